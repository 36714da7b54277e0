"""A small workbook, made here, of each kind that public workbooks are of: what is to be read, and what refused.

The kinds are those of the public workbooks' list, so that everybody's tests know them (`test_own_workbooks.py`).
"""

from __future__ import annotations

import datetime
import io
import re
import zipfile
from collections.abc import Callable, Mapping
from typing import Any

import openpyxl
import xlsxwriter
from small_workbook import (
    CORE,
    MAIN,
    OFFICE,
    OLE2,
    PACKAGE,
    RELATIONS,
    ROOT,
    SHEET,
    STRINGS,
    STYLES,
    TYPES,
    WORKBOOK,
    archive_of,
    book_of,
    parts_of,
    relation,
    sheet_of,
    workbook_part,
)  # fmt: skip

from flexlash.reading.raw import ErrorCell, Unstored

__all__ = ["READABLE", "REFUSED", "RICH"]

Cells = Mapping[str, Any]
DATE = datetime.datetime(2026, 4, 1, 12)  # noqa: DTZ001
_STRICT = (
    ("http://schemas.openxmlformats.org/spreadsheetml/2006/main", "http://purl.oclc.org/ooxml/spreadsheetml/main"),
    (OFFICE, "http://purl.oclc.org/ooxml/officeDocument/relationships"),
)
_TEXT = '<c r="A1" t="inlineStr"><is><t>{}</t></is></c>'
_MACROS = b"no macros at all, but a part that is called so"


def _written(fill: Callable[[xlsxwriter.Workbook, Any], None], **options: Any) -> bytes:
    """Return a workbook as XlsxWriter writes it, with one sheet called Data that `fill` fills."""
    buffer = io.BytesIO()
    with xlsxwriter.Workbook(buffer, {"in_memory": True, **options}) as book:
        fill(book, book.add_worksheet("Data"))
    return buffer.getvalue()


def _rewritten(data: bytes, change: Callable[[str, bytes], bytes | None]) -> bytes:
    """Return a workbook with its parts changed, or left out where the change is None."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        parts = {name: change(name, archive.read(name)) for name in archive.namelist()}
    return archive_of({name: part for name, part in parts.items() if part is not None})


def _values(_: xlsxwriter.Workbook, sheet: Any) -> None:
    sheet.write_row(0, 0, ["variant", 0.1 + 0.7, True, "Δ µ′ 𝄞"])
    sheet.write_row(2, 1, [-5e-300, " spaced "])


VALUES: Cells = {"A1": "variant", "B1": 0.1 + 0.7, "C1": True, "D1": "Δ µ′ 𝄞", "B3": -5e-300, "C3": " spaced "}


def _dated(book: xlsxwriter.Workbook, sheet: Any) -> None:
    for row, shown in enumerate(("yyyy-mm-dd hh:mm", "0.00", "[h]:mm")):
        sheet.write_datetime(row, 0, DATE, book.add_format({"num_format": shown}))
    sheet.write_number(3, 0, 0.25, book.add_format({"num_format": "hh:mm"}))


def _days(first: int) -> float:
    """Return the serial number of the date since the first day of a system."""
    return (DATE - datetime.datetime(first, 1, 1)) / datetime.timedelta(days=1)  # noqa: DTZ001


def _dates(serial: float) -> Cells:
    return {"A1": DATE, "A2": serial, "A3": datetime.timedelta(days=serial), "A4": datetime.time(6)}


def _strict(data: bytes) -> bytes:
    """Return a workbook in the Strict dialect of Excel's save dialog."""

    def change(_: str, part: bytes) -> bytes:
        for usual, strict in _STRICT:
            part = part.replace(usual.encode(), strict.encode())
        return part

    return _rewritten(data, change)


def _prefixed(name: str, part: bytes) -> bytes:
    """Return a part with a prefix on every name of the main namespace, as some programs write."""
    if not name.startswith("xl/") or f'xmlns="{MAIN}"'.encode() not in part:
        return part
    part = re.sub(rb"<(/?)(\w+)(?=[\s/>])", rb"<\1x:\2", part)
    return part.replace(f'xmlns="{MAIN}"'.encode(), f'xmlns:x="{MAIN}"'.encode())


def _absolute(name: str, part: bytes) -> bytes:
    """Return relations with targets from the root of the archive."""
    return re.sub(rb'Target="(?!http|/)', b'Target="/xl/', part) if name == RELATIONS else part


def _linked(_: xlsxwriter.Workbook, sheet: Any) -> None:
    sheet.write_url("A1", "https://example.org/x", string="a link")
    sheet.write_url("A2", "internal:Data!A1", string="inside")


def _merged(book: xlsxwriter.Workbook, sheet: Any) -> None:
    sheet.merge_range("A1:C2", "over six cells", book.add_format({"bold": True}))
    sheet.write_number("A3", 7)


def _hidden(book: xlsxwriter.Workbook, sheet: Any) -> None:
    sheet.write_number("A1", 1)
    sheet.write_number("A2", 2)
    sheet.set_row(1, None, None, {"hidden": True})
    sheet.set_column("B:B", None, None, {"hidden": True})
    other = book.add_worksheet("Away")
    other.hide()
    other.write_number("A1", 3)


def _table(_: xlsxwriter.Workbook, sheet: Any) -> None:
    sheet.add_table("A1:B3", {"columns": [{"header": "name"}, {"header": "size"}], "data": [["a", 1], ["b", 2]]})


def _ruled(book: xlsxwriter.Workbook, sheet: Any) -> None:
    sheet.write_number("A1", 1)
    sheet.data_validation("A1:A9", {"validate": "list", "source": ["1", "2"]})
    sheet.conditional_format("A1:A9", {"type": "cell", "criteria": ">", "value": 1,
                                       "format": book.add_format({"bg_color": "red", "bold": True})})  # fmt: skip
    book.define_name("sizes", "=Data!$A$1:$A$9")


def _charted(book: xlsxwriter.Workbook, sheet: Any) -> None:
    sheet.write_column("A1", [1, 2, 3])
    for place in (book.add_chartsheet("Picture"), sheet):
        chart = book.add_chart({"type": "line"})
        chart.add_series({"values": "=Data!$A$1:$A$3"})
        chart.set_title({"name": "A title"})
        place.set_chart(chart) if place is not sheet else sheet.insert_chart("C3", chart)


def _remarked(book: xlsxwriter.Workbook, sheet: Any) -> None:
    sheet.write_rich_string("A1", "half ", book.add_format({"bold": True, "font_script": 1, "color": "red"}), "bold")
    sheet.write_comment("A1", "a note", {"author": "JM", "visible": True})
    sheet.write_string("A2", "a\rb_x0041_c")


def _calculated(_: xlsxwriter.Workbook, sheet: Any) -> None:
    sheet.write_number("A1", 2)
    sheet.write_formula("A2", "=A1*2", None, 4)
    sheet.write_array_formula("A3:A4", "{=A1:A2*2}", None, 8)
    sheet.write_number("A4", 8)


def _everything(book: xlsxwriter.Workbook, sheet: Any) -> None:
    """Fill a workbook with most that engineers use, all of it at once."""
    for fill in (_ruled, _linked, _remarked, _charted):
        fill(book, sheet)
    sheet.insert_textbox("F9", "a text box")
    sheet.add_sparkline("F1", {"range": "Data!A1:A3"})
    sheet.protect()
    sheet.set_header("&C&D &F")
    sheet.print_area("A1:F20")
    sheet.repeat_rows(0)
    sheet.set_h_pagebreaks([10])
    sheet.freeze_panes(1, 1)
    sheet.autofilter("A1:B9")
    sheet.set_row(5, None, None, {"level": 1, "collapsed": True})
    sheet.set_tab_color("green")
    _table(book, book.add_worksheet("Table"))
    looks = {
        "diag_border": 1,
        "diag_type": 3,
        "pattern": 4,
        "fg_color": "#00FF00",
        "bg_color": "#0000FF",
        "rotation": 45,
    }
    texts = {"underline": 34, "font_strikeout": True, "font_outline": True, "font_shadow": True, "font_family": 3}
    sheet.write_string(
        "H9", "looks", book.add_format({**looks, **texts, "bold": True, "indent": 2, "num_format": "0.0"})
    )


def _macros() -> bytes:
    """Return a workbook of the kind that holds macros (.xlsm)."""
    kind = b"application/vnd.ms-office.vbaProject"

    def change(name: str, part: bytes) -> bytes:
        if name == TYPES:
            part = part.replace(b"spreadsheetml.sheet.main+xml", b"sheet.macroEnabled.main+xml").replace(
                b"application/vnd.openxmlformats-officedocument.sheet.macro", b"application/vnd.ms-excel.sheet.macro"
            )
            return part.replace(b"<Override", b'<Default Extension="bin" ContentType="%s"/><Override' % kind, 1)
        end = b"</Relationships>"
        if name == RELATIONS:
            project = b"http://schemas.microsoft.com/office/2006/relationships/vbaProject"
            part = part.replace(end, b'<Relationship Id="rId99" Type="%s" Target="vbaProject.bin"/>%s' % (project, end))
        return part

    data = _rewritten(_written(_values), change)
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return archive_of({**{name: archive.read(name) for name in archive.namelist()}, "xl/vbaProject.bin": _MACROS})


def _by_openpyxl() -> bytes:
    book = openpyxl.Workbook()
    book.active.title = "Data"
    for address, value in VALUES.items():
        book.active[address] = value
    buffer = io.BytesIO()
    book.save(buffer)
    return buffer.getvalue()


def _small(rows: str, **parts: str | bytes | None) -> bytes:
    """Return a small workbook of rows, its sheet called Data."""
    return book_of(rows, **{WORKBOOK: workbook_part(['<sheet name="Data" sheetId="1" r:id="rId1"/>']), **parts})


def _utf_16(part: str) -> bytes:
    return ('<?xml version="1.0" encoding="UTF-16"?>' + part).encode("utf-16")


_NUMBERS = (
    '<row r="1"><c r="A1"><v>1</v></c><c r="XFD1"><v>2</v></c></row><row r="1048576"><c r="B1048576"><v>3</v></c></row>'
)
_SHARED = (
    '<row r="1"><c r="A1"><f t="shared" ref="A1:A2" si="0">1+1</f><v>2</v></c></row>'
    '<row r="2"><c r="A2"><f t="shared" si="0"/><v>2</v></c><c r="B2"><f>1+1</f></c></row>'
)
_WRONG = '<row r="1"><c r="A1" t="e"><v>#REF!</v></c><c r="B1" t="str"><f>T(1)</f><v/></c></row>'
_PHONETIC = f'<sst xmlns="{MAIN}"><si><t>課</t><rPh sb="0" eb="1"><t>カ</t></rPh></si><si><t>b</t></si></sst>'

READABLE: dict[str, tuple[Callable[[], bytes], Mapping[str, Cells]]] = {
    "plain": (lambda: _written(_values), {"Data": VALUES}),
    "by another program": (_by_openpyxl, {"Data": VALUES}),
    "strict": (lambda: _strict(_written(_values)), {"Data": VALUES}),
    "dates": (lambda: _written(_dated), {"Data": _dates(_days(1900) + 2)}),
    "1904": (lambda: _written(_dated, date_1904=True), {"Data": _dates(_days(1904))}),
    "prefixed-ns": (lambda: _rewritten(_written(_values), _prefixed), {"Data": VALUES}),
    "absolute-rel": (lambda: _rewritten(_written(_values), _absolute), {"Data": VALUES}),
    "external-rel": (lambda: _written(_linked), {"Data": {"A1": "a link", "A2": "inside"}}),
    "shared-formulas": (lambda: _small(_SHARED), {"Data": {"A1": 2, "A2": 2, "B2": Unstored()}}),
    "formulas": (lambda: _written(_calculated), {"Data": {"A1": 2, "A2": 4, "A3": 8, "A4": 8}}),
    "inline-strings": (lambda: _written(_values, constant_memory=True), {"Data": VALUES}),
    "no-sharedStrings": (
        lambda: _small(f'<row r="1">{_TEXT.format("a")}</row>', **{STRINGS: None}),
        {"Data": {"A1": "a"}},
    ),
    "cells-without-ref": (
        lambda: _small("<row><c><v>1</v></c><c><v>2</v></c></row><row><c><v>3</v></c></row>"),
        {"Data": {"A1": 1, "B1": 2, "A2": 3}},
    ),
    "no-dimension": (lambda: _small('<row r="3"><c r="C3"><v>1</v></c></row>'), {"Data": {"C3": 1}}),
    "a false dimension": (
        lambda: _small("", **{SHEET: sheet_of('<row r="3"><c r="C3"><v>1</v></c></row>', '<dimension ref="A1"/>')}),
        {"Data": {"C3": 1}},
    ),
    "no-styles": (lambda: _small('<row r="1"><c r="A1"><v>1</v></c></row>', **{STYLES: None}), {"Data": {"A1": 1}}),
    "merged": (lambda: _written(_merged), {"Data": {"A1": "over six cells", "A3": 7}}),
    "hidden-sheet": (lambda: _written(_hidden), {"Data": {"A1": 1, "A2": 2}, "Away": {"A1": 3}}),
    "table": (
        lambda: _written(_table),
        {"Data": {"A1": "name", "B1": "size", "A2": "a", "B2": 1, "A3": "b", "B3": 2}},
    ),
    "data-validation": (lambda: _written(_ruled), {"Data": {"A1": 1}}),
    "chart sheet": (lambda: _written(_charted), {"Data": {"A1": 1, "A2": 2, "A3": 3}}),
    "rich text": (lambda: _written(_remarked), {"Data": {"A1": "half bold", "A2": "a\rb_x0041_c"}}),
    "phonetic text": (
        lambda: _small('<row r="1"><c r="A1" t="s"><v>0</v></c></row>', **{STRINGS: _PHONETIC}),
        {"Data": {"A1": "課"}},
    ),
    "errors": (lambda: _small(_WRONG), {"Data": {"A1": ErrorCell("#REF!")}}),
    "the farthest cells": (lambda: _small(_NUMBERS), {"Data": {"A1": 1, "XFD1": 2, "B1048576": 3}}),
    "UTF-16": (
        lambda: _small("", **{SHEET: _utf_16(sheet_of('<row r="1"><c r="A1"><v>1</v></c></row>'))}),
        {"Data": {"A1": 1}},
    ),
    "macros": (_macros, {"Data": VALUES}),
}
"""Workbooks that are read, by kind: how each is made, and every cell it holds."""


RICH: dict[str, Callable[[], bytes]] = {
    "everything": lambda: _written(_everything),
    "everything, strict": lambda: _strict(_written(_everything)),
    "everything, from 1904": lambda: _written(_everything, date_1904=True),
}
"""Workbooks that hold most of what engineers use."""


def _truncated(share: float) -> bytes:
    data = _written(_values)
    return data[: int(len(data) * share)]


def _doctype(part: str, text: str, declared: str = "") -> bytes:
    """Return a workbook with a document type in one part."""
    return _small("<row/>", **{part: f'<!DOCTYPE a [<!ENTITY e "x">{declared}]>{text}'})


def _entities(part: str) -> bytes:
    text = str(parts_of().get(part, "<a/>"))
    return _doctype(part, text)


_BOMB = "".join(f'<!ENTITY e{place} "{f"&e{place - 1};" * 10}">' for place in range(1, 9))
_OUTSIDE = '<!ENTITY f SYSTEM "file:///etc/passwd">'
_CELLS = '<row r="1">{}</row>'
_ONE, _TWO = '<c r="A1"><v>1</v></c>', '<c r="B1"><v>2</v></c>'
_DOCUMENT = {
    TYPES: f'<Types xmlns="{PACKAGE}/content-types"/>',
    ROOT: f'<Relationships xmlns="{PACKAGE}/relationships">{relation(1, "officeDocument", "word/document.xml")}'
    "</Relationships>",
    "word/document.xml": "<document/>",
}
_OPEN_DOCUMENT = {"mimetype": "application/vnd.oasis.opendocument.spreadsheet", "content.xml": "<a/>"}

REFUSED: dict[str, tuple[str, Callable[[], bytes]]] = {
    "encrypted-ooxml": ("E103", lambda: OLE2 + bytes(504) + "EncryptedPackage".encode("utf-16-le") + bytes(512)),
    "biff-xls": ("E104", lambda: OLE2 + bytes(504) + "Workbook".encode("utf-16-le") + bytes(512)),
    "ods": ("E104", lambda: archive_of(_OPEN_DOCUMENT)),
    "ods without its type": ("E104", lambda: archive_of({"content.xml": "<a/>", "META-INF/manifest.xml": "<a/>"})),
    "xlsb": ("E104", lambda: _small("", **{"xl/workbook.bin": b"\x83\x01\x00"})),
    "pk-but-broken 10 %": ("E102", lambda: _truncated(0.1)),
    "pk-but-broken 50 %": ("E102", lambda: _truncated(0.5)),
    "pk-but-broken 99 %": ("E102", lambda: _truncated(0.99)),
    "not-zip: zeros": ("E101", lambda: bytes(5000)),
    "not-zip: a picture": ("E101", lambda: b"\x89PNG\r\n\x1a\n" + bytes(100)),
    "not-zip: a web page": ("E101", lambda: b"<html><table><tr><td>1</td></tr></table></html>"),
    "docx": ("E101", lambda: archive_of(_DOCUMENT)),
    "no-content-types: an archive that holds a workbook": ("E101", lambda: archive_of({"a.xlsx": _written(_values)})),
    "no-workbook-part": ("E101", lambda: _small("", **{WORKBOOK: None})),
    "an empty archive": ("E101", lambda: b"PK\5\6" + bytes(18)),
    "dtd in the sheet": ("E105", lambda: _entities(SHEET)),
    "dtd in the texts": ("E105", lambda: _entities(STRINGS)),
    "dtd in the workbook": ("E105", lambda: _entities(WORKBOOK)),
    "dtd in the types": ("E105", lambda: _entities(TYPES)),
    "dtd in the relations": ("E105", lambda: _entities(ROOT)),
    "dtd in the properties": ("E105", lambda: _entities(CORE)),
    "entities that multiply": ("E105", lambda: _doctype(SHEET, sheet_of(_CELLS.format(_TEXT.format("&e8;"))), _BOMB)),
    "an entity from outside": ("E105", lambda: _doctype(SHEET, sheet_of(_CELLS.format(_TEXT.format("&f;"))), _OUTSIDE)),
    "cells out of order": ("E102", lambda: _small(_CELLS.format(_TWO + _ONE))),
    "a cell twice": ("E102", lambda: _small(_CELLS.format(_ONE + _ONE))),
    "rows out of order": ("E102", lambda: _small('<row r="2"/><row r="1"/>')),
    "a cell beyond the sheet": ("E102", lambda: _small(_CELLS.format('<c r="XFE1"><v>1</v></c>'))),
    "a text that is not there": ("E102", lambda: _small(_CELLS.format('<c r="A1" t="s"><v>2</v></c>'))),
    "a format that is not there": ("E102", lambda: _small(_CELLS.format('<c r="A1" s="9"><v>1</v></c>'))),
    "no-sheets": ("E102", lambda: _small("", **{WORKBOOK: workbook_part(['<sheet name="S" r:id="rId7"/>'])})),
    "a sheet that is not there": ("E102", lambda: _small("", **{SHEET: None})),
}
"""Files that are refused, by kind: the code of the refusal, and how each is made."""
