"""The table of levers → bytes: CSV, Parquet or JSON."""

from __future__ import annotations

import io
import json

import polars as pl

from flexlash.analysis.outcome import Outcome
from flexlash.report.results_table import csv_text
from flexlash.schema.stamps import placeholder

__all__ = ["ROLE", "levers_bytes"]

ROLE = "levers"
"""What the stamp of a table of levers says that it is."""


def levers_bytes(outcome: Outcome, levers: pl.DataFrame, ending: str) -> bytes:
    """Return the table of levers of a submission in the form that an ending names, numbers with every digit."""
    if ending == ".csv":
        return csv_text(levers).encode()
    if ending == ".parquet":
        buffer = io.BytesIO()
        levers.write_parquet(buffer, metadata={"flexlash": placeholder(ROLE)})
        return buffer.getvalue()
    findings = [finding.as_dictionary() for finding in outcome.findings]
    content = {"levers": levers.to_dicts(), "findings": findings, "stamp": placeholder(ROLE)}
    return (json.dumps(content, ensure_ascii=False, indent=1) + "\n").encode()
