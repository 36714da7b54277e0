"""Which variants the report draws: all of them, or the worst when there are too many to see."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from flexlash.assessment import Computed
from flexlash.outcome import Outcome
from flexlash.summary import worst_first

__all__ = ["DRAWN", "Drawn", "drawn_variants"]

DRAWN = 500
"""Most variants whose curves are stored."""


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """A variant with its Results row and what was computed of it."""

    row: dict[str, Any]
    computed: Computed


def drawn_variants(outcome: Outcome) -> list[Drawn]:
    """Return up to `DRAWN` computed variants, worst first."""
    by_name = {one.variant.name: one for one in outcome.computed.values()}
    return [Drawn(row=row, computed=by_name[row["variant"]]) for row in worst_first(outcome)[:DRAWN]]
