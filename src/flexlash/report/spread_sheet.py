"""The Spread sheet: one variant picked by drop-down, its density and its cumulative curve.

The curves of all drawn variants stand in Curves, worst first; plain formulas look up the picked one, and
each is stored with its value.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from flexlash.findings import shown
from flexlash.report.selection import Drawn
from flexlash.report.styles import GRID, PALETTE, Book
from flexlash.summary import share_words
from flexlash.tolerance.variation import CURVE_PROBABILITIES, HISTOGRAM_BINS
from flexlash.units import ARCMIN

__all__ = ["curve_place", "write_curves", "write_spread"]

_FIXED = (
    "Variant", "Label", "Over limit", "P2.5", "P2.5 to P97.5", "P50", "Limit", "Mean", "sd", "P97.5", "P99.865", "Ppk",
    "Bin start", "Bin width",
)  # fmt: skip
_LABEL = 24
"""Most characters of a name under a chart."""

_CURVE = len(_FIXED)
_BARS = _CURVE + len(CURVE_PROBABILITIES)
_FIGURES = (
    ("Limit [arcmin]", "Limit"),
    ("Mean [arcmin]", "Mean"),
    ("Standard deviation [arcmin]", "sd"),
    ("P2.5 [arcmin]", "P2.5"),
    ("P50 [arcmin]", "P50"),
    ("P97.5 [arcmin]", "P97.5"),
    ("P99.865 [arcmin]", "P99.865"),
    ("Ppk upper", "Ppk"),
    ("Units over the limit", "Over limit"),
)
_OPTIONAL = {"Limit", "Ppk", "Over limit"}
_FIRST_FIGURE = 3
_FIRST_CHART = 13
_HELPER = 14
_LIMIT, _MEDIAN = "$B$4", "$B$8"


def curve_place(heading: str) -> int:
    """Return the place of a column of Curves, from 0."""
    return _FIXED.index(heading)


def write_curves(book: Book, drawn: Sequence[Drawn]) -> None:
    """Write the Curves sheet: one row per drawn variant, in arcmin; heights are shares of all units."""
    sheet = book.sheet("Curves")
    headings = [*_FIXED, *(f"P{100 * share:g}" for share in CURVE_PROBABILITIES)]
    headings += [f"Bin {number}" for number in range(1, HISTOGRAM_BINS + 1)]
    sheet.write_string(
        0, 0, "Stored curves behind the charts [arcmin]; bins are shares of all units.", book.format("quiet")
    )
    for place, heading in enumerate(headings):
        sheet.write_string(1, place, heading, book.format("header"))
    sheet.set_column(0, 2, 24)
    for row, one in enumerate(drawn, start=2):
        for place, value in enumerate(_stored(one)):
            if isinstance(value, str):
                sheet.write_string(row, place, value, book.format("text"))
            elif value is not None:
                sheet.write_number(row, place, value, book.format("text", "general"))
    sheet.freeze_panes(2, 1)
    sheet.repeat_rows(0, 1)
    sheet.print_area(0, 0, max(2, len(drawn) + 1), len(_FIXED) - 1)


def _stored(one: Drawn) -> list[str | float | None]:
    """Return a variant's row of Curves."""
    row, variation = one.row, one.computed.variation
    name, limit = row["variant"], row["backlash_limit_arcmin"]
    stored = [
        name,
        shown(name, longest=_LABEL),
        None if limit is None else share_words(row),
        row["p2_5_arcmin"],
        row["p97_5_arcmin"] - row["p2_5_arcmin"],
        row["p50_arcmin"],
        limit,
        row["mean_arcmin"],
        row["sd_arcmin"],
        row["p97_5_arcmin"],
        row["p99_865_arcmin"],
        row["ppk"],
    ]
    if variation is None or variation.curve is None or variation.edges is None or variation.heights is None:
        return [*stored, row["mean_arcmin"], 0.0, *([row["mean_arcmin"]] * len(CURVE_PROBABILITIES)), 1.0]
    edges, curve = variation.edges / ARCMIN, variation.curve / ARCMIN
    return [*stored, float(edges[0]), float(edges[1] - edges[0]), *curve.tolist(), *variation.heights.tolist()]


def write_spread(book: Book, drawn: Sequence[Drawn], total: int) -> None:
    """Write the Spread sheet with the worst variant picked."""
    sheet = book.sheet("Spread", landscape=False, pages_tall=1)
    sheet.write_string(0, 0, "Spread of one variant", book.format("title"))
    sheet.set_row(0, 28)
    sheet.set_column(0, 0, 26)
    sheet.set_column(1, 1, 38)
    sheet.set_column(2, _HELPER - 2, 9)
    if not drawn:
        return
    first, last = 3, len(drawn) + 2
    stored = _stored(drawn[0])
    names = f"Curves!$A${first}:$A${last}"
    sheet.write_string(2, 0, "Pick a variant", book.format("label"))
    sheet.write_string(2, 1, drawn[0].row["variant"], book.format("input"))
    sheet.data_validation(2, 1, 2, 1, {
        "validate": "list",
        "source": f"={names}",
        "input_title": "Variant",
        "input_message": "The figures and both charts follow.",
        "error_title": "Variant",
        "error_message": "Pick a variant of the list.",
    })  # fmt: skip
    # EXACT, since MATCH by itself ignores letter case and takes * and ? in a name for any letters.
    place = f'=MATCH(TRUE,INDEX(EXACT({names},$B$3&""),0),0)'
    sheet.write_formula(2, 2, place, book.format("quiet"), 1)
    sheet.write_string(2, 3, "◄ its place in the list, worst first", book.format("quiet"))
    for row, (label, name) in enumerate(_FIGURES, start=_FIRST_FIGURE):
        column = _FIXED.index(name)
        sheet.write_string(row, 0, label, book.format("label"))
        formula = _look_up(column, first, last)
        if name in _OPTIONAL:
            formula = f'=IF({formula[1:]}="","none",{formula[1:]})'
        value = "none" if stored[column] is None else stored[column]
        style = book.format("figure", "" if name == "Over limit" else "plain" if name == "Ppk" else "arcmin")
        sheet.write_formula(row, 1, formula, style, value)
    if len(drawn) < total:
        note = f"The {len(drawn)} variants of greatest probability over limit can be picked; all are in Results."
        sheet.write_string(_FIRST_CHART - 1, 0, note, book.format("quiet"))
    _write_helper(book, sheet, stored, first, last)
    _write_charts(book, sheet)
    sheet.print_area(0, 0, 50, _HELPER - 3)


def _look_up(place: int, first: int, last: int) -> str:
    """Return the formula of a Curves column for the picked variant."""
    letter = xl_col_to_name(place)
    return f"=INDEX(Curves!${letter}${first}:${letter}${last},$C$3)"


def _write_helper(book: Book, sheet: Any, stored: list[str | float | None], first: int, last: int) -> None:
    """Write the data of both charts, to the right of the printed page."""
    quiet = book.format("quiet")
    headings = ("Bin middle", "Share within", "Share over limit", "", "Backlash", "Share below", "", "Limit", "Share")
    for offset, heading in enumerate(headings):
        sheet.write_string(1, _HELPER + offset, heading, quiet)
    numbers = [value if isinstance(value, float) else None for value in stored]
    _write_bins(book, sheet, numbers, first, last)
    plain = book.format("text", "general")
    for offset, share in enumerate(CURVE_PROBABILITIES):
        value = numbers[_CURVE + offset]
        sheet.write_formula(2 + offset, _HELPER + 4, _look_up(_CURVE + offset, first, last), plain, value)
        sheet.write_number(2 + offset, _HELPER + 5, share, plain)
    limit, median = numbers[_FIXED.index("Limit")], numbers[_FIXED.index("P50")]
    given = limit is not None
    line = limit if given else median
    for row, share in ((2, 0), (3, 1)):
        sheet.write_formula(row, _HELPER + 7, f"=IF(ISNUMBER({_LIMIT}),{_LIMIT},{_MEDIAN})", plain, line)
        sheet.write_formula(row, _HELPER + 8, f"=IF(ISNUMBER({_LIMIT}),{share},0)", plain, share if given else 0)


def _write_bins(book: Book, sheet: Any, numbers: list[float | None], first: int, last: int) -> None:
    """Write middle and height of each bin, its height in the column of its side of the limit."""
    plain = book.format("text", "general")
    places = [_FIXED.index(name) for name in ("Bin start", "Bin width", "Limit")]
    start, width, limit = (numbers[place] for place in places)
    start_formula, width_formula = (_look_up(place, first, last)[1:] for place in places[:2])
    heights = numbers[_BARS:]
    letter = xl_col_to_name(_HELPER)
    for number in range(HISTOGRAM_BINS):
        row = 2 + number
        middle = (start or 0.0) + (number + 0.5) * (width or 0.0)
        height = (heights[number] if number < len(heights) else 0.0) or 0.0
        over = limit is not None and middle > limit
        sheet.write_formula(row, _HELPER, f"={start_formula}+{number + 0.5}*{width_formula}", plain, middle)
        bar = _look_up(_BARS + number, first, last)[1:]
        is_over = f"AND(ISNUMBER({_LIMIT}),${letter}{row + 1}>N({_LIMIT}))"
        sheet.write_formula(row, _HELPER + 1, f"=IF({is_over},0,{bar})", plain, 0 if over else height)
        sheet.write_formula(row, _HELPER + 2, f"=IF({is_over},{bar},0)", plain, height if over else 0)


def _write_charts(book: Book, sheet: Any) -> None:
    """Draw both charts below the figures."""
    size = (1020, 345)
    book.insert(sheet, _FIRST_CHART, 0, _density(book), size=size, text="Density of the picked variant")
    book.insert(
        sheet, _FIRST_CHART + 18, 0, _cumulative(book), size=size, text="Cumulative curve of the picked variant"
    )


def _density(book: Book) -> Any:
    """Return the histogram, coloured beyond the limit."""
    last = HISTOGRAM_BINS + 1
    chart = book.chart("column", "Density: share of units per bin", subtype="stacked")
    for offset, name, colour in ((1, "within the limit", "blue"), (2, "over the limit", "red")):
        chart.add_series({
            "name": name,
            "categories": ["Spread", 2, _HELPER, last, _HELPER],
            "values": ["Spread", 2, _HELPER + offset, last, _HELPER + offset],
            "fill": {"color": PALETTE[colour]},
            "border": {"none": True},
            "gap": 4,
        })  # fmt: skip
    labels = {"num_format": "0.00", "num_font": {"rotation": -45}, "interval_unit": 5}
    chart.set_x_axis({"name": "Backlash [arcmin]", **labels})
    chart.set_y_axis({"num_format": "0%", "major_gridlines": GRID})
    return chart


def _cumulative(book: Book) -> Any:
    """Return the cumulative curve with the limit as a line."""
    chart = book.chart("scatter", "Share of units below a backlash", subtype="straight")
    curve = {"color": PALETTE["blue"], "width": 2.25}
    limit = {"color": PALETTE["red"], "width": 1.5, "dash_type": "dash"}
    for name, offset, last, line in (
        ("share below", 4, len(CURVE_PROBABILITIES) + 1, curve),
        ("limit", 7, 3, limit),
    ):
        chart.add_series({
            "name": name,
            "categories": ["Spread", 2, _HELPER + offset, last, _HELPER + offset],
            "values": ["Spread", 2, _HELPER + offset + 1, last, _HELPER + offset + 1],
            "line": line,
        })  # fmt: skip
    chart.set_x_axis({"name": "Backlash [arcmin]", "num_format": "0.00", "major_gridlines": {"visible": False}})
    chart.set_y_axis({"min": 0, "max": 1, "num_format": "0%", "major_gridlines": GRID})
    return chart
