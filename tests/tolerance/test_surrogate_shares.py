"""Shares of variance by the line engine with its surrogate: exact where it is, honest where not, at few points."""

import numpy as np
import pytest
from known_shares import KNOWN, errors_of
from line_models import row_model

from flexlash.tolerance import Normal, Uniform, propagate
from flexlash.tolerance.engine.line_direction import Inputs, direction_of
from flexlash.tolerance.engine.line_points import mirrored_net
from flexlash.tolerance.engine.line_shares import line_shares
from flexlash.tolerance.engine.line_surrogate import fitted_surrogate
from flexlash.tolerance.engine.surrogate_shares import surrogate_shares
from flexlash.tolerance.student import Student

TORQUE = 800.0
WIND_UP = {
    "length": Uniform(0.1598, 0.1602),
    "wall": Uniform(1.55e-3, 1.65e-3),
    "disk": Uniform(1.55e-3, 1.65e-3),
    "radius": Normal(0.08, 2e-5),
    "inner": Uniform(0.03985, 0.04015),
    "modulus": Normal(211e9, 2.11e9),
    "ratio": Uniform(0.28, 0.32),
}
"""The flexspline of the tolerance reference: B3-160, seven independent inputs."""


def wind_up(*, length, wall, disk, radius, inner, modulus, ratio):
    """Return twice the wind-up [rad] of a cup: cylinder and disk."""
    square = radius * radius
    cup = length / (square * radius * wall) + (1 / (inner * inner) - 1 / square) / (2 * disk)
    return 2 * TORQUE / np.pi * (1 + ratio) / modulus * cup


def by_product_rule(model, inputs, nodes=6):
    """Return first-order and total indices by Gauss's rule over all inputs together, and the variance."""
    points, weights = zip(*(gauss_nodes(one, nodes) for one in inputs.values()), strict=True)
    output = model(**dict(zip(inputs, np.meshgrid(*points, indexing="ij"), strict=True)))

    every = range(len(inputs))

    def mean(values, axes):
        for axis in axes:
            shape = [-1 if place == axis else 1 for place in every]
            values = (values * weights[axis].reshape(shape)).sum(axis=axis, keepdims=True)
        return values

    whole = mean(output, every)
    variance = mean((output - whole) ** 2, every).item()
    effects = [mean(output, [other for other in every if other != place]) - whole for place in every]
    first = [mean(effect * effect, [place]).item() / variance for place, effect in enumerate(effects)]
    total = [mean((output - mean(output, [place])) ** 2, every).item() / variance for place in every]
    return np.array([first, total]), variance


def gauss_nodes(one, nodes):
    """Return nodes and weights of a normal or uniform input."""
    if isinstance(one, Normal):
        points, weights = np.polynomial.hermite_e.hermegauss(nodes)
        return one.mean + one.sd * points, weights / weights.sum()
    points, weights = np.polynomial.legendre.leggauss(nodes)
    return (one.low + one.high) / 2 + (one.high - one.low) / 2 * points, weights / 2


def surrogate_of(model, *rows):
    """Return model, inputs and surrogates of rows alike."""
    model, inputs = row_model(model), Inputs.of(rows)
    with np.errstate(all="ignore"):
        return model, inputs, fitted_surrogate(model, inputs, direction_of(model, inputs).vector)


def counted(model):
    """Return a model of rows that counts what it is asked for, and the list it counts in."""
    asked = []

    def counting(arguments, rows):
        output = model(arguments, rows)
        asked.append(output.size)
        return output

    return counting, asked


@pytest.mark.slow
@pytest.mark.parametrize("name", KNOWN)
def test_shares_are_right_within_their_errors(name):
    """For each of four seeds all indices of a closed form are within four standard errors, which are below 0.003."""
    known = KNOWN[name]
    for seed in range(4):
        spread = propagate(known.model, known.inputs, seed=seed)
        off, told = errors_of(spread, known)
        assert spread.method == "line"
        assert (off <= 4 * told + 1e-9).all()
        assert (told <= 0.003).all()


VARIANCES = {
    "linear": 1 + 4 / 6,
    "two exponentials": np.exp(4) - np.exp(2),
    "seven exponentials": np.exp(3.5) - np.exp(1.75),
}


@pytest.mark.parametrize("name", VARIANCES)
def test_shares_of_a_surrogate_that_is_the_model_are_exact(name):
    """Where the surrogate is the model, 16 points give the closed form to 1e-9 and no error."""
    known = KNOWN[name]
    model, inputs, surrogate = surrogate_of(known.model, known.inputs)
    net = mirrored_net(0, len(inputs.names), 16)
    found = surrogate_shares(surrogate, model, inputs, net, np.array([VARIANCES[name]]))
    assert found[:2, :, 0] == pytest.approx(np.array([known.first, known.total]), abs=1e-9)
    assert (found[2:] <= 1e-9).all()


def test_a_flexspline_takes_16_evaluations():
    """All indices of the reference flexspline take 16 evaluations, are right to 5e-4 and within four errors."""
    exact, variance = by_product_rule(wind_up, WIND_UP)
    model, inputs, surrogate = surrogate_of(wind_up, WIND_UP)
    model, asked = counted(model)
    for seed in range(20):
        found = line_shares(model, inputs, (np.array([variance]), np.zeros(1)), seed, surrogate)[:, :, 0]
        off = np.abs(found[:2] - exact)
        assert off.max() <= 5e-4
        assert (off <= 4 * found[2:] + 1e-7).all()
        assert found[2:].max() <= 1e-3
    assert asked == [16] * 20


def test_the_reference_flexspline_has_the_shares_of_its_budget():
    """Shares of the reference flexspline are those of its first-order budget but for the curvature, 1e-3."""
    budget = {"wall": 0.3025, "modulus": 0.2846, "ratio": 0.2245, "disk": 0.1701, "inner": 0.0174, "length": 0.0005}
    spread = propagate(wind_up, WIND_UP)
    assert spread.shares == pytest.approx(budget | {"radius": 0.0004}, abs=1e-3)
    assert max(spread.shares_standard_error.values()) <= 5e-4


def test_a_residual_that_is_too_great_takes_quadrature():
    """Where the residual alone causes more than errors allow, points over the others answer instead of it."""
    inputs = {"a": Uniform(-1, 1), "b": Uniform(-1, 1), "c": Normal(0, 1)}
    model, inputs, surrogate = surrogate_of(lambda a, b, c: c + a * b, inputs)
    model, asked = counted(model)
    found = line_shares(model, inputs, (np.array([1 + 1 / 9]), np.zeros(1)), 0, surrogate)[:, :, 0]
    assert asked[:2] == [16, 64]
    assert len(asked) > 2
    exact = np.array([[0, 0, 0.9], [0.1, 0.1, 0.9]])
    assert (np.abs(found[:2] - exact) <= 4 * found[2:] + 1e-6).all()


def test_an_error_of_the_variance_is_one_of_the_shares():
    """A variance known to 1 % leaves 1 % of each share uncertain, where all else is exact."""
    model, inputs, surrogate = surrogate_of(lambda a, b: a + 2 * b, {"a": Normal(0, 1), "b": Normal(0, 1)})
    found = line_shares(model, inputs, (np.array([5.0]), np.array([0.005])), 0, surrogate)[:, :, 0]
    assert found[2:] == pytest.approx(found[:2] * 0.001, rel=0.2)


@pytest.mark.parametrize("degrees", [3.0, 5.0])
def test_a_tail_beyond_the_rule_is_told(degrees):
    """What a rule misses of the variance of a heavy tail is an error of the shares, by surrogate and by quadrature."""
    heavy = Student(0.0, 1.0, degrees)
    model, inputs, surrogate = surrogate_of(lambda a, b: 2 * a + b, {"a": heavy, "b": heavy})
    variance = np.array([5 * heavy.standard_deviation**2])
    for stood in (surrogate, None):
        found = line_shares(model, inputs, (variance, 0 * variance), 0, stood)[:, :, 0]
        assert (np.abs(found[:2] - [0.8, 0.2]) <= 2 * found[2:] + 1e-9).all()


def test_rows_without_a_surrogate_are_not_answered_by_it():
    """A model that is not finite at the surrogate's nodes has infinite errors by it, so that quadrature answers."""
    model, inputs, surrogate = surrogate_of(
        lambda a, b: np.where(np.abs(a) > 5.5, np.inf, a + b), {"a": Normal(0, 1), "b": Normal(0, 1)}
    )
    with np.errstate(all="ignore"):
        found = surrogate_shares(surrogate, model, inputs, mirrored_net(0, 2, 16), np.array([2.0]))
    assert not surrogate.fitted[0]
    assert np.isinf(found[2:]).all()


@pytest.mark.slow
def test_errors_are_honest():
    """Over 100 seeds 95 % intervals hold 91 to 99 % of the exact indices where model and surrogate part."""
    wide = {
        name: Normal(one.mean, 3 * one.sd)
        if isinstance(one, Normal)
        else Uniform(2 * one.low - one.high, 2 * one.high - one.low)
        for name, one in WIND_UP.items()
    }
    exact, _ = by_product_rule(wind_up, wide)
    matters = exact > 1e-3
    covered = []
    for seed in range(100):
        spread = propagate(wind_up, wide, seed=seed)
        found = np.array([[*spread.shares.values()], [*spread.total_shares.values()]])
        told = np.array([[*spread.shares_standard_error.values()], [*spread.total_shares_standard_error.values()]])
        covered.append((np.abs(found - exact) <= 1.96 * told)[matters])
    assert 0.91 <= np.mean(covered) <= 0.99


def test_a_row_has_the_same_bits_alone_and_in_company():
    """Shares and errors of rows alike, some by the surrogate and some by quadrature, do not depend on the others."""
    rows = [
        {"a": Normal(10 + place, 0.2 + 0.5 * (place % 3)), "b": Uniform(3, 4 + place), "c": Normal(5, 0.3)}
        for place in range(9)
    ]

    def function(a, b, c):
        return np.sqrt(a * a + b * b) * c + a * b

    def found(chosen):
        model, inputs, surrogate = surrogate_of(function, *chosen)
        variance = np.full(len(chosen), 1e3)
        return line_shares(model, inputs, (variance, 0.001 * variance), 0, surrogate)

    together = found(rows)
    assert (together[2:].max(axis=(0, 1)) > 0.001).any()
    for place, row in enumerate(rows):
        assert np.array_equal(found([row])[:, :, 0], together[:, :, place])
        assert np.array_equal(found(rows[place:])[:, :, 0], together[:, :, place])
