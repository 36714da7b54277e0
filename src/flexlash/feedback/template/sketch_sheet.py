"""The template's sheet Sketch: cup, hat and cylinder with their symbols, and the column that each symbol stands for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from flexlash.feedback.template.demanded_cells import asking_types, other_way, refusing_types
from flexlash.feedback.template.print_pages import set_up_page
from flexlash.feedback.template.sketch_chart import drawn_chart
from flexlash.mechanics.sketch.drawing_marks import LETTER, Drawing, Label
from flexlash.mechanics.sketch.part_sketch import part_sketch
from flexlash.schema.columns import DIMENSIONS, Column
from flexlash.schema.entry_words import dimension_words

__all__ = ["SKETCH", "SYMBOLS", "sketches", "write_sketch"]

SKETCH = "Sketch"

SYMBOLS = {
    "cylinder_length": "l",
    "mean_radius": "r_m",
    "bore_diameter": "bore ø",
    "wall_thickness": "Δ",
    "disk_thickness": "t",
    "disk_inner_radius": "r_ci",
    "disk_outer_radius": "r_co",
    "disk_hub_thickness": "t_hub",
    "hub_fillet_radius": "hub fillet R",
    "junction_fillet_radius": "junction fillet R",
    "rim_length": "rim length",
    "rim_thickness": "rim",
    "tooth_face_width": "tooth face",
    "disk_cone_angle": "cone angle",
}
"""What the sketches call the dimensions of Variants."""

_WALL = {"cylinder_length": 0.1, "wall_thickness": 0.005}
_RIM = {"rim_length": 0.026, "rim_thickness": 0.009, "tooth_face_width": 0.02}
_SHAPES: dict[str, dict[str, float]] = {
    "cup": _WALL
    | _RIM
    | {
        "mean_radius": 0.055,
        "disk_thickness": 0.006,
        "disk_inner_radius": 0.02,
        "hub_fillet_radius": 0.006,
        "junction_fillet_radius": 0.007,
    },
    "hat": _WALL | _RIM | {"bore_diameter": 0.075, "disk_thickness": 0.006, "disk_outer_radius": 0.066},
    "cylinder": _WALL | _RIM | {"mean_radius": 0.055},
}
"""Parts whose walls are thick enough to see."""

_COLUMNS = {"Symbol": 16, "Column of Variants": 28, "cup": 22, "hat": 22, "cylinder": 22, "Meaning": 90}
_PICTURE_ROW, _TABLE_ROW = 3, 19
_GAP = 8
"""Between two sketches [px]."""

_NAME_COLOUR = "#1F3A5F"


def sketches() -> dict[str, Drawing]:
    """Return the sketch of each flexspline type with its name, and with symbols instead of sizes."""
    drawings = {name: part_sketch(name, shape, with_sizes=False) for name, shape in _SHAPES.items()}
    return {name: replace(one, marks=(*one.marks, _name(name))) for name, one in drawings.items()}


def _name(kind: str) -> Label:
    return Label(x=4, y=LETTER, words=kind, colour=_NAME_COLOUR)


def write_sketch(workbook: Any, sheet: Any, lists: Any, formats: Mapping[str, Any]) -> None:
    """Write the sketches and what their symbols mean; the points of their lines stand on the sheet `lists`."""
    sheet.hide_gridlines(2)
    for index, width in enumerate(_COLUMNS.values()):
        sheet.set_column(index, index, width)
    sheet.set_row(0, 26)
    sheet.write_string(0, 0, "Sketch: what the symbols mean", formats["title"])
    hint = "Half-sections above the axis, open end to the right. The grey block holds the part."
    sheet.write_string(1, 0, hint, formats["hint"])
    left = 0
    for name, drawing in sketches().items():
        chart = drawn_chart(workbook, lists, name, drawing)
        place = {"x_offset": left, "description": f"{drawing.title}. {drawing.description}", "object_position": 3}
        sheet.insert_chart(_PICTURE_ROW, 0, chart, place)
        left += round(drawing.width) + _GAP
    _write_symbols(sheet, formats)
    sheet.freeze_panes(1, 0)
    set_up_page(sheet)
    sheet.protect("", {"format_columns": True, "objects": True})


def _write_symbols(sheet: Any, formats: Mapping[str, Any]) -> None:
    """Write one line a symbol: its column, what each type asks of it, what it means."""
    for index, heading in enumerate(_COLUMNS):
        sheet.write_string(_TABLE_ROW, index, heading, formats["header"])
    for row, (name, symbol) in enumerate(SYMBOLS.items(), start=_TABLE_ROW + 1):
        column = DIMENSIONS[name]
        sheet.set_row(row, 32 if len(column.help) > 1.1 * _COLUMNS["Meaning"] else 18)
        sheet.write_string(row, 0, symbol, formats["legend"])
        sheet.write_string(row, 1, column.label, formats["legend words"])
        for index, kind in enumerate(_SHAPES, start=2):
            style, words = _asked(column, kind)
            sheet.write_string(row, index, words, formats[style])
        sheet.write_string(row, len(_COLUMNS) - 1, column.help, formats["legend words"])


def _asked(column: Column, kind: str) -> tuple[str, str]:
    """Return what a flexspline type asks of a column, as a look and in words."""
    if kind in refusing_types(column):
        return "legend unused", "leave blank"
    if other := other_way(column):
        return "legend needed", f"this or {dimension_words(other)}"
    if column.required or kind in asking_types(column):
        return "legend needed", "fill in"
    return "legend", "may stay blank"
