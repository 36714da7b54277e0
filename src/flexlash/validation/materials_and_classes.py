"""Materials and Tolerances: from typed tables, or built in, to records in SI."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from flexlash.reading.raw import RawSheet, RawValue
from flexlash.schema import tables
from flexlash.schema.columns import ENTRY_SHEETS, MATERIALS, TOLERANCES
from flexlash.schema.spellings import plain
from flexlash.schema.variant import Material, ToleranceRow
from flexlash.validation.class_bases import ClassBases, class_names
from flexlash.validation.ledger import Ledger
from flexlash.validation.measured_samples import Samples
from flexlash.validation.named_samples import NamedSamples
from flexlash.validation.process_entries import check_process, check_verdict
from flexlash.validation.tolerance_rows import check_limits, standard_class, tolerance_row, warn_of_shift
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
    beside = {
        key: None if record.get(key) is None else record[key] * _MATERIAL[key].si_unit.si
        for key in ("yield_MPa", "density_kg_m3")
    }
    return Material(
        name=name,
        constants=constants,
        yield_strength=beside["yield_MPa"],
        density=beside["density_kg_m3"],
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
                ledger.add_in(table, "E322", row, key)
    elif (
        young is not None
        and poisson is not None
        and not any((table.sheet, row, key) in ledger.unit_mistakes for key in _CONSTANTS)
    ):
        implied = young / (2 * (1 + poisson))
        if abs(shear / implied - 1) > 5e-4:  # noqa: PLR2004
            ledger.add_in(table, "W404", row, "shear_modulus_GPa", value=shear, other=implied)


def report_doubled(table: Table, ledger: Ledger, keys: tuple[str, ...], code: str) -> set[int]:
    """Report every row whose keys another row has too, each with its partners; return the rows."""
    groups: dict[tuple[str, ...], list[int]] = defaultdict(list)
    for row, *names in table.frame.select("row", *keys).iter_rows():
        if all(name is not None for name in names):
            groups[tuple(plain(name) for name in names)].append(row)
    doubled = {row: others for rows in groups.values() for row, others in table.partners(rows, keys[-1])}
    for row, others in doubled.items():
        ledger.add_in(table, code, row, keys[-1], value=table.entered(row, keys[-1]), other=others)
    return set(doubled)


def tolerance_classes_of(table: Table, ledger: Ledger, samples: Samples | None = None) -> dict[str, list[ToleranceRow]]:
    """Return the tolerance classes of a sheet by plain name, with what they take over from those they are based on.

    Faulty classes are named in the ledger, also those based on one.
    """
    classes: dict[str, list[ToleranceRow]] = {}
    doubled = report_doubled(table, ledger, ("tolerance_class", "dimension"), "E319")
    bases, named = ClassBases(table, ledger), NamedSamples(table, ledger, samples or Samples())
    for entered in table.frame.iter_rows(named=True):
        row, name = entered["row"], entered["tolerance_class"]
        if name is None:
            ledger.everything = True
            continue
        record = {key: None if (row, key) in table.faulty else value for key, value in entered.items()}
        record["tolerance_class"], key = name, plain(name)
        classes.setdefault(key, [])
        if bases.take(record):
            continue
        found = _sound_row(table, ledger, record, named)
        if found is None or row in doubled:
            ledger.spoil("class", key, table.sheet, row)
        else:
            classes[key].append(found)
    return bases.resolved(classes, class_names(table), standard_class())


_LIMITS = ("lower_deviation", "upper_deviation", "deviation_unit", "grade")


def _lacks_dimension(table: Table, record: Mapping[str, Any]) -> bool:
    """Whether a row has no dimension, where that is not said of the header already."""
    columns, doubtful = table.heading.columns, table.heading.doubtful.values()
    is_read = "dimension" in columns or ("based_on" in columns and "dimension" not in doubtful)
    return is_read and record["dimension"] is None and (record["row"], "dimension") not in table.faulty


def _sound_row(table: Table, ledger: Ledger, record: Mapping[str, Any], samples: NamedSamples) -> ToleranceRow | None:
    """Return a row of Tolerances for a dimension, or None where something is wrong with it, which is told."""
    row, before = record["row"], len(ledger.findings)
    if _lacks_dimension(table, record):
        requirement = f"{_TOLERANCE['dimension'].requirement}, or the name of a class to base this one on,"
        ledger.add_in(table, "E201", row, "dimension", requirement=requirement)
    if record["dimension"] is not None or any(record[key] is not None for key in _LIMITS):
        check_limits(table, ledger, record)
    check_process(table, ledger, record)
    sample = samples.of(record)
    is_sound = not any(found.level == "error" for found in ledger.findings[before:])
    if not is_sound or record["dimension"] is None or any((row, key) in table.faulty for key in _TOLERANCE):
        return None
    if record["sample"] is not None and sample is None:
        return None
    found = tolerance_row(record, sample)
    warn_of_shift(table, ledger, record)
    return found if check_verdict(table, ledger, record, found) else None
