"""What the surrogate's own law adds to lines: probabilities, densities, moments, told errors; rows left alone."""

import numpy as np
import pytest
from line_models import row_model, total
from scipy.special import ndtr

from flexlash.tolerance import Normal, Triangular, Uniform
from flexlash.tolerance.engine.line_control import LineControl
from flexlash.tolerance.engine.line_direction import Inputs, direction_of
from flexlash.tolerance.engine.line_drawing import LineDrawing
from flexlash.tolerance.engine.line_moments import moments_of
from flexlash.tolerance.engine.line_quantiles import quantiles_at, quantiles_of
from flexlash.tolerance.engine.line_surrogate import fitted_surrogate
from flexlash.tolerance.engine.surrogate_law import SurrogateLaw

PROBABILITIES = np.array([0.00135, 0.025, 0.5, 0.975, 0.99865])


def drawing_of(function, *rows, seed=0):
    """Return how lines are drawn through rows alike."""
    with np.errstate(all="ignore"):
        return LineDrawing(row_model(function), Inputs.of(rows), seed)


def drawn_of(function, *rows, lines=64, seed=0):
    """Return lines through rows alike with their surrogates."""
    with np.errstate(all="ignore"):
        return drawing_of(function, *rows, seed=seed).drawn(np.arange(len(rows)), lines)


def tied(a, b, c, d):
    """Return a sum to which two of the inputs add together as well."""
    return a + b + 0.3 * a * b + c + d


TIED = {"a": Normal(0, 0.5), "b": Uniform(-1, 1), "c": Uniform(-1, 1), "d": Normal(0, 0.3)}
NODES, WEIGHTS = np.polynomial.legendre.leggauss(120)
"""Of b and of c; given these `tied` is normal with the mean b + c and the variance (1 + 0.3 b)²/4 + 0.09."""

WITHIN = (0.5 * (1 + 0.3 * NODES)) ** 2 + 0.09


def tied_above(value):
    """Return the exact probability that `tied` is above a value, and the density there."""
    sd = np.sqrt(WITHIN)[:, None]
    score = (value - NODES[:, None] - NODES) / sd
    weights = np.outer(WEIGHTS, WEIGHTS) / 4
    return (weights * ndtr(-score)).sum(), (weights * np.exp(-score * score / 2) / np.sqrt(2 * np.pi) / sd).sum()


@pytest.mark.parametrize("bent", [False, True])
def test_probabilities_and_densities_where_the_surrogate_errs(bent):
    """Where inputs act together the surrogate errs by many told errors; with the lines all probabilities are right.

    So are quantiles and densities, whatever bends the output.
    """
    drawn = drawn_of((lambda **given: np.exp(tied(**given))) if bent else tied, TIED, lines=128)
    values = np.array([-2.4, -1.2, 0.2, 1.2, 2.6])
    output = (np.exp(values) if bent else values)[:, None]
    exact, density = np.transpose([tied_above(value) for value in values])
    with np.errstate(all="ignore"):
        found, again = quantiles_at(drawn, output), quantiles_of(drawn, 1 - exact)
        own = drawn.control.above(output)
    assert (np.abs(found.above[:, 0] - exact) <= 3 * found.above_error[:, 0]).all()
    assert (np.abs(again.output - output) <= 3 * again.output_error).all()
    assert (np.abs(own[:, 0] - exact) / found.above_error[:, 0]).max() > 5
    for one in (found, again):
        assert one.density[:, 0] == pytest.approx(density / (output[:, 0] if bent else 1), rel=0.1)


def test_moments_where_the_surrogate_errs():
    """Moments of inputs that act together are right to their errors, where the surrogate's own are not."""
    drawn = drawn_of(tied, TIED, lines=128)
    with np.errstate(all="ignore"):
        found = moments_of(drawn)
    # Central moments of b + c and a normal of its own scatter, c apart: it is independent of the rest.
    second = WEIGHTS / 2 @ (NODES**2 + WITHIN)
    third = WEIGHTS / 2 @ (NODES**3 + 3 * NODES * WITHIN)
    fourth = WEIGHTS / 2 @ (NODES**4 + 6 * NODES**2 * WITHIN + 3 * WITHIN**2)
    variance, fourth = second + 1 / 3, fourth + 6 * second / 3 + 1 / 5
    exact = {"mean": 0.0, "sd": variance**0.5, "skewness": third / variance**1.5, "kurtosis": fourth / variance**2 - 3}
    for name, value in exact.items():
        assert abs(getattr(found, name)[0] - value) <= 3 * getattr(found, f"{name}_error")[0], name
    own = drawn.control.surrogate.moments(np.zeros(1))
    assert abs(own[2][0] - third) > 5 * found.skewness_error[0] * variance**1.5


def test_a_law_blunter_than_the_lines_stays_out():
    """Lines know the end of a uniform that dominates all others better than the series of its law: they go on alone."""
    inputs = {"y": Uniform(-100, 100), "x": Uniform(-1, 1), "z": Uniform(-1, 1), "u": Normal(0, 0.1)}
    assert drawn_of(total, inputs).control is None
    assert drawn_of(total, inputs | {"y": Uniform(-10, 10)}).control is not None


@pytest.mark.parametrize(("bend", "used"), [(0.0, True), (-1.0, True), (-2.5, False)])
def test_a_surrogate_that_falls_on_a_line_is_not_used(bend, used):
    """A surrogate that falls far out on its lines has no one crossing there: it is left out though it would help."""
    row = {"a": Normal(0, 3), "b": Uniform(-3, 3), "c": Uniform(-3, 3)}
    inputs = Inputs.of([row])
    with np.errstate(all="ignore"):
        lines = drawn_of(total, row, lines=16).lines
        surrogate = fitted_surrogate(row_model(total), inputs, direction_of(row_model(total), inputs).vector)
        surrogate.coefficients[-1, 0] += bend
        control = LineControl(lines, surrogate, SurrogateLaw.of(surrogate, inputs), np.ones(1, dtype=bool))
    assert control.used.tolist() == [used]


def test_what_no_line_tells_is_told_of_the_tail_where_model_and_surrogate_part():
    """Where inputs act together at their upper ends alone, the upper tail is told as less sure than the lower."""
    drawn = drawn_of(lambda a, b, c: a + b + 0.05 * np.exp(a + b) + c, {name: Uniform(-1, 1) for name in "abc"})
    rare, density = np.full((1, 1), 1e-4), np.full((1, 1), 1e-3)
    upper = drawn.control.unseen(rare, density, 0 * rare)
    lower = drawn.control.unseen(1 - rare, density, 1 + 0 * rare)
    assert upper > 1.5 * lower > 0


def steep(a, b, c):
    """Return an output that scatters over many orders of size where its inputs scatter much."""
    return np.exp(2 * a + 0.2 * a * b) * (1 + 0.3 * b) + 0.1 * c


def test_rows_that_take_different_rounds_keep_their_bits():
    """A row's quantiles, probabilities and moments are the same bits alone as beside rows that take more rounds."""
    rows = [
        {"a": Normal(0, sd), "b": Uniform(-width, width), "c": Triangular(-end, end)}
        for sd, width, end in ((0.01, 0.02, 0.3), (1.0, 0.5, 1e-3), (0.3, 1.0, 0.1), (0.5, 0.01, 2.0))
    ]
    drawing, chosen = drawing_of(steep, *rows, seed=1), np.arange(len(rows))
    probability = np.array([1e-6, *PROBABILITIES])
    limit = np.array([[1.02, 9.0, 2.0, 1.1], [0.9, 0.05, 0.4, 0.2]])
    with np.errstate(all="ignore"):
        together = drawing.drawn(chosen, 32)
        several = quantiles_of(together, probability), quantiles_at(together, limit), moments_of(together)
        assert together.control.used.any()
        for row in chosen:
            alone = drawing_of(steep, rows[row], seed=1).drawn(np.arange(1), 32)
            single = quantiles_of(alone, probability), quantiles_at(alone, limit[:, [row]]), moments_of(alone)
            for many, one in zip(several, single, strict=True):
                for name, values in vars(one).items():
                    assert np.array_equal(getattr(many, name)[..., row], values[..., 0]), (row, name)
            for level in range(2):
                one = quantiles_at(alone, limit[[level]][:, [row]])
                assert one.above[0, 0] == several[1].above[level, row]
                assert one.above_error[0, 0] == several[1].above_error[level, row]


@pytest.mark.parametrize(
    ("function", "end", "lines"),
    [
        (steep, 1, 64),
        (lambda a, b, c: np.sinh(4 * a) + b + c, 1, 64),
        (lambda a, b, c: 0.1 * a + 3 * b + c, 3, 16),
    ],
    ids=["steep", "sinh", "not found"],
)
def test_levels_that_take_many_searches_keep_their_bits(function, end, lines):
    """A quantile that is found at once is the same bit for bit beside others that are searched for by halving."""
    inputs = {"a": Normal(0, 1), "b": Uniform(-1, 1), "c": Triangular(-end, end)}
    drawn = drawn_of(function, inputs, lines=lines, seed=1)
    probability = np.array([1e-9, 1e-6, *PROBABILITIES, 1 - 1e-6, 1 - 1e-9])
    with np.errstate(all="ignore"):
        every = quantiles_of(drawn, probability)
        for level in range(len(probability)):
            alone = quantiles_of(drawn, probability[[level]])
            for name, values in vars(alone).items():
                assert values[0, 0] == getattr(every, name)[level, 0], (level, name)


def test_rows_that_lines_know_take_no_surrogate_beside_rows_that_do():
    """A row of nearly normal output does without a surrogate whatever is beside it, so that its numbers are its own."""
    rows = [{name: Normal(0, sd) for name in "abcd"} for sd in (0.05, 0.5)]
    drawing = drawing_of(lambda a, b, c, d: np.sinh(a) + np.sinh(b) + c + d, *rows)
    with np.errstate(all="ignore"):
        assert drawing.drawn(np.arange(2), 64).control.used.tolist() == [False, True]
        assert drawing.drawn(np.arange(1), 64).control is None
