"""The values of cells, read with openpyxl.

Of openpyxl the parser of cells is used, not its sheets: those fill every gap before a far cell with blank cells.
"""

from __future__ import annotations

import io
import re
from typing import Any
from xml.etree.ElementTree import Element, iterparse

from openpyxl.cell.text import Text
from openpyxl.reader.excel import ExcelReader
from openpyxl.styles.numbers import BUILTIN_FORMATS
from openpyxl.styles.stylesheet import apply_stylesheet
from openpyxl.worksheet._reader import WorkSheetParser

from flexlash.reading.elements import MAIN
from flexlash.reading.raw import Percentage

__all__ = ["SheetCells"]

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


class _Cell:
    """A cell as an element, of which openpyxl's parser asks no more than this."""

    __slots__ = ("_attributes", "_held")

    def __init__(self, kind: str, style: int, held: str | Element) -> None:
        self._attributes = {"t": kind, "s": style}
        self._held = held

    def get(self, name: str, default: object = None) -> object:
        return self._attributes.get(name, default)

    def findtext(self, *_: object) -> object:
        return self._held

    def find(self, _: str) -> object:
        return self._held


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
        self.parser = WorkSheetParser(
            None,
            self.strings,
            data_only=True,
            epoch=self.workbook.epoch,
            date_formats=self.workbook._date_formats,  # noqa: SLF001
            timedelta_formats=self.workbook._timedelta_formats,  # noqa: SLF001
        )

    def properties(self) -> dict[str, str]:
        """Return the document properties that are no standard ones, by name."""
        return {property_.name: str(property_.value) for property_ in self.workbook.custom_doc_props.props}

    def value(self, kind: str, style: int, held: str | Element) -> Any:
        """Return the value of a cell as it is written; one that is shown as a percentage knows it, None is blank."""
        cell = self.parser.parse_cell(_Cell(kind, style, held))
        value = cell["value"]
        if style in self.percentages and cell["data_type"] == "n" and isinstance(value, int | float):
            return Percentage(value)
        return value


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
