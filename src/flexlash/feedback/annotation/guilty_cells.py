"""Which cells are to be marked, at what level, and what the note on each says."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Collection, Iterable, Mapping, Sequence

from flexlash.feedback.splicing.sheet_spans import Area
from flexlash.schema.cell_addresses import cell_address
from flexlash.schema.finding_catalogue import Level
from flexlash.schema.findings import Finding

__all__ = ["LEVELS", "guilty_cells", "note_text", "worst"]

LEVELS: tuple[Level, ...] = ("error", "warning", "info")
"""Worst first."""

_MOST_IN_A_NOTE = 5
_LAST_ROW, _LAST_COLUMN = 1_048_576, 16_384


def guilty_cells(
    findings: Iterable[Finding], merged: Mapping[str, Sequence[Area]]
) -> dict[tuple[str, int, int], list[Finding]]:
    """Return the cells (sheet, row, column) with an error or warning and all findings on each, those with errors first.

    `merged` are the merged areas of each sheet that can be marked; a cell in one is known by the area's first.
    """
    cells: dict[str, dict[tuple[int, int], list[Finding]]] = {title: {} for title in merged}
    for finding in findings:
        cell = cell_address(finding.cell)
        if finding.sheet in cells and cell and cell.row <= _LAST_ROW and cell.column <= _LAST_COLUMN:
            cells[finding.sheet].setdefault(cell, []).append(finding)
    guilty: dict[tuple[str, int, int], list[Finding]] = {}
    for title, on_sheet in cells.items():
        areas = _areas_by_row(merged[title], {row for row, _ in on_sheet})
        for (row, column), on_cell in on_sheet.items():
            shown = next((one[:2] for one in areas[row] if one[1] <= column <= one[3]), (row, column))
            guilty.setdefault((title, *shown), []).extend(on_cell)
    blamed = {cell: on_cell for cell, on_cell in guilty.items() if worst(on_cell) != "info"}
    return dict(sorted(blamed.items(), key=lambda item: worst(item[1]) != "error"))


def _areas_by_row(areas: Iterable[Area], rows: Collection[int]) -> dict[int, list[Area]]:
    """Return the areas that cross each of these rows."""
    crossing: dict[int, list[Area]] = {row: [] for row in sorted(rows)}
    order = list(crossing)
    for area in areas:
        for row in order[bisect_left(order, area[0]) : bisect_right(order, area[2])]:
            crossing[row].append(area)
    return crossing


def worst(findings: Iterable[Finding]) -> Level:
    """Return the worst level among findings."""
    levels = {finding.level for finding in findings}
    return next(level for level in LEVELS if level in levels)


def note_text(findings: Sequence[Finding]) -> str:
    """Return what a note says of a cell's findings, worst first."""
    order = sorted(findings, key=lambda finding: LEVELS.index(finding.level))
    texts = [f"{one.level.capitalize()} {one.code}: {one.message}\nFix: {one.fix}" for one in order[:_MOST_IN_A_NOTE]]
    if len(order) > _MOST_IN_A_NOTE:
        texts.append(f"{len(order) - _MOST_IN_A_NOTE} more: see the Findings sheet.")
    return "\n\n".join(texts)
