"""The Sensitivity sheet: which dimension causes the spread, and what each does between its limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexlash.columns import DIMENSIONS
from flexlash.outcome import Outcome
from flexlash.report.selection import Drawn
from flexlash.report.styles import GRID, PALETTE, Book
from flexlash.summary import dimension_words
from flexlash.units import ARCMIN

__all__ = ["write_sensitivity"]

_TORNADO_ROWS = len(DIMENSIONS)
_HEADER = 5 + max(_TORNADO_ROWS, 20)


def write_sensitivity(book: Book, outcome: Outcome, drawn: Sequence[Drawn]) -> None:
    """Write the tornado of the worst variant above the shares of all variants."""
    sheet = book.sheet("Sensitivity")
    sheet.write_string(0, 0, "What causes the spread", book.format("title"))
    sheet.set_row(0, 28)
    sheet.set_column(0, 0, 26)
    sheet.set_column(1, 2 * len(DIMENSIONS) + 2, 12)
    if drawn:
        _write_tornado(book, sheet, drawn[0])
    _write_shares(book, sheet, outcome)


def _write_tornado(book: Book, sheet: Any, worst: Drawn) -> None:
    """Write and draw how far each dimension moves the backlash between its limits, the others in the middle."""
    variation = worst.computed.variation
    if variation is None or not variation.swings:
        return
    name = worst.row["variant"]
    text = f"Worst variant, {name}: backlash [arcmin] with one dimension at its limits, by its share of variance."
    sheet.write_string(1, 0, text, book.format("quiet"))
    headings = ("Dimension", "At lower limit", "At upper limit", "Share of variance", "Share with interactions")
    for place, heading in enumerate(headings):
        sheet.write_string(3, place, heading, book.format("header"))
    sheet.set_row(3, 32)
    swings = sorted(variation.swings.items(), key=lambda item: -variation.shares[item[0]])
    for row, (dimension, (low, high)) in enumerate(swings, start=4):
        sheet.write_string(row, 0, dimension_words(dimension), book.format("text"))
        sheet.write_number(row, 1, low / ARCMIN, book.format("text", "arcmin"))
        sheet.write_number(row, 2, high / ARCMIN, book.format("text", "arcmin"))
        sheet.write_number(row, 3, variation.shares[dimension], book.format("text", "share"))
        sheet.write_number(row, 4, variation.totals[dimension], book.format("text", "share"))
    last = 3 + len(swings)
    middle = sum(swings[0][1]) / 2 / ARCMIN
    chart = book.chart("bar", f"Tornado of {name} [arcmin]")
    for place, label, colour in (
        (1, "at the lower limit", PALETTE["sky"]),
        (2, "at the upper limit", PALETTE["blue"]),
    ):
        chart.add_series({
            "name": label,
            "categories": ["Sensitivity", 4, 0, last, 0],
            "values": ["Sensitivity", 4, place, last, place],
            "fill": {"color": colour},
            "overlap": 100,
            "gap": 40,
        })  # fmt: skip
    chart.set_x_axis({"crossing": middle, "num_format": "0.000", "major_gridlines": GRID})
    chart.set_y_axis({"reverse": True, "crossing": "min", "label_position": "low"})
    book.insert(sheet, 3, 6, chart, size=(700, 400), text="Tornado chart of the worst variant")


def _write_shares(book: Book, sheet: Any, outcome: Outcome) -> None:
    """Write the first-order shares of variance of every variant, one column per dimension that varies."""
    rows = [one for one in outcome.computed.values() if one.variation is not None]
    names = [name for name in DIMENSIONS if any(name in one.variation.shares for one in rows if one.variation)]
    right = len(names) + 1
    text = (
        "Share of each dimension in the variance of the backlash (first-order Sobol' index); what is missing to "
        "100 % is interaction. Total indices, interactions included, follow to the right."
    )
    sheet.write_string(_HEADER - 1, 0, text, book.format("quiet"))
    sheet.write_string(_HEADER, 0, "Variant", book.format("header"))
    for place, name in enumerate(names, start=1):
        sheet.write_string(_HEADER, place, dimension_words(name), book.format("header"))
        sheet.write_string(_HEADER, place + right, f"{dimension_words(name)}, total", book.format("header"))
    sheet.set_row(_HEADER, 48)
    for row, one in enumerate(rows, start=_HEADER + 1):
        sheet.write_string(row, 0, one.variant.name, book.format("text"))
        shares = one.variation.shares if one.variation else {}
        totals = one.variation.totals if one.variation else {}
        for place, name in enumerate(names, start=1):
            if name in shares:
                sheet.write_number(row, place, shares[name], book.format("text", "share"))
                sheet.write_number(row, place + right, totals[name], book.format("text", "share"))
    if rows and names:
        scale = {
            "type": "2_color_scale",
            "min_color": "#FFFFFF",
            "max_color": PALETTE["orange"],
            "min_type": "num",
            "min_value": 0,
            "max_type": "num",
            "max_value": 1,
        }
        sheet.conditional_format(_HEADER + 1, 1, _HEADER + len(rows), len(names), scale)
        sheet.conditional_format(_HEADER + 1, right + 1, _HEADER + len(rows), right + len(names), scale)
