"""What reading yields: sheets of raw cells at their own addresses."""

from __future__ import annotations

import datetime
from dataclasses import dataclass, field
from typing import TypeAlias

__all__ = ["ERROR_WORDS", "ErrorCell", "RawSheet", "RawValue", "Submission", "Unstored", "column_letters"]

ERROR_WORDS = frozenset((
    "#REF!", "#DIV/0!", "#VALUE!", "#NAME?", "#N/A", "#NUM!", "#NULL!", "#SPILL!", "#CALC!", "#FIELD!", "#BLOCKED!",
    "#CONNECT!", "#UNKNOWN!", "#BUSY!", "#GETTING_DATA", "#EXTERNAL!", "#PYTHON!",
))  # fmt: skip
"""Error words, which some programs store as plain texts."""


@dataclass(frozen=True)
class ErrorCell:
    """A cell that shows an Excel error."""

    text: str


@dataclass(frozen=True)
class Unstored:
    """A formula whose result was never stored."""


RawValue: TypeAlias = (
    str | float | int | bool | datetime.date | datetime.time | datetime.timedelta | ErrorCell | Unstored
)


@dataclass(frozen=True, kw_only=True)
class RawSheet:
    """Cells by row and column number, both from 1 as the user counts; blank cells are absent.

    `numbers_are_texts` tells a CSV sheet, in which a text may be a number. `hidden_rows` hold cells that Excel does
    not show; `merged` are areas as (first row, first column, last row, last column).
    """

    name: str
    rows: dict[int, dict[int, RawValue]]
    numbers_are_texts: bool = False
    hidden: bool = False
    hidden_rows: frozenset[int] = frozenset()
    merged: tuple[tuple[int, int, int, int], ...] = ()


@dataclass(frozen=True, kw_only=True)
class Submission:
    """A submission as read. `role` is what its document properties say it is."""

    name: str
    sha256: str
    kind: str
    sheets: dict[str, RawSheet] = field(default_factory=dict)
    modified: datetime.datetime | None = None
    role: str = ""
    template_version: str = ""
    delimiter: str = ""


def column_letters(number: int) -> str:
    """Return the letters of a column number.

    >>> column_letters(28)
    'AB'
    """
    letters = ""
    while number:
        number, rest = divmod(number - 1, 26)
        letters = chr(65 + rest) + letters
    return letters
