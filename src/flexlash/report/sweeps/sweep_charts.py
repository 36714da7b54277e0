"""The charts of a sweep over one dimension: the backlash with its spread and limit, disk share and stress."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from flexlash.decisions.sweep import Study
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.axes import Axis, axis_over
from flexlash.report.layout.styles import GRID, PALETTE, Book
from flexlash.report.sweeps.sweep_curves import LEVELS, crossing_heading, grid_of, heading_of
from flexlash.report.wording.sweep_words import level_title, swept_title, value_words
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.columns import columns_of
from flexlash.schema.findings import shown

__all__ = ["SMALLEST", "backlash_chart", "share_chart"]

SMALLEST = 10
"""Size of the smallest letters of the sheet [pt]."""

_SMALL = {"name_font": {"size": SMALLEST, "bold": False}, "num_font": {"size": SMALLEST}}
_MARKS = ("circle", "triangle", "diamond", "square")
_MARK_COLOURS = ("grey", "rose", "red", "ink")
_EDGE = {"color": PALETTE["grey"], "width": 0.75}
_NAME = 30
"""Between the sky of 95 % of the units and white."""


def backlash_chart(book: Book, study: Study, number: int, stored: Stored) -> Any:
    """Return the backlash over the dimension: 95 % of units as a band, above it up to P99.865, lines and crossings."""
    grid = grid_of(study)
    count = len(grid.places)

    def series(what: str) -> Mapping[str, Any]:
        values = stored.series(heading_of(number, what), count)
        return {"categories": stored.series(heading_of(number, "label"), count), "values": values}

    bands = book.chart("area", f"Backlash of {shown(study.variant, longest=_NAME)}", subtype="stacked")
    bands.add_series({**series("P2.5"), "name": "P2.5", "fill": {"none": True}, "border": {"none": True}})
    for what, colour in (("P2.5 to P97.5", PALETTE["sky"]), ("P97.5 to P99.865", PALETTE["pale"])):
        bands.add_series({**series(what), "name": what, "fill": {"color": colour}, "border": _EDGE})
    lines = book.workbook.add_chart({"type": "line"})
    lines.add_series({**series("P50"), "name": "P50", "line": {"color": PALETTE["ink"], "width": 2}})
    look = {"color": PALETTE["blue"], "width": 1.5, "dash_type": "dash"}
    lines.add_series({**series("Nominal"), "name": "Nominal", "line": look})
    lines.add_series({**series("points"), "name": "computed points", **_mark("circle", PALETTE["ink"], 4)})
    hidden = [0, 5]
    if study.limit is not None:
        limit = {"color": PALETTE["red"], "width": 2}
        lines.add_series(
            {**series("Limit"), "name": f"Limit {book.angles.of(study.limit):.6g}{book.angles.sign}", "line": limit}
        )
        _add_crossings(lines, study, series)
    bands.combine(lines)
    axis = _axis(study, book.angles)
    bands.set_y_axis({**axis.options(), **_SMALL, "name": f"Backlash [{book.angles.name}]", "major_gridlines": GRID})
    bands.set_x_axis({
        **_SMALL,
        "name": swept_title(study.first.key),
        "position_axis": "on_tick",
        "interval_unit": grid.labelled,
        "interval_tick": grid.labelled,
        "major_tick_mark": "none",
    })  # fmt: skip
    bands.set_legend({"position": "right", "delete_series": hidden, "font": {"size": SMALLEST}})
    return bands


def share_chart(book: Book, study: Study, rows: tuple[int, int], columns: tuple[int, int]) -> Any:
    """Return the share of the disk, and on the right the von Mises stress, over the dimension.

    They stand on the sheet Sweep in these rows, the values in the first column; `columns` are those of share and
    stress.
    """
    chart = book.chart("scatter", "Disk share and stress", subtype="straight_with_markers")
    known = study.results.filter(study.results["disk_share"].is_not_null())
    for column, name, colour, right in (
        (columns[0], "Disk share", "blue", False),
        (columns[1], "Von Mises stress (right), torsion only", "grey", True),
    ):
        chart.add_series({
            "name": name,
            "categories": ["Sweep", rows[0], 0, rows[1], 0],
            "values": ["Sweep", rows[0], column, rows[1], column],
            "line": {"color": PALETTE[colour], "width": 2},
            "marker": {"type": "circle", "size": 4, "fill": {"color": PALETTE[colour]},
                       "border": {"color": PALETTE[colour]}},
            "y2_axis": right,
        })  # fmt: skip
    shares, stress = (axis_over(_without_noise(known[key].to_list())) for key in ("disk_share", "von_mises_MPa"))
    below = axis_over(study.first.values)
    ends = {"min": below.low, "max": below.high, "major_unit": below.step, "major_gridlines": {"visible": False}}
    chart.set_x_axis({**_SMALL, **ends, "name": swept_title(study.first.key), "num_format": "General"})
    chart.set_y_axis({**shares.options(per_cent=True), **_SMALL, "major_gridlines": GRID})
    chart.set_y2_axis({**stress.options(), **_SMALL, "name": "MPa", "crossing": "max"})
    return chart


def _add_crossings(lines: Any, study: Study, series: Any) -> None:
    """Mark the crossings of each level on the limit; the legend says where they are."""
    unit = columns_of("Variants")[study.first.key].unit_behind
    for place, percent in enumerate(dict.fromkeys(one.percent for one in study.crossings)):
        values = " and ".join(value_words(one.value) for one in study.crossings if one.percent == percent)
        look = _mark(_MARKS[place % len(_MARKS)], PALETTE[_MARK_COLOURS[place % len(_MARK_COLOURS)]], 8)
        lines.add_series({
            **series(crossing_heading(percent)), "name": f"{level_title(percent)} crosses at {values}{unit}", **look,
        })  # fmt: skip


def _mark(shape: str, colour: str, size: int) -> dict[str, Any]:
    """Return the look of a series that is marks without a line."""
    fill = {"color": colour}
    return {"line": {"none": True}, "marker": {"type": shape, "size": size, "fill": fill, "border": {"color": "white"}}}


def _axis(study: Study, angles: AngleUnit) -> Axis:
    """Return an axis over all that is drawn."""
    numbers = [study.results[key] for key in (*LEVELS.values(), "backlash_arcmin")]
    ends = [value for column in numbers for value in column.to_list() if value is not None]
    drawn = [*ends, *([] if study.limit is None else [study.limit])]
    return axis_over(_without_noise([angles.of(angle) for angle in drawn]))


def _without_noise(values: Sequence[float]) -> list[float]:
    """Return numbers whose differences are none of rounding, so that an axis over equal ones is one."""
    return [float(f"{value:.9g}") for value in values]
