"""What a header cell says: its name and unit, and which column of the schema a name stands for."""

from __future__ import annotations

from collections.abc import Mapping

from flexlash.schema.column import Column
from flexlash.schema.spellings import plain

__all__ = ["BLANK", "LAST_HEADER_ROW", "called_names", "columns_named", "known_names", "name_and_unit"]

LAST_HEADER_ROW = 15
"""The header row is one of so many first rows."""

BLANK = " \t\r\n\u00a0\u200b\ufeff"
"""Characters of which a cell may be full and yet be empty."""

_SHORT = {
    "flexspline_type": ("type",),
    "mean_radius_mm": ("r_m",),
    "wall_thickness_mm": ("Δ",),
    "disk_inner_radius_mm": ("r_ci",),
    "disk_outer_radius_mm": ("r_co",),
}
"""Short headers that can mean nothing else; T, l and t could."""

_LOST = frozenset({"?", "\ufffd"})
"""What other programs make of Δ and ν where their encoding has no such letter."""

_LONGEST = 200
"""Most characters of a header that can name a column; a longer one is no name."""


def known_names(columns: Mapping[str, Column]) -> dict[str, str]:
    """Return every accepted header without its unit → key: key, label with and without symbol, short forms."""
    keys = {}
    for key, column in columns.items():
        for spelling in (key, column.dimension, column.name, column.plain_name, *_SHORT.get(key, ())):
            keys[plain(spelling)] = key
    return keys


def called_names(columns: Mapping[str, Column]) -> dict[str, str]:
    """Return every name by which engineers call a column in other words, or in another language → key."""
    return {plain(name): key for key, column in columns.items() for name in column.also_called.split()}


def columns_named(cells: Mapping[int, object], names: Mapping[str, str]) -> dict[int, str]:
    """Return the keys of the columns that the cells of a row are headers of, by place; `names` are known ones."""
    keys = {}
    for place, cell in cells.items():
        if isinstance(cell, str) and len(cell) <= _LONGEST:
            key = names.get(plain(name_and_unit(cell)[0]))
            if key is not None:
                keys[place] = key
    return keys


def name_and_unit(header: str) -> tuple[str, str | None]:
    """Return a header's name and the unit in the brackets at its end, None without brackets.

    >>> name_and_unit("Wall (new) thickness [mm]"), name_and_unit("Wall thickness [mm")
    (('Wall (new) thickness', 'mm'), ('Wall thickness [mm', None))
    """
    name, unit = header, None
    text = header.rstrip() if len(header) <= _LONGEST else ""
    if text.endswith(("]", ")")):
        inside = max(text.rfind("]", 0, -1), text.rfind(")", 0, -1)) + 1
        openings = [opening for sign in "[(" if (opening := text.find(sign, inside)) >= 0]
        if openings:
            name, unit = text[: min(openings)].rstrip(), text[min(openings) + 1 : -1].strip()
    return " ".join(word for word in name[: _LONGEST + 1].split(" ") if word not in _LOST), unit
