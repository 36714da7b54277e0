"""What a column's numbers are called and must be, as a sentence or a line of a table says it."""

from __future__ import annotations

from flexlash.schema.column import Column
from flexlash.schema.columns import DIMENSIONS

__all__ = ["dimension_title", "dimension_words", "inner_name", "wrong_number"]

_CAPITALS = ("Young", "Poisson", "Cp")
"""What names begin with that keep their capital inside a sentence."""


def inner_name(column: Column) -> str:
    """Return a column's name inside a sentence: `disk cone angle`, `Young's modulus E`."""
    name = column.plain_name.replace("_", " ")
    return name if name.startswith(_CAPITALS) else name[0].lower() + name[1:]


def dimension_words(name: str) -> str:
    """Return a dimension's name as a sentence uses it.

    >>> dimension_words("wall_thickness"), dimension_words("youngs_modulus")
    ('wall thickness', "Young's modulus")
    """
    return inner_name(DIMENSIONS[name])


def dimension_title(name: str) -> str:
    """Return a dimension's name as it begins a line of a table.

    >>> dimension_title("wall_thickness"), dimension_title("disk_calibration")
    ('Wall thickness', 'Disk calibration')
    """
    words = dimension_words(name)
    return words[0].upper() + words[1:]


def wrong_number(column: Column) -> str:
    """Return that an entry is no number within the bounds: `disk cone angle is not a number from 30 to 90 °`."""
    return f"{inner_name(column)} is not {_bounds(column)}"


def _bounds(column: Column) -> str:
    """Return what a number must be: `a number from 30 to 90 °`."""
    if column.minimum is None:
        return "a number" if column.maximum is None else f"a number of at most {column.maximum:.15g}"
    unit, least = column.unit_behind, f"{column.minimum:.15g}"
    if column.maximum is None:
        return f"a number above {least}{unit}" if column.exclusive_minimum else f"a number of at least {least}{unit}"
    most = f"{column.maximum:.15g}{unit}"
    return f"a number above {least}, at most {most}" if column.exclusive_minimum else f"a number from {least} to {most}"
