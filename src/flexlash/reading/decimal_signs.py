"""Numbers of a delimited text whose sign may separate decimals or thousands: settled by the others, or put in doubt."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

from flexlash.reading.raw import CommaNumber, DoubtfulNumber, RawValue

__all__ = ["Settled", "settle_numbers"]

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

_PREVAILING = 3
"""So many times more numbers with one decimal sign than with the other make the others the odd ones."""

_Rows = dict[int, dict[int, RawValue]]


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
    counts = Counter(kind for *_, kind in _numbers(rows, columns))
    commas, points = counts["comma"] + counts["thousands_points"], counts["point"] + counts["thousands_commas"]
    settled = Settled(has_decimal_point=points > 0)
    if counts["comma"] and delimiter != "," and commas >= _PREVAILING * points:
        first = next((row, column) for row, column, _, kind in _numbers(rows, columns) if kind == "comma")
        open_commas = DoubtfulNumber if points or counts["open_point"] else CommaNumber
        doubtful = dict.fromkeys(("point", "thousands_commas", "open_point"), DoubtfulNumber)
        _mark(rows, others, {"comma": CommaNumber, "open_comma": open_commas, **doubtful})
        return settled._replace(comma_number=first)
    is_proven = points and points >= _PREVAILING * commas
    if not is_proven and (commas or delimiter != ","):
        # The commas may be the only sign of the doubt: once fixed, they would leave 1.200 behind as an ordinary number.
        commas_too = ("comma", "thousands_points") if counts["open_point"] else ()
        _mark(rows, others, dict.fromkeys(("open_point", *commas_too), DoubtfulNumber))
    return settled


def _numbers(rows: _Rows, columns: Collection[int] | None) -> Iterator[tuple[int, int, str, str]]:
    """Yield row, column, text and kind of every number with a sign in it."""
    for row, cells in rows.items():
        for column in tuple(cells) if columns is None else columns:
            cell = cells.get(column)
            if isinstance(cell, str) and ("." in cell or "," in cell) and (match := _NUMBER.fullmatch(cell)):
                yield row, column, cell, match.lastgroup or ""


def _mark(rows: _Rows, others: Collection[int], marks: Mapping[str, type[CommaNumber | DoubtfulNumber]]) -> None:
    """Put numbers in the place of texts, by the kind of each."""
    for row, column, text, kind in _numbers(rows, None):
        if kind in marks and column not in others:
            rows[row][column] = marks[kind](text)
