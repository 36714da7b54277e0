"""The Compare sheet: percentile boxes of the worst variants side by side, where they lie and how wide they are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from flexlash.analysis.outcome import Outcome
from flexlash.report.extent import extent_of
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.axes import axis_over
from flexlash.report.layout.links import write_link
from flexlash.report.layout.styles import GRID, PALETTE, Book
from flexlash.report.report_data import Drawn
from flexlash.report.wording.chart_words import limits_over, medians_of, spans_of

__all__ = ["BOXES", "write_compare"]

BOXES = 40
"""Most variants whose boxes and names can be read in one chart."""

_WIDTH, _HEIGHT = 1150, 375
"""Size [px] of each chart."""

_TOP = 5
_ROWS = 19
"""Row, from 0, of the first chart; rows that each takes."""

_LAST_COLUMN = 17
_LABELS = ((12, -45, 9), (BOXES, -90, 9))
"""Up to how many variants the names are turned so far and so large."""

_WIDEST_GAP = 500
"""What Excel allows."""

_UNSEEN = {"fill": {"none": True}, "border": {"none": True}}
_NOTES = (
    "Each box holds the middle half of a variant's units, P25 to P75, and changes colour at the median; the whiskers "
    "reach from P2.5 to P97.5.",
    "The second chart has the same boxes around the median of each variant: the higher a box, the more its tolerances "
    "matter.",
)
_LINKS = (
    (0, "Ranking", "Ranking and differences"),
    (4, "Contributions", "What causes the spread"),
)


def write_compare(book: Book, outcome: Outcome, drawn: Sequence[Drawn], compared: Stored) -> None:
    """Write the Compare sheet."""
    sheet = book.sheet("Compare", pages_tall=1)
    sheet.write_string(0, 0, "Variants side by side", book.format("title"))
    sheet.set_row(0, 28)
    sheet.print_area(0, 0, _TOP + 2 * _ROWS, _LAST_COLUMN)
    if not drawn:
        return
    count, total = min(len(drawn), BOXES), extent_of(outcome).total
    which = f"All {total} computed variants, worst first" if total > 1 else "The only computed variant"
    if count < total:
        which = f"The {count} worst of {total:,} computed variants, worst first (Ranking lists {len(drawn)})"
    for row, note in enumerate((f"{which}. {_NOTES[0]}", _NOTES[1]), start=1):
        sheet.write_string(row, 0, note, book.format("quiet"))
    for column, target, text in _LINKS:
        write_link(sheet, 3, column, f"{target}!A1", text, style=book.format("link"))
    text = f"Boxes of the backlash of {count} variants, worst first, with their limits: "
    text += f"{spans_of(drawn[:count], book.angles)}. {limits_over(drawn[:count])}"
    book.insert(sheet, _TOP, 0, _boxes(book, compared, count), size=(_WIDTH, _HEIGHT), text=text)
    text = f"Boxes of the backlash of {count} variants less the median of each, in the same order: "
    text += medians_of(drawn[:count], book.angles)
    book.insert(sheet, _TOP + _ROWS, 0, _widths(book, compared, count), size=(_WIDTH, _HEIGHT), text=text)


def _boxes(book: Book, compared: Stored, count: int) -> Any:
    """Return the boxes where they lie: columns on one that is not seen, whose error bar is the lower whisker."""
    limits = _numbers(compared, "Limit", count)
    chart = book.chart("column", "Backlash and limit" if limits else "Backlash", subtype="stacked")
    names = compared.series("Label", count)
    lower = {"y_error_bars": _whisker(compared, count, "minus", "P2.5 to P25")}
    upper = {"y_error_bars": _whisker(compared, count, "plus", "P75 to P97.5")}
    for heading, look in (
        ("P25", {**_UNSEEN, **lower}),
        ("P25 to P50", _half("sky")),
        ("P50 to P75", {**_half("blue"), **upper}),
    ):
        values = compared.series(heading, count)
        chart.add_series({"name": heading, "categories": names, "values": values, "gap": _gap(count), **look})
    if limits:
        marks = book.workbook.add_chart({"type": "line"})
        colour = {"color": PALETTE["red"]}
        marker = {"type": "long_dash", "size": 9, "fill": colour, "border": colour}
        values = compared.series("Limit", count)
        look = {"line": {"none": True}, "marker": marker}
        marks.add_series({"name": "Limit", "categories": names, "values": values, **look})
        chart.combine(marks)
    ends = [*_numbers(compared, "P2.5", count), *_numbers(compared, "P97.5", count), *limits]
    chart.set_legend({"position": "bottom", "delete_series": [0]})
    return _with_axes(chart, ends, count, f"Backlash [{book.angles.name}]")


def _widths(book: Book, compared: Stored, count: int) -> Any:
    """Return the boxes around the median: a column down and one up from 0, each with a whisker."""
    chart = book.chart("column", "Spread around the median of each variant", subtype="stacked")
    for heading, colour, whisker in (
        ("P25 less P50", "sky", ("minus", "P2.5 to P25")),
        ("P75 less P50", "blue", ("plus", "P75 to P97.5")),
    ):
        chart.add_series({
            "name": heading,
            "categories": compared.series("Label", count),
            "values": compared.series(heading, count),
            "gap": _gap(count),
            "y_error_bars": _whisker(compared, count, *whisker),
            **_half(colour),
        })  # fmt: skip
    medians = _numbers(compared, "P50", count)
    ends = [
        end - median
        for heading in ("P2.5", "P97.5")
        for end, median in zip(_numbers(compared, heading, count), medians, strict=True)
    ]
    return _with_axes(chart, ends, count, f"Backlash less median [{book.angles.name}]")


def _with_axes(chart: Any, ends: Sequence[float], count: int, name: str) -> Any:
    """Return a chart with an upright axis over these values and readable names below."""
    turned, size = next((turned, size) for most, turned, size in _LABELS if count <= most)
    font = {"name_font": {"size": 10, "bold": False}, "num_font": {"size": 9}}
    chart.set_y_axis({**axis_over(ends).options(), **font, "name": name, "major_gridlines": GRID})
    chart.set_x_axis({"num_font": {"rotation": turned, "size": size}, "interval_unit": 1, "label_position": "low"})
    return chart


def _gap(count: int) -> int:
    """Return how far apart boxes stand, in per cent of their width, so that few of them are not slabs."""
    return min(_WIDEST_GAP, max(60, 800 // count))


def _half(colour: str) -> dict[str, Any]:
    return {"fill": {"color": PALETTE[colour]}, "border": {"color": PALETTE["ink"]}}


def _numbers(compared: Stored, heading: str, count: int) -> list[float]:
    """Return the numbers of a column, the first variants alone, without blanks."""
    column = (row[heading] for row in compared.rows[:count])
    return [float(value) for value in column if value is not None]


def _whisker(compared: Stored, count: int, direction: str, heading: str) -> dict[str, Any]:
    """Return error bars to one side whose lengths stand in a column."""
    name, first, column, last, _ = compared.series(heading, count)
    letter = xl_col_to_name(column)
    cells, lengths = f"={name}!${letter}${first + 1}:${letter}${last + 1}", _numbers(compared, heading, count)
    both = {"plus_values": cells, "minus_values": cells, "plus_data": lengths, "minus_data": lengths}
    return {"type": "custom", "direction": direction, "color": PALETTE["ink"], "width": 1.25, **both}
