"""Numbers of a delimited text whose sign may separate decimals or thousands: settled by the others, or put in doubt."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple, TypeAlias

from flexlash.reading.raw import CommaNumber, DoubtfulNumber, RawValue

__all__ = ["Marks", "Settled", "mark", "numbers_of", "settle_numbers", "settled_marks", "sign_of"]

_NUMBER = re.compile(
    r"""\s*[+-]?(?:
    (?P<open_comma>[1-9]\d{0,2},\d{3})
    |(?P<open_point>[1-9]\d{0,2}\.\d{3})
    |(?P<comma>\d*,\d+(?:[eE][+-]?\d{1,3})?)
    |(?P<point>\d*\.\d+(?:[eE][+-]?\d{1,3})?)
    |(?P<thousands_points>[1-9]\d{0,2}(?:(?:\.\d{3})+,\d+|(?:\.\d{3}){2,}))
    |(?P<thousands_commas>[1-9]\d{0,2}(?:(?:,\d{3})+\.\d+|(?:,\d{3}){2,}))
    )\s*""",
    re.ASCII | re.VERBOSE,
)
"""Numbers by what their signs can be, the first that fits: 1,6 has a decimal comma, 1.200 may be 1.2 or 1200."""

_SHORT = 50
"""Characters of most numbers; what a longer text is, is not kept in mind."""

_PREVAILING = 3
"""So many times more numbers with one decimal sign than with the other make the others the odd ones."""

_Rows = dict[int, dict[int, RawValue]]

Marks: TypeAlias = Mapping[str, type[CommaNumber | DoubtfulNumber]]
"""What takes the place of a text, by the kind of its number."""


class Settled(NamedTuple):
    """The first number whose decimal comma is beyond doubt, and whether any number's decimal point is."""

    comma_number: tuple[int, int] | None = None
    has_decimal_point: bool = False


def settle_numbers(
    rows: _Rows, columns: Collection[int] | None, others: Collection[int] = (), *, delimiter: str
) -> Settled:
    """Mark the numbers with a decimal comma, and those in doubt; return what was settled.

    `columns` are those that hold numbers, None for all, and `others` those that hold none. What stands elsewhere, such
    as 1.2 for a revision, is marked and tells nothing.

    A point before three digits is taken as decimal only where another number can have nothing but a decimal point
    and no comma contradicts. In a table separated by commas it is decimal unless a quoted number has a decimal comma.
    """
    counts = Counter(kind for *_, kind in numbers_of(rows, columns))
    marks, has_decimal_point = settled_marks(counts, delimiter)
    first = None
    if marks.get("comma") is CommaNumber:
        first = next((row, column) for row, column, _, kind in numbers_of(rows, columns) if kind == "comma")
    mark(rows, others, marks)
    return Settled(comma_number=first, has_decimal_point=has_decimal_point)


def settled_marks(counts: Mapping[str, int], delimiter: str) -> tuple[Marks, bool]:
    """Return what takes the place of numbers, by how many there are of each kind, and whether a decimal point is sure.

    Where the comma is proven decimal, texts of the kind `comma` become CommaNumber, and never else.
    """
    counts = Counter(counts)
    commas, points = counts["comma"] + counts["thousands_points"], counts["point"] + counts["thousands_commas"]
    if counts["comma"] and delimiter != "," and commas >= _PREVAILING * points:
        open_commas = DoubtfulNumber if points or counts["open_point"] else CommaNumber
        doubtful = dict.fromkeys(("point", "thousands_commas", "open_point"), DoubtfulNumber)
        return {"comma": CommaNumber, "open_comma": open_commas, **doubtful}, points > 0
    is_proven = points and points >= _PREVAILING * commas
    if not is_proven and (commas or delimiter != ","):
        # The commas may be the only sign of the doubt: once fixed, they would leave 1.200 behind as an ordinary number.
        commas_too = ("comma", "thousands_points") if counts["open_point"] else ()
        return dict.fromkeys(("open_point", *commas_too), DoubtfulNumber), points > 0
    return {}, points > 0


def sign_of(text: str) -> str:
    """Return the kind of a number with a sign in it, an empty text for any other text."""
    return _sign_of(text) if len(text) <= _SHORT else _sign_of.__wrapped__(text)


@lru_cache(maxsize=10_000)
def _sign_of(text: str) -> str:
    match = _NUMBER.fullmatch(text) if "." in text or "," in text else None
    return (match.lastgroup or "") if match else ""


def numbers_of(rows: _Rows, columns: Collection[int] | None) -> Iterator[tuple[int, int, str, str]]:
    """Yield row, column, text and kind of every number with a sign in it."""
    for row, cells in rows.items():
        for column in tuple(cells) if columns is None else columns:
            cell = cells.get(column)
            if isinstance(cell, str) and ("." in cell or "," in cell) and (match := _NUMBER.fullmatch(cell)):
                yield row, column, cell, match.lastgroup or ""


def mark(rows: _Rows, others: Collection[int], marks: Marks) -> None:
    """Put numbers in the place of texts, by the kind of each, but in the columns that hold none."""
    for row, column, text, kind in numbers_of(rows, None):
        if kind in marks and column not in others:
            rows[row][column] = marks[kind](text)
