"""Materials and Tolerances: from typed tables, or built in, to records in SI."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from flexlash.reading.raw import RawSheet, RawValue
from flexlash.schema import tables
from flexlash.schema.column import Column
from flexlash.schema.columns import DIMENSIONS, ENTRY_SHEETS, LOT_DIMENSIONS, MATERIALS, TOLERANCES
from flexlash.schema.spellings import plain
from flexlash.schema.tolerance_grades import is_grade
from flexlash.schema.units import find_unit
from flexlash.schema.variant import Material, ScattersBetween, ToleranceRow
from flexlash.validation.cell_values import is_no_value, no_value_facts
from flexlash.validation.grade_texts import meant_grade
from flexlash.validation.ledger import Ledger
from flexlash.validation.number_texts import is_both_ways
from flexlash.validation.validated import Table

__all__ = [
    "BUILT_IN_SHEETS",
    "built_in_materials",
    "built_in_sheet",
    "materials_of",
    "report_doubled",
    "standard_class",
    "tolerance_classes_of",
]

_MATERIAL = {column.key: column for column in MATERIALS}
_TOLERANCE = {column.key: column for column in TOLERANCES}
BUILT_IN_SHEETS = {"Materials": "materials", "Tolerances": "standard_class"}
"""Sheets that a submission may lack, with the table that is used instead."""

_CONSTANTS = ("youngs_modulus_GPa", "poisson_ratio", "shear_modulus_GPa")
"""Columns of which the last, or else the first two, are required."""

_DEVIATIONS = ("lower_deviation", "upper_deviation")


def built_in_sheet(schema: str) -> RawSheet:
    """Return a built-in table as it would stand on its sheet."""
    columns = [column for column in ENTRY_SHEETS[schema] if column.key != "tolerance_class"]
    rows: dict[int, dict[int, RawValue]] = {1: {index: column.label for index, column in enumerate(columns, start=1)}}
    for number, row in enumerate(tables.rows(BUILT_IN_SHEETS[schema]), start=2):
        rows[number] = {
            index: float(row[column.key]) if column.is_number else row[column.key]
            for index, column in enumerate(columns, start=1)
            if row.get(column.key)
        }
    return RawSheet(name=schema, rows=rows)


def built_in_materials() -> dict[str, Material]:
    """Return the materials of the template by plain name."""
    numeric = {key for key, column in _MATERIAL.items() if column.is_number}
    return {
        plain(row["material"]): _material(
            {key: float(text) for key, text in row.items() if key in numeric and text}, row["material"]
        )
        for row in tables.rows("materials")
    }


def _material(record: Mapping[str, Any], name: str) -> Material:
    """Return a material in SI."""
    constants = {
        column.dimension: record[column.key] * column.si_unit.si
        for column in MATERIALS
        if column.role == "dimension" and record.get(column.key) is not None
    }
    strength = record.get("yield_MPa")
    return Material(
        name=name,
        constants=constants,
        yield_strength=None if strength is None else strength * _MATERIAL["yield_MPa"].si_unit.si,
    )


def materials_of(table: Table, ledger: Ledger) -> dict[str, Material]:
    """Return the materials of a sheet by plain name; faulty ones are named in the ledger."""
    materials: dict[str, Material] = {}
    doubled = report_doubled(table, ledger, ("material",), "E321")
    for record in table.frame.iter_rows(named=True):
        row, name = record["row"], record["material"]
        if name is None:
            continue
        key = plain(name)
        if row in doubled or any((row, column) in table.faulty for column in _MATERIAL):
            ledger.spoil("material", key, table.sheet, row)
        materials.setdefault(key, _material(record, name))
        _check_constants(table, ledger, record, key)
    return materials


def _check_constants(table: Table, ledger: Ledger, record: Mapping[str, Any], material: str) -> None:
    """Require G, or E and ν, and tell when all three are given and disagree."""
    row = record["row"]
    if any((row, key) in table.faulty for key in _CONSTANTS):
        return
    young, poisson, shear = (record[key] for key in _CONSTANTS)
    if shear is None:
        for key, value in (("youngs_modulus_GPa", young), ("poisson_ratio", poisson)):
            if value is None:
                ledger.spoil("material", material, table.sheet, row)
                _report(table, ledger, "E322", row, key)
    elif (
        young is not None
        and poisson is not None
        and not any((table.sheet, row, key) in ledger.unit_mistakes for key in _CONSTANTS)
    ):
        implied = young / (2 * (1 + poisson))
        if abs(shear / implied - 1) > 5e-4:  # noqa: PLR2004
            _report(table, ledger, "W404", row, "shear_modulus_GPa", value=shear, other=implied)


def report_doubled(table: Table, ledger: Ledger, keys: tuple[str, ...], code: str) -> set[int]:
    """Report every row whose keys another row has too, each with its partners; return the rows."""
    groups: dict[tuple[str, ...], list[int]] = defaultdict(list)
    for row, *names in table.frame.select("row", *keys).iter_rows():
        if all(name is not None for name in names):
            groups[tuple(plain(name) for name in names)].append(row)
    doubled = {row: others for rows in groups.values() for row, others in table.partners(rows, keys[-1])}
    for row, others in doubled.items():
        _report(table, ledger, code, row, keys[-1], value=table.entered(row, keys[-1]), other=others)
    return set(doubled)


def _report(table: Table, ledger: Ledger, code: str, row: int, key: str, **facts: Any) -> None:
    """Record a finding at a cell of a Materials, Tolerances or Settings row."""
    columns = _MATERIAL if table.schema == "Materials" else _TOLERANCE
    name = columns[key].name if key in columns else "Setting"
    ledger.add(code, sheet=table.sheet, cell=table.address(row, key), column=key, name=name, **facts)


def standard_class() -> list[ToleranceRow]:
    """Return the built-in class `standard`."""
    entries = []
    for row in tables.rows("standard_class"):
        record: dict[str, Any] = {key: text or None for key, text in row.items()}
        for key in ("lower_deviation", "upper_deviation", "limits_sigma"):
            record[key] = float(record[key]) if record[key] else None
        entries.append(_tolerance_row({"row": 0, "tolerance_class": "standard", **record}))
    return entries


def _tolerance_row(record: Mapping[str, Any]) -> ToleranceRow:
    """Return a valid tolerance row in SI."""
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
        scatters_between=record.get("scatters_between") or _usual_scatter(record["dimension"]),
        **given,
    )


def _usual_scatter(dimension: str) -> ScattersBetween:
    """Return between what a dimension scatters where Tolerances does not say."""
    return "lots" if dimension in LOT_DIMENSIONS else "parts"


def tolerance_classes_of(table: Table, ledger: Ledger) -> dict[str, list[ToleranceRow]]:
    """Return the tolerance classes of a sheet by plain name; faulty ones are named in the ledger."""
    classes: dict[str, list[ToleranceRow]] = defaultdict(list)
    doubled = report_doubled(table, ledger, ("tolerance_class", "dimension"), "E319")
    for record in table.frame.iter_rows(named=True):
        row, name = record["row"], record["tolerance_class"]
        if name is None:
            ledger.everything = True
            continue
        key = plain(name)
        classes[key] += []
        sound = _check_tolerance(table, ledger, record) and row not in doubled
        if (
            sound
            and record["dimension"] is not None
            and not any((row, column) in table.faulty for column in _TOLERANCE)
        ):
            classes[key].append(_tolerance_row(record))
            _check_shift(table, ledger, record)
        else:
            ledger.spoil("class", key, table.sheet, row)
    return dict(classes)


def _check_tolerance(table: Table, ledger: Ledger, record: Mapping[str, Any]) -> bool:
    """Check the cells of a tolerance row, as far as they have no fault yet; return whether nothing was found."""
    row = record["row"]
    record = {key: None if (row, key) in table.faulty else value for key, value in record.items()}
    before = len(ledger.findings)
    column, unit = DIMENSIONS.get(record["dimension"]), record["deviation_unit"]
    if column and unit and unit.strip() != "%" and find_unit(unit, column.quantity) is None:
        _report(table, ledger, "E211", row, "deviation_unit", value=unit, dimension=column.dimension, unit=column.unit)
    if record["grade"] is not None:
        _check_grade(table, ledger, record, column)
    elif (row, "grade") not in table.faulty:
        _check_deviations(table, ledger, record)
    return len(ledger.findings) == before


def _check_grade(table: Table, ledger: Ledger, record: Mapping[str, Any], column: Column | None) -> None:
    """Require that a grade stands alone, exists and applies to its dimension, where that is known."""
    row, grade = record["row"], record["grade"]
    if any(record[key] is not None for key in _DEVIATIONS):
        _report(table, ledger, "E316", row, "grade", value=grade)
    elif is_no_value(grade):
        _report(table, ledger, "E221", row, "grade", value=grade, **no_value_facts(_TOLERANCE["grade"]))
    elif not is_grade(grade):
        meant = meant_grade(grade)
        certain_value = None if grade.isdecimal() else meant or None
        _report(table, ledger, "E210", row, "grade", value=grade, suggestion=meant, certain_value=certain_value)
    elif column and (column.quantity != "length" or column.grade_at == "none"):
        _report(table, ledger, "E320", row, "grade", value=grade, other=column.dimension)


def _check_deviations(table: Table, ledger: Ledger, record: Mapping[str, Any]) -> None:
    """Require both deviations, the lower first; one cell that says both is its own finding alone."""
    row, (lower, upper) = record["row"], (record[key] for key in _DEVIATIONS)
    faulty = [str(table.entered(row, key)) for key in _DEVIATIONS if (row, key) in table.faulty]
    for key in _DEVIATIONS:
        if record[key] is None and (row, key) not in table.faulty and not any(map(is_both_ways, faulty)):
            _report(table, ledger, "E317", row, key)
    if lower is not None and upper is not None and lower > upper:
        _report(table, ledger, "E318", row, "lower_deviation", value=lower, other=upper)


def _check_shift(table: Table, ledger: Ledger, record: Mapping[str, Any]) -> None:
    """Warn of deviations that shift a dimension without scatter."""
    lower, upper = (record[key] for key in _DEVIATIONS)
    if lower and lower == upper:
        _report(table, ledger, "W410", record["row"], "upper_deviation", value=upper)
