"""Small workbooks written part by part, so that a test can make any of them wrong."""

from __future__ import annotations

import io
import warnings
import zipfile
from collections.abc import Iterable, Mapping

__all__ = [
    "CORE", "MAIN", "OFFICE", "OLE2", "ONE", "PACKAGE", "RELATIONS", "ROOT", "SHEET", "STRINGS", "STYLES", "TYPES",
    "WORKBOOK", "archive_of", "book_of", "overwritten", "parts_of", "relation", "sheet_of", "styles_of",
    "workbook_part",
]  # fmt: skip

OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
PACKAGE = "http://schemas.openxmlformats.org/package/2006"
TYPES = "[Content_Types].xml"
ROOT = "_rels/.rels"
CORE = "docProps/core.xml"
WORKBOOK = "xl/workbook.xml"
RELATIONS = "xl/_rels/workbook.xml.rels"
SHEET = "xl/worksheets/sheet1.xml"
STRINGS = "xl/sharedStrings.xml"
STYLES = "xl/styles.xml"
OLE2 = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
ONE = '<row r="1"><c r="A1"><v>1</v></c></row>'

_KIND = "application/vnd.openxmlformats-officedocument.spreadsheetml"
Parts = Mapping[str, str | bytes]


def relation(number: int, kind: str, target: str) -> str:
    """Return a relation of the workbook to one of its parts."""
    return f'<Relationship Id="rId{number}" Type="{OFFICE}/{kind}" Target="{target}"/>'


def workbook_part(sheets: Iterable[str] = ('<sheet name="S" sheetId="1" r:id="rId1"/>',)) -> str:
    """Return the part that lists the sheets."""
    return f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheets>{"".join(sheets)}</sheets></workbook>'


def sheet_of(rows: str, before: str = "", after: str = "") -> str:
    """Return a worksheet of rows."""
    return f'<worksheet xmlns="{MAIN}">{before}<sheetData>{rows}</sheetData>{after}</worksheet>'


def styles_of(*formats: int) -> str:
    """Return the part of styles with cell formats of these number formats."""
    kinds = "".join(f'<xf numFmtId="{number}" applyNumberFormat="1"/>' for number in formats)
    return (
        f'<styleSheet xmlns="{MAIN}"><fonts><font/></fonts><fills><fill><patternFill/></fill></fills>'
        "<borders><border/></borders>"
        f"<cellStyleXfs><xf/></cellStyleXfs><cellXfs>{kinds}</cellXfs></styleSheet>"
    )


def parts_of(rows: str = ONE, **changed: str | bytes | None) -> dict[str, str | bytes]:
    """Return the parts of a small workbook by name; `changed` replaces parts, None leaves one out."""
    parts: dict[str, str | bytes | None] = {
        TYPES: f'<Types xmlns="{PACKAGE}/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Default Extension="xml" ContentType="application/xml"/>'
        f'<Override PartName="/{WORKBOOK}" ContentType="{_KIND}.sheet.main+xml"/>'
        f'<Override PartName="/{SHEET}" ContentType="{_KIND}.worksheet+xml"/>'
        f'<Override PartName="/{STRINGS}" ContentType="{_KIND}.sharedStrings+xml"/></Types>',
        ROOT: f'<Relationships xmlns="{PACKAGE}/relationships">{relation(1, "officeDocument", WORKBOOK)}'
        "</Relationships>",
        WORKBOOK: workbook_part(),
        RELATIONS: f'<Relationships xmlns="{PACKAGE}/relationships">'
        f"{relation(1, 'worksheet', 'worksheets/sheet1.xml')}"
        f"{relation(2, 'sharedStrings', 'sharedStrings.xml')}{relation(3, 'styles', 'styles.xml')}</Relationships>",
        SHEET: sheet_of(rows),
        STRINGS: f'<sst xmlns="{MAIN}"><si><t>first</t></si><si><t>last</t></si></sst>',
        STYLES: styles_of(0),
    }
    parts.update(changed)
    return {name: text for name, text in parts.items() if text is not None}


def archive_of(parts: Parts | Iterable[tuple[str, str | bytes]], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    """Return an archive of parts, or of pairs of name and text where a name comes twice."""
    buffer = io.BytesIO()
    pairs = parts.items() if isinstance(parts, Mapping) else parts
    with warnings.catch_warnings(), zipfile.ZipFile(buffer, "w", method) as archive:
        warnings.simplefilter("ignore")
        for name, text in pairs:
            archive.writestr(name, text)
    return buffer.getvalue()


def book_of(rows: str = ONE, *, method: int = zipfile.ZIP_DEFLATED, **changed: str | bytes | None) -> bytes:
    """Return a small workbook; see `parts_of`."""
    return archive_of(parts_of(rows, **changed), method)


def overwritten(data: bytes, signature: bytes, offset: int, value: int, size: int) -> bytes:
    """Return an archive with one field of every header of a kind overwritten."""
    changed = bytearray(data)
    place = changed.find(signature)
    while place >= 0:
        changed[place + offset : place + offset + size] = value.to_bytes(size, "little")
        place = changed.find(signature, place + 4)
    return bytes(changed)
