"""The law of sums of independent terms, against laws that are known otherwise."""

import math

import numpy as np
import pytest
from line_models import probability_below, row_model, total
from scipy import stats
from scipy.special import ndtr

from flexlash.tolerance import Normal, Triangular, Uniform
from flexlash.tolerance.engine.line_direction import Inputs, direction_of
from flexlash.tolerance.engine.line_surrogate import fitted_surrogate
from flexlash.tolerance.engine.surrogate_law import SurrogateLaw


def law_of(function, *rows):
    """Return the surrogates of rows and their law."""
    model, inputs = row_model(function), Inputs.of(rows)
    with np.errstate(all="ignore"):
        surrogate = fitted_surrogate(model, inputs, direction_of(model, inputs).vector)
        return surrogate, SurrogateLaw.of(surrogate, inputs)


def test_sum_of_normals():
    """A sum of normals is normal from 1e-8 to 1 − 1e-8, to the residual that is told; so is its density."""
    surrogate, law = law_of(lambda a, b: a - 2 * b + 50, {"a": Normal(0, 3), "b": Normal(1, 2)})
    scores = np.linspace(-5.6, 5.6, 41)[:, None]
    below, density = law.below(scores * 5)
    assert law.residual[0] < 2e-8
    assert below == pytest.approx(ndtr(scores), abs=law.residual[0])
    assert density == pytest.approx(stats.norm.pdf(scores) / 5, abs=2e-8)
    assert not surrogate.logarithmic[0]
    beyond = [one[:, 0].tolist() for one in law.below(np.array([[-99.0], [99.0]]))]
    assert beyond == [[0, 1], [0, 0]]


@pytest.mark.parametrize("widths", [(1, 1, 1), (1, 2, 0.5, 3), (1,) * 8, (30, 1, 1)])
def test_sums_of_uniforms_against_irwin_and_hall(widths):
    """Of uniforms, as many as the widths, F is that of Irwin and Hall to the residual that is told."""
    _, law = law_of(total, {f"u{place}": Uniform(0, width) for place, width in enumerate(widths)})
    values = np.linspace(0.02, 0.98, 49) * sum(widths)
    below, _ = law.below(values[:, None] - sum(widths) / 2)
    exact = np.array([probability_below(value, widths) for value in values])
    assert np.abs(below[:, 0] - exact).max() <= law.residual[0] + 1e-12
    assert law.residual[0] < 1e-3
    ends, _ = law.below(np.linspace(-0.5, 0.5, 401)[:, None] * sum(widths))
    assert ends.min() == 0
    assert ends.max() == 1


def test_product_is_a_sum_of_logarithms():
    """A product of lognormal-like factors is met by its logarithm: exp of a sum of normals is lognormal."""
    surrogate, law = law_of(lambda a, b: np.exp(0.1 * a + 0.2 * b), {"a": Normal(0, 1), "b": Normal(0, 1)})
    assert surrogate.logarithmic[0]
    sd = math.hypot(0.1, 0.2)
    values = np.linspace(-5, 5, 21)[:, None] * sd
    assert law.below(values)[0] == pytest.approx(ndtr(values / sd), abs=law.residual[0])


@pytest.mark.parametrize(
    "inputs", [{"a": Normal(0, 1), "b": Uniform(-1, 1)}, {"a": Triangular(-1, 1), "b": Uniform(-1, 2)}]
)
def test_quantiles_are_near_their_probabilities(inputs):
    """The values from which a search starts have about the probability that was asked for."""
    _, law = law_of(total, inputs)
    probability = np.array([1e-4, 0.00135, 0.025, 0.5, 0.975, 0.99865])
    below, _ = law.below(law.quantiles(probability))
    assert below[:, 0] == pytest.approx(probability, abs=1e-5)


def test_rows_have_their_own_law_whatever_is_beside_them():
    """Rows that take few and many terms have together, and taken out, the bits that each has alone."""
    rows = [
        {"a": Uniform(-width, width), "b": Uniform(-1, 1), "c": Normal(0, sd)}
        for width, sd in ((1, 3), (30, 0.01), (1, 0.2))
    ]
    _, together = law_of(total, *rows)
    values = np.linspace(-0.9, 0.9, 7)[:, None]
    assert len(together.series) > 1
    for index, row in enumerate(rows):
        _, alone = law_of(total, row)
        taken = together.take(np.array([index]))
        assert alone.residual[0] == together.residual[index] == taken.residual[0]
        for told in (together.below(np.tile(values, 3)), taken.below(values)):
            column = index if told[0].shape[1] > 1 else 0
            assert np.array_equal(told[0][:, column], alone.below(values)[0][:, 0])
            assert np.array_equal(told[1][:, column], alone.below(values)[1][:, 0])


@pytest.mark.parametrize("power", [4, 5, 6])
def test_what_the_range_leaves_out_is_told(power):
    """Of a term so heavy that the range of the series leaves some of it out, F is right to the residual that is told.

    Given a the sum is normal: F is the mean of Φ over a.
    """
    size = {4: 20, 5: 500, 6: 3000}[power]
    _, law = law_of(lambda a, b: a**power / size + a + b, {"a": Normal(0, 1), "b": Normal(0, 1)})
    scores = np.linspace(-9, 9, 2001)
    weights = np.exp(-scores * scores / 2)
    values = np.concatenate([np.linspace(-30, 30, 81), np.geomspace(30, 1000, 10)])
    exact = [weights @ ndtr(value - scores**power / size - scores) / weights.sum() for value in values]
    off = np.abs(law.below(values[:, None])[0][:, 0] - exact).max()
    assert off <= law.residual[0] < 2e-5
