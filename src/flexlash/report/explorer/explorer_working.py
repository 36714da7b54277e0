"""Behind the Explorer: the picked variant's percentiles, and how a share or a limit is read off between them.

Four neighbouring percentiles make a cubic of the normal score over the backlash, or of the backlash over the score.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from flexlash.report.explorer.curves_sheet import error_heading, score_heading
from flexlash.report.explorer.explorer_choice import Choice
from flexlash.report.formula.functions import IF, IFERROR, INDEX, MATCH, MAX, MEDIAN, MIN, NORM_S_DIST
from flexlash.report.formula.live import Live, Range, fill, put
from flexlash.report.layout.styles import Book
from flexlash.tolerance.distribution_curves import CURVE_SCORES

__all__ = ["COLUMN", "CURVE_ROW", "Read", "Working"]

COLUMN = 8
"""First column of the working, beyond the printed page."""

CURVE_ROW = 3
"""Row, from 0, of the least percentile."""

_LAST = len(CURVE_SCORES)
_BLOCK = COLUMN + 5


@dataclass(frozen=True, kw_only=True)
class Read:
    """A share read off: the score of the limit, the standard error of that, and the share over it."""

    score: Live
    error: Live
    share: Live


class Working:
    """The picked variant's curve in four columns, and blocks of cells that read from it."""

    def __init__(self, book: Book, sheet: Any, choice: Choice) -> None:
        self._sheet = sheet
        self._quiet = book.format("quiet")
        self._plain = book.format("text", "general")
        self._next_row = CURVE_ROW
        sheet.write_string(1, COLUMN, "Working behind figures and charts: nothing to change here.", self._quiet)
        for offset, text in enumerate(("score z", "share below", "backlash", "error of z")):
            sheet.write_string(CURVE_ROW - 1, COLUMN + offset, text, self._quiet)
        sheet.set_column(COLUMN, COLUMN + 20, 12)
        self.backlash: list[Live] = []
        self.errors: list[Live] = []
        for row, score in enumerate(CURVE_SCORES, start=CURVE_ROW):
            at = fill(sheet, row, COLUMN, score, self._plain)
            put(sheet, row, COLUMN + 1, IF(choice.known, NORM_S_DIST(at), 0.0), self._plain)
            self.backlash.append(put(sheet, row, COLUMN + 2, choice.angle(score_heading(score)), self._plain))
            self.errors.append(put(sheet, row, COLUMN + 3, choice.text(error_heading(score)), self._plain))
        self.is_level = self.cell("nothing scatters", self.backlash[-1] <= self.backlash[0])

    def cell(self, label: str, what: Live) -> Live:
        """Write a step of the working with its label and return the reference to it."""
        self._sheet.write_string(self._next_row, _BLOCK, label, self._quiet)
        self._next_row += 1
        return put(self._sheet, self._next_row - 1, _BLOCK + 1, what, self._plain)

    def read_share(self, limit: Live) -> Read:
        """Return what the curve says of the units over a limit."""
        asked = self.cell("limit asked", limit)
        below = self.cell("percentiles up to it", IFERROR(MATCH(asked, self._column(2), 1), 0.0))
        start = self.cell("first of the four", MIN(MAX(below, 2.0), float(_LAST - 2)) - 1)
        nodes = self._four(start, 2)
        inside = self.cell("limit within the curve", MEDIAN(self.backlash[0], asked, self.backlash[-1]))
        cubic = self._cubic(inside, nodes, self._four(start, 0))
        left = self.cell("percentile before it", MIN(MAX(below, 1.0), float(_LAST - 1)))
        before, after = (INDEX(self._column(0), number) for number in (left, left + 1))
        held = MEDIAN(before, cubic, after)
        first, last = self.backlash[0], self.backlash[-1]
        beyond = IF(asked <= first, CURVE_SCORES[0], IF(asked >= last, CURVE_SCORES[-1], held))
        score = self.cell("score of the limit", IF(self.is_level, 0.0, beyond))
        error = self.cell("its standard error", self._error_at(score, left))
        over = IF(self.is_level, IF(asked < first, 1.0, 0.0), NORM_S_DIST(-score))
        return Read(score=score, error=error, share=self.cell("share over it", over))

    def read_output(self, wanted: Live) -> tuple[Live, Live]:
        """Return the backlash at a score, and its standard error."""
        score = self.cell("score asked", MEDIAN(CURVE_SCORES[0], wanted, CURVE_SCORES[-1]))
        below = IFERROR(MATCH(score, self._column(0), 1), 0.0)
        left = self.cell("percentile before it", MIN(MAX(below, 1.0), float(_LAST - 1)))
        start = self.cell("first of the four", MIN(MAX(left, 2.0), float(_LAST - 2)) - 1)
        backlash = self._cubic(score, self._four(start, 0), self._four(start, 2))
        rise = self._difference(2, left) / self._difference(0, left)
        return self.cell("backlash there", backlash), self.cell(
            "its standard error", self._error_at(score, left) * rise
        )

    def _column(self, offset: int) -> Range:
        """Return a column of the curve: 0 scores, 2 backlash, 3 standard errors of the scores."""
        letter = xl_col_to_name(COLUMN + offset)
        cells = {2: self.backlash, 3: self.errors}.get(offset)
        values = CURVE_SCORES if cells is None else [cell.number for cell in cells]
        return Range(f"${letter}${CURVE_ROW + 1}:${letter}${CURVE_ROW + _LAST}", values)

    def _four(self, start: Live, offset: int) -> list[Live]:
        """Write four neighbours of a column, side by side, and return the references."""
        label = "backlash of the four" if offset else "scores of the four"
        self._sheet.write_string(self._next_row, _BLOCK, label, self._quiet)
        self._next_row += 1
        return [
            put(
                self._sheet,
                self._next_row - 1,
                _BLOCK + 1 + step,
                INDEX(self._column(offset), start + step if step else start),
                self._plain,
            )
            for step in range(4)
        ]

    def _cubic(self, at: Live, nodes: Sequence[Live], values: Sequence[Live]) -> Live:
        """Write the cubic through four points and return the reference to what it is at a place."""
        total: Live | None = None
        for node, value in zip(nodes, values, strict=True):
            weight = value
            for other in nodes:
                if other is not node:
                    weight = weight * ((at - other) / (node - other))
            total = weight if total is None else total + weight
        if total is None:
            raise ValueError("a cubic needs points")
        return self.cell("cubic through them", IF(self.is_level, values[0], total))

    def _error_at(self, score: Live, left: Live) -> Live:
        """Return the standard error of a score, in a straight line between percentiles."""
        part = (score - INDEX(self._column(0), left)) / self._difference(0, left)
        return INDEX(self._column(3), left) + part * self._difference(3, left)

    def _difference(self, offset: int, left: Live) -> Live:
        """Return by how much a column rises from one row to the next."""
        column = self._column(offset)
        return INDEX(column, left + 1) - INDEX(column, left)
