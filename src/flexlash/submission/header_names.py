"""What a header cell says: its name and unit, and which column of the schema a name stands for."""

from __future__ import annotations

import re
from collections.abc import Mapping

from flexlash.column import Column
from flexlash.submission.spellings import plain

__all__ = ["LAST_HEADER_ROW", "known_names", "name_and_unit"]

LAST_HEADER_ROW = 15
"""The header row is one of so many first rows."""

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

_BRACKETS = re.compile(r"^(.*?)\s*[\[(]([^\])]*)[\])]\s*$", re.DOTALL)


def known_names(columns: Mapping[str, Column]) -> dict[str, str]:
    """Return every accepted header without its unit → key: key, label with and without symbol, short forms."""
    found = {}
    for key, column in columns.items():
        for spelling in (key, column.dimension, column.name, column.plain_name, *_SHORT.get(key, ())):
            found[plain(spelling)] = key
    return found


def name_and_unit(header: str) -> tuple[str, str | None]:
    """Return a header's name and the unit in its brackets, None without brackets."""
    match = _BRACKETS.match(header)
    name, unit = (match[1], match[2].strip()) if match else (header, None)
    return " ".join(word for word in name.split(" ") if word not in _LOST), unit
