"""The Levers sheet: which single change brings a failing variant within its limit, and what a sound one leaves open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import polars as pl

from flexlash.analysis.outcome import Outcome
from flexlash.report.extent import extent_of
from flexlash.report.failing.failing_places import variant_targets
from flexlash.report.layout.given_rows import GivenRows
from flexlash.report.layout.links import write_link
from flexlash.report.layout.paper import Listed, print_one_page
from flexlash.report.layout.styles import PALETTE, Book
from flexlash.report.layout.wrapping import LINE_HEIGHT, lines_of
from flexlash.report.report_data import ROW, ReportData
from flexlash.report.wording.labels import distinct_labels
from flexlash.report.wording.lever_table import LEVER_COLUMNS, LeverColumn
from flexlash.report.wording.lever_words import Lever, hats_of, shown_levers

__all__ = ["FIRST_LEVER", "LEVERS", "lever_places", "write_levers"]

LEVERS = "Levers"
_NOTES = (
    "One change a row, all else as drawn. Of a variant that misses its limit: what brings the share of units within it "
    "to the setting target_percent. Of one that meets it: how far the value may go. The drawn value is the exact one "
    "rounded to the drawing step on the safe side; what stands beside it was computed anew with the drawn value.",
    "Mass is that of wall, rim, disk and fillets. Stress is of torsion only; Bending is that of the wall by the wave "
    "generator at the same deflection. Cost is relative: steps, or IT grades of a tolerance, times their cost on the "
    "entry sheet Levers, else 1. Rank 1 is the cheapest change in range. Grey: this change alone cannot do it.",
)
_HEADER = len(_NOTES) + 2
FIRST_LEVER = _HEADER + 1
"""Row of Levers, from 0, of the first change."""

_NAME = 22
_WIDTHS = [column.width for column in LEVER_COLUMNS]


def write_levers(book: Book, outcome: Outcome, data: ReportData) -> None:
    """Write the single changes of the drawn variants that have a limit; no sheet where none has."""
    levers = shown_levers(data.levers, hats_of(outcome))
    if levers.is_empty():
        return
    sheet = book.sheet(LEVERS, kind=GivenRows)
    sheet.write_string(0, 0, "What one change does", book.format("title"))
    sheet.set_row(0, 28)
    for row, note in enumerate(_NOTES, start=1):
        sheet.merge_range(row, 0, row, len(LEVER_COLUMNS) - 1, note, book.format("note"))
        sheet.set_row(row, LINE_HEIGHT * lines_of(note, sum(_WIDTHS)))
    if note := extent_of(outcome).note:
        sheet.write_string(_HEADER - 1, 0, note, book.format("quiet"))
    for place, column in enumerate(LEVER_COLUMNS):
        sheet.set_column(place, place, column.width)
        sheet.write_string(_HEADER, place, column.heading, book.format("header"))
    sheet.set_row(_HEADER, 4 * LINE_HEIGHT + 2)
    _write_rows(book, sheet, levers)
    _write_links(book, sheet, outcome, data, levers)
    last = (_HEADER + levers.height, len(LEVER_COLUMNS) - 1)
    sheet.autofilter(_HEADER, 0, *last)
    line = book.workbook.add_format({"top": 1, "top_color": PALETTE["grey"]})
    new_variant = {"type": "formula", "criteria": f"=$A{FIRST_LEVER + 1}<>$A{FIRST_LEVER}", "format": line}
    sheet.conditional_format(FIRST_LEVER, 0, *last, new_variant)
    sheet.freeze_panes(FIRST_LEVER, 2)
    sheet.repeat_rows(_HEADER)
    listed = Listed(noun="changes", first=FIRST_LEVER, columns=[column.heading for column in LEVER_COLUMNS])
    print_one_page(sheet, _WIDTHS, last[0], listed=listed)


def lever_places(levers: pl.DataFrame) -> dict[str, int]:
    """Return the row of Levers, from 0, of the first change of each variant; `levers` as `shown_levers` gives them."""
    first: dict[str, int] = {}
    for row, variant in enumerate(levers["variant"], start=FIRST_LEVER):
        first.setdefault(variant, row)
    return first


def _labels(levers: pl.DataFrame) -> Mapping[str, str]:
    names = levers["variant"].unique(maintain_order=True).to_list()
    return dict(zip(names, distinct_labels(names, _NAME), strict=True))


def _write_rows(book: Book, sheet: Any, levers: pl.DataFrame) -> None:
    """Write all changes at once."""
    rows, labels = levers.to_dicts(), _labels(levers)
    given = []
    for place, column in enumerate(LEVER_COLUMNS):
        values = [column.value(lever) if place else labels[lever["variant"]] for lever in rows]
        styles = [_format(book, column, lever, value) for lever, value in zip(rows, values, strict=True)]
        given.append((values, styles))
    sheet.give(FIRST_LEVER, given, _heights([values for values, _ in given]))


def _format(book: Book, column: LeverColumn, lever: Lever, value: str | float | None) -> Any:
    """Return the look of a cell: grey where the change cannot do it, green for the cheapest."""
    look = "indented wrap" if column.wraps else "indented" if isinstance(value, str) else "text"
    state = " grey" if lever["possible"] == "no" else " ok" if lever["rank"] == 1 else ""
    number = "" if value is None or isinstance(value, str) else column.code(value)
    return book.format(f"{look}{state}", number)


def _heights(columns: Sequence[Sequence[str | float | None]]) -> dict[int, float]:
    """Return the heights [pt] of rows whose wrapped texts take more than one line."""
    wrapped = [place for place, column in enumerate(LEVER_COLUMNS) if column.wraps]
    heights = {}
    for row, cells in enumerate(zip(*(columns[place] for place in wrapped), strict=True), start=FIRST_LEVER):
        lines = max(lines_of(str(cell or ""), _WIDTHS[place] - 1) for place, cell in zip(wrapped, cells, strict=True))
        if lines > 1:
            heights[row] = LINE_HEIGHT * lines
    return heights


def _write_links(book: Book, sheet: Any, outcome: Outcome, data: ReportData, levers: pl.DataFrame) -> None:
    """Let the first row of each variant lead to its page, or to Explorer."""
    targets, labels = variant_targets(data.drawn, outcome.settings.verdict_bounds), _labels(levers)
    submitted = {variant.row["variant"]: variant.row[ROW] for variant in data.drawn}
    for name, row in lever_places(levers).items():
        write_link(sheet, row, 0, targets[submitted[name]], labels[name], style=book.format("indented link"))
