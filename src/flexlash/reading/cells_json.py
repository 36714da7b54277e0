"""Cells as JSON and back: how the limited process hands over what it read, and a report carries it.

Nothing in it can be executed.
"""

from __future__ import annotations

import datetime
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from flexlash.reading.raw import (
    CommaNumber,
    CsvDialect,
    DoubtfulNumber,
    ErrorCell,
    Percentage,
    RawSheet,
    RawValue,
    Unstored,
)
from flexlash.reading.xlsx import Cells

__all__ = ["cells_from_json", "cells_to_json", "dialect_of"]

_KINDS: dict[str, tuple[type, Callable[[Any], str], Callable[[str], RawValue]]] = {
    "moment": (datetime.datetime, datetime.datetime.isoformat, datetime.datetime.fromisoformat),
    "date": (datetime.date, datetime.date.isoformat, datetime.date.fromisoformat),
    "time": (datetime.time, datetime.time.isoformat, datetime.time.fromisoformat),
    "duration": (
        datetime.timedelta,
        lambda value: repr(value.total_seconds()),
        lambda text: datetime.timedelta(seconds=float(text)),
    ),
    "error": (ErrorCell, lambda value: value.text, ErrorCell),
    "unstored": (Unstored, lambda _: "", lambda _: Unstored()),
    "percentage": (Percentage, float.__repr__, lambda text: Percentage(float(text))),
    "comma": (CommaNumber, str, CommaNumber),
    "doubtful": (DoubtfulNumber, str, DoubtfulNumber),
}
"""How each kind of value that JSON lacks is written and read."""

_ADDRESSES = ("comma_number", "foreign_text")
_OWN = frozenset({str, int, float, bool})
"""Kinds of value that JSON has itself."""


def cells_to_json(cells: Cells) -> dict[str, Any]:
    """Return cells as what JSON can hold."""
    return {
        "sheets": [
            {
                "name": sheet.name,
                "rows": [
                    [row, [[column, _written(value)] for column, value in row_cells.items()]]
                    for row, row_cells in sheet.rows.items()
                ],
                "hidden": sheet.hidden,
                "hidden_rows": sorted(sheet.hidden_rows),
                "merged": sheet.merged,
                "numbers_are_texts": sheet.numbers_are_texts,
                "manner": asdict(sheet.dialect) | {"longer": sorted(sheet.dialect.longer)} if sheet.dialect else None,
            }
            for sheet in cells.sheets
        ],
        "modified": cells.modified.isoformat() if cells.modified else "",
        "role": cells.role,
        "template_version": cells.template_version,
    }


def _written(value: RawValue) -> Any:
    """Return a value as JSON holds it; kinds that it lacks become a pair of their name and a text."""
    if type(value) in _OWN:
        return value
    for kind, (type_, write, _) in _KINDS.items():
        if isinstance(value, type_):
            return [kind, write(value)]
    return str(value)


def cells_from_json(written: dict[str, Any]) -> Cells:
    """Return the cells that `cells_to_json` has written."""
    return Cells(
        sheets=[
            RawSheet(
                name=sheet["name"],
                rows={row: {column: _read(value) for column, value in cells} for row, cells in sheet["rows"]},
                hidden=sheet["hidden"],
                hidden_rows=frozenset(sheet["hidden_rows"]),
                merged=tuple(tuple(area) for area in sheet["merged"]),
                numbers_are_texts=sheet["numbers_are_texts"],
                dialect=dialect_of(sheet["manner"]) if sheet["manner"] else None,
            )
            for sheet in written["sheets"]
        ],
        modified=datetime.datetime.fromisoformat(written["modified"]) if written["modified"] else None,
        role=written["role"],
        template_version=written["template_version"],
    )


def dialect_of(written: dict[str, Any]) -> CsvDialect:
    """Return how a delimited text was written, as JSON holds it."""
    addresses = {name: address and tuple(address) for name, address in written.items() if name in _ADDRESSES}
    return CsvDialect(**(written | addresses | {"longer": frozenset(written.get("longer", ()))}))


def _read(value: Any) -> RawValue:
    return _KINDS[value[0]][2](value[1]) if isinstance(value, list) else value
