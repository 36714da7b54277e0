"""How the numbers of Results are shown: by their unit, and by what their standard error or their size asks for."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from flexlash.report.layout.styles import Book, decimals_of, percent_of
from flexlash.schema.columns import Column
from flexlash.schema.number_words import places, share_error

if TYPE_CHECKING:
    import polars as pl

__all__ = ["ESTIMATED_SHARES", "SHARE_OF_VARIANCE_ERROR", "number_codes", "number_formats", "usual_format"]

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

ESTIMATED_SHARES = frozenset({"main_contributor_share", "interaction_share"})
"""Shares of the variance, which are estimates without a standard error of their own."""

SHARE_OF_VARIANCE_ERROR = 0.002
"""How well a share of the variance is known."""

_NEAR = 1e-6
"""Shares nearer than this to none or all are shown with few decimals."""

_ERRORS = {"elasticity_difference_percent": ("elasticity_error_percent",)}
"""Columns with the error of another one, where it does not follow from the key."""

_NEAR_END = "0.0000%"
"""Number format of a share that is nearly none or all."""

_TWO_DIGITS = 0.1
"""Part of a number to which two digits tell it."""

_PPK = "0.000"
"""Number format of a Ppk, where it is known so well."""

_LEAST_DECIMAL = 1e-4
"""Standard errors below it are shown as powers of ten."""


def usual_format(column: Column) -> str:
    """Return the number format of a column where nothing else asks for another."""
    key = column.key
    if key.startswith("stiffness"):
        return "stiffness"
    if key in ESTIMATED_SHARES:
        return percent_of(SHARE_OF_VARIANCE_ERROR)
    if "share" in key or "probability" in key or key == "lots_failing":
        return "share"
    return _USUAL.get(key) or _UNITS.get(column.unit, "plain")


def number_formats(book: Book, results: pl.DataFrame, column: Column) -> list[Any]:
    """Return a format for each number of a column."""
    return [book.format("text", code) for code in number_codes(results, column)]


def number_codes(results: pl.DataFrame, column: Column) -> list[str]:
    """Return the number format of each number of a column, by name or in Excel's letters."""
    values, usual = results[column.key].to_list(), usual_format(column)
    stem, _, unit = column.key.rpartition("_")
    if "standard_error" in column.key:
        return [_of_error(value) for value in values]
    if column.key.startswith(("probability", "ppm")):
        rough = "_sample_" in column.key
        return [_of_guess(value) for value in values] if rough else _of_shares(results, column.key, values)
    if column.key in _WORKED_OUT:
        work_out, needed = _WORKED_OUT[column.key]
        errors = [work_out(row) for row in results.select(column.key, *needed).iter_rows(named=True)]
        if usual == "share":
            return [percent_of(error) for error in errors]
        return [min(decimals_of(error, usual), _PPK, key=len) for error in errors]
    error = next(
        (
            key
            for key in (*_ERRORS.get(column.key, ()), f"{stem}_standard_error_{unit}", f"{column.key}_standard_error")
            if key in results
        ),
        "",
    )
    if not error:
        return [usual] * results.height
    errors = results[error].to_list()
    known = usual if column.unit == "arcsec" else "arcmin" if unit else "plain"
    return _share_codes(values, errors, 1.0) if usual == "share" else [decimals_of(one, known) for one in errors]


def _ppk_error(row: dict[str, Any]) -> float | None:
    """Return the standard error of the percentile-based Ppk, from those of its percentiles; None without a limit."""
    ppk, reach = row["ppk"], (row["p99_865_arcmin"] or 0.0) - (row["p50_arcmin"] or 0.0)
    if ppk is None or not reach > 0:
        return None
    median, tail = row["p50_standard_error_arcmin"], row["p99_865_standard_error_arcmin"]
    return float(math.hypot((ppk - 1) * median, ppk * tail) / reach)


def _ppk_normal_error(row: dict[str, Any]) -> float | None:
    """Return the standard error of Ppk by normal theory, from those of mean and sd; None without a limit."""
    ppk, sd = row["ppk_normal"], row["sd_arcmin"]
    if ppk is None or not sd:
        return None
    return float(math.hypot(row["mean_standard_error_arcmin"], 3 * ppk * row["sd_standard_error_arcmin"]) / (3 * sd))


def _counted_error(row: dict[str, Any]) -> float | None:
    """Return the standard error of a share that plain draws were counted for; None without a limit."""
    share = row["random_probability_over_limit"]
    return None if share is None else math.sqrt(float(share * (1 - share) / row["random_points"]))


_OF_PERCENTILES = tuple(f"{one}{error}_arcmin" for one in ("p50", "p99_865") for error in ("", "_standard_error"))
_OF_MOMENTS = ("sd_arcmin", "mean_standard_error_arcmin", "sd_standard_error_arcmin")

_WORKED_OUT: dict[str, tuple[Callable[[dict[str, Any]], float | None], tuple[str, ...]]] = {
    "ppk": (_ppk_error, _OF_PERCENTILES),
    "ppk_normal": (_ppk_normal_error, _OF_MOMENTS),
    "random_probability_over_limit": (_counted_error, ("random_points",)),
}
"""Numbers whose standard error follows from those of others, and the keys of these."""


def _of_error(error: float | None) -> str:
    """Return the number format that shows two digits of a standard error.

    >>> _of_error(0.0213), _of_error(12.0), _of_error(7.1e-6)
    ('0.000', '0', '0.0E+00')
    """
    if not error:
        return "0"
    if error < _LEAST_DECIMAL:
        return "0.0E+00"
    digits = max(0, 1 + places(error))
    return f"0.{'0' * digits}" if digits else "0"


def _of_guess(share: float | None) -> str:
    """Return the number format that shows two digits of a share that is not known well.

    >>> _of_guess(0.0123), _of_guess(1.2e-5), _of_guess(0.0), _of_guess(0.9994)
    ('0.0%', '0.0000%', '0.0000%', '0.000%')
    """
    known = share or 0.0
    return percent_of(max(min(known, 1 - known) * _TWO_DIGITS, _NEAR))


def _of_shares(results: pl.DataFrame, key: str, values: list[float | None]) -> list[str]:
    """Return a number format for each share over the limit, or its bounds, down to the share's standard error."""
    stem = key.removesuffix("_low").removesuffix("_high")
    ends = zip(results[f"{stem}_low"].to_list(), results[f"{stem}_high"].to_list(), strict=True)
    errors = [None if low is None else share_error(low, high) for low, high in ends]
    return _share_codes(values, errors, 1e6 if key.startswith("ppm") else 1.0)


def _share_codes(values: list[float | None], errors: list[float | None], whole: float) -> list[str]:
    """Return a number format for each share of a whole, down to its standard error."""
    near_end = _NEAR_END if whole == 1.0 else "#,##0.0##"
    formats = []
    for value, error in zip(values, errors, strict=True):
        if value is not None and not _NEAR * whole <= value <= (1 - _NEAR) * whole:
            formats.append(near_end)
        else:
            formats.append(percent_of(error) if whole == 1.0 else decimals_of(error, "count"))
    return formats
