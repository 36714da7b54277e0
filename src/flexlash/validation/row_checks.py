"""What the pandera schemas of columns and of relations find, turned into findings."""

from __future__ import annotations

from typing import Any

import pandera.polars as pa
import polars as pl

from flexlash.schema.columns import columns_of
from flexlash.schema.spellings import misspelt, spelt_alike, suggested
from flexlash.validation.cell_values import is_no_value, no_value_facts
from flexlash.validation.column_schemas import entry_schema, failures
from flexlash.validation.ledger import Ledger
from flexlash.validation.relations import RELATIONS, Relation, numbers_of
from flexlash.validation.unit_mistakes import find_unit_mistakes, report_contradiction
from flexlash.validation.unusual_values import report_unusual
from flexlash.validation.validated import Table, UnitMistake

__all__ = ["check_cells", "check_relations"]


def _relation_check(relation: Relation) -> pa.Check:
    """Return a frame-wide check, named by its rule, that holds where the relation is not broken."""

    def holds(data: Any) -> pl.LazyFrame:
        return data.lazyframe.select(~relation.broken)  # type: ignore[no-any-return]

    return pa.Check(holds, name=relation.rule.id, error=relation.rule.id)


_RELATIONS = pa.DataFrameSchema(checks=[_relation_check(relation) for relation in RELATIONS.values()])


def check_cells(table: Table, ledger: Ledger) -> None:
    """Check every cell by itself: required, bounds, lists; and find the units that are mistaken."""
    columns = columns_of(table.schema)
    for broken, index in failures(entry_schema(table.schema), table.frame):
        key, _, rule = broken.partition("|")
        row = table.frame["row"][index]
        column = columns[key]
        if (row, key) in table.faulty or key not in table.heading.columns:
            continue
        value = table.frame[key][index]
        table.faulty.add((row, key))
        is_none = rule == "choices" and is_no_value(value)
        ledger.add(
            "E221" if is_none else column.rules[rule].code,
            sheet=table.sheet,
            cell=table.address(row, key),
            column=key,
            name=column.name,
            requirement=column.requirement,
            choices=", ".join(column.choices),
            value=table.entered(row, key),
            suggestion=suggested(value, column.choices) if rule == "choices" and not is_none else "",
            certain_value=misspelt(value, spelt_alike(column.choices)) if rule == "choices" else None,
            **no_value_facts(column),
            rows=[row] if table.schema == "Variants" else [],
        )
    find_unit_mistakes(table, ledger)
    report_unusual(table, ledger)


def check_relations(table: Table, ledger: Ledger) -> None:
    """Check what the cells of a Variants row must be to one another."""
    columns = columns_of("Variants")
    for name, index in failures(_RELATIONS, table.frame):
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
