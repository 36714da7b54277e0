"""The Trace spread sheet: the tolerances of the variant picked on Trace, added up to the first-order sd by formulas.

Limits give a standard deviation, times the slope of the backlash that is a contribution, and the squares of these add
up. Slopes are the program's: to work out all of them would take two backlashes for each dimension. Any one that the
reader picks is audited instead, by the formulas of Trace (`trace_slope`).
"""

from __future__ import annotations

from collections import Counter
from typing import Any

from xlsxwriter.utility import xl_range_abs

from flexlash.report.formula.functions import (
    ABS,
    AND,
    COUNTA,
    IF,
    IFERROR,
    INDEX,
    ISNUMBER,
    MATCH,
    MAX,
    MIN,
    SQRT,
    SUM,
    on_sheet,
)
from flexlash.report.formula.live import Live, Operand, Range, fill, live, put
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import Book
from flexlash.report.trace.inputs import SPREAD
from flexlash.report.trace.scatter import NUMBER, TIED
from flexlash.report.trace.spread_table import BLANK_ZERO, DIFFERENCE, HEADER, PRINTED, SMALL_FIGURE, SpreadTable
from flexlash.report.trace.trace_page import SHEET
from flexlash.report.trace.trace_slope import TRACE_SPREAD, Moved, write_slope
from flexlash.tolerance.sensitivity import SD_STEP, SIZE_STEP

__all__ = ["AGREEMENT", "AGREES", "CHANGED", "DIFFERS", "TRACE_SPREAD", "trace_spread_sheet", "write_trace_spread"]

AGREEMENT = 1e-9
"""Relative difference up to which a number agrees with the program's."""

AGREES, CHANGED, DIFFERS = "agrees to 1e-9", "your tolerances count", "differs"
_NOTES = (
    "Follows the variant that is picked on Trace. Limits give a standard deviation s; slope times s is what a "
    "dimension adds; the squares add up. Slopes c are taken in the middle of all limits.",
    "Type half a width of limits into a yellow cell: s follows, and all that comes of it; an s of the process stays. "
    "Changes on Trace do not count here.",
)
_LABEL, _FIRST = 0, 8
_FIGURE = "0.000000"
_FINE = "0.000000000"
_PICK = 3


def trace_spread_sheet(book: Book) -> Any:
    """Return the sheet in its place among the others."""
    return book.sheet(TRACE_SPREAD, tab="entry")


def write_trace_spread(  # noqa: PLR0917
    book: Book, sheet: Any, inputs: Stored, scattering: tuple[Stored, Stored], picked: Live | None, audited: str = ""
) -> dict[str, Live]:
    """Write Trace spread for the variant picked on Trace by its number; return its results by key.

    The slope that is `audited` at first is that of the dimension that adds most, unless it is named.
    """
    scatter, tied = scattering
    title = "Trace spread: from tolerances to the standard deviation of the backlash"
    sheet.write_string(0, 0, title, book.format("title"))
    sheet.set_row(0, 28)
    if not scatter.rows or picked is None:
        sheet.write_string(1, 0, "Nothing scatters.", book.format("quiet"))
        return {}
    number = on_sheet(SHEET, picked)
    for row, note in enumerate(_NOTES, start=1):
        sheet.write_string(row, 0, note, book.format("quiet"))
    sheet.write_string(_PICK, 0, "Variant", book.format("label"))
    name = IF(number > 0, inputs.pick(MAX(number, 1.0), "Variant"), "pick one on Trace")
    put(sheet, _PICK, 1, name, book.format("label"))
    table = SpreadTable(book, sheet, scatter, number, _most(scatter))
    sums = _Sums(book, sheet, table)
    ties = sums.write_ties(tied, number) if tied.rows else (live(0.0), live(0.0))
    found = sums.write_sums(inputs, number, ties)
    found |= sums.write_slope_check(inputs, number, found["first_order_sd"], audited)
    sheet.freeze_panes(HEADER + 1, 1)
    sheet.repeat_rows(HEADER)
    sheet.print_area(0, 0, sums.row, PRINTED)
    return found


def _most(stored: Stored) -> int:
    """Return the most rows that a variant has."""
    return max(Counter(row[NUMBER] for row in stored.rows).values())


class _Sums:
    """What follows below the table."""

    def __init__(self, book: Book, sheet: Any, table: SpreadTable) -> None:
        self.book, self.sheet, self.table = book, sheet, table
        self.row = table.last

    def _begin(self, title: str, *headings: str) -> None:
        """Begin a table after a blank row."""
        self.row += 2
        self.sheet.write_string(self.row, _LABEL, title, self.book.format("label"))
        for place, heading in enumerate(headings, start=_FIRST):
            self.sheet.write_string(self.row, place, heading, self.book.format("header"))
        if headings:
            self.sheet.set_row(self.row, 48)

    def _put(self, place: int, value: Operand, number: str) -> Live:
        style = self.book.format("figure", number)
        return put(self.sheet, self.row, _FIRST + place, live(value), style)

    def _line(self, label: str, value: Operand, number: str = _FIGURE) -> Live:
        """Write a line with one figure."""
        self.row += 1
        if label:
            self.sheet.write_string(self.row, _LABEL, label, self.book.format("text"))
        return self._put(0, value, number)

    def _of(self, key: str, name: Operand, otherwise: Operand) -> Live:
        """Return what a dimension has in a column of the table."""
        place = IFERROR(MATCH(name, self.table.column("dimension"), 0), 0.0)
        return IF(place > 0, INDEX(self.table.column(key), MAX(place, 1.0)), otherwise)

    def write_ties(self, tied: Stored, number: Live) -> tuple[Live, Live]:
        """Write the pairs that scatter together; return what they add to the sum of squares, and to that of lots."""
        heads = ("First (1)", "Second (2)", "Correlation r of the values", "2 r (c·s)₁ (c·s)₂ [arcmin²]", "of lots")
        self._begin("Dimensions that scatter together", *heads)
        numbers, top, of_all, of_lots = tied.cells(NUMBER), self.row + 1, [], []
        first = IFERROR(MATCH(number, numbers, 0), 0.0)
        last = IF(first > 0, MATCH(number, numbers, 1), 0.0)
        remark = IF(first > 0, "", "none of this variant")
        put(self.sheet, self.row, _FIRST - 1, remark, self.book.format("hint"))
        for line in range(_most(tied)):
            place = first + line
            here = AND(first > 0, place <= last)
            at = MIN(MAX(place, 1.0), float(len(tied.rows)))
            one = self._line("", IF(here, tied.pick(at, "First"), ""), "general")
            other = self._put(1, IF(here, tied.pick(at, "Second"), ""), "general")
            correlation = self._put(2, IF(here, tied.pick(at, TIED), 0.0), BLANK_ZERO)
            both = self._of("part", one, 0.0) * self._of("part", other, 0.0)
            cross = self._put(3, 2 * correlation * both, SMALL_FIGURE)
            in_lots = AND(*(self._of("between", name, "").equals("lots") for name in (one, other)))
            of_all.append(cross.value)
            of_lots.append(self._put(4, IF(in_lots, cross, 0.0), SMALL_FIGURE).value)
        ranges = (
            Range(xl_range_abs(top, _FIRST + place, self.row, _FIRST + place), values)
            for place, values in ((3, of_all), (4, of_lots))
        )
        every, lots = map(SUM, ranges)
        return every, lots

    def write_sums(self, inputs: Stored, number: Live, ties: tuple[Live, Live]) -> dict[str, Live]:
        """Write the first-order sd of all units, of parts and of lots, each beside what the program has."""
        heads = (
            "First order: √Σ [arcmin]",
            "Program, first order",
            "Difference",
            "By the engine [arcmin]",
            "Engine beside first order",
        )
        self._begin("Standard deviation of the backlash", *heads)
        every = SUM(self.table.column("squared")) + ties[0]
        lots = SUM(self.table.column("lots")) + ties[1]
        found, program = {}, IF(number > 0, inputs.pick(MAX(number, 1.0), SPREAD["first_order_sd"]), "")
        for key, label, squares, heading in (
            ("first_order_sd", "All units", every, "sd"),
            ("within_lot_sd", "Parts within one lot", every - lots, "within_lot_sd"),
            ("between_lots_sd", "Lots, each by the mean of its parts", lots, "between_lots_sd"),
        ):
            found[key] = self._line(label, SQRT(MAX(squares, 0.0)))
            if key == "first_order_sd":
                beside = self._put(1, program, _FIGURE)
                off = IF(ISNUMBER(beside), IF(beside > 0, found[key] / beside - 1, found[key]), "")
                found["difference"] = self._put(2, off, DIFFERENCE)
            engine = IF(number > 0, inputs.pick(MAX(number, 1.0), SPREAD[heading]), "")
            engine = self._put(3, engine, _FIGURE)
            ratio = IF(AND(ISNUMBER(engine), found[key] > 0), engine / found[key] - 1, "")
            self._put(4, ratio, "+0.00%;-0.00%;0.00%")
        offs = self.table.column("off")
        off = MAX(MAX(offs), 0.0 - MIN(offs), IF(ISNUMBER(found["difference"]), ABS(found["difference"]), 0.0))
        own = COUNTA(self.table.column("own"))
        verdict = IF(own > 0, CHANGED, IF(off <= AGREEMENT, AGREES, DIFFERS))
        found["verdict"] = self._line(
            "Verdict: every s and the first-order sd beside the program's", verdict, "general"
        )
        return found

    def write_slope_check(self, inputs: Stored, number: Live, first_order: Live, audited: str) -> dict[str, Live]:
        """Write one slope as the formulas of Trace give it; the dimension is the reader's choice."""
        self._begin("One slope from the formulas of Trace")
        names = self.table.column("dimension")
        squares = list(self.table.column("squared").values)
        self.row += 1
        self.sheet.write_string(self.row, _LABEL, "Dimension", self.book.format("text"))
        greatest = names.values[squares.index(max(squares, key=float))]
        picked = fill(self.sheet, self.row, _FIRST - 1, audited or str(greatest), self.book.format("input"))
        self.sheet.data_validation(self.row, _FIRST - 1, self.row, _FIRST - 1, {
            "validate": "list", "source": f"={names.text}", "error_title": "Dimension",
            "error_message": "Pick a dimension of the variant.",
        })  # fmt: skip
        remark = IF(
            IFERROR(MATCH(picked, names, 0), 0.0) > 0, "◄ any of them", "◄ this variant does not have it: pick one"
        )
        put(self.sheet, self.row, _FIRST, remark, self.book.format("hint"))
        middle, sd = self._of("middle", picked, 0.0), self._of("program sd", picked, 0.0)
        step = MAX(SD_STEP * sd, SIZE_STEP * ABS(middle))
        step = self._line("Step h: a thousandth of s, at least a millionth of the middle", step, "general")
        above, below = write_slope(self.book, inputs, number, self._moved(picked, step))
        above = self._line("Backlash h above the middle [arcmin], see Trace slope", above, _FINE)
        below = self._line("Backlash h below the middle [arcmin]", below, _FINE)
        there = AND(ISNUMBER(above), step > 0)
        slope = IF(there, (above - below) / (2 * IF(step > 0, step, 1.0)), "")
        slope = self._line("Slope c: their difference over 2h [arcmin per unit]", slope, _FINE)
        program = self._line("The program's slope", self._of("slope", picked, ""), _FINE)
        known = AND(ISNUMBER(slope), ISNUMBER(program), first_order > 0)
        off = IF(known, ABS(slope - program) * sd / first_order, "")
        off = self._line("Difference times s, as a share of the first-order sd", off, DIFFERENCE)
        verdict = IF(ISNUMBER(off), IF(off <= AGREEMENT, AGREES, DIFFERS), "")
        verdict = self._line("Verdict", verdict, "general")
        return {"picked": picked, "slope": slope, "slope difference": off, "slope verdict": verdict}

    def _moved(self, picked: Live, step: Live) -> Moved:
        """Return what is moved as another sheet refers to it."""
        names, middles = (self.table.column(key) for key in ("dimension", "middle"))
        return Moved(
            picked=on_sheet(TRACE_SPREAD, picked),
            step=on_sheet(TRACE_SPREAD, step),
            names=_range_there(names),
            middles=_range_there(middles),
        )


def _range_there(cells: Range) -> Range:
    """Return a range of this sheet as another sheet refers to it."""
    return Range(on_sheet(TRACE_SPREAD, Live(cells.text, 0.0)).text, cells.values)
