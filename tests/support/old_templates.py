"""Filled templates of version 1 as other programs leave them: written by openpyxl, with whatever a cell may hold."""

from __future__ import annotations

import openpyxl
from openpyxl.packaging.custom import IntProperty, StringProperty

from flexlash.feedback.template.filling import Filling
from flexlash.reading.raw import ErrorCell, Unstored
from flexlash.schema.columns import ENTRY_SHEETS

__all__ = ["LABELS", "PLACES", "old_workbook", "rows_of"]

LABELS = {name: [column.label for column in columns if column.since == 1] for name, columns in ENTRY_SHEETS.items()}
"""Headers of version 1 by sheet."""

PLACES = {
    name: {column.key: place for place, column in enumerate(one for one in columns if one.since == 1)}
    for name, columns in ENTRY_SHEETS.items()
}
"""Columns of version 1 by sheet and key, counted from 0."""

_TOP = {
    "Variants": "flexlash: one row per flexspline variant",
    "Materials": "Materials",
    "Tolerances": "Tolerances",
    "Settings": "Settings",
}

_HINTS = {
    "Variants": "Fill the yellow cells of a row: its type decides which. White cells may stay blank. Help: the note "
    "on a header, the sheet Sketch.",
}
"""What version 6 had below its titles."""


def rows_of(name, rows):
    """Return rows given by key as lists in the order of version 1."""
    return [[row.get(key) for key in PLACES[name]] for row in rows]


def old_workbook(variants, *, version=1, headers=LABELS["Variants"], settings=None, materials=(), tolerances=()):
    """Return a workbook of version 1 with rows of Variants as lists, and rows of the other sheets by key."""
    book = openpyxl.Workbook()
    book.remove(book.active)
    builtin = Filling(materials=materials, tolerances=tolerances, settings=settings or {})
    tables = {
        "Variants": [list(headers), *variants],
        **{
            name: [LABELS[name], *rows_of(name, builtin.entries(name).rows)]
            for name in ("Materials", "Tolerances", "Settings")
        },
    }
    for name, table in tables.items():
        sheet = book.create_sheet(name)
        sheet["A1"] = _TOP[name]
        sheet["A2"] = _HINTS.get(name)
        for row, values in enumerate(table, start=4):
            for place, value in enumerate(values, start=1):
                put(sheet.cell(row, place), value)
    book.custom_doc_props.append(StringProperty(name="flexlash", value="template"))
    if version is not None:
        book.custom_doc_props.append(IntProperty(name="flexlash_template_version", value=version))
    return book


def put(cell, value):
    """Put a raw value into a cell as itself: texts never become formulas."""
    if isinstance(value, ErrorCell):
        cell.value, cell.data_type = value.text, "e"
    elif isinstance(value, Unstored):
        cell.value = "=A1*2"
    elif value is not None:
        cell.value = value
        if isinstance(value, str):
            cell.data_type = "s"
