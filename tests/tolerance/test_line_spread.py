"""How many lines a row needs: their number, when it is enough, the intervals of shares, and the spread of one row."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import ndtri

from flexlash.tolerance import Normal, Triangular, Uniform, propagate
from flexlash.tolerance.engine.line_points import LINE_REPLICATES
from flexlash.tolerance.engine.line_precision import (
    DECISIVE,
    FEWEST_LINES,
    MOST_LINES,
    PROBABILITY_PRECISION,
    RAREST_PROBABILITY,
    SD_PRECISION,
    initial_lines,
    lines_needed,
    precision_notes,
    unresolved,
)
from flexlash.tolerance.engine.line_quantiles import probability_interval
from flexlash.tolerance.engine.line_spread import LineSpread, LinesUnsuitable

thorough = settings(deadline=None, max_examples=100, derandomize=True)

TWO = {"a": Normal(0, 1), "b": Normal(0, 1)}
UNIFORMS = {f"u{place}": Uniform(0, 1) for place in range(4)}


def line_spread(function, inputs, *, samples=None, seed=0):
    """Return the spread of a function of keyword arrays by lines alone."""

    def model(arguments, rows):
        shape = np.broadcast_shapes(*map(np.shape, arguments.values()), rows.shape)
        return np.broadcast_to(function(**arguments), shape)

    return LineSpread(model, inputs, samples=samples, seed=seed)


def total(**inputs):
    """Return the sum of all inputs."""
    return sum(inputs.values())


def decided(excess, *, lines=FEWEST_LINES, share=None, relative=0.0, limited=None, scale=2.0):
    """Return the lines wanted and the margin of a row whose errors are so many times those wanted."""
    errors = np.array([[0.3], [1.0], [0.7], [0.0], [0.9]]) * excess * SD_PRECISION * scale
    settled = SimpleNamespace(output_error=errors)
    over = None
    if share is not None:
        error = np.array([[relative * PROBABILITY_PRECISION * min(share, 1 - share)]])
        over = SimpleNamespace(above=np.array([[share]]), above_error=error)
    row = SimpleNamespace(lines=lines, scale=np.array([scale]))
    (wanted,), (margin,) = lines_needed(row, settled, over, limited)
    return int(wanted), float(margin)


@pytest.mark.parametrize(
    ("samples", "lines"),
    [(1, 8), (8, 8), (9, 16), (16, 16), (17, 32), (64, 64), (65, 128), (1000, 1024), (1024, 1024), (1025, 2048)],
)
def test_lines_are_rounded_up(samples, lines):
    """The number of lines is rounded up to 8 replicates times a power of two."""
    assert LINE_REPLICATES == 8
    assert initial_lines(3, samples) == lines
    assert line_spread(total, TWO, samples=samples).size == lines


def test_default_and_single_input():
    """Without a number 64 lines begin; one input alone has one line in each replicate, whatever is asked for."""
    assert initial_lines(2, None) == FEWEST_LINES == 64
    assert initial_lines(1, None) == initial_lines(1, 5000) == LINE_REPLICATES


@pytest.mark.parametrize("inputs", [1, 2])
@pytest.mark.parametrize("samples", [0, -3])
def test_no_lines_are_refused(inputs, samples):
    """A number of lines below 1 is refused with the number."""
    with pytest.raises(ValueError, match=rf"^samples = {samples} must be at least 1$"):
        initial_lines(inputs, samples)


def test_precise_lines_are_enough():
    """Where errors are far smaller than wanted, the lines are enough and errors are as they are."""
    wanted, margin = decided(0.0)
    assert (wanted, margin) == (FEWEST_LINES, 1.0)
    wanted, margin = decided(0.1)
    assert wanted == FEWEST_LINES
    assert 1 < margin < 1.01


def test_barely_precise_lines_are_not_enough():
    """An error that is just within what is wanted gains a margin, and with it is not enough."""
    wanted, margin = decided(0.99)
    assert wanted == 2 * FEWEST_LINES
    assert margin == pytest.approx(1.3, abs=0.01)


@pytest.mark.parametrize(("excess", "times"), [(1.5, 4), (3.0, 8), (10.0, 32), (60.0, 128)])
def test_imprecise_lines_grow_at_once(excess, times):
    """Lines grow in proportion to the error still too large, at once and by a power of two."""
    assert decided(excess)[0] == times * FEWEST_LINES


def test_scale_of_the_output_does_not_matter():
    """The same errors in standard deviations want the same lines, whatever the unit."""
    assert decided(3.0, scale=1e-9) == pytest.approx(decided(3.0, scale=1e9), rel=1e-12)


def test_budget_is_kept():
    """However large the error, no more than the most lines are wanted, and at the most the row is done."""
    assert decided(1e9)[0] == MOST_LINES
    assert decided(1e9, lines=MOST_LINES)[0] == MOST_LINES
    assert decided(5.0, lines=MOST_LINES // 2)[0] == MOST_LINES


@thorough
@given(excess=st.floats(0, 1e6), bits=st.integers(3, 11))
def test_wanted_lines_are_a_power_of_two_and_never_fewer(excess, bits):
    """Lines wanted are replicates times a power of two, never fewer, and more where errors are too large."""
    lines = LINE_REPLICATES << (bits - 3)
    wanted, margin = decided(excess, lines=lines)
    assert lines <= wanted <= MOST_LINES
    assert wanted & (wanted - 1) == 0
    assert 1 <= margin <= 1.3
    assert (wanted > lines) == (excess * margin > 1)


@pytest.mark.parametrize("share", [0.2, 1e-4, 1 - 1e-4, 2 * RAREST_PROBABILITY])
def test_rare_shares_want_lines_too(share):
    """The share over a limit wants lines for its own relative precision, on either side."""
    assert decided(0.0, share=share, relative=0.1)[0] == FEWEST_LINES
    assert decided(0.0, share=share, relative=3.0)[0] == 8 * FEWEST_LINES
    assert decided(10.0, share=share, relative=3.0)[0] == decided(10.0)[0]


def test_shares_too_rare_or_not_asked_for_want_no_lines():
    """A share below 1e-9, or of a row without a limit, does not count."""
    assert RAREST_PROBABILITY == 1e-9
    for share in (0.5 * RAREST_PROBABILITY, 0.0, 1.0):
        assert decided(0.0, share=share, relative=1e6)[0] == FEWEST_LINES
    assert decided(0.0, share=0.1, relative=3.0, limited=np.array([False]))[0] == FEWEST_LINES
    assert decided(0.0, share=0.1, relative=3.0, limited=np.array([True]))[0] == 8 * FEWEST_LINES


def test_rows_are_decided_apart():
    """Each row has its own number of lines and margin."""
    settled = SimpleNamespace(output_error=np.array([[0.0, 3e-3, 30.0]]))
    row = SimpleNamespace(lines=64, scale=np.array([1.0, 1.0, 1.0]))
    wanted, margin = lines_needed(row, settled)
    assert wanted.tolist() == [64, 512, MOST_LINES]
    assert margin[0] == 1
    assert margin[1] > 1


def test_unsettled_rows_are_told():
    """A row is unresolved where any of its crossings is off by more than the standard error wanted."""
    lines = SimpleNamespace(scale=np.array([1.0, 1.0, 100.0]))
    residual = np.array([[0.0, 2 * SD_PRECISION, 2 * SD_PRECISION], [0.5 * SD_PRECISION, 0.0, 0.0]])
    assert unresolved(lines, SimpleNamespace(residual=residual)).tolist() == [False, True, False]


def test_missed_precision_is_told():
    """A row whose settled quantiles miss the precision wanted says by how much, others say nothing."""
    settled = SimpleNamespace(output_error=np.array([[0.5e-3, 1e-3, 0.0], [1e-3, 0.0123, 0.0]]))
    notes = precision_notes(settled, np.array([1.0, 2.0, 0.0]))
    assert notes == ["", "standard errors reach 0.0062 standard deviations, 0.001 was wanted", ""]


@pytest.mark.parametrize("share", [0.5, 0.1, 1e-3, 1e-6])
@pytest.mark.parametrize("relative", [1e-6, 1e-3])
def test_narrow_interval_of_a_share_is_even(share, relative):
    """With a small error the interval is the share ± 1.96 standard errors."""
    error = relative * share
    low, high = probability_interval(np.array([share]), np.array([error]))
    assert low[0] == pytest.approx(share - 1.96 * error, abs=0.02 * error)
    assert high[0] == pytest.approx(share + 1.96 * error, abs=0.02 * error)


@thorough
@given(share=st.floats(1e-12, 1 - 1e-12), relative=st.floats(0, 10), factor=st.floats(0.1, 5))
def test_interval_of_a_share_holds_it_within_0_and_1(share, relative, factor):
    """The interval holds the share to rounding, stays within 0 and 1, and widens with the factor."""
    error = np.array([relative * min(share, 1 - share)])
    low, high = probability_interval(np.array([share]), error, factor)
    assert 0 <= low[0] <= share * (1 + 1e-9)
    assert share * (1 - 1e-9) <= high[0] <= 1
    wide_low, wide_high = probability_interval(np.array([share]), error, 2 * factor)
    assert wide_low[0] <= low[0]
    assert high[0] <= wide_high[0]


@thorough
@given(share=st.floats(0.01, 0.99), relative=st.floats(0.001, 1))
def test_interval_of_the_rest_is_the_rest_of_the_interval(share, relative):
    """The interval of one less a share is one less its interval."""
    error = np.array([relative * min(share, 1 - share)])
    low, high = probability_interval(np.array([share]), error)
    rest_low, rest_high = probability_interval(np.array([1 - share]), error)
    assert rest_low[0] == pytest.approx(1 - high[0], abs=1e-12)
    assert rest_high[0] == pytest.approx(1 - low[0], abs=1e-12)


def test_interval_of_no_share():
    """A share told from none by nothing has an interval from exactly 0 to almost 0, and so the rest of one."""
    low, high = probability_interval(np.array([0.0, 1e-17, 1.0]), np.zeros(3))
    assert low[:2].tolist() == [0.0, 0.0]
    assert (high[:2] <= 1e-14).all()
    assert low[2] >= 1 - 1e-14
    assert high[2] == 1.0


def test_easy_models_take_the_fewest_lines():
    """A model that is straight along and across its lines is settled with the fewest of them."""
    assert line_spread(total, TWO).size == FEWEST_LINES
    assert line_spread(total, TWO).notes == ()
    assert line_spread(lambda a: np.exp(a), {"a": Normal(0, 1)}).size == LINE_REPLICATES  # noqa: PLW0108


@pytest.mark.parametrize("seed", range(4))
def test_lines_are_added_until_errors_are_small(seed):
    """Lines are added until every settled quantile errs by less than a thousandth of the standard deviation."""
    spread = line_spread(total, UNIFORMS, seed=seed)
    assert FEWEST_LINES < spread.size < MOST_LINES
    assert spread.size & (spread.size - 1) == 0
    assert (spread.standard_error(DECISIVE) <= SD_PRECISION * spread.sd * 1.05).all()
    fixed = line_spread(total, UNIFORMS, samples=64, seed=seed)
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
        (lambda a, b: np.floor(a + b), "the output has steps or dips between the points looked at"),
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
