"""A workbook's bytes → its cells, read with openpyxl after every part was looked at."""

from __future__ import annotations

import datetime
import io
import re
import warnings
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from flexlash.submission.raw import ERROR_WORDS, ErrorCell, RawSheet, RawValue, Unstored
from flexlash.submission.reading.archive import packed, unpacked
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.package import Package, open_package
from flexlash.submission.reading.refusal import Refusal
from flexlash.submission.reading.worksheet import Worksheet

__all__ = ["PROPERTY", "Cells", "read_workbook"]

PROPERTY = "flexlash"
"""Document property in which a template, a report or a marked copy says what it is."""

_ESCAPED = re.compile("_x([0-9A-Fa-f]{4})_")
"""How a workbook writes characters that XML does not allow."""


@dataclass(frozen=True, kw_only=True)
class Cells:
    """What a file holds: its sheets in order, its date of change, and what it says it is."""

    sheets: list[RawSheet] = field(default_factory=list)
    modified: datetime.datetime | None = None
    role: str = ""
    template_version: str = ""


def read_workbook(data: bytes, limits: ReadingLimits) -> Cells:
    """Return the cells of every worksheet; raise Refusal when one of them might be read wrongly."""
    package = open_package(unpacked(data, limits), limits)
    looked_at = _look_at(package, limits)
    try:
        # openpyxl warns of every feature that it does not carry over, none of which holds a cell's value.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return _read(packed(package.parts) if package.mended else data, package, looked_at)
    except MemoryError:
        raise
    except Exception as fault:
        # openpyxl leaks a dozen exception types on damaged parts; none of their texts is for a user.
        raise Refusal("E102") from fault


def _look_at(package: Package, limits: ReadingLimits) -> dict[str, Worksheet]:
    """Walk through every worksheet, by title; the limit of cells is that of the whole file."""
    found = {}
    cells = 0
    for sheet in package.sheets:
        found[sheet.title] = Worksheet(package.parts[sheet.part], limits, package.styles, package.strings)
        cells += found[sheet.title].cells
        limits.require("cells", cells)
    return found


def _read(data: bytes, package: Package, looked_at: dict[str, Worksheet]) -> Cells:
    """Read every worksheet; its dimension record is not believed."""
    import openpyxl

    workbook = openpyxl.load_workbook(io.BytesIO(data), read_only=True, data_only=True)
    sheets = []
    for part, worksheet in zip(package.sheets, workbook.worksheets, strict=True):
        worksheet.reset_dimensions()
        seen = looked_at[part.title]
        rows = _rows(worksheet.iter_rows(values_only=True))
        for row, place in seen.errors:
            shows = rows.setdefault(row, {}).get(place, "an error")
            rows[row][place] = shows if isinstance(shows, ErrorCell) else ErrorCell(str(shows))
        for row, place in seen.unstored:
            rows.setdefault(row, {})[place] = Unstored()
        sheets.append(
            RawSheet(
                name=part.title,
                rows=dict(sorted(rows.items())),
                hidden=part.hidden,
                hidden_rows=frozenset(seen.hidden_rows),
                merged=tuple(seen.merged),
            )
        )
    properties = {one.name: str(one.value) for one in workbook.custom_doc_props.props}
    return Cells(
        sheets=sheets,
        modified=package.modified,
        role=properties.get(PROPERTY, ""),
        template_version=properties.get(f"{PROPERTY}_template_version", ""),
    )


def _rows(rows: Iterable[tuple[Any, ...]]) -> dict[int, dict[int, RawValue]]:
    """Return the non-blank cells of a sheet by row and column number."""
    found: dict[int, dict[int, RawValue]] = {}
    for number, values in enumerate(rows, start=1):
        cells = {place: _plain(value) for place, value in enumerate(values, start=1) if value is not None}
        if cells:
            found[number] = cells
    return found


def _plain(value: Any) -> RawValue:
    """Return a cell's value, an error word as an error and escaped characters as themselves."""
    if not isinstance(value, str):
        return value  # type: ignore[no-any-return]
    if value in ERROR_WORDS:
        return ErrorCell(value)
    return _ESCAPED.sub(lambda match: chr(int(match[1], 16)), value) if "_x" in value else value
