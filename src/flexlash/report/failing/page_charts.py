"""The charts of a failing variant's page: density with limit, nominal and mean, tornado, one bar of segments."""

from __future__ import annotations

from typing import Any

from flexlash.report.explorer.curves_sheet import SEGMENTS
from flexlash.report.failing.stored_pages import LINES, causes_of_page, ends_of_histogram, is_drawn
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.axes import axis_around, axis_over
from flexlash.report.layout.styles import GRID, OUTLINE, PALETTE, Book
from flexlash.report.report_data import Drawn
from flexlash.schema.angle_unit import AngleUnit
from flexlash.tolerance.distribution_curves import HISTOGRAM_BINS

__all__ = ["density_chart", "density_words", "segments_chart", "segments_words", "tornado_chart", "tornado_words"]

_LETTERS = {"size": 10, "bold": False, "color": "#404040"}
_TITLE = {"size": 12, "color": PALETTE["ink"]}
_PLOT = 0.92
"""Part of the width of the density that its bins and lines have."""

_POINT = 0.75
"""Points in a pixel."""

_DASHES = {
    "Limit": ("black", "solid", 2.25),
    "Nominal": ("ink", "dash", 1.5),
    "Mean": ("green", "round_dot", 1.75),
}
_BLACK = "#000000"
_COLOURS = ("ink", "grey", "blue", "sky", "orange", "red")


def density_chart(book: Book, variant: Drawn, pages: Stored, place: int, width: int) -> Any:
    """Return the histogram of a variant, units over the limit in red, on a chart so many pixels wide.

    Bins are the error bars of points, so that they and the lines share an axis of numbers. A line that lies beyond that
    axis has its words in the legend alone.
    """
    angles = book.angles
    chart = _chart(book, "scatter", f"Share of units by backlash [{angles.name}]", subtype="straight")
    low, high = map(angles.of, ends_of_histogram(variant))
    lines = [variant.row[key] for line, key in LINES.items() if is_drawn(variant, line)]
    axis = axis_over([low, high, *map(angles.of, lines)])
    bar = _PLOT * width * _POINT * (high - low) / HISTOGRAM_BINS / (axis.high - axis.low)
    middles = pages.across(place, "Middle 1", f"Middle {HISTOGRAM_BINS}")
    for name, heading, colour in (("within the limit", "Within", "blue"), ("over the limit", "Over", "red")):
        chart.add_series({
            "name": name,
            "categories": middles,
            "values": pages.across(place, f"{heading} 1", f"{heading} {HISTOGRAM_BINS}"),
            "line": {"none": True},
            "marker": {"type": "none"},
            "y_error_bars": {
                "type": "percentage",
                "value": 100,
                "direction": "minus",
                "end_style": 0,
                "line": {"color": PALETTE[colour], "width": round(max(0.75, bar), 2)},
            },
        })  # fmt: skip
    for line in (line for line, key in LINES.items() if variant.row[key] is not None):
        colour, dash, weight = _DASHES[line]
        chart.add_series({
            "name": f"{line} {_line_words(variant, line, book.angles)}",
            "categories": pages.across(place, f"{line} from", f"{line} to"),
            "values": pages.across(place, f"{line} bottom", f"{line} top"),
            "line": {"color": PALETTE.get(colour, _BLACK), "width": weight, "dash_type": dash},
            "marker": {"type": "none"},
        })  # fmt: skip
    chart.set_x_axis({**axis.options(), "major_gridlines": {"visible": False}, "num_font": _LETTERS})
    chart.set_y_axis({"visible": False, "min": 0, "major_gridlines": {"visible": False}})
    chart.set_legend({"position": "bottom", "font": _LETTERS, "delete_series": [0, 1]})
    return chart


def density_words(variant: Drawn, angles: AngleUnit) -> str:
    """Return the alternative text of the histogram."""
    told = ", ".join(f"{line.lower()} {_line_words(variant, line, angles)}" for line in LINES)
    return f"{_name(variant)}: histogram of the backlash of all units, the part over the limit in red; {told}"


def tornado_chart(book: Book, variant: Drawn, pages: Stored, place: int) -> Any:
    """Return what each dimension does between its limits, the greatest share of the variance on top."""
    chart = _chart(book, "bar", f"What causes the spread [{book.angles.name}]")
    last = max(1, len(causes_of_page(variant, book.angles)))
    for heading, colour in (("At lower limit", "sky"), ("At upper limit", "blue")):
        chart.add_series({
            "name": heading.lower(),
            "categories": pages.across(place, "Cause 1", f"Cause {last}"),
            "values": pages.across(place, f"{heading} 1", f"{heading} {last}"),
            "fill": {"color": PALETTE[colour]},
            "border": OUTLINE,
            "overlap": 100,
            "gap": 40,
        })  # fmt: skip
    axis = axis_around([half for _, _, half in causes_of_page(variant, book.angles)])
    chart.set_x_axis({**axis.options(), "crossing": 0, "major_gridlines": GRID, "num_font": _LETTERS})
    chart.set_y_axis({"reverse": True, "label_position": "low", "num_font": _LETTERS, "crossing": "max"})
    chart.set_legend({"position": "bottom", "font": _LETTERS})
    return chart


def tornado_words(variant: Drawn, angles: AngleUnit) -> str:
    """Return the alternative text of the tornado."""
    causes = causes_of_page(variant, angles)
    told = "; ".join(f"{name}: {abs(half):.3g}{angles.sign} to either side" for name, _, half in causes)
    told = told or "nothing scatters"
    return f"{_name(variant)}: change of the backlash between the limits of each dimension. {told}"


def segments_chart(book: Book, variant: Drawn, pages: Stored, place: int) -> Any:
    """Return one bar of the segments from the open end to the hub."""
    chart = _chart(book, "bar", "Where the nominal backlash arises, from the open end to the hub", subtype="stacked")
    for (name, share), colour in zip(_segments(variant).items(), _colours(variant), strict=True):
        chart.add_series({
            "name": f"{name} {100 * share:.1f} %",
            "categories": pages.across(place, "Variant", "Variant"),
            "values": pages.across(place, name, name),
            "fill": {"color": PALETTE[colour]},
            "border": OUTLINE,
            "gap": 10,
        })  # fmt: skip
    whole = book.angles.of(variant.row["backlash_arcmin"])
    chart.set_x_axis({"min": 0, "max": whole, "visible": False, "major_gridlines": {"visible": False}})
    chart.set_y_axis({"visible": False})
    chart.set_legend({"position": "bottom", "font": _LETTERS})
    return chart


def segments_words(variant: Drawn) -> str:
    """Return the alternative text of the bar of segments."""
    told = ", ".join(f"{name} {100 * share:.1f} %" for name, share in _segments(variant).items())
    return f"{_name(variant)}: segments of the part by their share of the nominal backlash: {told}"


def _name(variant: Drawn) -> str:
    return str(variant.row["variant"])


def _chart(book: Book, kind: str, title: str, **options: Any) -> Any:
    chart = book.chart(kind, title, **options)
    chart.set_title({"name": title, "name_font": _TITLE, "overlay": False})
    chart.set_chartarea({"border": {"color": PALETTE["pale"]}})
    return chart


def _segments(variant: Drawn) -> dict[str, float]:
    """Return the share of the nominal backlash that each segment has, those without any left out."""
    nominal = variant.computed.nominal
    angles = {name: getattr(nominal, f"{segment}_windup") for segment, name in SEGMENTS.items()}
    return {name: angle / nominal.windup for name, angle in angles.items() if isinstance(angle, float) and angle > 0}


def _colours(variant: Drawn) -> list[str]:
    """Return the colour of each segment that the bar has, the same on every page."""
    own = _segments(variant)
    return [colour for name, colour in zip(SEGMENTS.values(), _COLOURS, strict=True) if name in own]


def _line_words(variant: Drawn, line: str, angles: AngleUnit) -> str:
    """Return where a line stands, and on which side of the picture where it is not drawn."""
    value = variant.row[LINES[line]]
    if value is None:
        return "none"
    words = angles.entered(value) if line == "Limit" else angles.words(value)
    if is_drawn(variant, line):
        return words
    return f"{words}, off to the {'left' if value < ends_of_histogram(variant)[0] else 'right'}"
