"""The spread of one model by lines: as many as its precision takes, and refused where lines do not serve."""

import math

import numpy as np
import pytest
from hypothesis import settings
from line_models import row_model, total
from scipy.special import ndtri

from flexlash.tolerance import Normal, Triangular, Uniform, propagate
from flexlash.tolerance.engine.line_points import LINE_REPLICATES
from flexlash.tolerance.engine.line_precision import (
    DECISIVE,
    FEWEST_LINES,
    MOST_LINES,
    SD_PRECISION,
    initial_lines,
)
from flexlash.tolerance.engine.line_spread import LineSpread, LinesUnsuitable

thorough = settings(deadline=None, max_examples=100, derandomize=True)

TWO = {"a": Normal(0, 1), "b": Normal(0, 1)}
UNIFORMS = {f"u{place}": Uniform(0, 1) for place in range(4)}


def bent_total(**inputs):
    """Return the square of the sum: neither it nor its logarithm adds up, so that no surrogate is exact."""
    return total(**inputs) ** 2


def line_spread(function, inputs, *, samples=None, seed=0):
    """Return the spread of a function of keyword arrays by lines alone."""
    return LineSpread(row_model(function), inputs, samples=samples, seed=seed)


@pytest.mark.parametrize(
    ("samples", "lines"),
    [(1, 8), (8, 8), (9, 16), (16, 16), (17, 32), (64, 64), (65, 128), (1000, 1024), (1024, 1024), (1025, 2048)],
)
def test_lines_are_rounded_up(samples, lines):
    """The number of lines is rounded up to 8 replicates times a power of two."""
    assert LINE_REPLICATES == 8
    assert initial_lines(3, samples) == lines
    assert line_spread(total, TWO, samples=samples).size == lines


def test_easy_models_take_the_fewest_lines():
    """A model that is straight along and across its lines is settled with the fewest of them."""
    assert line_spread(total, TWO).size == FEWEST_LINES
    assert line_spread(total, TWO).notes == ()
    assert line_spread(lambda a: np.exp(a), {"a": Normal(0, 1)}).size == LINE_REPLICATES  # noqa: PLW0108


@pytest.mark.parametrize("seed", range(4))
def test_lines_are_added_until_errors_are_small(seed):
    """Lines are added until every settled quantile errs by less than a thousandth of the standard deviation."""
    spread = line_spread(bent_total, UNIFORMS, seed=seed)
    assert FEWEST_LINES < spread.size < MOST_LINES
    assert spread.size & (spread.size - 1) == 0
    assert (spread.standard_error(DECISIVE) <= SD_PRECISION * spread.sd * 1.05).all()
    fixed = line_spread(bent_total, UNIFORMS, samples=16, seed=seed)
    assert fixed.standard_error(DECISIVE).max() > SD_PRECISION * fixed.sd


def test_hard_models_stop_at_the_most_lines():
    """A kink across the lines takes all the lines there may be, and its errors still say how far off it is."""
    spread = line_spread(lambda a, b: abs(a) + 0.3 * b, TWO)
    assert spread.size == MOST_LINES
    assert spread.standard_error(DECISIVE).max() > SD_PRECISION * spread.sd
    (note,) = spread.notes
    assert note.startswith("standard errors reach ")
    assert abs(spread.mean - math.sqrt(2 / math.pi)) <= 4 * spread.mean_standard_error
    assert abs(spread.sd - math.sqrt(1 - 2 / math.pi + 0.09)) <= 4 * spread.sd_standard_error


def test_asking_for_lines_turns_adaptation_off():
    """With a number of lines just so many are taken, be they too few or too many."""
    assert line_spread(total, UNIFORMS, samples=16).size == 16
    assert line_spread(total, TWO, samples=4096).size == 4096


def test_stopping_widens_errors():
    """Errors of lines that were found enough are larger than those of the same lines asked for outright."""
    adapted = line_spread(total, UNIFORMS)
    asked = line_spread(total, UNIFORMS, samples=adapted.size)
    ratio = adapted.standard_error(0.5) / asked.standard_error(0.5)
    assert 1 < ratio <= 1.3
    assert adapted.quantile(0.5) == asked.quantile(0.5)
    assert adapted.sd_standard_error / asked.sd_standard_error == pytest.approx(ratio, rel=1e-3)


@pytest.mark.parametrize(
    ("function", "reason"),
    [
        (lambda a, b: a * b, "the output has no gradient at the median"),
        (lambda a, b: np.sin(a + b), "the output does not rise everywhere along its gradient at the median"),
        (lambda a, b: np.floor(a + b), "the output rises in steps"),
        (
            lambda a, b: np.where(a > 6, np.nan, a + b),
            "the model is not finite within 8 standard deviations",
        ),
    ],
)
def test_models_that_lines_do_not_serve(function, reason):
    """Where lines do not serve, that is raised with the reason."""
    with pytest.raises(LinesUnsuitable) as refusal:
        line_spread(function, TWO)
    assert str(refusal.value) == reason


@pytest.mark.slow
def test_a_bend_across_the_lines_is_followed():
    """The greater of two uniforms, which bends between the points looked at, has its exact quantiles."""
    spread = line_spread(lambda a, b: np.maximum(a, b), {"a": Uniform(0, 1), "b": Uniform(0, 1)})  # noqa: PLW0108
    probabilities = np.array([0.00135, 0.025, 0.5, 0.975, 0.99865])
    error = np.abs(spread.quantile(probabilities) - np.sqrt(probabilities))
    assert np.all(error <= 4 * spread.standard_error(probabilities))


def test_no_model_prints_a_warning():
    """Overflow, underflow and division by zero on the way to the tails are no warnings."""
    spread = line_spread(lambda a, b: -np.log(a) + b, {"a": Uniform(0, 1), "b": Normal(0, 1)})
    assert spread.mean == pytest.approx(1, abs=1e-3)
    with pytest.raises(LinesUnsuitable):
        line_spread(lambda a, b: np.exp(200 * (a + b)), TWO)


def test_interval_of_a_probability_is_that_of_its_confidence():
    """The interval of a share widens with its confidence and holds the exact share."""
    spread = line_spread(total, {"a": Uniform(0, 1), "b": Uniform(0, 2), "c": Triangular(0, 2)}, samples=256)
    share = spread.probability_above(4.0)
    low, high = spread.probability_interval(4.0)
    wide = spread.probability_interval(4.0, 0.999)
    assert wide[0] < low < share < high < wide[1]
    reach = math.log(wide[1] / wide[0]) / math.log(high / low)
    assert reach == pytest.approx(ndtri(0.9995) / ndtri(0.975), rel=0.05)


def test_propagate_answers_by_lines():
    """What propagate gives by lines are the numbers of a line spread."""
    own = line_spread(total, UNIFORMS, seed=3)
    through = propagate(total, UNIFORMS, seed=3)
    assert isinstance(through, LineSpread)
    assert (through.size, through.mean, through.quantile(0.9)) == (own.size, own.mean, own.quantile(0.9))
    assert through.shares == own.shares
