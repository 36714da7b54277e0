"""The table of trade-offs, one row a variant, and beside the printed page what its charts draw."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

from flexlash.decisions.trade_offs import TradeOff
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import Drawn
from flexlash.report.wording.verdict import COLOURS, NO_VERDICT, firm, verdict_word
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.units import ARCMIN

__all__ = ["WIDTHS", "Figure", "FrontTable"]

Figure = Literal["mass", "cost"]
"""What the backlash is set against."""

WIDTHS = (27, 10, 10, 10, 10, 10, 10, 11, 10, 11, 10)
"""Widths of the printed columns."""

_WITH_COST, _WITHOUT_COST = 9, 7
"""The last column of the table, from 0."""

_FIRST_HELPER = len(WIDTHS) + 1
_LINE = _FIRST_HELPER + 5
"""First columns, from 0, of what the charts draw: backlash by verdict, then the fronts."""

_SAID = {True: "yes", False: "no", None: "–"}


@dataclass(frozen=True, kw_only=True)
class FrontTable:
    """The table of some variants, worst first, its headings in the row `top`, with costs where `has_cost`."""

    book: Book
    sheet: Any
    top: int
    drawn: Sequence[Drawn]
    offers: Sequence[TradeOff]
    labels: Sequence[str]
    bounds: VerdictBounds
    has_cost: bool

    @property
    def percentile(self) -> str:
        """The name of the percentile of the target."""
        return f"P{self.bounds.target_words.removesuffix(' %')}"

    @property
    def rows(self) -> tuple[int, int]:
        """First and last row."""
        return self.top + 1, self.top + len(self.drawn)

    @property
    def last_column(self) -> int:
        """The last column of the table."""
        return _WITH_COST if self.has_cost else _WITHOUT_COST

    @cached_property
    def verdicts(self) -> list[str]:
        """The verdict of each variant."""
        return [verdict_word(variant.row, self.bounds) for variant in self.drawn]

    def write(self) -> None:
        """Write headings and rows."""
        headings = ["Variant", "Verdict", "Torque T [N·m]", "Nominal [{angle}]", f"{self.percentile} [{{angle}}]"]
        headings += ["Limit [{angle}]", "Mass [kg]", "On the front of mass"]
        headings += ["Relative cost", "On the front of cost"] if self.has_cost else []
        self.sheet.write_row(self.top, 0, self.book.headings(*headings), self.book.format("header"))
        self.sheet.set_row(self.top, 32)
        for row, (variant, offer, label, verdict) in enumerate(
            zip(self.drawn, self.offers, self.labels, self.verdicts, strict=True), start=self.top + 1
        ):
            self.sheet.write_string(row, 0, label, self.book.format("text"))
            self.sheet.write_string(row, 1, verdict, self.book.format(COLOURS[verdict]))
            limit = variant.row["backlash_limit_arcmin"]
            numbers = {
                2: (variant.computed.variant.dimensions["torque"], "general"),
                3: (variant.row["backlash_arcmin"], "angle"),
                4: (offer.quantile / ARCMIN, "angle"),
                5: (limit and self.book.angles.of(limit), "general"),
                6: (offer.mass, "plain"),
                8: (offer.cost, "#,##0.0"),
            }
            for column, (number, code) in numbers.items():
                if number is not None and column <= self.last_column:
                    self.book.write_figure(self.sheet, row, column, number, code)
            for column, is_on in ((7, offer.light), (9, offer.cheap)):
                if column <= self.last_column:
                    style = self.book.format("ok" if is_on else "indented")
                    self.sheet.write_string(row, column, _SAID[is_on], style)
            self._write_helper(row, verdict, offer)

    def _write_helper(self, row: int, verdict: str, offer: TradeOff) -> None:
        """Write the backlash into the column of its verdict."""
        column = _FIRST_HELPER + list(_COLUMNS).index(firm(verdict))
        self.book.write_figure(self.sheet, row, column, offer.quantile / ARCMIN, "angle", look="quiet")

    def write_helpers(self) -> None:
        """Write what the columns beside the page are."""
        quiet = self.book.format("quiet")
        self.sheet.write_string(self.top - 1, _FIRST_HELPER, "Behind the charts: nothing to change here.", quiet)
        for place, verdict in enumerate(_COLUMNS):
            self.sheet.write_string(self.top, _FIRST_HELPER + place, verdict, quiet)

    def by_verdict(self, figure: Figure) -> Iterator[tuple[str, Mapping[str, Any]]]:
        """Yield each verdict that a variant has, with the places of figure and backlash of those."""
        first, last = self.rows
        across = self._column(figure)
        for place, verdict in enumerate(_COLUMNS):
            if any(firm(one) == verdict for one in self.verdicts):
                column = _FIRST_HELPER + place
                name = self.sheet.name
                places = {
                    "categories": [name, first, across, last, across],
                    "values": [name, first, column, last, column],
                }
                yield verdict, places

    @staticmethod
    def _column(figure: Figure) -> int:
        return {"mass": 6, "cost": 8}[figure]

    def front(self, figure: Figure) -> list[list[int]]:
        """Return the places of the variants on each front, of those of one torque, the least figure first."""
        fronts: dict[float, list[int]] = {}
        for place, (variant, offer) in enumerate(zip(self.drawn, self.offers, strict=True)):
            if offer.light if figure == "mass" else offer.cheap:
                fronts.setdefault(variant.computed.variant.dimensions["torque"], []).append(place)
        return [sorted(places, key=lambda place: (self.figure(figure, place), place)) for places in fronts.values()]

    def figure(self, figure: Figure, place: int) -> float:
        """Return the figure of a variant."""
        value = self.offers[place].mass if figure == "mass" else self.offers[place].cost
        if value is None:
            raise LookupError("a variant on a front without the figure")
        return value

    def write_front(self, figure: Figure, places: Sequence[int], start: int) -> Mapping[str, Any]:
        """Write a front beside the page, so many rows below the headings; return its places for a chart."""
        column = _LINE + {"mass": 0, "cost": 3}[figure]
        number = self.book.format("quiet", "general")
        self.sheet.write_string(self.top, column, f"front of {figure}", self.book.format("quiet"))
        first = self.top + 1 + start
        for row, place in enumerate(places, start=first):
            self.sheet.write_number(row, column, self.figure(figure, place), number)
            self.sheet.write_number(row, column + 1, self.book.angles.of_radians(self.offers[place].quantile), number)
        last, name = first + len(places) - 1, self.sheet.name
        return {
            "categories": [name, first, column, last, column],
            "values": [name, first, column + 1, last, column + 1],
        }


_COLUMNS = ("fails", "marginal", "meets", NO_VERDICT)
"""Verdicts in the order of the columns beside the page."""
