"""An openpyxl workbook → bytes: every digit, nothing of the day, no temporary file."""

from __future__ import annotations

import io
import re
import warnings
import zipfile
from collections.abc import Sequence
from typing import Any
from xml.etree.ElementTree import Element, tostring
from xml.sax.saxutils import escape, quoteattr

from openpyxl import Workbook
from openpyxl.cell._writer import etree_write_cell
from openpyxl.comments.comment_sheet import CommentRecord
from openpyxl.drawing.spreadsheet_drawing import SpreadsheetDrawing
from openpyxl.packaging.custom import StringProperty
from openpyxl.worksheet._writer import WorksheetWriter
from openpyxl.writer.excel import ExcelWriter
from openpyxl.xml.constants import ARC_WORKBOOK, XML_NS

from flexlash.feedback.annotation.valid_xml import put_right
from flexlash.reading.xlsx import PROPERTY

__all__ = ["CHECKED", "pack"]

CHECKED = "checked"
"""What the document property says of a marked copy."""

_DATA = "sheetData"
_OWNER = re.compile(rb'localSheetId="(\d+)"')
_RETURN = {"\r": "&#13;"}


def pack(workbook: Workbook) -> bytes:
    """Return a workbook's bytes, the same for the same content, with the property of a marked copy."""
    properties = workbook.custom_doc_props
    if PROPERTY in properties.names:
        del properties[PROPERTY]
    properties.append(StringProperty(name=PROPERTY, value=CHECKED))
    buffer = io.BytesIO()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        archive = _Archive(buffer, "w")
        archive.tabs = [place for place, sheet in enumerate(workbook._sheets) if sheet in workbook.worksheets]  # noqa: SLF001
        _Writer(workbook, archive).save()
    return buffer.getvalue()


class _SheetWriter(WorksheetWriter):  # type: ignore[misc]
    """Writes a sheet with every digit of its numbers and no temporary file."""

    def __init__(self, sheet: Any) -> None:
        super().__init__(sheet, out=io.BytesIO())
        self.data: list[str] = []

    def write_rows(self) -> None:
        for number, cells in self.rows():
            attributes = {"r": number, **dict(self.ws.row_dimensions.get(number, {}))}
            self.data.append("<row" + "".join(f" {key}={quoteattr(str(value))}" for key, value in attributes.items()))
            self.data.append(">")
            self.data.extend(map(self._cell, cells))
            self.data.append("</row>")
        self.xf.send(Element(_DATA))

    def _cell(self, cell: Any) -> str:
        """Return a cell's XML; what is not plain is left to openpyxl."""
        if cell.comment is not None:
            self.ws._comments.append(CommentRecord.from_cell(cell))  # noqa: SLF001
        value, kind, style = cell.value, cell.data_type, f' s="{cell.style_id}"' if cell.has_style else ""
        start = f'<c r="{cell.coordinate}"{style}'
        if cell.hyperlink is None and value is None:
            return f"{start}/>" if style or cell.comment else ""
        if cell.hyperlink is None and type(value) in {int, float} and kind == "n":
            return f"{start}><v>{value!r}</v></c>"
        if cell.hyperlink is None and type(value) is str and kind == "s":
            return f'{start} t="inlineStr"><is><t xml:space="preserve">{escape(value, _RETURN)}</t></is></c>'
        element = _Element()
        etree_write_cell(element, self.ws, cell, cell.has_style)
        return element.text

    def read(self) -> bytes:
        empty = f"<{_DATA} />".encode()
        return bytes(super().read()).replace(empty, f"<{_DATA}>{''.join(self.data)}</{_DATA}>".encode(), 1)


class _Element:
    """Takes one element where openpyxl would stream it."""

    text = ""

    def write(self, element: Any) -> None:
        for text in element.iter("t"):
            text.set(f"{{{XML_NS}}}space", "preserve")
        self.text = tostring(element, encoding="unicode")


class _Writer(ExcelWriter):  # type: ignore[misc]
    """Writes a workbook without temporary files."""

    def write_worksheet(self, ws: Any) -> None:
        ws._drawing = SpreadsheetDrawing()  # noqa: SLF001
        ws._drawing.charts = ws._charts  # noqa: SLF001
        ws._drawing.images = ws._images  # noqa: SLF001
        writer = _SheetWriter(ws)
        writer.write()
        ws._rels = writer._rels  # noqa: SLF001
        self._archive.writestr(ws.path[1:], writer.read())
        self.manifest.append(ws)


class _Archive(zipfile.ZipFile):
    """An archive whose entries bear no date of their own, and whose parts are mended on their way in."""

    tabs: Sequence[int] = ()

    def writestr(self, zinfo_or_arcname: Any, data: Any, *_: Any, **__: Any) -> None:
        entry = zipfile.ZipInfo(str(zinfo_or_arcname))
        entry.compress_type = zipfile.ZIP_DEFLATED
        entry.create_system = 3
        if entry.filename == ARC_WORKBOOK:
            # openpyxl numbers the sheets that names belong to as if there were no chart sheets.
            data = _OWNER.sub(lambda match: b'localSheetId="%d"' % self.tabs[int(match[1])], data)
        super().writestr(entry, put_right(entry.filename, data) if isinstance(data, bytes) else data)
