"""A variant's spider: a chart of how the backlash follows each dimension, and the numbers beside and below it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from flexlash.decisions.spider import SPIDER_CHANGES, SpiderLine, spider_of
from flexlash.decisions.trade_offs import TradeOff
from flexlash.report.layout.axes import axis_over
from flexlash.report.layout.styles import GRID, LINES, PALETTE, Book
from flexlash.report.report_data import Drawn
from flexlash.report.wording.chart_words import largest_of
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.units import ARCMIN

__all__ = ["SPIDER_ROWS", "SpiderBlock"]

_CHART_ROWS, _SIZE = 20, (940, 390)
_TOLERANCE = ("Lower limit", "Upper limit", "Backlash at its least", "Backlash at its greatest")
"""Rows above the points."""

SPIDER_ROWS = 1 + _CHART_ROWS + 1 + len(_TOLERANCE) + len(SPIDER_CHANGES)
"""Rows that a block takes."""

_DRAWN = 8
"""Most lines that can be told apart in the chart, the steepest ones."""

_FAR = 1.2
"""Times the greatest change of the backlash up to which a limit is drawn."""

_COLOURS = LINES
_LIMIT = "#000000"
_SMALL = {"name_font": {"size": 9, "bold": False}, "num_font": {"size": 9}}
_PERCENT, _SIGNED, _FINE = "+0%;-0%;0%", "+0.00%;-0.00%;0.00%", "+0.000%;-0.000%;0.000%"


@dataclass(frozen=True, kw_only=True)
class SpiderBlock:
    """The spider of a variant from the row `top` on; `label` is its name, `offer` what its target's percentile is."""

    book: Book
    sheet: Any
    top: int
    variant: Drawn
    offer: TradeOff
    label: str
    bounds: VerdictBounds

    @cached_property
    def lines(self) -> list[SpiderLine]:
        """The lines that are drawn and told."""
        return spider_of(self.variant.computed)[:_DRAWN]

    @property
    def limits(self) -> dict[str, float]:
        """Where limits lie, as parts of the nominal backlash, by what they are of."""
        limit, nominal = self.variant.row["backlash_limit_arcmin"], self.variant.row["backlash_arcmin"]
        if limit is None:
            return {}
        target = f"Limit for {self.bounds.target_words} of units, spread in proportion"
        return {"Limit of the nominal": limit / nominal - 1, target: limit / (self.offer.quantile / ARCMIN) - 1}

    @property
    def _parts(self) -> list[float]:
        """All changes of the backlash that are known."""
        return [part for line in self.lines for part in line.backlash if part is not None]

    @property
    def _near(self) -> dict[str, float]:
        """The limits that are not so far off that they would squeeze the lines."""
        far = _FAR * max(map(abs, self._parts))
        return {words: part for words, part in self.limits.items() if abs(part) <= far}

    def write(self, last_column: int) -> None:
        """Write title, chart and tables."""
        nominal, limit = self.variant.row["backlash_arcmin"], self.variant.row["backlash_limit_arcmin"]
        angles = self.book.angles
        told = f"nominal {angles.words(nominal)}" + ("" if limit is None else f", limit {angles.entered(limit)}")
        if len(self._near) < len(self.limits):
            told += ", too far off to be drawn"
        title = f"Each dimension of “{self.label}” alone: {told}"
        self.sheet.merge_range(self.top, 0, self.top, last_column, title, self.book.format("section"))
        self._write_points()
        self._write_tolerances()
        last = ((line_words(line), line.backlash[-1]) for line in self.lines)
        ends = {words: part for words, part in last if part is not None}
        text = f"Change of the backlash of {self.label} over the change of each dimension, with its limit: "
        text += f"at {100 * SPIDER_CHANGES[-1]:g} % more of it {largest_of(ends, per_cent=True)}"
        self.book.insert(self.sheet, self.top + 1, 0, self._chart(), size=_SIZE, text=text)

    @property
    def _points(self) -> tuple[int, int]:
        first = self.top + 1 + _CHART_ROWS + 1 + len(_TOLERANCE)
        return first, first + len(SPIDER_CHANGES) - 1

    def _write_points(self) -> None:
        """Write the points of the lines, one column a line, and the limits behind them."""
        first, _ = self._points
        names = ["Change of the dimension", *map(line_words, self.lines), *self.limits]
        top = first - 1 - len(_TOLERANCE)
        self.sheet.write_row(top, 0, names, self.book.format("header"))
        self.sheet.set_row(top, 62)
        for place, change in enumerate(SPIDER_CHANGES):
            self.sheet.write_number(first + place, 0, change, self.book.format("figure", _PERCENT))
            changes = [*(line.backlash[place] for line in self.lines), *self.limits.values()]
            for column, part in enumerate(changes, start=1):
                if part is not None:
                    self.sheet.write_number(first + place, column, part, self.book.format("text", _SIGNED))

    def _write_tolerances(self) -> None:
        """Write above the points between which limits each dimension lies, and what the backlash does there."""
        first = self._points[0] - len(_TOLERANCE)
        for row, words in enumerate(_TOLERANCE, start=first):
            self.sheet.write_string(row, 0, words, self.book.format("label"))
        for column, line in enumerate(self.lines, start=1):
            numbers = [*(line.tolerance or ()), *sorted(line.swing or ())]
            for row, part in enumerate(numbers, start=first):
                self.sheet.write_number(row, column, part, self.book.format("text", _FINE))

    def _chart(self) -> Any:
        """Return the chart."""
        chart = self.book.chart("scatter", f"Backlash of {self.label} by each dimension", subtype="straight")
        for place, line in enumerate(self.lines):
            dash = "solid" if place < len(_COLOURS) else "dash"
            look = {"color": PALETTE[_COLOURS[place % len(_COLOURS)]], "width": 2, "dash_type": dash}
            self._add(chart, line_words(line), place + 1, look)
        for number, words in enumerate(self.limits):
            if words not in self._near:
                continue
            style = "solid" if number == 0 else "round_dot"
            look = {"color": _LIMIT, "width": 1.25, "dash_type": style}
            self._add(chart, words, 1 + len(self.lines) + number, look)
        up = axis_over([*self._parts, *self._near.values()])
        low, high = SPIDER_CHANGES[0], SPIDER_CHANGES[-1]
        ends = {"min": low, "max": high, "major_unit": high / 5, "crossing": "min", "num_format": _PERCENT}
        chart.set_x_axis({**_SMALL, **ends, "name": "Change of the dimension", "major_gridlines": GRID})
        up_options = {**up.options(per_cent=True), "name": "Change of the backlash", "major_gridlines": GRID}
        chart.set_y_axis({**_SMALL, **up_options})
        chart.set_legend({"position": "right", "font": {"size": 9}})
        return chart

    def _add(self, chart: Any, words: str, column: int, line: dict[str, Any]) -> None:
        """Add the line of a column of the points to the chart."""
        first, last = self._points
        name = self.sheet.name
        chart.add_series({
            "name": words, "line": line, "marker": {"type": "none"},
            "categories": [name, first, 0, last, 0], "values": [name, first, column, last, column],
        })  # fmt: skip


def line_words(line: SpiderLine) -> str:
    """Return a dimension in words, with what follows it."""
    words = dimension_words(line.dimension)
    if line.moves:
        return " with ".join([words, *(dimension_words(name) for name in line.moves)])
    return f"{words} alone" if line.alone else words
