"""How much of a submission a report shows: all of it, or, of a large one, the worst variants and the first findings."""

from __future__ import annotations

from dataclasses import dataclass

from flexlash.analysis import whole_batch
from flexlash.analysis.outcome import Outcome
from flexlash.report import report_data
from flexlash.schema.number_words import grouped

__all__ = ["MOST_FINDINGS", "Extent", "extent_of"]

MOST_FINDINGS = 1000
"""Most findings that the report of a large submission lists."""


@dataclass(frozen=True, kw_only=True)
class Extent:
    """How many of the computed variants a report draws, and where the others are.

    The sheets of a `large` report show no other variant than those drawn, but for Results; with `only_drawn` Results
    does neither. `results_file` is then the file beside the report that holds all of Results, empty where there is
    none; `findings_file` that of findings.
    """

    drawn: int
    total: int
    large: bool = False
    only_drawn: bool = False
    results_file: str = ""
    findings_file: str = ""

    @property
    def is_part(self) -> bool:
        """Whether some computed variants are not drawn."""
        return self.drawn < self.total

    @property
    def words(self) -> str:
        """What is drawn, as sentences begin: `500 worst of 10,000`."""
        return f"{self.drawn} worst of {grouped(self.total)}"

    @property
    def elsewhere(self) -> str:
        """Where all variants are, as sentences end."""
        if not self.only_drawn:
            return "all are in Results"
        return f"all Results are in {self.results_file}" if self.results_file else "run with -o NAME.parquet for all"

    @property
    def note(self) -> str:
        """The sentence at the top of a sheet that shows a part of the variants; empty where it shows all."""
        return f"The {self.words} variants; {self.elsewhere}." if self.is_part else ""


def extent_of(outcome: Outcome) -> Extent:
    """Return how much of a submission its report shows."""
    whole, computed = outcome.whole, len(outcome.computed)
    drawn = min(report_data.DRAWN, computed)
    if whole is None:
        return Extent(drawn=drawn, total=computed, large=outcome.results.height > whole_batch.LARGE)
    return Extent(
        drawn=drawn,
        total=whole.computed,
        large=True,
        only_drawn=True,
        results_file=whole.results_file,
        findings_file=whole.findings_file,
    )
