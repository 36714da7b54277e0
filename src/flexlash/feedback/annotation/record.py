"""The hidden sheet that remembers what marked cells looked like before.

Each row points to a marked cell by a formula, which spreadsheet programs adjust when rows are inserted or a sheet is
renamed, and wears the fill that the cell had: a fill written in words would not survive every program.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from openpyxl import Workbook
from openpyxl.utils import absolute_coordinate, quote_sheetname

from flexlash.feedback.annotation.appearance import put, wear, worn

__all__ = ["Mark", "Record", "free_title", "take_record", "write_record"]

_TITLE = "flexlash marks"
_POINTER = re.compile(r"=\$?(?P<sheet>'(?:[^']|'')+'|[^'!]+)!(?P<cell>\$?[A-Z]+\$?\d+|#REF!)")


@dataclass(frozen=True, kw_only=True)
class Mark:
    """A marked cell: the number of the fill it had, and who wrote the note it had."""

    sheet: str
    cell: str
    fill: int
    author: str = ""

    @property
    def column(self) -> str:
        """Letters of the cell's column."""
        return self.cell.rstrip("0123456789")


@dataclass(frozen=True, kw_only=True)
class Record:
    """What an earlier marking left: its marks, and what it had to leave behind."""

    marks: Sequence[Mark] = ()
    lost: Sequence[str] = ()


def free_title(workbook: Workbook, wanted: str) -> str:
    """Return a title that no sheet of the workbook bears yet."""
    taken = {title.casefold() for title in workbook.sheetnames}
    titles = [wanted, f"flexlash {wanted}", *(f"{wanted} ({number})" for number in range(2, len(taken) + 3))]
    return next(title for title in titles if title.casefold() not in taken)


def write_record(workbook: Workbook, findings_title: str, record: Record) -> None:
    """Write the record as the last sheet, out of the user's sight."""
    sheet = workbook.create_sheet(free_title(workbook, _TITLE))
    sheet.sheet_state = "veryHidden"
    put(sheet["A1"], _TITLE)
    sheet.append([_pointer(findings_title, "A1"), "findings"])
    for row, what in enumerate(record.lost, start=sheet.max_row + 1):
        put(sheet.cell(row, 2), "lost")
        put(sheet.cell(row, 3), what)
    for row, one in enumerate(record.marks, start=sheet.max_row + 1):
        pointer = sheet.cell(row, 1, _pointer(one.sheet, one.cell))
        wear(pointer, one.fill)
        put(sheet.cell(row, 2), "mark")
        if one.author:
            put(sheet.cell(row, 3), one.author)


def take_record(workbook: Workbook) -> Record:
    """Return the record of an earlier marking and remove it, together with the sheet of findings it made."""
    sheet = next((one for one in workbook.worksheets if one["A1"].value == _TITLE), None)
    if sheet is None:
        return Record()
    marks, lost = [], []
    for pointer, kind, text in sheet.iter_rows(min_row=2, max_col=3):
        place = _POINTER.fullmatch(str(pointer.value))
        title = place["sheet"].strip("'").replace("''", "'") if place else ""
        if kind.value == "lost":
            lost.append(str(text.value))
        elif kind.value == "findings" and title in workbook.sheetnames:
            workbook.remove(workbook[title])
        elif kind.value == "mark" and place:
            cell = place["cell"].replace("$", "")
            marks.append(Mark(sheet=title, cell=cell, fill=worn(pointer), author=str(text.value or "")))
    workbook.remove(sheet)
    return Record(marks=marks, lost=lost)


def _pointer(title: str, cell: str) -> str:
    """Return the formula that points to a cell."""
    return f"={quote_sheetname(title)}!{absolute_coordinate(cell)}"
