"""Bytes → sheets of raw cells at their own addresses; no judgement of what they hold."""

from __future__ import annotations

import hashlib
import io
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from flexlash.submission.delimited import read_table
from flexlash.submission.gate import Admitted, Refusal, admit, read_bytes
from flexlash.submission.raw import (
    ERROR_WORDS,
    ErrorCell,
    RawSheet,
    RawValue,
    Submission,
    Unstored,
    column_letters,
)

__all__ = [
    "ErrorCell",
    "RawSheet",
    "RawValue",
    "Submission",
    "Unstored",
    "column_letters",
    "read_submission",
    "read_table",
]

PROPERTY = "flexlash"
"""Document property in which a template or a report says what it is."""


def read_submission(path: Path) -> Submission:
    """Return the cells of a workbook, CSV or Parquet file.

    Raises OSError when the file cannot be opened and Refusal when it is no readable submission.
    """
    data = read_bytes(path)
    admitted = admit(data)
    digest = hashlib.sha256(data).hexdigest()
    if admitted.kind == "workbook":
        return _read_workbook(admitted, path.name, digest)
    if admitted.kind == "parquet":
        sheet = _read_parquet(data)
        return Submission(name=path.name, sha256=digest, kind="parquet", sheets={"Variants": sheet})
    sheet, delimiter = read_table(data, "Variants")
    sheets = {"Variants": sheet}
    return Submission(name=path.name, sha256=digest, kind="csv", sheets=sheets, delimiter=delimiter)


def _read_workbook(admitted: Admitted, name: str, digest: str) -> Submission:
    """Read every worksheet with openpyxl; its dimension record is not believed."""
    import openpyxl

    try:
        # openpyxl warns of every feature that it does not carry over, none of which holds a cell's value.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            workbook = openpyxl.load_workbook(io.BytesIO(admitted.data), read_only=True, data_only=True)
            sheets = {}
            for worksheet in workbook.worksheets:
                worksheet.reset_dimensions()
                rows = _rows(worksheet.iter_rows(values_only=True))
                for row, place in admitted.errors.get(worksheet.title, ()):
                    shows = rows.setdefault(row, {}).get(place, "an error")
                    rows[row][place] = shows if isinstance(shows, ErrorCell) else ErrorCell(str(shows))
                for row, place in admitted.unstored.get(worksheet.title, ()):
                    rows.setdefault(row, {})[place] = Unstored()
                sheets[worksheet.title] = RawSheet(name=worksheet.title, rows=dict(sorted(rows.items())))
        properties = {one.name: str(one.value) for one in workbook.custom_doc_props.props}
    except Exception as fault:
        # openpyxl leaks a dozen exception types on damaged parts; none of their texts is for a user.
        raise Refusal("E102") from fault
    return Submission(
        name=name,
        sha256=digest,
        kind="workbook",
        sheets=sheets,
        modified=admitted.modified,
        role=properties.get(PROPERTY, ""),
        template_version=properties.get(f"{PROPERTY}_template_version", ""),
    )


def _rows(rows: Iterable[tuple[Any, ...]]) -> dict[int, dict[int, RawValue]]:
    """Return the non-blank cells of a sheet by row and column number."""
    found: dict[int, dict[int, RawValue]] = {}
    for number, values in enumerate(rows, start=1):
        cells = {
            place: ErrorCell(value) if value in ERROR_WORDS else value
            for place, value in enumerate(values, start=1)
            if value is not None
        }
        if cells:
            found[number] = cells
    return found


def _read_parquet(data: bytes) -> RawSheet:
    """Return a Parquet file as a sheet whose header stands in row 1."""
    import polars as pl
    from polars import selectors

    try:
        frame = pl.read_parquet(io.BytesIO(data)).with_columns(selectors.decimal().cast(pl.Float64))
    except Exception as fault:
        raise Refusal("E102") from fault
    rows: dict[int, dict[int, RawValue]] = {1: dict(enumerate(frame.columns, start=1))}
    for number, values in enumerate(frame.iter_rows(), start=2):
        cells = {place: value for place, value in enumerate(values, start=1) if value is not None}
        if cells:
            rows[number] = cells
    return RawSheet(name="Variants", rows=rows)
