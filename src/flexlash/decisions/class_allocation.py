"""The widest tolerances of one class that keep all of its variants within their limits, at least relative cost."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.special import ndtri

from flexlash.decisions.changed_rows import limits_as_submitted, over_limit, toleranced
from flexlash.decisions.class_widths import ClassWidth, Member
from flexlash.decisions.lever import Terms
from flexlash.decisions.tolerance_widths import grades_finer, with_widths
from flexlash.decisions.width_programme import Cuts, cheapest
from flexlash.schema.arrays import Array
from flexlash.schema.spellings import plain
from flexlash.tolerance.row_batches import TolerancedRow

__all__ = ["Allocation", "allocated", "cost_of"]

_TOGETHER = 24
"""Variants that are looked at first, and whose slopes are drawn; those that their answer does not keep join them."""

_ROUNDS, _REPAIRS = 8, 12
"""Most times that slopes are drawn anew, and that room is taken back from what was drawn."""

_STEP = 1.2
"""Times the square of a factor across which a slope is drawn."""

_SETTLED = 1e-4
"""Change of the logarithm of a factor below which slopes need not be drawn anew."""

_FAR = 0.2
"""Share over the limit from which a variant is too far from its target for its slopes to say anything of it."""

_TIGHT = 0.03
"""Part of the room that a variant at its limit may have left, since drawings have steps."""

_REFUSED = frozenset({"impossible", "untabulated"})
"""Problems of limits for which a submission is not computed."""

_LEAST_COST = 1e-3
"""Part of the dearest cost per grade that a tolerance costs at least, so that none is narrowed for nothing."""


@dataclass(frozen=True, kw_only=True)
class Allocation:
    """What a class may have: a value for each of its widths, None where no width keeps any of its variants.

    `helpless` are the places of variants that not even the narrowest widths keep within, `tight` of those that are at
    their limit. `over` is the share over the limit of each variant with the values, of helpless ones with the narrowest
    widths. `equal` is the factor at which all widths alike keep the others, None where none does.
    """

    values: tuple[float, ...] | None
    over: tuple[float, ...]
    helpless: tuple[int, ...] = ()
    tight: tuple[int, ...] = ()
    equal: float | None = None


def allocated(widths: Sequence[ClassWidth], members: Sequence[Member], terms: Terms) -> Allocation:
    """Return the allocation of a class, whose variants come nearest to their limit first.

    Squares of factors are looked for on straight bounds through the engine's shares over the limit, drawn anew where
    the last answer lies; then rounded to the drawing's steps one after the other, the coarsest first, and proven with
    the rows that a submission would have. Room that a variant lacks then is taken from it, and the rest looked for
    again.
    """
    least = [member.over for member in members]
    hopeful = [place for place, member in enumerate(members) if not member.is_hopeless]
    every = _Search(widths, [members[place] for place in hopeful], terms)
    narrowest = every.over(np.log([width.least for width in widths])) if hopeful else []
    for place, share in zip(hopeful, narrowest, strict=True):
        least[place] = share
    helpless = tuple(place for place, share in enumerate(least) if share > terms.target)
    helped = [place for place in range(len(members)) if place not in helpless]
    all_helped = _Search(widths, [members[place] for place in helped], terms)
    working = helped[:_TOGETHER]
    for _ in range(_REPAIRS):
        found = _Search(widths, [members[place] for place in working], terms).found() if working else None
        if found is None:
            break
        shares = dict(zip(helped, all_helped.proven(found.values), strict=True))
        lacking = [place for place, share in shares.items() if share > terms.target]
        if not lacking:
            wanted = (1 - _TIGHT) * _inverse_square(terms.target)
            tight = tuple(place for place, share in shares.items() if _inverse_square(share) >= wanted)
            over = tuple(shares.get(place, least[place]) for place in range(len(members)))
            return Allocation(values=found.values, over=over, helpless=helpless, tight=tight, equal=found.equal)
        working = [*working, *sorted(lacking, key=lambda place: -shares[place])[:_TOGETHER]]
    return Allocation(values=None, over=tuple(least), helpless=helpless)


class _Found(NamedTuple):
    """Values of widths, and the factor at which all alike would do."""

    values: tuple[float, ...]
    equal: float


class _Search:
    """The search for the factors of some widths with which variants keep their limits."""

    def __init__(self, widths: Sequence[ClassWidth], members: Sequence[Member], terms: Terms) -> None:
        self._widths, self._members, self._terms = widths, members, terms
        self._names = [width.dimension for width in widths]
        self._bounds = [(math.log(width.least), math.log(width.most)) for width in widths]
        costs = np.array([width.cost for width in widths])
        self._costs = np.maximum(costs, _LEAST_COST * max(costs.max(), _LEAST_COST))
        self._wanted = _inverse_square(terms.target)

    def over(self, logs: Array, places: Sequence[int] | None = None) -> list[float]:
        """Return the shares over the limit of variants with these factors."""
        chosen = range(len(self._members)) if places is None else places
        rows = [self._row(self._members[place], logs) for place in chosen]
        return over_limit(rows, self._terms, by_lines=True)

    def _row(self, one: Member, logs: Array) -> TolerancedRow:
        factors = {
            name: math.exp(log) for name, log in zip(self._names, logs, strict=True) if log and name in one.limits
        }
        return toleranced(one.variant, with_widths(one.variant, one.limits, factors), one.limit, self._terms)

    def proven(self, values: Sequence[float]) -> list[float]:
        """Return the shares over the limit of variants of a submission whose class has these values."""
        owner = plain(self._members[0].variant.tolerance_class)
        changed = {
            width.dimension: width.changed(value)
            for width, value in zip(self._widths, values, strict=True)
            if not width.fixed and value != width.value
        }
        rows = [changed.get(row.dimension, row) for row in self._terms.classes[owner]]
        terms = replace(self._terms, classes={**self._terms.classes, owner: rows})
        over, parts = [1.0] * len(self._members), dict[int, TolerancedRow]()
        for place, one in enumerate(self._members):
            limits, problems = limits_as_submitted(one.variant, terms)
            # What a submission refuses keeps no limit.
            if not any(problem.kind in _REFUSED for problem in problems):
                parts[place] = toleranced(one.variant, limits, one.limit, terms)
        for place, share in zip(parts, over_limit(list(parts.values()), self._terms), strict=True):
            over[place] = share
        return over

    def found(self) -> _Found | None:
        """Return the values, and the factor at which all widths alike keep the variants; None where none was found."""
        equal = self._equal()
        _, cuts, places = self._settled(np.clip(equal, *np.array(self._bounds).T))
        for _ in range(_REPAIRS):
            values = self._drawn(cuts)
            if values is None:
                return None
            over = self.proven(values)
            lacking = {place: share for place, share in enumerate(over) if share > self._terms.target}
            if not lacking:
                return _Found(values, math.exp(equal))
            drawn = np.log([width.factor(value) for width, value in zip(self._widths, values, strict=True)])
            cuts, places = self._with_less_room(cuts, places, drawn, lacking)
        return None

    def _equal(self) -> float:
        """Return the logarithm of the greatest factor at which all widths alike keep every variant."""
        low, high = min(low for low, _ in self._bounds), max(high for _, high in self._bounds)
        ends = np.array(self._bounds).T
        near, far = low, high
        if max(self.over(np.clip(high, *ends))) <= self._terms.target:
            return high
        # Halving with all variants alike costs little: what is wanted is a start, and what equal widths would cost.
        for _ in range(14):
            middle = (near + far) / 2
            keeps = max(self.over(np.full(len(self._widths), middle).clip(*ends))) <= self._terms.target
            near, far = (middle, far) if keeps else (near, middle)
        return near

    def _settled(self, logs: Array) -> tuple[Array, Cuts, list[int]]:
        """Return the logarithms of the factors that cost least by slopes drawn there, and these slopes."""
        for turn in range(_ROUNDS):
            cuts, places = self._cuts(logs)
            wanted = cheapest(self._costs, cuts, self._bounds)
            if wanted is None:
                break
            moved, part = wanted, 1.0
            while max(self.over(moved)) > _FAR:
                part /= 2
                moved = logs + part * (wanted - logs)
            change = float(np.abs(moved - logs).max())
            logs = moved
            if change <= _SETTLED and turn:
                break
        return logs, cuts, places

    def _cuts(self, logs: Array) -> tuple[Cuts, list[int]]:
        """Return straight bounds through the shares over the limit of the variants that are nearest to it."""
        shares = np.array(self.over(logs))
        nearest = np.argsort(-shares, kind="stable")[:_TOGETHER]
        places = sorted(int(place) for place in nearest)
        squares = np.exp(2 * logs)
        now = np.array([_inverse_square(shares[place]) for place in places])
        slopes = np.zeros((len(places), len(logs)))
        for index in range(len(logs)):
            if self._bounds[index][0] == self._bounds[index][1]:
                continue
            further = logs.copy()
            further[index] += math.log(_STEP) / 2
            moved = np.array([_inverse_square(share) for share in self.over(further, places)])
            slopes[:, index] = np.maximum(moved - now, 0.0) / (squares[index] * (_STEP - 1))
        room = self._wanted - now + np.einsum("ij,j->i", slopes, squares)
        return Cuts(slopes=slopes, room=room), places

    def _with_less_room(
        self, cuts: Cuts, places: list[int], drawn: Array, lacking: Mapping[int, float]
    ) -> tuple[Cuts, list[int]]:
        """Return bounds that take from each variant the room that it lacks, drawn anew where it had none."""
        if not set(lacking) <= set(places):
            return self._cuts(drawn)
        room, used = cuts.room.copy(), np.einsum("ij,j->i", cuts.slopes, np.exp(2 * drawn))
        for place, share in lacking.items():
            index = places.index(place)
            excess = _inverse_square(share) - self._wanted
            room[index] = min(room[index], used[index]) - 1.02 * excess - 1e-9 * self._wanted
        return replace(cuts, room=room), places

    def _drawn(self, cuts: Cuts) -> tuple[float, ...] | None:
        """Return values in steps of the drawing: the coarsest first, each the cheaper of its two neighbours."""
        bounds = list(self._bounds)
        values = [width.value for width in self._widths]
        logs = cheapest(self._costs, cuts, bounds)
        if logs is None:
            return None
        open_ones = [index for index, (low, high) in enumerate(bounds) if low < high]
        while open_ones:
            steps = {one: self._coarseness(one, float(logs[one])) for one in open_ones}
            index = max(open_ones, key=lambda one: steps[one])
            open_ones.remove(index)
            best = self._rounded(index, logs, cuts, bounds)
            if best is None:
                return None
            values[index], logs = best
            bounds[index] = (float(logs[index]), float(logs[index]))
        return tuple(values)

    def _coarseness(self, index: int, log: float) -> float:
        """Return what a step of a width is beside it."""
        width = self._widths[index]
        return 1.0 if width.kind == "grade" else width.step / (width.value * math.exp(log))

    def _rounded(
        self, index: int, logs: Array, cuts: Cuts, bounds: Sequence[tuple[float, float]]
    ) -> tuple[float, Array] | None:
        """Return the value of a width in whole steps with which all others cost least, and their logarithms."""
        width, best = self._widths[index], None
        low, high = self._bounds[index]
        for upwards in (False, True):
            value = width.drawn(math.exp(logs[index]), upwards=upwards)
            if value <= 0 or not low - 1e-9 <= (log := math.log(width.factor(value))) <= high + 1e-9:
                continue
            tried = [(log, log) if place == index else bound for place, bound in enumerate(bounds)]
            rest = cheapest(self._costs, cuts, tried)
            if rest is not None and (best is None or self._costs @ rest > self._costs @ best[1]):
                best = value, rest
        return best


def cost_of(width: ClassWidth, value: float) -> tuple[float, float]:
    """Return how many IT grades finer a value is, and what that costs: less than nothing where it is wider."""
    if width.fixed:
        return 0.0, 0.0
    grades = width.value - value if width.kind == "grade" else grades_finer(width.factor(value))
    return grades + 0.0, width.cost * grades + 0.0


def _inverse_square(over: float) -> float:
    """Return the inverse square of how many standard deviations a normal output stays below its limit."""
    return float(ndtri(min(over, _HALF))) ** -2 if over > 0 else 0.0


_HALF = 0.49
"""Greatest share over the limit that has an inverse square."""
