"""A workbook and its fixes → the same workbook with these cells replaced and a sheet that lists them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

from flexlash.feedback.fixing.fix import Fix
from flexlash.feedback.splicing.sheet_spans import SheetSpans, cell_xml
from flexlash.feedback.splicing.workbook_parts import WorkbookParts
from flexlash.feedback.splicing.xml_spans import spliced, xml_text
from flexlash.reading.elements import MAIN
from flexlash.reading.products import fixed_role
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.xlsx import PROPERTY
from flexlash.schema.cell_addresses import cell_address
from flexlash.schema.unused_names import numbered_names

__all__ = ["FIXES_SHEET", "fixed_workbook"]

FIXES_SHEET = "Fixes"
"""Sheet of a fixed submission that lists what was changed."""

_HEADINGS = ("Cell", "Found", "Now", "Finding")


def fixed_workbook(data: bytes, fixes: Sequence[Fix], limits: ReadingLimits) -> tuple[bytes, list[Fix]]:
    """Return the workbook with the fixes made, and the fixes that were made.

    A cell that holds a formula is left as it is. Nothing else changes but a document property, which says what the
    workbook was made of: every other byte of every part is the submission's own.
    """
    book = WorkbookParts(data, limits)
    by_sheet: dict[str, list[Fix]] = defaultdict(list)
    for fix in fixes:
        by_sheet[fix.sheet].append(fix)
    made: list[Fix] = []
    for title, sheet in book.worksheets.items():
        if wanted := by_sheet.get(title):
            content, done = _with_cells(book.read(sheet), wanted)
            if done:
                book.write(sheet, content)
                made += done
    if made:
        book.set_attributes(book.workbook, "calcPr", fullCalcOnLoad="1")
        titles = numbered_names(
            FIXES_SHEET, f"flexlash {FIXES_SHEET} 1", numbered=f"flexlash {FIXES_SHEET} {{}}".format
        )
        book.add_sheet(book.free_title(titles), _sheet(made))
        book.set_property(PROPERTY, fixed_role(data))
    return book.data(), made


def _with_cells(part: bytes, fixes: list[Fix]) -> tuple[bytes, list[Fix]]:
    """Return a sheet with cells replaced, and the fixes that were made."""
    addressed = [(cell, fix) for fix in fixes if (cell := cell_address(fix.cell))]
    cells = SheetSpans(part, [cell for cell, _ in addressed]).cells
    changes = []
    made = []
    for cell, fix in addressed:
        span = cells.pop(cell, None)
        if span and not span.is_formula:
            changes.append((span.start, span.end, cell_xml(fix.cell, fix.value, span.prefix, span.style)))
            made.append(fix)
    return spliced(part, changes), made


def _sheet(made: Sequence[Fix]) -> bytes:
    """Return the list of fixes as a worksheet, each linked to its cell."""
    title = f"flexlash fixed {len(made)} cell{'s' if len(made) != 1 else ''}; check each of them."
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
