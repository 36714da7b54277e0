"""Shares of variance by the line engine: Sobol' indices known in closed form, within errors that are honest."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from line_models import row_model

from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform, propagate
from flexlash.tolerance.engine.line_direction import Inputs
from flexlash.tolerance.engine.line_shares import line_shares

thorough = settings(deadline=None, max_examples=30, derandomize=True)


def indices(function, *rows, variance, seed=0):
    """Return first-order and total indices (inputs, rows)."""
    return shares(function, *rows, variance=variance, seed=seed)[:2]


def shares(function, *rows, variance, seed=0):
    """Return first-order and total indices and their standard errors, (4, inputs, rows)."""
    known = np.array(variance, dtype=float)
    return line_shares(row_model(function), Inputs.of(rows), (known, 0 * known), seed)


@pytest.mark.parametrize("seed", range(3))
def test_additive_model(seed):
    """In a weighted sum first and total index of an input are its part of the variance, but for the kink of c."""
    row = {"a": Normal(3, 2), "b": Uniform(-1, 4), "c": Triangular(0, 2), "d": TruncatedNormal(0, 1, -2, 2)}
    slopes = {"a": 1.0, "b": -2.0, "c": 0.5, "d": 3.0}
    parts = np.array([(slopes[name] * one.standard_deviation) ** 2 for name, one in row.items()])
    first, total = indices(
        lambda **given: sum(slopes[name] * values for name, values in given.items()),
        row,
        variance=[parts.sum()],
        seed=seed,
    )
    assert first[:, 0] == pytest.approx(parts / parts.sum(), abs=2e-5)
    assert total[:, 0] == pytest.approx(parts / parts.sum(), abs=2e-5)


def test_additive_polynomial_of_degree_four():
    """A polynomial of degree 4 in each input, without interaction, is exact too."""
    exact = np.array([96.0, 2.0])
    first, total = indices(lambda a, b: a**4 + b**2, {"a": Normal(0, 1), "b": Normal(0, 1)}, variance=[exact.sum()])
    assert first[:, 0] == pytest.approx(exact / exact.sum(), rel=1e-4)
    assert total[:, 0] == pytest.approx(exact / exact.sum(), rel=1e-4)


@pytest.mark.parametrize("spread", [0.02, 0.1, 0.2])
def test_multiplicative_model(spread):
    """In a product of inputs the indices are those of the closed form, interaction included."""
    variation = np.array([spread, 2 * spread, 1.5 * spread])
    row = {name: Normal(10, 10 * one) for name, one in zip("abc", variation, strict=True)}
    squares = 1 + variation**2
    whole = squares.prod() - 1
    first, total = indices(lambda a, b, c: a * b * c, row, variance=[whole * 1e6])
    # The mean over the other inputs is taken at 16 points or a few more.
    assert first[:, 0] == pytest.approx(variation**2 / whole, rel=0.1 * spread + 1e-6, abs=1e-4)
    assert total[:, 0] == pytest.approx(variation**2 * squares.prod() / squares / whole, rel=0.5 * spread + 1e-6)
    assert (total >= first).all()


def test_pure_interaction():
    """In a product of centred inputs no input causes anything by itself, and each has part in everything."""
    row = {"a": Normal(0, 1), "b": Uniform(-1, 1)}
    first, total = indices(lambda a, b: a * b, row, variance=[1 / 3])
    assert first[:, 0] == pytest.approx([0, 0], abs=1e-12)
    assert total[:, 0] == pytest.approx([1, 1], abs=0.1)


def test_an_input_without_effect_has_no_share():
    """An input that the output ignores has both indices 0."""
    first, total = indices(lambda a, b: a + 0 * b, {"a": Normal(0, 1), "b": Normal(0, 1)}, variance=[1.0])
    assert first[:, 0] == pytest.approx([1, 0], abs=1e-6)
    assert total[:, 0] == pytest.approx([1, 0], abs=1e-6)


def test_an_output_that_does_not_vary_has_no_shares():
    """Where nothing varies, no input causes anything, and no warning is given."""
    first, total = indices(lambda a, b: 0 * a * b + 4, {"a": Normal(0, 1), "b": Normal(0, 1)}, variance=[0.0])
    assert (first == 0).all()
    assert (total == 0).all()


def test_a_shift_of_the_output_changes_no_share():
    """A large constant added to the output changes no index beyond rounding."""
    row = {"a": Normal(1, 0.2), "b": Uniform(1, 2)}
    plain = indices(lambda a, b: a * b, row, variance=[0.5])
    shifted = indices(lambda a, b: a * b + 1e6, row, variance=[0.5])
    assert shifted[0] == pytest.approx(plain[0], abs=1e-8)
    assert shifted[1] == pytest.approx(plain[1], abs=1e-8)


@pytest.mark.slow
def test_squares_of_noisy_means_leave_no_bias(monkeypatch):
    """Few points leave the mean over seeds of a first index where it is: 0.1, not the 0.03 more that noise adds."""
    monkeypatch.setattr("flexlash.tolerance.engine.line_shares.QUADRATURE_POINTS", (64,))
    row = dict.fromkeys("abc", Normal(0, 1))
    found = [indices(lambda a, b, c: a + 3 * a * b * c, row, variance=[10.0], seed=seed)[0] for seed in range(300)]
    assert np.mean(found, axis=0)[0, 0] == pytest.approx(0.1, abs=0.015)


@pytest.mark.slow
@thorough
@given(
    slopes=st.lists(st.floats(-3, 3), min_size=3, max_size=3).filter(lambda one: max(map(abs, one)) > 0.1),
    bend=st.floats(-0.3, 0.3),
    twist=st.floats(-0.3, 0.3),
)
def test_first_index_is_within_0_and_the_total(slopes, bend, twist):
    """Whatever the model, 0 ≤ first index ≤ total index, and first indices are at most 1 together."""
    one, two, three = slopes
    row = {"a": Normal(0, 1), "b": Uniform(-1, 1), "c": Triangular(-1, 1)}

    def model(a, b, c):
        return one * a + two * b + three * c + bend * a * a + twist * a * b

    effects = np.array([one**2 + 2 * bend**2, two**2 / 3, three**2 / 6])
    first, total = indices(model, row, variance=[effects.sum() + twist**2 / 3])
    assert (first >= 0).all()
    assert (first <= total * (1 + 1e-9) + 1e-12).all()
    assert first.sum() <= 1.02
    assert first[2, 0] == pytest.approx(effects[2] / (effects.sum() + twist**2 / 3), abs=2e-4)


def test_rows_do_not_depend_on_their_neighbours():
    """The indices of a row are the same bit for bit, alone or beside other rows."""
    rows = [{"a": Normal(1, 0.2), "b": Uniform(1, 2)}, {"a": Normal(5, 1), "b": Uniform(0, 9)}]
    together = indices(lambda a, b: a * b**2, *rows, variance=[1.0, 2000.0])
    for place, row in enumerate(rows):
        alone = indices(lambda a, b: a * b**2, row, variance=[[1.0, 2000.0][place]])
        for several, single in zip(together, alone, strict=True):
            assert np.array_equal(several[:, place], single[:, 0])


def test_shares_of_a_spread_are_these():
    """A line spread has first and total index of each input by name, in the order of the inputs."""
    row = {"a": Normal(10, 1), "b": Uniform(9, 11), "c": Normal(0, 1)}
    spread = propagate(lambda a, b, c: a * b + c, row, seed=5)
    parts = np.array([100.0, 100 / 3, 1.0])
    both = 1 / 3
    assert spread.method == "line"
    assert list(spread.shares) == list(spread.total_shares) == ["a", "b", "c"]
    whole = parts.sum() + both
    assert list(spread.shares.values()) == pytest.approx(list(parts / whole), abs=1e-3)
    assert list(spread.total_shares.values()) == pytest.approx(
        list((parts + np.array([both, both, 0])) / whole), abs=4e-3
    )
    assert math.fsum(spread.shares.values()) == pytest.approx(1 - both / whole, abs=1e-3)
