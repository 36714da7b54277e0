"""The pandera schemas that derive from the columns, and their failures turned into findings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandera.polars as pa
import polars as pl
from pandera.errors import SchemaErrors

from flexlash.schema.columns import Column, columns_of
from flexlash.schema.spellings import misspelt, spelt_alike, suggested
from flexlash.validation.cell_values import is_no_value, no_value_facts
from flexlash.validation.ledger import Ledger, UnitMistake
from flexlash.validation.relations import RELATIONS, Relation, numbers_of
from flexlash.validation.typed_columns import Table
from flexlash.validation.unit_mistakes import find_unit_mistakes, report_contradiction
from flexlash.validation.unusual_values import report_unusual

__all__ = ["check_cells", "check_relations"]


def _checks(column: Column) -> list[pa.Check]:
    """Return a column's bounds and list as checks whose error is the finding's code."""
    checks = []
    if column.minimum is not None and column.is_number:
        bound = pa.Check.gt if column.exclusive_minimum else pa.Check.ge
        checks.append(bound(column.minimum, error="E207"))
    if column.maximum is not None and column.is_number:
        checks.append(pa.Check.le(column.maximum, error="E208"))
    if column.choices:
        checks.append(pa.Check.isin(column.choices, error="E209"))
    return checks


def _cell_schema(schema: str) -> pa.DataFrameSchema:
    return pa.DataFrameSchema(
        {
            key: pa.Column(
                pl.Float64 if column.is_number else pl.String,
                checks=_checks(column),
                nullable=not column.required,
            )
            for key, column in columns_of(schema).items()
        }
    )


def _relation_check(relation: Relation) -> pa.Check:
    """Return a frame-wide check, named by its rule, that holds where the relation is not broken."""

    def holds(data: Any) -> pl.LazyFrame:
        return data.lazyframe.select(~relation.broken)  # type: ignore[no-any-return]

    return pa.Check(holds, name=relation.rule.id, error=relation.rule.id)


_RELATIONS = pa.DataFrameSchema(checks=[_relation_check(relation) for relation in RELATIONS.values()])


def _failures(schema: pa.DataFrameSchema, frame: pl.DataFrame) -> Iterator[tuple[str, str, int]]:
    """Yield check, column and frame index of every failure, in row order."""
    try:
        schema.validate(frame, lazy=True)
    except SchemaErrors as errors:
        cases = errors.failure_cases.sort("index", maintain_order=True)
        yield from cases.select("check", pl.col("column").fill_null(""), "index").iter_rows()


def check_cells(table: Table, ledger: Ledger) -> None:
    """Check every cell by itself: required, bounds, lists; and find the units that are mistaken."""
    columns = columns_of(table.schema)
    for check, key, index in _failures(_cell_schema(table.schema), table.frame):
        row = table.frame["row"][index]
        column = columns[key]
        if (row, key) in table.faulty or key not in table.heading.places:
            continue
        value = table.frame[key][index]
        table.faulty.add((row, key))
        is_none = check == "E209" and is_no_value(value)
        ledger.add(
            "E201" if check == "not_nullable" else "E221" if is_none else check,
            sheet=table.sheet,
            cell=table.address(row, key),
            column=key,
            name=column.name,
            requirement=column.requirement,
            choices=", ".join(column.choices),
            value=table.entered(row, key),
            suggestion=suggested(value, column.choices) if check == "E209" and not is_none else "",
            repair=misspelt(value, spelt_alike(column.choices)) if check == "E209" else None,
            **no_value_facts(column),
            rows=[row] if table.schema == "Variants" else [],
        )
    find_unit_mistakes(table, ledger)
    report_unusual(table, ledger)


def check_relations(table: Table, ledger: Ledger) -> None:
    """Check what the cells of a Variants row must be to one another."""
    columns = columns_of("Variants")
    for name, _, index in _failures(_RELATIONS, table.frame):
        relation = RELATIONS[name]
        rule, record = relation.rule, table.frame.row(index, named=True)
        row, key = record["row"], relation.rule.key
        if any((row, other) in table.faulty for other in relation.keys):
            continue
        if not rule.is_error and any((table.sheet, row, other) in ledger.unit_mistakes for other in relation.keys):
            continue
        if rule.compares_lengths and (mistake := _unit_mistake_beside(table, ledger, row, relation)):
            report_contradiction(mistake, columns[key].name, ledger)
            continue
        entered = {"value": "" if record[key] is None else record[key], "entered": table.entered(row, key)}
        ledger.add(
            rule.code,
            sheet=table.sheet,
            cell=table.address(row, key),
            column=key,
            name=columns[key].name,
            rows=[row],
            **entered | rule.facts(numbers_of(record)),
        )


def _unit_mistake_beside(table: Table, ledger: Ledger, row: int, relation: Relation) -> UnitMistake | None:
    """Return the mistaken cell that breaks a relation, where that is not the cell which the relation blames."""
    mistakes = {key: ledger.unit_mistakes.get((table.sheet, row, key)) for key in relation.keys}
    return None if mistakes[relation.rule.key] else next(filter(None, mistakes.values()), None)
