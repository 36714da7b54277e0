"""What was recognised of a delimited text is told: once, by the file's name, with an example at its cell."""

from __future__ import annotations

import pytest

from flexlash.pipeline import check, fix
from flexlash.reading.delimited import read_table
from flexlash.validation.csv_findings import report_dialect
from flexlash.validation.ledger import Ledger


def _told(content):
    ledger = Ledger("study.csv")
    report_dialect(read_table(content, "Variants", "a.csv"), ledger)
    return ledger.findings


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"a,b\n1.5,2\n", []),
        (b"a;b\n1.5;2\n", ["a.csv was read as UTF-8 text with columns separated by semicolon."]),
        (b"a\tb\n", ["a.csv was read as UTF-8 text with columns separated by tab."]),
        (b"a|b\n", ["a.csv was read as UTF-8 text with columns separated by bar."]),
        ("a,b\n".encode("utf-16"), ["a.csv was read as UTF-16 text with columns separated by comma."]),
        (
            "a,b\nx,Müller\n".encode("cp1252"),
            ['a.csv was read as Windows-1252 text, since it is not Unicode; Variants!B2 shows "Müller".'],
        ),
        (
            b"a;b\nx; 1,6\ny;2,5\n",
            [
                "a.csv was read as UTF-8 text with columns separated by semicolon.",
                'a.csv writes numbers with a decimal comma: Variants!B2 "1,6" was read as 1.6.',
            ],
        ),
    ],
)
def test_what_was_recognised_is_told(content, words):
    """A comma and UTF-8 go without saying; any other delimiter, encoding or decimal sign is told once a file."""
    assert [found.message for found in _told(content)] == words
    assert {found.level for found in _told(content)} <= {"info"}


def test_examples_stand_at_their_cells():
    """Decimal comma and assumed letters are told at the cell that shows them, with what it holds."""
    found = {one.code: one for one in _told("a;b\nMüller;1,6\n".encode("cp1252"))}
    assert (found["I510"].place, found["I510"].value, found["I510"].suggestion) == ("Variants!B2", "1,6", "1.6")
    assert (found["I511"].place, found["I511"].value) == ("Variants!A2", "Müller")
    assert found["I507"].place == ""


GERMAN = (
    "Variant;Material;Torque T [N·m];Cylinder length l [mm];Mean radius r_m [mm];Wall thickness Δ [mm];"
    "Disk inner radius r_ci [mm];Notes\nA;20Cr2Ni4;800;160;80;1,6;40;für Müller\n"
)


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_a_table_of_another_country_gives_the_same_numbers(tmp_path, table, sound, encoding):
    """A table with semicolons and decimal commas is computed like one with commas and points, to the last bit."""
    path = tmp_path / "german.csv"
    path.write_bytes(GERMAN.encode(encoding))
    outcome = check(path)
    assert {found.code for found in outcome.findings} == {"I507", "I510"}
    plain = check(table([sound | {"variant": "A"}])).results
    assert outcome.results["backlash_rad"].to_list() == plain["backlash_rad"].to_list()


def test_signs_that_excel_lost_do_not_matter(tmp_path):
    """A plain CSV of Excel, in which Δ became a question mark, is read; its letters are told as assumed."""
    path = tmp_path / "german.csv"
    path.write_bytes(GERMAN.replace("Δ", "?").encode("cp1252"))
    outcome = check(path)
    assert [found.code for found in outcome.findings if found.level != "info"] == []
    assert "I511" in {found.code for found in outcome.findings}
    assert outcome.counts["computed"] == 1


def test_doubt_about_the_decimal_sign_is_an_error_at_each_cell(tmp_path):
    """Where commas and points mix, no number with a comma is taken, nor one whose point may separate thousands."""
    path = tmp_path / "mixed.csv"
    path.write_text(GERMAN.replace("800;160", "1.600;160.5"), encoding="utf-8")
    outcome = check(path)
    told = [(found.code, found.cell, found.suggestion) for found in outcome.findings if found.level == "error"]
    assert told == [("E202", "C2", "1.6 or 1600"), ("E202", "F2", "1.6")]
    assert outcome.counts["computed"] == 0


THOUSANDS = "variant;material;torque_Nm;cylinder_length_mm;mean_radius_mm;wall_thickness_mm;disk_inner_radius_mm\n"


@pytest.mark.slow
@pytest.mark.parametrize("delimiter", [";", "\t", "|"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_thousands_points_are_questioned_without_any_decimal_comma(tmp_path, delimiter, encoding):
    """1.050 N·m may be 1050 N·m: in a table that nothing proves to write decimal points, both readings are offered."""
    rows = "".join(f"V{torque};20Cr2Ni4;{torque};160;80;2;40\n" for torque in ("1.050", "2.500", "12.500"))
    path = tmp_path / "thousands.txt"
    path.write_bytes((THOUSANDS + rows).replace(";", delimiter).encode(encoding))
    outcome = check(path)
    told = [(found.code, found.cell, found.suggestion, found.certain_value) for found in outcome.findings if found.cell]
    assert told == [
        ("E202", "C2", "1.05 or 1050", None),
        ("E202", "C3", "2.5 or 2500", None),
        ("E202", "C4", "12.5 or 12500", None),
    ]
    assert (outcome.exit_code, outcome.counts["computed"]) == (4, 0)
    path.write_bytes((THOUSANDS + rows.replace(";2;40", ";1.6;40")).replace(";", delimiter).encode(encoding))
    assert (check(path).exit_code, check(path).counts["computed"]) == (0, 3)


def test_tables_beside_question_their_numbers_too(tmp_path, table, sound):
    """Deviations and moduli of tables given beside a submission are questioned alike."""
    tolerances, materials = tmp_path / "t.csv", tmp_path / "m.csv"
    tolerances.write_text("tolerance_class;dimension;lower_deviation;upper_deviation\nfine;torque;-1.050;1.050\n")
    materials.write_text("material\tyoungs_modulus_GPa\tpoisson_ratio\n20Cr2Ni4\t2.110\t0,3\n")
    found = check(table([sound]), tolerances=tolerances, materials=materials).findings
    told = {(one.sheet, one.cell, one.suggestion) for one in found if one.code == "E202"}
    assert told == {
        ("Tolerances", "C2", "-1.05 or -1050"),
        ("Tolerances", "D2", "1.05 or 1050"),
        ("Materials", "B2", "2.11 or 2110"),
    }


DOUBTS = {
    "thousands beside a comma": ("1.200;1,6", {"C2"}),
    "thousands beside both signs": ("1.200;1.200,5", {"C2"}),
    "undecided": ("1.200;1,6 mm;160.5;1,6", {"C2"}),
    "a lone point": ("1.7;1,6;160,5;1,8", {"C2"}),
    "a lone point beside a cell to fix": ("1.7;1.6 mm;160,5;1,8;1,9", {"C2"}),
}


@pytest.mark.slow
@pytest.mark.parametrize("what", DOUBTS)
def test_a_doubtful_number_stays_in_doubt_in_the_fixed_file(tmp_path, what):
    """Mending other cells of a table never makes a number of one whose decimal sign is in doubt."""
    values, doubtful = DOUBTS[what]
    keys = ["torque_Nm", "wall_thickness_mm", "cylinder_length_mm", "mean_radius_mm", "disk_inner_radius_mm"]
    numbers = values.split(";")
    lines = [["variant", "material", *keys[: len(numbers)], "flexspline_type"], ["A", "20Cr2Ni4", *numbers, "cylindre"]]
    path, new = tmp_path / "a.csv", tmp_path / "new.csv"
    path.write_text("\n".join(map(";".join, lines)), encoding="utf-8")
    outcome, fixes = fix(path, new)
    assert "cylinder" in {certain_value.value for certain_value in fixes}
    for found in (check(path).findings, outcome.findings, check(new).findings):
        assert doubtful <= {one.cell for one in found if one.code == "E202"}


def test_a_table_beside_tells_its_own_manner(tmp_path, table, sound):
    """Materials given beside a submission are told by their own file's name and take part with their commas."""
    materials = tmp_path / "mine.csv"
    materials.write_text("material;shear_modulus_GPa;poisson_ratio\n20Cr2Ni4;81,2;0,3\n", encoding="utf-8")
    outcome = check(table([sound]), materials=materials)
    words = [found.message for found in outcome.findings if found.code in {"I507", "I510"}]
    assert words == [
        "mine.csv was read as UTF-8 text with columns separated by semicolon.",
        'mine.csv writes numbers with a decimal comma: Materials!B2 "81,2" was read as 81.2.',
    ]
    assert outcome.validated.materials["20cr2ni4"].constants["shear_modulus"] == 81.2e9
