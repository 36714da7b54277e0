"""Fills and notes on guilty cells, and taking them away again by the record of an earlier marking."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from copy import copy
from typing import Any

from openpyxl import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from flexlash.feedback.annotation.appearance import AUTHOR, FILLS, level_of, note, wear, worn
from flexlash.feedback.annotation.record import Mark
from flexlash.feedback.annotation.shading import overrule, withdraw
from flexlash.schema.finding_catalogue import Level
from flexlash.schema.findings import Finding

__all__ = ["MOST_NOTES", "Place", "guilty_cells", "mark", "unmark"]

MOST_NOTES = 1000
"""Notes, and areas with conditional formats of ours, beyond this number make a workbook slow; fills do not."""

_MOST_IN_A_NOTE = 5
_HEAD = "— flexlash —"
_LAST_ROW, _LAST_COLUMN = 1_048_576, 16_384

Place = tuple[str, int, int]
"""Sheet, row and column of a cell."""


def guilty_cells(workbook: Workbook, findings: Iterable[Finding]) -> dict[Place, list[Finding]]:
    """Return the cells with an error or warning and all findings on each, cells with errors first."""
    found: dict[Place, list[Finding]] = {}
    sheets = {sheet.title: sheet for sheet in workbook.worksheets}
    merged = {title: [area.bounds for area in sheet.merged_cells.sorted()] for title, sheet in sheets.items()}
    for one in findings:
        if one.sheet in sheets and one.address:
            row, column = one.address
            if row <= _LAST_ROW and column <= _LAST_COLUMN:
                row, column = _top_left(merged[one.sheet], row, column)
                found.setdefault((one.sheet, row, column), []).append(one)
    guilty = {place: on_cell for place, on_cell in found.items() if _worst(on_cell) != "info"}
    return dict(sorted(guilty.items(), key=lambda item: _worst(item[1]) != "error"))


def mark(workbook: Workbook, guilty: dict[Place, list[Finding]]) -> list[Mark]:
    """Fill guilty cells, put notes on the first of them, and return what they were before."""
    marks = []
    fills = {level: workbook._fills.add(fill) for level, fill in FILLS.items()}  # noqa: SLF001
    places: dict[str, dict[Level, list[tuple[int, int]]]] = {}
    for number, ((title, row, column), findings) in enumerate(guilty.items()):
        sheet, level = workbook[title], _worst(findings)
        cell = _cell(sheet, row, column)
        theirs = cell.comment
        marks.append(Mark(sheet=title, cell=cell.coordinate, fill=worn(cell), author=_author(theirs)))
        wear(cell, fills[level])
        if number < MOST_NOTES:
            before = f"{theirs.text}\n\n" if theirs else ""
            cell.comment = note(f"{before}{_HEAD}\n{_told(findings)}", AUTHOR)
            places.setdefault(title, {"error": [], "warning": []})[level].append((row, column))
    for title, by_level in places.items():
        overrule(workbook[title], by_level)
    return marks


def unmark(workbook: Workbook, marks: Sequence[Mark]) -> None:
    """Give all cells the fills and notes that they had before the marks, and all notes a readable size.

    A mark that was moved, as by sorting, takes what was recorded for another cell of its column.
    """
    ours = {number for number, fill in enumerate(workbook._fills) if level_of(fill)} if marks else set()  # noqa: SLF001
    recorded = {(one.sheet, one.cell): one for one in marks}
    astray = []
    for sheet in workbook.worksheets:
        withdraw(sheet)
        for cell in sheet._cells.values():  # noqa: SLF001
            marked = worn(cell) in ours
            before = recorded.pop((sheet.title, cell.coordinate), None) if marked else None
            if before:
                wear(cell, before.fill)
            elif marked:
                astray.append(cell)
            if cell.comment is not None:
                _clear_note(cell, before.author if before else "")
    spare = {(one.sheet, one.column): one for one in recorded.values()}
    for cell in astray:
        one = spare.get((cell.parent.title, cell.column_letter))
        wear(cell, one.fill if one else 0)


def _clear_note(cell: Any, author: str) -> None:
    """Leave of a note what is the user's."""
    theirs, head, _ = cell.comment.text.rpartition(_HEAD)
    if not head:
        cell.comment = note(cell.comment.text, cell.comment.author)
    elif theirs.strip():
        cell.comment = note(theirs.removesuffix("\n\n"), author)
    else:
        cell.comment = None


def _top_left(merged: Sequence[tuple[int, int, int, int]], row: int, column: int) -> tuple[int, int]:
    """Return the cell that shows a cell's content: the first of its merged area, or itself."""
    for first_column, first_row, last_column, last_row in merged:
        if first_row <= row <= last_row and first_column <= column <= last_column:
            return first_row, first_column
    return row, column


def _cell(sheet: Worksheet, row: int, column: int) -> Any:
    """Return a cell; one that is not there yet gets the format of its row or column."""
    if (row, column) in sheet._cells:  # noqa: SLF001
        return sheet.cell(row, column)
    cell = sheet.cell(row, column)
    bands = [sheet.row_dimensions[row]] if row in sheet.row_dimensions else []
    bands += [one for one in sheet.column_dimensions.values() if (one.min or 0) <= column <= (one.max or 0)]
    styled = next((band for band in bands if band.has_style), None)
    if styled is not None:
        cell._style = copy(styled._style)  # noqa: SLF001
    return cell


def _author(comment: Any) -> str:
    return comment.author or "" if comment else ""


def _worst(findings: Iterable[Finding]) -> Level:
    levels = {one.level for one in findings}
    return "error" if "error" in levels else "warning" if "warning" in levels else "info"


def _told(findings: Sequence[Finding]) -> str:
    """Return what a note says of a cell's findings, worst first."""
    order = sorted(findings, key=lambda one: ("error", "warning", "info").index(one.level))
    told = [f"{one.level.capitalize()} {one.code}: {one.message}\nMend: {one.fix}" for one in order[:_MOST_IN_A_NOTE]]
    if len(order) > _MOST_IN_A_NOTE:
        told.append(f"{len(order) - _MOST_IN_A_NOTE} more: see the Findings sheet.")
    return "\n\n".join(told)
