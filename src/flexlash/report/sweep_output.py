"""The points of sweeps → bytes: the Sweep table as CSV, Parquet or JSON."""

from __future__ import annotations

import io
import json
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.decisions.sweep import Study, sweep_table
from flexlash.report.output import ROLE, ROWS_TOGETHER
from flexlash.report.results_table import csv_text
from flexlash.schema.stamps import placeholder

__all__ = ["sweep_bytes", "sweep_fields"]


def sweep_bytes(studies: Sequence[Study], outcome: Outcome, ending: str) -> tuple[bytes, str]:
    """Return the points of sweeps in the form that an ending names, and the role that its stamp says.

    JSON has the crossings of each study and the findings of the submission as well.
    """
    table = sweep_table(studies)
    if ending == ".csv":
        return csv_text(table).encode(), ROLE
    if ending == ".parquet":
        buffer = io.BytesIO()
        table.write_parquet(buffer, row_group_size=ROWS_TOGETHER, metadata={"flexlash": placeholder(ROLE)})
        return buffer.getvalue(), ROLE
    found = [one.as_dictionary() for one in outcome.findings]
    content = sweep_fields(studies) | {"findings": found, "stamp": placeholder(ROLE)}
    return (json.dumps(content, ensure_ascii=False, indent=1) + "\n").encode(), ROLE


def sweep_fields(studies: Sequence[Study]) -> dict[str, Any]:
    """Return the points and the crossings of studies as JSON has them."""
    crossings = [
        {"variant": study.variant, "key": study.first.key, "second_key": study.second and study.second.key}
        | asdict(crossing)
        for study in studies
        for crossing in study.crossings
    ]
    return {"sweep": sweep_table(studies).to_dicts(), "crossings": crossings}
