"""How tables are printed: on one page while they can be read, else on pages side by side, or their beginning alone."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from typing import Any

from flexlash.report.layout.report_worksheet import ReportWorksheet
from flexlash.report.layout.wrapping import LINE_HEIGHT

__all__ = ["READABLE", "SMALL", "fits", "print_one_page", "print_readably"]

READABLE, SMALL = 65, 55
"""Sizes of print in per cent: letters of 11 points come to 7 and to 6."""

_PAGE = 734
"""Width [pt] between the margins of Letter on its side, the narrower of both papers."""

_SIDEWAYS, _UPRIGHT = (734.0, 512.0), (536.0, 710.0)
"""Width and height [pt] between the margins of both papers, the lesser of each."""

_LEAST = 7 / 11
"""Least size of print at which letters of 11 points come to 7."""

_BROADER = 1.06
"""How much wider than Excel LibreOffice has columns, at most."""

_ROOM = 0.97
"""Part of the height of a page that is filled."""

_DIGIT, _PADDING = 7, 5
_POINT = 4 / 3
"""Pixels of a digit, of what a column is wider than its digits, and of a point."""


def fits(widths: Sequence[float], least: int = READABLE) -> bool:
    """Return whether columns of these widths are on one page on its side, printed no smaller than a size in per cent.

    >>> fits([10] * 20), fits([10] * 21), fits([10] * 21, SMALL)
    (True, False, True)
    """
    pixels = sum(round(_DIGIT * width) + _PADDING for width in widths)
    return pixels * least / 100 <= _PAGE * _POINT


def print_readably(sheet: Any, widths: Sequence[float], *, breaks: Sequence[int] = (), least: int = READABLE) -> None:
    """Print columns of these widths on one page, or, where letters would be too small, readably on several.

    Each of several pages repeats the first column; a page begins at each column of `breaks`.
    """
    if fits(widths, least):
        sheet.fit_to_pages(1, 0)
        return
    sheet.set_print_scale(READABLE)
    sheet.repeat_columns(0)
    sheet.print_across()
    sheet.set_v_pagebreaks(list(breaks))


def print_one_page(
    sheet: ReportWorksheet,
    widths: Sequence[float],
    last: int,
    *,
    upright: bool = False,
    smallest: float = 11.0,
    ends: Sequence[int] = (),
) -> None:
    """Print on one page what of the columns of these widths and of the rows to `last` can be read there.

    `smallest` is the size of the smallest letters [pt]. With `ends` the page ends with one of these rows, the last that
    it has room for. Where rows are left out, the head of the page says so.
    """
    width, height = _UPRIGHT if upright else _SIDEWAYS
    least = min(1.0, _LEAST * 11.0 / smallest)
    wide = [value * _BROADER / _POINT for value in accumulate(round(_DIGIT * one) + _PADDING for one in widths)]
    columns = max(1, sum(value * least <= width for value in wide))
    scale = max(least, min(1.0, width / wide[columns - 1]))
    high = list(accumulate(sheet.heights.get(row, LINE_HEIGHT) for row in range(last + 1)))
    whole = high[-1] * least <= _ROOM * height
    scale = least if whole else scale
    rows = [row for row in (*ends, last) if high[row] * scale <= _ROOM * height]
    if not ends and not whole:
        rows = [row for row, value in enumerate(high) if value * scale <= _ROOM * height]
    end = max(rows, default=ends[0] if ends else last)
    sheet.fit_to_pages(1, 1)
    sheet.print_area(0, 0, end, columns - 1)
    if end < last:
        sheet.set_header("&R&12Printed: the beginning of this sheet")
