"""Computed variants → their tolerance spread; the drawn ones among them → their whole distribution."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from flexlash.analysis.computed import Computed, Spread
from flexlash.analysis.options import Options
from flexlash.mechanics.flexspline import backlash
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import Settings
from flexlash.tolerance.distribution_curves import Curve, curve_of
from flexlash.tolerance.row_batches import TolerancedRow, batch_statistics, batches_alike
from flexlash.tolerance.sampling import SamplingPlan
from flexlash.tolerance.spread_statistics import SpreadStatistics
from flexlash.workers import mapped

__all__ = ["drawn_curves", "row_curves", "row_statistics", "spread_of"]

_MODELS = {kind: partial(backlash, kind) for kind in ("cup", "hat", "cylinder")}

ROWS_PER_WORKER, POINTS_PER_WORKER = 1000, 100_000
"""Rows to be spread, lines or points of curves, below which starting a worker costs more than it saves."""


def spread_of(computed: Mapping[int, Computed], settings: Settings, options: Options) -> Spread:
    """Return the spread of the variants; the same points serve all rows."""
    steps = len(computed) * (2 if options.elasticity else 1)
    numbers, rows = list(computed), [_toleranced(variant) for variant in computed.values()]
    found: dict[int, SpreadStatistics] = {}
    for done, (index, statistics) in enumerate(row_statistics(rows, _plan(settings, options), options.jobs), start=1):
        found[numbers[index]] = statistics
        if options.progress:
            options.progress(done, steps)
    return Spread(statistics=found, cross_checked=bool(options.cross_check))


def row_statistics(
    rows: Sequence[TolerancedRow], plan: SamplingPlan, jobs: int
) -> Iterator[tuple[int, SpreadStatistics]]:
    """Yield each row's index and statistics, rows alike together, by up to `jobs` processes where there are enough."""
    batches = list(batches_alike(rows))
    work = [[rows[index] for index in batch] for batch in batches]
    statistics = mapped(partial(batch_statistics, plan=plan), work, min(jobs, len(rows) // ROWS_PER_WORKER))
    for batch, of_batch in zip(batches, statistics, strict=True):
        yield from zip(batch, of_batch, strict=True)


def drawn_curves(drawn: Sequence[Computed], settings: Settings, options: Options) -> list[Curve]:
    """Return the curves of variants that have a spread."""
    rows = [(_toleranced(variant), variant.spread) for variant in drawn if variant.spread]
    return list(row_curves(rows, _plan(settings, options), options.jobs))


def row_curves(
    rows: Sequence[tuple[TolerancedRow, SpreadStatistics]], plan: SamplingPlan, jobs: int
) -> Iterator[Curve]:
    """Yield the curve of each row, by up to `jobs` processes where there are lines or points enough."""
    points = sum(int(statistics.numbers.get("spread_points") or 0) for _, statistics in rows)
    return mapped(partial(_curve, plan=plan), rows, min(jobs, points // POINTS_PER_WORKER))


def _curve(row: tuple[TolerancedRow, SpreadStatistics], plan: SamplingPlan) -> Curve:
    return curve_of(*row, plan)


def _plan(settings: Settings, options: Options) -> SamplingPlan:
    return SamplingPlan(
        method=settings.method,
        inputs=tuple(DIMENSIONS),
        samples=settings.samples,
        seed=settings.seed,
        coverage=settings.coverage_percent / 100,
        cross_check=bool(options.cross_check),
    )


def _toleranced(variant: Computed) -> TolerancedRow:
    """Return what the spread of a variant takes."""
    return TolerancedRow(
        model=_MODELS[variant.variant.flexspline_type],
        nominal=variant.variant.dimensions,
        limits=variant.limits,
        upper_limit=variant.variant.backlash_limit,
    )
