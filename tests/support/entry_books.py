"""Submissions as workbooks with entry sheets written by key, the optional ones too."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import openpyxl

from flexlash.schema.columns import columns_of

__all__ = ["CUP", "UNIFORM_CUP", "correlations", "entry_book"]

Rows = Sequence[Mapping[str, Any]]

CUP: dict[str, Any] = {
    "variant": "B3-160",
    "flexspline_type": "cup",
    "material": "20Cr2Ni4",
    "torque_Nm": 800,
    "cylinder_length_mm": 160,
    "mean_radius_mm": 80,
    "wall_thickness_mm": 1.6,
    "disk_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40,
    "tolerance_class": "shop",
}
"""The cup of the reference model, whose wall and disk scatter apart."""

UNIFORM_CUP: Rows = [
    {"tolerance_class": "shop", "dimension": name, "lower_deviation": -half, "upper_deviation": half, **rest}
    for name, half, rest in (
        ("cylinder_length", 0.2, {"distribution": "uniform"}),
        ("wall_thickness", 0.05, {"distribution": "uniform"}),
        ("disk_thickness", 0.05, {"distribution": "uniform"}),
        ("mean_radius", 0.06, {}),
        ("disk_inner_radius", 0.15, {"distribution": "uniform"}),
        ("youngs_modulus", 6.33, {}),
        ("poisson_ratio", 0.02, {"distribution": "uniform"}),
    )
]
"""Its tolerances in class `shop`."""


def correlations(*pairs: tuple[Any, ...]) -> list[dict[str, Any]]:
    """Return rows of Correlations from two dimensions, the correlation, and the class where it is not `shop`."""
    keys = ("dimension_1", "dimension_2", "correlation", "tolerance_class")
    return [{"tolerance_class": "shop"} | dict(zip(keys, pair, strict=False)) for pair in pairs]


def entry_book(path: Path, **sheets: Rows) -> Path:
    """Write a workbook with these entry sheets, named in lower case, under their labels; return its path."""
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        title = name.capitalize().replace("_", " ")
        sheet, columns = book.create_sheet(title), columns_of(title)
        keys = list(dict.fromkeys(key for row in rows for key in row))
        sheet.append([columns[key].label for key in keys])
        for row in rows:
            sheet.append([row.get(key) for key in keys])
    book.save(path)
    return path
