"""Bytes → sheets of raw cells at their own addresses; no judgement of what they hold."""

from __future__ import annotations

import csv
import datetime
import hashlib
import io
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

from flexlash.submission.gate import Admitted, Refusal, admit, read_bytes

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

_ERRORS = frozenset({"#REF!", "#DIV/0!", "#VALUE!", "#NAME?", "#N/A", "#NUM!", "#NULL!", "#SPILL!", "#CALC!"})


@dataclass(frozen=True)
class ErrorCell:
    """A cell that shows an Excel error."""

    text: str


@dataclass(frozen=True)
class Unstored:
    """A formula whose result was never stored."""


RawValue: TypeAlias = (
    str | float | int | bool | datetime.date | datetime.time | datetime.timedelta | ErrorCell | Unstored
)


@dataclass(frozen=True, kw_only=True)
class RawSheet:
    """Cells by row and column number, both from 1 as the user counts; blank cells are absent."""

    name: str
    rows: dict[int, dict[int, RawValue]]


@dataclass(frozen=True, kw_only=True)
class Submission:
    """A submission as read. `role` is what its document properties say it is."""

    name: str
    sha256: str
    kind: str
    sheets: dict[str, RawSheet] = field(default_factory=dict)
    modified: datetime.datetime | None = None
    role: str = ""
    template_version: str = ""
    delimiter: str = ""


def column_letters(number: int) -> str:
    """Return the letters of a column number.

    >>> column_letters(28)
    'AB'
    """
    letters = ""
    while number:
        number, rest = divmod(number - 1, 26)
        letters = chr(65 + rest) + letters
    return letters


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
                unstored = admitted.unstored.get(worksheet.title, frozenset())
                rows = _rows(worksheet.iter_rows(values_only=True), unstored)
                sheets[worksheet.title] = RawSheet(name=worksheet.title, rows=rows)
        properties = {one.name: str(one.value) for one in workbook.custom_doc_props.props}
        modified = workbook.properties.modified
    except Exception as fault:
        # openpyxl leaks a dozen exception types on damaged parts; none of their texts is for a user.
        raise Refusal("E102") from fault
    return Submission(
        name=name,
        sha256=digest,
        kind="workbook",
        sheets=sheets,
        modified=modified,
        role=properties.get(PROPERTY, ""),
        template_version=properties.get(f"{PROPERTY}_template_version", ""),
    )


def _rows(rows: object, unstored: frozenset[str]) -> dict[int, dict[int, RawValue]]:
    """Return the non-blank cells of a sheet, with formulas that lack a result put in by address."""
    found: dict[int, dict[int, RawValue]] = {}
    for number, values in enumerate(rows, start=1):  # type: ignore[arg-type, var-annotated]
        cells = {
            place: ErrorCell(value) if isinstance(value, str) and value in _ERRORS else value
            for place, value in enumerate(values, start=1)
            if value is not None
        }
        if cells:
            found[number] = cells
    for address in unstored:
        letters = address.rstrip("0123456789")
        place = 0
        for letter in letters:
            place = place * 26 + ord(letter) - 64
        found.setdefault(int(address[len(letters) :]), {})[place] = Unstored()
    return dict(sorted(found.items()))


def read_table(data: bytes, name: str) -> tuple[RawSheet, str]:
    """Return a CSV file as a sheet and the delimiter it was written with.

    Raises Refusal when it is not UTF-8 text or not a table.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise Refusal("E107") from fault
    first = next((line for line in text.splitlines() if line.strip()), "")
    delimiter = max(",;\t", key=first.count)
    found = {}
    try:
        for number, values in enumerate(csv.reader(io.StringIO(text), delimiter=delimiter, strict=True), start=1):
            cells: dict[int, RawValue] = {place: cell for place, cell in enumerate(values, start=1) if cell.strip()}
            if cells:
                found[number] = cells
    except csv.Error as fault:
        raise Refusal("E102") from fault
    return RawSheet(name=name, rows=found), delimiter


def _read_parquet(data: bytes) -> RawSheet:
    """Return a Parquet file as a sheet whose header stands in row 1."""
    import polars as pl

    try:
        frame = pl.read_parquet(io.BytesIO(data))
    except Exception as fault:
        raise Refusal("E102") from fault
    rows: dict[int, dict[int, RawValue]] = {1: dict(enumerate(frame.columns, start=1))}
    for number, values in enumerate(frame.iter_rows(), start=2):
        cells = {place: value for place, value in enumerate(values, start=1) if value is not None}
        if cells:
            rows[number] = cells
    return RawSheet(name="Variants", rows=rows)
