"""A cell of the submission as read, written so that it can do nothing but be read."""

from __future__ import annotations

from typing import Any

from flexlash.reading.raw import ErrorCell, Percentage, RawValue, Unstored
from flexlash.report.layout.styles import Book
from flexlash.schema.findings import shown

__all__ = ["raw_text", "write_raw"]

_LONGEST = 1000
_MOST_DECIMALS = 10


def write_raw(book: Book, sheet: Any, cell: tuple[int, int], value: RawValue, style: str = "text") -> None:
    """Write a raw value: a number as a number, a percentage as its cell showed it, anything else as a text."""
    if isinstance(value, Percentage):
        sheet.write_number(*cell, value, book.format(style, _percent(value)))
    elif isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < float("inf"):
        sheet.write_number(*cell, value, book.format(style))
    else:
        sheet.write_string(*cell, raw_text(value), book.format(style))


def raw_text(value: RawValue) -> str:
    """Return a raw value as a text."""
    if isinstance(value, ErrorCell):
        return value.text
    if isinstance(value, Unstored):
        return "(formula without a stored result)"
    if isinstance(value, str) and value.isprintable() and len(value) <= _LONGEST:
        return str(value)
    return shown(value, longest=_LONGEST)


def _percent(value: Percentage) -> str:
    """Return the number format that shows a percentage with the decimals it has: 5%, 12.5%."""
    decimals = min(len(f"{100 * value:.10f}".rstrip("0").partition(".")[2]), _MOST_DECIMALS)
    return f"0.{'0' * decimals}%" if decimals else "0%"
