"""Links of the report: where rows stand on each sheet, and no more links than Excel keeps."""

from __future__ import annotations

import io
import re
import zipfile

import openpyxl
import pytest
import xlsxwriter
from finding_examples import SUBMISSIONS

from flexlash.pipeline import run
from flexlash.report.layout import links
from flexlash.report.layout.links import (
    finding_list,
    finding_rows,
    name_column,
    result_rows,
    row_of,
    rules_of,
    write_link,
)


@pytest.fixture
def outcome(table, sound):
    """Return the outcome of three rows: sound, with two warnings, with an error; the names stand in column B."""
    rows = [
        sound,
        {**sound, "variant": "strained", "torque_Nm": 12000.0},
        {**sound, "variant": "empty", "torque_Nm": ""},
    ]
    return run(table([{"material": row["material"], **row} for row in rows]), samples=256)


def test_rows_of_results_follow_the_submitted_rows(outcome):
    """Row numbers of the submission lead to the rows of Results in submitted order."""
    assert result_rows(outcome) == {2: 2, 3: 3, 4: 4}
    assert name_column(outcome) == 2


def test_findings_are_listed_worst_first(outcome):
    """Errors stand before warnings and infos; each rule is listed once, with all of its findings."""
    listed = finding_list(outcome)
    assert [found.level for found in listed] == sorted((found.level for found in listed), key="error warning info".find)
    rules = rules_of(outcome)
    assert sorted(map(id, listed)) == sorted(id(found) for group in rules.values() for found in group)
    assert {found.code for found in outcome.findings} == set(rules)
    assert next(iter(rules))[0] == "E"


def test_a_row_leads_to_its_first_finding(outcome):
    """The row of Findings of a variant is that of the worst of its findings."""
    rows, listed = finding_rows(outcome), finding_list(outcome)
    start = links.FIRST_FINDING + len(rules_of(outcome))
    for number in (3, 4):
        assert row_of(outcome, listed[rows[number] - start]) == number
        assert all(row_of(outcome, found) != number for found in listed[: rows[number] - start])
    assert 2 not in rows


def test_links_end_where_excel_ends_them(monkeypatch):
    """Beyond the links that Excel keeps a cell is a plain text, without a warning; a link's text stands once."""
    monkeypatch.setattr(links, "MOST_LINKS", 2)
    buffer = io.BytesIO()
    book = xlsxwriter.Workbook(buffer)
    sheet = book.add_worksheet("Results")
    for row in range(3):
        write_link(sheet, row, 0, f"Results!B{row + 1}", "http://a", style=None)
    book.close()
    cells = [cell for (cell,) in openpyxl.load_workbook(buffer)["Results"].iter_rows()]
    assert [cell.value for cell in cells] == ["http://a"] * 3
    assert [cell.hyperlink and cell.hyperlink.location for cell in cells] == ["Results!B1", "Results!B2", None]
    assert [cell.hyperlink.display for cell in cells[:2]] == [None, None] or not any(
        cell.hyperlink.display for cell in cells[:2]
    )


@pytest.mark.slow
def test_names_of_sheets_with_spaces_are_quoted(tmp_path):
    """A link to a mirrored sheet such as Levers entered names it as Excel follows it: between quotes."""
    path, options = SUBMISSIONS["decided"](tmp_path)
    run(path, tmp_path / "report.xlsx", samples=16, method="random", **options)
    with zipfile.ZipFile(tmp_path / "report.xlsx") as archive:
        sheets = [archive.read(name).decode() for name in archive.namelist() if name.startswith("xl/worksheets/sheet")]
    places = {place for sheet in sheets for place in re.findall(r'<hyperlink [^>]*location="([^"]*)"', sheet)}
    assert {"'Levers entered'!B2", "'Sweep entered'!D4", "'Other sources'!E4"} <= places
    titles = {place.rpartition("!")[0] for place in places}
    assert [title for title in titles if " " in title and not (title[0] == title[-1] == "'")] == []
    names = {title.strip("'") for title in titles}
    assert names <= {*openpyxl.load_workbook(tmp_path / "report.xlsx").sheetnames}
