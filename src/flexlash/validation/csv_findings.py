"""What was recognised of a delimited text, told to its author."""

from __future__ import annotations

from typing import Any

from flexlash.reading.raw import RawSheet
from flexlash.schema.cell_addresses import CellAddress
from flexlash.validation.ledger import Ledger

__all__ = ["report_dialect"]

_NAMES = {",": "comma", ";": "semicolon", "\t": "tab", "|": "bar"}


def report_dialect(sheet: RawSheet, ledger: Ledger) -> None:
    """Tell delimiter, encoding, decimal sign and sample of a sheet that was read from a delimited text."""
    dialect = sheet.dialect
    if dialect is None:
        return
    facts: dict[str, Any] = {"file": dialect.file} if dialect.file else {}
    if dialect.delimiter != "," or dialect.encoding == "UTF-16":
        ledger.add("I507", value=_NAMES[dialect.delimiter], detail=dialect.encoding, **facts)
    if dialect.sample_column:
        parts = [cells[dialect.sample_column] for cells in sheet.rows.values() if dialect.sample_column in cells]
        ledger.add("I532", value=str(parts[-1]), **facts)
    # What stands in another excerpt of the same table is told there.
    if dialect.comma_number and dialect.comma_number[0] in sheet.rows:
        facts |= _at(sheet, dialect.comma_number)
        ledger.add("I510", suggestion=facts["value"].replace(",", "."), **facts)
    if dialect.foreign_text and dialect.foreign_text[0] in sheet.rows:
        ledger.add("I511", **facts | _at(sheet, dialect.foreign_text))


def _at(sheet: RawSheet, address: tuple[int, int]) -> dict[str, Any]:
    """Return the address and the text of a cell."""
    row, column = address
    text = str(sheet.rows[row][column]).strip()
    return {"sheet": sheet.name, "cell": CellAddress(row=row, column=column), "value": text}
