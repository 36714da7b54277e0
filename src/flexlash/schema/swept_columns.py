"""What can be swept: a dimension of Variants, by its key or by a header of the template, with or without its unit."""

from __future__ import annotations

from flexlash.schema.column import Column
from flexlash.schema.columns import columns_of
from flexlash.schema.findings import shown
from flexlash.schema.header_names import called_names, known_names, name_and_unit
from flexlash.schema.spellings import plain, suggested
from flexlash.schema.units import find_unit

__all__ = ["swept_column"]

_COLUMNS = columns_of("Variants")
_SWEPT = {key: column for key, column in _COLUMNS.items() if column.role == "dimension"}
_NAMED, _CALLED = known_names(_COLUMNS), called_names(_SWEPT)


def swept_column(text: str) -> Column:
    """Return the column of Variants that a key or header names; raise ValueError, with the nearest.

    >>> [swept_column(text).key for text in ("cylinder_length", "Wall-thickness mm", "Cylinder length l [mm]", "r_ci")]
    ['cylinder_length_mm', 'wall_thickness_mm', 'cylinder_length_mm', 'disk_inner_radius_mm']
    """
    whole = _NAMED.get(plain(text))
    name, unit = (text, None) if whole else name_and_unit(text)
    key = whole or _NAMED.get(plain(name))
    if key is None:
        near = _CALLED.get(plain(name)) or suggested(name, _SWEPT)
        hint = f"; did you mean {near}?" if near else f". Dimensions: {', '.join(_SWEPT)}"
        raise ValueError(f"there is no dimension {shown(text)}{hint}")
    if key not in _SWEPT:
        raise ValueError(f"{key} is not a dimension of the part, so it cannot be swept")
    column = _SWEPT[key]
    if unit is not None and find_unit(unit, column.quantity) != column.si_unit:
        raise ValueError(f"the values of {key} are in {column.unit}, not in {shown(unit)}")
    return column
