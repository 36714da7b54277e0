"""A filled old file moves into a new template and loses nothing without a word."""

from __future__ import annotations

import datetime
import io
import string
import zipfile

import openpyxl
import polars as pl
import pytest
import regenerate
import xlsxwriter
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from old_templates import LABELS, PLACES, old_workbook, put, rows_of

from flexlash.feedback.template import entry_rules
from flexlash.feedback.template.entry_rules import FIRST_ROW
from flexlash.feedback.template.template_workbook import Filling, study, template_bytes
from flexlash.feedback.template.upgrade import upgraded
from flexlash.pipeline import check
from flexlash.reading.raw import ErrorCell, Unstored
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.columns import SETTINGS, VARIANTS
from flexlash.validation.template_versions import TEMPLATE_VERSION

SOUND = {
    "variant": "A",
    "material": "20Cr2Ni4",
    "torque_Nm": 800.0,
    "cylinder_length_mm": 160.0,
    "mean_radius_mm": 80.0,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40.0,
    "tolerance_class": "standard",
}
FORMATS = "Colours, number formats, widths, filters and rules of your own are those of the new template."
moment = datetime.datetime.fromisoformat
NASTY = (
    None, "", " ", "x", "1,6", "1.6 mm", "1.6", "=1+1", "+1", "@x", "{=1}", "http://x.example", "_x000D_", "a\nb",
    " a ", "é" * 300, "x" * 32_767, 0, 1, -1, 0.1 + 0.2, 1 / 3, 1e300, 5e-324, 2**60, 1.6, True, False,
    moment("2026-04-01"), moment("1900-01-31"), moment("2026-04-01T13:30:15"),
    datetime.time(12, 30), datetime.timedelta(hours=30, minutes=1), ErrorCell("#REF!"), ErrorCell("#N/A"),
    ErrorCell("#SPILL!"), Unstored(),
)  # fmt: skip


@pytest.fixture(autouse=True)
def _here(monkeypatch):
    """Few prepared rows, for speed."""
    monkeypatch.setattr(entry_rules, "PREPARED_ROWS", 8)


def _moved(path):
    """Return the new template beside an old file, and what was said of it."""
    new = path.with_name(f"{path.stem}-new.xlsx")
    upgrade = upgraded(path)
    new.write_bytes(upgrade.data)
    return new, upgrade


def _saved(book, tmp_path):
    path = tmp_path / "old.xlsx"
    book.save(path)
    return path


def _told(outcome, lower=0):
    """Return the findings without their columns' letters, which an upgrade may move, and `lower` rows higher."""
    return sorted(
        (one.code, one.sheet, int(one.cell.lstrip(string.ascii_uppercase) or lower) - lower, one.column, one.variant)
        + (("", "") if one.code == "I509" else (one.value, one.suggestion))
        for one in outcome.findings
    )


def _assert_same(old, new, lower=0):
    """Assert that two files give the same findings and the same numbers."""
    before, after = check(old), check(new)
    assert _told(after, lower) == _told(before)
    numbers = [name for name in before.results.columns if name != "findings"]
    assert after.results.select(numbers).equals(before.results.select(numbers))


def _cells(path, sheet="Variants"):
    return openpyxl.load_workbook(path)[sheet]


@pytest.mark.parametrize("name", ["study", "needs_fixing", "catalogue_sizes", "calibrated"])
def test_a_template_of_this_version_moves_unchanged(tmp_path, name):
    """Rebuilt from its own values, each example is byte for byte the file that it was."""
    path = tmp_path / "now.xlsx"
    path.write_bytes(template_bytes(study() if name == "study" else getattr(regenerate, name)()))
    upgrade = upgraded(path)
    assert upgrade.data == path.read_bytes()
    assert (upgrade.version, upgrade.remarks) == (TEMPLATE_VERSION, (FORMATS,))


def test_an_empty_template_moves_unchanged(tmp_path):
    """Nothing filled in is nothing carried over."""
    path = tmp_path / "empty.xlsx"
    path.write_bytes(template_bytes())
    upgrade = upgraded(path)
    assert (upgrade.data, upgrade.rows) == (path.read_bytes(), 0)


def test_version_one_gains_its_columns_and_keeps_its_meaning(tmp_path):
    """A filled version 1 becomes one of today: own materials, classes, settings and faults stay."""
    rows = [{**SOUND, "variant": "A"}, {**SOUND, "variant": "B", "wall_thickness_mm": "1,6"}]
    rows += [{**SOUND, "variant": "C", "material": "mine", "tolerance_class": "fine"}]
    book = old_workbook(
        rows_of("Variants", rows),
        settings={"seed": 7, "coverage_percent": 90.0, "disk_calibration": "0,9"},
        materials=[
            {"material": "mine", "shear_modulus_GPa": 81.0},
            {"material": "20Cr2Ni4", "youngs_modulus_GPa": 1.0},
        ],
        tolerances=[{"tolerance_class": "fine", "dimension": "wall_thickness", "grade": "IT7"}],
    )
    old = _saved(book, tmp_path)
    new, upgrade = _moved(old)
    _assert_same(old, new)
    assert (upgrade.version, upgrade.rows, upgrade.remarks) == (1, 3, (FORMATS,))
    assert [cell.value for cell in _cells(new)[4]][: len(VARIANTS)] == [column.label for column in VARIANTS]
    settings_ = {row[0].value: row[1].value for row in _cells(new, "Settings")["A5:B15"]}
    assert settings_ == {column.key: column.default for column in SETTINGS} | {
        "seed": 7,
        "coverage_percent": 90,
        "disk_calibration": "0,9",
    }
    assert [row[0].value for row in _cells(new, "Materials")["A5:A7"]] == ["mine", "20Cr2Ni4", None]


@pytest.mark.parametrize("key", ["variant", "torque_Nm", "wall_thickness_mm", "notes", "material", "tolerance_class"])
@pytest.mark.parametrize("sheet", ["Variants"])
def test_every_kind_of_cell_stays_as_it_is(tmp_path, key, sheet):
    """Whatever a cell holds, faulty or not, the new file reads as the old one."""
    rows = [{**SOUND, "variant": f"row {number}", key: value} for number, value in enumerate(NASTY)]
    old = _saved(old_workbook(rows_of(sheet, rows)), tmp_path)
    _assert_same(old, _moved(old)[0])


_CELL = st.sampled_from(NASTY) | st.floats(-1e300, 1e300) | st.text("ab1,. %−±µ=", max_size=6)


@settings(max_examples=15, deadline=None, phases=(Phase.explicit, Phase.generate))
@given(
    rows=st.lists(st.dictionaries(st.sampled_from(list(PLACES["Variants"])), _CELL, max_size=4), max_size=6),
    gap=st.integers(0, 3),
)
def test_any_filling_gives_the_same_findings_and_numbers(tmp_path_factory, rows, gap):
    """Sound rows with a few cells replaced by anything, and gaps between them: the same findings, the same numbers."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(entry_rules, "PREPARED_ROWS", 8)
        filled = [{**SOUND, "variant": f"row {number}", **change} for number, change in enumerate(rows)]
        spread = [row for one in filled for row in (one, *[{}] * gap)]
        old = _saved(old_workbook(rows_of("Variants", spread)), tmp_path_factory.mktemp("any"))
        _assert_same(old, _moved(old)[0])


@pytest.mark.parametrize(
    ("key", "header"),
    [
        ("wall_thickness_mm", "Wall thickness Δ [in]"),
        ("wall_thickness_mm", "wall thickness"),
        ("torque_Nm", "Torque [lbf·in]"),
        ("torque_Nm", "Torque T [parsec]"),
        ("rim_length_mm", "Rim lenght [mm]"),
        ("wall_thickness_mm", "wall_thickness_mm"),
        ("notes", " NOTES "),
    ],
)
def test_headers_of_the_user_keep_their_unit(tmp_path, key, header):
    """A header with another unit, none, or a slip stays with its values; another spelling of ours becomes ours."""
    headers = [header if name == key else LABELS["Variants"][place] for name, place in PLACES["Variants"].items()]
    rows = [{**SOUND, key: 0.0625}, {**SOUND, "variant": "B"}]
    old = _saved(old_workbook(rows_of("Variants", rows), headers=headers), tmp_path)
    new, upgrade = _moved(old)
    _assert_same(old, new)
    kept = header not in {"wall_thickness_mm", " NOTES "}
    place = [column.key for column in VARIANTS].index(key)
    assert _cells(new).cell(4, place + 1).value == (header if kept else VARIANTS[place].label)
    assert any(f'"{header}"' in remark for remark in upgrade.remarks) == kept


def test_the_rule_of_a_cell_follows_the_unit_of_its_header(tmp_path):
    """Below a header in radians the rule allows 30° to 90° in radians."""
    filling = Filling(variants=[{**SOUND, "disk_cone_angle_deg": 1.2}])
    book = openpyxl.load_workbook(io.BytesIO(template_bytes(filling)))
    place = [column.key for column in VARIANTS].index("disk_cone_angle_deg") + 1
    book["Variants"].cell(4, place).value = "Disk cone angle [rad]"
    new, _ = _moved(_saved(book, tmp_path))
    letter = book["Variants"].cell(4, place).column_letter
    (rule,) = [one for one in _cells(new).data_validations.dataValidation if str(one.sqref).startswith(f"{letter}5:")]
    assert (float(rule.formula1), float(rule.formula2)) == pytest.approx((0.5235987756, 1.5707963268))
    assert rule.error == "Please enter an angle in rad from 0.523598775598299 to 1.5707963267949."


def test_columns_of_the_user_stand_behind_the_status(tmp_path):
    """Unknown, doubled and missing headers move with their values behind the template's columns, in their order."""
    headers = ["Project", *LABELS["Variants"], "Wall thickness Δ [mm]", None, "Row status", "Lead [d]"]
    rows = rows_of("Variants", [SOUND, {**SOUND, "variant": "B"}])
    rows = [
        ["P1", *rows[0], 1.7, "stray", "complete", 12],
        ["P2", *rows[1], None, None, None, moment("2026-04-01")],
    ]
    old = _saved(old_workbook(rows, headers=headers), tmp_path)
    new, _ = _moved(old)
    sheet, first = _cells(new), len(VARIANTS) + 2
    own = [[sheet.cell(row, first + place).value for place in range(5)] for row in (4, 5, 6)]
    assert own == [
        ["Project", "Wall thickness Δ [mm]", None, "Lead [d]", None],
        ["P1", 1.7, "stray", 12, None],
        ["P2", None, None, moment("2026-04-01"), None],
    ]
    _assert_same(old, new)


def test_settings_out_of_order_unknown_and_doubled(tmp_path):
    """Settings are found by name wherever they stand; rows that are none of ours stay below them, a note beside too."""
    book = old_workbook(rows_of("Variants", [SOUND]))
    sheet = book["Settings"]
    for row, values in enumerate(
        [
            ("disk_calibration", 0.9),
            ("Seed ", 3),
            ("colour", "red"),
            ("seed", 4),
            ("samples", None),
            ("method", "sobol"),
        ],
        start=5,
    ):
        for place, value in enumerate(values, start=1):
            sheet.cell(row, place).value = value
    sheet["A11"], sheet["B11"] = None, None
    sheet["D4"], sheet["D6"] = "Why", "agreed"
    old = _saved(book, tmp_path)
    new, _ = _moved(old)
    after = [[cell.value for cell in row] for row in _cells(new, "Settings")["A5:B17"]]
    assert after == [
        ["Seed ", 3], ["coverage_percent", 95], ["method", "sobol"], ["samples", None], ["lost_motion_percent", 4],
        ["cylinder_calibration", 1], ["disk_calibration", 0.9], ["acceptable_ppm", 1350],
        ["target_percent", 99.865], ["mean_shift_factor", 0.3], ["angle_unit", "arcmin"],
        ["colour", "red"], ["seed", 4],
    ]  # fmt: skip
    assert [_cells(new, "Settings")[cell].value for cell in ("D4", "D5", "D6")] == ["Why", "agreed", None]
    assert {one.code for one in check(old).findings} == {one.code for one in check(new).findings}


def test_more_rows_than_the_template_prepares(tmp_path):
    """Rows beyond the prepared ones, and a lone cell far below, move with rules and status at their distance."""
    rows = rows_of("Variants", [{**SOUND, "variant": f"row {number}"} for number in range(20)])
    book = old_workbook(rows)
    book["Variants"]["B3000"] = "stray"
    old = _saved(book, tmp_path)
    new, _ = _moved(old)
    _assert_same(old, new)
    sheet = _cells(new)
    assert sheet["B3000"].value == "stray"
    status = openpyxl.load_workbook(new, data_only=True)["Variants"]
    assert status.cell(24, len(VARIANTS) + 1).value == "complete"
    rules = {str(one.sqref) for one in sheet.data_validations.dataValidation}
    assert "A5:A3000" in rules


def test_more_materials_and_classes_than_prepared(tmp_path):
    """Six hundred own materials stay in the list of the drop-down."""
    materials = [{"material": f"steel {number}", "shear_modulus_GPa": 80.0} for number in range(600)]
    old = _saved(old_workbook(rows_of("Variants", [{**SOUND, "material": "steel 599"}]), materials=materials), tmp_path)
    new, _ = _moved(old)
    _assert_same(old, new)
    name = openpyxl.load_workbook(new).defined_names["fl_materials"].attr_text
    assert name == "Materials!$A$5:INDEX(Materials!$A$5:$A$604,MAX(1,COUNTA(Materials!$A$5:$A$604)))"


def _crowded(path):
    """Write an old template with everything that no cell holds."""
    book = xlsxwriter.Workbook(path)
    sheet = book.add_worksheet("Variants")
    sheet.write_row(3, 0, LABELS["Variants"])
    sheet.write_row(4, 0, rows_of("Variants", [SOUND])[0])
    for row, name in ((5, "B"), (6, "C")):
        sheet.write_row(row, 0, rows_of("Variants", [{**SOUND, "variant": name}])[0])
    wall, torque = PLACES["Variants"]["wall_thickness_mm"], PLACES["Variants"]["torque_Nm"]
    sheet.write_formula(4, wall, "=0.8*2", None, 1.6)
    sheet.write_formula(5, wall, "=H5", None, 1.6)
    sheet.write_formula(6, torque, "=D5*1", None, "")
    sheet.write_formula(6, PLACES["Variants"]["notes"], '=IF(1>2,"x","")', None, "")
    sheet.write(0, 3, "checked by Jo")
    sheet.write(1, 9, "3 of 3 rows complete")
    sheet.write_comment(3, 0, "the template's own")
    sheet.write_comment(5, 3, "ask Jo")
    sheet.set_row(6, None, None, {"hidden": True})
    sheet.insert_textbox(10, 3, "remember")
    chart = book.add_chart({"type": "line"})
    chart.add_series({"values": "=Variants!$D$5:$D$7"})
    sheet.insert_chart(12, 3, chart)
    drawings = book.add_worksheet("Drawings")
    drawings.write(0, 0, "x")
    book.add_worksheet("Lists")
    book.close()
    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    first = "xl/worksheets/sheet1.xml"
    parts[first] = parts[first].replace(b'<c r="T7"><f>', b'<c r="T7" t="str"><f>')
    assert b't="str"' in parts[first]
    with zipfile.ZipFile(path, "w") as archive:
        for name, part in parts.items():
            archive.writestr(name, part)


def test_what_cannot_move_is_said(tmp_path):
    """Formulas, notes, other sheets, charts, texts above the header and hidden rows are named, each with its place."""
    old = tmp_path / "crowded.xlsx"
    _crowded(old)
    new, upgrade = _moved(old)
    assert upgrade.remarks == (
        "Variants!H6: formulas became the values that they showed.",
        "Variants!D7: formulas that never stored a result show #N/A until you enter their values.",
        "Variants!T7: formulas that showed nothing were left behind.",
        "Variants!D6: notes were left behind.",
        "Variants!D1: what stands above the header row was left behind.",
        "Variants!A7: hidden rows are shown.",
        "The sheet Drawings with 1 row was left behind.",
        "Left behind: 1 chart, 1 text box or shape.",
        FORMATS,
    )
    sheet = _cells(new)
    assert [sheet[cell].value for cell in ("H5", "H6", "D7")] == ["=0.8*2", 1.6, "=NA()"]
    codes = [(one.code, one.cell) for one in check(new).findings if one.level == "error"]
    assert codes == [("E206", "D7")]


def test_a_formula_without_a_result_never_becomes_a_number(tmp_path):
    """Recalculated, what stands for a lost formula is an error, never a value that nobody entered."""
    rows = [{**SOUND, "torque_Nm": Unstored()}]
    new, _ = _moved(_saved(old_workbook(rows_of("Variants", rows)), tmp_path))
    assert _cells(new)["D5"].value == "=NA()"


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_a_table_moves_into_the_template(tmp_path, table, ending):
    """A table of variants becomes a filled template: its number texts as numbers, faulty ones as they are."""
    rows = [
        {**SOUND, "torque_Nm": "8e2", "wall_thickness_mm": "1.6", "size": "007"},
        {**SOUND, "variant": "B", "wall_thickness_mm": "thin", "size": "1"},
    ]
    old = table(rows)
    if ending == "parquet":
        old = tmp_path / "table.parquet"
        pl.DataFrame([{**SOUND, "size": "007", "day": datetime.date(1850, 1, 1)}]).write_parquet(old)
    new, upgrade = _moved(old)
    sheet = _cells(new)
    assert [sheet["D5"].value, sheet["H5"].value] == [800, 1.6]
    assert sheet.cell(5, len(VARIANTS) + 2).value == "007"
    _assert_same(old, new, lower=3)
    assert upgrade.version is None
    if ending == "parquet":
        assert upgrade.remarks == ("Variants!J2: what no cell can hold became a text, or was cut to a cell's length.",)


def test_a_visible_version_is_enough(tmp_path):
    """Where the document property was lost, the visible cell still tells the version."""
    book = old_workbook(rows_of("Variants", [SOUND]), version=None)
    book["Variants"]["J1"] = "Template version 1"
    old = _saved(book, tmp_path)
    assert upgraded(old).version == 1
    assert not check(old).findings


def _write(path, data):
    path.write_bytes(data)
    return path


def _newer(path):
    old_workbook(rows_of("Variants", [SOUND]), version=TEMPLATE_VERSION + 1).save(path)


def _without_header(path):
    book = old_workbook([])
    book["Variants"].delete_rows(4)
    book.save(path)


def _report(path):
    book = old_workbook(rows_of("Variants", [SOUND]))
    book.custom_doc_props.props[0].value = "report"
    book.save(path)


@pytest.mark.parametrize(
    ("make", "code"),
    [
        (_newer, "E116"),
        (_without_header, "E109"),
        (_report, "E101"),
        (lambda path: _write(path, b"PK\x03\x04 damaged"), "E102"),
        (lambda path: _write(path, b"%PDF-1.4"), "E101"),
        (lambda path: openpyxl.Workbook().save(path), "E108"),
    ],
)
def test_what_is_no_template_is_refused(tmp_path, make, code):
    """A newer template, a report, a damaged file or anything else is refused by its code."""
    path = tmp_path / "old.xlsx"
    make(path)
    with pytest.raises(Refusal) as caught:
        upgraded(path)
    assert caught.value.code == code


def test_limits_hold_for_tables_as_well(table):
    """A table with more columns or rows than a template may have is refused, not cut."""
    path = table([SOUND, {**SOUND, "variant": "B"}])
    for limits in ({"rows": 2}, {"columns": 7}):
        with pytest.raises(Refusal) as caught:
            upgraded(path, ReadingLimits.of(limits))
        assert caught.value.code == "E110"


def test_a_side_sheet_without_headers_is_said(tmp_path):
    """A Materials sheet that nobody can read is named; the built-in materials stand in the new file."""
    book = old_workbook(rows_of("Variants", [SOUND]))
    book["Materials"].delete_rows(4)
    _, upgrade = _moved(_saved(book, tmp_path))
    assert upgrade.remarks[0].startswith("Materials: ")
    assert upgrade.remarks[0].endswith("rows have no header row above them and were left behind.")


def test_a_misspelt_side_sheet_takes_its_place(tmp_path):
    """A sheet that was meant to be Materials becomes Materials, which is said."""
    materials = [{"material": "20Cr2Ni4", "shear_modulus_GPa": 50.0}]
    book = old_workbook(rows_of("Variants", [SOUND]), materials=materials)
    book["Materials"].title = "Materialls"
    new, upgrade = _moved(_saved(book, tmp_path))
    assert upgrade.remarks == ("The sheet Materialls was taken as Materials.", FORMATS)
    assert check(new).validated.materials["20cr2ni4"].constants["shear_modulus"] == 50e9


def test_rows_start_where_the_template_begins(tmp_path):
    """Whatever row the old header stood in, the rows keep their distance from it."""
    path = tmp_path / "plain.xlsx"
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "variants "
    for row, values in ((1, LABELS["Variants"]), (2, rows_of("Variants", [SOUND])[0]), (5, ["lone"])):
        for place, value in enumerate(values, start=1):
            put(sheet.cell(row, place), value)
    book.save(path)
    new, _ = _moved(path)
    assert [_cells(new).cell(FIRST_ROW + 1 + row, 1).value for row in range(4)] == ["A", None, None, "lone"]
