"""The cells of worksheets, read with openpyxl.

Of openpyxl the parser of cells is used, not its sheets: those fill every gap before a far cell with blank cells.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from typing import Any
from xml.etree.ElementTree import iterparse

from openpyxl.cell.text import Text
from openpyxl.reader.excel import ExcelReader
from openpyxl.styles.numbers import BUILTIN_FORMATS
from openpyxl.styles.stylesheet import apply_stylesheet
from openpyxl.worksheet._reader import WorkSheetParser

from flexlash.reading.elements import MAIN
from flexlash.reading.raw import Percentage

__all__ = ["SheetCells"]

_ROWS, _ROW, _CELL = f"{{{MAIN}}}sheetData", f"{{{MAIN}}}row", f"{{{MAIN}}}c"
_QUOTED = re.compile(r'"[^"]*"|\\.')
"""Parts of a number format that are shown as they are."""

_FIRST_OWN_FORMAT = 164
_PIECE = 2**20
"""Read in pieces this large, a long piece of markup is not looked through again for each of many small ones."""


class _Part:
    """A part as a file that is read in large pieces."""

    def __init__(self, part: bytes) -> None:
        self.file = io.BytesIO(part)

    def read(self, _: int = -1) -> bytes:
        return self.file.read(_PIECE)


class SheetCells:
    """A workbook opened for its cells; `strings` is the part of the texts that its cells share."""

    def __init__(self, data: bytes, strings: bytes | None) -> None:
        reader = ExcelReader(io.BytesIO(data), read_only=True, data_only=True, keep_links=False)
        reader.read_manifest()
        reader.read_workbook()
        reader.read_custom()
        self.workbook = reader.wb
        apply_stylesheet(reader.archive, self.workbook)
        self.strings = _texts(strings) if strings else []
        self.percentages = _percent_styles(self.workbook)

    def properties(self) -> dict[str, str]:
        """Return the document properties that are no standard ones, by name."""
        return {property_.name: str(property_.value) for property_ in self.workbook.custom_doc_props.props}

    def rows(self, part: bytes) -> Iterator[tuple[int, list[tuple[int, Any]]]]:
        """Yield the rows of a worksheet that hold cells: a number, and each non-blank cell's column and value."""
        for number, cells in _Parser(_Part(part), self.strings, self.workbook).parse():
            if filled := [(cell["column"], self._value(cell)) for cell in cells if cell["value"] is not None]:
                yield number, filled

    def _value(self, cell: dict[str, Any]) -> Any:
        """Return a cell's value; one that is shown as a percentage knows it."""
        is_number = cell["data_type"] == "n" and isinstance(cell["value"], int | float)
        return Percentage(cell["value"]) if is_number and cell["style_id"] in self.percentages else cell["value"]


def _texts(part: bytes) -> list[str]:
    """Return the texts that cells share; openpyxl's own reader drops x005F_, the escape of an underscore, too early."""
    texts = []
    # The walk has refused document types; the guarded parser that openpyxl takes is slow.
    for _, element in iterparse(_Part(part)):  # noqa: S314
        if element.tag == f"{{{MAIN}}}si":
            texts.append(Text.from_tree(element).content)
            element.clear()
    return texts


def _percent_styles(workbook: Any) -> frozenset[int]:
    """Return the cell formats that show a number as a percentage."""
    own = workbook._number_formats  # noqa: SLF001
    percentages = set()
    for index, style in enumerate(workbook._cell_styles):  # noqa: SLF001
        number = style.numFmtId
        custom = number - _FIRST_OWN_FORMAT
        shape = own[custom] if 0 <= custom < len(own) else BUILTIN_FORMATS.get(number, "")
        if "%" in _QUOTED.sub("", shape):
            percentages.add(index)
    return frozenset(percentages)


class _Parser(WorkSheetParser):  # type: ignore[misc]
    """Reads the cells of a worksheet, and nothing else of it."""

    def __init__(self, part: _Part, strings: list[str], book: Any) -> None:
        super().__init__(
            part,
            strings,
            data_only=True,
            epoch=book.epoch,
            date_formats=book._date_formats,  # noqa: SLF001
            timedelta_formats=book._timedelta_formats,  # noqa: SLF001
        )

    def parse(self) -> Iterator[tuple[int, list[dict[str, Any]]]]:
        """Yield each row's number and cells."""
        is_over = False
        # The walk has refused document types and rows elsewhere; the guarded parser that openpyxl takes is slow.
        for _, element in iterparse(self.source):  # noqa: S314
            if element.tag == _ROW:
                yield self.parse_row(element)
                element.clear()
            is_over = is_over or element.tag == _ROWS
            if is_over:
                element.clear()

    def parse_row(self, row: Any) -> tuple[int, list[dict[str, Any]]]:
        """Return a row's number and its cells; a row's looks are not kept."""
        number = row.get("r")
        self.row_counter: int = self.row_counter + 1 if number is None else int(number)
        self.col_counter = 0
        return self.row_counter, [self.parse_cell(cell) for cell in row.iterfind(_CELL)]
