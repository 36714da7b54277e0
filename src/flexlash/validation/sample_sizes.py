"""Samples beside the entered values of the variants that use them: whole columns measured in another unit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import polars as pl

from flexlash.schema.cell_addresses import CellAddress
from flexlash.schema.column import Column
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.findings import spelled_out
from flexlash.schema.spellings import plain
from flexlash.schema.units import find_unit
from flexlash.schema.variant import MeasuredDimension
from flexlash.validation.ledger import Ledger
from flexlash.validation.measured_samples import Samples
from flexlash.validation.validated import Table

__all__ = ["report_sample_sizes"]

_OTHER = 5.0
"""Times from which the middle of a sample is another size than the entered value."""

_SAME = 0.5
"""Share of the entered value from which on a deviation is rather the size itself."""

_NEAR = 0.2
"""How near, as a share, sizes in another unit must come to the entered ones."""

_UNITS = {
    "length": ("mm", "µm", "m", "cm", "in", "mil"),
    "torque": ("N·m", "N·mm", "kN·m", "lbf·in"),
    "angle": ("°", "rad", "arcmin"),
}
"""Units in which people measure, of each quantity."""


def report_sample_sizes(samples: Samples, tolerances: Table | None, variants: Table, ledger: Ledger) -> None:
    """Warn once of each column of a sample whose values are many times what variants of its class have there."""
    table = samples.table
    if table is None or tolerances is None or not samples.dimensions:
        return
    told: set[tuple[str, str]] = set()
    for sample, entered in _used(samples, tolerances, variants):
        column = DIMENSIONS[sample.dimension]
        detail, unit = _judged(sample, entered, table.heading.factors[column.key] * column.si_unit.si)
        if detail and (plain(sample.sample), sample.dimension) not in told:
            told.add((plain(sample.sample), sample.dimension))
            cell = CellAddress(row=table.heading.row, column=table.heading.columns[column.key])
            facts: dict[str, Any] = {"column": column.key, "name": column.name, "other": sample.sample}
            suggestion = f"{column.name} [{unit}]" if unit else ""
            ledger.add("W454", sheet=table.sheet, cell=cell, detail=detail, suggestion=suggestion, **facts)


def _used(samples: Samples, tolerances: Table, variants: Table) -> Iterator[tuple[MeasuredDimension, float]]:
    """Yield each sample that a row of Tolerances names with the middle [SI] of what variants of its class have there.

    Of a class that has none itself, as one that others are based on, it is the middle of all variants.
    """
    keys = [column.key for column in DIMENSIONS.values() if column.sheet == "Variants"]
    frame = variants.frame.select(pl.col("tolerance_class").fill_null("standard"), *keys)
    of_all = frame.select(pl.col(*keys).median()).row(0, named=True)
    groups = frame.group_by("tolerance_class", maintain_order=True).agg(pl.col(*keys).median())
    of_class = {plain(record["tolerance_class"]): record for record in groups.iter_rows(named=True)}
    named = tolerances.frame.select("tolerance_class", "sample", "dimension").drop_nulls()
    for name, sample, dimension in named.iter_rows():
        measured = samples.dimensions.get(plain(sample), {}).get(dimension)
        column = DIMENSIONS.get(dimension)
        if measured is not None and column is not None:
            entered = of_class.get(plain(name), of_all).get(column.key)
            if entered and entered > 0:
                yield measured, entered * column.si_unit.si


def _judged(sample: MeasuredDimension, entered: float, unit: float) -> tuple[str, str]:
    """Return in words what is odd about the size of a sample, and its probable unit; empty texts for nothing."""
    column = DIMENSIONS[sample.dimension]
    middle = sorted(sample.values)[len(sample.values) // 2]
    ratio = middle / entered
    shown = f"the entered {spelled_out(entered / column.si_unit.si, 6)} {column.unit}".rstrip(" -")
    if sample.are_deviations:
        return (f"deviations as large as {shown} itself", "") if _SAME < ratio < 1 / _SAME else ("", "")
    # Sizes below 0 have an error of their own.
    if min(sample.values) <= 0 or 1 / _OTHER < ratio < _OTHER:
        return "", ""
    times = f"{spelled_out(ratio, 2)} times" if ratio > 1 else f"a {spelled_out(1 / ratio, 2)}th of"
    return f"about {times} {shown}", _probable_unit(column, unit / ratio)


def _probable_unit(column: Column, meant: float) -> str:
    """Return the one unit of about this size [SI], an empty text where there is none."""
    for text in _UNITS.get(column.quantity, ()):
        unit = find_unit(text, column.quantity)
        if unit is not None and math.isclose(unit.si, meant, rel_tol=_NEAR):
            return text
    return ""
