"""The printed page of one variant: verdict, sentences, its part, limits used, distribution, causes, changes."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import polars as pl

from flexlash.mechanics.sketch.part_sketch import part_sketch
from flexlash.mechanics.sketch.sketch_emf import emf
from flexlash.report.failing.failing_places import PAGE_ROWS
from flexlash.report.failing.page_charts import (
    density_chart,
    density_words,
    segments_chart,
    segments_words,
    tornado_chart,
    tornado_words,
)
from flexlash.report.failing.page_figures import page_figures
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.links import write_link
from flexlash.report.layout.styles import Book
from flexlash.report.layout.wrapping import lines_of
from flexlash.report.page.one_variant import used_limits
from flexlash.report.report_data import Drawn
from flexlash.report.wording.lever_sentences import CHANGE, what_to_change
from flexlash.report.wording.lever_words import Lever, change_words, followers_words, sentence_start
from flexlash.report.wording.sentences import cause_of
from flexlash.report.wording.summary_facts import SummaryFacts
from flexlash.report.wording.verdict import COLOURS, UNSETTLED, firm, verdict_word
from flexlash.report.wording.verdict_sentences import judged
from flexlash.schema.findings import shown

__all__ = ["COLUMN_WIDTHS", "PAGE_SCALE", "FailingPage"]

PAGE_SCALE = 75
"""Size of print in per cent, in which letters of 10 points come to 7.5."""

COLUMN_WIDTHS = (180, 76, 76, 76, 76, 76, 144, 58, 120)
"""Widths [px], together what is between the margins of A4 upright, where LibreOffice has them 5 % wider."""

_LEFT, _RIGHT = range(6), range(6, 9)
_LAST = len(COLUMN_WIDTHS) - 1
_PAGE = 935.0
"""Height [pt] between the margins of Letter, the lower of both papers."""

_LINE = 13.5
_GAP = 6.0
_DIGIT = 6.6
"""Pixels of a digit in letters of 10 points."""

_SKETCH_ROWS, _SEGMENT_ROWS, _LEVERS = 16, 6, 5
_CHART_ROWS = (11, 22)
"""Least and greatest number of rows that density and tornado take."""

_NAME = 60
_LIMIT_HEADINGS = ("Limits used", "nominal", "lower", "upper", "sd", "differ by", "distribution")
_LEVER_HEADINGS = (
    (0, 2, "Cheapest changes, each alone"),
    (3, 3, "over limit then [ppm]"),
    (4, 4, "mass [%]"),
    (5, 5, "stiffness [%]"),
    (6, 6, "von Mises, torsion only [MPa]"),
    (7, 7, "bending [%]"),
    (8, 8, "relative cost"),
)


class FailingPage:
    """The page of the failing variant at a place: the next row, and how high what stands above it is [pt]."""

    def __init__(
        self, book: Book, sheet: Any, facts: SummaryFacts, *, variant: Drawn, pages: Stored, place: int
    ) -> None:
        self.book, self.sheet, self.facts = book, sheet, facts
        self.variant, self.pages, self.place = variant, pages, place
        self.row = place * PAGE_ROWS
        self.height = 0.0

    def write(self, label: str, count: int) -> None:
        """Write the page of the variant of this short name, one of so many, and hide the rows that it leaves."""
        self._heading(label, count)
        for topic, text in self._sentences():
            self._sentence(topic, text)
        self._gap()
        self._part()
        self._gap()
        levers = self._cheapest()
        heights = [_LINE * lines_of(_words(lever), _digits(range(3))) for lever in levers]
        below = _GAP * 3 + _LINE * (_SEGMENT_ROWS + 3 + bool(levers)) + sum(heights)
        self._limits(int((_PAGE - self.height - below) / _LINE) - _CHART_ROWS[0] - 1)
        self._gap()
        least, most = _CHART_ROWS
        self._charts(max(least, min(most, int((_PAGE - self.height - below) / _LINE))))
        self._changes(levers)
        for row in range(self.row, (self.place + 1) * PAGE_ROWS):
            self.sheet.set_row(row, None, None, {"hidden": True})

    def _end_row(self, height: float = _LINE) -> None:
        self.sheet.set_row(self.row, height)
        self.height += height
        self.row += 1

    def _gap(self) -> None:
        self._end_row(_GAP)

    def _across(self, first: int, last: int, text: str, style: Any) -> None:
        """Write a text across columns; a text is never taken for a formula."""
        if last > first:
            self.sheet.merge_range(self.row, first, self.row, last, "", style)
        self.sheet.write_string(self.row, first, text, style)

    def _heading(self, label: str, count: int) -> None:
        """Write name and verdict, and below them what is compared."""
        row, bounds = self.variant.row, self.facts.bounds
        verdict = verdict_word(row, bounds)
        doubt = ", not settled" if verdict.endswith(UNSETTLED) else ""
        self.sheet.write_string(self.row, 0, label, self.book.format("title"))
        self._across(_RIGHT[0], _LAST, f"{firm(verdict)}{doubt}", self.book.format(f"big {COLOURS[verdict]}"))
        self._end_row(28)
        one = self.variant.computed.variant
        facts = (
            f"{self.place + 1} of {count}",
            shown(self.facts.outcome.submission.name, longest=_NAME),
            shown(one.material, longest=_NAME // 2),
            f"torque {one.dimensions['torque']:g} N·m",
            f"limit {self.facts.angles.entered(row['backlash_limit_arcmin'])}",
            "compared at full torque (2U)",
        )
        self.sheet.write_string(self.row, 0, " · ".join(facts), self.book.format("page quiet"))
        write_link(self.sheet, self.row, _LAST, "Summary!A1", "to the Summary", style=self.book.format("page link"))
        self._end_row(16)

    def _sentences(self) -> Iterator[tuple[str, str]]:
        """Yield how much over, why, and the cheapest change, as the Summary says them of the worst."""
        facts, row = self.facts, self.variant.row
        own = replace(facts, levers=facts.levers.filter(pl.col("variant") == row["variant"]))
        yield "By how much", " ".join(judged(facts, row))
        yield "Why", " ".join(cause_of(facts, row))
        yield CHANGE, " ".join(what_to_change(own))

    def _sentence(self, topic: str, text: str) -> None:
        if text:
            self.sheet.write_string(self.row, 0, topic, self.book.format("page topic"))
            self._across(1, _LAST, text, self.book.format("page said"))
            self._end_row(_LINE * lines_of(text, _digits(range(1, _LAST + 1))) + 1)

    def _part(self) -> None:
        """Draw the part with its dimensions, and write the figures beside it."""
        one = self.variant.computed.variant
        drawing = part_sketch(one.flexspline_type, one.dimensions, name=shown(one.name, longest=_NAME))
        room = sum(COLUMN_WIDTHS[column] for column in _LEFT), _SKETCH_ROWS * _LINE / 0.75
        scale = min(room[0] / drawing.width, room[1] / drawing.height)
        self.sheet.insert_image(self.row, 0, f"part-{self.place + 1}.emf", {
            "image_data": io.BytesIO(emf(drawing)),
            "x_scale": scale,
            "y_scale": scale,
            "object_position": 2,
            "description": f"{drawing.title}. {drawing.description}",
        })  # fmt: skip
        figures = list(page_figures(self.variant, self.facts.bounds, self.facts.angles))[:_SKETCH_ROWS]
        for name, value in [*figures, *[("", "")] * (_SKETCH_ROWS - len(figures))]:
            if name:
                self.sheet.write_string(self.row, _RIGHT[0], name, self.book.format("page label"))
                self._across(_RIGHT[1], _LAST, value, self.book.format("page figure"))
            self._end_row()

    def _limits(self, most: int) -> None:
        """Write the limits of the dimensions, no more than so many: what scatters first."""
        for column, heading in enumerate(_LIMIT_HEADINGS):
            last = _LAST if column == len(_LIMIT_HEADINGS) - 1 else column
            self._across(column, last, heading, self.book.format("page header"))
        self._end_row(_LINE + 1)
        rows = list(used_limits(self.variant))
        listed = rows if len(rows) <= most else [row for row in rows if row[1]["lower"]][: most - 1]
        text, figure = self.book.format("page text"), self.book.format("page figure")
        for name, limits in listed:
            unit = f" [{limits['unit']}]" if limits["unit"] else ""
            self.sheet.write_string(self.row, 0, f"{limits['name']}{unit}", text)
            for column, key in enumerate(("nominal", "lower", "upper", "sd"), start=1):
                self.sheet.write_string(self.row, column, str(limits[key]), figure)  # type: ignore[literal-required]
            if limits["lower"]:
                self.sheet.write_string(self.row, 5, self.variant.computed.limits[name].scatters_between, figure)
            words = limits["distribution"].removesuffix(", one value for a lot")
            self._across(_RIGHT[0], _LAST, f"  {words}", text)
            self._end_row()
        if left := len(rows) - len(listed):
            note = f"{left} more are on the sheet Tolerances used."
            self.sheet.write_string(self.row, 0, note, self.book.format("page quiet"))
            self._end_row()

    def _charts(self, rows: int) -> None:
        """Draw density and tornado side by side, so many rows high, and the segments below."""
        whole = sum(COLUMN_WIDTHS)
        half, height = whole // 2 - 4, round(rows * _LINE / 0.75) - 2
        density = density_chart(self.book, self.variant, self.pages, self.place, half)
        tornado = tornado_chart(self.book, self.variant, self.pages, self.place)
        size = half, height
        self.book.insert(
            self.sheet, self.row, 0, density, size=size, text=density_words(self.variant, self.facts.angles)
        )
        self.book.insert(
            self.sheet,
            self.row,
            0,
            tornado,
            size=size,
            text=tornado_words(self.variant, self.facts.angles),
            right=whole - half,
        )
        for _ in range(rows):
            self._end_row()
        self._gap()
        size = whole, round(_SEGMENT_ROWS * _LINE / 0.75) - 2
        segments = segments_chart(self.book, self.variant, self.pages, self.place)
        self.book.insert(self.sheet, self.row, 0, segments, size=size, text=segments_words(self.variant))
        for _ in range(_SEGMENT_ROWS):
            self._end_row()
        self._gap()

    def _cheapest(self) -> Sequence[Lever]:
        """Return the cheapest changes that bring the variant within its limit."""
        own = self.facts.levers.filter(
            (pl.col("variant") == self.variant.row["variant"])
            & (pl.col("direction") == "meet")
            & pl.col("rank").is_not_null()
        )
        return own.head(_LEVERS).to_dicts()

    def _changes(self, levers: Sequence[Lever]) -> None:
        """Write the cheapest changes, and a line on what stands above."""
        if levers:
            for first, last, heading in _LEVER_HEADINGS:
                self._across(first, last, heading, self.book.format("page header"))
            self._end_row(2 * _LINE + 1)
        for lever in levers:
            self._change(lever)
        note = "Limits as used, k sigma as entered; lots: one value for all parts of a lot. Stress is of torsion only."
        self.sheet.write_string(self.row, 0, note, self.book.format("page quiet"))
        self._end_row()

    def _change(self, lever: Lever) -> None:
        """Write one change with its side effects."""
        words = _words(lever)
        self._across(0, 2, words, self.book.format("page said"))
        for column, key, code in (
            (3, "ppm_after", "#,##0"),
            (4, "mass_change_percent", "+0.0;-0.0;0.0"),
            (5, "stiffness_change_percent", "+0.0;-0.0;0.0"),
            (7, "bending_stress_change_percent", "+0.0;-0.0;0.0"),
            (8, "relative_cost", "0.0"),
        ):
            if lever[key] is not None:
                self.sheet.write_number(self.row, column, lever[key], self.book.format("page text", code))
        now, then = self.variant.row["von_mises_MPa"], lever["von_mises_MPa_after"]
        if now is not None and then is not None:
            self.sheet.write_string(self.row, 6, f"{now:.0f} → {then:.0f}", self.book.format("page figure"))
        self._end_row(_LINE * lines_of(words, _digits(range(3))))


def _words(lever: Lever) -> str:
    """Return what changes."""
    return sentence_start(f"{change_words(lever)}{followers_words(lever)}")


def _digits(columns: Sequence[int]) -> float:
    """Return how many digits fit beside each other into columns."""
    return (sum(COLUMN_WIDTHS[column] for column in columns) - 8) / _DIGIT
