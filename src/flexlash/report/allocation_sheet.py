"""The Allocation sheet: the tolerances of each class that keep its variants within their limits at least cost."""

from __future__ import annotations

from typing import Any

import polars as pl

from flexlash.report.layout.paper import SMALL, print_readably
from flexlash.report.layout.styles import PALETTE, Book
from flexlash.report.layout.wrapping import LINE_HEIGHT, lines_of
from flexlash.report.wording.allocation_sentences import allocation_lines
from flexlash.schema.column import Column
from flexlash.schema.decision_results import ALLOCATION
from flexlash.schema.entry_words import dimension_title

__all__ = ["ALLOCATED", "write_allocation"]

ALLOCATED = "Allocation"

_NOTES = (
    "For each class, what its tolerances may be so that every variant with a limit keeps the setting target_percent, "
    "at the least relative cost: IT grades finer times cost per IT grade of the sheet Levers, else 1. Middle, "
    "distribution and capability stay; moduli scatter as they do. Found on the engine's slopes, rounded to steps of "
    "the drawing, and recomputed for every variant exactly as if it had been submitted.",
    "To apply this to a class, enter these widths in its rows of Tolerances: ± in mm or ° about the middle of the "
    "deviations that it has, ± in % of the value, or the grade of that number. At most five IT grades wider or finer, "
    "and ± 10 % of a value.",
)
_SENTENCES = 12
"""Most classes of which the sheet says in words what they may have."""

_WIDTHS = {
    "tolerance_class": 22.0,
    "dimension": 24.0,
    "unit": 10.0,
    "limited_by": 46.0,
    "possible": 9.0,
    "reason": 60.0,
}
_WIDTH = 11.0
_WRAPPED = frozenset({"limited_by", "reason"})
_CODES = {"grade_steps": "+0.0;-0.0;0.0", "relative_cost": "+0.0;-0.0;0.0"}


def write_allocation(book: Book, allocation: pl.DataFrame, target_percent: float) -> None:
    """Write a row for each tolerance of each class; no sheet where no class has a variant with a limit."""
    if allocation.is_empty():
        return
    columns = [column for column in ALLOCATION if allocation[column.key].is_not_null().any()]
    widths = [_WIDTHS.get(column.key, _WIDTH) for column in columns]
    sheet = book.sheet(ALLOCATED)
    sheet.write_string(0, 0, "Tolerances of a class at least cost", book.format("title"))
    sheet.set_row(0, 28)
    header = _write_notes(book, sheet, [*_NOTES, *allocation_lines(allocation, target_percent, _SENTENCES)], widths)
    for place, (column, width) in enumerate(zip(columns, widths, strict=True)):
        sheet.set_column(place, place, width)
        sheet.write_string(header, place, column.label, book.format("header"))
    sheet.set_row(header, 2 * LINE_HEIGHT + 2)
    _write_rows(book, sheet, header + 1, columns, _once_a_class(allocation))
    last = (header + allocation.height, len(columns) - 1)
    line = book.workbook.add_format({"top": 1, "top_color": PALETTE["grey"]})
    new_class = {"type": "formula", "criteria": f"=$A{header + 2}<>$A{header + 1}", "format": line}
    sheet.conditional_format(header + 1, 0, *last, new_class)
    sheet.autofilter(header, 0, *last)
    sheet.freeze_panes(header + 1, 2)
    sheet.repeat_rows(header)
    print_readably(sheet, widths, least=SMALL)


def _write_notes(book: Book, sheet: Any, notes: list[str], widths: list[float]) -> int:
    """Write notes across all columns, each as high as it needs; return the row of the header."""
    for row, note in enumerate(notes, start=1):
        style = "note" if row <= len(_NOTES) else "wrap"
        sheet.merge_range(row, 0, row, len(widths) - 1, note, book.format(style))
        sheet.set_row(row, LINE_HEIGHT * lines_of(note, sum(widths)))
    return len(notes) + 2


def _once_a_class(allocation: pl.DataFrame) -> pl.DataFrame:
    """Return the table with the reason of a class in its first row alone."""
    first = pl.col("tolerance_class").is_first_distinct()
    return allocation.with_columns(pl.when(first).then(pl.col("reason")).alias("reason"))


def _write_rows(book: Book, sheet: Any, top: int, columns: list[Column], allocation: pl.DataFrame) -> None:
    for row, cells in enumerate(allocation.iter_rows(named=True), start=top):
        lines = 1
        for place, column in enumerate(columns):
            value, key = cells[column.key], column.key
            if isinstance(value, str):
                shown = dimension_title(value) if key == "dimension" else value
                sheet.write_string(row, place, shown, book.format("indented wrap" if key in _WRAPPED else "indented"))
                lines = max(lines, lines_of(shown, _WIDTHS[key] - 1) if key in _WRAPPED else 1)
            elif value is not None:
                look = "ok" if key == "to_value" and value != cells["from_value"] else "text"
                sheet.write_number(row, place, value, book.format(look, _CODES.get(key, "general")))
        if lines > 1:
            sheet.set_row(row, LINE_HEIGHT * lines)
