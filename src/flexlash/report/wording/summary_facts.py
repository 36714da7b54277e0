"""An outcome → what the Summary's sentences draw on: its rows worst first, those that fail, short names of variants."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

from flexlash.analysis.computed import Computed
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.recommendations import Recommendation
from flexlash.analysis.run_summary import listed, quoted, worst_first
from flexlash.report.report_data import DRAWN
from flexlash.report.wording.labels import distinct_labels
from flexlash.report.wording.verdict import firm, light
from flexlash.schema.findings import shown

__all__ = ["NAMED", "Row", "SummaryFacts", "labels_of", "rough", "summary_facts"]

NAMED = 3
"""Most variants that a sentence names."""

_NAME = 30
"""Most characters of a name in a sentence."""

_SURE = {"line": 64, "sobol": 2**12, "random": 2**20}
"""Fewest lines or points by which shares of the variance are known to one per cent."""

Row: TypeAlias = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class SummaryFacts:
    """An outcome with what several sentences draw on; `rows` are worst first, `labels` are short names by name."""

    outcome: Outcome
    recommendations: Sequence[Recommendation]
    rows: Sequence[Row]
    labels: dict[str, str]

    @cached_property
    def computed(self) -> dict[str, Computed]:
        """The computed variants by name."""
        return {computed.variant.name: computed for computed in self.outcome.computed.values()}

    @cached_property
    def failing(self) -> list[Row]:
        """The variants whose verdict is red or amber, worst first."""
        return [row for row in self.judged if firm(light(row)) != "green"]

    @cached_property
    def judged(self) -> list[Row]:
        """The variants with a limit, worst first."""
        return [row for row in self.rows if row["backlash_limit_arcmin"] is not None]

    def named(self, name: str) -> str:
        """Return a variant's name as a sentence has it: short and in quotation marks."""
        return quoted(self.labels.get(name) or shown(name, longest=_NAME))

    def names(self, names: Sequence[str]) -> str:
        """Return several names as a sentence lists them, the first few."""
        return listed([self.named(name) for name in names], NAMED)


def summary_facts(outcome: Outcome, recommendations: Sequence[Recommendation]) -> SummaryFacts:
    """Return what the sentences on an outcome draw on."""
    rows = worst_first(outcome)
    labels = labels_of(outcome, [row["variant"] for row in rows[:DRAWN]])
    return SummaryFacts(outcome=outcome, recommendations=recommendations, rows=rows, labels=labels)


def labels_of(outcome: Outcome, worst: Sequence[str]) -> dict[str, str]:
    """Return a short name for each of the worst and of the first that were not computed, distinct where they are."""
    lost = outcome.results.filter(outcome.results["status"] == "error")["variant"].to_list()[:NAMED]
    names = list(dict.fromkeys([*worst, *filter(None, lost)]))
    return dict(zip(names, distinct_labels(names, _NAME), strict=True))


def rough(row: Row) -> bool:
    """Whether a row's shares of the variance are estimated from too few points to be right to one per cent."""
    return bool((row["spread_points"] or math.inf) < _SURE.get(row["spread_method"], 0))
