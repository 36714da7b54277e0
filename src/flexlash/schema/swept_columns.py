"""What can be swept: a dimension of Variants, by its key with or without unit."""

from __future__ import annotations

from flexlash.schema.column import Column
from flexlash.schema.columns import VARIANTS
from flexlash.schema.findings import shown
from flexlash.schema.spellings import plain, suggested

__all__ = ["swept_column"]

_SWEPT = {column.key: column for column in VARIANTS if column.role == "dimension"}
_NAMED = {plain(name): column for column in _SWEPT.values() for name in (column.dimension, column.key)}


def swept_column(name: str) -> Column:
    """Return the column of Variants of this key, with or without its unit; raise ValueError, with the nearest.

    >>> swept_column("cylinder_length").key, swept_column("Wall-thickness mm").key
    ('cylinder_length_mm', 'wall_thickness_mm')
    """
    column = _NAMED.get(plain(name))
    if column is not None:
        return column
    other = next((one for one in VARIANTS if plain(name) in {plain(one.key), plain(one.dimension)}), None)
    if other is not None:
        raise ValueError(f"{other.key} is not a dimension of the part, so it cannot be swept")
    near = suggested(name, _SWEPT)
    hint = f"; did you mean {near}?" if near else f". Dimensions: {', '.join(_SWEPT)}"
    raise ValueError(f"there is no dimension {shown(name)}{hint}")
