"""The points of sweeps → bytes: the Sweep table as CSV, Parquet or JSON."""

from __future__ import annotations

import io
import json
from collections.abc import Sequence
from dataclasses import asdict

from flexlash.analysis.outcome import Outcome
from flexlash.decisions.sweep import Study, sweep_table
from flexlash.report.output import ROLE, ROWS_TOGETHER
from flexlash.report.results_table import csv_text
from flexlash.schema.stamps import placeholder

__all__ = ["sweep_bytes"]


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
    content = {
        "sweep": table.to_dicts(),
        "crossings": [
            {"variant": study.variant, "key": study.first.key, "second_key": study.second and study.second.key}
            | asdict(crossing)
            for study in studies
            for crossing in study.crossings
        ],
        "findings": [found.as_dictionary() for found in outcome.findings],
        "stamp": placeholder(ROLE),
    }
    return (json.dumps(content, ensure_ascii=False, indent=1) + "\n").encode(), ROLE
