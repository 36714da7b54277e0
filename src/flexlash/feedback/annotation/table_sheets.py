"""Cells as read → a workbook, for submissions that are none."""

from __future__ import annotations

import datetime
import io
import math
import re
from collections.abc import Mapping
from typing import Any

import xlsxwriter

from flexlash.feedback.annotation.appearance import legible
from flexlash.reading.raw import ErrorCell, RawSheet, RawValue, Unstored

__all__ = ["table_workbook"]

_DATE = datetime.datetime(2026, 1, 1, tzinfo=datetime.UTC).replace(tzinfo=None)
_NUMBER = re.compile(r"-?(0|[1-9]\d*)(\.\d+)?([eE][+-]?\d+)?", re.ASCII)
_EXACT_INTEGER = 2**53
_FIRST_YEAR = 1901
_SHOWN = {
    datetime.datetime: "yyyy-mm-dd h:mm:ss",
    datetime.date: "yyyy-mm-dd",
    datetime.time: "h:mm:ss",
    datetime.timedelta: "[hh]:mm:ss",
}
"""Number format of each kind of date and time."""

_NARROW, _WIDE = 10, 40


def table_workbook(sheets: Mapping[str, RawSheet]) -> bytes:
    """Return a workbook with the cells of tables at their own addresses."""
    buffer = io.BytesIO()
    workbook = xlsxwriter.Workbook(buffer, {"in_memory": True})
    workbook.set_properties({"title": "flexlash marked copy", "author": "flexlash", "created": _DATE})
    formats = {kind: workbook.add_format({"num_format": shown}) for kind, shown in _SHOWN.items()}
    for title, raw in sheets.items():
        sheet = workbook.add_worksheet(title)
        longest: dict[int, int] = {}
        for row, cells in raw.rows.items():
            for column, value in cells.items():
                _write(sheet, row - 1, column - 1, _number(value) if raw.numbers_are_texts else value, formats)
                longest[column] = max(longest.get(column, 0), len(str(value)))
        for column, length in longest.items():
            sheet.set_column(column - 1, column - 1, max(_NARROW, min(_WIDE, length + 2)))
    workbook.close()
    return buffer.getvalue()


def _number(value: RawValue) -> RawValue:
    """Return the number that a text of a CSV file is, unless a number would not be written the same way."""
    number = float(value) if isinstance(value, str) and _NUMBER.fullmatch(value) else math.nan
    return number if math.isfinite(number) else value


def _write(sheet: Any, row: int, column: int, value: RawValue, formats: Mapping[type, Any]) -> None:
    """Write a value as what it is, and as a text where a workbook has no such value."""
    if isinstance(value, datetime.datetime | datetime.time):
        value = value.replace(tzinfo=None)
    dated = isinstance(value, datetime.date) and value.year >= _FIRST_YEAR
    if isinstance(value, bool):
        sheet.write_boolean(row, column, value)
    elif isinstance(value, int | float) and math.isfinite(value) and abs(value) <= _EXACT_INTEGER:
        sheet.write_number(row, column, value)
    elif dated or isinstance(value, datetime.time | datetime.timedelta):
        sheet.write_datetime(row, column, value, formats[type(value)])
    elif not isinstance(value, Unstored):
        sheet.write_string(row, column, legible(value.text if isinstance(value, ErrorCell) else value))
