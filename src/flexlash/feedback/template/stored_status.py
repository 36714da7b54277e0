"""The row status that is stored with its formula, so that a viewer which does not calculate shows the right text."""

from __future__ import annotations

import datetime
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from flexlash.feedback.template.cell_writer import Formula
from flexlash.feedback.template.filling import Entries
from flexlash.feedback.template.status_formulas import status_text
from flexlash.reading.raw import ErrorCell, Unstored

__all__ = ["listed_name", "stored_statuses"]


def listed_name(value: Any) -> str:
    """Return a name as the lists hold it, an empty text where there is none."""
    return "" if value is None or isinstance(value, Formula | Unstored) else str(value)


def stored_statuses(entries: Entries, materials: Sequence[str], classes: Sequence[str]) -> list[str]:
    """Return what Excel would show as the status of each row; an error in the row shows through."""
    rows = [_as_excel({column.key: row.get(column.key) for column in entries.columns}) for row in entries.rows]
    twins: dict[str, list[Mapping[str, Any]]] = defaultdict(list)
    for row in rows:
        twins[str(row.get("variant")).casefold()].append(row)
    return [_stored_status(row, twins[str(row.get("variant")).casefold()], materials, classes) for row in rows]


def _stored_status(
    row: Mapping[str, Any], twins: Sequence[Mapping[str, Any]], materials: Sequence[str], classes: Sequence[str]
) -> str:
    """Return the status of a row; `twins` are the rows of its name."""
    if not row:
        return ""
    error = next((value.text for value in row.values() if isinstance(value, ErrorCell)), None)
    return error or status_text(row, twins, materials, classes)


def _as_excel(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row's entries as a formula sees them: times as numbers, results for formulas."""
    seen = {}
    for key, value in row.items():
        if isinstance(value, Formula):
            seen[key] = 1.0 if value.result is None else value.result
        elif isinstance(value, datetime.date | datetime.time | datetime.timedelta | Unstored):
            seen[key] = 1.0
        elif value is not None:
            seen[key] = value
    return seen
