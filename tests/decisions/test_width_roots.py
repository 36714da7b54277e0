"""Searches for widths find the factor of a closed form in few questions, and stop where they may go no wider."""

from __future__ import annotations

import math

import pytest
from scipy.special import ndtr, ndtri

from flexlash.decisions.width_roots import narrowed, widened

ALLOWED = 0.00135


def _found(search, over_at):
    """Return the root of a search and how many questions it asked."""
    factor, asked = next(search), 0
    while True:
        asked += 1
        try:
            factor = search.send(over_at(factor))
        except StopIteration as end:
            return end.value, asked


def _normal(part, distance=3.5):
    """Return the share over a limit so many sd above the mean, where a tolerance has this part of the variance."""
    return lambda factor: float(ndtr(-distance / math.sqrt(1 + (factor**2 - 1) * part)))


@pytest.mark.parametrize("part", [0.9, 0.1, 1e-4])
@pytest.mark.parametrize("guess", [0.3, 1.0, 5.0])
def test_a_tolerance_grows_to_its_closed_form(part, guess):
    """Of a normal output the factor is that of its variance, whatever the first guess, in at most eight questions."""
    over, true = _normal(part), math.sqrt(1 + ((3.5 / ndtri(1 - ALLOWED)) ** 2 - 1) / part)
    root, asked = _found(widened(ALLOWED, over(1.0), 1 + guess * (true - 1), 1e9), over)
    assert root.factor == pytest.approx(true, rel=1e-7)
    assert not root.bounded
    assert asked <= 8


@pytest.mark.parametrize(("part", "distance"), [(0.9, 2.9), (0.9, 1.5), (0.5, 2.5), (0.99, 0.4)])
def test_a_tolerance_shrinks_to_its_closed_form(part, distance):
    """The same inwards, where a part of the variance, or nearly all of it, is that of the tolerance."""
    over, true = _normal(part, distance), math.sqrt(1 - (1 - (distance / ndtri(1 - ALLOWED)) ** 2) / part)
    root, asked = _found(narrowed(ALLOWED, over(1.0)), over)
    assert root.factor == pytest.approx(true, rel=1e-7)
    assert asked <= 8


def test_a_tolerance_shrinks_from_a_mean_over_the_limit():
    """Where the width moves the mean over the limit as it is, the root is found as well."""

    def over(factor):
        return float(ndtr((2 * factor - 1) / 0.2))

    root, _ = _found(narrowed(ALLOWED, over(1.0)), over)
    assert root.factor == pytest.approx((1 + 0.2 * float(ndtri(ALLOWED))) / 2, rel=1e-6)


def test_a_bounded_distribution_has_its_root():
    """A share that is 0 up to a width and then rises steeply has its root there."""

    def over(factor):
        return max(0.0, 1 - 2 / factor) / 2

    root, _ = _found(widened(ALLOWED, 0.0, 1.5, 100.0), over)
    assert root.factor == pytest.approx(2 / (1 - 2 * ALLOWED), rel=1e-6)


def test_a_search_ends_at_the_bound():
    """Where the widest that may be tried keeps the target, it is the answer, with what is over the limit there."""
    over = _normal(0.1)
    root, asked = _found(widened(ALLOWED, over(1.0), 50.0, 1.5), over)
    assert (root.factor, root.bounded, root.over, asked) == (1.5, True, over(1.5), 1)


def test_what_no_width_fixes_is_told():
    """Where the narrowest misses the target there is no factor, but what it leaves over the limit."""
    root, asked = _found(narrowed(ALLOWED, 0.4), lambda factor: 0.2 + 0.2 * factor)
    assert (root.factor, root.over, asked) == (None, 0.2, 1)


def test_a_width_between_two_that_miss_the_target_is_found():
    """Where the narrowest misses it, too, the best is looked for about a likely one, however far that is off."""

    def over(factor):
        return float(ndtr(-2.5 - 0.7 * (1 - ((factor - 0.4) / 0.3) ** 2)))

    true = 0.4 + 0.3 * math.sqrt(1 - (-ndtri(ALLOWED) - 2.5) / 0.7)
    for likely in (0.4, 0.3, 0.55, 0.9):
        root, _ = _found(narrowed(ALLOWED, over(1.0), likely), over)
        assert root.factor == pytest.approx(true, rel=1e-6), likely
    root, asked = _found(narrowed(ALLOWED / 1e3, over(1.0), 0.5), over)
    assert (root.factor, asked) == (None, 14)
    assert root.best == pytest.approx(0.4, abs=0.01)
    assert root.over == over(root.best)
