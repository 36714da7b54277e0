"""What only the report draws: the variants that it shows, their curves, pictures and levers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import polars as pl

from flexlash.analysis.computed import Computed
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.tolerance_spread import drawn_curves
from flexlash.analysis.whole_batch import DRAWN, worst_rows
from flexlash.decisions.allocation import allocation_of
from flexlash.decisions.levers import levers_of
from flexlash.decisions.sweep import Study, sweeps_of
from flexlash.schema.variant import Settings
from flexlash.tolerance.distribution_curves import Curve

if TYPE_CHECKING:
    from flexlash.mechanics.elasticity.twist import ElasticityCheck

__all__ = [
    "DRAWN",
    "PICTURED",
    "ROW",
    "Drawn",
    "ReportData",
    "drawn_variants",
    "levers_of_variants",
    "ranked",
    "report_data",
]

ROW = "row"
"""The column of ranked Results that holds the row number of the submission."""

PICTURED = 6
"""Most variants of which the report shows the half-section."""


def no_levers() -> pl.DataFrame:
    """Return the table of levers without a row."""
    return levers_of({}, Settings(), {})


def no_allocation() -> pl.DataFrame:
    """Return the table of allocated tolerances without a row."""
    return allocation_of({}, Settings(), {})


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """A variant with its Results row, what was computed of it, and its whole distribution."""

    row: dict[str, Any]
    computed: Computed
    curve: Curve


@dataclass(frozen=True, kw_only=True)
class ReportData:
    """What the report draws beside an outcome.

    `drawn` are the variants that it shows, worst first; `pictured` the elasticity checks of the worst, with their
    stress fields, by name; `levers` the table of single changes of those drawn that have a limit; `allocation` that of
    the tolerances of their classes; `studies` the sweeps that were asked for.
    """

    drawn: Sequence[Drawn]
    pictured: Mapping[str, ElasticityCheck] = field(default_factory=dict)
    levers: pl.DataFrame = field(default_factory=no_levers)
    allocation: pl.DataFrame = field(default_factory=no_allocation)
    studies: Sequence[Study] = ()


def report_data(outcome: Outcome) -> ReportData:
    """Return what the report draws beside an outcome."""
    worst = ranked(outcome)
    drawn = _drawn(outcome, worst, DRAWN)
    return ReportData(
        drawn=drawn,
        pictured=_pictured(outcome, worst),
        levers=levers_of_variants(outcome, [one.row[ROW] for one in drawn]),
        allocation=_allocation(outcome),
        studies=sweeps_of(outcome),
    )


def ranked(outcome: Outcome) -> pl.DataFrame:
    """Return the Results of all variants that have a spread, worst first, each with its row number."""
    table = outcome.validated.table if outcome.validated else None
    rows = pl.Series(dtype=pl.Int64) if table is None else table.frame["row"]
    return worst_rows(outcome.results.with_columns(rows.alias(ROW)))


def drawn_variants(outcome: Outcome, most: int | None = None) -> list[Drawn]:
    """Return the variants that the report shows, or so many, worst first, with their whole distributions."""
    return _drawn(outcome, ranked(outcome), DRAWN if most is None else most)


def _drawn(outcome: Outcome, worst: pl.DataFrame, most: int) -> list[Drawn]:
    """Return the first of the ranked variants with their whole distributions."""
    rows = worst.head(most).to_dicts()
    computed = [outcome.computed[row[ROW]] for row in rows]
    curves = drawn_curves(computed, outcome.settings, outcome.options)
    return [
        Drawn(row=row, computed=variant, curve=curve)
        for row, variant, curve in zip(rows, computed, curves, strict=True)
    ]


def _pictured(outcome: Outcome, worst: pl.DataFrame) -> dict[str, ElasticityCheck]:
    """Solve the worst few of the checked variants once more, for their stress fields."""
    key = "elasticity_windup_rad"
    checked = worst.filter(worst[key].is_not_null()).head(PICTURED) if key in worst.columns else worst.clear()
    if checked.is_empty():
        return {}
    from flexlash.analysis.verification import pictured

    return pictured([outcome.computed[row] for row in checked[ROW]])


def levers_of_variants(outcome: Outcome, rows: Sequence[int]) -> pl.DataFrame:
    """Return the table of single changes of some variants, by row number in this order: of those that have a limit."""
    if outcome.validated is None:
        return no_levers()
    computed = {row: outcome.computed[row] for row in rows}
    return levers_of(computed, outcome.settings, outcome.validated.levers, outcome.options)


def _allocation(outcome: Outcome) -> pl.DataFrame:
    """Return the table of allocated tolerances; empty where the outcome does not hold all variants of a class."""
    if outcome.validated is None or outcome.whole is not None:
        return no_allocation()
    return allocation_of(outcome.computed, outcome.settings, outcome.validated.levers, outcome.options)
