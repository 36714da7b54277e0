"""A report carries what was read: every digit, every sort of cell, nothing of the engineer's other sheets."""

from __future__ import annotations

import datetime
import json
import math
import warnings
from dataclasses import replace

import openpyxl
import pytest
import regenerate
from finding_examples import SUBMISSIONS
from libreoffice import convert, needs_libreoffice
from written import write_outcome

from flexlash.feedback.template.template_workbook import TEMPLATE_VERSION
from flexlash.pipeline import run
from flexlash.reading.carried import carried_submission
from flexlash.reading.raw import ErrorCell, RawSheet, Submission, Unstored
from flexlash.reading.read import ReadReport, Source, report_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.xlsx import read_workbook
from flexlash.report.carried_sheet import carried_text
from flexlash.schema.findings import finding

OPTIONS = {"samples": 64}


def _carried(path):
    """Return the submission that a report carries, without what only its run knew."""
    return report_of(Source(name=path.name, data=path.read_bytes()), ReadingLimits()).submission


def _sheet(path):
    """Return the sheet itself."""
    (sheet,) = read_workbook(path.read_bytes(), ReadingLimits(), only=["Carried"]).sheets
    return sheet


def _read(outcome):
    """Return what was read, of the sheets that a report carries."""
    left = {"Dictionary", "Lists", "Sketch"}
    sheets = {name: sheet for name, sheet in outcome.submission.sheets.items() if name not in left}
    return replace(outcome.submission, data=b"", sheets=sheets)


def _saved_by_openpyxl(path, folder):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with path.open("rb") as file:
            openpyxl.load_workbook(file).save(folder / "saved.xlsx")
    return folder / "saved.xlsx"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["b3-160-study", "needs-fixing"])
def test_what_was_read_comes_back(name, tmp_path):
    """The report's sheet holds exactly the sheets that were read, their dates and properties, and the run's options."""
    outcome = run(
        regenerate.ROOT / "data" / f"{name}.xlsx", tmp_path / "r.xlsx", seed=3, angle_unit="arcsec", **OPTIONS
    )
    found = _carried(tmp_path / "r.xlsx")
    options = {"seed": 3, "method": "line", "samples": 64, "target_percent": 99.865, "angle_unit": "arcsec"}
    options |= {"cross_check": False, "elasticity": False, "strict": False}
    assert found.run_with == options
    assert replace(found, run_with=None) == _read(outcome)
    assert found.template_version == str(TEMPLATE_VERSION)
    assert [type(value) for row in found.sheets["Variants"].rows.values() for value in row.values()] == [
        type(value) for row in outcome.submission.sheets["Variants"].rows.values() for value in row.values()
    ]


@pytest.mark.slow
def test_numbers_keep_the_digits_that_cells_lose(table, sound, tmp_path):
    """A number of seventeen digits, which a cell cuts to sixteen, is carried whole."""
    length = 160.00000000000003
    run(table([{**sound, "cylinder_length_mm": repr(length)}]), tmp_path / "r.xlsx", **OPTIONS)
    text = "".join(cells[1] for cells in _sheet(tmp_path / "r.xlsx").rows.values())
    assert repr(length) in text


@pytest.mark.slow
def test_the_sheet_is_last_and_can_only_be_unhidden_on_purpose(table, sound, tmp_path):
    """The sheet is the last one, in no list of hidden sheets, in pieces that a cell holds, in plain letters."""
    rows = [{**sound, "variant": f"v{number}", "notes": "µ" * 300} for number in range(40)]
    run(table(rows), tmp_path / "r.xlsx", **OPTIONS)
    with (tmp_path / "r.xlsx").open("rb") as file:
        book = openpyxl.load_workbook(file)
    assert book.sheetnames[-1] == "Carried"
    assert book["Carried"].sheet_state == "veryHidden"
    pieces = [cells[1] for cells in _sheet(tmp_path / "r.xlsx").rows.values()]
    assert len(pieces) > 2
    assert all(0 < len(piece) <= 30_000 and piece.isascii() for piece in pieces)
    assert "from-report" in book["Carried"]["B1"].value


NASTY = ("_x0041_", "_x005F_x0041_", "=1+1", "a\nb", "\x01\x1b", " ends in a space ", "x" * 32_000, "𝄞é", "#REF!", "")


def _outcome(sheets, outcome):
    submission = Submission(name="n.xlsx", sha256="0" * 64, kind="workbook", sheets={one.name: one for one in sheets})
    return replace(outcome, submission=submission)


@pytest.fixture
def outcome(table, sound):
    """Return a computed outcome, whose submission a test can replace."""
    return run(table([sound]), **OPTIONS)


@pytest.mark.parametrize("text", NASTY, ids=repr)
def test_texts_that_workbooks_take_for_something_else(text, outcome, tmp_path):
    """Any text of a cell passes through the report's cells unchanged, escapes and control characters among it."""
    sheet = RawSheet(name="Variants", rows={1: {1: text, 2: "after"}})
    made = _outcome([sheet], outcome)
    assert "_x" not in carried_text(made)
    write_outcome(made, tmp_path / "r.xlsx")
    assert _carried(tmp_path / "r.xlsx").sheets == {"Variants": sheet}


def test_every_kind_of_cell_is_carried(outcome):
    """Errors, formulas without result, dates, lengths of time, truth values and infinities are carried as such."""
    values = [ErrorCell("#REF!"), Unstored(), datetime.date(2026, 1, 2), datetime.timedelta(1.5), True, math.inf, 7]
    sheet = RawSheet(name="Variants", rows={1: dict(enumerate(values, start=1))}, hidden_rows=frozenset({1}))
    found = carried_submission(json.loads(carried_text(_outcome([sheet], outcome))), ReadingLimits())
    assert found.sheets == {"Variants": sheet}


def test_other_sheets_of_the_engineer_are_not_carried(outcome):
    """Only entry sheets go into the report; of a sheet that a finding names, the rows by which it was recognised."""
    rows = {number: {1: f"secret {number}"} for number in range(1, 40)}
    names = ("variants", "Prices", "Variants (2)")
    made = _outcome([RawSheet(name=name, rows=rows) for name in names], outcome)
    made = replace(made, findings=(finding("W428", sheet="Variants (2)", cell="A1", value="", other="Variants"),))
    sheets = json.loads(carried_text(made))["cells"]["sheets"]
    assert {sheet["name"]: len(sheet["rows"]) for sheet in sheets} == {"variants": 39, "Variants (2)": 15}


@pytest.mark.parametrize("name", ["a copied sheet", "a sheet of notes"])
def test_findings_on_other_sheets_are_found_again(name, tmp_path):
    """W428 and W452, which speak of sheets that are not read, come again from what is carried of them."""
    path, options = SUBMISSIONS[name](tmp_path)
    outcome = run(path, **options, **OPTIONS)
    found = carried_submission(json.loads(carried_text(outcome)), ReadingLimits())
    again = run(_ready(found), **OPTIONS)
    assert [one.code for one in again.findings if one.code in {"W428", "W452"}]
    assert again.findings == outcome.findings


def _ready(submission):
    """Return a submission that needs no reading."""
    return ReadReport(name=submission.name, submission=submission, results=None, version="")


@pytest.mark.slow
def test_openpyxl_keeps_the_sheet(tmp_path):
    """Saved by openpyxl, the report still carries the same submission."""
    run(regenerate.ROOT / "data" / "b3-160-study.xlsx", tmp_path / "r.xlsx", **OPTIONS)
    assert _carried(_saved_by_openpyxl(tmp_path / "r.xlsx", tmp_path)) == _carried(tmp_path / "r.xlsx")


@pytest.mark.slow
@needs_libreoffice
def test_libreoffice_keeps_the_sheet(table, sound, tmp_path):
    """Saved by LibreOffice, the report still carries the same submission."""
    rows = [{**sound, "variant": f"v{number}", "notes": f"_x0041_ {'µ ' * 400}"} for number in range(20)]
    run(table(rows), tmp_path / "r.xlsx", **OPTIONS)
    assert _carried(convert(tmp_path / "r.xlsx", "xlsx", tmp_path)) == _carried(tmp_path / "r.xlsx")
