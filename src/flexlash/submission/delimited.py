"""Delimited text → a sheet of raw cells."""

from __future__ import annotations

import csv
import io
from collections import Counter

from flexlash.submission.gate import Refusal
from flexlash.submission.raw import ERROR_WORDS, ErrorCell, RawSheet, RawValue

__all__ = ["read_table"]

_TOP = 15
"""Rows among which the header, and so the widest row of a table, is looked for."""


def read_table(data: bytes, name: str) -> tuple[RawSheet, str]:
    """Return a CSV file as a sheet and the delimiter it was written with.

    Raises Refusal when it is not UTF-8 text or not a table.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise Refusal("E107") from fault
    tables = {sign: records for sign in ",;\t" if (records := _records(text, sign)) is not None}
    delimiter = max(tables, key=lambda sign: _evenness(tables[sign]), default="")
    if not delimiter or (len(tables) < len(",;\t") and not _evenness(tables[delimiter])):
        raise Refusal("E102")
    rows: dict[int, dict[int, RawValue]] = {}
    for number, values in enumerate(tables[delimiter], start=1):
        cells: dict[int, RawValue] = {
            place: ErrorCell(cell.strip()) if cell.strip() in ERROR_WORDS else cell
            for place, cell in enumerate(values, start=1)
            if cell.strip()
        }
        if cells:
            rows[number] = cells
    return RawSheet(name=name, rows=rows, numbers_are_texts=True), delimiter


def _evenness(records: list[list[str]]) -> int:
    """Return how many cells of the top rows stand in rows of the commonest width: high for the true delimiter."""
    widths = Counter(len(values) for values in records[:_TOP] if len(values) > 1)
    return max((width * count for width, count in widths.items()), default=0)


def _records(text: str, delimiter: str) -> list[list[str]] | None:
    """Return the records of a CSV text; None where its quotes do not close."""
    try:
        return list(csv.reader(io.StringIO(text, newline=None), delimiter=delimiter, strict=True))
    except csv.Error:
        return None
