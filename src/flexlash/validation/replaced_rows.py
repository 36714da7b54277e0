"""Rows of Variants with other values in some cells, checked as if they had been submitted so."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import polars as pl

from flexlash.validation.ledger import Ledger
from flexlash.validation.row_checks import check_cells, check_relations
from flexlash.validation.validated import Table, Validated

__all__ = ["Replacement", "with_replacements"]


@dataclass(frozen=True, kw_only=True)
class Replacement:
    """A row of Variants by its number, and the values that take the place of its own, in the units of the columns."""

    row: int
    values: Mapping[str, float]


def with_replacements(validated: Validated, replacements: Sequence[Replacement]) -> Validated:
    """Return a submission whose Variants are these rows alone, numbered from the first below the headers.

    Cells and relations are checked anew; materials, classes and settings stay as they are. Its findings are those of
    the rows. Raises LookupError where the submission has no such row.
    """
    if validated.table is None:
        raise LookupError("a submission without variants")
    table = _table(validated.table, replacements)
    ledger = Ledger.after(validated)
    ledger.rows.clear()
    ledger.everything = False
    ledger.table = table
    of_materials = {place: one for place, one in ledger.unit_mistakes.items() if one.schema != "Variants"}
    ledger.unit_mistakes = of_materials
    check_cells(table, ledger)
    check_relations(table, ledger)
    sound = table.frame.filter(~pl.col("row").is_in(list(ledger.rows)))
    return replace(
        validated,
        findings=tuple(ledger.findings),
        blocked=ledger.blocked,
        unit_mistakes=ledger.unit_mistakes,
        table=table,
        variants=replace(validated.variants, frame=sound),
    )


def _table(table: Table, replacements: Sequence[Replacement]) -> Table:
    """Return Variants with these rows, each cell that is replaced holding the number itself."""
    keys = list(dict.fromkeys(key for one in replacements for key in one.values))
    columns = dict(table.heading.columns)
    for key in keys:
        columns.setdefault(key, max([*columns.values(), *table.heading.extra], default=0) + 1)
    factors = table.heading.factors | dict.fromkeys(keys, 1.0)
    places = {row: place for place, row in enumerate(table.frame["row"].to_list())}
    first = table.heading.row + 1
    frame = table.frame[[places[one.row] for one in replacements]]
    numbers = pl.Series("row", range(first, first + len(replacements)), dtype=frame.schema["row"])
    changed = [
        pl.Series(
            key,
            [one.values.get(key, value) for one, value in zip(replacements, frame[key].to_list(), strict=True)],
            dtype=frame.schema[key],
        )
        for key in keys
    ]
    rows = range(first, first + len(replacements))
    return replace(
        table,
        heading=replace(table.heading, columns=columns, factors=factors),
        frame=frame.with_columns(numbers, *changed),
        cells={
            row: table.cells[one.row] | {columns[key]: value for key, value in one.values.items()}
            for row, one in zip(rows, replacements, strict=True)
        },
        faulty={
            (row, key)
            for row, one in zip(rows, replacements, strict=True)
            for key in columns
            if (one.row, key) in table.faulty and key not in one.values
        },
        whole=None,
    )
