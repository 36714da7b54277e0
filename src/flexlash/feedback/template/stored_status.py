"""The row status that is stored with its formula, so that a viewer which does not calculate shows the right text."""

from __future__ import annotations

import datetime
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from flexlash.feedback.template.cell_writer import Formula, writable
from flexlash.feedback.template.filling import Entries
from flexlash.feedback.template.status_rules import Known, Row, Stage, entry_text, stage_text
from flexlash.reading.raw import Unstored

__all__ = ["counted", "counted_pairs", "listed_name", "listed_names", "stored_statuses"]

_DAY_0 = datetime.datetime(1899, 12, 30)  # noqa: DTZ001
"""The day that Excel counts from."""


def listed_name(value: Any) -> str:
    """Return a name as the lists hold it, an empty text where there is none."""
    return "" if value is None or isinstance(value, Formula | Unstored) else str(value)


def listed_names(entries: Entries) -> list[str]:
    """Return the names in the first column of a sheet, row by row."""
    key = entries.columns[0].key
    return [listed_name(row.get(key)) for row in entries.rows]


def counted(names: Iterable[Any]) -> Counter[Any]:
    """Return how often each name stands there, in small letters."""
    return Counter(str(name).casefold() for name in names)


def counted_pairs(entries: Entries, first: str, second: str) -> Counter[Any]:
    """Return how often two columns say each pair of names, in small letters."""
    texts = ([listed_name(row.get(key)).casefold() for key in (first, second)] for row in entries.rows)
    return Counter(map(tuple, texts))


def stored_statuses(entries: Entries, stages: Sequence[Stage], known: Known) -> list[str]:
    """Return what Excel would show as the status of each row."""
    rows = [_as_excel({column.key: row.get(column.key) for column in entries.columns}) for row in entries.rows]
    groups = {rule.together for stage in stages for rule in stage.rules if rule.together}
    rows_of_name = {
        ",".join(keys): Counter(tuple(entry_text(row, key) for key in keys) for row in rows) for keys in groups
    }
    return [stage_text(stages, row, {**known, **rows_of_name}) if row else "" for row in rows]


def _as_excel(row: Mapping[str, Any]) -> Row:
    """Return a row's entries as a formula sees them: times as numbers, results for formulas."""
    return {key: _seen(writable(value)) for key, value in row.items() if value is not None}


def _seen(value: Any) -> Any:
    if isinstance(value, Formula):
        return 1.0 if value.result is None else value.result
    if isinstance(value, Unstored):
        return 1.0
    if isinstance(value, datetime.time):
        value = datetime.datetime.combine(_DAY_0, value)
    elif isinstance(value, datetime.date) and not isinstance(value, datetime.datetime):
        value = datetime.datetime.combine(value, datetime.time())
    if isinstance(value, datetime.datetime):
        value -= _DAY_0
    return value / datetime.timedelta(days=1) if isinstance(value, datetime.timedelta) else value
