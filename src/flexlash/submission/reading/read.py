"""Path → a submission as read: raw cells at their own addresses; no judgement of what they hold."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

from flexlash.findings import readable
from flexlash.submission.reading.carried import NONSENSE, carried_submission
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
    "ReportReading",
    "Submission",
    "Unstored",
    "column_letters",
    "read_submission",
    "read_table",
]


_MORE = 4
"""Times more cells, and time, than a submission has that a report may need, which has its results beside it."""


class Reading:
    """A submission being read; where another process does so, its caller can do something else meanwhile.

    `data` takes the place of the file's own bytes; `name` is the file's name as it may be printed. Raises OSError when
    the file cannot be opened; what else is wrong with it is told by `submission`.
    """

    def __init__(self, path: Path, limits: ReadingLimits | None = None, data: bytes | None = None) -> None:
        self.path = path
        self.name = readable(path.name)
        self.limits = limits or ReadingLimits()
        self.kind = ""
        self.data = b""
        self.refusal: Refusal | None = None
        self.asked: Asked | None = None
        try:
            self.data = read_bytes(path, self.limits) if data is None else data
            self.kind = kind_of(self.data)
            self.asked = self._ask()
        except Refusal as refusal:
            self.refusal = refusal

    def _ask(self) -> Asked | None:
        """Have the limited process begin, where this kind of file needs it."""
        return None if self.kind == "csv" else Asked(self.kind, self.data, self.limits)

    def submission(self) -> Submission:
        """Return the cells, once they are read; raise Refusal when the file is no readable submission."""
        if self.refusal:
            raise self.refusal
        digest = hashlib.sha256(self.data).hexdigest()
        if self.asked is None:
            sheets = {"Variants": read_table(self.data, "Variants", self.name, self.limits)}
            return Submission(name=self.name, sha256=digest, kind=self.kind, sheets=sheets, data=self.data)
        answer = self.asked.answer()[0]
        try:
            cells = from_wire(answer)
        except (ValueError, TypeError, LookupError, AttributeError) as fault:
            raise Refusal("E118") from fault
        return Submission(
            name=self.name,
            sha256=digest,
            kind=self.kind,
            sheets={sheet.name: sheet for sheet in cells.sheets},
            modified=cells.modified,
            role=cells.role,
            template_version=cells.template_version,
            data=self.data,
        )


class ReportReading(Reading):
    """A report being read for the submission that it carries.

    `results` are its Results, None before they are read; `version` is that of the flexlash that made it.
    """

    version: str = ""
    results: RawSheet | None = None
    carried: Submission | None = None

    def _ask(self) -> Asked | None:
        if self.kind != "workbook":
            raise Refusal("E120")
        cells, seconds, processor = (
            _MORE * limit for limit in (self.limits.cells, self.limits.seconds, self.limits.processor_seconds)
        )
        return Asked(
            "report", self.data, replace(self.limits, cells=cells, seconds=seconds, processor_seconds=processor)
        )

    def submission(self) -> Submission:
        """Return the submission that the report carries; raise Refusal when the file is no report that carries one."""
        if self.refusal:
            raise self.refusal
        if self.carried is None and self.asked is not None:
            answer = self.asked.answer()[0]
            try:
                self.results = next(iter(from_wire(answer["results"]).sheets), None)
                self.carried = carried_submission(answer["carried"], self.limits)
                self.version = answer["carried"]["version"]
            except NONSENSE as fault:
                raise Refusal("E118") from fault
        if self.carried is None:
            raise Refusal("E118")
        return self.carried


def read_submission(path: Path, limits: ReadingLimits | None = None) -> Submission:
    """Return the cells of a workbook, CSV or Parquet file.

    Raises OSError when the file cannot be opened and Refusal when it is no readable submission.
    """
    return Reading(path, limits).submission()
