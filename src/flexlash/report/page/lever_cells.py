"""Levers of a variant → the table of its page, and the cheapest change for the table of all variants."""

from __future__ import annotations

import polars as pl

from flexlash.report.page.excel_texts import number_text
from flexlash.report.page.shape import LeverCells, LeverTable
from flexlash.report.wording.lever_table import LEVER_COLUMNS
from flexlash.report.wording.lever_words import change_words, sentence_start
from flexlash.schema.findings import shown

__all__ = ["cheapest_changes", "lever_table"]

_COLUMNS = [column for column in LEVER_COLUMNS if not column.is_in_words]

_ROWS = 60
"""Most changes of a variant that its page has."""

_TEXT = 200
"""Most characters of a cell."""


def lever_table(levers: pl.DataFrame, variant: str) -> LeverTable | None:
    """Return the changes of a variant as its page shows them; None where it has no limit."""
    own = levers.filter(pl.col("variant") == variant)
    if own.is_empty():
        return None
    rows = own.head(_ROWS).to_dicts()
    cells = [[column.value(lever) for column in _COLUMNS] for lever in rows]
    return LeverTable(
        direction=rows[0]["direction"],
        headings=[column.heading for column in _COLUMNS],
        are_numbers=[not any(isinstance(row[place], str) for row in cells) for place in range(len(_COLUMNS))],
        rows=[
            LeverCells(
                cells=[
                    "" if value is None
                    else shown(value, _TEXT) if isinstance(value, str)
                    else number_text(value, column.code(value))
                    for column, value in zip(_COLUMNS, values, strict=True)
                ],
                possible=lever["possible"] == "yes",
                cheapest=lever["rank"] == 1,
            )
            for lever, values in zip(rows, cells, strict=True)
        ],
        more=max(0, own.height - _ROWS),
    )  # fmt: skip


def cheapest_changes(levers: pl.DataFrame) -> dict[str, str]:
    """Return the cheapest single change of each variant that misses its limit, by its name; a dash where there is none.

    A variant that meets its limit is not among them.
    """
    changes = dict.fromkeys(levers.filter(pl.col("direction") == "meet")["variant"].to_list(), "–")
    first = levers.filter(pl.col("rank") == 1).iter_rows(named=True)
    return changes | {lever["variant"]: shown(sentence_start(change_words(lever)), _TEXT) for lever in first}
