"""Which rows of a surveyed table hold a name: asked of the limited process, chunk by chunk."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from flexlash.reading.excerpt import excerpt, submission_of_excerpt
from flexlash.reading.limited_process import ask
from flexlash.reading.read import Source
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.survey import Survey, limits_of_survey, survey
from flexlash.schema.findings import readable
from flexlash.schema.spellings import plain

__all__ = ["excerpt_of_name"]

_ROWS = 5000
"""Rows that are looked at together."""


def excerpt_of_name(path: Path, name: str, limits: ReadingLimits) -> Source | None:
    """Return a table with only those of its rows in which a cell holds this name; None where no row does.

    No more than a piece of the table is held at once. Raises OSError when it cannot be opened, Refusal when it is no
    table.
    """
    within = limits_of_survey(limits, path.stat().st_size)
    known: Survey = ask(survey, within, path, limits, readable(path.name))
    rows = list(_rows(path, known, plain(name), limits, within))
    if not rows:
        return None
    return Source(name=known.name, data=ask(excerpt, within, path, known, rows))


def _rows(path: Path, known: Survey, name: str, limits: ReadingLimits, within: ReadingLimits) -> Iterator[int]:
    for chunk in known.chunks(_ROWS):
        if chunk:
            yield from ask(_named, within, ask(excerpt, within, path, known, chunk), name, limits)


def _named(data: bytes, name: str, limits: ReadingLimits) -> list[int]:
    """Return the rows of an excerpt in which a cell holds a name."""
    (sheet,) = submission_of_excerpt(data, limits).sheets.values()
    return [
        row
        for row, cells in sheet.rows.items()
        if any(isinstance(value, str) and plain(value) == name for value in cells.values())
    ]
