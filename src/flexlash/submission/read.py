"""Path → a submission as read: raw cells at their own addresses; no judgement of what they hold."""

from __future__ import annotations

import hashlib
from pathlib import Path

from flexlash.submission.delimited import read_table
from flexlash.submission.gate import kind_of, read_bytes
from flexlash.submission.raw import ErrorCell, RawSheet, RawValue, Submission, Unstored, column_letters
from flexlash.submission.reading.isolated import ask
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.wire import from_wire

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


def read_submission(path: Path, limits: ReadingLimits | None = None) -> Submission:
    """Return the cells of a workbook, CSV or Parquet file.

    Raises OSError when the file cannot be opened and Refusal when it is no readable submission.
    """
    limits = limits or ReadingLimits()
    data = read_bytes(path, limits)
    kind = kind_of(data)
    digest = hashlib.sha256(data).hexdigest()
    if kind == "csv":
        sheet, delimiter = read_table(data, "Variants")
        return Submission(name=path.name, sha256=digest, kind=kind, sheets={"Variants": sheet}, delimiter=delimiter)
    cells = from_wire(ask(kind, data, limits)[0])
    return Submission(
        name=path.name,
        sha256=digest,
        kind=kind,
        sheets={sheet.name: sheet for sheet in cells.sheets},
        modified=cells.modified,
        role=cells.role,
        template_version=cells.template_version,
    )
