"""The About sheet: what every sheet and column is, how the verdict is formed, what the digits mean."""

from __future__ import annotations

import hashlib

import openpyxl
import polars as pl
import pytest
from filled import SOUND, filled

from flexlash.pipeline import run
from flexlash.report.wording.about_texts import CHECKSUMS, SHEETS, TABS
from flexlash.report.wording.verdict import verdict_rules
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.result_columns import RESULTS
from flexlash.schema.used_columns import TOLERANCES_USED


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    """Return a report."""
    folder = tmp_path_factory.mktemp("about")
    (folder / "submission.xlsx").write_bytes(filled([SOUND]))
    run(folder / "submission.xlsx", folder / "report.xlsx", samples=256)
    return openpyxl.load_workbook(folder / "report.xlsx")


def _section(sheet, title):
    """Return the rows of a section as (name, text, link)."""
    start = next(cell.row for cell in sheet["A"] if cell.value == title)
    rows = []
    for row in sheet.iter_rows(min_row=start + 1, max_col=2):
        if row[0].value is None:
            break
        rows.append((row[0].value, row[1].value, row[0].hyperlink and row[0].hyperlink.location))
    return rows


@pytest.mark.slow
def test_every_sheet_is_listed_with_its_line(book):
    """The index names every visible sheet in order, says in a line what it is for, and leads to it."""
    visible = [sheet.title for sheet in book.worksheets if sheet.sheet_state == "visible"]
    links = {name: f"'{name}'!A1" if " " in name else f"{name}!A1" for name in visible}
    rows = _section(book["About"], "Sheets")
    assert rows == [(name, SHEETS[name], links[name]) for name in visible]
    assert (f"•  {TABS}", None, None) in _section(book["About"], "Hidden sheets")
    assert all(SHEETS[name] for name in visible)


def test_every_column_is_defined(book):
    """Each heading of Results and of Tolerances used stands in About with its help."""
    defined = [(name, text) for name, text, _ in _section(book["About"], "Columns of Results")]
    assert defined == [(column.label, column.help) for column in RESULTS]
    defined = [(name, text) for name, text, _ in _section(book["About"], "Columns of Tolerances used")]
    assert defined == [(column.label, column.help) for column in TOLERANCES_USED]


def test_verdict_and_digits_are_explained(book):
    """About gives the rule of each verdict, and says what is rounded and what is exact."""
    said = " ".join(name for name, _, _ in _section(book["About"], "Verdict"))
    for colour, rule in verdict_rules(VerdictBounds()).items():
        assert f"{colour.capitalize()}: {rule}." in said
    digits = " ".join(name for name, _, _ in _section(book["About"], "Digits and columns"))
    assert "Standard errors are kept to 4 digits and estimated shares to 4 decimals" in digits
    spread = " ".join(name for name, _, _ in _section(book["About"], "Spread"))
    assert "Exact to rounding: nominal columns" in spread


def test_long_texts_have_rows_high_enough(book):
    """A row of About is as high as its text needs at its width."""
    sheet = book["About"]
    for row in sheet.iter_rows(min_row=3, max_col=2):
        text, width = (row[1].value, 88) if row[1].value else (row[0].value, 114)
        if text and len(text) > width:
            assert sheet.row_dimensions[row[0].row].height >= 15 * (1 + (len(text) - 3) // width)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["csv", "parquet"])
def test_what_tells_whether_a_file_came_through_unchanged(kind, tmp_path, book):
    """About names the digest of what was read, and says whether a file of its kind carries checksums."""
    path, report = tmp_path / f"study.{kind}", tmp_path / "report.xlsx"
    frame = pl.DataFrame([{key: value for key, value in SOUND.items() if value is not None}])
    if kind == "csv":
        frame.write_csv(path)
    else:
        frame.write_parquet(path)
    run(path, report, samples=256)
    told = {
        name: text for name, text, _ in _section(openpyxl.load_workbook(report)["About"], "Provenance and settings")
    }
    assert told["sha256"] == hashlib.sha256(path.read_bytes()).hexdigest()
    assert told["Checksums"] == CHECKSUMS[kind]
    assert "sha256 above" in CHECKSUMS[kind]
    said = {name: text for name, text, _ in _section(book["About"], "Provenance and settings")}
    assert said["Checksums"] == CHECKSUMS["workbook"]
