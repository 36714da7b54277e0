"""An outcome → what the Summary's sentences draw on: its rows worst first, those that fail, short names of variants."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import polars as pl

from flexlash.analysis.computed import Computed
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_summary import listed, quoted
from flexlash.analysis.whole_batch import is_straddled, verdict_place
from flexlash.report.extent import Extent, extent_of
from flexlash.report.report_data import DRAWN, ROW, ranked
from flexlash.report.wording.labels import distinct_labels
from flexlash.report.wording.lever_words import hats_of, shown_levers
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import shown
from flexlash.schema.limit_verdict import VERDICTS, VerdictBounds

__all__ = ["NAMED", "Row", "SummaryFacts", "first_rows", "labels_of", "main_cause", "rough", "summary_facts"]

NAMED = 3
"""Most variants that a sentence names."""

_NAME = 30
"""Most characters of a name in a sentence."""

_SURE = {"line": 8, "sobol": 2**8, "random": 2**10}
"""Fewest lines or points by which shares of the variance are known to one per cent."""

Row: TypeAlias = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class SummaryFacts:
    """An outcome with what several sentences draw on.

    `ranked` are the Results of its variants, worst first, each with its verdict and whether that is straddled; `labels`
    are short names by name; `extent` is how many variants there are and how many of them the report draws; `levers` are
    the changes of those, as `shown_levers` orders them.
    """

    outcome: Outcome
    levers: pl.DataFrame
    ranked: pl.DataFrame
    labels: dict[str, str]
    extent: Extent

    @property
    def bounds(self) -> VerdictBounds:
        """Which share of units over the limit each verdict allows."""
        return self.outcome.settings.verdict_bounds

    @property
    def angles(self) -> AngleUnit:
        """The unit in which angles are told."""
        return self.outcome.settings.angles

    @cached_property
    def worst(self) -> Row | None:
        """The worst variant, None where nothing was computed."""
        return next(iter(first_rows(self.ranked, 1)), None)

    @cached_property
    def failing(self) -> pl.DataFrame:
        """The variants that fail or are marginal, worst first."""
        return self.judged.filter(pl.col("verdict") != "meets")

    @cached_property
    def judged(self) -> pl.DataFrame:
        """The variants with a limit, worst first."""
        return self.ranked.filter(pl.col("backlash_limit_arcmin").is_not_null())

    def computed(self, row: Row) -> Computed:
        """Return what was computed of a variant."""
        return self.outcome.computed[row[ROW]]

    def named(self, name: str) -> str:
        """Return a variant's name as a sentence has it: short and in quotation marks."""
        return quoted(self.labels.get(name) or shown(name, longest=_NAME))

    def names(self, names: Sequence[str]) -> str:
        """Return several names as a sentence lists them, the first few."""
        return listed([self.named(name) for name in names[:NAMED]], NAMED, len(names))


def summary_facts(outcome: Outcome, levers: pl.DataFrame) -> SummaryFacts:
    """Return what the sentences on an outcome draw on; `levers` are those of the variants that its report shows."""
    words = dict(enumerate(VERDICTS))
    bounds = outcome.settings.verdict_bounds
    verdict = verdict_place(bounds).replace_strict(words, return_dtype=pl.String)
    rows = ranked(outcome).with_columns(verdict=verdict, straddled=is_straddled(bounds))
    labels = labels_of(outcome, rows["variant"].head(DRAWN).to_list())
    return SummaryFacts(
        outcome=outcome,
        levers=shown_levers(levers, hats_of(outcome)),
        ranked=rows,
        labels=labels,
        extent=extent_of(outcome),
    )


def first_rows(rows: pl.DataFrame, most: int = NAMED) -> list[Row]:
    """Return the first few rows."""
    return rows.head(most).to_dicts()


def labels_of(outcome: Outcome, worst: Sequence[str]) -> dict[str, str]:
    """Return a short name for each of the worst and of the first that were not computed, distinct where they are."""
    lost = outcome.results.filter(outcome.results["status"] == "error")["variant"].to_list()[:NAMED]
    names = list(dict.fromkeys([*worst, *filter(None, lost)]))
    return dict(zip(names, distinct_labels(names, _NAME), strict=True))


def rough(row: Row) -> bool:
    """Whether a row's shares of the variance are estimated from too few points to be right to one per cent."""
    return bool((row["spread_points"] or math.inf) < _SURE.get(row["spread_method"], 0))


def main_cause(row: Row) -> str:
    """Return what causes most of a row's spread, with its share; an empty text where nothing scatters."""
    if not row["main_contributor"]:
        return ""
    about = "≈" if rough(row) else ""
    return f"{dimension_words(row['main_contributor'])} ({about}{100 * row['main_contributor_share']:.0f} %)"
