"""Inputs of Trace that make no part: what the program refuses shows no number, and everything else does."""

from __future__ import annotations

import re

import pytest
from libreoffice import convert_all, needs_libreoffice
from report_entries import error_cells, typed, values_of
from traced_rows import LINES, MATERIALS, ROWS, rows_of, traced

from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.pipeline import check
from flexlash.report.trace.trace_sheet import NO_PART, UNREAL
from flexlash.schema.findings import CATALOGUE

BASE = ("cup", "refined", "taper", "power law", "cone", "hat", "cylinder", "rimmed cylinder", "given G")
REFUSED = {
    "junction fillet beyond the bore": ("refined", {"junction_fillet_radius_mm": 200.0}, "E313"),
    "junction fillet beyond the bore of a long cup": (
        "refined", {"junction_fillet_radius_mm": 90.0, "cylinder_length_mm": 300.0}, "E328",
    ),
    "no radius": ("refined", {"bore_diameter_mm": None}, "E301"),
    "no radius either": ("cup", {"mean_radius_mm": None}, "E301"),
    "both radii": ("cup", {"mean_radius_mm": 80.0, "bore_diameter_mm": 159.0}, "E302"),
    "hub beyond the disk": ("cup", {"disk_inner_radius_mm": 90.0}, "E303"),
    "hub as wide as the disk": ("cup", {"disk_inner_radius_mm": 80.0}, "E303"),
    "bolts within the wall": ("hat", {"disk_outer_radius_mm": 75.0}, "E303"),
    "wall of twice the radius": ("cup", {"wall_thickness_mm": 160.0}, "E330"),
    "wall in micrometres": ("cylinder", {"wall_thickness_mm": 450.0}, "E330"),
    "hub fillet wider than the disk": ("refined", {"hub_fillet_radius_mm": 45.0}, "E312"),
    "rim beyond the cylinder": ("refined", {"rim_length_mm": 170.0}, "E305"),
    "rim as long as the cylinder": ("rimmed cylinder", {"rim_length_mm": 160.0}, "E305"),
    "thin rim": ("refined", {"rim_thickness_mm": 1.0}, "E306"),
    "rim without a thickness": ("refined", {"rim_thickness_mm": None}, "E304"),
    "rim without a length": ("cup", {"rim_thickness_mm": 3.0}, "E304"),
    "fillet and rim longer than the cup": ("refined", {"rim_length_mm": 158.0}, "E313"),
    "teeth wider than the cup": ("cup", {"tooth_face_width_mm": 161.0}, "E360"),
    "teeth in the fillet": ("refined", {"tooth_face_width_mm": 158.0}, "E360"),
    "cone with fillets": ("refined", {"disk_cone_angle_deg": 45.0}, "E327"),
    "cone with a junction fillet": ("cone", {"junction_fillet_radius_mm": 2.0}, "E327"),
    "cup with a hub fillet made a hat": ("refined", {"flexspline_type": "hat"}, "E310"),
    "hat with an exponent of 0": ("hat", {"disk_thickness_exponent": 0.0}, "E310"),
    "cup made a cylinder": ("cup", {"flexspline_type": "cylinder"}, "E310"),
    "cylinder with a cone": ("cylinder", {"disk_cone_angle_deg": 90.0}, "E310"),
    "cylinder with a thick disk": ("cylinder", {"disk_thickness_mm": 2.0}, "E310"),
    "cylinder made a cup": ("cylinder", {"flexspline_type": "cup"}, "E311"),
    "cup without a hub": ("cup", {"disk_inner_radius_mm": None}, "E311"),
    "hat without bolts": ("hat", {"disk_outer_radius_mm": None}, "E311"),
    "unknown type": ("cup", {"flexspline_type": "foo"}, "E209"),
    "exponent without thickness at hub": ("cup", {"disk_thickness_exponent": 2.0}, "E325"),
    "exponent and thickness": ("taper", {"disk_thickness_exponent": 2.0}, "E326"),
    "no thickness": ("cup", {"disk_thickness_mm": 0.0}, "E207"),
    "no wall": ("cup", {"wall_thickness_mm": 0.0}, "E207"),
    "no torque": ("cup", {"torque_Nm": None}, "E201"),
    "torque backwards": ("cup", {"torque_Nm": -800.0}, "E207"),
    "a word for a length": ("cup", {"cylinder_length_mm": "long"}, "E202"),
    "a word for a bore": ("refined", {"bore_diameter_mm": "wide"}, "E202"),
    "steep cone": ("cup", {"disk_cone_angle_deg": 0.0}, "E207"),
    "cone beyond flat": ("cup", {"disk_cone_angle_deg": 91.0}, "E208"),
    "steep exponent": ("power law", {"disk_thickness_exponent": 11.0}, "E208"),
    "no modulus": ("cup", {"youngs_modulus_GPa": None}, "E322"),
    "no ratio": ("cup", {"poisson_ratio": None}, "E322"),
    "ratio of nothing": ("cup", {"poisson_ratio": -1.0}, "E207"),
    "ratio of no material": ("cup", {"poisson_ratio": 0.6}, "E208"),
    "given modulus taken away": ("given G", {"shear_modulus_GPa": None}, "E322"),
    "hardly any modulus": ("cup", {"youngs_modulus_GPa": 1e-6}, "E324"),
}  # fmt: skip
SOUND = {
    "nothing": ("cup", {}),
    "wide hub fillet": ("refined", {"hub_fillet_radius_mm": 39.0}),
    "wide junction fillet": ("refined", {"junction_fillet_radius_mm": 70.0}),
    "hub near the disk": ("cup", {"disk_inner_radius_mm": 75.0}),
    "hub just inside the bore": ("cup", {"disk_inner_radius_mm": 79.1}),
    "bolts just outside the wall": ("hat", {"disk_outer_radius_mm": 80.9}),
    "thick wall": ("cup", {"wall_thickness_mm": 70.0}),
    "bore instead": ("cup", {"bore_diameter_mm": 159.0}),
    "radius instead": ("refined", {"mean_radius_mm": 79.0}),
    "rim left out": ("refined", {"rim_length_mm": None, "rim_thickness_mm": None}),
    "rim as thick as the wall": ("refined", {"rim_thickness_mm": 1.6}),
    "rim and fillet fill the cup": ("refined", {"rim_length_mm": 157.0}),
    "teeth on the rim": ("refined", {"tooth_face_width_mm": 12.0}),
    "teeth beyond the rim": ("refined", {"tooth_face_width_mm": 40.0}),
    "teeth on a plain cup": ("cup", {"tooth_face_width_mm": 160.0}),
    "cone without fillets": (
        "refined", {"disk_cone_angle_deg": 45.0, "hub_fillet_radius_mm": None, "junction_fillet_radius_mm": 0.0},
    ),
    "flat cone with fillets": ("refined", {"disk_cone_angle_deg": 90.0}),
    "another letter case": ("cup", {"flexspline_type": "CUP"}),
    "hat made a cylinder": ("hat", {"flexspline_type": "cylinder", "disk_outer_radius_mm": None}),
    "cylinder with a fillet of 0": ("cylinder", {"hub_fillet_radius_mm": 0.0}),
    "cup made a hat": (
        "cup", {"flexspline_type": "hat", "disk_inner_radius_mm": None, "disk_outer_radius_mm": 120.0},
    ),
    "power law with exponent 0": ("power law", {"disk_thickness_exponent": 0.0}),
    "power law without thickness": ("taper", {"disk_thickness_exponent": 2.0, "disk_thickness_mm": None}),
    "modulus without ratio": ("given G", {"youngs_modulus_GPa": 200.0}),
    "shear modulus alone": ("cup", {"shear_modulus_GPa": 80.0, "poisson_ratio": None, "youngs_modulus_GPa": None}),
    "ratio of rubber": ("cup", {"poisson_ratio": 0.47}),
}  # fmt: skip
CASES = {name: case[:2] for name, case in (REFUSED | SOUND).items()}
ONLY_TRACE = {
    "lost motion of nothing": ({"lost_motion_percent": 0.05}, "E207"),
    "calibration left out": ({"disk_calibration": None}, "E201"),
    "calibration of nothing": ({"disk_calibration": 1e-300}, "E207"),
    "calibration too large": ({"cylinder_calibration": 11.0}, "E208"),
    "rated torque in words": ({"rated_torque_Nm": "much"}, "E202"),
}
"""Settings and requirements, which are no part of a row's shape, on the variant `cup`."""


def _is_of_material(key):
    return key.endswith(("GPa", "MPa", "ratio"))


def _codes(workbook):
    """Return the codes of the errors that the program finds in rows with these changes, and in their materials."""
    rows, materials = {}, []
    for name, (base, changes) in CASES.items():
        material = next(one for one in MATERIALS if one["material"] == ROWS[base]["material"]) | {"material": name}
        material |= {key: value for key, value in changes.items() if _is_of_material(key)}
        row = ROWS[base] | {key: value for key, value in changes.items() if not _is_of_material(key)}
        if isinstance(changes.get("bore_diameter_mm"), float) and "mean_radius_mm" not in changes:
            row["mean_radius_mm"] = None
        if "mean_radius_mm" in changes and "bore_diameter_mm" not in changes:
            row["bore_diameter_mm"] = None
        rows[name] = row | {"material": name}
        materials.append({key: value for key, value in material.items() if value is not None})
    outcome = check(workbook(rows_of(rows), materials=materials))
    codes = {name: set() for name in CASES}
    errors = [found for found in outcome.findings if found.level == "error"]
    (first,) = {found.cell[1:] for found in errors if found.variant == next(iter(CASES))}
    for found in errors:
        codes[list(CASES)[int(found.cell[1:]) - int(first)]].add(found.code)
    assert {name for name, found in codes.items() if not found} == {
        one.variant.name for one in outcome.computed.values()
    }
    return codes


@pytest.fixture(scope="module")
def trace(tmp_path_factory):
    """Return the lines of a trace by key, and a folder with the report."""
    folder = tmp_path_factory.mktemp("parts")
    path = folder / "submission.xlsx"
    rows = rows_of({name: ROWS[name] for name in BASE})
    path.write_bytes(template_bytes(Filling(variants=rows, materials=MATERIALS)))
    lines, data = traced(check(path))
    (folder / "report.xlsx").write_bytes(data)
    return lines, folder


def _entries(lines, base, changes):
    entries = {"B3": base}
    for key, value in changes.items():
        line = LINES.get(key) or re.sub("_(mm|Nm|GPa|deg)$", "", key)
        entries["G" + lines[line].text.rpartition("$")[2]] = "none" if value is None else value
    return entries


@pytest.mark.slow
@needs_libreoffice
def test_trace_refuses_what_the_program_refuses(trace, workbook):
    """Typed into Trace, exactly those changes show no number which the same row of a submission is refused for."""
    lines, folder = trace
    codes = _codes(workbook)
    assert {name for name, found in codes.items() if not found} == set(SOUND)
    cases = CASES | {name: ("cup", changes) for name, (changes, _) in ONLY_TRACE.items()}
    told = {name: case[-1] for name, case in (REFUSED | ONLY_TRACE).items()}
    paths = [
        typed(folder / "report.xlsx", folder / f"{place}.xlsx", "Trace", _entries(lines, base, changes))
        for place, (base, changes) in enumerate(cases.values())
    ]
    results = {key for key in lines if _row(lines, key) >= _row(lines, "torque_over_modulus")}
    for name, path in zip(cases, convert_all(paths, "xlsx", folder), strict=True):
        values = values_of(path, "Trace")
        assert not error_cells(values | values_of(path, "Trace steps")), name
        shown = {values[lines[key].text.replace("$", "")] for key in results}
        if name in SOUND:
            assert str(values["E3"]).startswith("◄ backlash "), name
            assert shown != {"none"}, name
        elif told[name] == "E324":
            assert values["E3"] == UNREAL
        else:
            assert str(values["E3"]).startswith(NO_PART), (name, values["E3"])
            assert str(values["E3"]).endswith(f"({told[name]})"), (name, values["E3"])
            assert shown == {"none"}, name
            assert not _numbers_from(values, _row(lines, "torque_over_modulus")), name
        assert name not in REFUSED or told[name] in codes[name], (name, codes[name])


def _numbers_from(values, row):
    """Return the cells with numbers from a row on."""
    return [cell for cell, value in values.items() if int(cell[1:]) >= row and isinstance(value, int | float)]


def _row(lines, key):
    return int(lines[key].text.rpartition("$")[2])


def test_every_rule_names_a_finding(trace):
    """Each rule stands on Trace steps in words, with the code of a finding that is an error."""
    values = values_of(trace[1] / "report.xlsx", "Trace steps")
    rules = {values[f"A{cell[1:]}"]: code for cell, code in values.items() if cell[0] == "C" and int(cell[1:]) > 4}
    assert len(rules) > 45
    assert {code[0] for code in rules.values()} == {"E"}
    assert set(rules.values()) <= CATALOGUE.keys()
    assert rules["torque is not a number above 0 N·m"] == "E202"
    assert rules["disk cone angle is not a number from 30 to 90 °"] == "E202"
    assert rules["cylinder calibration is not a number from 0.1 to 10"] == "E202"
