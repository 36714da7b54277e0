"""The outcome → bytes: the report workbook, or Results as CSV, Parquet or JSON."""

from __future__ import annotations

import io
import json
from typing import TYPE_CHECKING

from flexlash.analysis.outcome import Outcome
from flexlash.analysis.used_tolerances import used_tolerances
from flexlash.analysis.whole_batch import DRAWN
from flexlash.decisions.width_table import width_table_of
from flexlash.report.results_table import csv_text, results_table
from flexlash.schema.stamps import placeholder

if TYPE_CHECKING:
    import polars as pl

    from flexlash.report.report_data import ReportData

__all__ = ["ROLE", "ROWS_TOGETHER", "outcome_bytes"]

ROLE = "results"
"""What the stamp of a table of Results says that it is."""

ROWS_TOGETHER = 2**17
"""Rows of a row group of Parquet: so many have to be held at once, however many there are."""


def outcome_bytes(outcome: Outcome, ending: str, data: ReportData | None = None) -> tuple[bytes, str]:
    """Return the outcome in the form that an ending names, and what that file is: `report` or `results`.

    `data` is what the report draws, made here where it is None.
    """
    if ending == ".xlsx":
        from flexlash.report.workbook import report_bytes

        return report_bytes(outcome, data), "report"
    return _TABLES[ending](outcome), ROLE


def _as_csv(outcome: Outcome) -> bytes:
    """Return the Results as CSV, which has no room for a stamp."""
    return csv_text(results_table(outcome)).encode()


def _as_parquet(outcome: Outcome) -> bytes:
    """Return the Results as Parquet, with room for the stamp in the metadata."""
    buffer = io.BytesIO()
    results_table(outcome).write_parquet(buffer, row_group_size=ROWS_TOGETHER, metadata={"flexlash": placeholder(ROLE)})
    return buffer.getvalue()


def _as_json(outcome: Outcome) -> bytes:
    """Return Results, Tolerances used and the findings as one JSON object, the stamp last."""
    content = {
        "results": results_table(outcome).to_dicts(),
        "tolerances": used_tolerances(outcome.computed.values(), _widths(outcome)).to_dicts(),
        "findings": [content.as_dictionary() for content in outcome.findings],
        "stamp": placeholder(ROLE),
    }
    return (json.dumps(content, ensure_ascii=False, indent=1) + "\n").encode()


def _widths(outcome: Outcome) -> pl.DataFrame | None:
    """Return to what tolerances may go; None of more variants than a report draws, which would take too long."""
    if outcome.validated is None or len(outcome.computed) > DRAWN:
        return None
    return width_table_of(outcome.computed, outcome.settings, outcome.validated.levers, outcome.options)


_TABLES = {".csv": _as_csv, ".parquet": _as_parquet, ".json": _as_json}
