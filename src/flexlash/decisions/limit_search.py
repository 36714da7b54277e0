"""The value of a changed dimension at which just the target share of units is over the limit, and its drawing value.

The prediction of `predicted_scores` says where to look; the engine then says which share is over the limit there and at
the drawing value. Between two such points the scores rise in proportion to the levels of Φ, which tells the value to
some parts in ten million. What does not yield to that, a grade that jumps or a tail that ends, is found between a value
on each side of the target, on the engine alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import ndtri

from flexlash.decisions.changed_rows import limits_as_submitted, run_plan, toleranced
from flexlash.decisions.changes import with_sizes
from flexlash.decisions.crossings import Bracket, closed
from flexlash.decisions.known_tail import Tail
from flexlash.decisions.lever import Present, Terms
from flexlash.decisions.predicted_scores import ChangedAlike
from flexlash.schema.arrays import Array
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.units import as_entered
from flexlash.schema.variant_arrays import Indices
from flexlash.tolerance.row_probabilities import OverLimits, probabilities_over

__all__ = ["LimitSearch", "Solution"]

Bools = npt.NDArray[np.bool_]
Rounded = Callable[[float, bool], float]
"""The drawing value next to a value, upwards or downwards, both in the unit of the column."""

_RAREST = 1e-15
_ROUNDS, _MORE_STEPS = 5, 3

_ON_TARGET = 1e-9
"""Distance from the target, in levels of Φ, that counts as none."""

_INTERVAL = 2 * 1.96
"""Standard errors that an interval spans."""

_TOLD, _GUESSED = 8e-2, 0.3
"""Part of the way to the target that a step may miss, with a slope that two points tell or the tail as it is now."""

_NEAR, _NEARER = (1e-5, 3e-4), (1e-6, 3e-4)
"""Least and greatest distance from the target, in levels of Φ, from which such a step may be the last; between these
it is what misses the target by no more than its standard error."""

_OUTWARDS = tuple((step / 12) ** 2 for step in range(1, 13))
"""Parts of the way to the ends at which the engine looks where a prediction went astray."""

_APART = 0.05
"""How far apart two points must be, in levels of Φ, to tell a slope."""

_SLOPES = (0.5, 2.0)
"""Between which parts of the expected slope a told one is believed."""

_SAME = 1e-9
"""Part of a value by which it no longer moves."""


@dataclass(frozen=True, kw_only=True)
class Solution:
    """What was found of each variant: arrays (variants,), NaN where there is nothing.

    `value` [SI] meets the target just so; `drawing` is its drawing value in the unit of the column, NaN where no
    multiple of the step beside it serves. Where no value was found, `extreme` [SI] is the best there is, or the worst,
    which still meets the limit. `over` is the share over the limit with the drawing value, or at the extreme.
    """

    value: Array
    drawing: Array
    extreme: Array
    over: Array


class LimitSearch:
    """The search for one change of some variants alike; the engine says which share is over the limit.

    `tail` is as of `tail_of`.
    """

    def __init__(self, alike: ChangedAlike, presents: Sequence[Present], terms: Terms, tail: Tail) -> None:
        self._alike = alike
        self._presents = presents
        self._terms = terms
        self._tail = tail
        self._unit = DIMENSIONS[alike.change.dimension].si_unit.si
        self._wanted = np.array([present.direction(terms.target) == "meet" for present in presents])
        self._target = terms.level
        self._crossing = alike.crossing(tail.score, wanted=self._wanted)

    def solution(self, rounded: Rounded) -> Solution:
        """Return what is found, with drawing values as `rounded` returns them."""
        count = len(self._presents)
        found = {name: np.full(count, np.nan) for name in ("value", "drawing", "extreme", "over")}
        has = np.isfinite(self._crossing.value)
        unsettled = self._refine(np.flatnonzero(has), found, rounded)
        missing = np.flatnonzero(~has)
        ends = self._alike.take(missing).extreme(highest=self._wanted[missing]) if len(missing) else np.empty(0)
        over = self._shares(missing, ends)
        found["extreme"][missing], found["over"][missing] = ends, over
        unpredicted = missing[self._crossed(missing, over)]
        beyond = self._crossing.beyond.copy()
        beyond[unpredicted] = found["extreme"][unpredicted]
        halved = np.concatenate([unsettled, unpredicted])
        self._halve(halved, beyond, found, rounded)
        self._make_safe(np.flatnonzero(np.isfinite(found["value"])), found, rounded)
        return Solution(**found)

    def _crossed(self, rows: Indices, over: Array) -> Bools:
        """Return where shares over the limit are on the other side of the target than they are now; NaN is on none."""
        return np.where(self._wanted[rows], over <= self._terms.target, over > self._terms.target)

    def _shares(self, rows: Indices, values: Array, *, by_lines: bool = True) -> Array:
        """Return the shares over the limit of some variants with values [SI]; NaN where these make no part."""
        return self._spread(rows, values, by_lines=by_lines).probability

    def _spread(self, rows: Indices, values: Array, *, by_lines: bool = True) -> OverLimits:
        """Return the same with their intervals."""
        over = OverLimits(*np.full((3, len(rows)), np.nan))
        plan, own = run_plan(self._terms, by_lines=by_lines), self._alike.take(rows)
        fine = own.makes_a_part(values[:, None])[:, 0]
        if plan.method == "line":
            over = own.over_limit(values, plan)
        left = np.flatnonzero(fine & np.isnan(over.probability))
        spread, places = [], []
        for place in left.tolist():
            present = self._presents[rows[place]]
            changed = with_sizes(
                present.variant, self._alike.change.sizes(present.variant.dimensions, float(values[place]))
            )
            limits, problems = limits_as_submitted(changed, self._terms)
            if not any(problem.kind in {"impossible", "untabulated"} for problem in problems):
                spread.append(toleranced(changed, limits, present.limit, self._terms))
                places.append(place)
        for place, one in zip(places, probabilities_over(spread, plan), strict=True):
            for every, number in zip(over, one, strict=True):
                every[place] = number
        return over

    def _levels(self, over: Array) -> Array:
        """Return the levels of Φ of shares over the limit."""
        return np.asarray(ndtri(np.clip(1 - over, _RAREST, 1 - _RAREST)))

    def _refine(self, rows: Indices, found: dict[str, Array], rounded: Rounded) -> Indices:
        """Put down what is found from the predicted values on, and return the variants of which it is not."""
        values, drawings, shares = self._crossing.value.copy(), found["drawing"].copy(), found["over"].copy()
        for _ in range(_ROUNDS):
            if not len(rows):
                break
            own, first, rise = self._alike.take(rows), values[rows], self._tail.rise[rows]
            level, highest, lowest = (self._levels(one) for one in self._spread(rows, first))
            score, missing = own.score(first), self._target - level
            drawing = self._drawn(rows, own.value_at(first, score + missing * rise), rounded)
            new = np.flatnonzero(drawing != drawings[rows])
            drawings[rows] = drawing
            shares[rows[new]] = self._shares(rows[new], drawing[new] * self._unit, by_lines=False)
            slope, told = self._slope(rows, level, score, drawing, shares[rows])
            value = own.value_at(first, score + missing * slope)
            error = (highest - lowest) / _INTERVAL
            near = np.abs(missing) <= np.where(
                told, np.clip(error / _TOLD, *_NEAR), np.clip(error / _GUESSED, *_NEARER)
            )
            near |= np.abs(value - first) <= _SAME * np.abs(first)
            settled = near & (self._drawn(rows, value, rounded) == drawing)
            done = rows[settled]
            found["value"][done], found["drawing"][done] = value[settled], drawing[settled]
            found["over"][done] = shares[done]
            values[rows] = value
            rows = rows[~settled & np.isfinite(value)]
        return np.flatnonzero(np.isfinite(self._crossing.value) & np.isnan(found["value"]))

    def _slope(self, rows: Indices, level: Array, score: Array, drawing: Array, over: Array) -> tuple[Array, Bools]:
        """Return how scores rise with levels from these on to the target, and whether the drawing values tell it."""
        own, rise, drawn = self._alike.take(rows), self._tail.rise[rows], self._levels(over)
        with np.errstate(all="ignore"):
            apart = drawn - level
            slope = (own.score(drawing * self._unit) - score) / apart + self._tail.bend[rows] * (self._target - drawn)
            told = (np.abs(apart) > _APART) & (slope > _SLOPES[0] * rise) & (slope < _SLOPES[1] * rise)
            told &= (over > _RAREST) & (over < 1 - _RAREST) & (self._terms.plan.method == "line")
        return np.where(told, slope, rise), told

    def _halve(self, rows: Indices, beyond: Array, found: dict[str, Array], rounded: Rounded) -> None:
        """Put down what is found between the present values and some beyond the target."""
        if not len(rows):
            return
        near, far = self._alike.present[rows].copy(), beyond[rows]
        over = self._shares(rows, far)
        reached = self._crossed(rows, over)
        astray = np.flatnonzero(~reached)
        far[astray], over[astray] = self._looked_for(rows[astray], far[astray], over[astray])
        reached = self._crossed(rows, over)
        value = np.full(len(rows), np.nan)
        value[reached] = self._closed(rows[reached], near[reached], far[reached], over[reached])
        drawing = self._drawn(rows, value, rounded)
        shares = self._shares(rows, drawing * self._unit, by_lines=False)
        for name, numbers in (("value", value), ("drawing", drawing), ("over", shares)):
            found[name][rows[reached]] = numbers[reached]
        missed = rows[~reached]
        found["extreme"][missed], found["over"][missed] = far[~reached], over[~reached]

    def _closed(self, rows: Indices, near: Array, far: Array, over: Array) -> Array:
        """Return where the target is met just so between values [SI] on its two sides, on the safe one where it jumps.

        `over` are the shares at the far values.
        """

        def distances(asked: Sequence[tuple[int, float]]) -> list[float | None]:
            own, values = np.array([row for row, _ in asked]), np.array([value for _, value in asked])
            shares = self._shares(own, values)
            levels = self._levels(shares) - self._target
            # What makes no part is as far from the target as can be, on the side of the present value.
            lost = np.where(self._wanted[own], -np.inf, np.inf)
            return [*np.where(np.isnan(shares), lost, levels).tolist()]

        present = np.array([self._presents[row].over for row in rows])
        ends = zip(
            near.tolist(), far.tolist(), *(self._levels(one) - self._target for one in (present, over)), strict=True
        )
        brackets = [
            Bracket(whose=row, low=low, high=high, at_low=float(at_low), at_high=float(at_high))
            for row, (low, high, at_low, at_high) in zip(rows.tolist(), ends, strict=True)
        ]
        found = closed(brackets, distances, _ON_TARGET)
        return np.array([
            np.nan if one is None
            else one.nearer if min(abs(one.at_low), abs(one.at_high)) <= _ON_TARGET
            else one.high if self._wanted[one.whose] else one.low
            for one in found
        ])  # fmt: skip

    def _looked_for(self, rows: Indices, values: Array, over: Array) -> tuple[Array, Array]:
        """Return values [SI] beyond the target and their shares, as the engine finds them going outwards on both sides.

        A prediction that points the wrong way says nothing of the other one. Where no value is beyond the target, the
        best of those looked at, or the worst, is returned; it may be the given one.
        """
        best, share = values.copy(), over.copy()
        if not len(rows):
            return best, share
        present, ends = self._alike.present[rows], [end[rows] for end in self._alike.ends]
        open_ = np.arange(len(rows))
        for part in _OUTWARDS:
            for end in ends:
                tried = (present + part * (end - present))[open_]
                there = self._shares(rows[open_], tried)
                wanted, known = self._wanted[rows[open_]], share[open_]
                better = np.where(wanted, there < known, there > known) | (np.isnan(known) & ~np.isnan(there))
                best[open_[better]], share[open_[better]] = tried[better], there[better]
                open_ = open_[~self._crossed(rows[open_], share[open_])]
                if not len(open_):
                    return best, share
        return best, share

    def _drawn(self, rows: Indices, values: Array, rounded: Rounded, more: int = 0) -> Array:
        """Return the drawing values of values [SI] on their safe side, so many steps further; NaN of NaN.

        A value that may only be relaxed keeps at least what it is.
        """
        drawing = np.full(len(rows), np.nan)
        for place, (row, value) in enumerate(zip(rows.tolist(), values.tolist(), strict=True)):
            if not np.isfinite(value):
                continue
            present = float(self._alike.present[row])
            outwards = value > present
            upwards = outwards if self._wanted[row] else not outwards
            told = rounded(value / self._unit, upwards)
            for _ in range(more):
                told = rounded(told * (1 + (_SAME if upwards else -_SAME) * 10), upwards)
            entered = as_entered(present, self._unit)
            passed = told <= entered if outwards else told >= entered
            drawing[place] = entered if passed and not self._wanted[row] else told
        return drawing

    def _make_safe(self, rows: Indices, found: dict[str, Array], rounded: Rounded) -> None:
        """Go on by a step or some where the share with the drawing value is above the target after all."""
        for more in range(1, _MORE_STEPS + 1):
            rows = rows[~(found["over"][rows] <= self._terms.target)]
            if not len(rows):
                return
            found["drawing"][rows] = self._drawn(rows, found["value"][rows], rounded, more)
            found["over"][rows] = self._shares(rows, found["drawing"][rows] * self._unit, by_lines=False)
        still = rows[~(found["over"][rows] <= self._terms.target)]
        found["drawing"][still] = np.nan
