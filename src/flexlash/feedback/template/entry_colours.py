"""The colours that guide through a row while it is filled: what it needs, what it lacks, what it does not take."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from xlsxwriter.utility import xl_col_to_name

from flexlash.feedback.template.demanded_cells import asks_for_blank, asks_for_entry, holds_too_much
from flexlash.feedback.template.entry_rules import FIRST_ROW
from flexlash.schema.columns import Column

__all__ = ["shade_entries"]


def shade_entries(sheet: Any, columns: Sequence[Column], rows: int, formats: Mapping[str, Any]) -> None:
    """Colour the cells of all prepared rows by what each row asks of them."""
    row = FIRST_ROW + 1
    cells = {column.key: f"${xl_col_to_name(index)}{row}" for index, column in enumerate(columns)}
    begun = f"COUNTA($A{row}:${xl_col_to_name(len(columns) - 1)}{row})>0"
    for index, column in enumerate(columns):
        for style, condition in _conditions(column, begun).items():
            rule = {"type": "formula", "criteria": f"={condition.format(**cells)}", "format": formats[style]}
            sheet.conditional_format(FIRST_ROW, index, FIRST_ROW + rows - 1, index, rule)


def _conditions(column: Column, begun: str) -> dict[str, str]:
    """Return when a cell of a column has which look; never two at once, since LibreOffice forgets which would win."""
    lacking = f'AND({begun},{{{column.key}}}="")'
    if column.required:
        return {"missing": lacking}
    found: dict[str, str] = {}
    if needed := asks_for_entry(column):
        found |= {"missing": f"AND({lacking},{needed})", "needed": f"AND(NOT({lacking}),{needed})"}
    if unused := asks_for_blank(column):
        wrong = holds_too_much(column)
        found |= {"unused": f"AND({unused},NOT({wrong}))", "wrong": wrong}
    return found
