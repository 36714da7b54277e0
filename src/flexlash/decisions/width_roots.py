"""How wide tolerances may be: the factor of their widths at which the share over the limit is just the one allowed.

Each search asks for the share at one factor after the other; who drives many searches answers them together.
"""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass
from typing import TypeAlias

from scipy.special import ndtri

__all__ = ["Root", "Search", "narrowed", "widened"]

Search: TypeAlias = Generator[float, float, "Root"]
"""Asks for the share over the limit at a factor, and returns the root."""

_Point: TypeAlias = tuple[float, float]
"""A factor and the share over the limit there."""

_NEAR = 1e-5
"""Part of the share allowed from which the next secant leaves less than what numbers of lines differ by."""

_NARROW = 1e-9
"""Part of a factor down to which it is looked for."""

_HALF = 0.5
"""Share over the limit from which the middle of a normal output is over it."""

_MOST, _HALVED = 80, 5
"""Most questions of a search, of which every fifth halves what is left."""

_LOOKS = 6
"""Times that the halves beside the best factor are halved: to less than a hundredth of the width."""

_BEYOND = 1.05
"""How much further than the guess a first try goes that should end on the other side."""


@dataclass(frozen=True, kw_only=True)
class Root:
    """A factor of widths and the share over the limit there.

    `bounded` says that a wider tolerance was not to be tried: the target is still kept. Without a `factor` none keeps
    it, and `over` is the least that was found, `best` the factor there: 0 where the narrowest is best.
    """

    factor: float | None
    over: float
    bounded: bool = False
    best: float = 0.0


def widened(allowed: float, over: float, guess: float, farthest: float) -> Search:
    """Return how many times as wide tolerances may be, at most `farthest`, that keep the target as they are.

    Arguments: shares over the limit, `allowed` and `over` as it is; `guess` of the factor, above 1.
    """
    if farthest <= 1:
        return Root(factor=1.0, over=over, bounded=True)
    kept, at = (1.0, over), min(guess * _BEYOND, farthest)
    while True:
        found = yield at
        if found > allowed:
            return (yield from _between(allowed, kept, (at, found)))
        if at >= farthest:
            return Root(factor=farthest, over=found, bounded=True)
        kept, at = (at, found), min(2 * at, farthest)


def narrowed(allowed: float, over: float, likely: float = 0.0) -> Search:
    """Return how many times as wide tolerances may be, below 1, that miss the target as they are.

    Arguments: shares over the limit, `allowed` and `over` as it is; the factor that is `likely` the best. Where that is
        not 0, the narrowest need not be: scatter that takes that of others back, or a mean on the good side, goes with
        the width. The best is then looked for about the likely one.
    """
    missed = (1.0, over)
    best = (0.0, (yield 0.0))
    if best[1] > allowed and 0 < likely < 1:
        best = yield from _lowest(allowed, best, likely, missed)
    if best[1] > allowed:
        return Root(factor=None, over=best[1], best=best[0])
    return (yield from _between(allowed, best, missed))


def _lowest(allowed: float, narrowest: _Point, likely: float, missed: _Point) -> Generator[float, float, _Point]:
    """Return the factor with the least share over the limit found about a likely one, or the first that will do.

    Both halves beside the best one so far are halved in turn.
    """
    low, best, high = narrowest, (likely, (yield likely)), missed
    for _ in range(_LOOKS):
        if best[1] <= allowed:
            break
        below = ((low[0] + best[0]) / 2, (yield (low[0] + best[0]) / 2))
        above = ((best[0] + high[0]) / 2, (yield (best[0] + high[0]) / 2))
        order = [low, below, best, above, high]
        place = min(range(1, 4), key=lambda index: order[index][1])
        low, best, high = order[place - 1 : place + 2]
    return min(best, narrowest, key=lambda point: point[1])


def _between(allowed: float, kept: _Point, missed: _Point) -> Search:
    """Return the factor between one that keeps the target and a greater one that misses it.

    Secants are drawn where a normal output has straight lines: the inverse square of the distance to the limit, in
    standard deviations, over the square of the factor. The last one, from a share that is nearly the one allowed, is
    taken at its word.
    """
    before, last = kept, missed
    for question in range(_MOST):
        if missed[0] - kept[0] <= _NARROW * missed[0]:
            break
        at = _inside(kept, missed, _secant(allowed, before, last)) or _inside(
            kept, missed, _secant(allowed, kept, missed)
        )
        if abs(last[1] - allowed) <= _NEAR * allowed:
            return Root(factor=at or last[0], over=allowed)
        if at is None or question % _HALVED == _HALVED - 1:
            at = math.sqrt((kept[0] ** 2 + missed[0] ** 2) / 2)
        before, last = last, (at, (yield at))
        kept, missed = (last, missed) if last[1] <= allowed else (kept, last)
    return Root(factor=kept[0], over=kept[1])


def _inside(kept: _Point, missed: _Point, at: float | None) -> float | None:
    return at if at is not None and kept[0] < at < missed[0] else None


def _secant(allowed: float, one: _Point, other: _Point) -> float | None:
    """Return the factor where the straight line through two shares meets the one allowed; None where there is none."""
    (first, low), (second, high) = ((factor * factor, _inverse_square(over)) for factor, over in (one, other))
    if low == high or not math.isfinite(low + high):
        return None
    square = first + (_inverse_square(allowed) - low) * (second - first) / (high - low)
    return math.sqrt(square) if square > 0 else None


def _inverse_square(over: float) -> float:
    """Return the inverse square of how many standard deviations a normal output stays below its limit."""
    if over >= _HALF:
        return math.inf
    return float(ndtri(over)) ** -2 if over > 0 else 0.0
