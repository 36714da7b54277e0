"""How the numbers of Results are shown: by their unit, and by what their standard error or their size asks for."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from flexlash.columns import Column
from flexlash.report.styles import Book, decimals_of, percent_of

if TYPE_CHECKING:
    import polars as pl

__all__ = ["number_formats", "usual_format"]

_UNITS = {
    "rad": "rad",
    "arcmin": "arcmin",
    "arcsec": "arcsec",
    "MPa": "stress",
    "ppm": "count",
    "rpm": "count",
    "Hz": "stress",
    "N·m": "stiffness",
}
_USUAL = {
    "catalogue_size": "0",
    "catalogue_stiffness_Nm_per_rad": "count",
    "spread_points": "count",
    "random_points": "count",
}
"""Number formats of columns whose unit does not say how they are shown: whole numbers."""

_NEAR = 1e-6
"""Shares nearer than this to none or all are shown with few decimals."""

_LEAST_DECIMAL = 1e-4
"""Standard errors below it are shown as powers of ten."""


def usual_format(column: Column) -> str:
    """Return the number format of a column where nothing else asks for another."""
    key = column.key
    if key.startswith("stiffness"):
        return "stiffness"
    if "share" in key or "probability" in key:
        return "share"
    return _USUAL.get(key) or _UNITS.get(column.unit, "plain")


def number_formats(book: Book, results: pl.DataFrame, column: Column) -> list[Any]:
    """Return a format for each number of a column."""
    values, usual = results[column.key].to_list(), usual_format(column)
    stem, _, unit = column.key.rpartition("_")
    if "standard_error" in column.key:
        return [book.format("text", _of_error(value)) for value in values]
    if column.key.startswith(("probability", "ppm")):
        return _of_shares(book, results, column.key, values)
    error = next(
        (key for key in (f"{stem}_standard_error_{unit}", f"{column.key}_standard_error") if key in results), ""
    )
    if not error:
        return [book.format("text", usual)] * results.height
    return [book.format("text", decimals_of(one, "arcmin" if unit else "plain")) for one in results[error].to_list()]


def _of_error(error: float | None) -> str:
    """Return the number format that shows two digits of a standard error.

    >>> _of_error(0.0213), _of_error(12.0), _of_error(7.1e-6)
    ('0.000', '0', '0.0E+00')
    """
    if not error:
        return "0"
    if error < _LEAST_DECIMAL:
        return "0.0E+00"
    places = max(0, 1 - math.floor(math.log10(error)))
    return f"0.{'0' * places}" if places else "0"


def _of_shares(book: Book, results: pl.DataFrame, key: str, values: list[float | None]) -> list[Any]:
    """Return a format for each share over the limit, or its bounds, its digits limited by half their distance."""
    stem = key.removesuffix("_low").removesuffix("_high")
    ends = zip(results[f"{stem}_low"].to_list(), results[f"{stem}_high"].to_list(), strict=True)
    halves = [None if low is None else (high - low) / 2 for low, high in ends]
    whole, near_end = (1e6, "#,##0.0##") if key.startswith("ppm") else (1.0, "0.0000%")
    formats = []
    for value, half in zip(values, halves, strict=True):
        if value is not None and not _NEAR * whole <= value <= (1 - _NEAR) * whole:
            formats.append(book.format("text", near_end))
        else:
            formats.append(book.format("text", percent_of(half) if whole == 1.0 else decimals_of(half, "count")))
    return formats
