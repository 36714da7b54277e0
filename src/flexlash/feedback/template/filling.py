"""What a template is filled with: rows of our own making, or whole sheets carried over from another file."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from flexlash.schema import tables
from flexlash.schema.columns import (
    ENTRY_SHEETS,
    MATERIALS,
    OPTIONAL_SHEETS,
    SETTINGS,
    TOLERANCES,
    VARIANTS,
    Column,
)

__all__ = ["Entries", "Filling", "study"]


@dataclass(frozen=True, kw_only=True)
class Entries:
    """What an entry sheet holds: its rows in order, blank ones as they stand.

    A row's values stand under the keys of their `columns`. The user's `own` columns stand behind the template's: their
    headers here, None without one, and their values in the rows under the column's number, counted from 0.
    """

    rows: Sequence[Mapping[Any, Any]]
    columns: Sequence[Column]
    own: Sequence[Any] = ()


@dataclass(frozen=True, kw_only=True)
class Filling:
    """Rows to fill a template with, each by key; what is not given is as in the empty template.

    `optional` are the optional sheets that it has; those with rows need not be named. `sheets` are whole entry sheets,
    which hold instead of everything else.
    """

    variants: Sequence[Mapping[str, Any]] = ()
    tolerances: Sequence[Mapping[str, Any]] = ()
    materials: Sequence[Mapping[str, Any]] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)
    measurements: Sequence[Mapping[str, Any]] = ()
    correlations: Sequence[Mapping[str, Any]] = ()
    other_sources: Sequence[Mapping[str, Any]] = ()
    levers: Sequence[Mapping[str, Any]] = ()
    sweep: Sequence[Mapping[str, Any]] = ()
    optional: Collection[str] = ()
    sheets: Mapping[str, Entries] = field(default_factory=dict)

    @property
    def sheet_names(self) -> list[str]:
        """The entry sheets of the template, in their order."""
        asked = {*self.optional, *self.sheets, *(name for name, rows in self._of_optional.items() if rows)}
        return [name for name in ENTRY_SHEETS if name not in OPTIONAL_SHEETS or name in asked]

    @property
    def _of_optional(self) -> dict[str, Sequence[Mapping[str, Any]]]:
        """The rows of the optional sheets, by name."""
        return {
            "Measurements": self.measurements,
            "Correlations": self.correlations,
            "Other sources": self.other_sources,
            "Levers": self.levers,
            "Sweep": self.sweep,
        }

    def entries(self, sheet: str) -> Entries:
        """Return what an entry sheet is filled with."""
        if sheet in self.sheets:
            return self.sheets[sheet]
        rows: Sequence[Mapping[str, Any]]
        if sheet == "Variants":
            rows = self.variants
        elif sheet == "Materials":
            rows = self.materials or _typed("materials", MATERIALS)
        elif sheet == "Tolerances":
            standard = [{"tolerance_class": "standard", **row} for row in _typed("standard_class", TOLERANCES)]
            rows = [*standard, *self.tolerances]
        elif sheet == "Settings":
            rows = [
                {"setting": column.key, "value": self.settings.get(column.key, column.default)} for column in SETTINGS
            ]
        else:
            rows = self._of_optional[sheet]
        return Entries(rows=rows, columns=ENTRY_SHEETS[sheet])


def study() -> Filling:
    """Return the published B3-160 study with its screening tolerances, as `--example` fills it in."""
    return Filling(variants=_typed("study", VARIANTS), tolerances=_typed("study_class", TOLERANCES))


def _typed(table: str, columns: Sequence[Column]) -> list[dict[str, Any]]:
    """Return the rows of a packaged table with its numbers as numbers and its blanks left out."""
    numeric = {column.key for column in columns if column.is_number}
    return [
        {key: float(text) if key in numeric else text for key, text in row.items() if text}
        for row in tables.rows(table)
    ]
