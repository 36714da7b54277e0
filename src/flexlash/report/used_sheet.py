"""The Tolerances used sheet: limits, mean and scatter of every dimension of every variant, and where these are from."""

from __future__ import annotations

from typing import Any

import polars as pl

from flexlash.analysis.outcome import Outcome
from flexlash.analysis.used_tolerances import used_tolerances
from flexlash.decisions.width_table import width_table
from flexlash.report.extent import extent_of
from flexlash.report.layout.paper import SMALL, print_readably
from flexlash.report.layout.result_formats import SHARE_OF_VARIANCE_ERROR
from flexlash.report.layout.styles import Book, decimals_of, percent_of
from flexlash.report.report_data import ReportData
from flexlash.schema.column import Column
from flexlash.schema.entry_words import dimension_title
from flexlash.schema.used_columns import TOLERANCES_USED

__all__ = ["USED", "write_used"]

USED = "Tolerances used"
_NOTES = (
    "Limits are the drawing's, whatever the process does: worst case and shares outside the drawing take them. Mean "
    "and standard deviation are those of the parts. A dimension without a row is exact.",
    "What Trace spread adds up for one variant stands here for all; the file of -o NAME.json holds "
    "the same with every digit, under tolerances. Relax to, Tighten to: half the width to which this tolerance alone "
    "may go, or must, by sheet Levers.",
)
_HEADER = len(_NOTES) + 2
_WIDTHS = {"variant": 26.0, "dimension": 24.0, "unit": 7.0, "distribution": 17.0, "scatters_with": 24.0, "source": 44.0}
_WIDTH = 12.0
_STYLES = dict.fromkeys(("distribution", "scatters_between", "source"), "indented") | {"scatters_with": "indented wrap"}
_MORE_DIGITS = {"mean": 10, "standard_deviation": 100}
"""A mean is shown with one digit more than the first of the standard deviation, this with two."""


def write_used(book: Book, outcome: Outcome, data: ReportData) -> None:
    """Write one row for each dimension that scatters or is shifted, of all variants or of those drawn of many."""
    extent = extent_of(outcome)
    variants = [one.computed for one in data.drawn] if extent.is_part else outcome.computed.values()
    frame = used_tolerances(variants, width_table(data.levers))
    columns = [column for column in TOLERANCES_USED if frame.is_empty() or frame[column.key].is_not_null().any()]
    sheet = book.sheet(USED)
    sheet.write_string(0, 0, "Tolerances as they were used", book.format("title"))
    sheet.set_row(0, 28)
    for row, note in enumerate(_NOTES, start=1):
        sheet.write_string(row, 0, note, book.format("quiet"))
    if extent.note:
        sheet.write_string(_HEADER - 1, 0, extent.note, book.format("quiet"))
    widths = [_WIDTHS.get(column.key, _WIDTH) for column in columns]
    for place, (column, width) in enumerate(zip(columns, widths, strict=True)):
        sheet.set_column(place, place, width)
        sheet.write_string(_HEADER, place, column.label, book.format("header"))
        _write_column(book, sheet, place, column, frame)
    sheet.set_row(_HEADER, 32)
    if frame.height:
        sheet.autofilter(_HEADER, 0, _HEADER + frame.height, len(columns) - 1)
    print_readably(sheet, widths, least=SMALL)
    sheet.freeze_panes(_HEADER + 1, 2)
    sheet.repeat_rows(_HEADER)


def _write_column(book: Book, sheet: Any, place: int, column: Column, frame: pl.DataFrame) -> None:
    """Write the cells of a column; a blank for none."""
    values, sds = frame[column.key].to_list(), frame["standard_deviation"].to_list()
    style = book.format(_STYLES.get(column.key, "text"))
    for row, (value, sd) in enumerate(zip(values, sds, strict=True), start=_HEADER + 1):
        if isinstance(value, str):
            shown = dimension_title(value) if column.key == "dimension" else value
            sheet.write_string(row, place, shown, style)
        elif value is not None:
            sheet.write_number(row, place, value, book.format("text", _code(column.key, sd)))


def _code(key: str, sd: float) -> str:
    """Return the number format of a column in a row of this standard deviation."""
    if key == "share":
        return percent_of(SHARE_OF_VARIANCE_ERROR)
    if key == "outside_limits_ppm":
        return "#,##0.0"
    return decimals_of(sd / _MORE_DIGITS[key], "general") if key in _MORE_DIGITS else "general"
