"""Computed variants → their tolerance spread; the drawn ones among them → their whole distribution."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple, TypeAlias, overload

from flexlash.analysis.backlash_models import BACKLASH_OF
from flexlash.analysis.computed import Computed, ComputedRows, Spread
from flexlash.analysis.drive_budget import DriveBudget, budget_of
from flexlash.analysis.drive_checks import drives_over_limit
from flexlash.analysis.measured_uncertainty import with_measured_uncertainty
from flexlash.analysis.options import Options
from flexlash.analysis.spread_rows import SpreadRows
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import Settings
from flexlash.tolerance.distribution_curves import Curve, curves_of
from flexlash.tolerance.row_batches import FirstOrder, RowBatch, TolerancedRow, batch_statistics, batches_alike
from flexlash.tolerance.sampling import SamplingPlan
from flexlash.tolerance.spread_statistics import SpreadStatistics
from flexlash.workers import mapped

__all__ = [
    "FIRST_INPUTS",
    "LATER_INPUTS",
    "drawn_curves",
    "first_orders",
    "row_curves",
    "row_statistics",
    "sampling_plan",
    "spread_of",
    "toleranced_row",
]

_FIRST_VERSIONS = 4
"""Template versions whose dimensions draw their points first: those of later ones leave the points of these alone."""

FIRST_INPUTS = tuple(name for name, column in DIMENSIONS.items() if column.since <= _FIRST_VERSIONS)
LATER_INPUTS = tuple(name for name in DIMENSIONS if name not in FIRST_INPUTS)
"""The dimensions in the order in which their points are drawn."""

Found: TypeAlias = tuple[int, SpreadStatistics]
"""A row's index, or its number, with its statistics."""

_TOGETHER = 500
"""Rows that are made and spread at a time."""

ROWS_PER_WORKER, POINTS_PER_WORKER = 1000, 100_000
"""Rows to be spread, lines or points of curves, below which starting a worker costs more than it saves."""


def spread_of(computed: ComputedRows, settings: Settings, options: Options) -> Spread:
    """Return the spread of the variants; the same points serve all rows."""
    budget = budget_of(computed.validated, settings)
    pieces = _Pieces(
        lambda numbers: _piece([computed[number] for number in numbers], budget), computed.alike(_TOGETHER)
    )
    found = _told(_found(pieces, sampling_plan(settings, options), options.jobs, budget), options, len(computed))
    statistics = SpreadRows.of(found)
    return Spread(
        statistics=statistics,
        cross_checked=bool(options.cross_check),
        findings=drives_over_limit(computed, statistics.frame, settings),
    )


def _told(found: Iterable[Found], options: Options, rows: int) -> Iterator[Found]:
    """Yield what is found, and tell how much that is of all steps, of which the elasticity check has as many."""
    steps = rows * (2 if options.elasticity else 1)
    for done, one in enumerate(found, start=1):
        yield one
        if options.progress:
            options.progress(done, steps)


def row_statistics(rows: Sequence[TolerancedRow], plan: SamplingPlan, jobs: int) -> Iterator[Found]:
    """Yield each row's index and statistics, rows alike together, by up to `jobs` processes where there are enough."""
    pieces = _Pieces(lambda indices: _Piece([rows[index] for index in indices]), list(batches_alike(rows)))
    return _found(pieces, plan, jobs)


def _found(pieces: _Pieces, plan: SamplingPlan, jobs: int, budget: DriveBudget | None = None) -> Iterator[Found]:
    """Yield the number and the statistics of each row of some pieces of work, with the budget of its drive if any."""
    workers = min(jobs, sum(map(len, pieces.numbers)) // ROWS_PER_WORKER)
    work = partial(_of_piece, plan=plan, budget=budget)
    for numbers, statistics in zip(pieces.numbers, mapped(work, pieces, workers), strict=True):
        yield from zip(numbers, statistics, strict=True)


class _Piece(NamedTuple):
    """Rows to be spread together, and the whole drives of these where there is a budget."""

    rows: list[TolerancedRow]
    drives: Sequence[TolerancedRow] = ()


def _piece(variants: Sequence[Computed], budget: DriveBudget | None) -> _Piece:
    """Return what the spread of variants takes."""
    rows = [toleranced_row(variant) for variant in variants]
    if budget is None:
        return _Piece(rows)
    drives = [budget.row(row, one.variant.system_limit) for row, one in zip(rows, variants, strict=True)]
    return _Piece(rows, drives)


def _of_piece(piece: _Piece, plan: SamplingPlan, budget: DriveBudget | None) -> list[SpreadStatistics]:
    """Return the statistics of each row, rows alike together."""
    rows, found = piece.rows, dict[int, SpreadStatistics]()
    for batch in batches_alike(rows):
        found |= zip(batch, batch_statistics([rows[index] for index in batch], plan), strict=True)
    statistics = with_measured_uncertainty(rows, [found[index] for index in range(len(rows))], plan)
    return statistics if budget is None else budget.with_budget(piece.drives, statistics, plan)


@dataclass(frozen=True)
class _Pieces(Sequence[_Piece]):
    """Rows of which some are spread together, by their numbers; made when it is their turn, since limits are large."""

    rows: Callable[[Sequence[int]], _Piece]
    numbers: Sequence[Sequence[int]]

    def __len__(self) -> int:
        return len(self.numbers)

    @overload
    def __getitem__(self, index: int) -> _Piece: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[_Piece]: ...
    def __getitem__(self, index: int | slice) -> _Piece | Sequence[_Piece]:
        if isinstance(index, slice):
            return _Pieces(self.rows, self.numbers[index])
        return self.rows(self.numbers[index])


def first_orders(variants: Sequence[Computed]) -> list[FirstOrder]:
    """Return what the first-order standard deviation of each variant is made of."""
    rows = [toleranced_row(variant) for variant in variants]
    found: dict[int, FirstOrder] = {}
    for batch in batches_alike(rows):
        found |= zip(batch, RowBatch([rows[index] for index in batch]).first_order(), strict=True)
    return [found[index] for index in range(len(rows))]


def drawn_curves(drawn: Sequence[Computed], settings: Settings, options: Options) -> list[Curve]:
    """Return the curves of variants that have a spread."""
    rows = [(toleranced_row(variant), variant.spread) for variant in drawn if variant.spread]
    return list(row_curves(rows, sampling_plan(settings, options), options.jobs))


def row_curves(
    rows: Sequence[tuple[TolerancedRow, SpreadStatistics]], plan: SamplingPlan, jobs: int
) -> Iterator[Curve]:
    """Yield the curve of each row, rows alike together, by up to `jobs` processes where there are points enough."""
    points = sum(int(statistics.numbers.get("spread_points") or 0) for _, statistics in rows)
    batches = list(batches_alike([row for row, _ in rows]))
    work = [[rows[index] for index in batch] for batch in batches]
    found = mapped(partial(_curves, plan=plan), work, min(jobs, points // POINTS_PER_WORKER))
    curves = {
        index: curve
        for batch, some in zip(batches, found, strict=True)
        for index, curve in zip(batch, some, strict=True)
    }
    return (curves[index] for index in range(len(rows)))


def _curves(rows: Sequence[tuple[TolerancedRow, SpreadStatistics]], plan: SamplingPlan) -> list[Curve]:
    return curves_of([row for row, _ in rows], [statistics for _, statistics in rows], plan)


def sampling_plan(settings: Settings, options: Options) -> SamplingPlan:
    """Return how the rows of a submission are sampled."""
    return SamplingPlan(
        method=settings.method,
        inputs=FIRST_INPUTS,
        later_inputs=LATER_INPUTS,
        samples=settings.samples,
        seed=settings.seed,
        coverage=settings.coverage_percent / 100,
        acceptable=settings.acceptable_ppm * 1e-6,
        bounds=settings.verdict_bounds.shares,
        cross_check=bool(options.cross_check),
    )


def toleranced_row(variant: Computed) -> TolerancedRow:
    """Return what the spread of a variant takes."""
    return TolerancedRow(
        model=BACKLASH_OF[variant.variant.flexspline_type],
        nominal=variant.variant.dimensions,
        limits=variant.limits,
        upper_limit=variant.variant.backlash_limit,
        between=variant.between,
        correlation=variant.correlation,
    )
