"""Shares of variance at points: closed forms within told errors, few evaluations, and errors where nothing is seen."""

import numpy as np
import pytest
from known_shares import KNOWN, errors_of

from flexlash.tolerance import Normal, Uniform, propagate
from flexlash.tolerance.sampling import UnitPoints

each_method = pytest.mark.parametrize("method", ["sobol", "random"])

HEAVY = ("heavy tails", "two exponentials", "seven exponentials")
"""Outputs whose variance comes from few points, so that replicates are not close to normal."""


@pytest.mark.slow
@each_method
@pytest.mark.parametrize("name", KNOWN)
def test_shares_are_right_within_their_errors(name, method):
    """For each of six seeds all indices of a closed form are within four standard errors; those of heavy tails six."""
    known = KNOWN[name]
    for seed in range(6):
        off, told = errors_of(propagate(known.model, known.inputs, method=method, seed=seed), known)
        assert (off <= (6 if name in HEAVY else 4) * told + 1e-12).all()
        assert name in HEAVY or (told <= 0.013).all()


@pytest.mark.slow
@each_method
@pytest.mark.parametrize("name", ["reciprocals", "product", "bilinear"])
def test_errors_are_honest(name, method):
    """Over 40 seeds 95 % intervals hold the exact indices in 90 % to all of the cases, and errors are not too wide."""
    known = KNOWN[name]
    off, told = np.array([
        errors_of(propagate(known.model, known.inputs, method=method, samples=2**13, seed=seed), known)
        for seed in range(40)
    ]).swapaxes(0, 1)  # fmt: skip
    assert (off <= 1.96 * told).mean() >= 0.9
    assert told.mean() <= 4 * np.sqrt((off * off).mean())


@each_method
def test_a_linear_model_leaves_nothing_to_chance(method):
    """What input variances say exactly of a linear model costs no points: 256 know the shares of ten inputs exactly."""
    inputs = {name: Uniform(-1, 1) if name in "aei" else Normal(5, 2) for name in "abcdefghij"}
    weights = dict(zip(inputs, range(1, 11), strict=True))
    spread = propagate(
        lambda **values: sum(weights[name] * value for name, value in values.items()),
        inputs,
        method=method,
        samples=2**8,
    )
    parts = np.array([(weights[name] * one.standard_deviation) ** 2 for name, one in inputs.items()])
    assert list(spread.shares.values()) == pytest.approx(list(parts / parts.sum()), abs=1e-9)
    assert spread.total_shares == pytest.approx(spread.shares, abs=1e-9)
    assert max(spread.shares_standard_error.values()) <= 1e-9


def counted(method, function, inputs, **arguments):
    """Return the spread and how many points the model was asked at for its shares."""
    asked = []

    def model(**values):
        asked.append(next(iter(values.values())).size)
        return function(**values)

    spread = propagate(model, inputs, method=method, **arguments)
    before = sum(asked)
    assert spread.shares
    return spread, sum(asked) - before


@each_method
def test_evaluations_are_as_few_as_the_errors_take(method):
    """A nearly linear model takes 256 points in each replicate, one of interactions all 2048 and not more."""
    inputs = {"a": Normal(10, 1), "b": Normal(10, 1)}
    _, few = counted(method, lambda a, b: a * b, inputs)
    assert few == 5 * 16 * 256
    _, many = counted(method, lambda a, b: np.exp(a) * np.exp(b), {"a": Normal(0, 1), "b": Normal(0, 1)})
    assert many == 5 * 16 * (256 + 1024 + 2048)
    _, held = counted(method, lambda a, b: np.exp(a) * np.exp(b), inputs, samples=2**10)
    assert held == 5 * 16 * 64


def test_what_no_point_shows_is_told():
    """Where total indices fall short of 1 together something was missed, and the errors say that nothing is known."""
    points = UnitPoints(["a", "b"], method="random", samples=2**17, seed=0)
    normal = Normal(mean=0, sd=1)
    seen = max(points.standard("a", normal, which).max() for which in ("leading", "second"))
    spread = propagate(lambda a, b: (a > seen) + 0.0 * b, {"a": normal, "b": normal}, method="random", samples=2**17)
    assert spread.shares == {"a": 0.0, "b": 0.0}
    assert spread.shares_standard_error == spread.total_shares_standard_error == {"a": 1.0, "b": 1.0}


@each_method
def test_one_input_and_none_are_exact(method):
    """A single input causes everything, an output that does not vary has no cause; both without error."""
    alone = propagate(lambda a: a**2, {"a": Normal(0, 1)}, method=method, samples=64)
    still = propagate(lambda a, b: 0 * a * b, {"a": Normal(0, 1), "b": Normal(0, 1)}, method=method, samples=64)
    assert (alone.shares, alone.shares_standard_error) == ({"a": 1.0}, {"a": 0.0})
    assert still.total_shares == still.total_shares_standard_error == {"a": 0.0, "b": 0.0}
