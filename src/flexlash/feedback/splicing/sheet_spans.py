"""Where cells stand in a worksheet's part, and where those belong that it does not hold yet."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from xml.parsers import expat

from flexlash.feedback.splicing.xml_spans import end_of_tag, xml_text
from flexlash.schema.cell_addresses import column_number

__all__ = ["WORKSHEET_ORDER", "Area", "CellSpan", "Gap", "SheetSpans", "area_of", "cell_xml"]

_LAST_ROW, _LAST_COLUMN = 1_048_576, 16_384

Area = tuple[int, int, int, int]
"""First row, first column, last row and last column of an area."""

WORKSHEET_ORDER = (
    "sheetPr", "dimension", "sheetViews", "sheetFormatPr", "cols", "sheetData", "sheetCalcPr", "sheetProtection",
    "protectedRanges", "scenarios", "autoFilter", "sortState", "dataConsolidate", "customSheetViews", "mergeCells",
    "phoneticPr", "conditionalFormatting", "dataValidations", "hyperlinks", "printOptions", "pageMargins", "pageSetup",
    "headerFooter", "rowBreaks", "colBreaks", "customProperties", "cellWatches", "ignoredErrors", "smartTags",
    "drawing", "legacyDrawing",
)  # fmt: skip
"""Children of a worksheet's element, up to the last that a mark adds."""


@dataclass(frozen=True, kw_only=True)
class CellSpan:
    """A cell from `start` to `end`, its tag's end at `inner`; its prefix, its style, and whether it is a formula."""

    start: int
    inner: int
    end: int
    prefix: str
    style: str
    is_formula: bool


@dataclass(frozen=True, kw_only=True)
class Gap:
    """Where absent cells of a row belong: what stands from `start` to `end` gives way to `before`, them and `after`.

    `style` is that of the row, an empty text when it has none.
    """

    row: int
    columns: tuple[int, ...]
    start: int
    end: int
    before: bytes = b""
    after: bytes = b""
    style: str = ""


class SheetSpans:
    """Walks through a worksheet's cells, known by row and column, as written or as counted.

    `cells` are those wanted and those of a wanted style, `gaps` where wanted ones that are absent belong, `prefix` is
    that of the sheet's elements.
    """

    def __init__(
        self,
        part: bytes,
        wanted: Iterable[tuple[int, int]],
        is_wanted_style: Callable[[str], bool] = lambda _: False,
    ) -> None:
        self.cells: dict[tuple[int, int], CellSpan] = {}
        self.gaps: list[Gap] = []
        self.prefix = ""
        self._part = part
        self._is_wanted_style = is_wanted_style
        self._missing: dict[int, list[int]] = defaultdict(list)
        for row, column in sorted(set(wanted)):
            self._missing[row].append(column)
        self._missing_rows = sorted(self._missing, reverse=True)
        self._row = self._column = self._start = self._row_start = self._data_start = 0
        self._row_style = self._style = ""
        self._columns: list[int] = []
        self._is_found = self._is_formula = False
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._open
        self._parser.EndElementHandler = self._close
        self._parser.Parse(part, True)

    def _open(self, name: str, attributes: dict[str, str]) -> None:
        local = name.rpartition(":")[2]
        if local == "c":
            self._open_cell(attributes)
        elif local == "f":
            self._is_formula = True
        elif local == "row":
            self._open_row(int(attributes.get("r", self._row + 1)))
            self._row_style = attributes.get("s", "") if attributes.get("customFormat") in {"1", "true"} else ""
        elif local == "sheetData":
            self.prefix = name.removesuffix(local)
            self._data_start = self._parser.CurrentByteIndex

    def _open_row(self, number: int) -> None:
        self._row, self._column = number, 0
        self._row_start = self._parser.CurrentByteIndex
        self._add_rows(number, self._row_start)
        if self._missing_rows and self._missing_rows[-1] == number:
            self._missing_rows.pop()
        self._columns = self._missing.get(number, [])[::-1]

    def _add_rows(self, end: float, place: int) -> None:
        """Note the rows that are absent before a row's number."""
        while self._missing_rows and self._missing_rows[-1] < end:
            row = self._missing_rows.pop()
            tag = self.prefix.encode()
            before, after = b'<%srow r="%d">' % (tag, row), b"</%srow>" % tag
            columns = tuple(self._missing[row])
            self.gaps.append(Gap(row=row, columns=columns, start=place, end=place, before=before, after=after))

    def _add_cells(self, end: float, place: int) -> None:
        """Note the cells that are absent before a column's number."""
        columns = []
        while self._columns and self._columns[-1] < end:
            columns.append(self._columns.pop())
        if columns:
            gap = Gap(row=self._row, columns=tuple(columns), start=place, end=place, style=self._row_style)
            self.gaps.append(gap)

    def _open_cell(self, attributes: dict[str, str]) -> None:
        address = attributes.get("r", "")
        self._column = column_number(address.rstrip("0123456789")) if address else self._column + 1
        if self._columns and self._columns[-1] < self._column:
            self._add_cells(self._column, self._parser.CurrentByteIndex)
        self._style = attributes.get("s", "")
        is_wanted = bool(self._columns) and self._columns[-1] == self._column
        if is_wanted:
            self._columns.pop()
        self._is_found = is_wanted or self._is_wanted_style(self._style)
        self._is_formula = False
        self._start = self._parser.CurrentByteIndex

    def _close(self, name: str) -> None:
        local = name.rpartition(":")[2]
        if local == "c" and self._is_found:
            inner = end_of_tag(self._part, self._start)
            is_empty = self._part.endswith(b"/>", self._start, inner)
            self.cells[self._row, self._column] = CellSpan(
                start=self._start,
                inner=inner,
                end=inner if is_empty else self._part.index(b">", self._parser.CurrentByteIndex) + 1,
                prefix=name.removesuffix(local),
                style=self._style,
                is_formula=self._is_formula,
            )
            self._is_found = False
        elif local == "row" and self._columns:
            self._fill_up(name, self._row_start, self._add_cells)
        elif local == "sheetData" and self._missing_rows:
            self._fill_up(name, self._data_start, self._add_rows)

    def _fill_up(self, name: str, start: int, add: Callable[[float, int], None]) -> None:
        """Note what is absent at the end of an element, which gets tags of its own where it was an empty one."""
        inner, first = end_of_tag(self._part, start), len(self.gaps)
        is_empty = self._part.endswith(b"/>", start, inner)
        add(math.inf, inner if is_empty else self._parser.CurrentByteIndex)
        if is_empty:
            opened = self._part[start : inner - 2].rstrip() + b">"
            self.gaps[first] = replace(self.gaps[first], start=start, before=opened + self.gaps[first].before)
            self.gaps[-1] = replace(self.gaps[-1], after=self.gaps[-1].after + b"</%s>" % name.encode())


def area_of(text: str) -> Area:
    """Return an area that is written as one or two cells, columns or rows.

    >>> area_of("B2:C5"), area_of("$D:$D")
    ((2, 2, 5, 3), (1, 4, 1048576, 4))
    """
    first, _, last = text.replace("$", "").partition(":")
    top, left = _corner(first, 1, 1)
    bottom, right = _corner(last or first, _LAST_ROW, _LAST_COLUMN)
    return top, left, bottom, right


def _corner(text: str, row: int, column: int) -> tuple[int, int]:
    letters = text.rstrip("0123456789")
    return int(text[len(letters) :] or row), column_number(letters) if letters else column


def cell_xml(address: str, value: str | float | None, prefix: str = "", style: str = "", formula: str = "") -> bytes:
    """Return a cell as XML: a number as such, a text inside the cell, a formula with its number."""
    tag = prefix.encode()
    attributes = b' r="%s"' % address.encode() + (b' s="%s"' % style.encode() if style else b"")
    if value is None:
        return b"<%sc%s/>" % (tag, attributes)
    if isinstance(value, str):
        text = b'<%sis><%st xml:space="preserve">%s</%st></%sis>' % (tag, tag, xml_text(value), tag, tag)
        return b'<%sc%s t="inlineStr">%s</%sc>' % (tag, attributes, text, tag)
    calculated = b"<%sf>%s</%sf>" % (tag, xml_text(formula), tag) if formula else b""
    return b"<%sc%s>%s<%sv>%s</%sv></%sc>" % (tag, attributes, calculated, tag, repr(value).encode(), tag, tag)
