"""Raw cells → cells of a new workbook that read as the same: texts as texts, faulty cells as faulty as they were."""

from __future__ import annotations

import datetime
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from flexlash.reading.raw import ErrorCell, Percentage, Unstored

__all__ = ["DATE_FORMATS", "CellWriter", "Formula", "writable"]

DATE_FORMATS = {
    "date": "d mmm",
    "moment": "yyyy-mm-dd hh:mm:ss",
    "time": "hh:mm:ss",
    "duration": "[hh]:mm:ss",
    "percentage": "0.##########%",
}
"""Number formats by what a cell holds, where the number alone would not tell."""

_EXAMPLE = "=0.8*2"
"""The formula of an example whose result is not stored."""

_ERRORS = frozenset(("#DIV/0!", "#N/A", "#NAME?", "#NULL!", "#NUM!", "#REF!", "#VALUE!"))
"""Errors that a formula can name; the others are written as the words that they show."""

_LONGEST_TEXT = 32_767
_FIRST_DATE = datetime.date(1900, 1, 1)


@dataclass(frozen=True, kw_only=True)
class Formula:
    """A formula and its stored result, None without one."""

    text: str
    result: float | None = None


class _Exact(float):
    digits: str
    """A number that is written with all of its digits, where the writer keeps sixteen, and a whole one as such."""

    def __new__(cls, value: float) -> Self:
        number = super().__new__(cls, value)
        number.digits = repr(value)
        return number

    def __format__(self, _: str) -> str:
        return self.digits


def writable(value: Any) -> Any:
    """Return a cell's value as a workbook can hold it: what has no form there as the text that says it."""
    if isinstance(value, str):
        return value[:_LONGEST_TEXT]
    if isinstance(value, ErrorCell):
        return value if value.text in _ERRORS else value.text
    if isinstance(value, bool | Formula | Unstored | datetime.time | datetime.timedelta):
        return str(value) if getattr(value, "tzinfo", None) else value
    if isinstance(value, int | float):
        return value if abs(value) < 1e308 else str(value)  # noqa: PLR2004
    if isinstance(value, datetime.date):
        day = value.date() if isinstance(value, datetime.datetime) else value
        return value if day >= _FIRST_DATE and not getattr(value, "tzinfo", None) else value.isoformat()
    return str(value)[:_LONGEST_TEXT]


class CellWriter:
    """Writes values of any kind to a sheet; `dates` are the formats of cells that hold a point or a length of time."""

    def __init__(self, sheet: Any, dates: Mapping[str, Any]) -> None:
        self.sheet = sheet
        self.dates = dates

    def write(self, row: int, column: int, value: Any, style: Any) -> None:
        """Write a value, None not at all."""
        value = None if value is None else writable(value)
        if isinstance(value, str):
            self.sheet.write_string(row, column, value, style)
        elif isinstance(value, bool):
            self.sheet.write_boolean(row, column, value, style)
        elif isinstance(value, datetime.date | datetime.time | datetime.timedelta):
            self.sheet.write_datetime(row, column, value, self.dates[_kind(value)])
        elif isinstance(value, ErrorCell):
            self.sheet.write_formula(row, column, f"={value.text}", style, value.text)
        elif isinstance(value, Formula | Unstored):
            formula = Formula(text=_EXAMPLE) if isinstance(value, Unstored) else value
            self.sheet.write_formula(row, column, formula.text, style, "" if formula.result is None else formula.result)
        elif value is not None:
            shape = self.dates["percentage"] if isinstance(value, Percentage) else style
            self.sheet.write_number(row, column, _Exact(value), shape)


def _kind(value: datetime.date | datetime.time | datetime.timedelta) -> str:
    """Return which of the date formats shows a value whole."""
    if isinstance(value, datetime.time):
        return "time"
    if isinstance(value, datetime.timedelta):
        return "duration"
    whole = not isinstance(value, datetime.datetime) or value.time() == datetime.time()
    return "date" if whole else "moment"
