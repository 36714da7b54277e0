"""Materials, Tolerances and Settings: every fault by its code and cell, and what a sound row becomes in SI."""

from dataclasses import replace

import pytest

from flexlash.reading.raw import ErrorCell, RawSheet, Unstored
from flexlash.schema.variant import Material, Settings, ToleranceRow
from flexlash.validation.ledger import Ledger
from flexlash.validation.materials_and_classes import (
    built_in_materials,
    built_in_sheet,
    materials_of,
    standard_class,
    tolerance_classes_of,
)
from flexlash.validation.row_checks import check_cells
from flexlash.validation.settings_table import settings_of
from flexlash.validation.typed_columns import tabulate

MATERIALS = ["material", "youngs_modulus_GPa", "poisson_ratio", "shear_modulus_GPa", "density_kg_m3", "yield_MPa"]
TOLERANCES = [
    "tolerance_class",
    "dimension",
    "lower_deviation",
    "upper_deviation",
    "deviation_unit",
    "grade",
    "distribution",
    "limits_sigma",
]
DEVIATIONS = {
    "tolerance_class": "fine",
    "dimension": "wall_thickness",
    "lower_deviation": -0.02,
    "upper_deviation": 0.01,
}
GRADE = {"tolerance_class": "fine", "dimension": "wall_thickness", "grade": "IT9"}


def _table(schema, headers, rows, *, from_text=False):
    raw = {
        number: {place: value for place, value in enumerate(row, start=1) if value is not None}
        for number, row in enumerate([headers, *rows], start=1)
    }
    ledger = Ledger("a.xlsx")
    table = tabulate(RawSheet(name=schema, rows=raw, numbers_are_texts=from_text), schema, ledger)
    check_cells(table, ledger)
    return table, ledger


def _materials(*rows):
    """Return the materials of rows given as lists, and the ledger."""
    table, ledger = _table("Materials", MATERIALS, rows)
    return materials_of(table, ledger), ledger


def _classes(*rows):
    """Return the tolerance classes of rows given by key, and the ledger."""
    table, ledger = _table("Tolerances", TOLERANCES, [[row.get(key) for key in TOLERANCES] for row in rows])
    return tolerance_classes_of(table, ledger), ledger


def _settings(*rows, from_text=False):
    """Return the settings of pairs of setting and value, and the ledger."""
    table, ledger = _table("Settings", ["Setting", "Value"], rows, from_text=from_text)
    return settings_of(table, ledger), ledger


def _told(ledger):
    return [(found.code, found.cell) for found in ledger.findings]


def test_built_in_materials():
    """The built-in materials are those of the template, in Pa, each usable."""
    materials = built_in_materials()
    assert len(materials) == 13
    assert materials["20cr2ni4"] == Material(
        name="20Cr2Ni4",
        constants={"youngs_modulus": 211e9, "poisson_ratio": 0.3},
        yield_strength=1080e6,
        density=7850,
    )
    for material in materials.values():
        assert set(material.constants) == {"youngs_modulus", "poisson_ratio"}
        assert 100e9 < material.constants["youngs_modulus"] < 220e9
        assert 0.25 < material.constants["poisson_ratio"] < 0.35
        assert 500e6 < material.yield_strength < 2500e6


def test_built_in_materials_are_shown_as_they_are_used():
    """The built-in materials, read as a sheet as the report shows them, are those that are computed with."""
    ledger = Ledger("a.xlsx")
    table = tabulate(built_in_sheet("Materials"), "Materials", ledger)
    assert materials_of(table, ledger) == built_in_materials()
    assert ledger.findings == []


def test_the_built_in_class_is_shown_as_it_is_used():
    """Class standard, read as the report shows it with its name put in, is the one that is computed with."""
    shown = built_in_sheet("Tolerances")
    width = len(TOLERANCES)
    rows = {
        number: {**cells, width: "Tolerance class" if number == 1 else "standard"}
        for number, cells in shown.rows.items()
    }
    ledger = Ledger("a.xlsx")
    table = tabulate(RawSheet(name="Tolerances", rows=rows), "Tolerances", ledger)
    found = tolerance_classes_of(table, ledger)["standard"]
    assert [replace(row, row=0) for row in found] == standard_class()


def test_a_material_in_si():
    """A material becomes its constants in Pa, found by its name in any case and spacing."""
    materials, ledger = _materials(["My Steel", 211, 0.3, None, 7850, 900], ["G only", None, None, 80.5, None, None])
    assert materials == {
        "mysteel": Material(
            name="My Steel",
            constants={"youngs_modulus": 211e9, "poisson_ratio": 0.3},
            yield_strength=900e6,
            density=7850,
        ),
        "gonly": Material(name="G only", constants={"shear_modulus": 80.5e9}),
    }
    assert ledger.findings == []


@pytest.mark.parametrize(
    ("row", "told"),
    [
        (["X", None, 0.3], [("E322", "B2")]),
        (["X", 211], [("E322", "C2")]),
        (["X", None, None, None, 7850], [("E322", "B2"), ("E322", "C2")]),
        (["X", 0, 0.3], [("E207", "B2")]),
        (["X", -211, 0.3], [("E207", "B2")]),
        (["X", 211, -0.1], [("E207", "C2")]),
        (["X", 211, 0.51], [("E208", "C2")]),
        (["X", "211 GPa", 0.3], [("E202", "B2")]),
        (["X", 211, 0.3, 0], [("E207", "D2")]),
        (["X", 211, 0.3, None, 0], [("E207", "E2")]),
        (["X", 211, 0.3, None, 7850, True], [("E204", "F2")]),
        (["X", ErrorCell("#N/A"), 0.3], [("E205", "B2")]),
    ],
)
def test_a_faulty_material_is_named(row, told):
    """A material without usable constants is told at its cells and spoils the variants made of it, no others."""
    _, ledger = _materials(row, ["sound", 211, 0.3])
    assert _told(ledger) == told
    assert ledger.materials == {"x"}
    assert not ledger.everything


@pytest.mark.parametrize(
    "row",
    [
        ["X", 211, 0],
        ["X", 211, 0.5],
        ["X", 211, 0.3, 81.1],
        ["X", None, None, 80],
        ["X", 211, None, 80],
        ["X", None, 0.3, 80],
    ],
)
def test_a_material_at_the_edge(row):
    """Poisson's ratio may be 0 or 0.5, and G may be given alone, with one or with both of E and ν."""
    materials, ledger = _materials(row)
    assert set(materials) == {"x"}
    assert [found.code for found in ledger.findings if found.level == "error"] == []


@pytest.mark.parametrize(("shear", "told"), [(81.153, []), (81.19, []), (81.20, ["W404"]), (80, ["W404"])])
def test_constants_that_disagree(shear, told):
    """A shear modulus that differs from E and ν by over 0.05 % is a warning; the entered value is used."""
    materials, ledger = _materials(["X", 211, 0.3, shear])
    assert [found.code for found in ledger.findings] == told
    assert materials["x"].constants["shear_modulus"] == pytest.approx(shear * 1e9)
    assert ledger.materials == set()


def test_a_material_twice():
    """A material that stands twice, in whatever case, is told with its partner and spoils its variants."""
    _, ledger = _materials(["20Cr2Ni4", 211, 0.3], ["other", 200, 0.3], ["20CR2NI4 ", 210, 0.3])
    _, found = [found for found in ledger.findings if found.code == "E321"]
    assert (found.cell, found.column, found.value) == ("A4", "material", "20CR2NI4 ")
    assert "A2" in found.message
    assert ledger.materials == {"20cr2ni4"}


def test_a_material_without_name():
    """A row of numbers without a name is told and spoils nothing."""
    materials, ledger = _materials([None, 211, 0.3], ["sound", 211, 0.3])
    assert _told(ledger) == [("E201", "A2")]
    assert set(materials) == {"sound"}
    assert ledger.materials == set()


def test_deviations_in_si():
    """Deviations become metres, with the default distribution and limits at three sigma."""
    classes, ledger = _classes(DEVIATIONS)
    assert classes == {
        "fine": [ToleranceRow(row=2, tolerance_class="fine", dimension="wall_thickness", lower=-2e-5, upper=1e-5)]
    }
    assert ledger.findings == []


@pytest.mark.parametrize(
    ("dimension", "unit", "size", "relative"),
    [
        ("wall_thickness", None, 1e-3, False),
        ("wall_thickness", "mm", 1e-3, False),
        ("wall_thickness", "µm", 1e-6, False),
        ("wall_thickness", "in", 0.0254, False),
        ("wall_thickness", " % ", 0.01, True),
        ("torque", None, 1, False),
        ("torque", "N·m", 1, False),
        ("torque", "kN·m", 1000, False),
        ("torque", "%", 0.01, True),
        ("youngs_modulus", None, 1e9, False),
        ("youngs_modulus", "MPa", 1e6, False),
        ("youngs_modulus", "%", 0.01, True),
        ("poisson_ratio", "-", 1, False),
        ("poisson_ratio", None, 1, False),
        ("poisson_ratio", "%", 0.01, True),
        ("cylinder_calibration", "-", 1, False),
    ],
)
def test_deviation_units(dimension, unit, size, relative):
    """Deviations may be in any unit of the dimension, in % of the entered value, or without unit in its own."""
    classes, ledger = _classes(DEVIATIONS | {"dimension": dimension, "deviation_unit": unit})
    (row,) = classes["fine"]
    assert (row.lower, row.upper) == pytest.approx((-0.02 * size, 0.01 * size), rel=1e-14)
    assert row.relative == relative
    assert [found.code for found in ledger.findings if found.level != "info"] == []


@pytest.mark.parametrize("grade", ["IT5", "IT12", "js7", "h6", "H7", "2768-f", "2768-m", "2768-c", "2768-v"])
def test_grades(grade):
    """ISO 286 and ISO 2768 grades are taken as entered."""
    classes, ledger = _classes(GRADE | {"grade": grade})
    assert [row.grade for row in classes["fine"]] == [grade]
    assert ledger.findings == []


@pytest.mark.parametrize("distribution", ["normal", "truncated normal", "uniform", "triangular", "Truncated-Normal"])
def test_distributions(distribution):
    """The four distributions are taken, also in other case; limits may lie at another number of sigma."""
    classes, _ = _classes(DEVIATIONS | {"distribution": distribution, "limits_sigma": 2})
    (row,) = classes["fine"]
    assert (row.distribution, row.limits_sigma) == (distribution.lower().replace("-", " "), 2)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"grade": "IT13"}, [("E210", "F2")]),
        ({"grade": "g6"}, [("E210", "F2")]),
        ({"grade": "2768-k"}, [("E210", "F2")]),
        ({"grade": "IT9", "lower_deviation": -0.02}, [("E316", "F2")]),
        ({"grade": "IT9", "upper_deviation": 0}, [("E316", "F2")]),
        ({"grade": "IT13", "lower_deviation": -0.02}, [("E316", "F2")]),
        ({"grade": None}, [("E317", "C2"), ("E317", "D2")]),
        ({"grade": None, "lower_deviation": 0}, [("E317", "D2")]),
        ({"grade": None, "upper_deviation": 0}, [("E317", "C2")]),
        ({"grade": None, "lower_deviation": 0.01, "upper_deviation": -0.02}, [("E318", "C2")]),
        ({"deviation_unit": "N·mm"}, [("E211", "E2")]),
        ({"deviation_unit": "furlong"}, [("E211", "E2")]),
        ({"deviation_unit": "-"}, [("E211", "E2")]),
        ({"dimension": "torque", "deviation_unit": "mm", "grade": None, "lower_deviation": -1, "upper_deviation": 1},
         [("E211", "E2")]),
        ({"dimension": "poisson_ratio", "deviation_unit": "mm", "grade": None, "lower_deviation": -1,
          "upper_deviation": 1}, [("E211", "E2")]),
        ({"dimension": "hub_fillet_radius"}, [("E320", "F2")]),
        ({"dimension": "junction_fillet_radius"}, [("E320", "F2")]),
        ({"dimension": "torque"}, [("E320", "F2")]),
        ({"dimension": "youngs_modulus"}, [("E320", "F2")]),
        ({"dimension": "poisson_ratio"}, [("E320", "F2")]),
        ({"dimension": "cylinder_calibration"}, [("E320", "F2")]),
        ({"dimension": None}, [("E201", "B2")]),
        ({"dimension": "wall"}, [("E209", "B2")]),
        ({"dimension": "rated_torque"}, [("E209", "B2")]),
        ({"dimension": "backlash_limit"}, [("E209", "B2")]),
        ({"distribution": "gaussian"}, [("E209", "G2")]),
        ({"limits_sigma": 0}, [("E207", "H2")]),
        ({"limits_sigma": -3}, [("E207", "H2")]),
        ({"limits_sigma": 101}, [("E208", "H2")]),
        ({"limits_sigma": "3σ"}, [("E202", "H2")]),
        ({"grade": None, "lower_deviation": "±0.02"}, [("E202", "C2")]),
        ({"grade": Unstored()}, [("E206", "F2")]),
        ({"grade": "IT 7", "distribution": "gaussian"}, [("E209", "G2"), ("E210", "F2")]),
        ({"grade": "IT 7", "dimension": "wall"}, [("E209", "B2"), ("E210", "F2")]),
        ({"grade": "IT9", "dimension": "torque", "limits_sigma": 0}, [("E207", "H2"), ("E320", "F2")]),
        ({"grade": None, "lower_deviation": "x"}, [("E202", "C2"), ("E317", "D2")]),
        ({"grade": None, "lower_deviation": "x", "upper_deviation": 1}, [("E202", "C2")]),
        ({"grade": None, "distribution": "gaussian"}, [("E209", "G2"), ("E317", "C2"), ("E317", "D2")]),
        ({"grade": None, "lower_deviation": 1, "upper_deviation": 0, "limits_sigma": 0},
         [("E207", "H2"), ("E318", "C2")]),
        ({"deviation_unit": "furlong", "distribution": "gaussian"}, [("E209", "G2"), ("E211", "E2")]),
        ({"deviation_unit": "furlong", "dimension": "wall"}, [("E209", "B2")]),
        ({"dimension": "wall", "lower_deviation": 0}, [("E209", "B2"), ("E316", "F2")]),
    ],
)  # fmt: skip
def test_a_faulty_tolerance_row_is_named(change, told):
    """Each fault of a tolerance row has its code and cell, and spoils its class alone."""
    classes, ledger = _classes(GRADE | change, {**GRADE, "tolerance_class": "other"})
    assert _told(ledger) == told
    assert ledger.classes == {"fine"}
    assert classes["fine"] == []
    assert len(classes["other"]) == 1
    assert not ledger.everything


def test_faults_of_a_row_that_stands_twice():
    """A row that stands twice is judged in its cells like any other."""
    _, ledger = _classes(GRADE, GRADE | {"grade": "IT 7"})
    assert _told(ledger) == [("E319", "B2"), ("E319", "B3"), ("E210", "F3")]


@pytest.mark.parametrize(
    ("unit", "words"),
    [(None, "5, and % as the deviation unit"), ("%", "5"), ("mm", "")],
)
def test_per_cent_in_a_deviation(unit, words):
    """A deviation of 5 % beside a blank unit needs the unit %, so that nobody types 5 and gets millimetres."""
    _, ledger = _classes(DEVIATIONS | {"upper_deviation": "5 %", "deviation_unit": unit})
    (found,) = ledger.findings
    assert (found.code, found.cell, found.suggestion) == ("E202", "D2", words)


def test_messages_of_tolerances():
    """Messages name the dimension, what it takes, and the deviation that collides."""
    _, ledger = _classes(
        DEVIATIONS | {"deviation_unit": "kN·m"}, DEVIATIONS | {"lower_deviation": 1.5, "dimension": "torque"}
    )
    unit, reversed_ = ledger.findings
    assert unit.message == ('Tolerances!E2 Deviation unit = "kN·m": wall_thickness takes mm or % of the entered value.')
    assert reversed_.message == "Tolerances!C3 Lower deviation = 1.5 is greater than the upper deviation 0.01."


def test_a_tolerance_twice():
    """A second row of the same class and dimension is told with its partner and spoils the class."""
    _, ledger = _classes(GRADE, GRADE | {"dimension": "rim_length"}, DEVIATIONS | {"tolerance_class": " FINE"})
    _, found = [found for found in ledger.findings if found.level == "error"]
    assert (found.code, found.cell, found.value) == ("E319", "B4", "wall_thickness")
    assert "B2" in found.message
    assert ledger.classes == {"fine"}


def test_one_dimension_in_two_classes():
    """Two classes may each have a row for the same dimension."""
    classes, ledger = _classes(GRADE, GRADE | {"tolerance_class": "coarse", "grade": "IT11"})
    assert {name: [row.grade for row in rows] for name, rows in classes.items()} == {
        "fine": ["IT9"],
        "coarse": ["IT11"],
    }
    assert ledger.findings == []


def test_a_tolerance_without_class():
    """A tolerance row without class might belong to any, so that nothing is computed."""
    _, ledger = _classes(GRADE | {"tolerance_class": None})
    assert _told(ledger) == [("E201", "A2")]
    assert ledger.everything


def test_the_built_in_class():
    """Class standard holds exactly the rows of the contract."""
    graded = {
        "bore_diameter": "H7",
        "mean_radius": "IT7",
        "wall_thickness": "IT9",
        "disk_thickness": "IT9",
        "disk_hub_thickness": "IT9",
        "rim_thickness": "IT9",
        "disk_inner_radius": "IT9",
        "disk_outer_radius": "IT9",
        "cylinder_length": "IT11",
        "rim_length": "IT12",
    }
    ranged = {
        "hub_fillet_radius": (-0.1, 0.1, True, "normal"),
        "junction_fillet_radius": (-0.1, 0.1, True, "normal"),
        "youngs_modulus": (-0.02, 0.02, True, "normal"),
        "poisson_ratio": (-0.01, 0.01, False, "uniform"),
    }
    rows = {row.dimension: row for row in standard_class()}
    assert {name: row.grade for name, row in rows.items() if row.grade} == graded
    found = {
        name: (row.lower, row.upper, row.relative, row.distribution) for name, row in rows.items() if not row.grade
    }
    assert found == ranged
    assert {row.limits_sigma for row in rows.values()} == {3}
    assert {rows[name].distribution for name in graded} == {"normal"}


def test_settings_by_default():
    """Without rows, or with blank values, every setting has its default."""
    expected = Settings(
        seed=0,
        coverage_percent=95,
        method="line",
        samples=None,
        lost_motion_percent=4,
        calibrations={"cylinder_calibration": 1.0, "disk_calibration": 1.0},
    )
    blank, ledger = _settings(["seed", None], ["method", None], ["samples", None], ["disk_calibration", None])
    assert blank == _settings()[0] == Settings() == expected
    assert ledger.findings == []


def test_settings_as_entered():
    """Settings are taken as entered, in any order, their names and lists in any case and spacing."""
    found, ledger = _settings(
        ["Samples", 4096],
        ["METHOD", "Sobol"],
        ["seed", 7],
        ["coverage percent", 99.73],
        ["lost_motion_percent", 3],
        ["cylinder_calibration", 1.1],
        ["disk_calibration", 0.9],
    )
    assert found == Settings(
        seed=7,
        coverage_percent=99.73,
        method="sobol",
        samples=4096,
        lost_motion_percent=3,
        calibrations={"cylinder_calibration": 1.1, "disk_calibration": 0.9},
    )
    assert {found.level for found in ledger.findings} <= {"info"}
    assert not ledger.everything


def test_whole_settings_are_whole():
    """Seed and samples become whole numbers, also when stored with a point."""
    found, _ = _settings(["seed", 7.0], ["samples", 64.0])
    assert [type(found.seed), type(found.samples)] == [int, int]


def test_settings_from_a_table_of_texts():
    """In a CSV file the values are texts that hold numbers."""
    found, ledger = _settings(["seed", "7"], ["method", "random"], ["disk_calibration", "0.9"], from_text=True)
    assert (found.seed, found.method, found.calibrations["disk_calibration"]) == (7, "random", 0.9)
    assert ledger.findings == []


@pytest.mark.parametrize(
    ("name", "value", "code", "suggestion"),
    [
        ("seed", -1, "E207", ""),
        ("seed", 2**32, "E208", ""),
        ("seed", 1.5, "E213", ""),
        ("seed", "7", "E220", "7"),
        ("seed", "TBD", "E221", ""),
        ("method", "n/a", "E221", ""),
        ("seed", "x", "E202", ""),
        ("coverage_percent", 0, "E207", ""),
        ("coverage_percent", 100, "E208", ""),
        ("coverage_percent", "95%", "E202", "95"),
        ("method", "lines", "E209", "line"),
        ("method", "monte carlo", "E209", ""),
        ("method", 1, "E209", ""),
        ("samples", 0, "E207", ""),
        ("samples", 2**22 + 1, "E208", ""),
        ("samples", 10.5, "E213", ""),
        ("lost_motion_percent", 0, "E207", ""),
        ("lost_motion_percent", 100.1, "E208", ""),
        ("cylinder_calibration", 0, "E207", ""),
        ("cylinder_calibration", 10.1, "E208", ""),
        ("cylinder_calibration", 1e-300, "E207", ""),
        ("disk_calibration", 0.099, "E207", ""),
        ("disk_calibration", -1, "E207", ""),
        ("disk_calibration", "1,1", "E202", "1.1"),
    ],
)
def test_a_faulty_setting_stops_everything(name, value, code, suggestion):
    """A setting out of bounds is told at its value, in its own terms, and nothing is computed with its default."""
    _, ledger = _settings(["lost_motion_percent", 4] if name == "seed" else ["seed", 1], [name, value])
    (found,) = ledger.findings
    assert (found.code, found.cell, found.column, found.suggestion) == (code, "B3", name, suggestion)
    assert f"Settings!B3 {name} {'holds' if code == 'E220' else '='} " in found.message
    assert ledger.everything


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("seed", 0),
        ("seed", 2**32 - 1),
        ("coverage_percent", 99.99),
        ("samples", 1),
        ("samples", 2**22),
        ("lost_motion_percent", 100),
        ("cylinder_calibration", 10),
        ("cylinder_calibration", 0.1),
    ],
)
def test_a_setting_at_its_limit(name, value):
    """A setting exactly at its limit is taken; an unusual one is told."""
    found, ledger = _settings([name, value])
    assert {**vars(found), **found.calibrations}[name] == value
    unusual = name in {"lost_motion_percent", "cylinder_calibration"}
    assert [one.code for one in ledger.findings] == ["W440"][:unusual]


@pytest.mark.parametrize(
    ("name", "value", "usual"),
    [
        ("disk_calibration", 0.49, "0.5 to 2.5"),
        ("disk_calibration", 0.5, ""),
        ("cylinder_calibration", 2.5, ""),
        ("cylinder_calibration", 2.51, "0.5 to 2.5"),
        ("lost_motion_percent", 0.9, "1 to 10 %"),
        ("lost_motion_percent", 3, ""),
    ],
)
def test_an_unusual_setting(name, value, usual):
    """A setting that is possible but unusual is used, with a warning that says what is usual."""
    found, ledger = _settings([name, value])
    assert {**vars(found), **found.calibrations}[name] == value
    words = [f"Settings!B2 {name} = {value}: {usual} is plausible; used as entered."] if usual else []
    assert [one.message for one in ledger.findings] == words


def test_a_setting_twice():
    """A setting that stands twice is told with its partner, and nothing is computed."""
    _, ledger = _settings(["seed", 1], ["method", "line"], ["Seed", 2])
    _, found = [found for found in ledger.findings if found.level == "error"]
    assert (found.code, found.cell, found.value) == ("E323", "A4", "Seed")
    assert "A2" in found.message
    assert ledger.everything


def test_a_value_without_a_setting():
    """A value whose setting is blank is told once."""
    _, ledger = _settings([None, 5], ["seed", 1])
    assert [found.code for found in ledger.findings] in (["E201"], ["W408"])


@pytest.mark.parametrize(
    "value", [True, ErrorCell("#REF!"), Unstored(), "x" * 1001], ids=["truth", "error", "formula", "long"]
)
def test_a_setting_that_is_no_entry_stops_everything(value):
    """A setting that shows an error, or was not calculated, stops everything like one out of bounds."""
    _, ledger = _settings(["seed", value])
    assert [found.cell for found in ledger.findings] == ["B2"]
    assert ledger.everything


def test_an_unknown_setting_stops_everything():
    """A misspelt setting is told with a suggestion, and nothing is computed with its default."""
    _, ledger = _settings(["sede", 5])
    (found,) = ledger.findings
    assert (found.code, found.cell, found.suggestion) == ("E209", "A2", "seed")
    assert ledger.everything


def test_what_a_setting_requires_is_said_of_the_setting():
    """A truth value as seed is told that a whole number is required."""
    _, ledger = _settings(["seed", True])
    assert "a whole number" in ledger.findings[0].message


def test_the_fix_of_a_fraction():
    """A seed of 1.5 is told to be whole, by message and fix."""
    _, ledger = _settings(["seed", 1.5])
    assert "whole" in ledger.findings[0].fix


@pytest.mark.parametrize("sheet", ["Materials", "Tolerances", "Settings"])
def test_both_of_two_are_marked(sheet):
    """Of a material, tolerance or setting that stands twice both rows are marked, each with its partner."""
    if sheet == "Materials":
        _, ledger = _materials(["X", 211, 0.3], ["X", 210, 0.3])
    elif sheet == "Tolerances":
        _, ledger = _classes(GRADE, GRADE)
    else:
        _, ledger = _settings(["seed", 1], ["seed", 2])
    assert {found.cell[1:] for found in ledger.findings} == {"2", "3"}


def test_newton_metres_do_not_measure_a_wall():
    """A deviation in N·m of a thickness is an error, not a tolerance of some picometres."""
    _, ledger = _classes(DEVIATIONS | {"deviation_unit": "N·m"})
    assert _told(ledger) == [("E211", "E2")]


def test_tolerances_without_the_dimension_column():
    """A Tolerances sheet that lacks its Dimension column is told so, and nothing else happens."""
    headers = [key for key in TOLERANCES if key != "dimension"]
    table, ledger = _table("Tolerances", headers, [["fine", -0.02, 0.01]])
    tolerance_classes_of(table, ledger)
    assert {found.code for found in ledger.findings} == {"E111"}


def test_tolerances_with_a_misspelt_dimension_column():
    """A blank cell under a misspelt Dimension header does no harm beyond the header's own error."""
    headers = ["Dimensoin" if key == "dimension" else key for key in TOLERANCES]
    table, ledger = _table("Tolerances", headers, [["fine", None, -0.02, 0.01]])
    tolerance_classes_of(table, ledger)
    assert {found.code for found in ledger.findings} == {"E112"}
