"""The page that Drive is written on: the picked variant, what is looked up of it, and the part η of a mean shift."""

from __future__ import annotations

from typing import Any

from flexlash.report.drive.stored_drives import result_label
from flexlash.report.formula.functions import IF, MAX, PI, match_exactly
from flexlash.report.formula.live import Live, fill, put
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import Book
from flexlash.report.layout.wrapping import LINE_HEIGHT, lines_of, merged_width

__all__ = ["BESIDE", "COLUMNS", "LETTERS", "SHEET", "TABLE", "DrivePage"]

SHEET = "Drive"

COLUMNS = (
    ("Source", 22),
    ("Enter as", 14.5),
    ("Value", 7),
    ("Lower deviation", 9),
    ("Upper deviation", 9),
    ("Radius [mm]", 8),
    ("Pressure angle [°]", 9),
    ("Ratio", 8),
    ("Kind", 10.5),
    ("Distribution", 16),
    ("Limits at ± sigma", 8),
    ("At the output", 11),
    ("Average [{angle}]", 8),
    ("T [{angle}]", 8),
    ("c", 6),
    ("(c T)²", 7),
    ("((1 − η) c T)²", 7.5),
    ("Of the average", 8),
    ("Of the variance", 8.5),
    ("Of the worst case", 7.5),
)
"""Headings and widths of the table of sources, whose columns are those of the sheet."""

BESIDE = 12
"""Column from which on charts stand beside tables and notes."""

LETTERS = {"size": 11}
"""Font of charts, which is that of cells when the page is printed."""

TABLE = 5
"""Row, from 0, of the headings of the first table; above it stand title, hint, variant and η."""

_PICK, _SHIFT = 2, 3


class DrivePage:
    """The sheet with the reader's choice: `shift` is η, `limit` the system limit of the picked variant."""

    def __init__(self, book: Book, stored: Stored, shift: float) -> None:
        self.book, self.stored = book, stored
        self.sheet: Any = book.sheet(SHEET, tab="entry")
        self._number = self._pick()
        self.sheet.write_string(_SHIFT, 0, "η, mean shift", book.format("label"))
        self.shift = fill(self.sheet, _SHIFT, 1, shift, book.format("input", "general"))

    def _pick(self) -> Live:
        """Write the drop-down; return the number of the variant, the worst one's where it is not in the list."""
        book, sheet, names = self.book, self.sheet, self.stored.cells("Variant")
        note = "Pick a variant, or type other numbers into the yellow cells: averages, rules, shares and charts follow."
        sheet.write_string(1, 0, note, book.format("quiet"))
        sheet.write_string(_PICK, 0, "Variant", book.format("label"))
        style = book.format("input")
        sheet.merge_range(_PICK, 1, _PICK, 4, "", style)
        name = fill(sheet, _PICK, 1, str(names.values[0]), style)
        sheet.data_validation(_PICK, 1, _PICK, 1, {
            "validate": "list",
            "source": f"={names.text}",
            "input_title": "Variant",
            "input_message": "The whole sheet follows.",
            "error_title": "Variant",
            "error_message": "Pick a variant from the list.",
        })  # fmt: skip
        place = put(sheet, _PICK, 5, match_exactly(name, names), book.format("quiet", '"number "0;;""'))
        put(sheet, _PICK, 6, IF(place > 0.0, "", "◄ not on the list: the worst is shown"), book.format("hint"))
        return MAX(place, 1.0)

    @property
    def radians(self) -> Live:
        """The unit of angles in radians."""
        return PI / (10800 * self.book.angles.per_arcmin)

    def result(self, key: str) -> Live:
        """Return a Result of the picked variant, an empty text where it has none."""
        return self.looked_up(result_label(key, self.book.angles))

    def looked_up(self, heading: str) -> Live:
        """Return what Drives holds of the picked variant under a heading."""
        return self.stored.pick(self._number, heading)

    def section(self, row: int, title: str, columns: int = len(COLUMNS)) -> None:
        """Write the title of a section."""
        for column in range(columns):
            self.sheet.write_blank(row, column, None, self.book.format("section"))
        self.sheet.write_string(row, 0, title, self.book.format("section"))

    def notes(self, row: int, *notes: str) -> int:
        """Write notes below each other from a row on, wrapped beside the charts; return the row after them."""
        width = merged_width([width for _, width in COLUMNS[:BESIDE]])
        for note in notes:
            self.sheet.merge_range(row, 0, row, BESIDE - 1, note, self.book.format("note"))
            self.sheet.set_row(row, LINE_HEIGHT * lines_of(note, width))
            row += 1
        return row
