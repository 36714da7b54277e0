"""The hidden sheet by which a report carries what was read: every digit of it, so that the report alone recreates it.

A sheet is kept by every program that saves a workbook; a part of its own would not be.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace

from flexlash import __version__
from flexlash.analysis.outcome import Outcome
from flexlash.reading.carried import FORM, SHEET, SWITCHES
from flexlash.reading.cells_json import cells_to_json
from flexlash.reading.raw import RawSheet, RawValue, Submission
from flexlash.reading.xlsx import Cells
from flexlash.report.layout.styles import Book
from flexlash.schema.variant import OVERRIDDEN
from flexlash.validation.entry_sheets import sheet_names

__all__ = ["carried_text", "write_carried"]

_PIECE = 30_000
"""Characters of a cell, which can hold 32,767."""

_STEM = 150
"""Characters that are kept of a name to which something is added."""

_TOP = 15
"""Rows of a sheet that was not read itself, in which its headers were recognised."""

_NOTE = "What flexlash read, for flexlash run --from-report and flexlash diff. Please leave it as it is."


def write_carried(book: Book, outcome: Outcome, changes: Mapping[str, str]) -> None:
    """Write the sheet, last of all and hidden from the list of hidden sheets.

    `changes` are the cheapest single changes, in words, of variants that miss their limit.
    """
    sheet = book.workbook.add_worksheet(SHEET)
    text = carried_text(outcome, changes)
    for row, start in enumerate(range(0, len(text), _PIECE)):
        sheet.write_string(row, 0, text[start : start + _PIECE])
    sheet.write_string(0, 1, _NOTE)
    sheet.very_hidden()


def carried_text(outcome: Outcome, changes: Mapping[str, str] | None = None) -> str:
    """Return what was read and the options that shaped the numbers, as JSON in plain letters, with these changes."""
    submission, settings = outcome.submission, outcome.settings
    worst_of = outcome.whole.rows if outcome.whole else submission.worst_of
    carried = {
        "form": FORM,
        "version": __version__,
        "submission": {"name": _name(outcome), "sha256": submission.sha256, "kind": submission.kind}
        | ({"worst_of": worst_of} if worst_of else {}),
        "options": {name: getattr(settings, name) for name in OVERRIDDEN}
        | {name: bool(getattr(outcome.options, name)) for name in SWITCHES},
        "cells": cells_to_json(
            Cells(
                sheets=_sheets(submission, {finding.sheet for finding in outcome.findings}),
                modified=submission.modified,
                role=submission.role,
                template_version=submission.template_version,
            )
        ),
    } | ({"changes": dict(changes)} if changes else {})
    # Readers of workbooks take _x0041_ for a letter, and some leave out x005F_ wherever it stands.
    text = json.dumps(carried, separators=(",", ":"))
    return text.replace("_x", "_\\u0078").replace("x005F_", "\\u0078005F_")


def _name(outcome: Outcome) -> str:
    """Return the name of the submission, which says where no more than the worst of its rows are carried."""
    name = outcome.submission.name
    if outcome.whole is None:
        return name
    stem, point, ending = name.rpartition(".")
    return f"{(stem or name)[:_STEM]}, {outcome.results.height} worst of {outcome.whole.rows}{point}{ending}"


def _sheets(submission: Submission, named: set[str]) -> list[RawSheet]:
    """Return the sheets that were read, and of others that a finding names as much as makes it found again."""
    ours = set(sheet_names(submission).values())
    return [
        sheet if name in ours else replace(sheet, rows=_top(sheet.rows))
        for name, sheet in submission.sheets.items()
        if name in ours or name in named
    ]


def _top(rows: Mapping[int, dict[int, RawValue]]) -> dict[int, dict[int, RawValue]]:
    """Return the rows by which a sheet was recognised: those of headers, and the first two."""
    first = list(rows)[:2]
    return {row: cells for row, cells in rows.items() if row <= _TOP or row in first}
