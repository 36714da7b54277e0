"""Bytes → an openpyxl workbook that holds what the file holds.

Left to itself openpyxl turns serial numbers into dates, empties merged cells, fills blank cells that hold a link,
drops escapes in texts and makes up missing dates.
"""

from __future__ import annotations

import datetime
import io
import re
import types
import warnings
import zipfile
from typing import Any

from openpyxl import Workbook
from openpyxl.cell.rich_text import CellRichText, TextBlock
from openpyxl.cell.text import Text
from openpyxl.reader import excel
from openpyxl.styles.cell_style import StyleArray
from openpyxl.workbook.properties import CalcProperties
from openpyxl.worksheet._reader import INLINE_STRING, WorkSheetParser, WorksheetReader
from openpyxl.worksheet.cell_range import MultiCellRange
from openpyxl.xml.constants import ARC_CORE, SHARED_STRINGS, SHEET_MAIN_NS
from openpyxl.xml.functions import iterparse

from flexlash.reading.archive import packed, unpacked
from flexlash.reading.package import open_package
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.xlsx import PROPERTY

__all__ = ["fresh", "load", "usual"]

_DATE = datetime.datetime(2026, 1, 1, tzinfo=datetime.UTC).replace(tzinfo=None)
_STRICT_DRAWING = b"http://purl.oclc.org/ooxml/drawingml/"
_DRAWING = b"http://schemas.openxmlformats.org/drawingml/2006/"
_PERCENT = re.compile(rb'="(-?\d+(?:\.\d+)?)%"')
_STRING = f"{{{SHEET_MAIN_NS}}}si"


def usual(data: bytes, limits: ReadingLimits) -> bytes:
    """Return a workbook as reading sees it: the Strict dialect in the usual one's names, its parts where they belong.

    openpyxl finds no sheet in a workbook of the Strict dialect, and does not say so.
    """
    package = open_package(unpacked(data, limits), limits)
    return packed({name: _usual_drawing(part) for name, part in package.parts.items()}) if package.mended else data


def _usual_drawing(part: bytes) -> bytes:
    """Return a part with the Strict dialect's names and percentages of drawings, and of themes, as usual ones."""
    if _STRICT_DRAWING not in part:
        return part
    part = part.replace(_STRICT_DRAWING, _DRAWING)
    return _PERCENT.sub(lambda share: b'="%d"' % round(1000 * float(share[1])), part)


def load(data: bytes) -> Workbook:
    """Return a workbook to be marked; raises whatever openpyxl raises on what it cannot read."""
    # openpyxl warns of what it drops; `losses` says that in words.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        reader = _Reader(io.BytesIO(data), keep_vba=False, keep_links=True, rich_text=True)
        reader.read()
    workbook = reader.wb
    # A template's own type would stop Excel from opening the copy as a workbook.
    workbook.template = False
    # Only cells typed as ISO dates are dates to this reader, and are written as such again.
    workbook.iso_dates = True
    # openpyxl cannot keep formulas' results; Excel shall calculate them on opening.
    workbook.calculation = workbook.calculation or CalcProperties()
    workbook.calculation.fullCalcOnLoad = True
    _keep_dates(workbook, data)
    _keep_columns(workbook)
    return workbook


def fresh() -> Workbook:
    """Return a workbook without sheets."""
    workbook = Workbook()
    workbook.remove(workbook.active)
    workbook.properties.creator = PROPERTY
    workbook.properties.created = workbook.properties.modified = _DATE
    return workbook


def _keep_dates(workbook: Workbook, data: bytes) -> None:
    """Undo the creator and dates that openpyxl makes up for a workbook without them."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        core = archive.read(ARC_CORE) if ARC_CORE in archive.namelist() else b""
    if b"creator" not in core:
        workbook.properties.creator = None
    for name in ("created", "modified"):
        if name.encode() not in core:
            setattr(workbook.properties, name, _DATE)


def _keep_columns(workbook: Workbook) -> None:
    """Give columns without a format the workbook's first one, which is what they mean by having none."""
    for sheet in workbook.worksheets:
        for column in sheet.column_dimensions.values():
            if not column.has_style:
                column._style = StyleArray(workbook._cell_styles[0])  # noqa: SLF001


def _text(node: Any) -> str | CellRichText:
    """Return a string item with its formatting and its escapes."""
    text = Text.from_tree(node)
    if not any(run.rPr for run in text.r):
        return str(text.content)
    return CellRichText([TextBlock(run.rPr, run.t or "") if run.rPr else run.t or "" for run in text.r])


class _Parser(WorkSheetParser):  # type: ignore[misc]
    """Reads texts with their escapes."""

    def parse_cell(self, element: Any) -> dict[str, Any]:
        cell: dict[str, Any] = super().parse_cell(element)
        inline = element.find(INLINE_STRING)
        if cell["data_type"] == "s" and inline is not None:
            cell["value"] = _text(inline)
        return cell


class _SheetReader(WorksheetReader):  # type: ignore[misc]
    """Reads a sheet with plain serial numbers, merged cells that keep their content, and blank linked cells."""

    def __init__(self, sheet: Any, source: Any, texts: Any, data_only: Any, rich_text: Any) -> None:
        super().__init__(sheet, source, texts, data_only, rich_text)
        self.parser = _Parser(source, texts, data_only, sheet.parent.epoch, rich_text=rich_text)

    def bind_merged_cells(self) -> None:
        if self.parser.merged_cells:
            self.ws.merged_cells = MultiCellRange([one.ref for one in self.parser.merged_cells.mergeCell])

    def bind_hyperlinks(self) -> None:
        filled = {place for place, cell in self.ws._cells.items() if cell.value is not None}  # noqa: SLF001
        super().bind_hyperlinks()
        for place, cell in self.ws._cells.items():  # noqa: SLF001
            if cell.hyperlink and place not in filled:
                cell.value = None


class _Reader(excel.ExcelReader):  # type: ignore[misc]
    """Reads a workbook with this module's reader of sheets."""

    read_worksheets = types.FunctionType(
        excel.ExcelReader.read_worksheets.__code__, {**vars(excel), "WorksheetReader": _SheetReader}
    )

    def read_strings(self) -> None:
        part = self.package.find(SHARED_STRINGS)
        if part is None:
            return
        with self.archive.open(part.PartName[1:]) as source:
            for _, node in iterparse(source):
                if node.tag == _STRING:
                    self.shared_strings.append(_text(node))
                    node.clear()
