"""Other sources, Levers and Sweep in templates, upgrades, marked copies and fixed files."""

from __future__ import annotations

import io

import openpyxl
import pytest
from decided_drives import LEVERS, SOURCES, SWEEPS, drive
from old_templates import old_workbook, rows_of

from flexlash.feedback.annotation.appearance import COLOURS
from flexlash.feedback.template import entry_rules
from flexlash.feedback.template.entry_rules import FIRST_ROW, HEADER_ROW
from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.feedback.template.upgrade import upgraded
from flexlash.pipeline import check, fix
from flexlash.schema.columns import ENTRY_SHEETS, columns_of
from flexlash.validation.decision_sheets import DECISION_SHEETS

FIRST = FIRST_ROW + 1
FAULTY = drive(
    other_sources=[
        {**SOURCES[0], "value_arcmin": "0,012 mm", "radius_mm": None},
        {**SOURCES[1], "enter_as": "mm radail play"},
        {**SOURCES[2], "side": "Input", "ratio": "100:1", "value_arcmin": "600 arcsec"},
    ],
    levers=[{**LEVERS[0], "lowest": 230.0}, {**LEVERS[1], "step": "20 µm", "may_change": "yess"}],
    sweep=[{**SWEEPS[0], "variant": "case3 ", "to": "0,2 m"}, {**SWEEPS[1], "second_dimension": "disk inner radius"}],
)
FAULTS = {
    ("Other sources", "value_arcmin", 0): ("E202", 0.012),
    ("Other sources", "radius_mm", 0): ("E201", None),
    ("Other sources", "enter_as", 1): ("E209", "mm radial play"),
    ("Other sources", "ratio", 2): ("E202", None),
    ("Other sources", "value_arcmin", 2): ("E202", 10.0),
    ("Levers", "lowest", 0): ("E365", None),
    ("Levers", "step", 1): ("E202", 0.02),
    ("Levers", "may_change", 1): ("E209", "yes"),
    ("Sweep", "to", 0): ("E202", 200.0),
}
"""What is told of the faulty rows, by sheet, column and row, and what can only be meant."""

REPAIRED = {
    ("Other sources", "side", 2): "input",
    ("Sweep", "variant", 0): "case 3",
    ("Sweep", "second_dimension", 1): "disk_inner_radius",
}


@pytest.fixture(autouse=True)
def _few_rows(monkeypatch):
    """Few prepared rows, for speed."""
    monkeypatch.setattr(entry_rules, "PREPARED_ROWS", 8)
    monkeypatch.setattr(entry_rules, "SIDE_ROWS", 8)


@pytest.fixture
def faulty(tmp_path):
    """Return a submission with faults on the three sheets."""
    path = tmp_path / "faulty.xlsx"
    path.write_bytes(template_bytes(FAULTY))
    return path


def _cell(sheet, key, row):
    index = list(columns_of(sheet)).index(key) + 1
    return f"{openpyxl.utils.get_column_letter(index)}{FIRST + row}"


def _column(data, sheet, label):
    cells = openpyxl.load_workbook(io.BytesIO(data), data_only=True)[sheet]
    place = [cell.value for cell in cells[HEADER_ROW + 1]].index(label) + 1
    return [cells.cell(row, place).value for row in range(FIRST, cells.max_row + 1)]


def test_a_sound_drive_is_complete_and_sound(tmp_path):
    """The status of every row is complete, and check finds no error in the three sheets."""
    path = tmp_path / "drive.xlsx"
    path.write_bytes(template_bytes(drive()))
    for sheet in DECISION_SHEETS:
        assert {*_column(path.read_bytes(), sheet, "Row status")} - {"", None} == {"complete"}
    assert [one.code for one in check(path).findings] == ["W423"]


@pytest.mark.slow
def test_a_template_with_the_sheets_moves_unchanged(tmp_path):
    """Upgraded, a template keeps the sheets without being asked, to the byte."""
    for name, filling in {"drive": drive(), "faulty": FAULTY, "empty": Filling(optional=["Sweep"])}.items():
        path = tmp_path / f"{name}.xlsx"
        path.write_bytes(template_bytes(filling))
        assert upgraded(path).data == path.read_bytes()


@pytest.mark.parametrize("version", [1, 4, 5])
def test_an_old_template_with_a_budget_of_its_own_keeps_it(tmp_path, version):
    """A file of an older version whose sheet Other sources was filled by hand keeps every row and its own column."""
    book = old_workbook(rows_of("Variants", [{"variant": "A", "torque_Nm": 800.0}]), version=version)
    sheet = book.create_sheet("other sources")
    for row in (["Source", "Enter as", "Value", "Supplier"], ["bearing", "arcmin", 0.4, "S2"], ["key", None, "0,2"]):
        sheet.append(row)
    path = tmp_path / "old.xlsx"
    book.save(path)
    upgrade = upgraded(path, optional=["Levers"])
    names = openpyxl.load_workbook(io.BytesIO(upgrade.data)).sheetnames
    assert names == [
        "Variants",
        "Sketch",
        "Materials",
        "Tolerances",
        "Settings",
        "Other sources",
        "Levers",
        "Dictionary",
        "Lists",
    ]
    assert _column(upgrade.data, "Other sources", "Source")[:2] == ["bearing", "key"]
    assert _column(upgrade.data, "Other sources", "Value")[:2] == [0.4, "0,2"]
    assert _column(upgrade.data, "Other sources", "Supplier")[:2] == ["S2", None]
    assert _column(upgrade.data, "Settings", "Value")[-3:] == [99.865, 0.3, "arcmin"]


def test_the_marked_copy_marks_them(faulty, tmp_path):
    """Each fault is found, and coloured at its cell with a note."""
    outcome = check(faulty, marked_copy=tmp_path / "marked.xlsx")
    found = {(one.sheet, one.cell): one.code for one in outcome.findings if one.level == "error"}
    assert found == {(sheet, _cell(sheet, key, row)): code for (sheet, key, row), (code, _) in FAULTS.items()}
    marked = openpyxl.load_workbook(outcome.written.marked_copy)
    for (sheet, cell), code in found.items():
        assert marked[sheet][cell].fill.fgColor.rgb == COLOURS["error"], (sheet, cell)
        assert code in marked[sheet][cell].comment.text
    assert outcome.exit_code == 3


@pytest.mark.slow
def test_certain_fixes_fix_them(faulty, tmp_path):
    """What can only be one slip is fixed, in the unit of its row; what a person must decide stays."""
    _, fixes = fix(faulty, tmp_path / "fixed.xlsx")
    certain = {place: value for place, (_, value) in FAULTS.items() if value is not None} | REPAIRED
    assert {(one.sheet, one.cell): one.value for one in fixes} == {
        (sheet, _cell(sheet, key, row)): value for (sheet, key, row), value in certain.items()
    }
    left = {(one.sheet, one.cell) for one in check(tmp_path / "fixed.xlsx").findings if one.level == "error"}
    open_to = {place for place, (_, value) in FAULTS.items() if value is None}
    assert left == {(sheet, _cell(sheet, key, row)) for sheet, key, row in open_to}


def test_every_sheet_has_its_columns_in_the_dictionary():
    """The dictionary of a template with the sheets explains each of their columns."""
    book = openpyxl.load_workbook(io.BytesIO(template_bytes(drive())))
    explained = {(row[0].value, row[2].value) for row in book["Dictionary"].iter_rows(min_row=2)}
    for sheet in DECISION_SHEETS:
        assert {(sheet, column.key) for column in ENTRY_SHEETS[sheet]} <= explained
