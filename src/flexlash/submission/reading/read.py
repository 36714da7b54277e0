"""Path → a submission as read: raw cells at their own addresses; no judgement of what they hold."""

from __future__ import annotations

import hashlib
from pathlib import Path

from flexlash.submission.reading.delimited import read_table
from flexlash.submission.reading.gate import kind_of, read_bytes
from flexlash.submission.reading.isolated import Asked
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.raw import ErrorCell, RawSheet, RawValue, Submission, Unstored, column_letters
from flexlash.submission.reading.refusal import Refusal
from flexlash.submission.reading.wire import from_wire
from flexlash.submission.reading.workbook import PROPERTY

__all__ = [
    "PROPERTY",
    "ErrorCell",
    "RawSheet",
    "RawValue",
    "Reading",
    "Submission",
    "Unstored",
    "column_letters",
    "read_submission",
    "read_table",
]


class Reading:
    """A submission being read; where another process does so, its caller can do something else meanwhile.

    `data` takes the place of the file's own bytes. Raises OSError when the file cannot be opened; what else is wrong
    with it is told by `submission`.
    """

    def __init__(self, path: Path, limits: ReadingLimits | None = None, data: bytes | None = None) -> None:
        self.path = path
        self.limits = limits or ReadingLimits()
        self.kind = ""
        self.data = b""
        self.refusal: Refusal | None = None
        self.asked: Asked | None = None
        try:
            self.data = read_bytes(path, self.limits) if data is None else data
            self.kind = kind_of(self.data)
            if self.kind != "csv":
                self.asked = Asked(self.kind, self.data, self.limits)
        except Refusal as refusal:
            self.refusal = refusal

    def submission(self) -> Submission:
        """Return the cells, once they are read; raise Refusal when the file is no readable submission."""
        if self.refusal:
            raise self.refusal
        digest = hashlib.sha256(self.data).hexdigest()
        if self.asked is None:
            sheets = {"Variants": read_table(self.data, "Variants", self.path.name)}
            return Submission(name=self.path.name, sha256=digest, kind=self.kind, sheets=sheets, data=self.data)
        answer = self.asked.answer()[0]
        try:
            cells = from_wire(answer)
        except (ValueError, TypeError, LookupError, AttributeError) as fault:
            raise Refusal("E118") from fault
        return Submission(
            name=self.path.name,
            sha256=digest,
            kind=self.kind,
            sheets={sheet.name: sheet for sheet in cells.sheets},
            modified=cells.modified,
            role=cells.role,
            template_version=cells.template_version,
            data=self.data,
        )


def read_submission(path: Path, limits: ReadingLimits | None = None) -> Submission:
    """Return the cells of a workbook, CSV or Parquet file.

    Raises OSError when the file cannot be opened and Refusal when it is no readable submission.
    """
    return Reading(path, limits).submission()
