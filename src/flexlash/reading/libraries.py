"""Whether a failure is a file's fault or a library's: flexlash uses parts of openpyxl that no release need keep.

A release that changes such a part would otherwise make every file look damaged.
"""

from __future__ import annotations

import io
import zipfile
from importlib.metadata import version

from flexlash.reading.raw import RawSheet, RawValue

__all__ = ["ChangedLibrary", "require_known_libraries"]

_CELLS: dict[int, RawValue] = {1: "a text", 2: 0.1}
"""A row that writing and reading must leave as it is."""


class ChangedLibrary(Exception):
    """An installed library does something else than flexlash relies on; no file is to blame."""


def require_known_libraries() -> None:
    """Raise ChangedLibrary when openpyxl, as installed, cannot write, read and mark a small workbook of our own.

    It is called where a failure is about to be blamed on a file: what fails here as well is not the file's fault.
    """
    try:
        found = _written_and_read()
    except MemoryError:
        raise
    except Exception as fault:
        raise _changed(f"cannot handle a workbook of flexlash's own ({type(fault).__name__}: {fault})") from fault
    if found != [(1, list(_CELLS.items()))]:
        raise _changed("reads a workbook of flexlash's own as something else")


def _changed(what: str) -> ChangedLibrary:
    """Return the error that says what the library does, and what helps."""
    return ChangedLibrary(
        f"openpyxl {version('openpyxl')} {what}. Your file is not to blame. "
        "Install flexlash again with pip, which takes a version of openpyxl that works"
    )


def _written_and_read() -> object:
    """Return the cells of a small workbook after marking, loading, writing and reading it."""
    from flexlash.feedback.annotation.loading import load
    from flexlash.feedback.annotation.marked_copy import marked_table
    from flexlash.feedback.annotation.packing import pack
    from flexlash.reading.sheet_cells import SheetCells
    from flexlash.schema.findings import Finding

    fault = Finding(level="error", code="E202", sheet="Own", cell="B1", message="Wrong.", fix="Fix it.")
    data = marked_table({"Own": RawSheet(name="Own", rows={1: dict(_CELLS)})}, [fault], "own")
    data = pack(load(data))
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        own = archive.read("xl/worksheets/sheet2.xml")
    return list(SheetCells(data, None).rows(own))
