"""What the status of a row of Variants says: entries first, then the rules of a part, then what other rows decide."""

from __future__ import annotations

from flexlash.feedback.template.cell_operands import CellRow
from flexlash.feedback.template.status_rules import (
    Row,
    Rule,
    Stage,
    entry_text,
    is_blank,
    missing,
    no_number,
    twice,
    unknown,
    unlisted,
)
from flexlash.schema.columns import DIMENSIONS, VARIANTS
from flexlash.schema.part_row import NumberRow, PartRule, first_broken
from flexlash.schema.part_rules import PART_RULES

__all__ = ["VARIANT_STATUS"]

_ERRORS = [rule for rule in PART_RULES if rule.is_error]
_DIMENSION_KEYS = {name: column.key for name, column in DIMENSIONS.items() if column.sheet == "Variants"}
_CELLS = CellRow({column.key: f"{{{column.key}}}" for column in VARIANTS})


def _number_row(row: Row) -> NumberRow:
    """Return a row of sound entries as numbers."""
    entries = {name: float(row[key]) for name, key in _DIMENSION_KEYS.items() if not is_blank(row.get(key))}
    return NumberRow(type=entry_text(row, "flexspline_type").strip() or "cup", entries=entries)


def _part_fault(row: Row) -> str | None:
    """Return which rule of the book a row of sound entries breaks first."""
    broken = first_broken(_ERRORS, _number_row(row))
    return broken.words if broken else None


def _part(rule: PartRule) -> Rule:
    """Return a rule of the book as one of the status."""
    return Rule(
        text=rule.words,
        excel=str(_CELLS.all_of(*rule.broken(_CELLS))),
        holds=lambda row, _: first_broken([rule], _number_row(row)) is not None,
    )


VARIANT_STATUS = (
    Stage(
        name="fl_row_entries",
        rules=[
            *(missing(column) for column in VARIANTS if column.required),
            *(unlisted(column) for column in VARIANTS if column.choices),
            unknown("material", "material not in Materials", "fl_materials"),
            *(no_number(column) for column in VARIANTS if column.is_number),
        ],
    ),
    Stage(name="fl_row_part", rules=[_part(rule) for rule in _ERRORS], quicker=_part_fault),
    Stage(
        name="fl_row_names",
        rules=[
            unknown("tolerance_class", "tolerance class not in Tolerances", "fl_tolerance_rows"),
            twice(("variant",), "variant used twice", "COUNTIF(fl_variants,{variant})>1"),
        ],
    ),
)
