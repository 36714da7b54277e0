"""A delimited text and its fixes → the same table with these cells replaced."""

from __future__ import annotations

import csv
import io
from collections import defaultdict
from collections.abc import Sequence

from flexlash.feedback.fixing.fix import Fix
from flexlash.reading.raw import ErrorCell, RawSheet, RawValue
from flexlash.schema.cell_addresses import cell_address

__all__ = ["fixed_table"]


def fixed_table(sheet: RawSheet, fixes: Sequence[Fix]) -> bytes:
    """Return a table as text that every Excel opens (UTF-8 with its mark), the fixes made.

    Rows, columns, delimiter and decimal sign are those of the submission.
    """
    comma = bool(sheet.dialect and sheet.dialect.comma_number)
    now: dict[int, dict[int, str]] = defaultdict(dict)
    for fix in fixes:
        if address := cell_address(fix.cell):
            now[address.row][address.column] = _written(fix.value, comma=comma)
    width = max((max(cells) for cells in sheet.rows.values()), default=0)
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, delimiter=sheet.dialect.delimiter if sheet.dialect else ",", lineterminator="\r\n")
    for number in range(1, max(sheet.rows, default=0) + 1):
        own = [""] * width
        for place, cell in sheet.rows.get(number, {}).items():
            own[place - 1] = _text(cell)
        for place, text in now.get(number, {}).items():
            own[place - 1] = text
        # A row of one cell more than the headers stays one: its numbers may be split by decimal commas.
        writer.writerow([*own, ""] if sheet.dialect and number in sheet.dialect.longer else own)
    return buffer.getvalue().encode("utf-8-sig")


def _written(value: str | float, *, comma: bool) -> str:
    if isinstance(value, str):
        return value
    return repr(value).replace(".", ",") if comma else repr(value)


def _text(value: RawValue) -> str:
    """Return a cell as it stood."""
    return value.text if isinstance(value, ErrorCell) else str(value)
