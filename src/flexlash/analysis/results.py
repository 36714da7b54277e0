"""Numbers of all stages → the Results table, column by column: printed units, submitted order."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import asdict, fields

import polars as pl

from flexlash.analysis.computed import ComputedRows, Elasticity
from flexlash.schema.column import Column
from flexlash.schema.findings import Finding
from flexlash.schema.result_columns import result_columns
from flexlash.schema.units import ARCMIN, RPM, as_entered
from flexlash.validation.column_schemas import checked_results
from flexlash.validation.validated import Table

__all__ = ["empty_results", "results_of"]

_HELD_BACK = "held back by --strict, since other rows have errors"
_NAMED = 3
"""Most errors elsewhere that a row of Results names."""

_COLUMNS = result_columns(cross_check=True, elasticity=True)
_STEMS = {column.key: (column.dimension, column.si_unit.si) for column in _COLUMNS if column.quantity} | {
    "stiffness_Nm_per_rad": ("stiffness", 1.0),
    "catalogue_stiffness_Nm_per_rad": ("catalogue_stiffness", 1.0),
    "elasticity_difference_percent": ("elasticity_difference", 0.01),
    "elasticity_error_percent": ("elasticity_error", 0.01),
    "two_lobe_low_arcmin": ("elasticity_two_lobe_low", ARCMIN),
    "two_lobe_high_arcmin": ("elasticity_two_lobe_high", ARCMIN),
    "face_width_change_percent": ("elasticity_face_width_change", 0.01),
    "natural_frequency_Hz": ("natural_frequency", 1.0),
    "resonance_speed_rpm": ("resonance_speed", RPM),
    "stiffness_Nm_per_arcmin": ("stiffness", 1 / ARCMIN),
    "ppm_over_limit": ("probability_over_limit", 1e-6),
    "ppm_over_limit_low": ("probability_over_limit_low", 1e-6),
    "ppm_over_limit_high": ("probability_over_limit_high", 1e-6),
}
"""Result key → its SI number's name and the size of the printed unit."""

_ENTERED = frozenset({"backlash_limit_arcmin", "system_limit_arcmin", "hub_shear_radius_mm"})
"""Results that repeat an entry, the radius where it is the disk's own."""

_ELASTICITY = [one.name for one in fields(Elasticity)]


def empty_results() -> pl.DataFrame:
    """Return the Results of a file that is no submission: its columns without a row."""
    return pl.DataFrame(schema={column.key: _type(column) for column in result_columns()})


def results_of(
    table: Table,
    computed: ComputedRows,
    findings: Iterable[Finding],
    stops: Mapping[int, Sequence[Finding]],
    columns: Sequence[Column],
) -> pl.DataFrame:
    """Return these columns of Results, one row per submitted variant in submitted order.

    `findings` are all of them; a row that is not `computed` keeps its place with empty numbers and says which of them,
    or of the errors elsewhere that are its `stops`, are why.
    """
    known = _known(table, computed)
    numbers = known.select("row", *(_column(column, known) for column in columns if column.key not in _OF_THE_ROW))
    rows = table.frame.select("row", pl.col("variant").fill_null(""), pl.col("notes").replace("", None))
    remarks = _remarks(table, computed.keys(), findings, stops)
    joined = rows.join(remarks, on="row", how="left", maintain_order="left")
    joined = joined.join(numbers, on="row", how="left", maintain_order="left")
    return checked_results(joined.select(column.key for column in columns), columns)


_OF_THE_ROW = frozenset({"variant", "notes", "status", "findings"})
"""Results that a row has whether or not it is computed."""


def _type(column: Column) -> type[pl.DataType]:
    return pl.Float64 if column.is_number else pl.String


def _known(table: Table, computed: ComputedRows) -> pl.DataFrame:
    """Return all that is known of the computed variants: numbers [SI] and words by name, with their row number."""
    known = pl.DataFrame(schema={"row": pl.Int64}) if computed.numbers is None else computed.numbers
    limits = [
        pl.Series(name, table.frame[f"{name}_arcmin"].to_numpy() * ARCMIN, nan_to_null=True)
        for name in ("backlash_limit", "system_limit")
    ]
    beside = [table.frame.select("row", *limits)]
    if computed.statistics is not None:
        beside += [computed.statistics.frame, computed.statistics.main_shares()]
    if computed.checks:
        checks = [asdict(check) for check in computed.checks.values()]
        elasticity = pl.DataFrame(checks, schema=dict.fromkeys(_ELASTICITY, pl.Float64))
        beside.append(
            elasticity.rename(lambda name: f"elasticity_{name}").with_columns(row=pl.Series(list(computed.checks)))
        )
    for frame in beside:
        known = known.join(frame, on="row", how="left", maintain_order="left")
    return known


def _column(column: Column, known: pl.DataFrame) -> pl.Series:
    """Return one column of the computed variants in its printed unit, null where no stage has found it."""
    stem, size = _STEMS.get(column.key, (column.key, 1.0))
    if stem not in known.columns:
        return pl.Series(column.key, [None] * known.height, dtype=_type(column))
    values = known[stem]
    if not column.is_number:
        return values.cast(pl.String).alias(column.key)
    if column.key in _ENTERED:
        entered = [None if value is None else as_entered(value, size) for value in values.to_list()]
        return pl.Series(column.key, entered, dtype=pl.Float64)
    # Not by polars, which multiplies by the reciprocal: that is another last digit.
    return pl.Series(column.key, values.to_numpy() / size).set(values.is_null(), None)


def _remarks(
    table: Table, computed: Collection[int], findings: Iterable[Finding], stops: Mapping[int, Sequence[Finding]]
) -> pl.DataFrame:
    """Return status and findings of every row: those at its own cells, else what elsewhere stops it."""
    own: dict[int, list[Finding]] = defaultdict(list)
    for found in findings:
        if found.sheet == table.sheet and found.cell and found.level != "info":
            own[found.row].append(found)
    records, computed = [], frozenset(computed)
    for row in table.frame["row"]:
        named = [f"{found.code} {found.cell}" for found in own[row]]
        if row not in computed and not any(found.level == "error" for found in own[row]):
            named.append(_stopped(stops.get(row, ())))
        status = "error" if row not in computed else "warning" if own[row] else "ok"
        records.append((row, status, ", ".join(named) or None))
    return pl.DataFrame(records, schema={"row": pl.Int64, "status": pl.String, "findings": pl.String}, orient="row")


def _stopped(errors: Sequence[Finding]) -> str:
    """Return what stops a row that has no error itself: `stopped by E317 Tolerances!F7`."""
    if not errors:
        return _HELD_BACK
    more = f" and {len(errors) - _NAMED} more" if len(errors) > _NAMED else ""
    return f"stopped by {', '.join(f'{found.code} {found.place}' for found in errors[:_NAMED])}{more}"
