"""The whole submission: every fault at once at its own cell, sound rows kept, and what one fault spoils elsewhere."""

import datetime
import decimal
import math

import numpy as np
import polars as pl
import pytest
import regenerate

from flexlash.analysis.assessment import assess
from flexlash.pipeline import check
from flexlash.reading.gate import Refusal
from flexlash.reading.raw import ErrorCell, RawSheet, Submission, Unstored
from flexlash.schema.cell_addresses import column_letters
from flexlash.schema.columns import VARIANTS, columns_of
from flexlash.schema.variant import Settings
from flexlash.validation.consolidation import consolidated
from flexlash.validation.validate import validate

ROW = {
    "variant": "A",
    "flexspline_type": "cup",
    "material": "20Cr2Ni4",
    "torque_Nm": 800,
    "cylinder_length_mm": 160,
    "mean_radius_mm": 80,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40,
}
KEYS = [column.key for column in VARIANTS]
MATERIALS = [["Material", "youngs_modulus_GPa", "poisson_ratio", "shear_modulus_GPa", "yield_MPa"]]
TOLERANCES = [["Tolerance class", "Dimension", "Lower deviation", "Upper deviation", "Grade"]]


def _sheet(name, rows, first=1):
    cells = {
        number: {place: value for place, value in enumerate(row, start=1) if value is not None}
        for number, row in enumerate(rows, start=first)
    }
    return RawSheet(name=name, rows={number: row for number, row in cells.items() if row})


def _submission(rows, kind="workbook", headers=(), **sheets):
    """Return a submission of Variants rows by key and of other sheets as lists; `headers` replace keys."""
    titles = [dict(headers).get(key, key) for key in KEYS]
    variants = _sheet("Variants", [titles, *([row.get(key) for key in KEYS] for row in rows)])
    others = {name: _sheet(name, lines) for name, lines in sheets.items()}
    return Submission(name="a.xlsx", sha256="", kind=kind, sheets={"Variants": variants, **others})


def _named(count):
    return [ROW | {"variant": f"V{number}"} for number in range(1, count + 1)]


def _told(validated, *levels):
    found = consolidated(validated)
    return [(one.code, one.place) for one in found if not levels or one.level in levels]


def _kept(validated):
    return [variant.name for variant in validated.variants]


def test_a_sound_row_in_si():
    """A sound row becomes a variant in m, N·m, Pa and rad, with its material's constants and the calibrations."""
    row = ROW | {"rated_torque_Nm": 600, "backlash_limit_arcmin": 60, "rim_length_mm": 25, "rim_thickness_mm": 3.2}
    (variant,) = validate(_submission([row])).variants
    assert (variant.row, variant.name, variant.flexspline_type, variant.material) == (2, "A", "cup", "20Cr2Ni4")
    assert variant.tolerance_class == "standard"
    assert variant.dimensions == pytest.approx(
        {
            "torque": 800,
            "cylinder_length": 0.16,
            "mean_radius": 0.08,
            "wall_thickness": 0.0016,
            "disk_inner_radius": 0.04,
            "rim_length": 0.025,
            "rim_thickness": 0.0032,
            "youngs_modulus": 211e9,
            "poisson_ratio": 0.3,
            "cylinder_calibration": 1,
            "disk_calibration": 1,
        },
        rel=1e-15,
    )
    assert variant.rated_torque == 600
    assert variant.backlash_limit == pytest.approx(math.radians(1), rel=1e-15)
    assert variant.yield_strength == 1080e6


def test_what_is_blank_or_equal_is_left_out():
    """A blank type is a cup; a fillet of 0, a blank disk thickness and a blank outer radius are no dimensions."""
    row = ROW | {"flexspline_type": None, "hub_fillet_radius_mm": 0, "junction_fillet_radius_mm": 0.0}
    (variant,) = validate(_submission([row])).variants
    assert variant.flexspline_type == "cup"
    left_out = {"hub_fillet_radius", "junction_fillet_radius", "disk_thickness", "disk_outer_radius", "bore_diameter"}
    assert left_out & set(variant.dimensions) == set()
    assert (variant.rated_torque, variant.backlash_limit) == (None, None)


def test_a_shear_modulus_is_used_instead():
    """A material with G carries G alone, so that tolerances of E and ν do not apply."""
    materials = [*MATERIALS, ["X", 211, 0.3, 81.15, None]]
    (variant,) = validate(_submission([ROW | {"material": " x "}], Materials=materials)).variants
    constants = {"youngs_modulus", "poisson_ratio", "shear_modulus"} & set(variant.dimensions)
    assert constants == {"shear_modulus"}
    assert (variant.material, variant.yield_strength) == ("X", None)


def test_young_and_poisson_stay_known_beside_a_shear_modulus():
    """E and ν of the material reach the variant in any case, for what does not follow from G; blank ones do not."""
    materials = [*MATERIALS, ["X", 200, 0.25, 70, None], ["Y", None, None, 70, None], ["Z", 200, 0.25, None, None]]
    rows = [ROW | {"variant": name, "material": name} for name in "XYZ"]
    found = {
        one.name: (one.youngs_modulus, one.poisson_ratio, "shear_modulus" in one.dimensions)
        for one in validate(_submission(rows, Materials=materials)).variants
    }
    assert found == {"X": (200e9, 0.25, True), "Y": (None, None, True), "Z": (200e9, 0.25, False)}


def test_requirements_are_no_dimensions():
    """Rated torque, load inertia and backlash limit stand beside the dimensions, in SI."""
    row = ROW | {"rated_torque_Nm": 1600, "load_inertia_kg_m2": 0.5, "backlash_limit_arcmin": 3.75}
    (variant,) = validate(_submission([row])).variants
    assert (variant.rated_torque, variant.load_inertia) == (1600, 0.5)
    assert variant.backlash_limit == pytest.approx(math.radians(3.75 / 60), rel=1e-15)
    assert not {"rated_torque", "load_inertia", "load_inertia_kg_m2", "backlash_limit"} & set(variant.dimensions)
    (variant,) = validate(_submission([ROW])).variants
    assert (variant.rated_torque, variant.load_inertia, variant.backlash_limit) == (None, None, None)


def test_exponent_and_cone_angle_reach_the_variant():
    """The exponent is a plain number, 0 too, and the cone angle becomes radians, 90° too."""
    rows = [
        ROW | {"variant": "A", "disk_hub_thickness_mm": 4, "disk_thickness_exponent": 0},
        ROW | {"variant": "B", "disk_hub_thickness_mm": 4, "disk_thickness_exponent": 2, "disk_cone_angle_deg": 60},
        ROW | {"variant": "C", "disk_cone_angle_deg": 90},
    ]
    keys = ("disk_thickness_exponent", "disk_cone_angle")
    found = [tuple(one.dimensions.get(key) for key in keys) for one in validate(_submission(rows)).variants]
    assert found == [(0.0, None), (2.0, pytest.approx(math.pi / 3, rel=1e-15)), (None, math.pi / 2)]


@pytest.mark.parametrize("kind", ["hat", "cylinder"])
def test_an_exponent_of_zero_is_no_dimension_without_a_cups_disk(kind):
    """A hat's or cylinder's exponent of 0 is refused or left out, so that no tolerance row makes it scatter."""
    disk = {"disk_inner_radius_mm": None, "disk_outer_radius_mm": 120 if kind == "hat" else None}
    row = ROW | disk | {"flexspline_type": kind, "disk_thickness_exponent": 0}
    validated = validate(_submission([row, *_named(1)]))
    assert "V1" in _kept(validated)
    assert [one.name for one in validated.variants if "disk_thickness_exponent" in one.dimensions] == []


def test_settings_reach_the_variants():
    """Calibrations of Settings are dimensions of every variant."""
    settings = [["Setting", "Value"], ["disk_calibration", 1.2], ["seed", 5]]
    validated = validate(_submission(_named(2), Settings=settings))
    assert {variant.dimensions["disk_calibration"] for variant in validated.variants} == {1.2}
    assert validated.settings.seed == 5


def test_every_fault_has_one_finding_at_its_cell():
    """Twenty-four rows with a fault each have one error each, at the guilty cell; the sound rows are kept."""
    filling = regenerate.needs_fixing()
    validated = validate(_submission(filling.variants))
    errors = [found for found in consolidated(validated) if found.level == "error"]
    expected = {f"fault {code}": (code, column) for code, column, _ in regenerate.FAULTS}
    assert {found.variant: (found.code, found.column) for found in errors} == expected
    assert len(errors) == len(expected)
    names = [row["variant"] for row in filling.variants]
    for found in errors:
        letter = column_letters(KEYS.index(found.column) + 1)
        assert found.place == f"Variants!{letter}{names.index(found.variant) + 2}"
    assert _kept(validated) == ["sound cup", "sound bore", "sound cylinder"]


def test_all_errors_of_a_row_at_once():
    """Every fault of a row is told in one go, each at its own cell, and the name of the variant with it."""
    row = ROW | {"torque_Nm": -1, "wall_thickness_mm": "1,6", "flexspline_type": "cap", "rim_length_mm": 5}
    validated = validate(_submission([row, *_named(1)]))
    assert sorted(_told(validated, "error")) == [
        ("E202", "Variants!H2"),
        ("E207", "Variants!D2"),
        ("E209", "Variants!B2"),
        ("E304", "Variants!R2"),
    ]
    assert {found.variant for found in consolidated(validated) if found.cell} == {"A"}
    assert _kept(validated) == ["V1"]


@pytest.mark.parametrize(
    ("key", "value", "code"),
    [
        ("variant", None, "E201"),
        ("material", None, "E201"),
        ("torque_Nm", None, "E201"),
        ("cylinder_length_mm", None, "E201"),
        ("wall_thickness_mm", None, "E201"),
        ("wall_thickness_mm", " ", "E201"),
        ("torque_Nm", 0, "E207"),
        ("torque_Nm", -0.0, "E207"),
        ("wall_thickness_mm", -1.6, "E207"),
        ("mean_radius_mm", 0, "E207"),
        ("disk_hub_thickness_mm", 0, "E207"),
        ("disk_thickness_exponent", -0.1, "E207"),
        ("disk_thickness_exponent", 10.1, "E208"),
        ("disk_cone_angle_deg", 29.9, "E207"),
        ("disk_cone_angle_deg", 90.1, "E208"),
        ("load_inertia_kg_m2", 0, "E207"),
        ("load_inertia_kg_m2", "1 kg·m²", "E202"),
        ("hub_fillet_radius_mm", -0.1, "E207"),
        ("junction_fillet_radius_mm", -0.1, "E207"),
        ("rated_torque_Nm", 0, "E207"),
        ("backlash_limit_arcmin", 0, "E207"),
        ("flexspline_type", "pancake", "E209"),
    ],
)
def test_each_cell_by_itself(key, value, code):
    """Required cells are filled, numbers lie in their bounds and entries in their list; each fault stops its row."""
    validated = validate(_submission([ROW | {key: value}, *_named(1)]))
    (found,) = [found for found in consolidated(validated) if found.level == "error"]
    assert (found.code, found.column, found.cell) == (code, key, f"{chr(65 + KEYS.index(key))}2")
    assert columns_of("Variants")[key].requirement in found.message
    assert _kept(validated) == ["V1"]


def test_a_list_entry_that_was_meant():
    """A misspelt entry of a list gets the nearest one as suggestion."""
    (found,) = [
        found
        for found in consolidated(validate(_submission([ROW | {"flexspline_type": "cylindre"}])))
        if found.level == "error"
    ]
    assert (found.code, found.suggestion) == ("E209", "cylinder")


def test_one_cause_is_told_once():
    """A wall that is text is not also too thin for the rim, too thick for the radius, or missing."""
    row = ROW | {"wall_thickness_mm": "1.6 mm", "rim_length_mm": 20, "rim_thickness_mm": 3}
    bore = row | {"variant": "B", "mean_radius_mm": None, "bore_diameter_mm": 158.4}
    assert _told(validate(_submission([row, bore])), "error") == [("E202", "Variants!H2"), ("E202", "Variants!H3")]


def test_duplicates_name_all_partners():
    """Each row of a name used more than once is marked and names all others; other rows are kept."""
    rows = [ROW | {"variant": name} for name in ("A", "B", "A", "C", "A")]
    validated = validate(_submission(rows))
    found = {found.cell: found for found in consolidated(validated) if found.code == "E308"}
    partners = {"A2": "A4, A6", "A4": "A2, A6", "A6": "A2, A4"}
    assert set(found) == set(partners)
    for cell, others in partners.items():
        assert found[cell].message == f'Variants!{cell} Variant = "A" is also in {others}.'
    assert _kept(validated) == ["B", "C"]


@pytest.mark.parametrize(("count", "others"), [(2, "A2"), (12, "A2:A12"), (100, "A2:A100"), (101, "A2:A102")])
def test_all_partners_of_a_duplicate_are_named(count, others):
    """However many rows share a name, each names all the others; of more than a hundred the range of all is told."""
    validated = validate(_submission([ROW] * count))
    assert len(_told(validated, "error")) == count
    assert consolidated(validated)[-1].message.endswith(f" is also in {others}.")


def test_only_findings_of_a_row_name_its_variant():
    """A finding on another sheet, or on the header row, names no variant; one in a row names that row's."""
    materials = [*MATERIALS, ["20Cr2Ni4", -1, 0.3]]
    headers = [("notes", "Customer")]
    validated = validate(_submission([ROW | {"torque_Nm": 0}], headers=headers, Materials=materials))
    named = {found.place: found.variant for found in consolidated(validated) if found.cell}
    assert named == {"Variants!AB1": "", "Variants!D2": "A", "Materials!B2": ""}


@pytest.mark.parametrize("name", [" A ", "a", "A\u200b"], ids=ascii)
def test_names_after_their_repair_are_compared(name):
    """Two names that differ by outer spaces, letter case or hidden characters alone are the same name."""
    assert _told(validate(_submission([ROW, ROW | {"variant": name}])), "error") == [
        ("E308", "Variants!A2"),
        ("E308", "Variants!A3"),
    ]


@pytest.mark.parametrize(
    ("key", "value", "code", "suggestion"),
    [
        ("material", "20Cr2Ni5", "E307", "20Cr2Ni4"),
        ("material", "40CrNiMo", "E307", "40CrNiMoA"),
        ("material", "unobtainium", "E307", ""),
        ("tolerance_class", "standart", "E309", "standard"),
        ("tolerance_class", "fein", "E309", "fine"),
        ("tolerance_class", "xyz", "E309", ""),
    ],
)
def test_an_unknown_name_gets_the_nearest(key, value, code, suggestion):
    """A material or class that does not exist stops its row; the nearest that does is suggested."""
    tolerances = [*TOLERANCES, ["fine", "wall_thickness", None, None, "IT7"]]
    validated = validate(_submission([ROW | {key: value}, *_named(1)], Tolerances=tolerances))
    (found,) = [found for found in consolidated(validated) if found.level == "error"]
    assert (found.code, found.column, found.suggestion, found.value) == (code, key, suggestion, value)
    assert _kept(validated) == ["V1"]


@pytest.mark.parametrize("name", ["20cr2ni4", " 20Cr2Ni4 ", "20 Cr 2 Ni 4", "20CR2NI4"])
def test_names_are_found_in_any_case_and_spacing(name):
    """A material is found in other case and spacing, and is then called as in its table."""
    (variant,) = validate(_submission([ROW | {"material": name, "tolerance_class": "STANDARD"}])).variants
    assert variant.material == "20Cr2Ni4"


def test_a_faulty_material_stops_its_variants_alone():
    """A material with a fault stops the variants made of it; those of others are kept."""
    materials = [*MATERIALS, ["X", "211 GPa", 0.3], ["Y", 211, 0.3]]
    rows = [ROW | {"variant": "made of X", "material": "x"}, ROW | {"variant": "made of Y", "material": "Y"}]
    validated = validate(_submission(rows, Materials=materials))
    assert _told(validated, "error") == [("E202", "Materials!B2")]
    assert _kept(validated) == ["made of Y"]


def test_a_faulty_class_stops_its_variants_alone():
    """A tolerance class with a fault stops the variants that name it; blank means standard."""
    tolerances = [
        *TOLERANCES,
        ["fine", "wall_thickness", 1, None, None],
        ["rough", "wall_thickness", None, None, "IT9"],
    ]
    rows = [ROW | {"variant": f"in {name}", "tolerance_class": name} for name in ("fine", "rough", None)]
    validated = validate(_submission(rows, Tolerances=tolerances))
    assert _told(validated, "error") == [("E317", "Tolerances!D2")]
    assert _kept(validated) == ["in rough", "in None"]


def test_a_faulty_standard_class_stops_blank_cells_too():
    """A fault in class standard stops the variants that name no class."""
    tolerances = [
        *TOLERANCES,
        ["standard", "wall_thickness", 1, 0, None],
        ["rough", "wall_thickness", None, None, "IT9"],
    ]
    rows = [ROW | {"variant": f"in {name}", "tolerance_class": name} for name in ("Standard", "rough", None)]
    validated = validate(_submission(rows, Tolerances=tolerances))
    assert _told(validated, "error") == [("E318", "Tolerances!C2")]
    assert _kept(validated) == ["in rough"]


def test_a_faulty_setting_leaves_nothing():
    """A setting out of bounds leaves no variant, since all would be computed with another value than was meant."""
    validated = validate(_submission(_named(3), Settings=[["Setting", "Value"], ["seed", -1]]))
    assert _told(validated, "error") == [("E207", "Settings!B2")]
    assert not validated.variants
    assert len(validated.submitted) == 3


@pytest.mark.parametrize(
    "header", [("wall_thickness_mm", None), ("torque_Nm", "Load"), ("torque_Nm", "mean_radius_mm")]
)
def test_a_missing_or_double_column_leaves_nothing(header):
    """Without a required column, or with one twice, nothing is computed and no row is blamed for it."""
    validated = validate(_submission(_named(3), headers=[header]))
    codes = [code for code, _ in _told(validated, "error")]
    assert codes in (["E111"], ["E112"], ["E114", "E111"])
    assert not validated.variants


def test_no_rows():
    """A sheet without rows is told where the first would stand."""
    validated = validate(_submission([]))
    assert _told(validated, "error") == [("E115", "Variants!A2")]
    assert validated.submitted == []


def test_no_header_row_leaves_nothing():
    """A Variants sheet without header row is told once and has no rows."""
    sheet = _sheet("Variants", [["B3-160", "cup", "20Cr2Ni4", 800]])
    validated = validate(Submission(name="a.xlsx", sha256="", kind="csv", sheets={"Variants": sheet}))
    assert _told(validated) == [("E109", "Variants!A1")]
    assert (len(validated.variants), validated.submitted) == (0, [])


def test_a_misspelt_sheet_is_asked_about(book):
    """The message of a misspelt sheet asks whether it was meant."""
    (found,) = check(book({"Varaints": [["a"]]})).findings
    assert found.message == "submission.xlsx has no sheet Variants; it has the sheets Varaints; did you mean Varaints?"


@pytest.mark.parametrize("name", ["variants", "VARIANTS", " Variants "])
def test_case_and_spaces_of_a_sheets_name_do_not_matter(name):
    """A sheet's name is recognised in any case, and findings call it as the file does."""
    sheet = _sheet(name, [KEYS, [(ROW | {"torque_Nm": 0}).get(key) for key in KEYS]])
    validated = validate(Submission(name="a.xlsx", sha256="", kind="workbook", sheets={name: sheet}))
    assert _told(validated, "error") == [("E207", f"{name}!D2")]


@pytest.mark.parametrize(
    ("version", "refused"),
    [("", False), ("0", False), ("1", False), ("7", False), ("8", True), ("10", True), ("x", False)],
)
def test_a_newer_template_is_refused(version, refused):
    """A template of a later version is refused, naming both versions; of this or an earlier one it is read."""
    submission = Submission(
        name="a.xlsx", sha256="", kind="workbook", template_version=version, sheets=_submission([ROW]).sheets
    )
    if not refused:
        assert _kept(validate(submission)) == ["A"]
        return
    with pytest.raises(Refusal) as caught:
        validate(submission)
    assert (caught.value.code, caught.value.facts) == ("E116", {"found": version, "known": 7})


def test_built_in_tables_are_told_of_a_workbook_alone():
    """A workbook without Materials or class standard is told what takes their place; a plain table cannot have them."""
    assert [code for code, _ in _told(validate(_submission([ROW])))] == ["I505", "I505"]
    assert _told(validate(_submission([ROW], kind="parquet"))) == []
    tolerances = [*TOLERANCES, ["standard", "wall_thickness", None, None, "IT7"]]
    materials = [*MATERIALS, ["20Cr2Ni4", 211, 0.3]]
    validated = validate(_submission([ROW], Tolerances=tolerances, Materials=materials))
    assert _told(validated) == []
    assert [row.grade for row in validated.classes["standard"]] == ["IT7"]
    assert set(validated.materials) == {"20cr2ni4"}


def test_a_class_beside_the_built_in_one():
    """Tolerances that hold other classes alone leave class standard built in."""
    tolerances = [*TOLERANCES, ["fine", "wall_thickness", None, None, "IT7"]]
    validated = validate(_submission([ROW], Tolerances=tolerances))
    assert {name: len(rows) for name, rows in validated.classes.items()} == {"fine": 1, "standard": 14}


def test_other_sources_are_read_with_a_unit_in_the_header():
    """A filled sheet Other sources is read; one that has no more than headers is not worth a word."""
    filled = [["Source", "Value"], ["bearing", 0.5]]
    validated = validate(_submission([ROW], **{"Other sources": filled}))
    assert [source.name for source in validated.other_sources] == ["bearing"]
    empty = validate(_submission([ROW], **{"Other sources": filled[:1]}))
    for one in (validated, empty):
        assert (_told(one), _kept(one)) == (_told(validate(_submission([ROW]))), ["A"])


def test_findings_stand_in_the_order_of_the_file(book):
    """Findings follow the file: its sheets in order, then rows, then columns, also beyond column Z."""
    extra = [f"Extra {number}" for number in range(1, 12)]
    rows = [
        [*KEYS, *extra],
        [(ROW | {"variant": "B", "wall_thickness_mm": "x", "torque_Nm": -1}).get(key) for key in KEYS],
        [(ROW | {"material": "none", "torque_Nm": 0}).get(key) for key in KEYS],
    ]
    settings = [["Setting", "Value"], ["seed", -1]]
    outcome = check(book({"Settings": settings, "Variants": rows, "Materials": [*MATERIALS, ["20Cr2Ni4", -1, 0.3]]}))
    assert outcome.exit_code == 4
    assert [found.place for found in outcome.findings if found.code != "I505"] == [
        "Settings!B2",
        *(f"Variants!A{letter}1" for letter in "CDEFGHIJKLM"),
        "Variants!D2",
        "Variants!H2",
        "Variants!C3",
        "Variants!D3",
        "Materials!B2",
    ]


def test_blank_rows_do_not_shift_addresses(book):
    """After blank rows, in the middle and at the end, every finding has the row number that Excel shows."""
    rows = [["Study"], [], KEYS, [], *([] for _ in range(60))]
    bad = [(ROW | {"torque_Nm": -5}).get(key) for key in KEYS]
    outcome = check(book({"Variants": [*rows, bad, [], [(ROW | {"variant": "B"}).get(key) for key in KEYS]]}))
    (found,) = [found for found in outcome.findings if found.level == "error"]
    assert (found.place, found.variant) == ("Variants!D65", "A")
    assert outcome.results["variant"].to_list() == ["A", "B"]
    assert outcome.results["status"].to_list() == ["error", "ok"]
    assert outcome.exit_code == 3


def test_one_bad_row_of_many(table, sound):
    """A file with three bad rows among fifty computes the others."""
    rows = [{**sound, "variant": f"V{number}"} for number in range(50)]
    for number, key in ((7, "torque_Nm"), (20, "wall_thickness_mm"), (49, "mean_radius_mm")):
        rows[number][key] = "?"
    outcome = check(table(rows))
    assert [found.place for found in outcome.findings] == ["Variants!D9", "Variants!G22", "Variants!F51"]
    assert outcome.counts == {
        "rows": 50,
        "computed": 47,
        "errors": 3,
        "warnings": 0,
        "meets": 0,
        "marginal": 0,
        "fails": 0,
    }
    assert outcome.exit_code == 3


def test_a_thousand_failures_keep_their_rows(table, sound):
    """A thousand bad cells are told at a thousand different addresses, each once."""
    rows = [{**sound, "variant": f"V{number}", "torque_Nm": -number} for number in range(1, 1001)]
    outcome = check(table(rows))
    assert [found.cell for found in outcome.findings] == [f"D{row}" for row in range(2, 1002)]
    assert {found.code for found in outcome.findings} == {"E207"}
    assert [found.value for found in outcome.findings[:2]] == ["-1", "-2"]


def _parquet(path, rows, **columns):
    frame = pl.DataFrame(rows, infer_schema_length=None)
    frame.with_columns(**columns).write_parquet(path)
    return path


def test_not_a_number_does_not_slip_through(tmp_path, sound):
    """Not-a-number and infinity are told at their cells and nothing is computed from them."""
    walls = [1.6, float("nan"), float("inf"), -float("inf"), None]
    rows = [{**sound, "variant": f"V{place}", "wall_thickness_mm": wall} for place, wall in enumerate(walls)]
    outcome = check(_parquet(tmp_path / "a.parquet", rows))
    assert [(found.code, found.cell) for found in outcome.findings] == [
        ("E212", "G3"),
        ("E212", "G4"),
        ("E212", "G5"),
        ("E201", "G6"),
    ]
    assert outcome.results["status"].to_list() == ["ok", "error", "error", "error", "error"]


def test_a_column_without_any_value(tmp_path, sound):
    """A column that is blank throughout, of whatever type, is blank, and required where it is required."""
    rows = [{**sound, "variant": f"V{number}"} for number in range(3)]
    outcome = check(_parquet(tmp_path / "a.parquet", rows, rim_length_mm=pl.lit(None), notes=pl.lit(None)))
    assert outcome.exit_code == 0
    outcome = check(_parquet(tmp_path / "b.parquet", rows, wall_thickness_mm=pl.lit(None)))
    assert [(found.code, found.cell) for found in outcome.findings] == [("E201", "G2"), ("E201", "G3"), ("E201", "G4")]


def test_whole_numbers_in_a_whole_column(tmp_path, sound):
    """A column stored as integers is computed like the same numbers with a point, bit for bit."""
    keys = ("torque_Nm", "cylinder_length_mm", "mean_radius_mm")
    whole = _parquet(tmp_path / "a.parquet", [sound], **{key: pl.col(key).cast(pl.Int32) for key in keys})
    assert check(whole).results.equals(check(_parquet(tmp_path / "b.parquet", [sound])).results)


def test_a_name_column_of_numbers(tmp_path, sound):
    """Variants named by whole numbers keep their names."""
    rows = [{**sound, "variant": number} for number in (101, 102)]
    assert check(_parquet(tmp_path / "a.parquet", rows)).results["variant"].to_list() == ["101", "102"]


def test_csv_and_parquet_agree(table, tmp_path, sound):
    """The same rows as CSV and as Parquet give the same numbers."""
    rows = [sound, {**sound, "variant": "B", "wall_thickness_mm": 1.7}]
    outcome = check(_parquet(tmp_path / "a.parquet", rows))
    assert check(table(rows)).results.equals(outcome.results)


def test_a_reference_to_a_bad_cell_is_not_judged_twice():
    """A material or class that is a date or an error is not also unknown."""
    row = ROW | {"material": True, "tolerance_class": False}
    assert _told(validate(_submission([row])), "error") == [("E204", "Variants!C2"), ("E204", "Variants!AA2")]


def test_defaults_without_a_settings_sheet():
    """Without Settings all settings have their defaults."""
    assert validate(_submission([ROW])).settings == Settings()


UNREADABLE = {"E107": b"a,b\n\x81,2\n", "E101": b"PAR1", "E102": b'a,b\n"x,2\n'}


@pytest.mark.parametrize("code", UNREADABLE)
@pytest.mark.parametrize("which", ["tolerances", "materials"])
def test_a_bad_table_beside_is_named_itself(which, code, table, sound, tmp_path):
    """A table given beside a submission that cannot be read is named itself, not the submission."""
    beside = tmp_path / f"{which}.csv"
    beside.write_bytes(UNREADABLE[code])
    (found,) = check(table([sound]), **{which: beside}).findings
    assert found.code == code
    assert found.message.startswith(f"{which}.csv ")


@pytest.mark.parametrize("kind", ["csv", "xlsx", "parquet"])
def test_tolerances_given_beside_any_submission(kind, table, book, tmp_path, sound):
    """A CSV file of tolerances beside a CSV, Parquet or workbook submission is read alike."""
    row = {**sound, "tolerance_class": "wide"}
    path = {
        "csv": lambda: table([row]),
        "xlsx": lambda: book({"Variants": [list(row), list(row.values())]}),
        "parquet": lambda: _parquet(tmp_path / "a.parquet", [row]),
    }[kind]()
    beside = tmp_path / "tolerances.csv"
    beside.write_text("tolerance_class,dimension,lower_deviation,upper_deviation\nwide,wall_thickness,-0.1,0.1\n")
    outcome = check(path, tolerances=beside)
    assert outcome.exit_code == 0
    assert set(outcome.computed[2].limits) == {"wall_thickness"}


MISSPELT = {
    "torque": ("torque_Nm", "Torqe T [N·m]"),
    "wall in furlongs": ("wall_thickness_mm", "Wall thickness Δ [furlong]"),
    "material": ("material", "Materal"),
}


@pytest.mark.parametrize("what", MISSPELT)
def test_a_blank_cell_under_a_bad_required_header(what):
    """A row that is blank under a misspelt required header is not computed, and nothing breaks."""
    key, header = MISSPELT[what]
    validated = validate(_submission([ROW, ROW | {"variant": "B", key: None}], headers=[(key, header)]))
    assert not validated.variants


def test_a_blank_name_under_a_bad_header():
    """A row that is blank under a misspelt Variant header is not computed nameless."""
    rows = [ROW, ROW | {"variant": None, "torque_Nm": 700}]
    assert validate(_submission(rows, headers=[("variant", "Variannt")])).variants.rows == []


def test_a_converted_value_is_told_as_entered():
    """A wall of -0.5 in is told as -0.5, the number that stands in the cell."""
    row = ROW | {"wall_thickness_mm": -0.5}
    validated = validate(_submission([row], headers=[("wall_thickness_mm", "Wall thickness Δ [in]")]))
    (found,) = [found for found in consolidated(validated) if found.code == "E207"]
    assert found.value == "-0.5"


def test_materials_without_names_are_one_cause():
    """A Materials sheet that lacks its Material column is told once, not once more by every variant."""
    materials = [["youngs_modulus_GPa", "poisson_ratio"], [211, 0.3]]
    assert _told(validate(_submission(_named(5), Materials=materials)), "error") == [("E111", "Materials!C1")]


def test_a_sheet_without_header_is_not_absent():
    """A Materials sheet whose header row is missing is told so, and not that the file brings no such sheet."""
    validated = validate(_submission([ROW], Materials=[["foo", "bar"], [1, 2]]))
    assert ("E109", "Materials!A1") in _told(validated)
    assert "sheet Materials" not in {found.value for found in consolidated(validated)}


def test_decimals_of_parquet_are_numbers(tmp_path, sound):
    """A column stored as decimals holds numbers."""
    path = _parquet(tmp_path / "a.parquet", [sound], wall_thickness_mm=pl.lit(decimal.Decimal("1.600")))
    assert check(path).exit_code == 0


def test_two_sheets_of_one_name(book):
    """Two sheets that both pass for Variants are not silently one."""
    row = list(ROW.values())
    outcome = check(book({"Variants": [list(ROW), row], "Vari ants": [list(ROW), ["Z", *row[1:]]]}))
    assert {found.code for found in outcome.findings} - {"I505"}


def test_a_row_that_is_not_computed_says_why(table, tmp_path, sound):
    """In the results every row that is not computed names a finding."""
    beside = tmp_path / "tolerances.csv"
    beside.write_text("tolerance_class,dimension,grade\nwide,wall_thickness,IT13\n")
    outcome = check(table([{**sound, "tolerance_class": "wide"}, {**sound, "variant": "B"}]), tolerances=beside)
    assert outcome.results["status"].to_list() == ["error", "ok"]
    assert outcome.results["findings"][0] is not None


@pytest.mark.parametrize("rows", [[], [[None, 211, 0.3]]], ids=["header alone", "row without name"])
def test_materials_without_rows(rows):
    """A Materials sheet that names no material leaves no variant, each of which is told so."""
    materials = [["Material", "youngs_modulus_GPa", "poisson_ratio"], *rows]
    validated = validate(_submission(_named(2), Materials=materials))
    assert not validated.variants
    assert {place for code, place in _told(validated) if code == "E307"} == {"Variants!C2", "Variants!C3"}


NASTY = [
    None, "", " ", "x", "1,6", "1.6", 0, -1, 1e300, 5e-324, math.inf, math.nan, True, ErrorCell("#REF!"), Unstored(),
    datetime.datetime(2026, 4, 1), datetime.time(1, 4), "a" * 2000, "{0}", "%", "=1+1", "\u202e", 1e-9,  # noqa: DTZ001
]  # fmt: skip
SOUND = {
    "Variants": [ROW, ROW | {"variant": "B", "mean_radius_mm": None, "bore_diameter_mm": 158.4, "notes": "x"}],
    "Materials": [
        {"material": "20Cr2Ni4", "youngs_modulus_GPa": 211, "poisson_ratio": 0.3, "yield_MPa": 900},
        {"material": "X", "shear_modulus_GPa": 80},
    ],
    "Tolerances": [
        {"tolerance_class": "standard", "dimension": "wall_thickness", "grade": "IT9"},
        {"tolerance_class": "fine", "dimension": "torque", "lower_deviation": -1, "upper_deviation": 1},
    ],
    "Settings": [{"setting": "seed", "value": 1}, {"setting": "method", "value": "line"}],
}


def _spoilt(draw):
    """Return a submission of which a few cells and headers hold something nasty."""
    sheets = {}
    for name, rows in SOUND.items():
        keys = list(columns_of(name))
        lines = [keys, *([row.get(key) for key in keys] for row in rows)]
        for _ in range(draw.integers(0, 3)):
            line, place = draw.integers(0 if draw.random() < 0.3 else 1, len(lines)), draw.integers(len(keys))
            lines[line][place] = (
                f"{keys[place]}s" if line == 0 and draw.random() < 0.5 else NASTY[draw.integers(len(NASTY))]
            )
        if name == "Variants" or draw.random() < 0.7:
            sheets[name] = _sheet(name, lines)
    return Submission(name="a.xlsx", sha256="", kind="workbook", sheets=sheets)


@pytest.mark.parametrize("seed", range(60))
def test_nasty_cells_never_end_in_an_exception(seed):
    """Whatever stands in a few cells or headers, each fault is a finding with an address, and the rest is computed."""
    validated = validate(_spoilt(np.random.default_rng(seed)))
    nominal = assess(validated, validated.settings)
    assert all(found.cell for found in consolidated(validated) if found.level == "error")
    assert {variant.row for variant in validated.variants} <= {row for row, *_ in validated.submitted}
    assert set(nominal.computed) == {variant.row for variant in validated.variants} - nominal.blocked.rows
    if not any(found.level == "error" for found in consolidated(validated)):
        assert len(nominal.computed) == len(validated.submitted) > 0


@pytest.mark.parametrize(
    ("entered", "told"),
    [
        (" 20cr2ni4 ", [("I504", " 20cr2ni4 ", "20Cr2Ni4")]),
        ("20Cr2Ni4 ", [("I504", "20Cr2Ni4 ", "20Cr2Ni4")]),
        (" unknown ", [("E307", "unknown", "")]),
    ],
)
def test_one_finding_per_name(entered, told):
    """A name in other case and with spaces is told once, as entered; an unknown one only as unknown."""
    findings = consolidated(validate(_submission([ROW | {"material": entered}])))
    found = [one for one in findings if one.sheet == "Variants"]
    assert [(one.code, one.value, one.suggestion) for one in found] == told
    assert all(f'"{value}"' in one.message for one, (_, value, _) in zip(found, told, strict=True))
