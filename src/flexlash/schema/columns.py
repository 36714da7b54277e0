"""The one truth about every field that is entered: what it is called, measured in, allowed to hold, good for.

Template, validation, data dictionary, report and the documents' tables all derive from these records. The fields of
Variants are in `variant_columns`, those of Materials and Settings in `dimension_columns`, those of Tolerances,
Measurements and Correlations in `tolerance_columns`, those of Other sources, Levers and Sweep in `decision_columns`;
those of the report in `result_columns`, `used_columns` and `decision_results`. Here they are the sheets of a template.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType

from flexlash.schema.column import Column
from flexlash.schema.decision_columns import LEVERS, OTHER_SOURCES, SWEEP
from flexlash.schema.dimension_columns import DIMENSIONS, LOT_DIMENSIONS, MATERIALS, SETTINGS
from flexlash.schema.tolerance_columns import CORRELATIONS, MEASUREMENTS, TOLERANCES
from flexlash.schema.variant_columns import VARIANTS

__all__ = [
    "CORRELATIONS",
    "DIMENSIONS",
    "ENTRY_SHEETS",
    "LEVERS",
    "LOT_DIMENSIONS",
    "MATERIALS",
    "MEASUREMENTS",
    "OPTIONAL_SHEETS",
    "OTHER_SOURCES",
    "SETTINGS",
    "SETTINGS_SHEET",
    "SWEEP",
    "TOLERANCES",
    "VARIANTS",
    "Column",
    "columns_of",
    "naming_column",
]

SETTINGS_SHEET = (
    Column.entry(
        "Settings",
        "identity",
        "setting",
        "Setting",
        "Name of the setting.",
        type="choice",
        required=True,
        choices=tuple(column.key for column in SETTINGS),
    ),
    Column.entry("Settings", "requirement", "value", "Value", "Its value. Blank: the default.", type="text"),
)

ENTRY_SHEETS = {
    "Variants": VARIANTS,
    "Materials": MATERIALS,
    "Tolerances": TOLERANCES,
    "Settings": SETTINGS_SHEET,
    "Measurements": MEASUREMENTS,
    "Correlations": CORRELATIONS,
    "Other sources": OTHER_SOURCES,
    "Levers": LEVERS,
    "Sweep": SWEEP,
}

OPTIONAL_SHEETS = {
    "Measurements": "parts that you have measured; their mean and spread take the place of assumed ones",
    "Correlations": "dimensions that vary together, such as two that are cut in one set-up",
    "Other sources": "play of teeth, bearing and coupling, for the backlash of the whole drive",
    "Levers": "what the drawing may change, how far and at what cost",
    "Sweep": "a dimension, or two, in steps from one value to another",
}
"""Entry sheets that a template has only where they are asked for, and what each is for."""


@cache
def columns_of(sheet: str) -> Mapping[str, Column]:
    """Return the columns of an entry sheet by key."""
    return MappingProxyType({column.key: column for column in ENTRY_SHEETS[sheet]})


def naming_column(sheet: str) -> Column:
    """Return the column of an entry sheet that names its rows: the first that says which they are."""
    return next(column for column in ENTRY_SHEETS[sheet] if column.role == "identity")
