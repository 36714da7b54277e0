"""A workbook and its repairs → the same workbook with these cells replaced and a sheet that lists them."""

from __future__ import annotations

import posixpath
import re
from collections import defaultdict
from collections.abc import Sequence

from flexlash.feedback.fixing.document_property import with_property
from flexlash.feedback.fixing.fix import Repair
from flexlash.feedback.fixing.splices import before_end, cell_spans, cell_xml, spliced, xml_text
from flexlash.reading.archive import packed, unpacked
from flexlash.reading.elements import MAIN, Listing
from flexlash.reading.package import open_package
from flexlash.reading.products import mended_role
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.xlsx import PROPERTY

__all__ = ["FIXES_SHEET", "mended_workbook"]

FIXES_SHEET = "Fixes"
"""Sheet of a mended submission that lists what was changed."""

_HEADINGS = ("Cell", "Found", "Now", "Finding")
_TYPES = "[Content_Types].xml"
_SHEET_TYPE = "application/vnd.openxmlformats-officedocument.spreadsheetml.worksheet+xml"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"


def mended_workbook(data: bytes, repairs: Sequence[Repair], limits: ReadingLimits) -> tuple[bytes, list[Repair]]:
    """Return the workbook with the repairs made, and the repairs that were made.

    A cell that holds a formula, or that stands in a part of unusual encoding, is left as it is. Nothing else changes
    but a document property, which says what the workbook was made of: every other byte of every part is the
    submission's own.
    """
    parts = unpacked(data, limits)
    package = open_package(parts, limits)
    by_sheet: dict[str, list[Repair]] = defaultdict(list)
    for repair in repairs:
        by_sheet[repair.sheet].append(repair)
    made: list[Repair] = []
    for sheet in package.sheets:
        wanted = by_sheet.get(sheet.title, [])
        if wanted and _is_plain(parts[sheet.part]):
            parts[sheet.part], done = _with_cells(parts[sheet.part], wanted)
            made += done
    if made:
        parts[package.workbook] = _recalculated(parts[package.workbook])
        if not package.mended:
            parts = _with_list(parts, package.workbook, made, limits)
            parts = with_property(parts, PROPERTY, mended_role(data), limits)
    return packed(parts, compressed=True), made


def _is_plain(part: bytes) -> bool:
    """Whether a part is written in an encoding in which ASCII is ASCII."""
    return b"\0" not in part


def _with_cells(part: bytes, repairs: list[Repair]) -> tuple[bytes, list[Repair]]:
    """Return a sheet with cells replaced, and the repairs that were made."""
    spans = cell_spans(part, frozenset(repair.cell for repair in repairs))
    changes: dict[tuple[int, int], bytes] = {}
    made = []
    for repair in repairs:
        span = spans.get(repair.cell)
        if span and not span.is_formula and (span.start, span.end) not in changes:
            changes[span.start, span.end] = cell_xml(repair.cell, repair.value, span.prefix, span.style)
            made.append(repair)
    return spliced(part, changes), made


def _recalculated(workbook: bytes) -> bytes:
    """Return the workbook's part with the wish that formulas be calculated when it is opened."""
    match = re.search(rb"<(?:[\w.-]+:)?calcPr\b([^<>]*?)/?>", workbook)
    if match is None or b"fullCalcOnLoad" in match[1]:
        return workbook
    return workbook[: match.end(1)] + b' fullCalcOnLoad="1"' + workbook[match.end(1) :]


def _with_list(
    parts: dict[str, bytes], workbook: str, made: Sequence[Repair], limits: ReadingLimits
) -> dict[str, bytes]:
    """Return the parts with one more sheet, which lists the repairs."""
    folder, name = posixpath.split(workbook)
    relations = f"{folder}/_rels/{name}.rels"
    part = next(
        name
        for number in range(1, len(parts) + 2)
        if (name := f"{folder}/worksheets/flexlash-fixes{number}.xml") not in parts
    )
    known = {one.get("Id", "") for one in Listing(parts[relations], limits, "Relationship").found}
    relation = next(name for number in range(1, len(known) + 2) if (name := f"rIdFixes{number}") not in known)
    sheets = Listing(parts[workbook], limits, "sheet").found
    numbers = [int(one.get("sheetId", "0")) for one in sheets]
    title = _free_title({one.get("name", "").casefold() for one in sheets})
    try:
        return {
            **parts,
            part: _sheet(made),
            _TYPES: before_end(
                parts[_TYPES],
                "Types",
                b'<@Override PartName="/%s" ContentType="%s"/>' % (part.encode(), _SHEET_TYPE.encode()),
            ),
            relations: before_end(
                parts[relations],
                "Relationships",
                b'<@Relationship Id="%s" Type="%s/worksheet" Target="/%s"/>'
                % (relation.encode(), _OFFICE.encode(), part.encode()),
            ),
            workbook: before_end(
                parts[workbook],
                "sheets",
                b'<@sheet name="%s" sheetId="%d" xmlns:fl="%s" fl:id="%s"/>'
                % (title.encode(), max(numbers, default=0) + 1, _OFFICE.encode(), relation.encode()),
            ),
        }
    except ValueError:
        return parts


def _free_title(taken: set[str]) -> str:
    """Return a title for the list that no sheet has."""
    titles = (FIXES_SHEET, *(f"flexlash {FIXES_SHEET} {number}" for number in range(1, len(taken) + 2)))
    return next(title for title in titles if title.casefold() not in taken)


def _sheet(made: Sequence[Repair]) -> bytes:
    """Return the list of repairs as a worksheet, each linked to its cell."""
    title = f"flexlash mended {len(made)} cell{'s' if len(made) != 1 else ''}; check each of them."
    table = [(title,), _HEADINGS, *((one.place, one.found, one.written, one.code) for one in made)]
    rows = b"".join(
        b'<row r="%d">%s</row>'
        % (row, b"".join(cell_xml(f"{letter}{row}", text) for letter, text in zip("ABCD", texts, strict=False)))
        for row, texts in enumerate(table, start=1)
    )
    links = b"".join(
        b'<hyperlink ref="A%d" location="%s"/>'
        % (row, xml_text(f"'{one.sheet.replace(chr(39), chr(39) * 2)}'!{one.cell}"))
        for row, one in enumerate(made, start=3)
    )
    return (
        b'<?xml version="1.0" encoding="UTF-8" standalone="yes"?>'
        b'<worksheet xmlns="%s"><cols><col min="1" max="1" width="24" customWidth="1"/>'
        b'<col min="2" max="3" width="32" customWidth="1"/></cols><sheetData>%s</sheetData>'
        b"<hyperlinks>%s</hyperlinks></worksheet>" % (MAIN.encode(), rows, links)
    )
