"""The hidden sheet that remembers what marked cells looked like before.

Each row points to a marked cell by a formula, the number of its row, which spreadsheet programs adjust when rows are
inserted or a sheet is renamed, and wears the format that the cell had: a format written in words would not survive
every program.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from flexlash.feedback.annotation.appearance import plain
from flexlash.feedback.splicing.sheet_spans import cell_xml
from flexlash.feedback.splicing.workbook_parts import WorkbookParts
from flexlash.feedback.splicing.xml_spans import element_spans
from flexlash.reading.elements import MAIN
from flexlash.schema.cell_addresses import cell_address, column_letters
from flexlash.schema.unused_names import numbered_names

__all__ = ["Record", "free_titles", "quoted", "record_sheet", "take_record"]

RECORD = "flexlash marks"

Cell = tuple[int, int]
"""Row and column."""

_Pointer = tuple[str, int, int]
"""Title of a sheet, row and column."""


@dataclass(frozen=True, kw_only=True)
class Record:
    """What an earlier marking left: the formats that cells had, by sheet, and what it could not keep."""

    marks: dict[str, dict[Cell, str]] = field(default_factory=dict)
    lost: Sequence[str] = ()


def free_titles(wanted: str) -> Iterator[str]:
    """Yield titles for a sheet, the one wanted first."""
    return numbered_names(wanted, f"flexlash {wanted}", numbered=lambda number: f"{wanted} ({number})")


def quoted(title: str) -> str:
    """Return a sheet's title as a formula names it."""
    return "'" + title.replace("'", "''") + "'"


def record_sheet(findings_title: str, record: Record) -> bytes:
    """Return the record as a worksheet."""
    rows: list[tuple[_Pointer | None, str, str, str]] = [(None, "", RECORD, "")]
    rows.append(((findings_title, 1, 1), "", "findings", ""))
    rows += [(None, "", "lost", plain(what)) for what in record.lost]
    for title, cells in record.marks.items():
        for (row, column), style in sorted(cells.items()):
            rows.append(((title, row, column), style, "mark", ""))
    lines = []
    for number, (pointer, style, kind, text) in enumerate(rows, start=1):
        line = [_pointing(number, pointer, style) if pointer else cell_xml(f"A{number}", kind, "", style)]
        line += [cell_xml(f"B{number}", kind)] if number > 1 else []
        line += [cell_xml(f"C{number}", text)] if text else []
        lines.append(b'<row r="%d">%s</row>' % (number, b"".join(line)))
    head = f'<?xml version="1.0" encoding="UTF-8" standalone="yes"?><worksheet xmlns="{MAIN}"><sheetData>'
    return head.encode() + b"".join(lines) + b"</sheetData></worksheet>"


def _pointing(number: int, pointer: _Pointer, style: str) -> bytes:
    title, row, column = pointer
    return cell_xml(f"A{number}", row, "", style, f"ROW({quoted(title)}!${column_letters(column)}${row})")


def take_record(book: WorkbookParts) -> Record | None:
    """Return the record of an earlier marking and remove it, with the sheet of findings it made; None without one."""
    for sheet in book.sheets:
        if sheet.is_hidden and RECORD in sheet.title and sheet.kind == "worksheet":
            rows = list(_rows(book, sheet.part))
            if rows and rows[0][2] == RECORD:
                record = _record(book, rows[1:])
                book.remove_sheet(sheet.title)
                return record
    return None


def _record(book: WorkbookParts, rows: Sequence[tuple[str, str, str, str, str]]) -> Record:
    marks: dict[str, dict[Cell, str]] = {}
    lost = []
    for formula, style, _, kind, text in rows:
        # The cell of a pointer whose row was deleted is #REF!; earlier versions pointed without asking for the row.
        pointed = formula.removeprefix("=").removeprefix("ROW(").removesuffix(")").removesuffix("#REF!")
        title, _, address = pointed.rpartition("!")
        title = title.removeprefix("$")
        title = title[1:-1].replace("''", "'") if title.startswith("'") else title
        cell = cell_address(address.replace("$", ""))
        if kind == "lost":
            lost.append(text)
        elif kind == "findings" and title in book.worksheets:
            book.remove_sheet(title)
        elif kind == "mark" and cell:
            marks.setdefault(title, {})[cell] = style
    return Record(marks=marks, lost=lost)


def _rows(book: WorkbookParts, sheet: str) -> Iterator[tuple[str, str, str, str, str]]:
    """Yield the rows of a record: formula and format of the first cell, and the texts of the first three."""
    part = book.related(book.workbook, "sharedStrings")
    texts = [span.text for span in element_spans(book.read(part), ("si",))[1:]] if part else []
    row: dict[str, tuple[str, str, str]] = {}
    for span in element_spans(book.read(sheet), ("row", "c", "f", "v", "is"))[1:]:
        if span.name == "row":
            if row:
                yield _row(row)
            row = {}
        elif span.name == "c":
            letter = span.attributes["r"].rstrip("0123456789")
            style, kind = span.attributes.get("s", ""), span.attributes.get("t", "")
            row[letter] = ("", style, "")
        else:
            formula, style, text = row[letter]
            shown = texts[int(span.text)] if kind == "s" and span.name == "v" else span.text
            row[letter] = (span.text, style, text) if span.name == "f" else (formula, style, shown)
    if row:
        yield _row(row)


def _row(row: dict[str, tuple[str, str, str]]) -> tuple[str, str, str, str, str]:
    nothing = ("", "", "")
    formula, style, first = row.get("A", nothing)
    return formula, style, first, row.get("B", nothing)[2], row.get("C", nothing)[2]
