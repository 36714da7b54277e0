"""A submission whose sheets have other names goes the whole way as if they had the template's."""

import openpyxl
import pytest
from filled import SOUND

from flexlash.feedback.template.upgrade import upgraded
from flexlash.pipeline import check, fix, run

NAMES = {"Variants": "Variants - Table 1-1", "Materials": "Materials - Table 1", "Settings": "Settings - Table 1"}


@pytest.fixture
def renamed(workbook):
    """Return a filled template whose sheets were renamed, as Numbers does, with one cell to fix."""
    path = workbook([SOUND, {**SOUND, "variant": "B", "wall_thickness_mm": "1,6"}], settings={"seed": 7})
    book = openpyxl.load_workbook(path)
    for name, other in NAMES.items():
        book[name].title = other
    book.save(path)
    return path


def test_what_is_read_is_the_same(renamed):
    """Variants, materials and settings come from the renamed sheets, each told once."""
    outcome = check(renamed)
    told = {found.sheet for found in outcome.findings if found.code == "I520"}
    assert told == set(NAMES.values())
    assert not [found for found in outcome.findings if found.code == "I505"]
    assert (outcome.settings.seed, outcome.counts["computed"], outcome.exit_code) == (7, 1, 3)


def test_report_links_and_recreates(renamed, tmp_path):
    """The report mirrors the renamed sheets under their titles, its findings link there, and it can be made anew."""
    report = tmp_path / "report.xlsx"
    outcome = run(renamed, report, samples=64)
    book = openpyxl.load_workbook(report)
    assert any(cell.value == "1,6" for row in book["Submission"].iter_rows() for cell in row)
    links = [cell.hyperlink.location for row in book["Findings"].iter_rows() for cell in row if cell.hyperlink]
    assert any(link.startswith("Submission!") for link in links)
    again = run(report, None, from_report=True)
    assert again.results.equals(outcome.results)


def test_fixed_marked_and_upgraded(renamed, tmp_path):
    """Fixed files keep the names of their sheets; a new template takes everything over."""
    outcome, fixes = fix(renamed, tmp_path / "fixed.xlsx", marked_copy=tmp_path / "marked.xlsx")
    assert [certain_value.sheet for certain_value in fixes] == [NAMES["Variants"]]
    assert outcome.counts["computed"] == 2
    check(renamed, marked_copy=tmp_path / "checked.xlsx")
    assert NAMES["Variants"] in openpyxl.load_workbook(tmp_path / "checked.xlsx").sheetnames
    upgrade = upgraded(renamed)
    (tmp_path / "new.xlsx").write_bytes(upgrade.data)
    new = check(tmp_path / "new.xlsx")
    assert (new.counts["rows"], new.settings.seed) == (2, 7)
    assert any("was taken as Variants" in remark for remark in upgrade.remarks)
