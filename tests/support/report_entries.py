"""A report as its reader leaves it: some cells typed into, and what a recalculation makes of it."""

from __future__ import annotations

import re
import warnings
import zipfile
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from xml.sax.saxutils import escape

import openpyxl

__all__ = ["error_cells", "opened", "sheet_part", "typed", "values_of", "without_charts"]


def sheet_part(archive: zipfile.ZipFile, sheet: str) -> str:
    """Return the part that holds a sheet."""
    workbook = archive.read("xl/workbook.xml").decode()
    relations = archive.read("xl/_rels/workbook.xml.rels").decode()
    (relation,) = re.findall(rf'<sheet name="{re.escape(sheet)}"[^>]*r:id="(\w+)"', workbook)
    (target,) = re.findall(rf'<Relationship Id="{relation}"[^>]*Target="([^"]+)"', relations)
    return f"xl/{target}"


def typed(report: Path, target: Path, sheet: str, entries: Mapping[str, str | float]) -> Path:
    """Write the report with entries typed into a sheet; an empty text empties the cell."""
    with zipfile.ZipFile(report) as source, zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as copy:
        part = sheet_part(source, sheet)
        for item in source.infolist():
            data = source.read(item)
            if item.filename == part:
                text = data.decode()
                for cell, entry in entries.items():
                    text, count = re.subn(
                        rf'<c r="{cell}"( s="\d+")?[^>]*?(?:/>|>.*?</c>)',
                        lambda match, cell=cell, entry=entry: _cell(cell, match[1] or "", entry),
                        text,
                        count=1,
                    )
                    assert count == 1, f"{sheet}!{cell} is not there"
                data = text.encode()
            copy.writestr(item.filename, data)
    return target


def without_charts(report: Path, target: Path) -> Path:
    """Write the report without its charts, which takes LibreOffice half as long to recalculate."""
    with zipfile.ZipFile(report) as source, zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as copy:
        for item in source.infolist():
            data = source.read(item)
            if item.filename.startswith("xl/worksheets/sheet"):
                data = re.sub(rb'<drawing r:id="\w+"/>', b"", data)
            copy.writestr(item.filename, data)
    return target


def _cell(cell: str, style: str, entry: str | float) -> str:
    if entry == "":
        return f'<c r="{cell}"{style}/>'
    if isinstance(entry, str):
        return f'<c r="{cell}"{style} t="inlineStr"><is><t>{escape(entry)}</t></is></c>'
    return f'<c r="{cell}"{style}><v>{entry!r}</v></c>'


@lru_cache(maxsize=4)
def opened(path: Path, **options: bool) -> openpyxl.Workbook:
    """Return a workbook as openpyxl reads it, which takes seconds for a report; no test may change it."""
    with path.open("rb") as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return openpyxl.load_workbook(file, **options)


def values_of(path: Path, sheet: str) -> dict[str, object]:
    """Return the stored values of a sheet by address."""
    with path.open("rb") as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        book = openpyxl.load_workbook(file, data_only=True, read_only=True)
        rows = book[sheet].iter_rows()
        return {cell.coordinate: cell.value for row in rows for cell in row if cell.value is not None}


def error_cells(values: Mapping[str, object]) -> list[str]:
    """Return the addresses of cells that show an error."""
    return [cell for cell, value in values.items() if isinstance(value, str) and value.startswith("#")]
