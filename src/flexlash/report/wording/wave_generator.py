"""Results rows → sentences on what the wave generator does to a part: it bends it, and two lobes carry the torque."""

from __future__ import annotations

from collections.abc import Iterator

import polars as pl

from flexlash.report.wording.summary_facts import Row, SummaryFacts, first_rows
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.findings import spelled_out

__all__ = ["BENDING", "TWO_LOBES", "bending", "bending_of", "two_lobes", "two_lobes_of"]

BENDING, TWO_LOBES = "Bending", "Two lobes"
"""The topics of these sentences on a variant's own page."""

_DIGITS = 3
_TORSION = "all other stresses are of torsion only"


def bending(facts: SummaryFacts) -> Iterator[str]:
    """Yield what the wave generator's bending does to the variant that it stresses most."""
    bent = facts.ranked.filter(pl.col("alternating_stress_MPa").is_not_null())
    for row in first_rows(bent.sort("alternating_stress_MPa", descending=True, maintain_order=True), 1):
        most = " most" if bent.height > 1 else ""
        yield f"The wave generator bends {facts.named(row['variant'])}{most}: {_stresses(row)}; {_TORSION}."


def bending_of(row: Row) -> Iterator[str]:
    """Yield what the wave generator's bending does to a variant, nothing where its deflection is not given."""
    if row["alternating_stress_MPa"] is not None:
        yield f"The wave generator bends it twice a turn: {_stresses(row)}; {_TORSION}."


def _stresses(row: Row) -> str:
    alternating, combined = (spelled_out(row[f"{name}_stress_MPa"], _DIGITS) for name in ("alternating", "combined"))
    return f"{alternating} MPa alternating, {combined} MPa with torsion"


def two_lobes(facts: SummaryFacts) -> Iterator[str]:
    """Yield the bounds under two lobes of the worst variant that has any."""
    if "two_lobe_low_arcmin" in facts.ranked.columns:
        bounded = facts.ranked.filter(pl.col("two_lobe_low_arcmin").is_not_null())
        for row in first_rows(bounded, 1):
            yield from two_lobes_of(row, facts.angles, f" for {facts.named(row['variant'])}")


def two_lobes_of(row: Row, angles: AngleUnit, whose: str = "") -> Iterator[str]:
    """Yield the bounds of a variant under two lobes, nothing where it has none."""
    if row.get("two_lobe_low_arcmin") is not None:
        low, high = (angles.spelled_out(row[f"two_lobe_{end}_arcmin"], _DIGITS) for end in ("low", "high"))
        yield (
            f"Two lobes on a rigid, tight wave generator: {low} to {high}{whose}; "
            "the wave generator's fit is not included."
        )
