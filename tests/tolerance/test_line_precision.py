"""How many lines a row needs: their number, when it is enough, and what is told where it is not."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.tolerance.engine.line_points import LINE_REPLICATES
from flexlash.tolerance.engine.line_precision import (
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

thorough = settings(deadline=None, max_examples=100, derandomize=True)


def decided(excess, *, lines=FEWEST_LINES, share=None, relative=0.0, limited=None, scale=2.0):
    """Return the lines needed and the margin of a row whose errors are so many times those wanted."""
    errors = np.array([[0.3], [1.0], [0.7], [0.0], [0.9]]) * excess * SD_PRECISION * scale
    decisive = SimpleNamespace(output_error=errors)
    over = None
    if share is not None:
        error = np.array([[relative * PROBABILITY_PRECISION * min(share, 1 - share)]])
        over = SimpleNamespace(above=np.array([[share]]), above_error=error, blunt=np.zeros((1, 1)))
    row = SimpleNamespace(lines=lines, scale=np.array([scale]))
    (needed,), (margin,) = lines_needed(row, decisive, over, limited)
    return int(needed), float(margin)


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
    needed, margin = decided(0.0)
    assert (needed, margin) == (FEWEST_LINES, 1.0)
    needed, margin = decided(0.1)
    assert needed == FEWEST_LINES
    assert 1 < margin < 1.01


def test_barely_precise_lines_are_not_enough():
    """An error that is just within what is wanted gains a margin, and with it is not enough."""
    needed, margin = decided(0.99)
    assert needed == 2 * FEWEST_LINES
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
    needed, margin = decided(excess, lines=lines)
    assert lines <= needed <= MOST_LINES
    assert needed & (needed - 1) == 0
    assert 1 <= margin <= 1.3
    assert (needed > lines) == (excess * margin > 1)


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
    decisive = SimpleNamespace(output_error=np.array([[0.0, 3e-3, 30.0]]))
    row = SimpleNamespace(lines=64, scale=np.array([1.0, 1.0, 1.0]))
    needed, margin = lines_needed(row, decisive)
    assert needed.tolist() == [64, 512, MOST_LINES]
    assert margin[0] == 1
    assert margin[1] > 1


def test_unresolved_rows_are_told():
    """A row is unresolved where any of its crossings is off by more than the standard error wanted."""
    lines = SimpleNamespace(scale=np.array([1.0, 1.0, 100.0]))
    residual = np.array([[0.0, 2 * SD_PRECISION, 2 * SD_PRECISION], [0.5 * SD_PRECISION, 0.0, 0.0]])
    assert unresolved(lines, SimpleNamespace(residual=residual)).tolist() == [False, True, False]


def test_missed_precision_is_told():
    """A row whose decisive quantiles miss the precision wanted says by how much, others say nothing."""
    decisive = SimpleNamespace(output_error=np.array([[0.5e-3, 1e-3, 0.0], [1e-3, 0.0123, 0.0]]))
    notes = precision_notes(decisive, np.array([1.0, 2.0, 0.0]))
    assert notes == ["", "standard errors reach 0.0062 standard deviations, 0.001 was wanted", ""]


@pytest.mark.parametrize("bounds", [(), (3e-6,), (2e-5,)], ids=str)
def test_what_more_lines_hardly_remove_counts_where_a_verdict_hangs_on_it(bounds):
    """The blunt part of an error of 50 % asks for lines only where the interval has a bound on both sides."""
    share, error = 2e-6, 1e-6
    over = SimpleNamespace(
        above=np.array([[share]]), above_error=np.array([[error]]), blunt=np.array([[0.999 * error]])
    )
    decisive = SimpleNamespace(output_error=np.zeros((5, 1)))
    row = SimpleNamespace(lines=FEWEST_LINES, scale=np.ones(1))
    (needed,), _ = lines_needed(row, decisive, over, None, bounds)
    assert needed == (FEWEST_LINES * 32 if bounds == (3e-6,) else FEWEST_LINES)
