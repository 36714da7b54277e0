"""What was recognised of a delimited text, told to its author."""

from __future__ import annotations

from typing import Any

from flexlash.reading.raw import RawSheet, column_letters
from flexlash.validation.ledger import Ledger

__all__ = ["tell_manner"]

_NAMES = {",": "comma", ";": "semicolon", "\t": "tab", "|": "bar"}


def tell_manner(sheet: RawSheet, ledger: Ledger) -> None:
    """Tell delimiter, encoding and decimal sign of a sheet that was read from a delimited text."""
    manner = sheet.manner
    if manner is None:
        return
    facts: dict[str, Any] = {"file": manner.file} if manner.file else {}
    if manner.delimiter != "," or manner.encoding == "UTF-16":
        ledger.add("I507", value=_NAMES[manner.delimiter], detail=manner.encoding, **facts)
    if manner.comma_number:
        facts |= _at(sheet, manner.comma_number)
        ledger.add("I510", suggestion=facts["value"].replace(",", "."), **facts)
    if manner.foreign_text:
        ledger.add("I511", **facts | _at(sheet, manner.foreign_text))


def _at(sheet: RawSheet, place: tuple[int, int]) -> dict[str, Any]:
    """Return the address and the text of a cell."""
    row, column = place
    text = str(sheet.rows[row][column]).strip()
    return {"sheet": sheet.name, "cell": f"{column_letters(column)}{row}", "value": text}
