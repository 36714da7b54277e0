"""Sweeps: a variant over one or two of its dimensions, and the values at which its backlash crosses the limit."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise, product
from statistics import NormalDist
from typing import Any, NamedTuple

import polars as pl

from flexlash.analysis.options import Progress
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.results import empty_results
from flexlash.decisions.crossings import Bracket, Turn, crossings, past_turns
from flexlash.decisions.swept_points import point_levels, point_results
from flexlash.schema.decision_rows import SweepRow, SweptDimension
from flexlash.schema.result_columns import RESULTS
from flexlash.validation.replaced_rows import Replacement
from flexlash.validation.swept_variants import swept_variants

__all__ = [
    "_MARGINAL_PERCENT",
    "Crossing",
    "Study",
    "level_margin",
    "percentile_key",
    "sweep_levels",
    "sweep_table",
    "sweeps_of",
]

_MARGINAL_PERCENT = 97.5
"""Share of units in per cent within the limit from which on a variant is no failing one."""

_CAPABLE_PERCENT = 99.865
"""Share of units in per cent that lies below three standard deviations over the mean of a normal distribution."""

_SMALL = 1e-7
"""Part of the limit by which a backlash may miss it, or normal score by which a share may, to count as on it."""

_UNBOUNDED = 38.0
"""Normal score beyond which no share can be told from none or all."""


@dataclass(frozen=True, kw_only=True)
class Crossing:
    """A value of the first dimension, in the unit of its column, at which a level of the backlash is just the limit.

    `percent` of the units stay below that level; None stands for the nominal backlash. `second` is the value of the
    second dimension, None where there is none. `falls` says that greater values are within the limit, not smaller ones.
    """

    percent: float | None
    second: float | None = None
    value: float
    falls: bool


@dataclass(frozen=True, kw_only=True)
class Study:
    """A variant over the values of a sweep.

    `row` is that of the sheet Sweep, 0 for one that was asked for on the command line. `results` has one row a point,
    the values of the second dimension running first: the variant, the swept keys, and the columns of Results.
    `entered` are the variant's own values of the swept keys, None where the cell is blank. `limit` [arcmin] is the
    variant's, None where it has none; then there are no `crossings`.
    """

    row: int
    variant: str
    first: SweptDimension
    second: SweptDimension | None = None
    entered: Mapping[str, float | None] = field(default_factory=dict)
    limit: float | None = None
    results: pl.DataFrame
    crossings: Sequence[Crossing] = ()

    @property
    def keys(self) -> list[str]:
        """The swept columns of Variants."""
        return [one.key for one in (self.first, self.second) if one is not None]


class _Line(NamedTuple):
    """The points of a study along its first dimension, for one value of the second one."""

    study: int
    second: float | None
    level: float | None


def sweeps_of(outcome: Outcome, progress: Progress | None = None) -> list[Study]:
    """Return the studies that a submission asks for: one for each row of Sweep and each variant that it is about.

    Variants that have no such dimension, or are not computed, have none. `progress` is told of the points.
    """
    validated = outcome.validated
    if validated is None or validated.table is None:
        return []
    asked = [
        (sweep, row, name) for sweep in validated.sweeps for row, name in swept_variants(validated, sweep).variants
    ]
    if not asked:
        return []
    points = [_points(sweep, row) for sweep, row, _ in asked]
    results = point_results(outcome, [point for some in points for point in some], progress)
    entered = validated.table.frame
    studies, start = [], 0
    for (sweep, row, name), some in zip(asked, points, strict=True):
        keys = list(some[0].values)
        own = entered.filter(pl.col("row") == row).row(0, named=True)
        part = results[start : start + len(some)]
        swept = [pl.Series(key, [point.values[key] for point in some], dtype=pl.Float64) for key in keys]
        studies.append(
            Study(
                row=sweep.row,
                variant=name,
                first=sweep.first,
                second=sweep.second,
                entered={key: own[key] for key in keys},
                limit=own["backlash_limit_arcmin"],
                results=pl.DataFrame([part["variant"], *swept]).hstack(part.drop("variant")),
            )
        )
        start += len(some)
    return _with_crossings(outcome, studies, [row for _, row, _ in asked])


def sweep_table(studies: Sequence[Study]) -> pl.DataFrame:
    """Return all points as the Sweep table: variant, every swept key, the columns of Results.

    A key is blank in the points of a study that does not sweep it.
    """
    keys = list(dict.fromkeys(key for study in studies for key in study.keys))
    results = empty_results()
    numbers = pl.DataFrame(schema=dict.fromkeys(keys, pl.Float64()))
    empty = pl.concat([results.select("variant"), numbers, results.drop("variant")], how="horizontal")
    return pl.concat([empty, *(study.results for study in studies)], how="diagonal_relaxed")


def sweep_levels(target: float) -> list[float | None]:
    """Return the levels whose crossings are told: the nominal backlash, then shares of units in per cent, rising.

    >>> sweep_levels(99.865), sweep_levels(99)
    ([None, 97.5, 99.865], [None, 97.5, 99, 99.865])
    """
    return [None, *sorted({_MARGINAL_PERCENT, target, _CAPABLE_PERCENT})]


def percentile_key(percent: float | None) -> str | None:
    """Return the key of Results that holds a level, None where no column does.

    >>> percentile_key(None), percentile_key(97.5), percentile_key(99.9)
    ('backlash_arcmin', 'p97_5_arcmin', None)
    """
    if percent is None:
        return "backlash_arcmin"
    key = f"p{percent:.10g}_arcmin".replace(".", "_")
    return key if key in _RESULTS else None


_RESULTS = frozenset(column.key for column in RESULTS)


def _points(sweep: SweepRow, row: int) -> list[Replacement]:
    """Return the points of a study of the variant in a row of Variants."""
    dimensions = [one for one in (sweep.first, sweep.second) if one is not None]
    keys = [one.key for one in dimensions]
    return [
        Replacement(row=row, values=dict(zip(keys, values, strict=True)))
        for values in product(*(one.values for one in dimensions))
    ]


def _with_crossings(outcome: Outcome, studies: Sequence[Study], rows: Sequence[int]) -> list[Study]:
    """Return the studies, whose variants stand in these rows of Variants, with their crossings."""
    levels = sweep_levels(outcome.settings.target_percent)
    keys = [*filter(None, map(percentile_key, levels)), "probability_over_limit"]
    brackets = [
        bracket
        for number, study in enumerate(studies)
        for level in levels
        for bracket in _brackets(number, study, level)
    ]

    def margins(asked: Sequence[tuple[_Line, float]]) -> list[float | None]:
        points = []
        for line, value in asked:
            first, second = studies[line.study].first, studies[line.study].second
            beside = {} if second is None or line.second is None else {second.key: line.second}
            points.append(Replacement(row=rows[line.study], values={first.key: value} | beside))
        found = point_levels(outcome, points, keys).iter_rows(named=True)
        return [level_margin(result, line.level) for result, (line, _) in zip(found, asked, strict=True)]

    found: dict[int, list[Crossing]] = {number: [] for number in range(len(studies))}
    turns = [turn for number, study in enumerate(studies) for level in levels for turn in _turns(number, study, level)]
    brackets += past_turns(turns, margins)
    for bracket, value in zip(brackets, crossings(brackets, margins, _SMALL), strict=True):
        if value is not None:
            line = bracket.whose
            falls = (bracket.at_low > 0) == (bracket.low < bracket.high)
            found[line.study].append(Crossing(percent=line.level, second=line.second, value=value, falls=falls))
    return [replace(study, crossings=_in_order(study, found[number], levels)) for number, study in enumerate(studies)]


def _in_order(study: Study, found: Sequence[Crossing], levels: Sequence[float | None]) -> tuple[Crossing, ...]:
    """Return crossings level by level, by the second dimension, along the first one."""
    seconds = list(dict.fromkeys(study.second.values if study.second else (None,)))
    way = -1 if study.first.values[0] > study.first.values[-1] else 1
    return tuple(sorted(found, key=lambda one: (levels.index(one.percent), seconds.index(one.second), way * one.value)))


def _brackets(number: int, study: Study, level: float | None) -> Iterator[Bracket[_Line]]:
    """Yield neighbouring points of a study between which a level crosses the limit."""
    for beside, line in _lines(study, level):
        for (low, at_low), (high, at_high) in pairwise(line):
            if at_low is not None and at_high is not None and (at_low > 0) != (at_high > 0):
                whose = _Line(number, beside, level)
                yield Bracket(whose=whose, low=low, high=high, at_low=at_low, at_high=at_high)


def _turns(number: int, study: Study, level: float | None) -> Iterator[Turn[_Line]]:
    """Yield three neighbouring points of a study on one side of the limit, whose middle one is nearest to it."""
    for beside, line in _lines(study, level):
        for three in zip(line, line[1:], line[2:], strict=False):
            first, middle, last = (margin for _, margin in three)
            if first is None or middle is None or last is None:
                continue
            near, far = sorted((abs(first), abs(last)))
            if (first > 0) == (middle > 0) == (last > 0) and abs(middle) <= near and abs(middle) < far:
                low, between, high = (value for value, _ in three)
                whose = _Line(number, beside, level)
                yield Turn(whose=whose, values=(low, between, high), numbers=(first, middle, last))


def _lines(study: Study, level: float | None) -> Iterator[tuple[float | None, list[tuple[float, float | None]]]]:
    """Yield each value of the second dimension, with the points along the first one as values and margins."""
    second = None if study.second is None else study.second.key
    lines: dict[float | None, list[tuple[float, float | None]]] = {}
    for result in study.results.iter_rows(named=True):
        beside = None if second is None else result[second]
        lines.setdefault(beside, []).append((result[study.first.key], level_margin(result, level)))
    yield from lines.items()


def level_margin(result: Mapping[str, Any], level: float | None) -> float | None:
    """Return by how much a level of a row of Results is over the limit, as a part of that; None without either.

    Of a share of units whose backlash is not among Results it is how far the normal score of the share over the limit
    lies above the one that is allowed.
    """
    limit = result["backlash_limit_arcmin"]
    if limit is None:
        return None
    if (key := percentile_key(level)) is not None:
        value = result[key]
        return None if value is None else (value - limit) / (limit or 1.0)
    over = result["probability_over_limit"]
    if over is None or level is None:
        return None
    return _score(over) - _score(1 - level / 100)


def _score(share: float) -> float:
    """Return the normal score of a share, a great number where it is none or all."""
    if 0 < share < 1:
        return NormalDist().inv_cdf(share)
    return math.copysign(_UNBOUNDED, share - 0.5)
