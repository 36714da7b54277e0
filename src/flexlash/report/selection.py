"""Which variants the report draws: all of them, or the worst when there are too many to see."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from flexlash.analysis.assessment import Computed
from flexlash.analysis.outcome import Outcome
from flexlash.tolerance.distribution_curves import Curve

__all__ = ["Drawn", "drawn_variants"]


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """A variant with its Results row, what was computed of it, and its whole distribution."""

    row: dict[str, Any]
    computed: Computed
    curve: Curve


def drawn_variants(outcome: Outcome) -> list[Drawn]:
    """Return the variants that have a curve, worst first."""
    rows = {row["variant"]: row for row in outcome.results.iter_rows(named=True)}
    return [
        Drawn(row=rows[outcome.computed[place].variant.name], computed=outcome.computed[place], curve=curve)
        for place, curve in outcome.curves.items()
    ]
