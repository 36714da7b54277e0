"""A Parquet file's bytes → its cells."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

from flexlash.reading.parquet_file import check_file
from flexlash.reading.raw import RawSheet, RawValue
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.xlsx import Cells

if TYPE_CHECKING:
    import polars as pl

__all__ = ["is_inexact", "read_parquet", "values_of"]

_MEBI = 2**20
_EXACT = 2**53
"""Up to here every whole number is a double, as a workbook's numbers are."""

_A_DAY = {"day": 1, "ms": 86_400 * 10**3, "us": 86_400 * 10**6}
"""Units of dates and times by their number in a day; in nanoseconds none lies too far away."""

_DATES = (-719_160, 2_932_890)
_DAYS = 99_000_000
"""Days from 1970 to the years 1 and 9999, and the most days of a duration."""

_FAR = "a date or time beyond the year 9999"


def read_parquet(data: bytes, limits: ReadingLimits | None = None) -> Cells:
    """Return a Parquet file as a sheet whose header stands in row 1.

    Raises Refusal when it is damaged, differs from its checksums, or exceeds a limit.
    """
    import polars as pl

    limits = limits or ReadingLimits()
    check_file(data, limits)
    try:
        frame = pl.read_parquet(io.BytesIO(data))
        columns = [values_of(series, limits) for series in frame.get_columns()]
    except (MemoryError, Refusal):
        raise
    except BaseException as fault:
        # On damaged files polars panics, which is no Exception.
        if isinstance(fault, KeyboardInterrupt | SystemExit):
            raise
        raise Refusal("E102") from fault
    limits.require("characters", max(map(len, frame.columns), default=0))
    rows: dict[int, dict[int, RawValue]] = {1: dict(enumerate(frame.columns, start=1))}
    for row, values in enumerate(zip(*columns, strict=True), start=2):
        cells = {column: value for column, value in enumerate(values, start=1) if value is not None}
        if cells:
            rows[row] = cells
    return Cells(sheets=[RawSheet(name="Variants", rows=rows)])


def values_of(series: pl.Series, limits: ReadingLimits) -> list[Any]:
    """Return a column's values as cells hold them: what is neither number, text, truth value nor date as a text."""
    import polars as pl

    kind = series.dtype
    if kind.is_decimal() or (kind.is_integer() and is_inexact(series)):
        return series.cast(pl.Float64).to_list()
    if kind.is_numeric() or kind in {pl.Boolean, pl.Null}:
        return series.to_list()
    if kind.is_temporal():
        return _moments(series)
    if kind == pl.Binary:
        return [
            None if value is None else _checked(value.decode(errors="backslashreplace"), limits) for value in series
        ]
    if isinstance(kind, pl.Categorical | pl.Enum):
        series = series.cast(pl.String)
    if series.dtype == pl.String:
        # A dictionary holds a long text once however many rows share it; Python would hold it once a row.
        longest = series.str.len_chars().max()
        limits.require("characters", longest if isinstance(longest, int) else 0)
        limits.require("unpacked_mebibytes", int(series.str.len_bytes().sum()) / _MEBI)
        return series.to_list()
    return [None if value is None else _checked(str(value), limits) for value in series.to_list()]


def is_inexact(series: pl.Series) -> bool:
    """Whether a column of whole numbers holds one beyond those that are doubles."""
    least, most = series.min(), series.max()
    return least is not None and not -_EXACT <= least <= most <= _EXACT  # type: ignore[operator]


def _moments(series: pl.Series) -> list[Any]:
    """Return dates, times and durations, in words those that Python has no date for."""
    import polars as pl

    kind = series.dtype
    unit = "day" if kind == pl.Date else getattr(kind, "time_unit", None)
    if unit not in _A_DAY:
        return series.to_list()
    low, high = (-_DAYS, _DAYS) if kind == pl.Duration else _DATES
    fits = series.to_physical().is_between(low * _A_DAY[unit], high * _A_DAY[unit])
    values = pl.select(pl.when(fits).then(series)).to_series().to_list()
    return [_FAR if fit is False else value for fit, value in zip(fits, values, strict=True)]


def _checked(text: str, limits: ReadingLimits) -> str:
    limits.require("characters", len(text))
    return text
