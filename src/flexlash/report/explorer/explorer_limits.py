"""The limits between which the dimensions of the Explorer's variant lie, below its charts."""

from __future__ import annotations

from collections import Counter
from typing import Any

from flexlash.report.explorer.explorer_choice import Choice
from flexlash.report.explorer.explorer_working import Working
from flexlash.report.formula.functions import AND, CONCATENATE, IF, IFERROR, MATCH
from flexlash.report.formula.live import Live, put
from flexlash.report.formula.stored import Stored
from flexlash.report.layout.styles import Book
from flexlash.report.trace.scatter import NUMBER

__all__ = ["write_limits"]

_TITLE = "Limits used"
_COLUMNS = ((0, "Dimension"), (1, "Lower limit"), (2, "Upper limit"), (4, "Distribution"), (5, "Differ by"))
_STYLES = {"text": "", "figure": "general"}
_WIDTH = 7
_EXACT = "What is not listed has no tolerance: it is exact."


def write_limits(book: Book, sheet: Any, reading: tuple[Choice, Working], scatter: Stored, row: int) -> int:
    """Write a line for each dimension that scatters, as many as any variant has; return the last row."""
    choice, working = reading
    for column in range(_WIDTH):
        sheet.write_blank(row, column, None, book.format("section"))
    sheet.write_string(row, 0, _TITLE, book.format("section"))
    sheet.write_string(row + 1, 0, _EXACT, book.format("quiet"))
    if not scatter.rows:
        return row + 1
    for column, words in _COLUMNS:
        sheet.write_string(row + 2, column, words, book.format("label" if column in {0, 4} else "figure"))
    numbers = scatter.cells(NUMBER)
    count = max(Counter(numbers.values).values())
    first = working.cell("first row of its limits", IFERROR(MATCH(choice.rank, numbers, 0), 0.0))
    last = working.cell("last row of its limits", IF(first > 0, MATCH(choice.rank, numbers, 1), 0.0))
    for line in range(count):
        is_there = AND(choice.known, first > 0, first + line <= last)
        place = IF(is_there, first + line, 1.0)
        for (column, _), (value, style) in zip(_COLUMNS, _cells(scatter, place), strict=True):
            put(sheet, row + 3 + line, column, IF(is_there, value, ""), book.format(style, _STYLES[style]))
    return row + 2 + count


def _cells(scatter: Stored, place: Live) -> tuple[tuple[Live, str], ...]:
    """Return what stands in the columns for a row of Scatter, and in which style."""
    name = CONCATENATE(scatter.pick(place, "Dimension"), " [", scatter.pick(place, "Unit"), "]")
    numbers = (scatter.pick(place, "Lower limit"), "figure"), (scatter.pick(place, "Upper limit"), "figure")
    return (name, "text"), *numbers, (scatter.pick(place, "Distribution"), "text"), (
        scatter.pick(place, "Scatters between"), "figure",
    )  # fmt: skip
