"""The table of Trace spread: one line for each dimension, from its limits to its part of the first-order variance."""

from __future__ import annotations

from typing import Any, NamedTuple

from xlsxwriter.utility import xl_range_abs, xl_rowcol_to_cell

from flexlash.report.formula.functions import (
    AND,
    CONCATENATE,
    EXP,
    FIXED,
    IF,
    IFERROR,
    ISNUMBER,
    MATCH,
    MAX,
    MIN,
    NORM_S_DIST,
    OR,
    PI,
    SQRT,
    SUM,
)
from flexlash.report.formula.live import Live, Operand, Range, fill, live, put
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import Book
from flexlash.report.trace.scatter import NUMBER

__all__ = ["BLANK_ZERO", "DIFFERENCE", "HEADER", "PRINTED", "SMALL_FIGURE", "SpreadTable"]

HEADER = 5
DIFFERENCE = "0.0E+00;-0.0E+00;0"
BLANK_ZERO = '0.000000;-0.000000;""'
SMALL_FIGURE = '0.000E+00;-0.000E+00;""'
_FAR = 40.0
"""Where a normal that is not cut at a side is cut, in standard deviations."""


class _Column(NamedTuple):
    heading: str
    width: float
    number: str = "general"


_COLUMNS = {
    "dimension": _Column("Dimension", 24),
    "unit": _Column("Unit", 7),
    "lower": _Column("Lower limit", 11),
    "upper": _Column("Upper limit", 11),
    "own": _Column("Your tolerance ±", 11),
    "middle": _Column("Middle", 11),
    "mean": _Column("Mean", 12),
    "words": _Column("Standard deviation from", 26),
    "sd": _Column("Standard deviation s", 13, BLANK_ZERO),
    "slope": _Column("Slope c of the backlash [arcmin per unit]", 15, "0.000000"),
    "part": _Column("Contribution c·s [arcmin]", 14, BLANK_ZERO),
    "squared": _Column("(c·s)² [arcmin²]", 14, SMALL_FIGURE),
    "share": _Column("Share of the sum", 9, '0.0%;-0.0%;""'),
    "between": _Column("Scatters between", 10),
    "off": _Column("s beside the program's", 11, DIFFERENCE),
    "gap": _Column("", 3),
    "position": _Column("Row of Scatter", 10),
    "distribution": _Column("Distribution", 16),
    "shift": _Column("Mean above middle", 11),
    "k": _Column("k", 8),
    "program sd": _Column("s of the program", 11),
    "given": _Column("s of the process", 11),
    "width": _Column("Width of limits", 11),
    "mean before": _Column("Mean before any cut", 12),
    "sd before": _Column("s before any cut", 12),
    "low": _Column("Cut below", 11),
    "high": _Column("Cut above", 11),
    "a": _Column("a: cut below in s", 11),
    "b": _Column("b: cut above in s", 11),
    "density a": _Column("φ(a)", 11),
    "density b": _Column("φ(b)", 11),
    "mass": _Column("Φ(b) − Φ(a)", 11),
    "moved": _Column("Mean moves by, in s", 11),
    "lots": _Column("(c·s)² of lots", 11, SMALL_FIGURE),
}
_PLACES = {key: place for place, key in enumerate(_COLUMNS)}
PRINTED = _PLACES["off"]
"""The last column that is printed; what stands to the right is worked out on the way."""


class SpreadTable:
    """The lines of the table, of which a variant takes as many as it has dimensions."""

    def __init__(self, book: Book, sheet: Any, scatter: Stored, number: Live, lines: int) -> None:
        self.book, self.sheet, self.scatter = book, sheet, scatter
        self._cells: dict[str, list[Live]] = {key: [] for key in _COLUMNS}
        self._row = HEADER
        self._not_there = book.workbook.add_format({"bg_color": "#FFFFFF", "border": 1, "border_color": "#FFFFFF"})
        for place, column in enumerate(_COLUMNS.values()):
            sheet.set_column(place, place, column.width)
            if column.heading:
                sheet.write_string(HEADER, place, column.heading, book.format("header"))
        sheet.set_row(HEADER, 64)
        numbers = scatter.cells(NUMBER)
        first = IFERROR(MATCH(number, numbers, 0), 0.0)
        last = IF(first > 0, MATCH(number, numbers, 1), 0.0)
        for line in range(lines):
            self._row += 1
            at = first + line
            self._write_line(IF(AND(first > 0, at <= last), at, 0.0))
        self.last = self._row
        total = SUM(self.column("squared"))
        for line, squared in enumerate(self._cells["squared"], start=HEADER + 1):
            share = IF(total > 0, squared / total, 0.0)
            put(sheet, line, _PLACES["share"], share, book.format("figure", _COLUMNS["share"].number))

    def column(self, key: str) -> Range:
        """Return a column of the table."""
        place = _PLACES[key]
        return Range(xl_range_abs(HEADER + 1, place, self._row, place), [cell.value for cell in self._cells[key]])

    def _put(self, key: str, value: Operand) -> Live:
        is_text = key in {"dimension", "unit", "words", "between", "distribution"}
        shape = "figure" if not is_text else "indented" if key in {"words", "between"} else "text"
        style = self.book.format(shape, _COLUMNS[key].number)
        cell = put(self.sheet, self._row, _PLACES[key], live(value), style)
        self._cells[key].append(cell)
        return cell

    def _write_line(self, position: Live) -> None:
        """Write a line: what is stored, then what follows from it."""
        position = self._put("position", position)
        here = position > 0

        def stored(key: str, heading: str) -> Live:
            return self._put(key, IF(here, self.scatter.pick(MAX(position, 1.0), heading), ""))

        stored("dimension", "Dimension")
        stored("unit", "Unit")
        lower, upper = stored("lower", "Lower limit"), stored("upper", "Upper limit")
        between, kind = stored("between", "Scatters between"), stored("distribution", "Distribution")
        shift, k, given = stored("shift", "Mean above middle"), stored("k", "k"), stored("given", "Process sd")
        slope = stored("slope", "Slope, program [arcmin per unit]")
        own = self._own_cell()
        middle = self._put("middle", IF(here, (lower + upper) / 2, ""))
        has_own = IF(ISNUMBER(own), own > 0, live(0.0) > 1)
        width = self._put("width", IF(here, IF(has_own, 2 * own, upper - lower), 0.0))
        mean = self._put("mean before", IF(here, middle + IF(ISNUMBER(shift), shift, 0.0), ""))
        of_triangle = IF(kind.equals("triangular"), width / SQRT(24.0), 0.0)
        of_limits = IF(kind.equals("uniform"), width / SQRT(12.0), of_triangle)
        of_process = IF(ISNUMBER(given), given, IF(ISNUMBER(k), width / (2 * k), of_limits))
        sd = self._put("sd before", IF(here, of_process, 0.0))
        mean, sd, is_cut = self._after_cut(position, kind, (middle, width), (mean, sd))
        self._write_words(position, kind, k, is_cut)
        part = self._put("part", IF(ISNUMBER(slope), slope * sd, 0.0))
        squared = self._put("squared", part * part)
        self._put("lots", IF(between.equals("lots"), squared, 0.0))
        program = stored("program sd", "Standard deviation, program")
        self._put("off", IF(here, IF(program > 0, sd / program - 1, 0.0), ""))

    def _own_cell(self) -> Live:
        """Write the yellow cell of a line, which takes half a width of limits."""
        place = _PLACES["own"]
        cell = fill(self.sheet, self._row, place, "", self.book.format("input", "general"))
        self.sheet.data_validation(self._row, place, self._row, place, {
            "validate": "decimal", "criteria": ">", "value": 0, "error_title": "Your tolerance ±",
            "error_message": "A number greater than 0 is required here: half the width of the limits.",
        })  # fmt: skip
        there = xl_rowcol_to_cell(self._row, _PLACES["position"], col_abs=True)
        rule = {"type": "formula", "criteria": f"={there}=0", "format": self._not_there}
        self.sheet.conditional_format(self._row, place, self._row, place, rule)
        self._cells["own"].append(cell)
        return cell

    def _after_cut(
        self, position: Live, kind: Live, limits: tuple[Live, Live], process: tuple[Live, Live]
    ) -> tuple[Live, Live, Live]:
        """Write mean and standard deviation after any cut of a normal; return them, and whether there is one."""
        (middle, width), (mean, sd), here = limits, process, position > 0
        at_limits, place = kind.equals("truncated normal"), MAX(position, 1.0)
        stored = [self.scatter.pick(place, f"Cut {side}") for side in ("below", "above")]
        low = self._put("low", IF(here, IF(at_limits, middle - width / 2, stored[0]), ""))
        high = self._put("high", IF(here, IF(at_limits, middle + width / 2, stored[1]), ""))
        is_cut = OR(ISNUMBER(low), ISNUMBER(high))
        a = self._put("a", IF(ISNUMBER(low), MAX((low - mean) / sd, -_FAR), -_FAR))
        b = self._put("b", IF(ISNUMBER(high), MIN((high - mean) / sd, _FAR), _FAR))
        densities = [EXP(-(end * end) / 2) / SQRT(2 * PI) for end in (a, b)]
        first, last = self._put("density a", densities[0]), self._put("density b", densities[1])
        # The difference of the shares beyond keeps its digits where both cuts are above the mean.
        above, below = NORM_S_DIST(-a) - NORM_S_DIST(-b), NORM_S_DIST(b) - NORM_S_DIST(a)
        mass = self._put("mass", IF(a > 0, above, below))
        moved = self._put("moved", (first - last) / mass)
        variance = 1 + (a * first - b * last) / mass - moved * moved
        cut_mean, cut_sd = mean + sd * moved, sd * SQRT(MAX(variance, 0.0))
        mean = self._put("mean", IF(here, IF(is_cut, cut_mean, mean), ""))
        return mean, self._put("sd", IF(here, IF(is_cut, cut_sd, sd), 0.0)), is_cut

    def _write_words(self, position: Live, kind: Live, k: Live, is_cut: Live) -> None:
        """Write what the standard deviation follows from."""
        given = self.scatter.pick(MAX(position, 1.0), "Process sd in words")
        of_triangle = IF(kind.equals("triangular"), "width/√24", "exact, shifted")
        of_limits = IF(kind.equals("uniform"), "width/√12", of_triangle)
        of_width = IF(ISNUMBER(k), CONCATENATE("width/(2k), k = ", FIXED(IF(ISNUMBER(k), k, 0.0), 2)), of_limits)
        words = IF(given.equals(""), of_width, given)
        self._put("words", IF(position > 0, IF(is_cut, CONCATENATE(words, ", cut"), words), ""))
