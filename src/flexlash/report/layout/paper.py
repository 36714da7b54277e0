"""How tables are printed: on one page while they can be read, else on pages side by side, or their beginning alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Any

from flexlash.analysis.run_summary import listed as enumerated
from flexlash.report.layout.report_worksheet import ReportWorksheet
from flexlash.report.layout.wrapping import LINE_HEIGHT
from flexlash.schema.findings import shown
from flexlash.schema.number_words import grouped

__all__ = ["READABLE", "SMALL", "Listed", "fits", "print_one_page", "print_readably"]

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

_HEAD = 80
"""Letters of the columns that the head of a page names."""

_DIGIT, _PADDING = 7, 5
_POINT = 4 / 3
"""Pixels of a digit, of what a column is wider than its digits, and of a point."""


def fits(widths: Sequence[float], least: int = READABLE) -> bool:
    """Return whether columns of these widths are on one page on its side, printed no smaller than a size in per cent.

    >>> fits([10] * 20), fits([10] * 21), fits([10] * 21, SMALL)
    (True, False, True)
    """
    pixels = sum(map(_pixels, widths))
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


@dataclass(frozen=True, kw_only=True)
class Listed:
    """What a sheet lists, as the head of its page counts it: a `noun` in each row from `first` on, `columns` by name.

    With `first` None each of the parts is one of them. Columns whose name is blank are not missed where they are left
    out.
    """

    noun: str
    first: int | None = None
    columns: Sequence[str] = ()


def print_one_page(
    sheet: ReportWorksheet,
    widths: Sequence[float],
    last: int,
    *,
    upright: bool = False,
    smallest: float = 11.0,
    ends: Sequence[int] = (),
    listed: Listed | None = None,
) -> None:
    """Print on one page what of the columns of these widths (0: hidden) and of the rows to `last` can be read there.

    `smallest` is the size of the smallest letters [pt]. With `ends` the page ends with one of these rows, the last that
    it has room for. The head of the page says what is left out of what is `listed`, or of the parts that end so.
    """
    width, height = _UPRIGHT if upright else _SIDEWAYS
    least = _LEAST * 11.0 / smallest
    wide = [value * _BROADER / _POINT for value in accumulate(map(_pixels, widths))]
    columns = max(1, sum(value * least <= width for value in wide))
    high = list(accumulate(sheet.heights.get(row, LINE_HEIGHT) for row in range(last + 1)))
    if high[-1] * least <= _ROOM * height:
        end = last
    else:
        # Of what begins hidden nothing is wide.
        scale = max(least, min(1.0, width / max(wide[columns - 1], 1.0)))
        fitting = [row for row in range(last) if high[row] * scale <= _ROOM * height] or [0]
        end = max(set(ends).intersection(fitting), default=fitting[-1])
    sheet.fit_to_pages(1, 1)
    sheet.print_area(0, 0, end, columns - 1)
    said = [_rows_words(end, last, ends, listed)] if end < last else []
    if listed and (left := [name for name in listed.columns[columns:] if name]):
        said.append(f"without the column{'s' * (len(left) > 1)} {_named(left)}")
    if said:
        sheet.set_header(f"&R&12Printed: {'; '.join(said)}")


def _pixels(width: float) -> int:
    return round(_DIGIT * width) + _PADDING if width else 0


def _rows_words(end: int, last: int, ends: Sequence[int], listed: Listed | None) -> str:
    """Return which rows are printed where a page ends before the last."""
    if listed is None or listed.first is None:
        printed, whole = sum(row <= end for row in ends), len(ends) + 1
    else:
        printed, whole = end + 1 - listed.first, last + 1 - listed.first
    if listed is None or printed < 1:
        return "the beginning of this sheet"
    return f"the first{f' {grouped(printed)}' * (printed > 1)} of {grouped(whole)} {listed.noun}"


def _named(names: Sequence[str]) -> str:
    """Return the names of columns as there is room for them in the head of a page, where & begins a code."""
    short = [shown(name, longest=_HEAD // 2).replace("&", "&&") for name in names]
    room = sum(length <= _HEAD for length in accumulate(len(name) + 2 for name in short))
    return enumerated(short, room)
