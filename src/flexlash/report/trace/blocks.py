"""Pieces of the sheet Trace steps: named cells and tables, without a number where the inputs make no part."""

from __future__ import annotations

from typing import Any

from xlsxwriter.utility import xl_range_abs

from flexlash.report.formula.functions import on_sheet
from flexlash.report.formula.live import Live, Range, Value, fill, put
from flexlash.report.layout.styles import Book
from flexlash.report.trace.trace_page import Lines

__all__ = ["Block"]

_ENTRY = 2
"""Column of a block that holds its single numbers; their names reach over the columns before."""


class Block:
    """A piece of the sheet: named cells and tables one below the other."""

    def __init__(self, page: Lines, sheet: Any, *, left: int, row: int, heads: tuple[str, str]) -> None:
        self.page, self.sheet, self.left, self.row = page, sheet, left, row + 1
        self._table: dict[int, list[Value]] = {}
        self.book: Book = page.book
        sheet.write_string(row, left, heads[0], self.book.format("label"))
        sheet.write_string(row + 1, left, heads[1], self.book.format("quiet"))

    def links(self, **keys: str) -> list[Live]:
        """Write inputs, each linked to its line."""
        return [self.entry(name, on_sheet(self.page.title, self.page[key])) for name, key in keys.items()]

    def entry(self, name: str, value: Live) -> Live:
        """Write a named number and return the reference to it."""
        self.row += 1
        self.sheet.write_string(self.row, self.left, name, self.book.format("text"))
        return self._put(_ENTRY, value)

    def heads(self, *headings: str) -> None:
        """Begin a table."""
        self.row += 1
        self._table = {}
        for column, heading in enumerate(headings):
            self.sheet.write_string(self.row, self.left + column, heading, self.book.format("header"))

    def cell(self, column: int, value: Live | float) -> Live:
        """Write a cell of the current row of a table and return the reference to it."""
        if isinstance(value, Live):
            cell = self._put(column, value)
        else:
            cell = fill(self.sheet, self.row, self.left + column, value, self.book.format("text", "general"))
        self._table.setdefault(column, []).append(cell.value)
        return cell

    def column(self, column: int) -> Range:
        """Return a column of the table, which ends with the current row."""
        values, across = self._table[column], self.left + column
        return Range(xl_range_abs(self.row - len(values) + 1, across, self.row, across), values)

    def _put(self, column: int, value: Live) -> Live:
        style = self.book.format("text", "general")
        return put(self.sheet, self.row, self.left + column, self.page.of_part(value, sheet=self.page.title), style)
