"""Computed variants, worst first → the chart of all of them, the table, and those that were not computed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import polars as pl

from flexlash.analysis.outcome import Outcome
from flexlash.report.page.lever_cells import cheapest_changes
from flexlash.report.page.shape import Axis, Chart, ChartVariant, Lost, TableRow
from flexlash.report.report_data import ROW
from flexlash.report.summary.summary_chart import CHARTED, chart_axis, chart_title
from flexlash.report.wording.distances import deciding_percentile, distance_words
from flexlash.report.wording.labels import distinct_labels
from flexlash.report.wording.summary_facts import Row, SummaryFacts, main_cause
from flexlash.report.wording.verdict import straddled, verdict_word
from flexlash.schema.findings import shown
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.number_words import brief_share

__all__ = ["chart_of", "lost_variants", "shown_names", "table_rows", "verdict_of"]

_LOST = 100
"""Most variants that were not computed that are told."""

_NAME = 80
"""Most characters of a variant's name."""

_WHY = 400
"""Most characters of the errors of a variant."""


def shown_names(rows: Sequence[Row]) -> list[str]:
    """Return short names of the variants of some Results rows, distinct where they are."""
    return distinct_labels([row["variant"] for row in rows], _NAME)


def chart_of(facts: SummaryFacts, rows: Sequence[Row], names: Sequence[str], paged: int) -> Chart | None:
    """Return the chart of the worst variants, of which so many have a page of their own."""
    drawn = rows[:CHARTED]
    if not drawn:
        return None
    start, step, decimals = chart_axis(drawn, facts.angles)
    total = facts.extent.total
    limits = {row["backlash_limit_arcmin"] for row in drawn} - {None}
    return Chart(
        title=chart_title(len(drawn), total, facts.angles),
        unit=facts.angles.name,
        axis=Axis(start=start, step=step, decimals=decimals),
        limits=sorted(map(facts.angles.of, limits)),
        variants=[
            _bar(facts, row, name, _page(place, paged))
            for place, (row, name) in enumerate(zip(drawn, names, strict=False))
        ],
        drawn=len(drawn),
        of=total,
    )


def _page(place: int, paged: int) -> int | None:
    return place if place < paged else None


def _bar(facts: SummaryFacts, row: Row, name: str, page: int | None) -> ChartVariant:
    of, limit = facts.angles.of, row["backlash_limit_arcmin"]
    return ChartVariant(
        variant=name,
        low=of(row["p2_5_arcmin"]),
        median=of(row["p50_arcmin"]),
        high=of(row["p97_5_arcmin"]),
        nominal=of(row["backlash_arcmin"]),
        limit=None if limit is None else of(limit),
        verdict=verdict_of(row, facts.bounds),
        page=page,
    )


def verdict_of(row: Row, bounds: VerdictBounds) -> str:
    """Return the verdict on a Results row, an empty text without a limit."""
    return bounds.verdict(row["probability_over_limit"]) or ""


def table_rows(facts: SummaryFacts, rows: Sequence[Row], names: Sequence[str], paged: int) -> Iterator[TableRow]:
    """Yield rows of the table, with the digits of the Summary."""
    cheapest = cheapest_changes(facts.levers)
    for place, (row, name) in enumerate(zip(rows, names, strict=True)):
        limit = row["backlash_limit_arcmin"]
        yield TableRow(
            variant=name,
            row=row[ROW],
            status=row["status"],
            verdict=verdict_of(row, facts.bounds),
            settled=not straddled(row, facts.bounds),
            light="" if limit is None else verdict_word(row, facts.bounds),
            nominal=facts.angles.words(row["backlash_arcmin"]),
            median=_percentile(facts, row, "p50"),
            p97_5=_percentile(facts, row, "p97_5"),
            p99_865=_percentile(facts, row, "p99_865"),
            limit="" if limit is None else facts.angles.entered(limit),
            distance="" if limit is None else distance_words(row, deciding_percentile(facts.bounds)[0], facts.angles),
            over_limit="" if limit is None else brief_share(row),
            main_cause=main_cause(row),
            page=_page(place, paged),
            cheapest=cheapest.get(row["variant"], ""),
        )


def _percentile(facts: SummaryFacts, row: Row, key: str) -> str:
    return facts.angles.words(row[f"{key}_arcmin"], row[f"{key}_standard_error_arcmin"])


def lost_variants(outcome: Outcome) -> list[Lost]:
    """Return the first variants that were submitted and not computed."""
    table = outcome.validated.table if outcome.validated else None
    if table is None:
        return []
    rows = outcome.results.select("variant", "status", "findings").with_columns(table.frame["row"].alias(ROW))
    lost = rows.filter(pl.col("status") == "error")
    return [
        Lost(variant=shown(name, _NAME), row=row, why=shown(why or "", _WHY))
        for name, _, why, row in lost.head(_LOST).iter_rows()
    ]
