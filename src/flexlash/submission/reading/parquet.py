"""A Parquet file's bytes → its cells."""

from __future__ import annotations

import io

from flexlash.submission.reading.raw import RawSheet, RawValue
from flexlash.submission.reading.refusal import Refusal
from flexlash.submission.reading.workbook import Cells

__all__ = ["read_parquet"]


def read_parquet(data: bytes) -> Cells:
    """Return a Parquet file as a sheet whose header stands in row 1; raise Refusal when it is damaged."""
    import polars as pl
    from polars import selectors

    try:
        frame = pl.read_parquet(io.BytesIO(data)).with_columns(selectors.decimal().cast(pl.Float64))
    except MemoryError:
        raise
    except BaseException as fault:
        # On damaged files polars panics, which is no Exception.
        raise Refusal("E102") from fault
    rows: dict[int, dict[int, RawValue]] = {1: dict(enumerate(frame.columns, start=1))}
    for number, values in enumerate(frame.iter_rows(), start=2):
        cells = {place: value for place, value in enumerate(values, start=1) if value is not None}
        if cells:
            rows[number] = cells
    return Cells(sheets=[RawSheet(name="Variants", rows=rows)])
