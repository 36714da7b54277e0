"""The columns of a table as a pandera schema, built once; every check bears the id of its rule: `column|rule`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from typing import TYPE_CHECKING

import pandera.polars as pa
import polars as pl
from pandera.errors import SchemaErrors

from flexlash.schema.columns import ENTRY_SHEETS

if TYPE_CHECKING:
    from flexlash.schema.column import Column

__all__ = ["ResultsError", "checked_results", "entry_schema", "failures"]


class ResultsError(AssertionError):
    """Results that break their own contract: a fault of the program, never of a submission."""


def _checks(column: Column) -> Iterator[pa.Check]:
    """Yield bounds and list of a column as checks, each named by its rule."""
    bound = pa.Check.gt if column.exclusive_minimum else pa.Check.ge
    rules = (("minimum", bound, column.minimum), ("maximum", pa.Check.le, column.maximum))
    for rule, check, limit in (*rules, ("choices", pa.Check.isin, column.choices)):
        if rule in column.rules:
            yield check(limit, name=column.rules[rule].id, error=column.rules[rule].id)


def _schema(columns: Iterable[Column], *, strict: bool) -> pa.DataFrameSchema:
    """Return the schema of a table; a strict one has these columns in this order and no others."""
    return pa.DataFrameSchema(
        {
            column.key: pa.Column(
                pl.Float64 if column.is_number else pl.String,
                checks=list(_checks(column)),
                nullable=not column.required,
            )
            for column in columns
        },
        strict=strict,
        ordered=strict,
    )


@cache
def entry_schema(sheet: str) -> pa.DataFrameSchema:
    """Return the schema of an entry sheet's typed cells."""
    return _schema(ENTRY_SHEETS[sheet], strict=False)


@cache
def _results_schema(columns: tuple[Column, ...]) -> pa.DataFrameSchema:
    return _schema(columns, strict=True)


def failures(schema: pa.DataFrameSchema, frame: pl.DataFrame) -> Iterator[tuple[str, int]]:
    """Yield the id of a broken rule and the index in the frame, in row order, for every failure."""
    try:
        schema.validate(frame, lazy=True)
    except SchemaErrors as errors:
        cases = errors.failure_cases.sort("index", maintain_order=True)
        for check, case, column, index in cases.select("check", "failure_case", "column", "index").iter_rows():
            yield _rule_id(check, case, column), index


def _rule_id(check: str, case: object, column: str) -> str:
    """Return the id of a broken rule, where pandera names it in its own words."""
    if check == "not_nullable":
        return f"{column}|required"
    return f"{case}|{check}" if check.startswith("column_") else check


def checked_results(results: pl.DataFrame, columns: Iterable[Column]) -> pl.DataFrame:
    """Return Results that keep their contract: these columns in this order, with their types, bounds and lists.

    Raises ResultsError for others. It goes by columns: a tenth of a second for 10,000 rows.
    """
    broken = sorted({rule for rule, _ in failures(_results_schema(tuple(columns)), results)})
    if broken:
        raise ResultsError(f"Results break their contract: {', '.join(broken)}")
    return results
