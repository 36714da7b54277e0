"""The table of the Summary: the worst variants with the percentile that decides, beside what other methods say."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flexlash.report.formula.functions import CONCATENATE, IF
from flexlash.report.formula.live import Live, put
from flexlash.report.layout.links import write_link
from flexlash.report.layout.styles import Book, decimals_of
from flexlash.report.layout.wrapping import lines_of, merged_width
from flexlash.report.wording.distances import deciding_percentile, distance, distance_format
from flexlash.report.wording.normal_theory import normal_words
from flexlash.report.wording.summary_facts import main_cause
from flexlash.report.wording.verdict import COLOURS, verdict_word
from flexlash.schema.angle_unit import ANGLE_UNITS
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.number_words import brief_share, glance

__all__ = ["WIDTHS", "SummaryTable"]

WIDTHS = (22, 8.5, 8.5, 9, 8.5, 9, 9.5, 9, 9, 16, 14.5, 24.5)
"""Widths of the page's columns: together so wide that letters of 11 pt are more than 7 pt on A4."""

_ANGLES = {2: "Limit", 3: "Nominal", 4: "P97.5", 5: "{deciding}", 6: "{deciding} over limit"}
_ANGLES |= {7: "Mean + 3 sd", 8: "Worst case"}
_WORDS = {0: "Variant", 1: "Verdict", 9: "Units over the limit", 10: "By normal theory", 11: "Main contributor"}
_OVER, _FIRST_ORDER = 6, 7
_SIGMAS = 3.0


class SummaryTable:
    """The table of a sheet, whose angles are in the unit that a cell names, as it is written that of the book."""

    def __init__(self, book: Book, sheet: Any, bounds: VerdictBounds, unit: Live) -> None:
        self.book = book
        self.sheet = sheet
        self.bounds = bounds
        self.unit = unit
        self.key, self.name = deciding_percentile(bounds)
        self._factor = IF(unit.equals("arcsec"), ANGLE_UNITS["arcsec"].per_arcmin, 1.0)

    def write_headings(self, row: int) -> None:
        """Write the headings, angles with the chosen unit."""
        style = self.book.format("header")
        for column, words in _WORDS.items():
            self.sheet.write_string(row, column, words, style)
        for column, words in _ANGLES.items():
            named = words.format(deciding=self.name)
            put(self.sheet, row, column, CONCATENATE(f"{named} [", self.unit, "]"), style)

    def write(self, row: int, result: Mapping[str, Any], name: str, target: str) -> int:
        """Write a Results row, its name leading to its target; return how many lines it takes."""
        verdict = verdict_word(dict(result), self.bounds)
        write_link(self.sheet, row, 0, target, name, style=self.book.format("link"))
        self.sheet.write_string(row, 1, verdict, self.book.format(COLOURS[verdict]))
        for column, (value, number) in self._angles(dict(result)).items():
            put(self.sheet, row, column, self._factor * value, self.book.format("text", number))
        words = {11: main_cause(dict(result))}
        if result["backlash_limit_arcmin"] is not None:
            words |= {9: brief_share(result), 10: normal_words(dict(result))}
        for column, text in words.items():
            self.sheet.write_string(row, column, text, self.book.format("indented wrap"))
        return max(lines_of(text, merged_width([WIDTHS[column]]) - 1) for column, text in words.items())

    def finish(self, first: int, last: int) -> None:
        """Show angles in the other unit with digits of its own: arc seconds are sixty times as many."""
        for unit in ANGLE_UNITS.values():
            digits = unit.decimals(3)
            for column in _ANGLES if unit != self.book.angles else ():
                rule = {"type": "formula", "criteria": f'={self.unit.text}="{unit.name}"'}
                signed = f"+{digits};-{digits};{digits}" if column == _OVER else digits
                look = self.book.workbook.add_format({"num_format": signed})
                self.sheet.conditional_format(first, column, last, column, {**rule, "format": look})

    def _angles(self, row: dict[str, Any]) -> dict[int, tuple[float, str]]:
        """Return value [arcmin] and number format of the cells that hold an angle."""
        keys = {2: "backlash_limit", 3: "backlash", 4: "p97_5", 5: self.key, 8: "worst_case_high"}
        cells = {
            column: (row[f"{key}_arcmin"], self._glance(row[f"{key}_arcmin"], row.get(f"{key}_standard_error_arcmin")))
            for column, key in keys.items()
            if row[f"{key}_arcmin"] is not None
        }
        if row["first_order_sd_arcmin"] is not None:
            high = row["mean_arcmin"] + _SIGMAS * row["first_order_sd_arcmin"]
            cells[_FIRST_ORDER] = high, self._glance(high, None)
        if row["backlash_limit_arcmin"] is not None:
            cells[_OVER] = distance(row, self.key), distance_format(row, self.key, self.book.angles)
        return cells

    def _glance(self, value: float, error: float | None) -> str:
        """Return the number format of an angle in four digits, or fewer where its standard error is greater."""
        of = self.book.angles.of
        return decimals_of(max(of(error or 0.0), glance(of(value))), "plain")
