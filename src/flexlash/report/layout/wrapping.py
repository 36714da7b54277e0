"""A text and a cell's width → the lines it takes, since no program sets the height of merged cells by itself."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence

__all__ = ["LINE_HEIGHT", "fitted", "lines_of", "merged_width"]

LINE_HEIGHT = 15.0
"""Height [pt] of a line of the report's font."""

_DIGIT, _PADDING, _MARGIN = 7, 5, 8
"""Pixels of a digit, of what a column is wider than its digits, and of what a cell keeps free at its sides."""

_NARROW = frozenset("iljtfrI.,;:'′|!()[]-/ ")
_BROAD = frozenset("mwMWQ@%—…")


def merged_width(widths: Sequence[float]) -> float:
    """Return how many digits fit beside each other into merged columns of these widths."""
    pixels = sum(_DIGIT * width + _PADDING for width in widths) - _MARGIN
    return pixels / _DIGIT


def lines_of(text: str, width: float) -> int:
    r"""Return how many lines a text takes in a cell so many digits wide, rather too many than too few.

    >>> lines_of("one two three", 20), lines_of("one two three", 8), lines_of("o" * 50, 20)
    (1, 2, 3)
    >>> lines_of("one\ntwo three", 20)
    2
    """
    return sum(_lines_of_paragraph(paragraph, width) for paragraph in text.split("\n"))


def _lines_of_paragraph(text: str, width: float) -> int:
    lines, used = 1, 0.0
    for word in text.split(" "):
        long = sum(map(_size, word))
        if used and used + long > width:
            lines, used = lines + 1, 0.0
        if long > width:
            more = int(long // width)
            lines, long = lines + more, long - more * width
        used += long + _size(" ")
    return lines


def fitted(text: str, width: float) -> str:
    """Return a text on one line of a cell so many digits wide, cut where it is longer.

    >>> fitted("one two", 20), fitted("o" * 50, 10)
    ('one two', 'oooooooo…')
    """
    if sum(map(_size, text)) <= width:
        return text
    used, kept = _size("…"), 0
    for character in text:
        used += _size(character)
        if used > width:
            break
        kept += 1
    return f"{text[:kept]}…"


def _size(character: str) -> float:
    """Return the width of a character in digits of the report's font."""
    if unicodedata.east_asian_width(character) in "WF":
        return 2.1
    if character in _NARROW:
        return 0.62
    if character in _BROAD:
        return 1.65
    return 1.22 if character.isupper() else 1.03
