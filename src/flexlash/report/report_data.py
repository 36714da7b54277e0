"""What only the report draws: the variants that it shows, their curves and pictures, and what would help the worst."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from flexlash.analysis.computed import Computed
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.recommendations import Recommendation, recommendations_of
from flexlash.analysis.run_summary import worst_first
from flexlash.analysis.tolerance_spread import drawn_curves
from flexlash.tolerance.distribution_curves import Curve

if TYPE_CHECKING:
    from flexlash.mechanics.elasticity.twist import ElasticityCheck

__all__ = ["DRAWN", "PICTURED", "Drawn", "ReportData", "drawn_variants", "report_data"]

DRAWN = 500
"""Most variants that the report draws, worst first."""

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
    stress fields, by name; `recommendations` what would bring the worst failing variants within their limit.
    """

    drawn: Sequence[Drawn]
    pictured: Mapping[str, ElasticityCheck] = field(default_factory=dict)
    recommendations: Sequence[Recommendation] = ()


def report_data(outcome: Outcome) -> ReportData:
    """Return what the report draws beside an outcome."""
    return ReportData(
        drawn=drawn_variants(outcome),
        pictured=_pictured(outcome),
        recommendations=recommendations_of(outcome.computed, outcome.settings),
    )


def drawn_variants(outcome: Outcome) -> list[Drawn]:
    """Return the variants that the report shows, worst first, with their whole distributions."""
    rows = worst_first(outcome)[:DRAWN]
    by_name = {variant.variant.name: variant for variant in outcome.computed.values()}
    computed = [by_name[row["variant"]] for row in rows]
    curves = drawn_curves(computed, outcome.settings, outcome.options)
    return [
        Drawn(row=row, computed=variant, curve=curve)
        for row, variant, curve in zip(rows, computed, curves, strict=True)
    ]


def _pictured(outcome: Outcome) -> dict[str, ElasticityCheck]:
    """Solve the worst few of the checked variants once more, for their stress fields."""
    if not any(variant.elasticity for variant in outcome.computed.values()):
        return {}
    from flexlash.analysis.verification import pictured

    by_name = {variant.variant.name: variant for variant in outcome.computed.values()}
    worst = [by_name[row["variant"]] for row in worst_first(outcome)]
    return pictured([variant for variant in worst if variant.elasticity is not None][:PICTURED])
