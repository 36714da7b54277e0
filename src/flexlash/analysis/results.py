"""Numbers of all stages → the Results table: its columns in order, printed units, submitted order."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import polars as pl

from flexlash.analysis.outcome import Outcome
from flexlash.schema.findings import Finding
from flexlash.schema.result_columns import result_columns
from flexlash.schema.units import ARCMIN, RPM, as_entered
from flexlash.schema.variant import Variant
from flexlash.tolerance.spread_statistics import SpreadStatistics
from flexlash.validation.blocking_errors import stopped_by

__all__ = ["result_record", "results_frame", "results_of"]

_HELD_BACK = "held back by --strict, since other rows have errors"
_NAMED = 3
"""Most errors elsewhere that a row of Results names."""

_COLUMNS = result_columns(cross_check=True, elasticity=True)
_STEMS = {column.key: (column.dimension, column.si_unit.si) for column in _COLUMNS if column.quantity} | {
    "stiffness_Nm_per_rad": ("stiffness", 1.0),
    "catalogue_stiffness_Nm_per_rad": ("catalogue_stiffness", 1.0),
    "elasticity_difference_percent": ("elasticity_difference", 0.01),
    "elasticity_error_percent": ("elasticity_error", 0.01),
    "natural_frequency_Hz": ("natural_frequency", 1.0),
    "resonance_speed_rpm": ("resonance_speed", RPM),
    "stiffness_Nm_per_arcmin": ("stiffness", 1 / ARCMIN),
    "ppm_over_limit": ("probability_over_limit", 1e-6),
    "ppm_over_limit_low": ("probability_over_limit_low", 1e-6),
    "ppm_over_limit_high": ("probability_over_limit_high", 1e-6),
}
"""Result key → its SI number's name and the size of the printed unit."""

_ENTERED = frozenset({"backlash_limit_arcmin", "hub_shear_radius_mm"})
"""Results that repeat an entry, the radius where it is the disk's own."""


def result_record(
    variant: Variant, nominal: Mapping[str, float | str | None], spread: SpreadStatistics | None
) -> dict[str, Any]:
    """Return the Results of a computed variant in printed units."""
    numbers: dict[str, Any] = dict(nominal)
    if spread is not None:
        numbers |= spread.numbers | spread.texts
        if spread.shares:
            main = max(spread.shares, key=lambda name: spread.shares[name])
            numbers |= {"main_contributor": main, "main_contributor_share": spread.shares[main]}
            numbers["interaction_share"] = max(1.0 - math.fsum(spread.shares.values()), 0.0)
    numbers["backlash_limit"] = variant.backlash_limit
    record = {}
    for column in _COLUMNS:
        stem, size = _STEMS.get(column.key, (column.key, 1.0))
        value = numbers.get(stem)
        if isinstance(value, float):
            value = as_entered(value, size) if column.key in _ENTERED else value / size
        record[column.key] = value
    return record


def results_frame(
    records: Sequence[Mapping[str, Any]], *, cross_check: bool = False, elasticity: bool = False
) -> pl.DataFrame:
    """Return the Results of all submitted rows; a row with errors keeps its place with empty numbers."""
    columns = result_columns(cross_check=cross_check, elasticity=elasticity)
    types = {column.key: pl.Float64 if column.is_number else pl.String for column in columns}
    return pl.DataFrame([{key: record.get(key) for key in types} for record in records], schema=types, orient="row")


def results_of(outcome: Outcome, *, cross_check: bool = False, elasticity: bool = False) -> pl.DataFrame:
    """Return the Results table, one row per submitted variant in submitted order."""
    if outcome.validated is None:
        return results_frame([])
    by_row: dict[int, list[Finding]] = {}
    sheet = outcome.validated.table.sheet if outcome.validated.table else ""
    for found in outcome.findings:
        if found.sheet == sheet and found.cell and found.level != "info":
            by_row.setdefault(found.row, []).append(found)
    stops = stopped_by(outcome.validated)
    records = []
    for row, name, notes in outcome.validated.submitted:
        mine = by_row.get(row, [])
        one = outcome.computed.get(row)
        listed = ", ".join(f"{found.code} {found.cell}" for found in mine)
        if one is None and not any(found.level == "error" for found in mine):
            listed = ", ".join(filter(None, [listed, _stopped(stops.get(row, []))]))
        record = result_record(one.variant, one.nominal, one.spread) if one else {}
        status = "error" if one is None else "warning" if mine else "ok"
        records.append(
            {**record, "variant": name, "status": status, "notes": notes or None, "findings": listed or None}
        )
    return results_frame(records, cross_check=cross_check, elasticity=elasticity)


def _stopped(errors: list[Finding]) -> str:
    """Return what stops a row that has no error itself: `stopped by E317 Tolerances!F7`."""
    if not errors:
        return _HELD_BACK
    more = f" and {len(errors) - _NAMED} more" if len(errors) > _NAMED else ""
    return f"stopped by {', '.join(f'{found.code} {found.place}' for found in errors[:_NAMED])}{more}"
