"""The page that Trace is written on: lines of one quantity each, with its value, unit and equation in words."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from xlsxwriter.utility import xl_rowcol_to_cell

from flexlash.report.formula.functions import AND, IF, PI, on_sheet
from flexlash.report.formula.live import Live, Value, put
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import PALETTE, Book
from flexlash.report.trace.inputs import PROGRAM

__all__ = ["CHANGE", "HEADER", "LEFT_OUT", "SHEET", "SUBMITTED", "VALUE", "WIDTHS", "Lines", "Page", "Words"]

SHEET = "Trace"
LEFT_OUT = "none"
"""What a reader types to leave an optional input out, and what stands where there is none."""

HEADER = 4
"""Row of the headings, from 0; they stay in sight."""

_NAME, _SYMBOL, VALUE, _UNIT, _EQUATION, SUBMITTED, CHANGE = range(7)
_COLUMNS = (
    ("Quantity", 31),
    ("Symbol", 8),
    ("Value used", 15),
    ("Unit", 16),
    ("Equation", 56),
    ("As submitted, or the program's value", 15),
    ("Your change, or the difference", 15),
)
WIDTHS = tuple(width for _, width in _COLUMNS)
_LOOKS = {
    "size": 'General;-General;"none"',
    "plain": "General",
    "integral": '0.00000E+00;-0.00000E+00;"none"',
    "angle": '0.000000E+00;-0.000000E+00;"none"',
    "fine": '0.000000;-0.000000;"none"',
    "figure": '#,##0.000;-#,##0.000;"none"',
    "difference": "0.0E+00",
    "share": '0.00%;-0.00%;"none"',
}
_SHAPES = {_UNIT: "indented"}

_PART_LOOK = '"a part";;"no part"'

Words = tuple[str, str, str, str]
"""Quantity, symbol, unit and equation of a line."""


class Lines(ABC):
    """Lines of one quantity each on a sheet of this title, for the variant of a number; each is found by its key."""

    def __init__(self, book: Book, sheet: Any, title: str, number: Live) -> None:
        self.book = book
        self.sheet = sheet
        self.title = title
        self.number = number
        self.row = 0
        self.lines: dict[str, Live] = {}

    def __getitem__(self, key: str) -> Live:
        """Return the reference to a line's value."""
        return self.lines[key]

    @abstractmethod
    def of_part(self, value: Live, instead: str = LEFT_OUT, sheet: str = "") -> Live:
        """Return a number, or another text where the inputs make no part; as this or another sheet writes it."""

    @abstractmethod
    def section(self, title: str) -> None:
        """Begin a section."""

    @abstractmethod
    def line(self, key: str, value: Live, words: Words, look: str = "figure") -> Live:
        """Write the next line and return the reference to its value."""


class Page(Lines):
    """The lines of Trace."""

    def __init__(self, book: Book, sheet: Any, number: Live, stored: Stored) -> None:
        super().__init__(book, sheet, SHEET, number)
        self.stored = stored
        self.row = HEADER
        self.rows: dict[str, int] = {}
        self.sections: list[int] = []
        self.entries: dict[str, tuple[Live, Live]] = {}
        self._is_part: Live | None = None
        self.differences: list[Value] = []
        self._none = book.workbook.add_format({"font_color": PALETTE["grey"]})
        for column, (heading, width) in enumerate(_COLUMNS):
            sheet.set_column(column, column, width)
            sheet.write_string(HEADER, column, heading, book.format("header"))
        sheet.set_row(HEADER, 48)

    def judge(self, fault: Live) -> None:
        """Let all that follows say none where a variant is missing or the inputs have this fault; "" is none."""
        is_part = IF(AND(self.number > 0, fault.equals("")), 1.0, 0.0)
        self._is_part = put(self.sheet, HEADER - 1, CHANGE, is_part, self.book.format("quiet", _PART_LOOK))

    def of_part(self, value: Live, instead: str = LEFT_OUT, sheet: str = "") -> Live:
        """Return a number, or another text where the inputs make no part; as this or another sheet writes it."""
        if self._is_part is None:
            return value
        return IF(on_sheet(SHEET, self._is_part) if sheet else self._is_part, value, instead)

    def submitted(self, heading: str) -> Live:
        """Return what was submitted, an empty text where that is blank or no variant is picked."""
        return IF(self.number > 0, self.stored.pick(self.number, heading), "")

    def section(self, title: str) -> None:
        """Begin a section."""
        self.row += 2
        self.sections.append(self.row)
        for column in range(len(_COLUMNS)):
            self.sheet.write_blank(self.row, column, None, self.book.format("section"))
        self.sheet.write_string(self.row, _NAME, title, self.book.format("section"))

    def line(self, key: str, value: Live, words: Words, look: str = "figure") -> Live:
        """Write the next line and return the reference to its value; the program's value stands beside it."""
        self.row += 1
        self._write_words(words)
        style = self.book.format("figure", _LOOKS[look])
        self.lines[key] = put(self.sheet, self.row, VALUE, self.of_part(value), style)
        self.rows[key] = self.row
        if look == "angle":
            angle = self.of_part(self.lines[key] / self.radians, "rad")
            put(self.sheet, self.row, _UNIT, angle, self.book.format("indented", self._angle_look))
        self._grey()
        if key in PROGRAM:
            self._write_program(self.lines[key], PROGRAM[key][0], style, is_word=look == "plain")
        return self.lines[key]

    @property
    def radians(self) -> Live:
        """The unit of angles in radians."""
        return PI / (10800 * self.book.angles.per_arcmin)

    @property
    def _angle_look(self) -> str:
        """The number format of an angle behind its value in radians."""
        digits, sign = self.book.angles.decimals(4), self.book.angles.sign
        return f'"rad = "{digits}"{sign}";"rad = "-{digits}"{sign}";"rad"'

    def _write_words(self, words: Words) -> None:
        for column, text in zip((_NAME, _SYMBOL, _UNIT, _EQUATION), words, strict=True):
            if text:
                self.sheet.write_string(self.row, column, text, self.book.format(_SHAPES.get(column, "text")))

    def _grey(self) -> None:
        """Let a line without a value stand back."""
        cell = xl_rowcol_to_cell(self.row, VALUE, col_abs=True)
        rule = {"type": "formula", "criteria": f'=OR({cell}=0,{cell}="none")', "format": self._none}
        self.sheet.conditional_format(self.row, _NAME, self.row, _EQUATION, rule)

    def _write_program(self, traced: Live, heading: str, style: Any, *, is_word: bool) -> None:
        """Write what the program found and how far the traced value is from it."""
        submitted = self.of_part(self.stored.pick(self.number, heading))
        program = put(self.sheet, self.row, SUBMITTED, submitted, style)
        off = IF(traced.equals(program), 0.0, 1.0) if is_word else traced / program - 1
        nothing = "none" if is_word else 0.0
        difference = IF(program.equals(""), IF(traced.equals(nothing), "", 1.0), off)
        shown = put(
            self.sheet, self.row, CHANGE, self.of_part(difference, ""), self.book.format("figure", _LOOKS["difference"])
        )
        self.differences.append(shown.value)
        cell = xl_rowcol_to_cell(self.row, CHANGE)
        changed = self.book.workbook.add_format({"num_format": "+0.000%;-0.000%"})
        rule = {"type": "formula", "criteria": f"=ABS(N({cell}))>0.000001", "format": changed}
        self.sheet.conditional_format(self.row, CHANGE, self.row, CHANGE, rule)
