"""The charts of the trade-offs: the backlash of every variant over its mass or cost, with the fronts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexlash.report.layout.axes import axis_over
from flexlash.report.layout.styles import GRID, OUTLINE, PALETTE, Book, literal
from flexlash.report.tradeoffs.front_table import Figure, FrontTable
from flexlash.report.wording.verdict import NO_VERDICT

__all__ = ["front_chart"]

_COLOURS = {"fails": "red", "marginal": "orange", "meets": "blue", NO_VERDICT: "grey"}
_AXES: dict[Figure, str] = {"mass": "Mass [kg]", "cost": "Relative cost"}
_NAMED = 12
"""Most variants of the fronts whose names are drawn: more of them cannot be read."""

_NAMED_FRONTS, _FRONTS = 3, 8
"""Most fronts whose variants are named, and most that are drawn as lines."""

_SMALL = {"name_font": {"size": 9, "bold": False}, "num_font": {"size": 9}}


def front_chart(book: Book, table: FrontTable, figure: Figure) -> Any:
    """Return the percentile of the target over a figure, with the variants on the front named."""
    chart = book.chart("scatter", f"{table.percentile} of the backlash over {'mass' if figure == 'mass' else 'cost'}")
    fronts = sorted(table.front(figure), key=len, reverse=True)[:_FRONTS]
    start, left = 0, _NAMED if len(fronts) <= _NAMED_FRONTS else 0
    line = {"color": PALETTE["ink"], "width": 1.25, "dash_type": "dash"}
    for number, front in enumerate(fronts):
        labels = _labels(table, front, left)
        chart.add_series({
            **table.write_front(figure, front, start), "name": "On the front" if number == 0 else f"Front {number + 1}",
            "line": line, "marker": {"type": "none"},
            "data_labels": {"value": True, "position": "right", "font": {"size": 8}, "custom": labels},
        })  # fmt: skip
        start, left = start + len(front) + 1, left - min(left, len(front))
    for verdict, places in table.by_verdict(figure):
        ink = {"color": PALETTE[_COLOURS[verdict]]}
        name = "No limit" if verdict == NO_VERDICT else verdict.capitalize()
        chart.add_series({
            **places, "name": name, "line": {"none": True},
            "marker": {"type": "circle", "size": 7, "fill": ink, "border": OUTLINE},
        })  # fmt: skip
    _set_axes(chart, table, figure)
    chart.set_legend({"position": "bottom", "font": {"size": 9}, "delete_series": list(range(1, len(fronts)))})
    return chart


def _labels(table: FrontTable, front: Sequence[int], most: int) -> list[dict[str, Any]]:
    """Return the names beside the points of a front, of so many of them at most."""
    return [
        {"value": literal(table.labels[place])} if number < most else {"delete": True}
        for number, place in enumerate(front)
    ]


def _set_axes(chart: Any, table: FrontTable, figure: Figure) -> None:
    """Set both axes near what is drawn."""
    places = [place for place, offer in enumerate(table.offers) if getattr(offer, figure) is not None]
    across = axis_over([table.figure(figure, place) for place in places])
    up = axis_over([table.book.angles.of_radians(table.offers[place].quantile) for place in places])
    chart.set_x_axis({**across.options(), **_SMALL, "name": _AXES[figure], "major_gridlines": GRID})
    chart.set_y_axis(
        {**up.options(), **_SMALL, "name": f"{table.percentile} [{table.book.angles.name}]", "major_gridlines": GRID}
    )
