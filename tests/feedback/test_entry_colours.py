"""The template colours what a row needs, lacks and does not take, as the book of rules says."""

from __future__ import annotations

import io
import itertools
import re

import openpyxl
import pytest
from libreoffice import convert, needs_libreoffice
from openpyxl.utils import get_column_letter, range_boundaries

from flexlash.feedback.template import entry_rules
from flexlash.feedback.template.demanded_cells import asking_types, refusing_types
from flexlash.feedback.template.entry_rules import FIRST_ROW, HEADER_ROW
from flexlash.feedback.template.template_formats import cell_formats
from flexlash.feedback.template.template_workbook import LEGEND, Filling, template_bytes
from flexlash.schema.columns import DIMENSIONS, VARIANTS

PLACES = {column.key: index for index, column in enumerate(VARIANTS, start=1)}
FULL = {"variant": "A", "material": "20Cr2Ni4", "torque_Nm": 800.0, "cylinder_length_mm": 160.0,
        "wall_thickness_mm": 1.6}  # fmt: skip
DISK = ["disk_thickness_mm", "disk_inner_radius_mm", "disk_outer_radius_mm", "disk_cone_angle_deg"]
CUP_ONLY = ["disk_hub_thickness_mm", "disk_thickness_exponent", "hub_fillet_radius_mm", "junction_fillet_radius_mm"]


def _all(look, *keys):
    return dict.fromkeys(keys, look)


NO_RADIUS = _all("missing", "mean_radius_mm", "bore_diameter_mm")
BY_MEAN = {"mean_radius_mm": "needed", "bore_diameter_mm": "unused"}
BY_BORE = {"mean_radius_mm": "unused", "bore_diameter_mm": "needed"}
NO_DISK = _all("unused", *DISK, *CUP_ONLY)
ROWS = {
    "blank": ({}, _all("needed", "mean_radius_mm", "bore_diameter_mm", "disk_inner_radius_mm")),
    "begun": (
        {"variant": "A"},
        _all("missing", *FULL, "mean_radius_mm", "bore_diameter_mm", "disk_inner_radius_mm") | {"variant": None},
    ),
    "cup": (FULL, NO_RADIUS | {"disk_inner_radius_mm": "missing"}),
    "cup in words": (FULL | {"flexspline_type": " Cup "}, NO_RADIUS | {"disk_inner_radius_mm": "missing"}),
    "complete cup": (
        FULL | {"mean_radius_mm": 80.0, "disk_inner_radius_mm": 40.0}, BY_MEAN | {"disk_inner_radius_mm": "needed"}
    ),
    "hat": (FULL | {"flexspline_type": "hat"},
            NO_RADIUS | _all("unused", *CUP_ONLY) | {"disk_outer_radius_mm": "missing"}),
    "complete hat": (
        FULL | {"flexspline_type": "hat", "bore_diameter_mm": 158.4, "disk_outer_radius_mm": 120.0},
        BY_BORE | _all("unused", *CUP_ONLY) | {"disk_outer_radius_mm": "needed"},
    ),
    "cylinder": (FULL | {"flexspline_type": "cylinder"}, NO_RADIUS | NO_DISK),
    "cylinder with a disk": (
        FULL | {"flexspline_type": "cylinder", "mean_radius_mm": 80.0, "disk_thickness_mm": 2.0},
        BY_MEAN | NO_DISK | {"disk_thickness_mm": "wrong"},
    ),
    "hat with a fillet, and one of 0": (
        FULL | {"flexspline_type": "hat", "mean_radius_mm": 80.0, "disk_outer_radius_mm": 120.0,
                "hub_fillet_radius_mm": 2.0, "junction_fillet_radius_mm": 0.0},
        BY_MEAN | _all("unused", *CUP_ONLY) | {"disk_outer_radius_mm": "needed", "hub_fillet_radius_mm": "wrong"},
    ),
    "both radii": (
        FULL | {"mean_radius_mm": 80.0, "bore_diameter_mm": 158.4, "disk_inner_radius_mm": 40.0},
        _all("wrong", "mean_radius_mm", "bore_diameter_mm") | {"disk_inner_radius_mm": "needed"},
    ),
    "half a rim": (
        FULL | {"mean_radius_mm": 80.0, "disk_inner_radius_mm": 40.0, "rim_length_mm": 20.0},
        BY_MEAN | {"disk_inner_radius_mm": "needed", "rim_thickness_mm": "missing"},
    ),
    "whole rim": (
        FULL | {"mean_radius_mm": 80.0, "disk_inner_radius_mm": 40.0, "rim_length_mm": 20.0, "rim_thickness_mm": 3.0},
        BY_MEAN | _all("needed", "disk_inner_radius_mm", "rim_thickness_mm", "rim_length_mm"),
    ),
    "cone with an exponent": (
        FULL | {"mean_radius_mm": 80.0, "disk_inner_radius_mm": 40.0, "disk_cone_angle_deg": 60.0,
                "disk_thickness_exponent": 2.0},
        BY_MEAN | {"disk_inner_radius_mm": "needed", "disk_hub_thickness_mm": "missing"}
        | _all("unused", "hub_fillet_radius_mm", "junction_fillet_radius_mm"),
    ),
    "type unknown": (FULL | {"flexspline_type": "cap"}, NO_RADIUS),
}  # fmt: skip
"""Rows, and the look of each cell that a colour reaches."""


@pytest.fixture(scope="module")
def book():
    """Return a template of these rows as openpyxl sees it."""
    return openpyxl.load_workbook(io.BytesIO(template_bytes(Filling(variants=[row for row, _ in ROWS.values()]))))


def _looks():
    """Return the names of the looks by their background and letters."""

    class _Book:
        def add_format(self, look):
            return look

    formats = cell_formats(_Book())
    return {(f"FF{formats[name]['bg_color'][1:]}", f"FF{formats[name]['font_color'][1:]}"): name for name in LEGEND}


def _rules(book):
    """Yield column, look and formula of each rule that colours an entry."""
    looks = _looks()
    for area in book["Variants"].conditional_formatting:
        left, top, right, _ = range_boundaries(str(area.sqref))
        for rule in area.rules:
            colours = rule.dxf.fill.bgColor.rgb, rule.dxf.font.color.rgb
            if left <= len(VARIANTS) and rule.type == "expression":
                assert (left, top) == (right, FIRST_ROW + 1)
                yield VARIANTS[left - 1].key, looks[colours], rule.formula[0]


@pytest.mark.slow
@needs_libreoffice
def test_each_cell_has_the_colour_that_its_row_asks_for(book, tmp_path):
    """Worked out by LibreOffice, the rules give each cell the look that its type asks for, never two at once."""
    rules = [*_rules(book)]
    sheet = book["Variants"]
    far = 100
    for place, (row, (_, _, formula)) in itertools.product(range(len(ROWS)), enumerate(rules)):
        moved = re.sub(rf"(\$?[A-Z]+){FIRST_ROW + 1}\b", rf"\g<1>{FIRST_ROW + 1 + place}", formula)
        sheet.cell(FIRST_ROW + 1 + place, far + row, f"={moved}")
    book.save(tmp_path / "rules.xlsx")
    done = openpyxl.load_workbook(convert(tmp_path / "rules.xlsx", "xlsx", tmp_path), data_only=True)["Variants"]
    for place, (name, (_, wanted)) in enumerate(ROWS.items()):
        found = {}
        for row, (key, look, _) in enumerate(rules):
            if done.cell(FIRST_ROW + 1 + place, far + row).value:
                assert key not in found, (name, key)
                found[key] = look
        assert found == {key: look for key, look in wanted.items() if look}, name


def test_what_each_type_asks_for():
    """Of the dimensions a blank row of each type lacks its radius, a cup r_ci, a hat r_co; no more are refused."""
    asked = {name: asking_types(column) for name, column in DIMENSIONS.items() if asking_types(column)}
    every = ("cup", "hat", "cylinder")
    assert asked == {"mean_radius": every, "bore_diameter": every, "disk_inner_radius": ("cup",),
                     "disk_outer_radius": ("hat",)}  # fmt: skip
    refused = {column.key: refusing_types(column) for column in VARIANTS if refusing_types(column)}
    assert refused == _all(("cylinder",), *DISK) | _all(("hat", "cylinder"), *CUP_ONLY)


def test_headers_and_legend_say_what_colours_mean(book):
    """Yellow headers are those of what every row needs, paler ones of what some do; the colours are named above."""
    sheet = book["Variants"]
    colours = {column.key: sheet.cell(HEADER_ROW + 1, place).fill.fgColor.rgb for place, column in
               enumerate(VARIANTS, start=1)}  # fmt: skip
    assert {key for key, colour in colours.items() if colour == "FFFFD966"} == set(FULL)
    some = {"mean_radius_mm", "bore_diameter_mm", "disk_inner_radius_mm", "disk_outer_radius_mm"}
    assert {key for key, colour in colours.items() if colour == "FFFFEDB3"} == some
    looks = _looks()
    named = {
        cell.value: looks[cell.fill.fgColor.rgb, cell.font.color.rgb if cell.font.color.type == "rgb" else "FF000000"]
        for cell in sheet[1]
        if cell.value in LEGEND.values()
    }
    assert named == {words: look for look, words in LEGEND.items()}


def test_letters_stand_out_from_their_colour():
    """Letters have a contrast of at least 4.5 to each colour behind them, and the colours differ in brightness."""
    brightness = {}
    for (back, front), name in _looks().items():
        light, dark = _luminance(back), _luminance(front)
        assert (light + 0.05) / (dark + 0.05) >= 4.5, name
        brightness[name] = round(light, 2)
    assert brightness["needed"] > brightness["unused"] > brightness["missing"] - 0.1
    assert len(set(brightness.values())) == len(LEGEND)


def _luminance(colour):
    """Return the relative luminance of a colour as WCAG defines it."""
    parts = [int(colour[place : place + 2], 16) / 255 for place in (2, 4, 6)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def test_a_newcomer_begins_in_the_first_row(book):
    """The template opens on Variants with the first cell to fill selected, its header within the first 15 rows."""
    assert book.active.title == "Variants"
    assert book["Variants"].sheet_view.selection[-1].activeCell == f"A{FIRST_ROW + 1}"
    assert entry_rules.HEADER_ROW + 1 <= 15
    links = {cell.hyperlink.location for row in book["Variants"]["A1:AC2"] for cell in row if cell.hyperlink}
    assert links == {"'Sketch'!A1", "'Dictionary'!A1"}
    assert get_column_letter(PLACES["variant"]) == "A"
