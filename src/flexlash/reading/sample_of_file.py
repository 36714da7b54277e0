"""Measured parts of a file that names no sample: all of them are one, which has the file's name."""

from __future__ import annotations

from pathlib import Path

from flexlash.reading.raw import RawValue
from flexlash.schema.columns import columns_of
from flexlash.schema.header_names import LAST_HEADER_ROW, called_names, columns_named, known_names

__all__ = ["add_sample"]

_SHEET, _HEADER = "Measurements", "Sample"


def add_sample(rows: dict[int, dict[int, RawValue]], file: str) -> int:
    """Add a column with the name of a file to rows of measured parts that name no sample; return it, 0 where they do.

    Only rows below the headers with a digit under a dimension are parts; units, notes and blank lines are none. Where
    headers name their dimensions in other words, which are questions first, every row has the name.
    """
    columns = columns_of(_SHEET)
    names = called_names(columns) | known_names(columns)
    known = {row: columns_named(rows[row], names) for row in range(1, LAST_HEADER_ROW + 1) if row in rows}
    header = max(known, key=lambda row: len(known[row]), default=0)
    sizes = {place for place, key in known.get(header, {}).items() if columns[key].is_number}
    name = Path(file).stem.strip()
    if not sizes or not name or "sample" in known[header].values():
        return 0
    added = 1 + max(max(cells) for cells in rows.values())
    is_clear = sizes <= columns_named(rows[header], known_names(columns)).keys()
    rows[header][added] = _HEADER
    for row, cells in rows.items():
        if row > header and (not is_clear or any(_has_digit(cells[place]) for place in sizes & cells.keys())):
            cells[added] = name
    return added


def _has_digit(cell: RawValue) -> bool:
    return any(map(str.isdigit, str(cell)))
