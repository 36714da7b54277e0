"""The book of rules as expressions on the frame of Variants, each with the cells it looks at."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import polars as pl

from flexlash.schema.columns import DIMENSIONS, VARIANTS
from flexlash.schema.part_row import NumberRow, PartRow, PartRule
from flexlash.schema.part_rules import PART_RULES, said_before

__all__ = ["RELATIONS", "FrameRow", "Relation", "numbers_of"]

_ENTERED = {column.dimension: column.key for column in VARIANTS if column.dimension in DIMENSIONS}


class FrameRow(PartRow):
    """The columns of Variants as operands: a blank is null, so that what it is compared with is not judged."""

    def given(self, name: str) -> pl.Expr:
        """Return whether a cell has an entry."""
        return pl.col(DIMENSIONS[name].key).is_not_null()

    def blank(self, name: str) -> pl.Expr:
        """Return whether a cell has no entry."""
        return pl.col(DIMENSIONS[name].key).is_null()

    def entered(self, name: str) -> pl.Expr:
        """Return the entry of a cell."""
        return pl.col(DIMENSIONS[name].key)

    def is_type(self, *types: str) -> pl.Expr:
        """Return whether the flexspline is of one of these types."""
        return pl.col("flexspline_type").fill_null("cup").is_in(types)

    def when(self, condition: pl.Expr, then: pl.Expr, otherwise: pl.Expr | float) -> pl.Expr:
        """Return one of two columns."""
        return pl.when(condition).then(then).otherwise(otherwise)

    def all_of(self, *conditions: pl.Expr) -> pl.Expr:
        """Return whether all conditions hold."""
        return pl.all_horizontal(conditions)

    def any_of(self, *conditions: pl.Expr) -> pl.Expr:
        """Return whether at least one condition holds."""
        return pl.any_horizontal(conditions)


@dataclass(frozen=True, kw_only=True)
class Relation:
    """A rule with the expression that is true in a row where it is to be told.

    It is silent for a row in which one of its `keys` has a finding already.
    """

    rule: PartRule
    broken: pl.Expr

    @cached_property
    def keys(self) -> list[str]:
        """The columns that the relation looks at, in their order."""
        seen = {self.rule.key, *self.broken.meta.root_names()}
        return [column.key for column in VARIANTS if column.key in seen]


def _relations() -> Iterator[Relation]:
    """Yield a relation for each rule, silent where one that says it already is broken."""
    row = FrameRow()
    broken = {rule.id: row.all_of(*rule.broken(row)).fill_null(value=False) for rule in PART_RULES}
    for rule in PART_RULES:
        before = [broken[one.id] for one in said_before(rule)]
        expression = broken[rule.id] & ~row.any_of(*before) if before else broken[rule.id]
        yield Relation(rule=rule, broken=expression)


RELATIONS = {relation.rule.id: relation for relation in _relations()}
"""Every relation by the name of its rule."""


def numbers_of(record: Mapping[str, Any]) -> NumberRow:
    """Return a row of the frame as plain numbers."""
    entries = {name: record[key] for name, key in _ENTERED.items() if record[key] is not None}
    return NumberRow(type=record["flexspline_type"] or "cup", entries=entries)
