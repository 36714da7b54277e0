"""What only the report draws: the variants that it shows, their curves and pictures, and what would help the worst."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import polars as pl

from flexlash.analysis.computed import Computed
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.recommendations import Recommendation, recommendations_of
from flexlash.analysis.tolerance_spread import drawn_curves
from flexlash.analysis.whole_batch import DRAWN, worst_rows
from flexlash.decisions.sweep import Study, sweeps_of
from flexlash.tolerance.distribution_curves import Curve

if TYPE_CHECKING:
    from flexlash.mechanics.elasticity.twist import ElasticityCheck

__all__ = ["DRAWN", "PICTURED", "ROW", "Drawn", "ReportData", "drawn_variants", "ranked", "report_data"]

ROW = "row"
"""The column of ranked Results that holds the row number of the submission."""

PICTURED = 6
"""Most variants of which the report shows the half-section."""


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
    stress fields, by name; `recommendations` what would bring the worst failing variants within their limit; `studies`
    the sweeps that were asked for.
    """

    drawn: Sequence[Drawn]
    pictured: Mapping[str, ElasticityCheck] = field(default_factory=dict)
    recommendations: Sequence[Recommendation] = ()
    studies: Sequence[Study] = ()


def report_data(outcome: Outcome) -> ReportData:
    """Return what the report draws beside an outcome."""
    worst = ranked(outcome)
    return ReportData(
        drawn=_drawn(outcome, worst),
        pictured=_pictured(outcome, worst),
        recommendations=_recommendations(outcome, worst),
        studies=sweeps_of(outcome),
    )


def ranked(outcome: Outcome) -> pl.DataFrame:
    """Return the Results of all variants that have a spread, worst first, each with its row number."""
    table = outcome.validated.table if outcome.validated else None
    rows = pl.Series(dtype=pl.Int64) if table is None else table.frame["row"]
    return worst_rows(outcome.results.with_columns(rows.alias(ROW)))


def drawn_variants(outcome: Outcome) -> list[Drawn]:
    """Return the variants that the report shows, worst first, with their whole distributions."""
    return _drawn(outcome, ranked(outcome))


def _drawn(outcome: Outcome, worst: pl.DataFrame) -> list[Drawn]:
    """Return the first of the ranked variants with their whole distributions."""
    rows = worst.head(DRAWN).to_dicts()
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


def _recommendations(outcome: Outcome, worst: pl.DataFrame) -> list[Recommendation]:
    """Return what helps the worst failing variant, and the worst whose median is within its limit."""
    over, median, limit = (worst[key] for key in ("probability_over_limit", "p50_arcmin", "backlash_limit_arcmin"))
    failing = over.is_not_null() & (over > outcome.settings.verdict_bounds.meets)
    hopeful = failing & (median <= limit) & worst["main_contributor"].is_not_null()
    rows = [*worst.filter(failing)[ROW].head(1), *worst.filter(hopeful)[ROW].head(1)]
    return recommendations_of({row: outcome.computed[row] for row in rows}, outcome.settings)
