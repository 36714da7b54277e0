"""What a row of Variants asks of each cell, by the book of rules: an entry, or that it stays blank."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

from flexlash.feedback.template.cell_operands import CellRow
from flexlash.schema.columns import VARIANTS, Column
from flexlash.schema.part_row import NumberRow, PartRule
from flexlash.schema.part_rules import PART_RULES

__all__ = ["asking_types", "asks_for_blank", "asks_for_entry", "holds_too_much", "other_way", "refusing_types"]

_TYPES = next(column.choices for column in VARIANTS if column.key == "flexspline_type")
_CELLS = {column.key: f"{{{column.key}}}" for column in VARIANTS}
_ANY, _BLANK = "1", '""'
"""What stands for a filled cell and for an empty one."""


def asks_for_entry(column: Column) -> str:
    """Return the condition that a row cannot do without an entry of this column, whatever it holds; "" for never.

    The cells of the row stand as `{key}`.

    >>> from flexlash.schema.columns import DIMENSIONS
    >>> asks_for_entry(DIMENSIONS["rim_length"])
    'AND({rim_thickness_mm}<>"",""="")'
    """
    return _any_broken(_CELLS | {column.key: _BLANK}, _demanding("entry", column))


def asks_for_blank(column: Column) -> str:
    """Return the condition that a row takes no entry of this column, whatever it holds; "" for never."""
    return _any_broken(_CELLS | {column.key: _ANY}, _demanding("none", column))


def holds_too_much(column: Column) -> str:
    """Return the condition that a row has an entry of this column that it does not take; "" for never."""
    return _any_broken(_CELLS, _demanding("none", column))


@cache
def asking_types(column: Column) -> tuple[str, ...]:
    """Return the flexspline types that ask for an entry of this column in a row that is otherwise blank."""
    rules = [*_demanding("entry", column)]
    rows = {name: NumberRow(type=name, entries={}) for name in _TYPES}
    return tuple(name for name, row in rows.items() if any(all(rule.broken(row)) for rule in rules))


@cache
def refusing_types(column: Column) -> tuple[str, ...]:
    """Return the flexspline types that take no entry of this column."""
    rules = [*_demanding("none", column)]
    rows = {name: NumberRow(type=name, entries={column.dimension: 1.0}) for name in _TYPES}
    return tuple(name for name, row in rows.items() if any(all(rule.broken(row)) for rule in rules))


def other_way(column: Column) -> str:
    """Return the dimension that may be entered instead of this one, an empty text where there is none."""
    pairs = ({rule.dimension, rule.instead} for rule in _demanding("entry", column) if rule.instead)
    return next((name for pair in pairs for name in pair if name != column.dimension), "")


def _demanding(what: str, column: Column) -> Iterator[PartRule]:
    names = {column.dimension} if column.role == "dimension" else set()
    return (rule for rule in PART_RULES if rule.demands == what and names & {rule.dimension, rule.instead})


def _any_broken(cells: dict[str, str], rules: Iterator[PartRule]) -> str:
    row = CellRow(cells)
    conditions = [row.all_of(*rule.broken(row)) for rule in rules]
    return str(row.any_of(*conditions)) if conditions else ""
