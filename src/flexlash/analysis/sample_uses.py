"""Measured samples → what they tell of each dimension, within the limits of every class that uses them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import combinations, islice

from flexlash.analysis.computed import Computed
from flexlash.schema.column import Column
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.spellings import plain
from flexlash.schema.units import as_entered
from flexlash.schema.variant import Limits, MeasuredDimension
from flexlash.tolerance.sample_statistics import (
    FEWEST_FOR_SD,
    Capability,
    MeasuredCorrelation,
    SampleStatistics,
    capability,
    measured_correlation,
    sample_statistics,
)

__all__ = ["MOST_ROWS", "MeasuredPair", "SampleUse", "measured_pairs", "sample_uses"]

MOST_ROWS = 500
"""Most dimensions of samples, and most pairs of them, that are worked up; those that classes use come first."""

_SAME = 12
"""Digits of limits, in the unit of the dimension, by which those of two variants are the same."""


@dataclass(frozen=True, kw_only=True)
class SampleUse:
    """What a sample tells of a dimension, in the unit of the dimension's column, and where it is used.

    `statistics` is None of a single value. `low` and `high` are the limits of the class `used_by`, as deviations where
    these were measured, and `capability` that within them; None where no variant has them. `distribution` is what the
    class takes the parts for.
    """

    sample: str
    column: Column
    are_deviations: bool
    count: int
    least: float
    greatest: float
    statistics: SampleStatistics | None
    low: float | None = None
    high: float | None = None
    capability: Capability | None = None
    distribution: str = ""
    used_by: str = ""
    variants: int = 0


@dataclass(frozen=True, kw_only=True)
class MeasuredPair:
    """How two dimensions of a sample scatter together; `by_scores` where one of them is not taken as normal."""

    sample: str
    first: Column
    second: Column
    by_scores: bool
    correlation: MeasuredCorrelation


_Use = tuple[str, str, str, float, float, str, str]
"""Plain name of the sample, dimension, class, limits, distribution, and the class whose row it is."""


def sample_uses(
    measured: Mapping[str, Mapping[str, MeasuredDimension]], variants: Iterable[Computed]
) -> list[SampleUse]:
    """Return one row for each dimension of each sample and each pair of limits that variants have with it."""
    found = _used(variants)
    by_dimension: dict[tuple[str, str], list[_Use]] = {}
    for use in found:
        by_dimension.setdefault(use[:2], []).append(use)
    return [
        row
        for one in islice(_in_order(measured, by_dimension), MOST_ROWS)
        for row in _rows_of(one, by_dimension, found)
    ]


def measured_pairs(
    measured: Mapping[str, Mapping[str, MeasuredDimension]], variants: Iterable[Computed]
) -> list[MeasuredPair]:
    """Return the correlation of each two dimensions that one sample has of the same parts, of samples in use."""
    used = _used(variants)
    not_normal = {use[:2] for use in used if use[5] == "measured"}
    names = dict.fromkeys(name for name, *_ in used)
    return list(islice(_pairs(measured, names, not_normal), MOST_ROWS))


def _pairs(
    measured: Mapping[str, Mapping[str, MeasuredDimension]], names: Iterable[str], not_normal: set[tuple[str, str]]
) -> Iterator[MeasuredPair]:
    for name in names:
        for first, second in combinations((one for one in DIMENSIONS if one in measured.get(name, {})), 2):
            by_scores = not not_normal.isdisjoint({(name, first), (name, second)})
            ours, theirs = measured[name][first], measured[name][second]
            found = measured_correlation(ours, theirs, by_scores=by_scores)
            if found is not None:
                pair = {"first": DIMENSIONS[first], "second": DIMENSIONS[second]}
                yield MeasuredPair(sample=ours.sample, by_scores=by_scores, correlation=found, **pair)


def _used(variants: Iterable[Computed]) -> Counter[_Use]:
    """Return how many variants use a dimension of a sample within the same limits."""
    found: Counter[_Use] = Counter()
    for one in variants:
        rows = one.among.validated.classes[plain(one.variant.tolerance_class)]
        owner = {row.dimension: row.tolerance_class for row in rows if row.sample is not None}
        for name, limits in one.limits.items():
            if limits.sample is not None and name in owner:
                low, high = _ends(limits, limits.sample, one.variant.dimensions[name])
                place = (plain(limits.sample.sample), limits.sample.dimension, one.variant.tolerance_class)
                found[*place, low, high, limits.distribution, owner[name]] += 1
    return found


def _ends(limits: Limits, sample: MeasuredDimension, nominal: float) -> tuple[float, float]:
    """Return limits in the unit of the dimension, as deviations where these were measured."""
    origin, unit = nominal if sample.are_deviations else 0.0, DIMENSIONS[sample.dimension].si_unit.si
    low, high = (round((end - origin) / unit, _SAME) for end in (limits.low, limits.high))
    return low, high


def _in_order(
    measured: Mapping[str, Mapping[str, MeasuredDimension]], used: Mapping[tuple[str, str], object]
) -> Iterator[tuple[str, MeasuredDimension]]:
    """Yield every measured dimension behind the plain name of its sample, those in use first."""
    for in_use in (True, False):
        for name, dimensions in measured.items():
            for dimension in DIMENSIONS:
                if dimension in dimensions and ((name, dimension) in used) is in_use:
                    yield name, dimensions[dimension]


def _rows_of(
    one: tuple[str, MeasuredDimension], used: Mapping[tuple[str, str], list[_Use]], variants: Mapping[_Use, int]
) -> Iterator[SampleUse]:
    """Yield the rows of a dimension of a sample: one for each pair of limits, one where there are none."""
    name, measured = one
    column = DIMENSIONS[measured.dimension]
    values = [as_entered(value, column.si_unit.si) for value in measured.values]
    statistics = sample_statistics(values) if len(values) >= FEWEST_FOR_SD else None
    row = SampleUse(
        sample=measured.sample,
        column=column,
        are_deviations=measured.are_deviations,
        count=len(values),
        least=min(values),
        greatest=max(values),
        statistics=statistics,
    )
    uses = used.get((name, measured.dimension), [])
    if not uses:
        yield row
    for use in uses:
        *_, tolerance_class, low, high, distribution, owner = use
        inherited = "" if plain(owner) == plain(tolerance_class) else f", taken over from {owner}"
        yield replace(
            row,
            low=low,
            high=high,
            capability=capability(statistics, low, high) if statistics and low < high else None,
            distribution=distribution,
            used_by=f"class {tolerance_class}{inherited}",
            variants=variants[use],
        )
