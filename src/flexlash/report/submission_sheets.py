"""Findings and the submission as read: every cell at its own address, so that findings link to it."""

from __future__ import annotations

from typing import Any

from xlsxwriter.utility import xl_cell_to_rowcol

from flexlash.columns import ENTRY_SHEETS
from flexlash.findings import Finding, shown
from flexlash.outcome import Outcome
from flexlash.report.styles import Book
from flexlash.result_columns import FINDINGS
from flexlash.submission.headers import STATUS_HEADER, plain
from flexlash.submission.reading.read import ErrorCell, RawSheet, RawValue, Unstored
from flexlash.submission.tables import BUILT_IN_SHEETS, built_in_sheet

__all__ = ["write_findings", "write_submission"]

_WIDTHS = {"message": 66, "fix": 50, "suggestion": 18, "variant": 20, "column": 24, "value": 20}
_LEVELS = ("error", "warning", "info")
_TITLES = {plain(name): "Submission" if name == "Variants" else name for name in ENTRY_SHEETS}


def write_findings(book: Book, outcome: Outcome) -> None:
    """Write the Findings sheet; each cell address links to the cell in the submission as read."""
    sheet = book.sheet("Findings")
    for place, column in enumerate(FINDINGS):
        sheet.set_column(place, place, _WIDTHS.get(column.key, 11))
        sheet.write_string(0, place, column.label, book.format("header"))
        sheet.write_comment(0, place, column.help)
    worst_first = sorted(outcome.findings, key=lambda found: _LEVELS.index(found.level))
    for row, found in enumerate(worst_first, start=1):
        _write_finding(book, sheet, row, found)
    if not outcome.findings:
        sheet.write_string(1, 0, "Nothing was found.", book.format("quiet"))
    sheet.autofilter(0, 0, max(1, len(outcome.findings)), len(FINDINGS) - 1)
    sheet.freeze_panes(1, 0)
    sheet.repeat_rows(0)


def _write_finding(book: Book, sheet: Any, row: int, found: Finding) -> None:
    """Write one finding, its level coloured and its cell linked."""
    styles = {"error": "error", "warning": "warning", "info": "text"}
    lines = max(len(found.message) // 68, len(found.fix) // 52)
    sheet.set_row(row, 15.5 * (1 + lines))
    for place, (key, value) in enumerate(found.as_dictionary().items()):
        title = _TITLES.get(plain(found.sheet))
        if key == "level":
            sheet.write_string(row, place, value, book.format(styles[found.level]))
        elif key == "cell" and value and title:
            sheet.write_url(row, place, f"internal:'{title}'!{value}", book.format("link"), value)
        else:
            sheet.write_string(row, place, value, book.format("wrap"))


def write_submission(book: Book, outcome: Outcome) -> None:
    """Write each entry sheet of the submission as read, guilty cells coloured, or the built-in table used instead."""
    levels: dict[tuple[str, str], str] = {}
    for found in outcome.findings:
        if found.cell and found.level != "info" and levels.get((found.sheet, found.cell)) != "error":
            levels[found.sheet, found.cell] = found.level
    rows = outcome.validated.header_rows if outcome.validated else {}
    by_title = {_TITLES.get(plain(raw.name), ""): raw for raw in outcome.submission.sheets.values()}
    for schema, title in zip(ENTRY_SHEETS, _TITLES.values(), strict=True):
        raw = by_title.get(title)
        if raw:
            marked = {xl_cell_to_rowcol(cell): level for (name, cell), level in levels.items() if name == raw.name}
            _write_mirror(book, raw, title, marked, rows.get(schema, 0))
        elif schema in BUILT_IN_SHEETS:
            _write_mirror(book, built_in_sheet(schema), title, {}, 1)


def _write_mirror(book: Book, raw: RawSheet, title: str, marked: dict[tuple[int, int], str], header: int) -> None:
    """Write a sheet's cells at their addresses, its header row as such."""
    sheet = book.sheet(title)
    if header:
        sheet.set_row(header - 1, 48)
        sheet.freeze_panes(header, 1)
        sheet.repeat_rows(header - 1)
    ignored = {
        place
        for place, value in raw.rows.get(header, {}).items()
        if isinstance(value, str) and plain(value) == plain(STATUS_HEADER)
    }
    places = [place for cells in raw.rows.values() for place in cells if place not in ignored]
    sheet.set_column(0, max(places, default=1), 14)
    sheet.set_column(0, 0, 24)
    for row, cells in raw.rows.items():
        for place, value in cells.items():
            if place not in ignored and not (isinstance(value, Unstored) and row < header):
                style = marked.get((row - 1, place - 1), "header" if row == header else "text")
                _write_value(sheet, row - 1, place - 1, value, book.format(style))
    for (row, place), level in marked.items():
        if place + 1 not in raw.rows.get(row + 1, {}):
            sheet.write_blank(row, place, None, book.format(level))


def _write_value(sheet: Any, row: int, place: int, value: RawValue, style: Any) -> None:
    """Write a raw value so that it can do nothing but be read."""
    if isinstance(value, bool):
        sheet.write_string(row, place, shown(value), style)
    elif isinstance(value, int | float) and abs(value) < float("inf"):
        sheet.write_number(row, place, value, style)
    elif isinstance(value, ErrorCell):
        sheet.write_string(row, place, value.text, style)
    elif isinstance(value, Unstored):
        sheet.write_string(row, place, "(formula without a stored result)", style)
    else:
        sheet.write_string(row, place, shown(value, longest=1000), style)
