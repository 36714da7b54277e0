"""Settings: from the typed table to the record of settings."""

from __future__ import annotations

from typing import Any

from flexlash.reading.raw import RawValue
from flexlash.schema.column import Column
from flexlash.schema.columns import SETTINGS
from flexlash.schema.spellings import misspelt, spelt_alike, suggested
from flexlash.schema.variant import Settings
from flexlash.validation.cell_values import Fault, as_number, as_text, is_no_value, no_value_facts
from flexlash.validation.ledger import Ledger
from flexlash.validation.materials_and_classes import report_doubled
from flexlash.validation.unusual_values import unusual_words
from flexlash.validation.validated import Table

__all__ = ["settings_of"]


def settings_of(table: Table, ledger: Ledger) -> Settings:
    """Return the settings of a sheet; a faulty one leaves nothing computable."""
    columns = {column.key: column for column in SETTINGS}
    values: dict[str, Any] = {}
    before = len(ledger.findings)
    doubled = report_doubled(table, ledger, ("setting",), "E323")
    index = table.heading.columns.get("value", 0)
    for record in table.frame.iter_rows(named=True):
        row, name = record["row"], record["setting"]
        raw = table.cells[row].get(index)
        if name not in columns or row in doubled or raw is None:
            continue
        column = columns[name]
        value = _setting_value(column, raw, from_text=table.numbers_are_texts)
        if not isinstance(value, Fault):
            values[name] = value
            if isinstance(value, float) and (usual := unusual_words(column, value)):
                cell = table.address(row, "value")
                told = {"value": f"{value:.10g}", "detail": usual, "name": name}
                ledger.add("W440", sheet=table.sheet, cell=cell, column=name, **told)
            continue
        facts: dict[str, Any] = {"suggestion": value.suggestion, "certain_value": value.certain_value}
        facts |= {"requirement": column.requirement, "choices": ", ".join(column.choices), **value.facts}
        cell = table.address(row, "value")
        ledger.add(value.code, sheet=table.sheet, cell=cell, column=name, name=name, value=value.value, **facts)
    faulty = any((row, key) in table.faulty for row in table.frame["row"] for key in ("setting", "value"))
    if faulty or ledger.has_errors(before):
        ledger.everything = True
    return _settings(values)


def _setting_value(column: Column, raw: RawValue, *, from_text: bool) -> str | float | Fault:
    """Return a setting's value within its bounds or list, or why it has none."""
    if column.is_number:
        value = as_number(raw, column, from_text=from_text)
        return value if isinstance(value, Fault) else _number_fault(column, value) or value
    text = as_text(raw, longest=200)
    if isinstance(text, Fault) or text.casefold() in column.choices:
        return text if isinstance(text, Fault) else text.casefold()
    if is_no_value(text):
        return Fault(code="E221", value=text, facts=no_value_facts(column))
    certain_value = misspelt(text, spelt_alike(column.choices))
    return Fault(code="E209", value=text, suggestion=suggested(text, column.choices), certain_value=certain_value)


def _number_fault(column: Column, value: float) -> Fault | None:
    """Return why a number is out of a setting's bounds, or None."""
    low, high = column.minimum, column.maximum
    if column.type == "integer" and value != int(value):
        return Fault(code="E213", value=value)
    if low is not None and (value < low or (column.exclusive_minimum and value == low)):
        return Fault(code="E207", value=value)
    return Fault(code="E208", value=value) if high is not None and value > high else None


def _settings(values: dict[str, Any]) -> Settings:
    """Return settings from valid values by name; absent ones take their default."""
    calibrations = {
        column.key: float(values.pop(column.key, column.default)) for column in SETTINGS if column.role == "dimension"
    }
    for key in ("seed", "samples"):
        if values.get(key) is not None:
            values[key] = int(values[key])
    return Settings(**values, calibrations=calibrations)
