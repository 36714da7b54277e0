"""The Findings sheet of a marked copy: what was found, where, and how to mend it, worst first."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from openpyxl import Workbook
from openpyxl.cell import Cell
from openpyxl.styles import Alignment, Border, Font, PatternFill, Side
from openpyxl.utils import get_column_letter, quote_sheetname
from openpyxl.worksheet.hyperlink import Hyperlink

from flexlash.feedback.annotation.appearance import FILLS, put
from flexlash.feedback.annotation.record import free_title
from flexlash.schema.finding_catalogue import Level
from flexlash.schema.findings import Finding
from flexlash.schema.result_columns import FINDINGS

__all__ = ["MOST_LISTED", "counted", "write_findings"]

MOST_LISTED = 5_000
"""Findings beyond this number are counted, not listed."""

_WIDTHS = {"code": 8, "message": 62, "fix": 46, "suggestion": 18, "variant": 20, "column": 24, "value": 20}
_LETTERS_ACROSS = 150
_LINE = 15
_LEVELS: tuple[Level, ...] = ("error", "warning", "info")
_TITLE = Font(name="Calibri", size=16, bold=True, color="FF1F3A5F")
_TEXT = Font(name="Calibri", size=11)
_HEAD = Font(name="Calibri", size=11, bold=True)
_LINK = Font(name="Calibri", size=11, underline="single", color="FF0072B2")
_HEAD_FILL = PatternFill("solid", fgColor="FFD9E2EC", bgColor="FFD9E2EC")
_EDGE = Side(style="thin", color="FF8EA9C1")
_BORDER = Border(left=_EDGE, right=_EDGE, top=_EDGE, bottom=_EDGE)
_UNDERLINE = Border(bottom=Side(style="hair", color="FF8EA9C1"))
_WRAP = Alignment(wrap_text=True, vertical="center")
_MIDDLE = Alignment(vertical="center")
_CENTRE = Alignment(wrap_text=True, horizontal="center", vertical="center")
_AS_ENTERED = {"variant", "value", "suggestion"}


def counted(findings: Sequence[Finding]) -> str:
    """Return in words how many errors and warnings there are.

    >>> counted([])
    'no errors and no warnings'
    """
    words = []
    for level in ("error", "warning"):
        number = sum(one.level == level for one in findings)
        words.append(f"{number:,} {level}{'' if number == 1 else 's'}" if number else f"no {level}s")
    return " and ".join(words)


def write_findings(workbook: Workbook, findings: Sequence[Finding], title: str, lines: Sequence[str]) -> str:
    """Write the findings as the first sheet, under a title and lines of explanation; return the sheet's name."""
    sheet = workbook.create_sheet(free_title(workbook, "Findings"), 0)
    put(sheet["A1"], title)
    sheet["A1"].font = _TITLE
    sheet.row_dimensions[1].height = 24
    top = [part for line in lines for part in textwrap.wrap(line, _LETTERS_ACROSS)]
    for row, text in enumerate(top, start=2):
        put(sheet.cell(row, 1), text)
        sheet.cell(row, 1).font = _TEXT
    header = len(top) + 3
    _write_header(sheet, header)
    order = sorted(findings, key=lambda one: (_LEVELS.index(one.level), one.code))
    styles = _styles(sheet)
    reachable = {one.title for one in workbook.worksheets}
    for row, one in enumerate(order[:MOST_LISTED], start=header + 1):
        _write_finding(sheet, row, one, styles, linked=one.sheet in reachable)
    last = header + max(1, min(len(order), MOST_LISTED))
    if not order:
        put(sheet.cell(last, 1), "Nothing was found.")
    elif len(order) > MOST_LISTED:
        put(sheet.cell(last + 1, 1), f"{len(order) - MOST_LISTED:,} more findings are not listed. Mend these first.")
    sheet.auto_filter.ref = f"A{header}:{get_column_letter(len(FINDINGS))}{last}"
    _set_up(sheet, header)
    _open_at(workbook, sheet)
    return str(sheet.title)


def _write_header(sheet: Any, row: int) -> None:
    for place, column in enumerate(FINDINGS, start=1):
        sheet.column_dimensions[get_column_letter(place)].width = _WIDTHS.get(column.key, 11)
        cell = sheet.cell(row, place)
        put(cell, column.label)
        cell.font, cell.fill, cell.border, cell.alignment = _HEAD, _HEAD_FILL, _BORDER, _CENTRE
    sheet.row_dimensions[row].height = 22


def _write_finding(sheet: Any, row: int, found: Finding, styles: Mapping[str, Any], *, linked: bool) -> None:
    """Write one finding, its level coloured and its cell linked."""
    lines = 1
    for place, (key, text) in enumerate(found.as_dictionary().items(), start=1):
        cell = sheet.cell(row, place)
        link = key == "cell" and linked and bool(text)
        cell._style = styles["link" if link else found.level if key == "level" else key]  # noqa: SLF001
        if text:
            put(cell, text)
            lines = max(lines, -(-len(text) // (_WIDTHS[key] - 4)) if key in _WIDTHS else 1)
        if link:
            there = f"{quote_sheetname(found.sheet)}!{found.cell}"
            cell.hyperlink = Hyperlink(ref=cell.coordinate, location=there, tooltip="Go to the cell")
    sheet.row_dimensions[row].height = _LINE * lines + 4


def _styles(sheet: Any) -> dict[str, Any]:
    """Return the format of each column, level and link; to make it anew for every cell would take seconds."""
    styles = {}
    for key in (*(column.key for column in FINDINGS), *_LEVELS, "link"):
        cell = Cell(sheet, row=1, column=1)
        cell.font = _LINK if key == "link" else _TEXT
        cell.alignment = _WRAP if key in _WIDTHS else _MIDDLE
        cell.border = _UNDERLINE
        cell.number_format = "@" if key in _AS_ENTERED else "General"
        if key in FILLS:
            cell.fill = FILLS[key]
        styles[key] = cell._style  # noqa: SLF001
    return styles


def _set_up(sheet: Any, header: int) -> None:
    """Freeze the header and set the sheet up to print one page wide."""
    sheet.freeze_panes = sheet.cell(header + 1, 1)
    sheet.sheet_view.showGridLines = False
    sheet.sheet_properties.tabColor = FILLS["error"].fgColor
    sheet.page_setup.orientation = "landscape"
    sheet.page_setup.paperSize = 9
    sheet.page_setup.fitToHeight = 0
    sheet.sheet_properties.pageSetUpPr.fitToPage = True
    sheet.print_title_rows = f"{header}:{header}"
    sheet.oddFooter.left.text, sheet.oddFooter.center.text = "&A", "&P / &N"


def _open_at(workbook: Workbook, sheet: Any) -> None:
    """Let the workbook open at a sheet, and at that alone: sheets selected together are edited together."""
    for one in [*workbook.worksheets, *workbook.chartsheets]:
        for view in one.views.sheetView if hasattr(one, "views") else one.sheetViews.sheetView:
            view.tabSelected = False
    workbook.active = sheet
    sheet.sheet_view.tabSelected = True
    for view in workbook.views:
        view.firstSheet = 0
