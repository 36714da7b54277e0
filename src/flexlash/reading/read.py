"""Bytes → a submission as read: raw cells at their own addresses; no judgement of what they hold.

All of this is done in the limited process.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from flexlash.reading.carried import read_report
from flexlash.reading.delimited import read_table
from flexlash.reading.excerpt import is_excerpt, submission_of_excerpt
from flexlash.reading.gate import kind_of, read_bytes
from flexlash.reading.libraries import ChangedLibrary
from flexlash.reading.parquet import read_parquet
from flexlash.reading.products import Companions
from flexlash.reading.raw import RawSheet, Submission
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.xlsx import Cells, read_workbook
from flexlash.schema.findings import readable

__all__ = [
    "ReadReport",
    "Source",
    "limits_of_reports",
    "of_table",
    "report_of",
    "submission_of",
    "table_of",
]

_MORE = 4
"""Times more cells, and time, than a submission has that a report may need, which has its results beside it."""


@dataclass(frozen=True, kw_only=True)
class Source:
    """A file to be read: its name as it may be printed, its bytes, and where it stands, if anywhere.

    `companions` are the files that were given with it, None where nothing is skipped.
    """

    name: str
    data: bytes
    path: Path | None = None
    companions: Companions | None = None

    @classmethod
    def at(cls, path: Path, limits: ReadingLimits) -> Source:
        """Return what stands at a path; raise OSError when it cannot be opened, Refusal when empty or too large."""
        return cls(name=readable(path.name), data=read_bytes(path, limits), path=path)


@dataclass(frozen=True, kw_only=True)
class ReadReport:
    """A report as read: the submission that it carries, its Results, the version of the flexlash that made it.

    `changes` are the cheapest single changes of variants that miss their limit, in words, by the variant's name.
    """

    name: str
    submission: Submission
    results: RawSheet | None
    version: str
    changes: Mapping[str, str] = field(default_factory=dict)
    data: bytes = b""
    path: Path | None = None


def submission_of(source: Source, limits: ReadingLimits) -> Submission:
    """Return the cells of a workbook, a text table, a Parquet file or an excerpt; raise Refusal when it is none."""
    if source.path is None and is_excerpt(source.data):
        with _refusing():
            return submission_of_excerpt(source.data, limits)
    with _refusing():
        kind = kind_of(source.data)
        cells = _cells(source, kind, limits)
    return Submission(
        name=source.name,
        sha256=hashlib.sha256(source.data).hexdigest(),
        kind=kind,
        sheets={sheet.name: sheet for sheet in cells.sheets},
        modified=cells.modified,
        role=cells.role,
        template_version=cells.template_version,
    )


def _cells(source: Source, kind: str, limits: ReadingLimits) -> Cells:
    if kind == "workbook":
        return read_workbook(source.data, limits)
    if kind == "parquet":
        return read_parquet(source.data, limits)
    return Cells(sheets=[read_table(source.data, "Variants", source.name, limits)])


def table_of(source: Source, name: str, limits: ReadingLimits) -> RawSheet:
    """Return a text table that stands beside a submission; raise Refusal, by its own name, when it is none."""
    try:
        with _refusing():
            kind_of(source.data, only="csv")
            return read_table(source.data, name, source.name, limits)
    except Refusal as refusal:
        raise of_table(refusal, source.name) from refusal


def of_table(refusal: Refusal, file: str) -> Refusal:
    """Return the refusal of a table that stands beside a submission, by its own name."""
    if refusal.code.startswith("I"):
        return Refusal("E101", file=file, found="a csv file is required here")
    return Refusal(refusal.code, **{"file": file, **refusal.facts})


def report_of(source: Source, limits: ReadingLimits) -> ReadReport:
    """Return what a report carries; raise Refusal when the file is none that carries a submission within limits."""
    with _refusing():
        if kind_of(source.data) != "workbook":
            raise Refusal("E120")
        submission, results, version, changes = read_report(source.data, limits, limits_of_reports(limits))
    return ReadReport(
        name=source.name, path=source.path, submission=submission, results=results, version=version, changes=changes
    )


def limits_of_reports(limits: ReadingLimits) -> ReadingLimits:
    """Return the limits within which a report of a submission within `limits` can be read."""
    return limits.times(_MORE, "cells", "seconds", "processor_seconds")


@contextmanager
def _refusing() -> Iterator[None]:
    """Refuse a file whose reader fails in whatever way: libraries raise a dozen types, and not only exceptions."""
    try:
        yield
    except (Refusal, MemoryError, ChangedLibrary):
        raise
    except BaseException as fault:
        raise Refusal("E118") from fault
