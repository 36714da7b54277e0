"""Surrogates of models that add up, or nearly: their terms, moments, and the values that stand for outputs."""

from math import comb

import numpy as np
import pytest
from line_models import row_model, total
from scipy import stats

from flexlash.tolerance import Lognormal, Normal, Triangular, TruncatedNormal, Uniform, propagate
from flexlash.tolerance.engine.line_direction import Inputs, direction_of
from flexlash.tolerance.engine.line_drawing import DrawnLines, LineDrawing
from flexlash.tolerance.engine.line_quantiles import quantiles_at, quantiles_of
from flexlash.tolerance.engine.line_surrogate import fitted_surrogate

MIXED = {"a": Normal(10, 1), "b": Uniform(2, 4), "c": Triangular(5, 7), "d": TruncatedNormal(3, 0.2, 2.6, 3.4)}
PROBABILITIES = np.array([0.00135, 0.025, 0.5, 0.975, 0.99865])


def surrogate_of(function, *rows):
    """Return the surrogates of rows alike."""
    model, inputs = row_model(function), Inputs.of(rows)
    with np.errstate(all="ignore"):
        return fitted_surrogate(model, inputs, direction_of(model, inputs).vector)


def product(**inputs):
    """Return the product of all inputs."""
    return np.prod(np.stack(np.broadcast_arrays(*inputs.values())), axis=0)


def test_sums_and_products_choose_what_adds_up():
    """A sum is met as it is, a product by its logarithm, and an output that may be negative never by that."""
    assert surrogate_of(total, MIXED).logarithmic.tolist() == [False]
    assert surrogate_of(product, MIXED).logarithmic.tolist() == [True]
    assert surrogate_of(lambda a, b: np.exp(a) * b, {"a": Normal(0, 1), "b": Normal(0, 1)}).logarithmic.tolist() == [
        False
    ]


def test_moments_of_a_sum_are_exact():
    """Mean, variance, third and fourth central moment of a sum are those of its inputs."""
    widths = (1.0, 3.0)
    surrogate = surrogate_of(lambda a, b, c: a + b + c, {"a": Uniform(0, 1), "b": Uniform(0, 3), "c": Normal(5, 2)})
    mean = sum(widths) / 2 + 5
    variance = sum(width**2 / 12 for width in widths) + 4
    fourth = -sum(width**4 / 120 for width in widths) + 3 * variance**2
    assert [float(one[0]) for one in surrogate.moments(np.array([mean]))] == pytest.approx(
        [0, variance, 0, fourth], rel=1e-9, abs=1e-9
    )


def test_moments_of_a_lognormal_about_another_value():
    """About any value the moments of exp of a sum of normals are those of its raw moments exp(k² σ²/2)."""
    surrogate = surrogate_of(lambda a, b: np.exp(0.1 * a + 0.2 * b), {"a": Normal(0, 1), "b": Normal(0, 1)})
    raw = [np.exp(power**2 * 0.05 / 2) for power in range(5)]
    exact = [sum(comb(k, i) * raw[i] * (-0.7) ** (k - i) for i in range(k + 1)) for k in range(1, 5)]
    assert [float(one[0]) for one in surrogate.moments(np.array([0.7]))] == pytest.approx(exact, rel=1e-8)


@pytest.mark.parametrize("part", [0.02, 1e-5])
def test_moments_of_a_product_keep_their_digits(part):
    """Central moments of a product are exact to 1e-7 also where its inputs scatter by a hundred-thousandth."""
    inputs = {name: Uniform(1 - part, 1 + part) for name in "abc"}
    surrogate = surrogate_of(product, inputs)
    found = [float(one[0]) for one in surrogate.moments(np.ones(1))]
    # E(Π(1 + x) − 1)ⁿ by all moments of x, a uniform between ± part.
    moments = [1.0] + [part**power / (power + 1) if power % 2 == 0 else 0.0 for power in range(1, 13)]
    for power in range(1, 5):
        rounding = 1e-15 * (np.sqrt(3) * part) ** (power - 1)
        assert found[power - 1] == pytest.approx(_product_moment(power, moments), rel=1e-7, abs=rounding)


def _product_moment(power, moments):
    """Return E((1 + x)(1 + y)(1 + z) − 1)ⁿ, by expanding all of it."""
    terms = {(0, 0, 0): 1.0}
    factor = {(i, j, k): 1.0 for i in (0, 1) for j in (0, 1) for k in (0, 1) if i + j + k}
    for _ in range(power):
        grown = {}
        for one, weight in terms.items():
            for other, more in factor.items():
                key = tuple(a + b for a, b in zip(one, other, strict=True))
                grown[key] = grown.get(key, 0.0) + weight * more
        terms = grown
    return sum(weight * np.prod([moments[exponent] for exponent in key]) for key, weight in terms.items())


@pytest.mark.parametrize(
    ("function", "inputs"),
    [
        (lambda a, b: (a + b) ** 3, {"a": Normal(10, 1), "b": Uniform(0, 2)}),
        (total, {"a": Normal(10, 1), "b": Uniform(0, 2)}),
        (lambda **given: np.exp(total(**given)), {f"u{place}": Uniform(-1.5, 1.5) for place in range(8)}),
    ],
    ids=["cube", "sum", "steep"],
)
def test_values_stand_for_outputs_and_back(function, inputs):
    """On the line through the medians model and surrogate agree, whatever bends the output; rates are derivatives."""
    surrogate = surrogate_of(function, inputs)
    outputs = surrogate.output(surrogate.risen)
    values, _ = surrogate.matched(outputs[4:-4])
    assert values == pytest.approx(surrogate.totals[4:-4], rel=1e-9, abs=1e-12)
    assert surrogate.unmatched(values) == pytest.approx(outputs[4:-4], rel=1e-9)
    between = (outputs[8:-9] + 2 * outputs[9:-8]) / 3
    rates, step = surrogate.matched(between)[1], 1e-5 * between
    change = surrogate.matched(between + step)[0] - surrogate.matched(between - step)[0]
    assert rates == pytest.approx(change / (2 * step), rel=2e-2)


def test_beyond_the_line_through_the_medians_values_go_on_as_outputs_do():
    """Tables rise where polynomials do not follow a step; beyond their ends values of S move by what outputs move."""
    surrogate = surrogate_of(lambda a, b: np.arctan(3 * a) + 0.1 * b, {"a": Normal(0, 1), "b": Normal(0, 1)})
    assert (np.diff(surrogate.totals, axis=0) >= 0).all()
    assert (np.diff(surrogate.totals, axis=0) == 0).any()
    outputs = np.array([[-12.0], [-11.0], [11.0], [12.0]])
    with np.errstate(all="ignore"):
        values, rates = surrogate.matched(outputs)
        assert surrogate.unmatched(values) == pytest.approx(outputs)
    assert np.diff(values[:, 0])[[0, 2]] == pytest.approx([1, 1])
    assert rates[:, 0].tolist() == [1.0] * 4


def test_models_that_are_not_finite_have_no_surrogate():
    """Where the model has no value at the ends of an input there is no surrogate, and lines go on without."""
    surrogate = surrogate_of(lambda a, b: np.where(a > 5.5, np.nan, a) + b, {"a": Normal(0, 1), "b": Normal(0, 1)})
    assert surrogate.fitted.tolist() == [False]


def test_a_sum_of_anything_is_exact_with_few_lines():
    """Percentiles of a sum by 16 lines are those of 4096 lines without a surrogate, to 100 times less than without."""
    model, inputs = row_model(total), Inputs.of([MIXED])
    with np.errstate(all="ignore"):
        drawing = LineDrawing(model, inputs, 0)
        few, many = drawing.drawn(np.arange(1), 16), drawing.drawn(np.arange(1), 1 << 12)
        found = quantiles_of(few, PROBABILITIES)
        alone = quantiles_of(DrawnLines(lines=few.lines), PROBABILITIES)
        truth = quantiles_of(DrawnLines(lines=many.lines), PROBABILITIES).output
    assert few.control is not None
    off, off_alone = (np.abs(one.output - truth).max() for one in (found, alone))
    assert off < off_alone / 30
    assert found.output_error.max() < alone.output_error.max() / 30


def test_exact_sums_against_convolution():
    """A sum of a normal and a lognormal has the percentiles of their convolution by quadrature."""
    inputs = {"a": Normal(0, 1), "b": Lognormal(mean=3, sd=1)}
    spread = propagate(total, inputs, samples=64)
    nodes, weights = np.polynomial.hermite_e.hermegauss(120)
    weights = weights / weights.sum()
    for probability in PROBABILITIES:
        value = spread.quantile(probability)
        below = float(
            weights @ stats.norm.cdf(value - (3 / np.sqrt(1 + 1 / 9)) * np.exp(np.sqrt(np.log(1 + 1 / 9)) * nodes))
        )
        assert abs(below - probability) < 1e-5


def test_a_surrogate_that_does_not_help_is_left_out():
    """Where inputs act together alone lines do better by themselves, and rows beside that are served still are."""

    def hyperbolic(a, b, c):
        return np.sqrt(a * a + b * b) + c

    rows = [{"a": Normal(0, sd), "b": Normal(1, sd), "c": Normal(0, 0.01)} for sd in (1.0, 0.01)]
    model, inputs = row_model(hyperbolic), Inputs.of(rows)
    with np.errstate(all="ignore"):
        drawn = LineDrawing(model, inputs, 3).drawn(np.arange(2), 32)
        found = quantiles_of(drawn, PROBABILITIES)
        plain = quantiles_of(DrawnLines(lines=drawn.lines), PROBABILITIES)
    assert drawn.control is not None
    assert drawn.control.used.tolist() == [False, True]
    assert np.array_equal(found.output[:, 0], plain.output[:, 0])
    assert np.array_equal(found.output_error[:, 0], plain.output_error[:, 0])
    assert found.output_error[:, 1].max() < plain.output_error[:, 1].max() / 3


def test_rare_probabilities_are_told_as_unsure_where_no_line_reaches():
    """Far in the tail of a bounded output the told error is no less than what model and surrogate are apart there."""
    inputs = {"a": Normal(10, 1), "b": Triangular(-1, 1), "c": Uniform(4, 9)}
    model = row_model(lambda a, b, c: a * np.exp(b / 4) + c**1.5)
    with np.errstate(all="ignore"):
        drawing = LineDrawing(model, Inputs.of([inputs]), 0)
        few, many = drawing.drawn(np.arange(1), 64), drawing.drawn(np.arange(1), 1 << 14)
        output = np.array([[13.5]])
        found, truth = quantiles_at(few, output), quantiles_at(many, output)
    assert abs(found.above - truth.above)[0, 0] <= 4 * np.hypot(found.above_error, truth.above_error)[0, 0]


def test_a_probability_about_as_rare_as_the_laws_residual_is_not_told_as_none():
    """At the end of a uniform that dominates four others the interval of a share of 1e-5 holds it, for every seed."""
    inputs = {"y": Uniform(-100, 100), **{f"x{place}": Uniform(-1, 1) for place in range(4)}}
    # Within 2 of the greatest sum only a corner of the cube is left: its share is (104 − y)⁵/5!/(200 · 2⁴).
    output = 104 - (1e-5 * 120 * 200 * 16) ** 0.2
    for seed in range(8):
        low, high = propagate(total, inputs, seed=seed).probability_interval(output)
        assert low <= 1e-5 <= high
