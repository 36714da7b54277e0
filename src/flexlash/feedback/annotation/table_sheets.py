"""Cells as read → worksheets, for submissions that are no workbook."""

from __future__ import annotations

import datetime
import math
import re
from typing import Any

from openpyxl import Workbook
from openpyxl.utils import get_column_letter

from flexlash.feedback.annotation.appearance import put
from flexlash.reading.raw import ErrorCell, RawSheet, RawValue, Unstored

__all__ = ["add_table"]

_NUMBER = re.compile(r"-?(0|[1-9]\d*)(\.\d+)?([eE][+-]?\d+)?", re.ASCII)
_EXACT_INTEGER = 2**53
_FIRST_YEAR = 1901
_NARROW, _WIDE = 10, 40


def add_table(workbook: Workbook, title: str, raw: RawSheet) -> None:
    """Add a sheet with a table's cells at their own addresses."""
    sheet = workbook.create_sheet(title)
    longest: dict[int, int] = {}
    for row, cells in raw.rows.items():
        for column, value in cells.items():
            _write(sheet.cell(row, column), _number(value) if raw.numbers_are_texts else value)
            longest[column] = max(longest.get(column, 0), len(str(value)))
    for column, length in longest.items():
        sheet.column_dimensions[get_column_letter(column)].width = max(_NARROW, min(_WIDE, length + 2))


def _number(value: RawValue) -> RawValue:
    """Return the number that a text of a CSV file is, unless a number would not be written the same way."""
    number = float(value) if isinstance(value, str) and _NUMBER.fullmatch(value) else math.nan
    return number if math.isfinite(number) else value


def _write(cell: Any, value: RawValue) -> None:
    """Write a value as what it is, and as a text where a workbook has no such value."""
    if isinstance(value, datetime.datetime | datetime.time):
        value = value.replace(tzinfo=None)
    number = isinstance(value, int | float) and math.isfinite(value) and abs(value) <= _EXACT_INTEGER
    dated = isinstance(value, datetime.date) and value.year >= _FIRST_YEAR
    if number or dated or isinstance(value, datetime.time | datetime.timedelta):
        cell.value = value
    elif isinstance(value, ErrorCell):
        put(cell, value.text)
    elif not isinstance(value, Unstored):
        put(cell, value)
