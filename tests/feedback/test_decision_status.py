"""The status of Other sources, Levers and Sweep says what a row lacks, and is complete where nothing is wrong."""

from __future__ import annotations

import openpyxl
import pytest
from filled import SOUND, filled
from libreoffice import convert_all, needs_libreoffice

from flexlash.feedback.template.entry_rules import FIRST_ROW
from flexlash.pipeline import check
from flexlash.reading.raw import ErrorCell
from flexlash.schema.columns import ENTRY_SHEETS

_MM = {"enter_as": "mm at radius", "value_arcmin": 0.01, "radius_mm": 80.0}
_RADIAL = _MM | {"enter_as": "mm radial play"}
_BOTH = {"lower_deviation": -0.005, "upper_deviation": 0.005}

SOURCE_ROWS = [
    (_MM | _BOTH, "complete"),
    ({"value_arcmin": 5.0}, "complete"),
    ({"lower_deviation": 0.0, "upper_deviation": 2.0}, "complete"),
    ({"value_arcmin": 5.0, "side": "output", "source": None}, "source missing"),
    (_MM | {"enter_as": "inch"}, "enter as is not in its list"),
    (_MM | {"enter_as": " MM at radius "}, "complete"),
    (_MM | {"value_arcmin": -0.01}, "value is not a number of at least 0"),
    (_MM | {"value_arcmin": "0,01"}, "value is not a number of at least 0"),
    (_MM | {"value_arcmin": ErrorCell("#REF!")}, "a cell holds an error"),
    (_MM | {"radius_mm": None}, "radius missing"),
    (_RADIAL | {"radius_mm": None}, "radius missing"),
    (_MM | {"enter_as": None}, "a radius beside arcmin"),
    (_MM | {"enter_as": "Arcmin"}, "a radius beside arcmin"),
    (_MM | {"radius_mm": 0.0}, "radius is not a number above 0 mm"),
    (_RADIAL, "complete"),
    (_RADIAL | {"pressure_angle_deg": 30.0}, "complete"),
    (_RADIAL | {"pressure_angle_deg": 61.0}, "pressure angle is not a number above 0, at most 60 °"),
    (_MM | {"pressure_angle_deg": 30.0}, "a pressure angle without mm radial play"),
    ({"value_arcmin": 5.0, "pressure_angle_deg": 30.0}, "a pressure angle without mm radial play"),
    ({"value_arcmin": 5.0, "side": "input"}, "ratio missing"),
    ({"value_arcmin": 5.0, "side": "Input", "ratio": 100.0}, "complete"),
    ({"value_arcmin": 5.0, "ratio": 100.0}, "a ratio on the output side"),
    ({"value_arcmin": 5.0, "side": "output", "ratio": 100.0}, "a ratio on the output side"),
    ({"value_arcmin": 5.0, "side": "input", "ratio": 0.5}, "ratio is not a number of at least 1"),
    ({"value_arcmin": 5.0, "lower_deviation": -1.0}, "upper deviation missing"),
    ({"value_arcmin": 5.0, "upper_deviation": 1.0}, "lower deviation missing"),
    (
        {"value_arcmin": 5.0, "lower_deviation": 1.0, "upper_deviation": -1.0},
        "lower deviation is above upper deviation",
    ),
    ({}, "neither value nor deviations are given"),
    ({"value_arcmin": 5.0, "kind": "random"}, "a random source without deviations"),
    ({"kind": "random", **_BOTH}, "complete"),
    ({"kind": "random", "lower_deviation": -2.0, "upper_deviation": 1.0}, "complete"),
    ({"kind": "luck", **_BOTH}, "kind is not in its list"),
    ({"lower_deviation": -2.0, "upper_deviation": 1.0}, "the play is below 0 in the middle of its deviations"),
    ({"value_arcmin": 0.3, "lower_deviation": -0.7, "upper_deviation": 0.1}, "complete"),
    (_BOTH, "complete"),
    (_BOTH | {"distribution": "measured"}, "distribution is not in its list"),
    (_BOTH | {"distribution": "triangular", "limits_sigma": 0.4}, "limits at ± sigma is not a number from 0.5 to 100"),
]

_WALL = {"dimension": "wall_thickness"}
LEVER_ROWS = [
    ({"dimension": "torque", "may_change": "yes"}, "complete"),
    ({"dimension": None, "may_change": "no", "cost_per_step": 1.0}, "dimension missing"),
    ({"dimension": "youngs_modulus"}, "dimension is not in its list"),
    ({"dimension": "Mean_radius ", "may_change": "No"}, "complete"),
    ({"dimension": "rim_length", "may_change": "perhaps"}, "may change is not in its list"),
    ({"dimension": "rim_length", "tolerance_may_change": "perhaps"}, "tolerance may change is not in its list"),
    ({"dimension": "rim_length", "step": 0.0}, "drawing step is not a number above 0"),
    ({"dimension": "rim_length", "cost_per_step": -1.0}, "cost per step is not a number of at least 0"),
    ({"dimension": "rim_length", "cost_per_grade": "x"}, "cost per IT grade is not a number of at least 0"),
    ({"dimension": "cylinder_length", "lowest": 100.0, "highest": 200.0, "step": 0.5}, "complete"),
    ({"dimension": "disk_inner_radius", "lowest": 200.0, "highest": 100.0}, "lowest is above highest"),
    ({"dimension": "disk_thickness", "lowest": -1.0}, "lowest is beyond what its dimension can be"),
    ({"dimension": "disk_hub_thickness", "lowest": 0.0}, "complete"),
    ({"dimension": "rim_thickness", "highest": 0.0}, "highest is beyond what its dimension can be"),
    ({"dimension": "hub_fillet_radius", "highest": 0.0}, "complete"),
    ({"dimension": "disk_cone_angle", "lowest": 20.0}, "lowest is beyond what its dimension can be"),
    ({"dimension": "disk_thickness_exponent", "highest": 11.0}, "highest is beyond what its dimension can be"),
    ({"dimension": "bore_diameter", "lowest": 20.0, "highest": 20.0}, "complete"),
    (_WALL, "dimension used twice"),
    (_WALL | {"dimension": "Wall_thickness"}, "dimension used twice"),
    ({"dimension": "material", "cost_per_step": 3.0, "may_change": "yes"}, "complete"),
]
_OTHERS = "another material has no range, no step and no tolerance"

_LENGTH = {"dimension": "cylinder_length", "from": 100.0, "to": 200.0, "step": 20.0}
_DISK = {"second_dimension": "disk_thickness", "second_from": 1.6, "second_to": 2.0, "second_step": 0.1}
SWEEP_ROWS = [
    (_LENGTH, "complete"),
    (_LENGTH | {"variant": "b3-160"}, "complete"),
    (_LENGTH | _DISK, "complete"),
    (_LENGTH | {"variant": "B3-161"}, "variant not in Variants"),
    (_LENGTH | {"dimension": None}, "dimension missing"),
    (_LENGTH | {"dimension": "length"}, "dimension is not in its list"),
    (_LENGTH | {"dimension": "material"}, "dimension is not in its list"),
    (_LENGTH | {"from": None}, "from missing"),
    (_LENGTH | {"to": None}, "to missing"),
    (_LENGTH | {"step": None}, "step missing"),
    (_LENGTH | {"step": -20.0}, "step is not a number above 0"),
    (_LENGTH | {"from": 200.0, "to": 100.0}, "complete"),
    (_LENGTH | {"to": "200 mm"}, "to is not a number"),
    (_LENGTH | {"from": 0.0}, "from is beyond what its dimension can be"),
    (_LENGTH | {"dimension": "hub_fillet_radius", "from": 0.0, "to": 3.0, "step": 1.0}, "complete"),
    (
        _LENGTH | {"dimension": "disk_cone_angle", "from": 60.0, "to": 95.0, "step": 5.0},
        "to is beyond what its dimension can be",
    ),
    (_LENGTH | {"step": 101.0}, "step reaches no second value"),
    (_LENGTH | {"to": 100.0}, "complete"),
    (_LENGTH | {"second_dimension": "disk_thickness"}, "second from missing"),
    (_LENGTH | _DISK | {"second_dimension": None}, "second dimension missing"),
    (_LENGTH | _DISK | {"second_to": None}, "second to missing"),
    (_LENGTH | _DISK | {"second_step": None}, "second step missing"),
    (_LENGTH | _DISK | {"second_step": 0.5}, "second step reaches no second value"),
    (_LENGTH | _DISK | {"second_dimension": "cylinder_length "}, "one dimension swept twice"),
    (_LENGTH | _DISK | {"second_from": -1.6}, "second from is beyond what its dimension can be"),
    (_LENGTH | {"step": 0.01}, "more than 2000 rows to compute"),
    (_LENGTH | _DISK | {"second_step": 0.001}, "more than 2000 rows to compute"),
]


def _rows(sheet):
    if sheet == "Other sources":
        return [{"source": f"play {number}"} | row for number, (row, _) in enumerate(SOURCE_ROWS)] + [
            {"source": name, "value_arcmin": 1.0} for name in ("twin", "Twin")
        ]
    if sheet == "Levers":
        return [row for row, _ in LEVER_ROWS]
    return [row for row, _ in SWEEP_ROWS]


STATUSES = {
    "Other sources": [text for _, text in SOURCE_ROWS] + ["source used twice"] * 2,
    "Levers": [text for _, text in LEVER_ROWS],
    "Sweep": [text for _, text in SWEEP_ROWS],
}


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """Return a template with one row per status."""
    path = tmp_path_factory.mktemp("filled") / "filled.xlsx"
    path.write_bytes(
        filled([SOUND], other_sources=_rows("Other sources"), levers=_rows("Levers"), sweep=_rows("Sweep"))
    )
    return path


def _statuses(path, sheet):
    cells = openpyxl.load_workbook(path, data_only=True)[sheet]
    place = len(ENTRY_SHEETS[sheet]) + 1
    return [cells.cell(FIRST_ROW + 1 + row, place).value for row in range(len(STATUSES[sheet]))]


@pytest.mark.parametrize("sheet", STATUSES)
def test_stored_status_tells_what_a_row_lacks(path, sheet):
    """The stored status names the first thing that a row lacks."""
    assert _statuses(path, sheet) == STATUSES[sheet]


@pytest.mark.parametrize("key", ["lowest", "highest", "step", "tolerance_may_change", "cost_per_grade"])
def test_another_material_has_no_range(tmp_path, key):
    """Each cell that a material cannot have is told; one of its cost is not."""
    file = tmp_path / "material.xlsx"
    row = {"dimension": "material", "cost_per_step": 2.0, key: "no" if key == "tolerance_may_change" else 1.0}
    file.write_bytes(filled([SOUND], levers=[row]))
    cells = openpyxl.load_workbook(file, data_only=True)["Levers"]
    assert cells.cell(FIRST_ROW + 1, len(ENTRY_SHEETS["Levers"]) + 1).value == _OTHERS
    (found,) = (one for one in check(file).findings if one.level == "error")
    assert (found.code, found.column) == ("E362", key)


@pytest.mark.slow
@needs_libreoffice
def test_the_status_formula_calculates_what_is_stored(path, tmp_path):
    """Recalculated by a spreadsheet program, every status formula gives its stored text."""
    (recalculated,) = convert_all([path], "xlsx", tmp_path)
    for sheet, texts in STATUSES.items():
        assert _statuses(recalculated, sheet) == texts


@pytest.mark.parametrize("sheet", STATUSES)
def test_the_status_agrees_with_check(path, sheet):
    """A row that is complete has no error for `flexlash check`, and every other row has one."""
    blamed = {finding.row for finding in check(path).findings if finding.level == "error" and finding.sheet == sheet}
    lacking = {FIRST_ROW + 1 + row for row, text in enumerate(STATUSES[sheet]) if text != "complete"}
    assert lacking == blamed
