"""The Sensitivity sheet: which dimension causes the spread, and what each does between its limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.report.extent import extent_of
from flexlash.report.layout.paper import SMALL, fits, print_readably
from flexlash.report.layout.result_formats import SHARE_OF_VARIANCE_ERROR
from flexlash.report.layout.styles import GRID, OUTLINE, PALETTE, Book, percent_of
from flexlash.report.report_data import Drawn
from flexlash.report.results_sheet import SHARE_DECIMALS
from flexlash.report.wording.chart_words import largest_of
from flexlash.report.wording.correlation_words import shared_out
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import shown
from flexlash.schema.units import ARCMIN
from flexlash.tolerance.spread_statistics import SpreadStatistics

__all__ = ["write_sensitivity"]

_NAME = 30
_TORNADO_ROWS = len(DIMENSIONS)
_HEADER = 5 + max(_TORNADO_ROWS, 20)
_CHART_PLACE, _CHART_WIDTH, _CHART_HEIGHT = 6, 780, 410
_NAME_WIDTH, _WIDTH, _GAP = 28.0, 9.7, 3.0
_PIXELS = 73
"""Width of a share's column."""


def write_sensitivity(book: Book, outcome: Outcome, drawn: Sequence[Drawn]) -> None:
    """Write the tornado of the worst variant above the shares of all variants, or of those drawn of many."""
    extent = extent_of(outcome)
    sheet = book.sheet("Sensitivity")
    sheet.write_string(0, 0, "What causes the spread", book.format("title"))
    sheet.set_row(0, 28)
    sheet.set_column(0, 0, _NAME_WIDTH)
    sheet.set_column(1, 2 * len(DIMENSIONS) + 2, _WIDTH)
    variants = [variant.computed for variant in drawn] if extent.large else outcome.computed.values()
    rows = [(computed.variant.name, computed.spread) for computed in variants if computed.spread is not None]
    if extent.large and extent.note:
        sheet.write_string(2, 0, extent.note, book.format("quiet"))
    names = [name for name in DIMENSIONS if any(name in spread.shares for _, spread in rows)]
    widths = [_NAME_WIDTH, *[_WIDTH] * len(names), _GAP, *[_WIDTH] * len(names)]
    totals = len(names) + 2
    if drawn:
        apart = not fits(widths, SMALL)
        width = min(_CHART_WIDTH, _PIXELS * (totals - 1 - _CHART_PLACE)) if apart else _CHART_WIDTH
        _write_tornado(book, sheet, drawn[0], width)
    coupled = shared_out(outcome.computed)
    _write_shares(book, sheet, rows, names, " " * bool(coupled) + coupled)
    sheet.set_column(totals - 1, totals - 1, _GAP)
    print_readably(sheet, widths, breaks=[totals], least=SMALL)
    sheet.repeat_rows(_HEADER)
    sheet.freeze_panes(0, 1)


def _write_tornado(book: Book, sheet: Any, worst: Drawn, width: int) -> None:
    """Write and draw how far each dimension moves the backlash between its limits, the others in the middle."""
    spread = worst.computed.spread
    if spread is None or not spread.swings:
        return
    name = shown(worst.row["variant"], longest=_NAME)
    unit = book.angles.name
    text = f"Worst variant, {name}: backlash [{unit}] with one dimension at its limits, by its share of variance."
    sheet.write_string(1, 0, text, book.format("quiet"))
    headings = ("Dimension", "At lower limit", "At upper limit", "Share of variance", "Share with interactions")
    sheet.write_row(3, 0, headings, book.format("header"))
    sheet.set_row(3, 32)
    share = book.format("text", percent_of(SHARE_OF_VARIANCE_ERROR))
    swings = sorted(spread.swings.items(), key=lambda item: -spread.shares[item[0]])
    for row, (dimension, (low, high)) in enumerate(swings, start=4):
        sheet.write_string(row, 0, dimension_words(dimension), book.format("text"))
        book.write_figure(sheet, row, 1, low / ARCMIN, "angle")
        book.write_figure(sheet, row, 2, high / ARCMIN, "angle")
        sheet.write_number(row, 3, spread.shares[dimension], share)
        sheet.write_number(row, 4, spread.total_shares[dimension], share)
    chart = _tornado(book, name, 3 + len(swings), book.angles.of_radians(sum(swings[0][1]) / 2))
    size, text = (width, _CHART_HEIGHT), _tornado_words(name, spread, book.angles)
    book.insert(sheet, 3, _CHART_PLACE, chart, size=size, text=text)


def _tornado_words(name: str, spread: SpreadStatistics, angles: AngleUnit) -> str:
    """Return the alternative text of the tornado."""
    widths = {dimension_words(key): angles.of_radians(abs(high - low)) for key, (low, high) in spread.swings.items()}
    moved = f"between its limits a dimension moves the backlash by {largest_of(widths, angles.sign)}"
    return f"Tornado of the worst variant, {name}: {moved}"


def _tornado(book: Book, name: str, last: int, middle: float) -> Any:
    """Return the tornado; both bars of a dimension start at the middle."""
    chart = book.chart("bar", f"Tornado of {name} [{book.angles.name}]")
    for column, label, colour in (
        (1, "at the lower limit", PALETTE["sky"]),
        (2, "at the upper limit", PALETTE["blue"]),
    ):
        chart.add_series({
            "name": label,
            "categories": ["Sensitivity", 4, 0, last, 0],
            "values": ["Sensitivity", 4, column, last, column],
            "fill": {"color": colour},
            "border": OUTLINE,
            "overlap": 100,
            "gap": 40,
        })  # fmt: skip
    chart.set_x_axis({"crossing": middle, "num_format": book.angles.decimals(3), "major_gridlines": GRID})
    # Every bar has its label: at its own choice Excel leaves out each second one of many.
    labels = {"label_position": "low", "interval_unit": 1, "num_font": {"size": 9}}
    chart.set_y_axis({"reverse": True, "crossing": "min", **labels})
    return chart


def _write_shares(
    book: Book, sheet: Any, rows: Sequence[tuple[str, SpreadStatistics]], names: Sequence[str], further: str
) -> None:
    """Write the shares of variance of every computed variant, one column per dimension that varies, to be filtered.

    `further` is what the note on them adds.
    """
    right = len(names) + 1
    text = (
        "Share of each dimension in the variance of the backlash (first-order Sobol' index); what is missing to "
        f"100 % is interaction. Total indices, interactions included, follow to the right.{further}"
    )
    sheet.write_string(_HEADER - 1, 0, text, book.format("quiet"))
    sheet.write_string(_HEADER, 0, "Variant", book.format("header"))
    for column, name in enumerate(names, start=1):
        sheet.write_string(_HEADER, column, dimension_words(name), book.format("header"))
        sheet.write_string(_HEADER, column + right, f"{dimension_words(name)}, total", book.format("header"))
    sheet.set_row(_HEADER, 48)
    plain, share = book.format("text"), book.format("text", percent_of(SHARE_OF_VARIANCE_ERROR))
    for row, (variant, spread) in enumerate(rows, start=_HEADER + 1):
        sheet.write_string(row, 0, variant, plain)
        for start, indices in ((1, spread.shares), (1 + right, spread.total_shares)):
            for column, name in enumerate(names, start=start):
                if name in indices:
                    sheet.write_number(row, column, round(indices[name], SHARE_DECIMALS), share)
    if rows and names:
        last = _HEADER + len(rows)
        sheet.autofilter(_HEADER, 0, last, right + len(names))
        for start in (1, right + 1):
            sheet.conditional_format(_HEADER + 1, start, last, start + len(names) - 1, _scale())


def _scale() -> dict[str, Any]:
    """Return the rule that colours a share the stronger the greater it is."""
    ends = {"min_type": "num", "min_value": 0, "max_type": "num", "max_value": 1}
    return {"type": "2_color_scale", "min_color": "#FFFFFF", "max_color": PALETTE["orange"], **ends}
