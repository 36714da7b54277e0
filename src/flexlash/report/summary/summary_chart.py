"""The chart of the Summary: how far each variant's units are from its limit, in per cent of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import GRID, PALETTE, Book
from flexlash.report.report_data import Drawn
from flexlash.report.summary.relative_bars import KINDS
from flexlash.report.wording.chart_words import limits_over, spans_of
from flexlash.report.wording.verdict import NO_VERDICT
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.number_words import grouped

__all__ = ["CHARTED", "chart_axis", "chart_title", "chart_words", "variants_chart"]

CHARTED = 60
"""Most variants whose names can be read below a chart."""

_COLOURS = {"fails": "dark red", "marginal": "amber", "meets": "blue", NO_VERDICT: "grey"}
"""Bars have no outline, so that each colour stands out from white by itself."""

_SHAPES = {"fails": "diamond", "marginal": "plus", "meets": "circle", NO_VERDICT: "x"}
"""Marks of medians, so that a print without colours tells verdicts apart."""

_FONT = 11
"""Size of letters [pt]: more than 7 when the page is printed."""

_TOLD_ABOVE, _TOLD_BELOW = 30, 12
"""Most variants of which the figures beyond the scale stand beside their marks without touching."""

_LOOKS: tuple[tuple[int, dict[str, float]], ...] = (
    (3, {"turned": 0, "bar": 14.0, "mark": 6}),
    (12, {"turned": -45, "bar": 12.0, "mark": 5}),
    (30, {"turned": -90, "bar": 8.0, "mark": 4}),
    (CHARTED, {"turned": -90, "bar": 5.0, "mark": 3}),
)
"""Up to how many variants: turn of names, width [pt] of bars, size of marks."""


def variants_chart(book: Book, bars: Stored, reach: float, total: int) -> Any:
    """Return the chart of the worst variants; its data stand on the sheet of the bars."""
    count = len(bars.rows)
    look = next(look for most, look in _LOOKS if count <= most)
    is_limited = any(row[NO_VERDICT] is None for row in bars.rows)
    chart = book.chart("line", relative_title(count, total, is_limited=is_limited))
    names = bars.series("Label")
    for kind in KINDS:
        if any(row[kind] is not None for row in bars.rows):
            ink = PALETTE[_COLOURS[kind]]
            chart.add_series({
                "name": "no limit" if kind == NO_VERDICT else kind,
                "categories": names, "values": bars.series(kind), "line": {"none": True},
                "marker": _marker(_SHAPES[kind], ink, look["mark"], "#FFFFFF"),
                "y_error_bars": {
                    "type": "custom", "end_style": 0, "direction": "both",
                    "line": {"color": ink, "width": look["bar"]},
                    "plus_values": _range(bars, "up"), "minus_values": _range(bars, "down"),
                    "plus_data": [row["up"] for row in bars.rows], "minus_data": [row["down"] for row in bars.rows],
                },
            })  # fmt: skip
    chart.add_series({
        "name": "P99.865", "categories": names, "values": bars.series("P99.865"), "line": {"none": True},
        "marker": _marker("long_dash", PALETTE["ink"], look["mark"] + 5),
    })  # fmt: skip
    for heading, position, most, shape in (
        ("above", "below", _TOLD_ABOVE, "triangle"),
        ("below", "above", _TOLD_BELOW, "square"),
    ):
        if any(row[heading] is not None for row in bars.rows):
            labels = [{"value": f"{row['off']:+.0f} %" if row[heading] is not None else ""} for row in bars.rows]
            told = {"value": True, "position": position, "custom": labels, "font": {"size": _FONT}}
            chart.add_series({
                "name": f"median further {heading}", "categories": names, "values": bars.series(heading),
                "line": {"none": True}, "marker": _marker(shape, PALETTE["grey"], look["mark"] + 3),
                **({"data_labels": told} if count <= most else {}),
            })  # fmt: skip
    zero = {"color": "#000000", "width": 2.25}
    chart.set_y_axis({
        "min": -reach, "max": reach, "major_unit": reach / 2, "num_format": '+0.#" %";-0.#" %";0" %"',
        "num_font": {"size": _FONT}, "major_gridlines": GRID,
    })  # fmt: skip
    chart.set_x_axis({
        "num_font": {"rotation": look["turned"], "size": _FONT}, "interval_unit": 1, "label_position": "low",
        "line": zero, "major_tick_mark": "none",
    })  # fmt: skip
    chart.show_blanks_as("gap")
    chart.set_legend({"position": "bottom", "font": {"size": _FONT}})
    return chart


def relative_title(shown: int, total: int, *, is_limited: bool) -> str:
    """Return the title of the chart that shows so many variants of so many."""
    part = f": the {shown} worst of {grouped(total)}" if shown < total else ""
    if is_limited:
        return f"Backlash less its limit (line at 0), in % of the limit: P2.5 to P97.5 with median{part}"
    return f"Backlash less its median (line at 0), in % of the median: P2.5 to P97.5{part}"


def chart_title(shown: int, total: int, angles: AngleUnit) -> str:
    """Return the title of the page's chart that shows so many variants of so many."""
    part = f": the {shown} worst of {grouped(total)}" if shown < total else ""
    return f"Backlash of 95 % of units (P2.5 to P97.5), median and limit [{angles.name}]{part}"


def chart_words(drawn: Sequence[Drawn], angles: AngleUnit) -> str:
    """Return the alternative text of the chart."""
    charted = drawn[:CHARTED]
    base = "median" if all(one.row["backlash_limit_arcmin"] is None for one in drawn) else "limit"
    return (
        f"Backlash of {len(charted)} variants, worst first: {spans_of(charted, angles)}. {limits_over(charted)} "
        f"Drawn in per cent of the {base}, which is the line at zero: a bar goes from the backlash that 2.5 % of units "
        "stay below to that which 97.5 % stay below, P99.865 as a dash. Bars of variants that fail are dark red with "
        "a diamond at the median, of marginal ones orange with a plus, of those that meet it blue with a circle; a "
        "triangle or a square with its figure stands for one beyond the scale."
    )


def _range(bars: Stored, heading: str) -> str:
    return f"={bars.cells(heading).text}"


def _marker(shape: str, colour: str, size: float, border: str = "") -> dict[str, Any]:
    """Return the look of a mark."""
    return {"type": shape, "size": size, "fill": {"color": colour}, "border": {"color": border or colour}}


def chart_axis(rows: Sequence[dict[str, Any]], angles: AngleUnit) -> tuple[float, float, int]:
    """Return start, step and digits of an axis that begins at a round number below all that Results rows show."""
    limits = [row["backlash_limit_arcmin"] for row in rows if row["backlash_limit_arcmin"] is not None]
    low = angles.of(min([*limits, *(row["p2_5_arcmin"] for row in rows)]))
    high = angles.of(max([*limits, *(row["p97_5_arcmin"] for row in rows)]))
    about = max(high - low, high / 100) / 6
    power = 10.0 ** math.floor(math.log10(about))
    step = power * next(times for times in (1, 2, 5, 10) if about <= times * power * (1 + 1e-9))
    digits = max(0, -math.floor(math.log10(step * (1 + 1e-9))))
    return max(0.0, round(math.floor((low - step / 2) / step) * step, 12)), round(step, 12), digits
