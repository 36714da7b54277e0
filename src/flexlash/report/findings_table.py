"""Findings as a table of CSV, in which no text can act as a formula: its header, and any of its rows."""

from __future__ import annotations

from collections.abc import Sequence

import polars as pl

from flexlash.report.results_table import csv_header, csv_rows
from flexlash.schema.findings import Finding
from flexlash.schema.result_columns import FINDINGS

__all__ = ["findings_header", "findings_rows"]


def findings_header() -> bytes:
    """Return the header line of a table of findings."""
    return csv_header([column.key for column in FINDINGS]).encode()


def findings_rows(findings: Sequence[Finding]) -> bytes:
    """Return findings as the rows of a table; nothing for none."""
    if not findings:
        return b""
    return csv_rows(pl.DataFrame([found.as_dictionary() for found in findings], infer_schema_length=None)).encode()
