"""A workbook's bytes → its cells, read with openpyxl after every part was looked at."""

from __future__ import annotations

import datetime
import re
import warnings
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from flexlash.reading.archive import packed, unpacked
from flexlash.reading.libraries import require_known_libraries
from flexlash.reading.package import Package, open_package
from flexlash.reading.raw import ERROR_WORDS, ErrorCell, RawSheet, RawValue, Unstored
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.worksheet import Worksheet, WrittenCell

if TYPE_CHECKING:
    from flexlash.reading.sheet_cells import SheetCells

__all__ = ["PROPERTY", "Cells", "look_at", "read_workbook"]

PROPERTY = "flexlash"
"""Document property in which a template, a report or a marked copy says what it is."""

_ESCAPED = re.compile("_x((?![Dd][89A-Fa-f])[0-9A-Fa-f]{4})_")
"""How a workbook writes characters that XML does not allow; halves of a character are none."""
_EXACT = 2**53
"""Up to here every whole number is a double, as a workbook's numbers are."""
_MEBI = 2**20


@dataclass(frozen=True, kw_only=True)
class Cells:
    """What a file holds: its sheets in order, its date of change, and what it says it is."""

    sheets: list[RawSheet] = field(default_factory=list)
    modified: datetime.datetime | None = None
    role: str = ""
    template_version: str = ""


def read_workbook(data: bytes, limits: ReadingLimits, only: Collection[str] = ()) -> Cells:
    """Return the cells of every worksheet, or of those named; raise Refusal when one of them might be read wrongly."""
    package = open_package(unpacked(data, limits), limits)
    if only:
        package = replace(package, sheets=[sheet for sheet in package.sheets if sheet.title in only])
    looked_at = look_at(package, limits)
    try:
        # openpyxl warns of every feature that it does not carry over, none of which holds a cell's value.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            cells = _read(packed(package.parts) if package.is_rewritten else data, package, looked_at)
    except MemoryError:
        raise
    except Exception as fault:
        # openpyxl leaks a dozen exception types on damaged parts; none of their texts is for a user.
        require_known_libraries()
        raise Refusal("E102") from fault
    _check_texts(cells, limits)
    return cells


def _check_texts(cells: Cells, limits: ReadingLimits) -> None:
    """Refuse one long text that so many cells share that together they exceed what a file may unpack to."""
    rows = (row for sheet in cells.sheets for row in sheet.rows.values())
    characters = sum(len(value) for row in rows for value in row.values() if isinstance(value, str))
    limits.require("unpacked_mebibytes", characters / _MEBI)


def look_at(package: Package, limits: ReadingLimits) -> dict[str, Worksheet]:
    """Walk through every worksheet, by title; the limit of cells is that of the whole file."""
    worksheets = {}
    cells = 0
    for sheet in package.sheets:
        most = limits.cells - cells
        worksheets[sheet.title] = Worksheet(package.parts[sheet.part], limits, package.styles, package.texts, most)
        cells += worksheets[sheet.title].cells
        limits.require("cells", cells)
    return worksheets


def _read(data: bytes, package: Package, looked_at: dict[str, Worksheet]) -> Cells:
    """Read every worksheet; its dimension record is not believed."""
    from flexlash.reading.sheet_cells import SheetCells

    reader = SheetCells(data, package.parts.get(package.strings))
    sheets = []
    for part in package.sheets:
        seen = looked_at[part.title]
        rows = {row: cells for row, written in seen.rows.items() if (cells := _values(reader, written))}
        for (row, column), text in seen.texts.items():
            rows.setdefault(row, {})[column] = _plain(text)
        for row, column in seen.errors:
            shows = rows.setdefault(row, {}).get(column, "an error")
            rows[row][column] = shows if isinstance(shows, ErrorCell) else ErrorCell(str(shows))
        for row, column in seen.unstored:
            rows.setdefault(row, {})[column] = Unstored()
        sheets.append(
            RawSheet(
                name=part.title,
                rows={row: rows[row] for row in sorted(rows)},
                hidden=part.hidden,
                hidden_rows=frozenset(seen.hidden_rows),
                merged=tuple(seen.merged),
            )
        )
    properties = reader.properties()
    return Cells(
        sheets=sheets,
        modified=package.modified,
        role=properties.get(PROPERTY, ""),
        template_version=properties.get(f"{PROPERTY}_template_version", ""),
    )


def _values(reader: SheetCells, written: Iterable[WrittenCell]) -> dict[int, RawValue]:
    """Return the values of a row's cells by column."""
    values = ((column, reader.value(kind, style, held)) for column, kind, style, held in written)
    return {column: _plain(value) for column, value in values if value is not None}


def _plain(value: Any) -> RawValue:
    """Return a cell's value, an error word as an error and escaped characters as themselves."""
    if isinstance(value, int) and abs(value) > _EXACT:
        return float(str(value))
    if not isinstance(value, str):
        return value  # type: ignore[no-any-return]
    if value in ERROR_WORDS:
        return ErrorCell(value)
    return _ESCAPED.sub(lambda match: chr(int(match[1], 16)), value) if "_x" in value else value
