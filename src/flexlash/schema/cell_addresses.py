"""Where a cell stands: its row and its column, printed as `D7` only where a person or a file reads it."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable
from typing import NamedTuple

__all__ = ["CellAddress", "cell_address", "cell_ranges", "column_letters", "column_number"]

_ADDRESS = re.compile(r"([A-Za-z]{1,3})([1-9]\d{0,6})", re.ASCII)


class CellAddress(NamedTuple):
    """Row and column of a cell, both from 1 as the user counts.

    >>> str(CellAddress(row=7, column=4))
    'D7'
    """

    row: int
    column: int

    def __str__(self) -> str:
        """Return the address as Excel writes it."""
        return f"{column_letters(self.column)}{self.row}"


def cell_address(text: str) -> CellAddress | None:
    """Return the address that a text is, None for a text that is none.

    >>> cell_address("D7"), cell_address("D0")
    (CellAddress(row=7, column=4), None)
    """
    match = _ADDRESS.fullmatch(text)
    return CellAddress(row=int(match[2]), column=column_number(match[1])) if match else None


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


def column_number(letters: str) -> int:
    """Return the number of a column's letters.

    >>> column_number("ab")
    28
    """
    number = 0
    for letter in letters.upper():
        number = number * 26 + ord(letter) - 64
    return number


def cell_ranges(addresses: Iterable[CellAddress], most: int = 20) -> str:
    """Return cell addresses with runs in a column drawn together, as many of them as a line may hold.

    >>> cell_ranges([CellAddress(row, 4) for row in (6, 7, 8, 14)] + [CellAddress(3, 5)])
    'D6:D8, D14, E3'
    """
    by_column: dict[int, set[int]] = defaultdict(set)
    for row, column in addresses:
        by_column[column].add(row)
    ranges = []
    for column, rows in sorted(by_column.items()):
        letters = column_letters(column)
        firsts, lasts = sorted(rows - {row + 1 for row in rows}), sorted(rows - {row - 1 for row in rows})
        for first, last in zip(firsts, lasts, strict=True):
            ranges.append(f"{letters}{first}" if first == last else f"{letters}{first}:{letters}{last}")
    more = f" and {len(ranges) - most} more" if len(ranges) > most else ""
    return ", ".join(ranges[:most]) + more
