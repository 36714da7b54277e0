"""Links of the report: where rows stand on each sheet, and no more links than Excel keeps."""

from __future__ import annotations

import io

import openpyxl
import pytest
import xlsxwriter

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
from flexlash.report.layout.styles import Book


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
    workbook = xlsxwriter.Workbook(buffer)
    sheet = Book(workbook).sheet("Results")
    for row in range(3):
        write_link(sheet, row, 0, f"Results!B{row + 1}", "http://a", style=None)
    workbook.close()
    cells = [cell for (cell,) in openpyxl.load_workbook(buffer)["Results"].iter_rows()]
    assert [cell.value for cell in cells] == ["http://a"] * 3
    assert [cell.hyperlink and cell.hyperlink.location for cell in cells] == ["Results!B1", "Results!B2", None]
    assert [cell.hyperlink.display for cell in cells[:2]] == [None, None] or not any(
        cell.hyperlink.display for cell in cells[:2]
    )


def test_no_link_leads_to_a_hidden_sheet():
    """A text whose sheet cannot be seen is plain, in look and in effect; the name of one with spaces is quoted."""
    buffer = io.BytesIO()
    workbook = xlsxwriter.Workbook(buffer)
    book = Book(workbook, {"Summary", "Seen too"})
    sheet = book.sheet("Summary")
    for title in ("Seen too", "Hidden one"):
        book.sheet(title)
        write_link(sheet, sheet.hlink_count, 0, f"{title}!A1", title, style=book.format("link"))
    workbook.close()
    read = openpyxl.load_workbook(buffer)
    assert {name: read[name].sheet_state for name in read.sheetnames} == {
        "Summary": "visible", "Seen too": "visible", "Hidden one": "hidden",
    }  # fmt: skip
    seen, hidden = read["Summary"]["A1"], read["Summary"]["A2"]
    assert seen.hyperlink.location == "'Seen too'!A1"
    assert seen.font.underline
    assert hidden.hyperlink is None
    assert not hidden.font.underline
