"""How wide tables are printed: on one page while they can be read, else on pages side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

__all__ = ["READABLE", "SMALL", "fits", "print_readably"]

READABLE, SMALL = 65, 55
"""Sizes of print in per cent: letters of 11 points come to 7 and to 6."""

_PAGE = 734
"""Width [pt] between the margins of Letter on its side, the narrower of both papers."""

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
