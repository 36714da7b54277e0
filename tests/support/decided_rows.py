"""Submissions given by keys, with rows of Other sources, Levers and Sweep, and what validation says of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from decided_drives import CASE_3, CYLINDER

from flexlash.reading.raw import RawSheet, Submission
from flexlash.schema.columns import ENTRY_SHEETS
from flexlash.validation.validate import validate
from flexlash.validation.validated import Validated

__all__ = ["UNLIMITED", "told", "validated"]

UNLIMITED = {**CASE_3, "system_limit_arcmin": None}
"""Case 3 alone, which no drive limits."""

_TITLES = {name.lower().replace(" ", "_"): name for name in ENTRY_SHEETS}


def _sheet(name: str, rows: Sequence[Mapping[str, Any]]) -> RawSheet:
    keys = [column.key for column in ENTRY_SHEETS[name]]
    cells = [dict(enumerate(keys, start=1))]
    cells += [{place: row[key] for place, key in enumerate(keys, start=1) if row.get(key) is not None} for row in rows]
    return RawSheet(name=name, rows=dict(enumerate(cells, start=1)))


def validated(variants: Sequence[Mapping[str, Any]] = (UNLIMITED, CYLINDER), **sheets: Any) -> Validated:
    """Return a submission of these sheets, named by their lower case, after validation."""
    raw = {_TITLES[key]: _sheet(_TITLES[key], rows) for key, rows in {"variants": variants, **sheets}.items()}
    return validate(Submission(name="a.xlsx", sha256="", kind="workbook", sheets=raw))


def told(found: Validated) -> list[tuple[str, str, int]]:
    """Return code, column and row of each finding but those of built-in tables; the first entries are in row 2."""
    return [(one.code, one.column, one.row) for one in found.findings if one.code != "I505"]
