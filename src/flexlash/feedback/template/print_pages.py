"""How the template's sheets print: on A4 across, in letters that one can read, on as many pages as that takes."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

__all__ = ["print_side_by_side", "set_up_page"]

_SCALE = 66
"""Size of print in per cent, in which letters of 11 points come to 7.3."""

_PAGE = 1045 / (_SCALE / 100) / 1.05
"""Pixels of columns between the margins of A4 at that size; LibreOffice has columns 5 % wider than Excel."""


def set_up_page(sheet: Any, header_row: int | None = None) -> None:
    """Print a sheet on A4 across, one page wide, its header row on every page."""
    sheet.set_landscape()
    sheet.set_paper(9)
    sheet.set_margins(0.4, 0.4, 0.5, 0.6)
    sheet.fit_to_pages(1, 0)
    sheet.set_footer("&L&A&C&P / &N&Rflexlash template")
    if header_row is not None:
        sheet.repeat_rows(header_row)


def print_side_by_side(sheet: Any, widths: Sequence[int], groups: Collection[int]) -> None:
    """Print columns of these widths [characters] on pages side by side, each with the first column again.

    A page ends where one of the `groups` of columns begins, unless that would leave half of it empty. What one page
    holds stays on one.
    """
    pixels = [width * 7 + 5 for width in widths]
    if sum(pixels) <= _PAGE:
        return
    breaks: list[int] = []
    first, filled = 1, pixels[0]
    for column, wide in enumerate(pixels[1:], start=1):
        if filled + wide > _PAGE:
            fitting = [group for group in groups if first < group <= column]
            good = [group for group in fitting if sum(pixels[first:group]) > _PAGE / 2]
            first = max(good, default=column)
            breaks.append(first)
            filled = pixels[0] + sum(pixels[first:column])
        filled += wide
    sheet.set_print_scale(_SCALE)
    sheet.set_v_pagebreaks(breaks)
    sheet.repeat_columns(0)
    sheet.print_across()
