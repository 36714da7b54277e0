"""Bytes → sheets of raw cells at their own addresses; no judgement of what they hold."""

from __future__ import annotations

import csv
import datetime
import hashlib
import io
import warnings
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

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

_ERRORS = frozenset((
    "#REF!", "#DIV/0!", "#VALUE!", "#NAME?", "#N/A", "#NUM!", "#NULL!", "#SPILL!", "#CALC!", "#FIELD!", "#BLOCKED!",
    "#CONNECT!", "#UNKNOWN!", "#BUSY!", "#GETTING_DATA", "#EXTERNAL!", "#PYTHON!",
))  # fmt: skip
"""Error words, which some programs store as plain texts."""

_TOP = 15
"""Rows among which the header, and so the widest row of a table, is looked for."""


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
    """Cells by row and column number, both from 1 as the user counts; blank cells are absent.

    `numbers_are_texts` tells a CSV sheet, in which a text may be a number.
    """

    name: str
    rows: dict[int, dict[int, RawValue]]
    numbers_are_texts: bool = False


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
            place: ErrorCell(value) if value in _ERRORS else value
            for place, value in enumerate(values, start=1)
            if value is not None
        }
        if cells:
            found[number] = cells
    return found


def read_table(data: bytes, name: str) -> tuple[RawSheet, str]:
    """Return a CSV file as a sheet and the delimiter it was written with.

    Raises Refusal when it is not UTF-8 text or not a table.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise Refusal("E107") from fault
    tables = {sign: records for sign in ",;\t" if (records := _records(text, sign)) is not None}
    delimiter = max(tables, key=lambda sign: _evenness(tables[sign]), default="")
    if not delimiter or (len(tables) < len(",;\t") and not _evenness(tables[delimiter])):
        raise Refusal("E102")
    rows: dict[int, dict[int, RawValue]] = {}
    for number, values in enumerate(tables[delimiter], start=1):
        cells: dict[int, RawValue] = {
            place: ErrorCell(cell.strip()) if cell.strip() in _ERRORS else cell
            for place, cell in enumerate(values, start=1)
            if cell.strip()
        }
        if cells:
            rows[number] = cells
    return RawSheet(name=name, rows=rows, numbers_are_texts=True), delimiter


def _evenness(records: list[list[str]]) -> int:
    """Return how many cells of the top rows stand in rows of the commonest width: high for the true delimiter."""
    widths = Counter(len(values) for values in records[:_TOP] if len(values) > 1)
    return max((width * count for width, count in widths.items()), default=0)


def _records(text: str, delimiter: str) -> list[list[str]] | None:
    """Return the records of a CSV text; None where its quotes do not close."""
    try:
        return list(csv.reader(io.StringIO(text, newline=None), delimiter=delimiter, strict=True))
    except csv.Error:
        return None


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
