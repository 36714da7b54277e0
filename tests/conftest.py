"""Submissions for the tests, made from the template or as plain tables."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from flexlash.submission.templating.template import Filling, template_bytes
from here import AskedHere, ask_here


@pytest.fixture(autouse=True)
def _read_here(request, monkeypatch):
    """Read workbooks in this process, unless a test is about the process that does so."""
    if "limited_process" not in request.keywords:
        monkeypatch.setattr("flexlash.submission.reading.read.Asked", AskedHere)
        monkeypatch.setattr("flexlash.handback.ask", ask_here)


SOUND: dict[str, Any] = {
    "variant": "B3-160",
    "flexspline_type": "cup",
    "material": "20Cr2Ni4",
    "torque_Nm": 800.0,
    "cylinder_length_mm": 160.0,
    "mean_radius_mm": 80.0,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40.0,
    "backlash_limit_arcmin": 3.75,
}
"""A Variants row without a fault."""


@pytest.fixture
def sound() -> dict[str, Any]:
    """Return a fresh copy of a row without a fault."""
    return dict(SOUND)


@pytest.fixture
def workbook(tmp_path: Path) -> Callable[..., Path]:
    """Return a function that fills the template with rows, and other sheets by keyword, and gives its path."""

    def write(rows: Sequence[Mapping[str, Any]], name: str = "submission.xlsx", **filling: Any) -> Path:
        path = tmp_path / name
        path.write_bytes(template_bytes(Filling(variants=rows, **filling)))
        return path

    return write


@pytest.fixture
def table(tmp_path: Path) -> Callable[..., Path]:
    """Return a function that writes rows as a CSV file under their keys and gives its path."""

    def write(rows: Sequence[Mapping[str, Any]], name: str = "submission.csv") -> Path:
        path = tmp_path / name
        headers = list(dict.fromkeys(key for row in rows for key in row))
        with path.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, headers)
            writer.writeheader()
            writer.writerows(rows)
        return path

    return write
