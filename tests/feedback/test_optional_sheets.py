"""Measurements and Correlations in templates, upgrades, marked copies and fixed files."""

from __future__ import annotations

import io
import statistics

import openpyxl
import pytest
from made_up_parts import DISK, FAULTS, PARTS, SAMPLE, WALL, faulty_parts, measured_parts
from old_templates import old_workbook, rows_of

from flexlash.feedback.annotation.appearance import COLOURS
from flexlash.feedback.template import entry_rules
from flexlash.feedback.template.entry_rules import FIRST_ROW, HEADER_ROW
from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.feedback.template.upgrade import upgraded
from flexlash.pipeline import check, fix
from flexlash.schema.columns import ENTRY_SHEETS, OPTIONAL_SHEETS
from flexlash.schema.spellings import plain

_PLAIN = [name for name in ENTRY_SHEETS if name not in OPTIONAL_SHEETS]
_MEASURED = [*_PLAIN, "Measurements", "Correlations"]


def _with_ours(entry_sheets):
    """Return the sheets of a template with these entry sheets."""
    first, *others = entry_sheets
    return [first, "Sketch", *others, "Dictionary", "Lists"]


@pytest.fixture(autouse=True)
def _here(monkeypatch):
    """Few prepared rows, for speed."""
    monkeypatch.setattr(entry_rules, "PREPARED_ROWS", 8)
    monkeypatch.setattr(entry_rules, "SIDE_ROWS", 8)


def _written(tmp_path, filling, name="submission.xlsx"):
    path = tmp_path / name
    path.write_bytes(template_bytes(filling))
    return path


def _sheets(data):
    return openpyxl.load_workbook(io.BytesIO(data)).sheetnames


def _column(data, sheet, label):
    """Return the entries below a header."""
    cells = openpyxl.load_workbook(io.BytesIO(data), data_only=True)[sheet]
    place = [cell.value for cell in cells[HEADER_ROW + 1]].index(label) + 1
    return [cells.cell(row, place).value for row in range(FIRST_ROW + 1, cells.max_row + 1)]


def test_the_example_has_the_moments_that_it_says(tmp_path):
    """Walls and disks of the sixty made-up parts have exactly the mean and standard deviation, and the tie, told."""
    path = _written(tmp_path, measured_parts())
    measured = check(path).validated.measured[plain(SAMPLE)]
    walls, disks = (measured[name].values for name in ("wall_thickness", "disk_thickness"))
    for values, (mean, sd) in ((walls, WALL), (disks, DISK)):
        assert len(values) == PARTS
        assert statistics.fmean(values) == pytest.approx(mean / 1000, rel=1e-12)
        assert statistics.stdev(values) == pytest.approx(sd / 1000, rel=1e-9)
    assert statistics.correlation(walls, disks) == pytest.approx(0.6, abs=0.005)


def test_every_row_of_the_example_is_complete(tmp_path):
    """No status of the example says that something is missing, and check finds neither error nor warning in it."""
    path = _written(tmp_path, measured_parts())
    for sheet in ("Variants", "Tolerances", "Correlations"):
        assert {*_column(path.read_bytes(), sheet, "Row status")} - {"", None} == {"complete"}, sheet
    assert [finding.code for finding in check(path).findings if finding.level != "info"] == []


@pytest.mark.parametrize("filling", [measured_parts(), faulty_parts(), Filling(optional=["Correlations"])])
def test_a_template_with_optional_sheets_moves_unchanged(tmp_path, filling):
    """Upgraded, a template keeps its optional sheets without being asked, to the byte."""
    path = _written(tmp_path, filling)
    assert upgraded(path).data == path.read_bytes()


def test_an_upgrade_adds_what_is_asked_for(tmp_path):
    """An older template gains the sheets named beside the upgrade, one with such a sheet keeps it as well."""
    old = tmp_path / "old.xlsx"
    old_workbook(rows_of("Variants", [{"variant": "A"}])).save(old)
    assert _sheets(upgraded(old).data) == _with_ours(_PLAIN)
    both = upgraded(old, optional=OPTIONAL_SHEETS).data
    assert _sheets(both) == _with_ours(ENTRY_SHEETS)
    some = _written(tmp_path, Filling(optional=["Correlations"]), "some.xlsx")
    assert _sheets(upgraded(some, optional=["Measurements"]).data) == _with_ours(_MEASURED)


@pytest.mark.parametrize("version", [1, 2, 3])
def test_an_old_template_with_sheets_of_measurements_keeps_them(tmp_path, version):
    """A file of any older version to which the sheets were added by hand keeps every row, and its own column."""
    book = old_workbook(rows_of("Variants", [{"variant": "A", "torque_Nm": 800.0}]), version=version)
    measured, tied = book.create_sheet("measurements"), book.create_sheet("Correlations")
    for row in (["Sample", "Wall thickness [in]", "Gauge"], ["lot 7", 0.0631, "G2"], [], ["lot 7", "0,0632", None]):
        measured.append(row)
    for row in (["Class", "first"], ["tolerance_class", "dimension_1", "dimension_2", "correlation"]):
        tied.append(row)
    tied.append(["standard", "wall_thickness", "rim_thickness", 0.4])
    hint = "One row per class and dimension: a grade, or lower and upper deviation. No row: exact."
    book["Tolerances"]["A2"] = hint
    path = tmp_path / "old.xlsx"
    book.save(path)
    upgrade = upgraded(path)
    assert upgrade.version == version
    assert _sheets(upgrade.data) == _with_ours(_MEASURED)
    assert _column(upgrade.data, "Measurements", "Sample")[:3] == ["lot 7", None, "lot 7"]
    assert _column(upgrade.data, "Measurements", "Wall thickness [in]")[:3] == [0.0631, None, "0,0632"]
    assert _column(upgrade.data, "Measurements", "Gauge")[:3] == ["G2", None, None]
    assert _column(upgrade.data, "Correlations", "Correlation")[0] == 0.4
    assert _column(upgrade.data, "Correlations", "Row status")[0] == "complete"
    said = " ".join(upgrade.remarks)
    assert "Wall thickness [in]" in said
    assert "Correlations!A1" in said
    assert "Tolerances!A2" not in said


def test_the_marked_copy_marks_the_new_sheets(tmp_path):
    """Each fault on Tolerances, Measurements and Correlations is found, and coloured at its cell with a note."""
    path = _written(tmp_path, faulty_parts())
    outcome = check(path, marked_copy=tmp_path / "marked.xlsx")
    found = {(one.sheet, one.cell): one.code for one in outcome.findings if one.level == "error"}
    assert found == FAULTS
    marked = openpyxl.load_workbook(outcome.written.marked_copy)
    for sheet, cell in FAULTS:
        assert marked[sheet][cell].fill.fgColor.rgb == COLOURS["error"], (sheet, cell)
        assert FAULTS[sheet, cell] in marked[sheet][cell].comment.text
    assert marked.sheetnames == ["Findings", *_with_ours(_MEASURED), "flexlash marks"]


def test_certain_fixes_fix_the_new_sheets(tmp_path):
    """What can only be one slip is fixed on the new sheets; what a person must decide stays."""
    path = _written(tmp_path, faulty_parts())
    _, fixes = fix(path, tmp_path / "fixed.xlsx")
    assert {(one.sheet, one.cell): one.value for one in fixes} == {
        ("Measurements", "H8"): 1.60712,
        ("Tolerances", "K20"): 1.33,
        ("Tolerances", "N21"): "parts",
        ("Tolerances", "O19"): "standard",
        ("Tolerances", "M23"): SAMPLE,
        ("Correlations", "C5"): "disk_thickness",
        ("Correlations", "D5"): 0.5,
        ("Correlations", "A6"): "measured",
    }
    book = openpyxl.load_workbook(tmp_path / "fixed.xlsx")
    assert all(book[one.sheet][one.cell].value == one.value for one in fixes)
    left = {(one.sheet, one.cell) for one in check(tmp_path / "fixed.xlsx").findings if one.level == "error"}
    assert left == {("Measurements", "A16"), ("Measurements", "C14"), ("Tolerances", "M24")}
