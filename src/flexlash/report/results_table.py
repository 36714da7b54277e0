"""An outcome → Results as a table: its columns, then the engineer's own under their own headers; and its CSV text."""

from __future__ import annotations

import datetime
import re
from collections.abc import Container, Iterator, Sequence

import polars as pl

from flexlash.analysis.outcome import Outcome
from flexlash.reading.own_columns import kind_of, number_of
from flexlash.reading.raw import ErrorCell, Percentage, RawValue
from flexlash.reading.whole_table import OwnKind
from flexlash.schema.result_columns import result_columns
from flexlash.schema.unused_names import unused_name

__all__ = ["csv_header", "csv_rows", "csv_text", "results_table"]

_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")

_STARTS = ((r"^([\t\r])", "'${1}"), (r"(^|[;|\t\r\n])([=+\-@])", "${1}'${2}"))
"""What a spreadsheet takes for the start of a formula, and what takes its place.

It may also stand behind what another reader takes for the end of a cell. Quotes do not help there: a reader that
separates cells elsewhere meets them in the middle of a cell, where they are letters.
"""


def results_table(outcome: Outcome) -> pl.DataFrame:
    """Return Results in submitted order with the submission's own columns at the right.

    An own column is numeric where all of its entries are numbers, else text. Where its header is the name of another
    column it reads `header (as submitted)`.
    """
    own: list[pl.Series] = []
    taken = {column.key for column in result_columns(cross_check=True, elasticity=True)}
    for header, values, kind in _own_columns(outcome):
        name = _own_name(header, taken)
        taken.add(name)
        own.append(_typed(name, values, kind))
    return outcome.results.with_columns(own)


def _own_name(header: str, taken: Container[str]) -> str:
    """Return the name of an own column, which says that it is `as submitted` where another column has that name."""
    return unused_name(
        taken, header, f"{header} (as submitted)", numbered=lambda number: f"{header} (as submitted {number})"
    )


def _own_columns(outcome: Outcome) -> Iterator[tuple[str, list[RawValue | None], OwnKind]]:
    """Yield header, entries and kind of each column that the submission has and flexlash does not use."""
    table = outcome.validated.table if outcome.validated else None
    if outcome.validated is None or table is None:
        return
    rows = [row for row, _, _ in outcome.validated.submitted]
    for column, header in sorted(table.heading.extra.items()):
        values = [table.cells[row].get(column) for row in rows]
        kind = table.whole.own.get(column, "text") if table.whole else None
        if table.numbers_are_texts and kind != "text":
            numbers = [None if value is None else number_of(value) for value in values]
            is_numeric = all((value is None) == (number is None) for value, number in zip(values, numbers, strict=True))
            values = [*numbers] if is_numeric else values
        yield _clean(header), values, kind or kind_of(values)


def _typed(name: str, values: Sequence[RawValue | None], kind: OwnKind) -> pl.Series:
    """Return a column of whole numbers, of numbers, or of texts."""
    if kind in {"whole", "number"}:
        return pl.Series(name, values, dtype=pl.Int64 if kind == "whole" else pl.Float64, strict=False)
    return pl.Series(name, [None if value is None else _text_of(value) for value in values], dtype=pl.String)


def _text_of(value: RawValue) -> str:
    """Return an entry as a text, as its cell shows it."""
    if isinstance(value, Percentage):
        return value.shown
    if isinstance(value, datetime.datetime) and value.time() == datetime.time():
        value = value.date()
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    text = value.text if isinstance(value, ErrorCell) else str(value)
    return _clean(text.upper() if isinstance(value, bool) else text)


def _clean(text: str) -> str:
    """Return a text without what no file of texts can hold."""
    return _CONTROL.sub("·", text).encode("utf-8", "backslashreplace").decode()


def csv_text(table: pl.DataFrame) -> str:
    """Return a table as CSV in which every text is quoted and none can act as a formula, whatever separates cells."""
    return csv_header(table.columns) + csv_rows(table)


def csv_header(columns: Sequence[str]) -> str:
    """Return the header line of a table as `csv_text` writes it."""
    header = pl.select(_inert(pl.lit(pl.Series(columns, dtype=pl.String)))).to_series()
    return ",".join('"' + name.replace('"', '""') + '"' for name in header) + "\n"


def csv_rows(table: pl.DataFrame) -> str:
    """Return the rows of a table as `csv_text` writes them."""
    return table.with_columns(_inert(pl.col(pl.String))).write_csv(quote_style="non_numeric", include_header=False)


def _inert(texts: pl.Expr) -> pl.Expr:
    """Return texts with an apostrophe before all that a spreadsheet would take for a formula."""
    for start, guarded in _STARTS:
        texts = texts.str.replace_all(start, guarded)
    return texts
