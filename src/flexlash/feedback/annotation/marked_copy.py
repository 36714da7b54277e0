"""Submission + findings → a workbook with its guilty cells marked, or with the findings alone."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from flexlash.feedback.annotation.appearance import COLOURS, FILLS
from flexlash.feedback.annotation.findings_list import counted, findings_sheet
from flexlash.feedback.annotation.guilty_cells import guilty_cells, note_text, worst
from flexlash.feedback.annotation.marks import Cell, fill_cells, restore_cells
from flexlash.feedback.annotation.marks_record import RECORD, Record, free_titles, quoted, record_sheet, take_record
from flexlash.feedback.annotation.notes import add_notes, clear_notes
from flexlash.feedback.annotation.shading import overrule, withdraw
from flexlash.feedback.annotation.table_sheets import table_workbook
from flexlash.feedback.splicing.sheet_spans import Area, SheetSpans, area_of
from flexlash.feedback.splicing.stylesheet import Stylesheet, empty_stylesheet
from flexlash.feedback.splicing.workbook_parts import WorkbookParts
from flexlash.feedback.splicing.xml_spans import element_spans, xml_text
from flexlash.reading.raw import RawSheet
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.xlsx import PROPERTY
from flexlash.schema.cell_addresses import column_letters
from flexlash.schema.finding_catalogue import Level
from flexlash.schema.findings import Finding
from flexlash.schema.result_columns import FINDINGS

__all__ = ["CHECKED", "MOST_NOTES", "MarkedCopy", "findings_workbook", "marked_copy", "marked_table"]

CHECKED = "checked"
"""What the document property says of a marked copy."""

MOST_NOTES = 1000
"""Notes, and areas with conditional formats of ours, beyond this number make a workbook slow; fills do not."""

_UNLIMITED = ReadingLimits().times(1000, "part_mebibytes", "unpacked_mebibytes", "compression")
"""For workbooks of our own making."""

_STYLES = "xl/styles.xml"
_TO_DO = "Fix the coloured cells in your own file and submit that; flexlash skips this copy without --marked-copies."


@dataclass(frozen=True, kw_only=True)
class MarkedCopy:
    """A marked workbook, and what of the submission it does not hold."""

    data: bytes
    lost: tuple[str, ...]


def marked_copy(
    data: bytes, findings: Sequence[Finding], name: str, limits: ReadingLimits | None = None, *, macros: bool = False
) -> MarkedCopy:
    """Return the user's own workbook with its guilty cells marked; marks of an earlier copy give way to the new ones.

    Every part that holds no mark is the submission's own, byte for byte. `macros` says that the copy is to be a file of
    the kind that may hold macros. Raises Refusal for a workbook that is refused, and ValueError or ExpatError for one
    in which a mark has no place.
    """
    book = WorkbookParts(data, limits or ReadingLimits())
    styles = _stylesheet(book)
    lost = tuple(dict.fromkeys([*_unmarked(book, styles), *_given_up(book, macros=macros)]))
    lines = [_TO_DO]
    if lost:
        lines.append(f"Your own file holds what this copy could not take over: {', '.join(lost)}.")
    title = f"flexlash: what to fix in {name}"
    record, more = _mark(book, styles, findings, lost)
    _add_findings(book, styles, findings, [title, more[0], *lines, *more[1:]], record)
    return MarkedCopy(data=_finished(book, styles), lost=lost)


def marked_table(
    sheets: Mapping[str, RawSheet], findings: Sequence[Finding], name: str, *, macros: bool = False
) -> bytes:
    """Return a submission that is no workbook as one, with its guilty cells marked."""
    return marked_copy(table_workbook(sheets), findings, name, _UNLIMITED, macros=macros).data


def findings_workbook(
    findings: Sequence[Finding], name: str, why: str, *, number: str = "", macros: bool = False
) -> bytes:
    """Return the findings alone, for a submission that cannot be marked; `why` is the first line.

    `number` says how many errors and warnings there are, where these are the first of them.
    """
    book = WorkbookParts(table_workbook({RECORD: RawSheet(name=RECORD, rows={})}), _UNLIMITED)
    book.set_kind(macros=macros)
    styles = _stylesheet(book)
    lines = [
        f"{name} has {number or counted(findings)}.",
        "Fix the cells listed here in your own file and submit it again.",
    ]
    _add_findings(book, styles, findings, [why, *lines], None)
    book.remove_sheet(RECORD)
    book.remove("", "docProps/app.xml")
    return _finished(book, styles)


def _stylesheet(book: WorkbookParts) -> Stylesheet:
    """Return the workbook's stylesheet, made where there is none for the formats that its cells name all the same."""
    if part := book.related(book.workbook, "styles"):
        return Stylesheet(book.read(part))
    if _STYLES in book.parts:
        # Readers look for it here, also where nothing refers to it.
        book.add(book.workbook, "styles", _STYLES, book.read(_STYLES))
        return Stylesheet(book.read(_STYLES))
    named = {"0"}

    def note(style: str) -> bool:
        named.add(style or "0")
        return False

    for sheet in book.worksheets.values():
        SheetSpans(book.read(sheet), (), note)
    book.add(book.workbook, "styles", _STYLES, empty_stylesheet(1 + max(map(int, named))))
    return Stylesheet(book.read(_STYLES))


def _unmarked(book: WorkbookParts, styles: Stylesheet) -> Sequence[str]:
    """Take the marks of an earlier copy away; return what that one could not keep."""
    record = take_record(book)
    if record is None:
        return ()
    ours = styles.fills_of(*COLOURS.values())
    for title, sheet in book.worksheets.items():
        clear_notes(book, sheet)
        part = withdraw(book.read(sheet))
        book.write(sheet, restore_cells(part, styles, ours, record.marks.get(title, {})))
    return record.lost


def _given_up(book: WorkbookParts, *, macros: bool) -> Sequence[str]:
    """Remove what a copy cannot keep, and return it in words."""
    lost = []
    book.set_kind(macros=macros)
    if not macros and (project := book.related(book.workbook, "vbaProject")):
        book.remove(book.workbook, project)
        lost.append("macros")
    if origin := book.related("", "origin"):
        lost.append(f"digital signatures ({len(book.relations(origin))})")
        book.remove("", origin)
    return lost


def _mark(
    book: WorkbookParts, styles: Stylesheet, findings: Sequence[Finding], lost: Sequence[str]
) -> tuple[Record, list[str]]:
    """Mark the guilty cells; return the record for the next marking, and what the list says of the marks."""
    sheets = book.worksheets
    guilty = guilty_cells(findings, {title: _merged(book.read(sheet)) for title, sheet in sheets.items()})
    by_sheet: dict[str, dict[Cell, list[Finding]]] = {}
    texts: dict[str, dict[Cell, str]] = {title: {} for title in sheets}
    for number, ((title, *cell), on_cell) in enumerate(guilty.items()):
        by_sheet.setdefault(title, {})[cell[0], cell[1]] = on_cell
        if number < MOST_NOTES:
            texts[title][cell[0], cell[1]] = note_text(on_cell)
    marks = {
        title: _mark_sheet(
            book, sheets[title], styles, {cell: worst(on_cell) for cell, on_cell in cells.items()}, texts[title]
        )
        for title, cells in by_sheet.items()
    }
    threads = sum(add_notes(book, sheets[title], on_sheet) for title, on_sheet in texts.items())
    first = (
        f"{counted(findings).capitalize()}. Cells with an error are red, cells with a warning yellow; "
        "each has a note that says how to fix it."
    )
    words = [first]
    if len(guilty) > MOST_NOTES:
        words.append(f"Notes are on the first {MOST_NOTES:,} of {len(guilty):,} coloured cells; the list has them all.")
    if threads:
        words.append(f"Coloured cells with a comment thread have no note: {threads:,}; the list has them all.")
    return Record(marks=marks, lost=lost), words


def _mark_sheet(
    book: WorkbookParts, sheet: str, styles: Stylesheet, levels: Mapping[Cell, Level], noted: Collection[Cell]
) -> dict[Cell, str]:
    """Fill the guilty cells of a worksheet and return the formats that they had."""
    fills = {level: styles.add("fills", fill) for level, fill in FILLS.items()}
    part, before = fill_cells(book.read(sheet), styles, {cell: fills[level] for cell, level in levels.items()})
    shaded = {level: [cell for cell in noted if levels[cell] == level] for level in FILLS}
    book.write(sheet, overrule(part, styles, shaded))
    return before


def _merged(part: bytes) -> list[Area]:
    """Return the merged areas of a worksheet."""
    return [area_of(span.attributes["ref"]) for span in element_spans(part, ("mergeCell",))[1:]]


def _add_findings(
    book: WorkbookParts, styles: Stylesheet, findings: Sequence[Finding], lines: Sequence[str], record: Record | None
) -> None:
    """Add the list of findings as the first sheet, and the record, if any, as the last, out of the user's sight."""
    book.set_property(PROPERTY, CHECKED)
    content, header, last = findings_sheet(findings, lines, styles, book.worksheets if record else ())
    sheet = book.free_title(free_titles("Findings"))
    book.add_sheet(sheet, content, first=True)
    if record:
        book.add_sheet(book.free_title(free_titles(RECORD)), record_sheet(sheet, record), state="veryHidden")
    table = f"{quoted(sheet)}!$A${header}:${column_letters(len(FINDINGS))}${last}"
    names = (
        f'<@definedName name="_xlnm._FilterDatabase" localSheetId="0" hidden="1">{xml_text(table).decode()}'
        '</@definedName><@definedName name="_xlnm.Print_Titles" localSheetId="0">'
        f"{xml_text(quoted(sheet)).decode()}!${header}:${header}</@definedName>"
    )
    book.add_names(names.encode())
    book.open_at_first()


def _finished(book: WorkbookParts, styles: Stylesheet) -> bytes:
    book.write(book.related(book.workbook, "styles"), styles.part())
    return book.data()
