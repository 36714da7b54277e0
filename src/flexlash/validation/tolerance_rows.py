"""One row of Tolerances: what its cells must be to one another, and the record in SI that it becomes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flexlash.schema import tables
from flexlash.schema.column import Column
from flexlash.schema.columns import DIMENSIONS, LOT_DIMENSIONS, columns_of
from flexlash.schema.tolerance_grades import is_grade
from flexlash.schema.units import find_unit
from flexlash.schema.variant import MeasuredDimension, ScattersBetween, ToleranceRow
from flexlash.validation.cell_values import is_no_value, no_value_facts
from flexlash.validation.grade_texts import meant_grade
from flexlash.validation.ledger import Ledger
from flexlash.validation.number_texts import is_both_ways
from flexlash.validation.validated import Table

__all__ = ["check_limits", "standard_class", "tolerance_row", "warn_of_shift"]

_DEVIATIONS = ("lower_deviation", "upper_deviation")


def standard_class() -> list[ToleranceRow]:
    """Return the built-in class `standard`."""
    entries = []
    for row in tables.rows("standard_class"):
        record: dict[str, Any] = {key: text or None for key, text in row.items()}
        for key in ("lower_deviation", "upper_deviation", "limits_sigma"):
            record[key] = float(record[key]) if record[key] else None
        entries.append(tolerance_row({"row": 0, "tolerance_class": "standard", **record}))
    return entries


def tolerance_row(record: Mapping[str, Any], sample: MeasuredDimension | None = None) -> ToleranceRow:
    """Return a valid tolerance row in SI, with its sample."""
    column = DIMENSIONS[record["dimension"]]
    text = (record["deviation_unit"] or "").strip()
    relative = text == "%"
    unit = column.si_unit if relative or not text else find_unit(text, column.quantity)
    factor = 0.01 if relative else unit.si if unit else 1.0
    given: dict[str, Any] = {key: record[key] for key in ("distribution", "limits_sigma") if record[key] is not None}
    if record["grade"] is None:
        given |= {"lower": record["lower_deviation"] * factor, "upper": record["upper_deviation"] * factor}
    return ToleranceRow(
        row=record["row"],
        tolerance_class=record["tolerance_class"],
        dimension=record["dimension"],
        relative=relative,
        grade=record["grade"],
        sample=sample,
        scatters_between=record.get("scatters_between") or _usual_scatter(record["dimension"]),
        **given | _process(record, factor),
    )


def _usual_scatter(dimension: str) -> ScattersBetween:
    """Return between what a dimension scatters where Tolerances does not say."""
    return "lots" if dimension in LOT_DIMENSIONS else "parts"


def _process(record: Mapping[str, Any], factor: float) -> dict[str, float]:
    """Return what a row says of its process; `factor` is the size of its deviation unit."""
    shift, sd, cp, cpk = (record.get(key) for key in ("mean_shift", "standard_deviation", "cp", "cpk"))
    found: dict[str, float] = {}
    if shift is not None:
        found["mean_shift"] = shift * factor
    if sd is not None:
        found["sd"] = sd * factor
    if cp is not None:
        # With fifteen digits, so that 1.1 is the very process of 3.3 standard deviations.
        found["limits_sigma"] = float(f"{3 * cp:.15g}")
        if cpk is not None and shift is None:
            found["harmful_shift"] = (cp - cpk) / (2 * cp)
        elif cpk is not None:
            found["cpk"] = cpk
    return found


def check_limits(table: Table, ledger: Ledger, record: Mapping[str, Any]) -> None:
    """Check unit, grade and deviations of a row; cells with a fault are None in its record."""
    row, unit = record["row"], record["deviation_unit"]
    column = DIMENSIONS.get(record["dimension"])
    if column and unit and unit.strip() != "%" and find_unit(unit, column.quantity) is None:
        facts = {"value": unit, "dimension": column.dimension, "unit": column.unit}
        ledger.add_in(table, "E211", row, "deviation_unit", **facts)
    if record["grade"] is not None:
        _check_grade(table, ledger, record, column)
    elif (row, "grade") not in table.faulty:
        _check_deviations(table, ledger, record)


def _check_grade(table: Table, ledger: Ledger, record: Mapping[str, Any], column: Column | None) -> None:
    """Require that a grade stands alone, exists and applies to its dimension, where that is known."""
    row, grade = record["row"], record["grade"]
    if any(record[key] is not None for key in _DEVIATIONS):
        ledger.add_in(table, "E316", row, "grade", value=grade)
    elif is_no_value(grade):
        ledger.add_in(table, "E221", row, "grade", value=grade, **no_value_facts(columns_of("Tolerances")["grade"]))
    elif not is_grade(grade):
        meant = meant_grade(grade)
        certain_value = None if grade.isdecimal() else meant or None
        ledger.add_in(table, "E210", row, "grade", value=grade, suggestion=meant, certain_value=certain_value)
    elif column and (column.quantity != "length" or column.grade_at == "none"):
        ledger.add_in(table, "E320", row, "grade", value=grade, other=column.dimension)


def _check_deviations(table: Table, ledger: Ledger, record: Mapping[str, Any]) -> None:
    """Require both deviations, the lower first; one cell that says both is its own finding alone."""
    row, (lower, upper) = record["row"], (record[key] for key in _DEVIATIONS)
    faulty = [str(table.entered(row, key)) for key in _DEVIATIONS if (row, key) in table.faulty]
    for key in _DEVIATIONS:
        if record[key] is None and (row, key) not in table.faulty and not any(map(is_both_ways, faulty)):
            ledger.add_in(table, "E317", row, key)
    if lower is not None and upper is not None and lower > upper:
        ledger.add_in(table, "E318", row, "lower_deviation", value=lower, other=upper)


def warn_of_shift(table: Table, ledger: Ledger, record: Mapping[str, Any]) -> None:
    """Warn of deviations that shift a dimension without scatter."""
    lower, upper = (record[key] for key in _DEVIATIONS)
    if lower and lower == upper:
        ledger.add_in(table, "W410", record["row"], "upper_deviation", value=upper)
