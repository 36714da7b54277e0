"""The Spread sheet: one variant picked by drop-down, its density and its cumulative curve.

The curves of all drawn variants stand in Curves, worst first; plain formulas look up the picked one, and
each is stored with its value.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from flexlash.report.selection import DRAWN, Drawn
from flexlash.report.styles import GRID, PALETTE, Book
from flexlash.summary import share_words
from flexlash.tolerance.variation import CURVE_PROBABILITIES, HISTOGRAM_BINS
from flexlash.units import ARCMIN

__all__ = ["write_curves", "write_spread"]

_FIXED = ("Variant", "P2.5", "P2.5 to P97.5", "P50", "Limit", "Mean", "sd", "Bin start", "Bin width")
_CURVE = len(_FIXED)
_BARS = _CURVE + len(CURVE_PROBABILITIES)
_FIGURES = (("Limit", 4), ("Mean", 5), ("Standard deviation", 6), ("P2.5", 1), ("P50", 3))
_HELPER = 14


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
    sheet.set_column(0, 0, 24)
    for row, one in enumerate(drawn, start=2):
        sheet.write_string(row, 0, one.row["variant"], book.format("text"))
        for place, value in enumerate(_numbers(one), start=1):
            if value is not None:
                sheet.write_number(row, place, value, book.format("text", "general"))
    sheet.freeze_panes(2, 1)
    sheet.repeat_rows(0, 1)
    sheet.print_area(0, 0, max(2, len(drawn) + 1), len(_FIXED) - 1)


def _numbers(one: Drawn) -> list[float | None]:
    """Return a variant's row of Curves after its name."""
    row, variation = one.row, one.computed.variation
    numbers = [
        row["p2_5_arcmin"],
        row["p97_5_arcmin"] - row["p2_5_arcmin"],
        row["p50_arcmin"],
        row["backlash_limit_arcmin"],
        row["mean_arcmin"],
        row["sd_arcmin"],
    ]
    if variation is None or variation.curve is None or variation.edges is None or variation.heights is None:
        return [*numbers, row["mean_arcmin"], 0.0, *([row["mean_arcmin"]] * len(CURVE_PROBABILITIES)), 1.0]
    edges = variation.edges / ARCMIN
    curve = variation.curve / ARCMIN
    return [
        *numbers,
        float(edges[0]),
        float(edges[1] - edges[0]),
        *curve.tolist(),
        *variation.heights.tolist(),
    ]


def write_spread(book: Book, drawn: Sequence[Drawn], total: int) -> None:
    """Write the Spread sheet with the worst variant picked."""
    sheet = book.sheet("Spread", landscape=False, pages_tall=1)
    sheet.write_string(0, 0, "Spread of one variant", book.format("title"))
    sheet.set_row(0, 28)
    sheet.set_column(0, 0, 26)
    sheet.set_column(1, 1, 26)
    sheet.set_column(2, _HELPER - 2, 9)
    if not drawn:
        return
    first, last = 3, len(drawn) + 2
    numbers = _numbers(drawn[0])
    sheet.write_string(2, 0, "Pick a variant", book.format("label"))
    sheet.write_string(2, 1, drawn[0].row["variant"], book.format("input"))
    sheet.data_validation(2, 1, 2, 1, {
        "validate": "list",
        "source": f"=Curves!$A${first}:$A${last}",
        "input_title": "Variant",
        "input_message": "The figures and both charts follow.",
        "error_title": "Variant",
        "error_message": "Pick a variant of the list.",
    })  # fmt: skip
    sheet.write_formula(2, 2, f"=MATCH($B$3,Curves!$A${first}:$A${last},0)", book.format("quiet"), 1)
    sheet.write_string(2, 3, "◄ its place in the list, worst first", book.format("quiet"))
    for row, (label, place) in enumerate(_FIGURES, start=3):
        sheet.write_string(row, 0, f"{label} [arcmin]", book.format("label"))
        value = numbers[place - 1]
        formula = _look_up(place, first, last)
        shown = f'=IF({formula[1:]}="","none",{formula[1:]})' if label == "Limit" else formula
        sheet.write_formula(row, 1, shown, book.format("text", "arcmin"), "none" if value is None else value)
    worst = drawn[0].row
    if worst["probability_over_limit"] is not None:
        note = f"{worst['variant']}: {share_words(worst)} of its units are over the limit."
        sheet.write_string(8, 0, note, book.format("quiet"))
    if len(drawn) < total:
        note = f"The {DRAWN} variants of greatest probability over limit can be picked; all are in Results."
        sheet.write_string(9, 0, note, book.format("quiet"))
    _write_helper(book, sheet, numbers, first, last)
    _write_charts(book, sheet)
    sheet.print_area(0, 0, 46, _HELPER - 3)


def _look_up(place: int, first: int, last: int) -> str:
    """Return the formula of a Curves column for the picked variant."""
    letter = xl_col_to_name(place)
    return f"=INDEX(Curves!${letter}${first}:${letter}${last},$C$3)"


def _write_helper(book: Book, sheet: Any, numbers: list[float | None], first: int, last: int) -> None:
    """Write the data of both charts, to the right of the printed page."""
    quiet, plain = book.format("quiet"), book.format("text", "general")
    headings = (
        "Bin middle",
        "Share within",
        "Share over limit",
        "",
        "Backlash",
        "Share below",
        "",
        "Limit",
        "Share",
    )
    for offset, heading in enumerate(headings):
        sheet.write_string(1, _HELPER + offset, heading, quiet)
    start, width, limit = (
        numbers[_FIXED.index("Bin start") - 1],
        numbers[_FIXED.index("Bin width") - 1],
        numbers[3],
    )
    heights = numbers[_BARS - 1 :]
    letters = [xl_col_to_name(_HELPER + offset) for offset in range(9)]
    start_formula, width_formula = (
        _look_up(_FIXED.index(name), first, last)[1:] for name in ("Bin start", "Bin width")
    )
    for number in range(HISTOGRAM_BINS):
        row = 2 + number
        middle = (start or 0.0) + (number + 0.5) * (width or 0.0)
        height = (heights[number] if number < len(heights) else 0.0) or 0.0
        over = limit is not None and middle > limit
        sheet.write_formula(row, _HELPER, f"={start_formula}+{number + 0.5}*{width_formula}", plain, middle)
        bar = _look_up(_BARS + number, first, last)[1:]
        at = f"${letters[0]}{row + 1}"
        is_over = f"AND(ISNUMBER($B$4),{at}>N($B$4))"
        sheet.write_formula(row, _HELPER + 1, f"=IF({is_over},0,{bar})", plain, 0 if over else height)
        sheet.write_formula(row, _HELPER + 2, f"=IF({is_over},{bar},0)", plain, height if over else 0)
    for offset, share in enumerate(CURVE_PROBABILITIES):
        value = numbers[_CURVE + offset - 1]
        sheet.write_formula(2 + offset, _HELPER + 4, _look_up(_CURVE + offset, first, last), plain, value)
        sheet.write_number(2 + offset, _HELPER + 5, share, plain)
    given = limit is not None
    line = limit if given else numbers[2]
    for row, share in ((2, 0), (3, 1)):
        sheet.write_formula(row, _HELPER + 7, "=IF(ISNUMBER($B$4),$B$4,$B$8)", plain, line)
        sheet.write_formula(row, _HELPER + 8, f"=IF(ISNUMBER($B$4),{share},0)", plain, share if given else 0)


def _write_charts(book: Book, sheet: Any) -> None:
    """Draw both charts below the figures."""
    size = (1020, 345)
    book.insert(sheet, 10, 0, _density(book), size=size, text="Density of the picked variant")
    book.insert(sheet, 28, 0, _cumulative(book), size=size, text="Cumulative curve of the picked variant")


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
    labels = {"num_format": "0.000", "num_font": {"rotation": -45}, "interval_unit": 4}
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
