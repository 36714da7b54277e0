"""The sheet Trace slope: the backlash at mid-limits with one dimension moved, so that its slope can be audited.

Both values come from the formulas of Trace, written once more with the dimensions at mid-limits.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from flexlash.report.formula.functions import AND, IF, IFERROR, INDEX, ISNUMBER, MATCH, MAX, PI, on_sheet
from flexlash.report.formula.live import Live, Range, live, put
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import Book
from flexlash.report.trace.inputs import ENTERED
from flexlash.report.trace.trace_inputs import INPUT_LINES, what_blank_is
from flexlash.report.trace.trace_mechanics import write_integrals, write_shape, write_windups
from flexlash.report.trace.trace_page import LEFT_OUT, Lines, Words
from flexlash.report.trace.trace_steps import Sums, set_widths
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.entry_words import dimension_title

__all__ = ["SLOPE", "TRACE_SPREAD", "Moved", "write_slope"]

SLOPE, TRACE_SPREAD = "Trace slope", "Trace spread"
_NOTE = (
    f"Nothing to enter here: the formulas of Trace at mid-limits, with the dimension that is picked on {TRACE_SPREAD} "
    "one step above and below. Changes on Trace do not count."
)
_TOP = 3
_APART = 3
"""Rows between what is written twice."""

_BLOCK_ROWS = 100
"""More rows than the sums over points take."""

_NAME, _SYMBOL, _VALUE = range(3)
_WIDTHS = (34, 9, 18)


@dataclass(frozen=True, kw_only=True)
class Moved:
    """What is moved, as this sheet refers to it: the dimension's name, its step, and all names with their middles."""

    picked: Live
    step: Live
    names: Range
    middles: Range


class _SumsHere(Sums):
    """The sums over points that some variant needs: here no reader adds a fillet or a taper."""

    def __init__(self, page: Lines, sheet: Any, top: int, inputs: Stored) -> None:
        super().__init__(page, sheet, SLOPE, top)
        self._had = {name for name in DIMENSIONS if any(row[ENTERED[name].label] for row in inputs.rows)}

    def junction_fillet(self) -> Live:
        """Return the integral of the junction fillet [1/mm³]."""
        return super().junction_fillet() if "junction_fillet_radius" in self._had else live(0.0)

    def hub_fillet(self) -> Live:
        """Return the integral of the hub fillet [1/mm³]."""
        return super().hub_fillet() if "hub_fillet_radius" in self._had else live(0.0)

    def taper(self) -> Live:
        """Return the integral of a disk that thins in a straight line [1/mm³]."""
        return super().taper() if "disk_hub_thickness" in self._had else live(0.0)


class _Chain(Lines):
    """The formulas of Trace with one dimension moved by so many steps."""

    def __init__(self, book: Book, sheet: Any, number: Live, *, top: int, sound: Live) -> None:
        super().__init__(book, sheet, SLOPE, number)
        self.row = top
        self._sound = sound

    def of_part(self, value: Live, instead: str = LEFT_OUT, sheet: str = "") -> Live:  # noqa: ARG002
        """Return a number, or another text where no variant or none of its dimensions is picked."""
        return IF(self._sound, value, instead)

    def section(self, title: str) -> None:
        """Write the title of a section."""
        self.row += 1
        self.sheet.write_string(self.row, _NAME, title.partition(":")[0], self.book.format("label"))

    def line(self, key: str, value: Live, words: Words, look: str = "figure") -> Live:  # noqa: ARG002
        """Write the next line and return the reference to its value."""
        self.row += 1
        self.sheet.write_string(self.row, _NAME, words[0], self.book.format("text"))
        if words[1]:
            self.sheet.write_string(self.row, _SYMBOL, words[1], self.book.format("text"))
        style = self.book.format("figure", "general")
        self.lines[key] = put(self.sheet, self.row, _VALUE, self.of_part(value), style)
        return self.lines[key]

    def write(self, inputs: Stored, moved: Moved, steps: float) -> Live:
        """Write inputs and formulas; return the backlash [arcmin] as other sheets refer to it."""
        top = self.row
        kind = inputs.pick(MAX(self.number, 1.0), "Flexspline type")
        self.line("flexspline_type", kind, ("Flexspline type", "", "", ""))
        for name, symbol, _ in INPUT_LINES:
            if name in DIMENSIONS:
                self.line(name, self._input(name, inputs, moved, steps), (dimension_title(name), symbol, "", ""))
        write_shape(self)
        write_integrals(self, _SumsHere(self, self.sheet, top, inputs))
        write_windups(self)
        windup = self["rim_windup"] + self["wall_windup"] + self["junction_fillet_windup"]
        windup = windup + self["disk_body_windup"] + self["hub_fillet_windup"]
        return self.line("backlash", 2 * windup / (PI / 10800), ("Backlash [arcmin]", "2U", "", ""))

    def _input(self, name: str, inputs: Stored, moved: Moved, steps: float) -> Live:
        """Return an input in the middle of its limits, else as submitted, moved where it is the one; or its blank."""
        title = dimension_title(name)
        place = IFERROR(MATCH(title, moved.names, 0), 0.0)
        entered = inputs.pick(MAX(self.number, 1.0), ENTERED[name].label)
        middle = IF(place > 0, INDEX(moved.middles, MAX(place, 1.0)), entered)
        step = IF(moved.picked.equals(title), steps * moved.step, 0.0)
        return IF(ISNUMBER(middle), middle + step, what_blank_is(self, name))


def write_slope(book: Book, inputs: Stored, number: Live, moved: Moved) -> tuple[Live, Live]:
    """Write the sheet; return the backlash [arcmin] with the dimension one step above and below its middle."""
    sheet = book.sheet(SLOPE, landscape=False, tab="stored")
    sheet.write_string(0, 0, "Slope behind Trace spread", book.format("title"))
    sheet.set_row(0, 28)
    sheet.merge_range(1, 0, 1, _VALUE, _NOTE, book.format("wrap"))
    sheet.set_row(1, 64)
    for column, width in enumerate(_WIDTHS):
        sheet.set_column(column, column, width)
    set_widths(sheet)
    has_dimension = IFERROR(MATCH(moved.picked, moved.names, 0), 0.0) > 0
    sound = put(sheet, _TOP - 1, _VALUE, IF(AND(number > 0, has_dimension), 1.0, 0.0), book.format("quiet"))
    found, row = [], _TOP
    for steps, words in ((1.0, "One step above the middle"), (-1.0, "One step below the middle")):
        sheet.write_string(row, _NAME, words, book.format("section"))
        chain = _Chain(book, sheet, number, top=row, sound=sound)
        found.append(on_sheet(SLOPE, chain.write(inputs, moved, steps)))
        row += _BLOCK_ROWS + _APART
    sheet.print_area(0, 0, chain.row, _VALUE)
    return found[0], found[1]
