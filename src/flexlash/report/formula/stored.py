"""Data sheets behind the sheets that move: one row per drawn variant, looked up by its number."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from flexlash.report.formula.functions import IF, INDEX
from flexlash.report.formula.live import Live, Range
from flexlash.report.layout.styles import Book
from flexlash.report.layout.wrapping import LINE_HEIGHT, lines_of, merged_width

__all__ = ["FIRST_ROW", "Stored"]

FIRST_ROW = 2
"""Row, from 0, of the first variant; above it stand a note and the headings."""

_HEADING = 9
"""Characters of a heading on one line."""

_NAME, _NUMBER, _LONGEST = 24.0, 9.3, 40.0
"""Widths of names and numbers, and of the longest texts."""

_NOT_PRINTED = "Stored numbers, not meant for print: only the first rows and columns are printed."
_PAGE = 110.0
_PRINTED = 12
"""Width of the columns and number of variants that are printed."""

Row = Mapping[str, "str | float | None"]


class Stored:
    """A data sheet whose rows are the drawn variants, worst first, and whose columns are found by heading.

    Each row holds the headings in the same order; a blank cell is None.
    """

    def __init__(self, name: str, rows: Sequence[Row]) -> None:
        self.name = name
        self.rows = rows
        self.headings = list(rows[0]) if rows else []
        self._columns = {heading: column for column, heading in enumerate(self.headings)}

    def cells(self, heading: str) -> Range:
        """Return the range of a column, the variants alone."""
        letter = xl_col_to_name(self._columns[heading])
        values = ["" if (value := row[heading]) is None else value for row in self.rows]
        return Range(f"{self.name}!${letter}${FIRST_ROW + 1}:${letter}${FIRST_ROW + len(self.rows)}", values)

    def series(self, heading: str, count: int | None = None) -> list[Any]:
        """Return a column's range as charts want it, of all variants or the first few."""
        column = self._columns[heading]
        last = FIRST_ROW + (len(self.rows) if count is None else count) - 1
        return [self.name, FIRST_ROW, column, last, column]

    def across(self, place: int, first: str, last: str) -> list[Any]:
        """Return the cells of one variant, counted from 0, between two headings as charts want them."""
        row = FIRST_ROW + place
        return [self.name, row, self._columns[first], row, self._columns[last]]

    def pick(self, number: Live, heading: str, times: Live | None = None) -> Live:
        """Return what a column holds for the variant of a number, from 1, times a factor; a blank is an empty text."""
        cells = self.cells(heading)
        entry = INDEX(cells, number)
        scaled = entry if times is None else entry * times
        return IF(entry.equals(""), "", scaled) if "" in cells.values else scaled

    def write(self, book: Book, note: str) -> None:
        """Write the sheet."""
        sheet = book.sheet(self.name, tab="stored")
        self._write_note(book, sheet, f"{note} {_NOT_PRINTED}")
        for column, heading in enumerate(self.headings):
            sheet.write_string(1, column, heading, book.format("header"))
        sheet.set_row(1, 15.5 * max((1 + len(heading) // _HEADING for heading in self.headings), default=1))
        text, number = book.format("text"), book.format("text", "general")
        for row, values in enumerate(self.rows, start=FIRST_ROW):
            for column, value in enumerate(values.values()):
                if isinstance(value, str):
                    sheet.write_string(row, column, value, text)
                elif value is not None:
                    sheet.write_number(row, column, value, number)
        sheet.freeze_panes(FIRST_ROW, 1)

    def _write_note(self, book: Book, sheet: Any, note: str) -> None:
        """Write a note across the columns that are printed, and set their widths."""
        widths: list[float] = []
        while sum(widths) < _PAGE:
            widths.append(self._width(len(widths)))
        for column in range(max(len(widths), len(self.headings))):
            sheet.set_column(column, column, self._width(column))
        last = len(widths) - 1
        sheet.merge_range(0, 0, 0, last, note, book.format("wrap"))
        sheet.set_row(0, LINE_HEIGHT * lines_of(note, merged_width(widths)))
        sheet.print_area(0, 0, FIRST_ROW + min(max(len(self.rows), 1), _PRINTED) - 1, last)

    def _width(self, column: int) -> float:
        """Return the width of a column: of its longest text, if it has one."""
        heading = self.headings[column] if column < len(self.headings) else ""
        texts = [len(value) for row in self.rows if isinstance(value := row.get(heading), str)]
        least = _NAME if column < 1 else _NUMBER
        return min(max([least, *texts]), _LONGEST)
