"""One walk through a worksheet's XML: its cells as they are written, and what would be read wrongly.

Formulas without a stored result, error cells, texts in an unusual place, hidden rows and merged areas are noted.
Refused is what a reader would take for something else without a word: rows or cells out of order, indices without a
target, texts as numbers.
"""

from __future__ import annotations

import math
import re
from typing import TypeAlias
from xml.etree.ElementTree import Element, TreeBuilder

from flexlash.reading.elements import MAIN, Elements
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.cell_addresses import CellAddress, cell_address

__all__ = ["MAXIMUM_COLUMN", "MAXIMUM_ROW", "Worksheet", "WrittenCell"]

WrittenCell: TypeAlias = tuple[int, str, int, str | Element]
"""A cell as it is written: column, type, style, and its value's text or the element of a text that it holds inside."""

MAXIMUM_ROW = 1_048_576
MAXIMUM_COLUMN = 16_384
"""The corner of every sheet, XFD1048576."""

_NUMBER = re.compile(r"\s*[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?\s*", re.ASCII)
_INDEX = re.compile(r"\s*\d{1,9}\s*", re.ASCII)
_AREA = re.compile(r"([A-Za-z]{1,3}[1-9]\d{0,6})(?::([A-Za-z]{1,3}[1-9]\d{0,6}))?", re.ASCII)
_KINDS = frozenset(("n", "s", "str", "b", "e", "inlineStr", "d"))
_TRUE = frozenset(("1", "true", "on"))


def _address(reference: str) -> CellAddress:
    """Return a cell's address; raise Refusal when a text is none, or beyond the sheet's corner."""
    address = cell_address(reference)
    if address is None or address.row > MAXIMUM_ROW or address.column > MAXIMUM_COLUMN:
        raise Refusal("E102")
    return address


class Worksheet(Elements):
    """What a worksheet holds; `styles` and `strings` are how many of them its cells may refer to.

    `rows` are the cells that have a value, as they are written, by row; none are kept beyond `most` of all cells.
    `unstored` are formula cells without a stored result, `errors` error cells, both as (row, column); `texts` are the
    texts by (row, column) of cells that say to hold their text inside and have it as their value; `hidden_rows` rows
    with cells that are hidden; `merged` areas as (first row, first column, last row, last column).
    """

    def __init__(self, data: bytes, limits: ReadingLimits, styles: int, strings: int, most: float = math.inf) -> None:
        self.rows: dict[int, list[WrittenCell]] = {}
        self.unstored: list[tuple[int, int]] = []
        self.errors: list[tuple[int, int]] = []
        self.texts: dict[tuple[int, int], str] = {}
        self.hidden_rows: list[int] = []
        self.merged: list[tuple[int, int, int, int]] = []
        self.styles = styles
        self.strings = strings
        self.most = most
        self.row_depth = self.style = 0
        self.row_digits = ""
        self.columns: dict[str, int] = {}
        self.known_styles: dict[str, int] = {}
        self.written: list[WrittenCell] = []
        self.inside: TreeBuilder | None = None
        self.inline: Element | None = None
        self.is_own = False
        self.cells = self.row = self.column = 0
        self.kind = self.value = ""
        self.length = 0
        self.in_row = self.in_cell = self.in_value = self.is_formula = self.is_hidden = False
        self.has_value = self.has_inline = self.in_rows = self.has_rows = False
        self._starts = {
            f"{MAIN} c": self._open_cell,
            f"{MAIN} sheetData": self._open_rows,
            f"{MAIN} row": self._open_row,
            f"{MAIN} v": self._open_value,
            f"{MAIN} is": self._open_inline,
            f"{MAIN} f": self._open_formula,
            f"{MAIN} mergeCell": self._merge,
        }
        self._ends = {
            f"{MAIN} c": self._close_cell,
            f"{MAIN} row": self._close_row,
            f"{MAIN} sheetData": self._close_rows,
            f"{MAIN} v": self._close_value,
        }
        super().__init__(data, limits)

    def start(self, name: str, attributes: dict[str, str]) -> None:
        """React to rows, cells and what stands in them."""
        if self.in_value:
            raise Refusal("E102")
        if react := self._starts.get(name):
            react(attributes)
        if self.inside is not None:
            self.inside.start(_tag(name), {_tag(key): value for key, value in attributes.items()})

    def end(self, name: str) -> None:
        """React to the end of rows, cells and values."""
        if self.inside is not None:
            self.inside.end(_tag(name))
            if self.depth == self.row_depth + 1:
                self.inline, self.inside = self.inside.close(), None
        if react := self._ends.get(name):
            react()

    def text(self, text: str) -> None:
        """Collect a value, and measure any text of a cell."""
        if self.in_value:
            self.value += text
        if self.in_cell:
            self.length += len(text)
            if self.length > self.limits.characters:
                self.limits.require("characters", self.length)
            if self.inside is not None:
                self.inside.data(text)

    def _open_rows(self, _: dict[str, str]) -> None:
        if self.has_rows:
            raise Refusal("E102")
        self.in_rows = self.has_rows = True

    def _close_rows(self) -> None:
        self.in_rows = False

    def _open_row(self, attributes: dict[str, str]) -> None:
        text = attributes.get("r")
        number = self.row + 1 if text is None else _index(text)
        if not self.in_rows or self.in_row or not self.row < number <= MAXIMUM_ROW:
            raise Refusal("E102")
        self.row, self.column, self.in_row = number, 0, True
        self.row_depth, self.row_digits, self.written = self.depth, str(number), []
        self.is_hidden = attributes.get("hidden", "0") in _TRUE

    def _close_row(self) -> None:
        self.in_row = False
        if self.written:
            self.rows[self.row] = self.written
        if self.is_hidden and self.column:
            self.hidden_rows.append(self.row)

    def _open_cell(self, attributes: dict[str, str]) -> None:
        if not self.in_row or self.in_cell:
            raise Refusal("E102")
        self.cells += 1
        reference = attributes.get("r")
        if reference is None:
            self.column += 1
        else:
            column = self._column(reference)
            if column <= self.column:
                raise Refusal("E102")
            self.column = column
        self.kind = attributes.get("t", "n")
        self.style = self._style(attributes.get("s", "0"))
        if self.kind not in _KINDS:
            raise Refusal("E102")
        self.in_cell = True
        self.is_formula = self.has_value = self.has_inline = False
        self.value, self.inline = "", None
        self.length = 0

    def _column(self, reference: str) -> int:
        """Return the column of a cell of this row; letters that were there before need no second look."""
        letters = reference.removesuffix(self.row_digits)
        column = self.columns.get(letters) if len(letters) < len(reference) else None
        if column is None:
            row, column = _address(reference)
            if row != self.row:
                raise Refusal("E102")
            self.columns[letters] = column
        return column

    def _style(self, text: str) -> int:
        """Return the number of a cell's style; one that was there before needs no second look."""
        style = self.known_styles.get(text)
        if style is None:
            style = _index(text)
            if style >= self.styles:
                raise Refusal("E102")
            self.known_styles[text] = style
        return style

    def _open_value(self, _: dict[str, str]) -> None:
        if self.has_value:
            raise Refusal("E102")
        self.in_value = self.has_value = self.in_cell
        self.is_own = self.depth == self.row_depth + 2

    def _open_inline(self, _: dict[str, str]) -> None:
        if self.in_cell and (self.has_inline or self.kind != "inlineStr"):
            raise Refusal("E102")
        self.has_inline = self.in_cell
        if self.in_cell and self.depth == self.row_depth + 2:
            self.inside = TreeBuilder()

    def _close_value(self) -> None:
        self.in_value = False

    def _open_formula(self, _: dict[str, str]) -> None:
        self.is_formula = self.in_cell

    def _close_cell(self) -> None:
        """Keep a cell as it is written, and judge its stored value by its kind."""
        self.in_cell = False
        held = self.inline if self.kind == "inlineStr" else self.value if self.value and self.is_own else None
        if held is not None and self.depth == self.row_depth and self.cells <= self.most:
            self.written.append((self.column, self.kind, self.style, held))
        address = (self.row, self.column)
        if self.is_formula and not self.value and not self.has_inline and self.kind != "str":
            self.unstored.append(address)
        elif self.kind == "e":
            self.errors.append(address)
        elif self.kind == "inlineStr":
            if self.value and not self.has_inline:
                self.texts[address] = self.value
        elif self.value and (
            (self.kind == "n" and not _NUMBER.fullmatch(self.value))
            or (self.kind == "s" and _index(self.value) >= self.strings)
            or (self.kind == "b" and self.value.strip() not in {"0", "1", "true", "false"})
        ):
            raise Refusal("E102")

    def _merge(self, attributes: dict[str, str]) -> None:
        self.limits.require("merged_areas", len(self.merged) + 1)
        match = _AREA.fullmatch(attributes.get("ref", ""))
        if match is None:
            raise Refusal("E102")
        self.merged.append((*_address(match[1]), *_address(match[2] or match[1])))


def _tag(name: str) -> str:
    """Return a name as element trees have it."""
    return f"{{{name.replace(' ', '}', 1)}" if " " in name else name


def _index(text: str) -> int:
    """Return a whole number of at least 0, written as one."""
    if not _INDEX.fullmatch(text):
        raise Refusal("E102")
    return int(text)
