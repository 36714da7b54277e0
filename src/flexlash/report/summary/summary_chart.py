"""The chart of the Summary: where 95 % of each variant's units lie, its median and its limit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.report.extent import extent_of
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import GRID, OUTLINE, PALETTE, Book
from flexlash.report.report_data import Drawn
from flexlash.report.wording.chart_words import limits_over, spans_of
from flexlash.report.wording.verdict import firm, verdict_word
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.number_words import grouped

__all__ = ["CHARTED", "chart_axis", "chart_title", "chart_words", "variants_chart"]

CHARTED = 60
"""Most variants whose names can be read below a chart."""

_COLOURS = {"fails": "red", "marginal": "orange"}
_LOOKS: tuple[tuple[int, dict[str, int]], ...] = (
    (3, {"gap": 500, "turned": 0, "font": 9, "median": 6, "limit": 14}),
    (12, {"gap": 150, "turned": -45, "font": 9, "median": 5, "limit": 12}),
    (30, {"gap": 60, "turned": -90, "font": 9, "median": 4, "limit": 9}),
    (CHARTED, {"gap": 30, "turned": -90, "font": 8, "median": 3, "limit": 6}),
)
"""Up to how many variants: space between bars in per cent of their width, turn and size of labels, size of marks."""


def variants_chart(book: Book, drawn: Sequence[Drawn], curves: Stored, outcome: Outcome) -> Any:
    """Return the chart of the worst variants; its data stand on the sheet of the curves."""
    shown, total = drawn[:CHARTED], extent_of(outcome).total
    look = next(look for most, look in _LOOKS if len(shown) <= most)
    bars = book.chart("column", chart_title(len(shown), total), subtype="stacked")
    marks = book.workbook.add_chart({"type": "line"})
    names = curves.series("Label", len(shown))
    hidden = {"fill": {"none": True}, "border": {"none": True}, "gap": look["gap"]}
    for chart, heading, name, how in (
        (bars, "P2.5", "P2.5", hidden),
        (
            bars,
            "P2.5 to P97.5",
            "P2.5 to P97.5 (orange: marginal, dark orange: fails)",
            _bars(shown, outcome.settings.verdict_bounds),
        ),
        (marks, "P50", "Median", _marker("diamond", PALETTE["ink"], look["median"])),
        (marks, "Limit", "Limit", _marker("long_dash", "#000000", look["limit"])),
    ):
        chart.add_series({"name": name, "categories": names, "values": curves.series(heading, len(shown)), **how})
    bars.combine(marks)
    bars.set_y_axis({**_axis(shown), "major_gridlines": GRID})
    bars.set_x_axis({"num_font": {"rotation": look["turned"], "size": look["font"]}, "interval_unit": 1})
    bars.set_legend({"position": "bottom", "delete_series": [0]})
    return bars


def chart_title(shown: int, total: int) -> str:
    """Return the title of the chart that shows so many variants of so many."""
    part = f": the {shown} worst of {grouped(total)}" if shown < total else ""
    return f"Backlash of 95 % of units (P2.5 to P97.5), median and limit [arcmin]{part}"


def chart_words(drawn: Sequence[Drawn]) -> str:
    """Return the alternative text of the chart."""
    charted = drawn[:CHARTED]
    return (
        f"Backlash of {len(charted)} variants, worst first: {spans_of(charted)}. {limits_over(charted)} "
        "A bar goes from the backlash that 2.5 % of units stay below to that which 97.5 % stay below, the median as "
        "a diamond, the limit as a dash. Bars of variants that "
        "fail are dark orange, of marginal ones orange, of others blue."
    )


def _bars(shown: Sequence[Drawn], bounds: VerdictBounds) -> dict[str, Any]:
    """Return the look of the bars, coloured by verdict."""

    def look(colour: str) -> dict[str, Any]:
        return {"fill": {"color": PALETTE[colour]}, "border": OUTLINE}

    colours = [_COLOURS.get(firm(verdict_word(variant.row, bounds)), "sky") for variant in shown]
    return {**look("sky"), "points": [look(colour) for colour in colours]}


def _marker(shape: str, colour: str, size: int) -> dict[str, Any]:
    """Return the look of a series that is marks without a line."""
    fill = {"color": colour}
    return {"line": {"none": True}, "marker": {"type": shape, "size": size, "fill": fill, "border": fill}}


def _axis(shown: Sequence[Drawn]) -> dict[str, Any]:
    """Return the same as the axis of a chart has it."""
    start, step, digits = chart_axis([variant.row for variant in shown])
    return {"min": start, "major_unit": step, "num_format": f"0.{'0' * digits}" if digits else "0"}


def chart_axis(rows: Sequence[dict[str, Any]]) -> tuple[float, float, int]:
    """Return start, step and digits of an axis that begins at a round number below all that Results rows show."""
    limits = [row["backlash_limit_arcmin"] for row in rows if row["backlash_limit_arcmin"] is not None]
    low = min([*limits, *(row["p2_5_arcmin"] for row in rows)])
    high = max([*limits, *(row["p97_5_arcmin"] for row in rows)])
    about = max(high - low, high / 100) / 6
    power = 10.0 ** math.floor(math.log10(about))
    step = power * next(times for times in (1, 2, 5, 10) if about <= times * power * (1 + 1e-9))
    digits = max(0, -math.floor(math.log10(step * (1 + 1e-9))))
    return max(0.0, round(math.floor((low - step / 2) / step) * step, 12)), round(step, 12), digits
