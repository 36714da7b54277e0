"""A row of units below the headers, as many programs write one: it is no data, and must not contradict the headers."""

from __future__ import annotations

import math
from collections.abc import Mapping

from flexlash.reading.raw import RawSheet, RawValue
from flexlash.schema.cell_addresses import CellAddress
from flexlash.schema.column import Column
from flexlash.schema.columns import columns_of, naming_column
from flexlash.schema.header_names import name_and_unit
from flexlash.schema.spellings import plain
from flexlash.schema.units import Unit, find_unit
from flexlash.validation.ledger import Ledger
from flexlash.validation.validated import Heading

__all__ = ["take_units_row"]

_NONE = frozenset({"", "-", "–", "—", "1", "none", "text"})
"""What a row of units says of a column without one, brackets aside."""

_TITLES = frozenset(map(plain, ("unit", "units", "Einheit", "Einheiten", "unité", "unités", "unità", "unidad")))
_FEWEST = 2
"""Units that make a row one of units; a table of measured parts may have one column of numbers alone."""


def take_units_row(sheet: RawSheet, heading: Heading, schema: str, ledger: Ledger) -> int:
    """Return the number of the row of units below the headers, 0 when there is none; a difference is an error.

    A column whose unit there is another than its header's is taken out of the heading, so that nothing of it is used.
    """
    below = (number for number in sorted(sheet.rows) if number > heading.row)
    row = sheet.whole.first_row if sheet.whole else next(below, 0)
    columns = columns_of(schema)
    cells = {index: cell for index, cell in sheet.rows.get(row, {}).items() if index not in heading.ignored}
    units = _units({key: cells.get(index, "") for key, index in heading.columns.items()}, columns)
    if len(units) < (_FEWEST if schema != "Measurements" else 1):
        return 0
    for key, unit in units.items():
        read_in = columns[key].si_unit.si * heading.factors[key]
        if not math.isclose(unit.si, read_in, rel_tol=1e-9):
            _report(sheet, heading, row, columns[key], ledger)
    index = min(cells)
    ledger.add(
        "I515",
        sheet=sheet.name,
        cell=CellAddress(row=row, column=index),
        value=" ".join(str(cell).strip() for cell in cells.values()),
    )
    return row


def _units(entries: Mapping[str, RawValue], columns: Mapping[str, Column]) -> dict[str, Unit]:
    """Return the units of a row by column, none where a cell of it holds anything else."""
    units: dict[str, Unit] = {}
    for key, entry in entries.items():
        text = _bare(entry)
        if text is None:
            return {}
        if text.casefold() in _NONE or (plain(text) in _TITLES and key == naming_column(columns[key].sheet).key):
            continue
        unit = find_unit(text, columns[key].quantity) if columns[key].is_number and columns[key].quantity else None
        if unit is None:
            return {}
        units[key] = unit
    return units


def _bare(entry: RawValue) -> str | None:
    """Return a cell's text without brackets, None where it is no text."""
    return entry.strip().strip("[]()").strip() if isinstance(entry, str) else None


def _report(sheet: RawSheet, heading: Heading, row: int, column: Column, ledger: Ledger) -> None:
    """Record a unit that is another than the one a column is read in, and take the column out of the heading."""
    index = heading.columns.pop(column.key)
    header = str(sheet.rows[heading.row][index])
    named = name_and_unit(header)[1] if heading.factors[column.key] != 1 else None
    heading.doubtful[index] = column.key
    ledger.add(
        "E219",
        sheet=sheet.name,
        cell=CellAddress(row=row, column=index),
        column=column.key,
        name=column.name,
        value=str(sheet.rows[row][index]).strip(),
        other=named or column.unit,
    )
