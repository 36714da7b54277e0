"""A worksheet that takes rows as columns of values: cell by cell they cost several times as much to write."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from flexlash.report.layout.report_worksheet import ReportWorksheet
from flexlash.schema.cell_addresses import column_letters

__all__ = ["GivenRows"]

Values = Sequence[str | float | None]

_LONGEST = 32_767
"""Characters that a cell can hold."""

_PIECE = 500
"""Rows whose text is held at a time."""


class GivenRows(ReportWorksheet):
    """A worksheet whose lower rows are given at once.

    It writes them as XlsxWriter would, without a record of each cell in between. What it uses of XlsxWriter for that
    is not public; the tests compare what both write.
    """

    def __init__(self) -> None:
        """Make a worksheet to which no rows are given."""
        super().__init__()
        self._first = 0
        self._columns: Sequence[tuple[Values, Sequence[Any]]] = ()
        self._heights: Mapping[int, float] = {}
        self._texts: dict[str, int] = {}
        self.dim_rowmax: int | None

    def give(
        self, first: int, columns: Sequence[tuple[Values, Sequence[Any]]], heights: Mapping[int, float] | None = None
    ) -> None:
        """Take the rows from `first` on, counted from 0: of each column the values, None for a blank, and formats.

        `heights` [pt] are those of single rows. Nothing else may stand below these rows; a cell that is written by
        itself stands instead of the one given.
        """
        self._first, self._columns, self._heights = first, columns, heights or {}
        self.heights |= self._heights
        self.dim_rowmax = max(self.dim_rowmax or 0, first + len(columns[0][0]) - 1)
        for values, _ in columns:
            for text in dict.fromkeys(value for value in values if isinstance(value, str)):
                self._texts[text] = self.str_table._get_shared_string_index(text[:_LONGEST])  # noqa: SLF001

    def _write_rows(self) -> None:
        """Write the rows above cell by cell, then those that were given."""
        last, self.dim_rowmax = self.dim_rowmax, self._first - 1
        super()._write_rows()
        self.dim_rowmax = last
        for row, cells in self._given():
            height = f' ht="{self._heights[row]:.16g}" customHeight="1"' if row in self._heights else ""
            self.fh.write(f'<row r="{row + 1}"{height}>')
            if own := self.table.get(row):
                for column in range(self.dim_colmax + 1):
                    if column in own:
                        self._write_cell(row, column, own[column])
                    elif column < len(cells):
                        self.fh.write(cells[column])
            else:
                self.fh.write("".join(cells))
            self.fh.write("</row>")

    def _given(self) -> Iterator[tuple[int, tuple[str, ...]]]:
        """Yield each given row with the text of its cells."""
        styles = {id(style): style for _, formats in self._columns for style in formats}
        numbers = {key: style._get_xf_index() for key, style in styles.items()}  # noqa: SLF001
        for start in range(0, len(self._columns[0][0]) if self._columns else 0, _PIECE):
            piece = slice(start, start + _PIECE)
            first = self._first + start + 1
            columns = [
                [
                    ""
                    if value is None
                    else f'<c r="{letters}{row}" s="{numbers[id(style)]}" t="s"><v>{self._texts[value]}</v></c>'
                    if isinstance(value, str)
                    else f'<c r="{letters}{row}" s="{numbers[id(style)]}"><v>{value:.16G}</v></c>'
                    for row, (value, style) in enumerate(zip(values[piece], formats[piece], strict=True), start=first)
                ]
                for letters, (values, formats) in zip(
                    map(column_letters, range(1, len(self._columns) + 1)), self._columns, strict=True
                )
            ]
            yield from enumerate(zip(*columns, strict=True), start=first - 1)
