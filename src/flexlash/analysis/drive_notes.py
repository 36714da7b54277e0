"""What the screen says of whole drives: of an outcome, or of the chunks of a large table one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.findings import shown
from flexlash.schema.number_words import grouped

if TYPE_CHECKING:
    import polars as pl

__all__ = ["DriveNotes"]

_NAME = 30


@dataclass(frozen=True, kw_only=True)
class DriveNotes:
    """How many variants have a budget of their drive, a system limit with it, and `meets` of these.

    `most` is the greatest worst case [arcmin], that of `variant`; `target` the wanted percentage of drives within.
    """

    told: int = 0
    judged: int = 0
    meets: int = 0
    variant: str = ""
    most: float = 0.0
    target: float = 99.865

    @classmethod
    def of(cls, results: pl.DataFrame, target: float) -> DriveNotes:
        """Return what is to be said of the rows of Results."""
        known = results.filter(results["system_mean_arcmin"].is_not_null())
        if known.is_empty():
            return cls(target=target)
        over = known["system_probability_over_limit"].drop_nulls()
        highest = known["system_worst_case_high_arcmin"]
        first = int(highest.arg_max() or 0)
        return cls(
            told=known.height,
            judged=over.len(),
            meets=int((over <= 1 - target / 100).sum()),
            variant=known["variant"][first],
            most=float(highest[first]),
            target=target,
        )

    def __add__(self, later: DriveNotes) -> DriveNotes:
        """Return what is to be said of these rows and of later ones together."""
        first = later if later.most > self.most else self
        return DriveNotes(
            told=self.told + later.told,
            judged=self.judged + later.judged,
            meets=self.meets + later.meets,
            variant=first.variant,
            most=first.most,
            target=(later if later.told else self).target,
        )

    def lines(self, angles: AngleUnit) -> Iterator[str]:
        """Yield one line with its angle in a unit, nothing where no variant has a budget."""
        if not self.told:
            return
        whose = f", the greatest, of {shown(self.variant, longest=_NAME)}" if self.told > 1 else ""
        limit = "no system limit is given"
        if self.judged:
            met = f"{grouped(self.meets)} of {grouped(self.judged)}"
            limit = f"system limit met by {met} ({self.target:g} % of drives within it)"
        yield f"Whole drive, wind-up and other sources: worst case {angles.words(self.most)}{whose}; {limit}."
