"""The Explorer's charts: density, cumulative curve, tornado, segments, each drawn from cells that follow the choice."""

from __future__ import annotations

from typing import Any

from flexlash.report.explorer.curves_sheet import CAUSES, SEGMENTS
from flexlash.report.explorer.explorer_choice import Choice
from flexlash.report.explorer.explorer_working import COLUMN, CURVE_ROW, Working
from flexlash.report.formula.functions import AND, CONCATENATE, FIXED, IF, INT, LOG10, MAX, MIN
from flexlash.report.formula.live import Live, live, put
from flexlash.report.layout.styles import GRID, OUTLINE, PALETTE, Book
from flexlash.report.wording.chart_words import largest_of
from flexlash.schema.findings import shown
from flexlash.tolerance.distribution_curves import CURVE_SCORES, HISTOGRAM_BINS

__all__ = ["CHART_ROWS", "FIRST_CHART", "write_charts"]

_BINS = COLUMN + 11
_BAR_ROW = CURVE_ROW
_CAUSE_ROW = _BAR_ROW + HISTOGRAM_BINS + 2
_SEGMENT_ROW = _CAUSE_ROW + CAUSES + 2
_DRAWN_SCORE = 3.41
"""The cumulative curve is drawn as far as this score on both sides, from 0.03 to 99.97 % of units."""

_BINS_PER_LABEL = 5
FIRST_CHART, CHART_ROWS = 20, 16
"""Row, from 0, of the upper charts, and rows from one chart to that below it."""

_COLOURS = ("ink", "grey", "blue", "sky", "orange", "red")
_WIDTHS, _HEIGHT = (560, 440), 312
_RIGHT = 3
_NAME = 40


def write_charts(book: Book, sheet: Any, choice: Choice, working: Working, limit: Live) -> None:
    """Write the cells behind the four charts, and draw them."""
    _write_notes(book, sheet, choice, working, limit)
    name = shown(str(choice.name.value), longest=_NAME)
    median, sign = choice.angle("P50").value, book.angles.sign
    middle = f", median {median:.4g}{sign}" if isinstance(median, float) else ""
    when = f"picked variant (when the report was written, {name}{middle}"
    at = f"the limit{f' {limit.value:.4g}{sign}' if isinstance(limit.value, float) else ' (none is given)'}"
    segments = {segment: choice.angle(segment).value for segment in SEGMENTS.values()}
    arise = largest_of({segment: value for segment, value in segments.items() if isinstance(value, float)}, sign)
    charts = (
        (_density(book, sheet, choice, limit), f"Histogram of the {when}): units within and over {at}"),
        (_cumulative(book, sheet, working, limit), f"Share of units below each backlash of the {when}), with {at}"),
        (_tornado(book, sheet, choice), f"Tornado of the {when}): what each dimension does between its limits"),
        (_segments(book, sheet, choice), f"Nominal backlash by segment of the {when}: {arise})"),
    )
    for number, (chart, text) in enumerate(charts):
        row, right = FIRST_CHART + number // 2 * CHART_ROWS, number % 2
        book.insert(sheet, row, _RIGHT if right else 0, chart, size=(_WIDTHS[right], _HEIGHT), text=text)


def _write_notes(book: Book, sheet: Any, choice: Choice, working: Working, limit: Live) -> None:
    """Say above the charts in which unit they are, and where the limit is when they do not show it.

    Titles do not follow in all programs, so that they name no unit.
    """
    quiet, none = book.format("quiet"), limit.equals("")
    put(sheet, FIRST_CHART - 1, 0, IF(choice.known, CONCATENATE("Charts in ", choice.unit), "Nothing to draw"), quiet)
    beyond = CONCATENATE("The limit ", FIXED(IF(none, 0.0, limit), 2), " lies outside the pictures.")
    put(sheet, FIRST_CHART - 1, 4, IF(none, "", IF(_in_picture(working, limit), "", beyond)), quiet)


def _drawn(working: Working) -> tuple[int, int]:
    """Return the places of the first and last percentile that the cumulative curve draws."""
    inside = [index for index, score in enumerate(CURVE_SCORES) if abs(score) < _DRAWN_SCORE]
    return inside[0], min(inside[-1], len(working.backlash) - 1)


def _in_picture(working: Working, limit: Live) -> Live:
    """Return whether the limit lies not much farther out than the drawn curve."""
    return AND(limit >= working.backlash[0], limit <= working.backlash[-1])


def _density(book: Book, sheet: Any, choice: Choice, limit: Live) -> Any:
    """Return the histogram; the bin in which the limit lies has both colours."""
    quiet, plain = book.format("quiet"), book.format("text", "general")
    for offset, text in enumerate(("bin middle", "within", "over the limit", "bin begins")):
        sheet.write_string(_BAR_ROW - 1, _BINS + offset, text, quiet)
    width = put(sheet, _BAR_ROW - 2, _BINS + 3, choice.angle("Bin width"), plain)
    labelled = IF(width > 0.0, width * float(_BINS_PER_LABEL), 1.0)
    decimals = put(sheet, _BAR_ROW - 2, _BINS, MAX(live(1.0) - INT(LOG10(labelled)), 0.0), plain)
    begins = choice.angle("Bin start")
    for number in range(HISTOGRAM_BINS):
        row = _BAR_ROW + number
        begins = put(sheet, row, _BINS + 3, begins + width if number else begins, plain)
        put(sheet, row, _BINS, FIXED(begins + width / 2, decimals), plain)
        height = IF(choice.known, choice.text(f"Bin {number + 1}"), 0.0)
        inside = IF(width > 0.0, MIN(MAX((limit - begins) / width, 0.0), 1.0), 1.0)
        within = put(sheet, row, _BINS + 1, IF(limit.equals(""), height, height * inside), plain)
        put(sheet, row, _BINS + 2, height - within, plain)
    last = _BAR_ROW + HISTOGRAM_BINS - 1
    chart = book.chart("column", "Density of the backlash", subtype="stacked")
    hatched = {"pattern": "dark_upward_diagonal", "fg_color": PALETTE["red"], "bg_color": "#FFFFFF"}
    for offset, name, look in (
        (1, "within the limit", {"fill": {"color": PALETTE["blue"]}}),
        (2, "over the limit (hatched)", {"pattern": hatched}),
    ):
        chart.add_series({
            "name": name,
            "categories": ["Explorer", _BAR_ROW, _BINS, last, _BINS],
            "values": ["Explorer", _BAR_ROW, _BINS + offset, last, _BINS + offset],
            **look,
            "border": {"none": True},
            "gap": 4,
        })  # fmt: skip
    chart.set_x_axis({"num_font": {"rotation": -45, "size": 10}, "interval_unit": _BINS_PER_LABEL})
    chart.set_y_axis({"num_format": "0%", "major_gridlines": GRID, "num_font": {"size": 10}})
    return chart


def _cumulative(book: Book, sheet: Any, working: Working, limit: Live) -> Any:
    """Return the cumulative curve with the limit as a line, where that lies in the picture."""
    quiet, plain = book.format("quiet"), book.format("text", "general")
    column = _BINS + 5
    for offset, text in enumerate(("limit", "share")):
        sheet.write_string(_BAR_ROW - 1, column + offset, text, quiet)
    # A limit outside becomes a line without length, since readers differ in what they draw of a missing number.
    none, inside = limit.equals(""), _in_picture(working, limit)
    middle = working.backlash[len(working.backlash) // 2]
    for row, share in ((_BAR_ROW, 0.0), (_BAR_ROW + 1, 1.0)):
        put(sheet, row, column, IF(none, middle, IF(inside, limit, middle)), plain)
        put(sheet, row, column + 1, IF(none, 0.0, IF(inside, share, 0.0)), plain)
    first, last = (CURVE_ROW + index for index in _drawn(working))
    chart = book.chart("scatter", "Share of units below a backlash", subtype="straight")
    for name, rows, columns, line in (
        ("share below", (first, last), (COLUMN + 2, COLUMN + 1), {"color": PALETTE["blue"], "width": 2.25}),
        ("limit", (_BAR_ROW, _BAR_ROW + 1), (column, column + 1), {
            "color": PALETTE["red"], "width": 1.5, "dash_type": "dash",
        }),
    ):  # fmt: skip
        chart.add_series({
            "name": name,
            "categories": ["Explorer", rows[0], columns[0], rows[1], columns[0]],
            "values": ["Explorer", rows[0], columns[1], rows[1], columns[1]],
            "line": line,
        })  # fmt: skip
    chart.set_x_axis({"num_format": "General", "major_gridlines": {"visible": False}, "num_font": {"size": 10}})
    chart.set_y_axis({"min": 0, "max": 1, "num_format": "0%", "major_gridlines": GRID, "num_font": {"size": 10}})
    return chart


def _tornado(book: Book, sheet: Any, choice: Choice) -> Any:
    """Return what each dimension does between its limits, the greatest share of the variance on top."""
    quiet, plain = book.format("quiet"), book.format("text", "general")
    for offset, text in enumerate(("dimension (share of variance)", "at lower limit", "at upper limit")):
        sheet.write_string(_CAUSE_ROW - 1, _BINS + offset, text, quiet)
    shown = IF(choice.known, 1.0, 0.0)
    for number in range(1, CAUSES + 1):
        row = _CAUSE_ROW + number - 1
        name = choice.text(f"Cause {number}")
        low, high = choice.angle(f"Low {number}"), choice.angle(f"High {number}")
        share = choice.text(f"Share {number}")
        given = name.equals("")
        percent = FIXED(IF(given, 0.0, share * 100.0), 0)
        put(sheet, row, _BINS, IF(given, "", CONCATENATE(name, " (", percent, " %)")), plain)
        half = (high - low) / 2
        put(sheet, row, _BINS + 1, IF(given, 0.0, live(0.0) - half * shown), plain)
        put(sheet, row, _BINS + 2, IF(given, 0.0, half * shown), plain)
    last = _CAUSE_ROW + CAUSES - 1
    chart = book.chart("bar", "Tornado: change between a dimension's limits")
    for offset, label, colour in ((1, "at its lower limit", "sky"), (2, "at its upper limit", "blue")):
        chart.add_series({
            "name": label,
            "categories": ["Explorer", _CAUSE_ROW, _BINS, last, _BINS],
            "values": ["Explorer", _CAUSE_ROW, _BINS + offset, last, _BINS + offset],
            "fill": {"color": PALETTE[colour]},
            "border": OUTLINE,
            "overlap": 100,
            "gap": 40,
        })  # fmt: skip
    chart.set_x_axis({"num_format": "0.000", "major_gridlines": GRID, "num_font": {"size": 10}})
    chart.set_y_axis({"reverse": True, "label_position": "low", "num_font": {"size": 10}})
    return chart


def _segments(book: Book, sheet: Any, choice: Choice) -> Any:
    """Return one bar of the segments from the open end to the hub."""
    quiet, plain = book.format("quiet"), book.format("text", "general")
    chart = book.chart("bar", "Where the nominal backlash arises", subtype="stacked")
    sheet.write_string(_SEGMENT_ROW, _BINS, "nominal", quiet)
    for offset, (segment, colour) in enumerate(zip(SEGMENTS.values(), _COLOURS, strict=True), start=1):
        value = put(sheet, _SEGMENT_ROW, _BINS + offset, IF(choice.known, choice.angle(segment), 0.0), plain)
        put(sheet, _SEGMENT_ROW - 1, _BINS + offset, CONCATENATE(f"{segment} ", FIXED(value, 2)), quiet)
        chart.add_series({
            "name": ["Explorer", _SEGMENT_ROW - 1, _BINS + offset],
            "categories": ["Explorer", _SEGMENT_ROW, _BINS, _SEGMENT_ROW, _BINS],
            "values": ["Explorer", _SEGMENT_ROW, _BINS + offset, _SEGMENT_ROW, _BINS + offset],
            "fill": {"color": PALETTE[colour]},
            "border": OUTLINE,
            "gap": 60,
        })  # fmt: skip
    chart.set_x_axis({"num_format": "0.0", "major_gridlines": GRID, "num_font": {"size": 10}})
    chart.set_y_axis({"visible": False})
    return chart
