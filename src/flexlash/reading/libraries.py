"""Whether a failure is a file's fault or a library's: flexlash uses parts of openpyxl that no release need keep.

A release that changes such a part would otherwise make every file look damaged.
"""

from __future__ import annotations

from importlib.metadata import version

from flexlash.reading.archive import packed
from flexlash.reading.elements import MAIN
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.worksheet import Worksheet

__all__ = ["ChangedLibrary", "require_known_libraries"]

_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_KIND = "application/vnd.openxmlformats-officedocument.spreadsheetml"
_SHEET = (
    f'<worksheet xmlns="{MAIN}"><sheetData><row r="1"><c r="A1" t="inlineStr"><is><r><t>a </t></r><r><t>text</t></r>'
    '</is></c><c r="B1"><v>0.1</v></c></row></sheetData></worksheet>'
).encode()
_ROWS = [(1, [(1, "a text"), (2, 0.1)])]
"""What that worksheet must be read as."""


class ChangedLibrary(Exception):
    """An installed library does something else than flexlash relies on; no file is to blame."""


def require_known_libraries() -> None:
    """Raise ChangedLibrary when openpyxl, as installed, cannot read a small workbook of our own.

    It is called where a failure is about to be blamed on a file: what fails here as well is not the file's fault.
    """
    try:
        found = _read()
    except MemoryError:
        raise
    except Exception as fault:
        raise _changed(f"cannot handle a workbook of flexlash's own ({type(fault).__name__}: {fault})") from fault
    if found != _ROWS:
        raise _changed("reads a workbook of flexlash's own as something else")


def _changed(what: str) -> ChangedLibrary:
    """Return the error that says what the library does, and what helps."""
    return ChangedLibrary(
        f"openpyxl {version('openpyxl')} {what}. Your file is not to blame. "
        "Install flexlash again with pip, which takes a version of openpyxl that works"
    )


def _read() -> object:
    """Return the cells of a small workbook."""
    from flexlash.reading.sheet_cells import SheetCells

    reader, written = SheetCells(packed(_parts()), None), Worksheet(_SHEET, ReadingLimits(), 1, 0).rows
    return [
        (row, [(column, reader.value(kind, style, held)) for column, kind, style, held in cells])
        for row, cells in written.items()
    ]


def _parts() -> dict[str, bytes]:
    """Return the parts of a small workbook."""
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{_PACKAGE}/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{_KIND}.sheet.main+xml"/></Types>',
        "_rels/.rels": _relation("officeDocument", "xl/workbook.xml"),
        "xl/workbook.xml": f'<workbook xmlns="{MAIN}" xmlns:r="{_OFFICE}"><sheets>'
        '<sheet name="Own" sheetId="1" r:id="rId1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": _relation("worksheet", "worksheets/sheet1.xml"),
    }
    return {**{name: part.encode() for name, part in parts.items()}, "xl/worksheets/sheet1.xml": _SHEET}


def _relation(kind: str, part: str) -> str:
    return (
        f'<Relationships xmlns="{_PACKAGE}/relationships">'
        f'<Relationship Id="rId1" Type="{_OFFICE}/{kind}" Target="{part}"/></Relationships>'
    )
