"""The Contributions sheet: which tolerance hurts which variant, as a heat map, and how much the disk winds up."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.report.compare.causes import (
    Cause,
    cause_sentences,
    causes_of,
    causes_of_drawn,
    left_out,
    mean_share,
    ranked_dimensions,
)
from flexlash.report.compare.compared import CONNECTED, share_heading
from flexlash.report.extent import extent_of
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.axes import axis_over
from flexlash.report.layout.styles import GRID, PALETTE, Book
from flexlash.report.report_data import Drawn
from flexlash.report.wording.chart_words import named_shares
from flexlash.report.wording.correlation_words import shared_out
from flexlash.report.wording.labels import distinct_labels
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.findings import shown

__all__ = ["MAPPED", "write_contributions"]

MAPPED = 27
"""Most variants that the heat map can hold and still be read."""

_LABEL_WIDTH = 160
_RIGHT_WIDTHS = (65, 70, 156, 90)
"""Widths [px] of the dimensions' names and of the columns over all variants."""

_NARROW, _WIDE = 32, 70
"""Least and greatest width [px] of a variant's column."""

_SPARE = 64
"""Width [px] of the columns that fill up the page."""

_PAGE = 1000
"""Least width [px] of the page."""

_ROW_HEIGHT = 20
_NAME, _SHORT = 30, 22
_MARKERS = {"cup": ("circle", "blue"), "hat": ("diamond", "orange")}
_CROWDED = 60
"""Points of a chart beyond which they are drawn small."""


def write_contributions(book: Book, outcome: Outcome, drawn: Sequence[Drawn], compared: Stored) -> None:
    """Write the Contributions sheet: sentences, heat map and, where there are disks, their chart."""
    sheet = book.sheet("Contributions", pages_tall=1)
    sheet.write_string(0, 0, "Which tolerance hurts everywhere, which only here", book.format("title"))
    sheet.set_row(0, 28)
    if not drawn:
        return
    widths = _widths(min(len(drawn), MAPPED))
    for column, pixels in enumerate(widths):
        sheet.set_column_pixels(column, column, pixels)
    extent = extent_of(outcome)
    causes = causes_of_drawn(drawn) if extent.large else causes_of(outcome)
    row = 1
    if extent.large and extent.note:
        sheet.write_string(row, 0, extent.note, book.format("quiet"))
        row += 1
    for sentence in cause_sentences(causes):
        sheet.write_string(row, 0, f"•  {sentence}", book.format("text"))
        row += 1
    if causes:
        row = _write_heat(book, sheet, causes, drawn, row + 1)
        for note in _notes(causes, drawn, shared_out(outcome.computed)):
            sheet.write_string(row, 0, note, book.format("quiet"))
            row += 1
    if any(variant.computed.variant.flexspline_type in CONNECTED for variant in drawn):
        width = max(_PAGE, sum(widths))
        height = width // 3
        chart = _disk_shares(book, compared, width / _PAGE)
        text = "Disk share of the wind-up of each cup and hat against its cylinder length over its mean radius"
        text += f": {named_shares(drawn, 'disk_share')}"
        book.insert(sheet, row + 1, 0, chart, size=(6 * width // 10, height), text=text)
        row += height // _ROW_HEIGHT + 2
    sheet.print_area(0, 0, row, len(widths) - 1)


def _widths(count: int) -> list[int]:
    """Return the widths [px] of the page's columns for so many variants."""
    fixed = _LABEL_WIDTH + sum(_RIGHT_WIDTHS)
    each = min(_WIDE, max(_NARROW, (_PAGE - fixed) // count))
    spare = max(0, -(-(_PAGE - fixed - count * each) // _SPARE))
    return [_LABEL_WIDTH, *[each] * count, *_RIGHT_WIDTHS, *[_SPARE] * spare]


def _write_heat(book: Book, sheet: Any, causes: Sequence[Cause], drawn: Sequence[Drawn], top: int) -> int:
    """Write the heat map of the worst variants below its headings in row `top`; return the row after it."""
    mapped = drawn[:MAPPED]
    right = 1 + len(mapped)
    sheet.write_string(top, 0, "Share of variance", book.format("header"))
    labels = distinct_labels([variant.row["variant"] for variant in mapped], _NAME)
    for column, label in enumerate(labels, start=1):
        sheet.write_string(top, column, label, book.format("turned"))
    every = f"of all {len(causes):,}"
    headings = (f"Mean {every}", f"Greatest {every}", "Greatest in", "Main contributor in")
    sheet.write_row(top, right, headings, book.format("header"))
    sheet.set_row(top, max(48, 10 + 5 * max(map(len, labels))))
    dimensions = ranked_dimensions(causes)
    for row, name in enumerate(dimensions, start=top + 1):
        words = dimension_words(name)
        sheet.write_string(row, 0, words[0].upper() + words[1:], book.format("text"))
        for column, variant in enumerate(mapped, start=1):
            shares = variant.computed.spread.shares if variant.computed.spread else {}
            if name in shares:
                sheet.write_number(row, column, shares[name], book.format("small figure", "0%"))
        _write_over_all(book, sheet, (row, right), causes, name)
    last = top + len(dimensions)
    _colour(sheet, (top + 1, 1, last, right + 1), max(max(cause.shares.values()) for cause in causes))
    return last + 1


def _write_over_all(book: Book, sheet: Any, cell: tuple[int, int], causes: Sequence[Cause], dimension: str) -> None:
    """Write a dimension's mean and greatest share over all computed variants, and how often it is the main one."""
    row, column = cell
    worst = max(causes, key=lambda cause: cause.shares.get(dimension, 0.0))
    style = book.format("small figure", "0%")
    sheet.write_number(row, column, mean_share(causes, dimension), style)
    sheet.write_number(row, column + 1, worst.shares[dimension], style)
    sheet.write_string(row, column + 2, shown(worst.name, longest=_SHORT), book.format("indented"))
    sheet.write_number(
        row, column + 3, sum(cause.main == dimension for cause in causes), book.format("small figure", "0")
    )


def _colour(sheet: Any, cells: tuple[int, int, int, int], most: float) -> None:
    """Colour shares from white to orange, which the greatest has."""
    scale = {
        "type": "2_color_scale",
        "min_color": "#FFFFFF",
        "max_color": PALETTE["orange"],
        "min_type": "num",
        "min_value": 0,
        "max_type": "num",
        "max_value": most,
    }
    sheet.conditional_format(*cells, scale)


def _notes(causes: Sequence[Cause], drawn: Sequence[Drawn], coupled: str) -> Iterator[str]:
    """Yield what the heat map shows; `coupled` is what is said of dimensions that scatter together."""
    which = "worst first"
    if len(causes) > MAPPED:
        which = f"the {MAPPED} worst of {len(causes):,}, worst first; the columns to the right are over all of them"
    yield f"Variants: {which}. Shares are first-order Sobol' indices; what a column lacks to 100 % is interaction."
    if coupled:
        yield coupled
    yield "A blank cell: the variant does not have the dimension, or no tolerance for it."
    yield from left_out(causes)
    if len(drawn) > MAPPED:
        yield f"The chart below has the {len(drawn)} variants of the sheet Ranking."


def _disk_shares(book: Book, compared: Stored, size: float) -> Any:
    """Return the disk share of each drawn cup and hat as a point over its length, letters `size` times the usual."""
    title = "Disk share of the wind-up against the length of the cylinder"
    chart = book.chart("scatter", title)
    chart.set_title({"name": title, "name_font": {"size": round(11 * size), "color": PALETTE["ink"]}})
    points: list[tuple[float, float]] = []
    for kind in CONNECTED:
        shape, colour = _MARKERS[kind]
        heading = share_heading(kind)
        of_kind = [
            (float(row["l/r"] or 0), float(row[heading] or 0)) for row in compared.rows if row[heading] is not None
        ]
        if of_kind:
            marker = {
                "type": shape,
                "size": 8 if len(compared.rows) <= _CROWDED else 5,
                "fill": {"color": PALETTE[colour]},
                "border": {"color": PALETTE["ink"]},
            }
            cells = {"categories": compared.series("l/r"), "values": compared.series(heading)}
            chart.add_series({"name": f"{kind}s", "marker": marker, **cells})
        points += of_kind
    lengths, shares = axis_over([length for length, _ in points]), axis_over([0.0, *(share for _, share in points)])
    small = {"size": round(9 * size), "bold": False}
    look = {"num_font": small, "name_font": small, "major_gridlines": GRID}
    chart.set_x_axis({**lengths.options(), **look, "name": "Cylinder length over mean radius l/r [-]"})
    chart.set_y_axis({**shares.options(per_cent=True), **look, "name": "Disk share [%]"})
    chart.set_legend({"position": "bottom", "font": small})
    return chart
