"""What users of other template systems complain of, each complaint a test."""

import re

import openpyxl
import pytest

from flexlash.analysis.run_summary import finding_lines, summary_lines
from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.pipeline import check, run

SOUND = {
    "variant": "A",
    "material": "20Cr2Ni4",
    "torque_Nm": 800.0,
    "cylinder_length_mm": 160.0,
    "mean_radius_mm": 80.0,
    "wall_thickness_mm": 1.6,
    "disk_inner_radius_mm": 40.0,
}
ROWS = [
    SOUND,
    {},
    {**SOUND, "variant": "B", "wall_thickness_mm": "1,6"},
    {},
    {},
    {**SOUND, "variant": "C", "torque_Nm": None},
    {**SOUND, "variant": "D"},
    {**SOUND, "variant": "d"},
    {**SOUND, "variant": "E", "material": "20Cr2Ni5"},
    {**SOUND, "variant": "F", "disk_inner_radius_mm": 78.0},
    *({**SOUND, "variant": f"G{number}", "cylinder_length_mm": -1.0} for number in range(20)),
    *({**SOUND, "variant": f"H{number}"} for number in range(30)),
]
"""Rows of a submission; the first stands in row 5, and rows 6, 8 and 9 are blank."""


@pytest.fixture(scope="module")
def answered(tmp_path_factory):
    """Return outcome, report and marked copy of a submission that has all kinds of faults."""
    folder = tmp_path_factory.mktemp("complaints")
    path = folder / "mine.xlsx"
    path.write_bytes(template_bytes(Filling(variants=ROWS)))
    book = openpyxl.load_workbook(path)
    book["Variants"]["F150"] = " "
    book["Variants"]["F151"] = "x"
    book.save(path)
    outcome = run(path, folder / "report.xlsx", samples=16, marked_copy=folder / "copy.xlsx")
    return outcome, openpyxl.load_workbook(folder / "report.xlsx"), openpyxl.load_workbook(folder / "copy.xlsx")


def _places(answered, code):
    return [found.cell for found in answered[0].findings if found.code == code]


@pytest.mark.slow
def test_wrong_row_number_after_a_blank_row(answered):
    """Rows are counted as Excel counts them, blank rows included."""
    assert _places(answered, "E202") == ["H7"]
    assert _places(answered, "E201") == ["D10"]


def test_sheet_name_missing_from_the_error(answered):
    """Every message about a cell names its sheet, and the cell by its letters."""
    for found in answered[0].findings:
        assert not found.cell or found.message.startswith(f"{found.sheet}!{found.cell}"), found.message
        assert re.fullmatch(r"[A-Z]+[1-9]\d*", found.cell), found


def test_only_one_of_two_duplicates_marked(answered):
    """All rows of a doubled name are told and marked, each with its partner."""
    doubled = [found for found in answered[0].findings if found.code == "E308"]
    assert [(found.cell, "A12" in found.message, "A11" in found.message) for found in doubled] == [
        ("A11", True, True),
        ("A12", True, True),
    ]


def test_a_whole_row_painted_for_one_cell(answered):
    """In the marked copy only the guilty cell of a row is coloured."""
    sheet = answered[2]["Variants"]
    own = sheet["H5"].fill.fgColor.rgb
    assert sheet["H7"].fill.fgColor.rgb != own
    for cell in sheet[7]:
        if cell.coordinate != "H7" and cell.column_letter not in "ACDEHW":
            assert cell.fill.fgColor.rgb == sheet.cell(5, cell.column).fill.fgColor.rgb, cell.coordinate


def _every_finding(book):
    """Return the rows of a Findings sheet that tell one finding each; a report's list by rule stands above them."""
    rows = list(book["Findings"].iter_rows(values_only=True))
    return (
        rows[[row[0] for row in rows].index("Every finding") :] if any(r[0] == "Every finding" for r in rows) else rows
    )


def test_the_same_error_many_times(answered):
    """Equal errors stand on the terminal once, with their range and count; the full list is in the report."""
    lines = [line for _, line in finding_lines(answered[0].findings)]
    (group,) = [line for line in lines if "E207" in line]
    assert "20 cells" in group
    assert "E15:E34" in group
    assert sum("cylinder length" in line.lower() and "-1" in line for line in lines) <= 5
    told = [row for row in _every_finding(answered[1]) if "E207" in row]
    assert len(told) == 20


def test_one_cause_reported_twice(answered):
    """No cell has two errors."""
    cells = [found.place for found in answered[0].findings if found.level == "error"]
    assert len(cells) == len(set(cells))


def test_no_jump_to_the_bad_cell(answered):
    """Findings of report and marked copy link to the cell."""
    for book, title in ((answered[1], "Submission"), (answered[2], "Variants")):
        links = [cell.hyperlink.location for row in book["Findings"] for cell in row if cell.hyperlink]
        assert any(re.fullmatch(rf"'?{title}'?!H7", location) for location in links), title


def test_an_error_without_a_home_cell(answered):
    """Every error of a readable submission has a cell."""
    assert all(found.cell for found in answered[0].findings if found.level == "error")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "code", "suggestion"),
    [
        (lambda book: book["Variants"].__setitem__("E4", "Cylinder lenght l [mm]"), "E112", "Cylinder length l [mm]"),
        (lambda book: book["Materials"].__setitem__("B4", "Youngs modulos [GPa]"), "E112", "Young's modulus E [GPa]"),
    ],
)
def test_misspelt_without_a_did_you_mean(change, code, suggestion, tmp_path):
    """A misspelt header is told with what was probably meant."""
    path = tmp_path / "a.xlsx"
    path.write_bytes(template_bytes(Filling(variants=[SOUND])))
    book = openpyxl.load_workbook(path)
    change(book)
    book.save(path)
    (found,) = [found for found in check(path).findings if found.code == code]
    assert found.suggestion == suggestion


@pytest.mark.slow
@pytest.mark.parametrize("length", [4, 500, 5000])
def test_an_empty_message_for_a_damaged_file(length, tmp_path):
    """A damaged file is told in a full sentence with a fix."""
    path = tmp_path / "a.xlsx"
    path.write_bytes(template_bytes()[:length])
    (found,) = check(path).findings
    assert found.message == "a.xlsx is damaged: a part of it is missing, altered or out of order."
    assert found.fix


def test_a_workbook_that_only_works_after_saving_again(tmp_path):
    """A formula without a stored result is told as such, with what to do, and stops only its own row."""
    path = tmp_path / "a.xlsx"
    path.write_bytes(template_bytes(Filling(variants=[SOUND, {**SOUND, "variant": "B"}])))
    book = openpyxl.load_workbook(path)
    book["Variants"]["H6"] = "=0.8*2"
    book.save(path)
    outcome = check(path)
    (found,) = [found for found in outcome.findings if found.level == "error"]
    assert (found.code, found.cell) == ("E206", "H6")
    assert "Open the file in Excel" in found.fix
    assert outcome.counts["computed"] == 1


def test_a_stray_character_far_below(answered):
    """White space far below is nothing; a lone character there is a warning with its address and blocks nothing."""
    assert _places(answered, "W408") == ["F151"]
    assert answered[0].counts["computed"] == 32


def test_warnings_mixed_with_errors(answered):
    """Terminal, report and marked copy tell errors first, then warnings."""
    levels = [level for level, _ in finding_lines(answered[0].findings) if level]
    assert levels == sorted(levels, key=["error", "warning", "info"].index)
    assert {"error", "warning"} <= set(levels)
    for book in answered[1:]:
        column = [value for row in _every_finding(book) for value in row[:1]]
        told = [value for value in column if value in {"error", "warning", "info"}]
        assert told == sorted(told, key=["error", "warning", "info"].index)
        assert set(told) == set(levels)


def test_no_suggested_repair(answered):
    """What can be guessed is suggested, at its own finding."""
    suggested = {found.cell: found.suggestion for found in answered[0].findings if found.suggestion}
    assert suggested["H7"] == "1.6"
    assert suggested["C13"] == "20Cr2Ni4"


def test_the_whole_file_refused_for_a_few_bad_rows(answered):
    """Sound rows are computed whatever is wrong with others, and the last lines count both."""
    outcome = answered[0]
    assert outcome.exit_code == 3
    assert outcome.results["backlash_rad"].drop_nulls().len() == outcome.counts["computed"] == 32
    first = next(iter(summary_lines(outcome, "mine.xlsx", ran=True)))
    assert first.startswith("mine.xlsx: 32 of 57 rows computed; 25 cells to fix; ")
