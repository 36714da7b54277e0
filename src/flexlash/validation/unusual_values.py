"""Values that may stand in a cell, but lie far from what is usual and are no mistake of the unit: a warning each."""

from __future__ import annotations

from collections.abc import Iterator

import polars as pl

from flexlash.schema.columns import Column, columns_of
from flexlash.schema.findings import spelled_out
from flexlash.validation.ledger import Ledger
from flexlash.validation.unit_mistakes import SHARES
from flexlash.validation.validated import Table

__all__ = ["report_unusual", "unusual_words"]

_BEYOND = 10.0
"""How far beyond the proportions of known flexsplines a length must lie to be told."""

_TORQUES = (1e-3, 1e3)
"""Rated torque over the torque of the row."""


def report_unusual(table: Table, ledger: Ledger) -> None:
    """Warn of each cell of a table that is far from usual, but of none in a row where a unit is mistaken."""
    mistaken = {row for sheet, row, _ in ledger.unit_mistakes if sheet == table.sheet}
    for key, low, high in _ranges(table.schema):
        strange = table.frame.filter(~pl.col(key).is_between(low, high)).select("row", key, low=low, high=high)
        for row, value, least, most in strange.iter_rows():
            if (row, key) in table.faulty or row in mistaken:
                continue
            column = columns_of(table.schema)[key]
            told = {"value": f"{value:.10g}", "detail": _words(column, least, most), "name": column.name}
            ledger.add("W440", sheet=table.sheet, cell=table.address(row, key), column=key, rows=(), **told)


def unusual_words(column: Column, value: float) -> str:
    """Return what is usual for a column, in words, where a value is not; else an empty text.

    >>> from flexlash.schema.columns import SETTINGS
    >>> factor = next(one for one in SETTINGS if one.key == "disk_calibration")
    >>> unusual_words(factor, 0.2), unusual_words(factor, 0.9)
    ('0.5 to 2.5', '')
    """
    low, high = column.usual or (value, value)
    return "" if low <= value <= high else _words(column, low, high)


def _words(column: Column, low: float, high: float) -> str:
    return f"{spelled_out(low)} to {spelled_out(high)}{column.unit_behind}"


def _ranges(schema: str) -> Iterator[tuple[str, pl.Expr, pl.Expr]]:
    """Yield the columns of a sheet that have a usual range, with its ends."""
    for key, column in columns_of(schema).items():
        if column.usual:
            low, high = column.usual
            yield key, pl.lit(float(low)), pl.lit(float(high))
    if schema == "Variants":
        radius = pl.coalesce("mean_radius_mm", pl.col("bore_diameter_mm") / 2)
        for key, (least, most) in SHARES.items():
            # A fillet of 0 is none.
            least_length = pl.when(pl.col(key) == 0).then(0.0).otherwise(least / _BEYOND * radius)
            yield key, least_length, most * _BEYOND * radius
        yield "rated_torque_Nm", pl.col("torque_Nm") * _TORQUES[0], pl.col("torque_Nm") * _TORQUES[1]
