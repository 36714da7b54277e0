"""The sheet Levers shows the table of levers: every change with its numbers, links that lead, reasons in grey."""

from __future__ import annotations

from dataclasses import replace

import pytest
from report_entries import opened
from told_levers import CASE_1, CASE_3, NOMINAL_OVER, study_levers

from flexlash.report.levers_sheet import FIRST_LEVER, LEVERS
from flexlash.report.report_data import report_data
from flexlash.report.wording.lever_words import change_words, shown_levers
from flexlash.report.workbook import report_bytes


@pytest.fixture(scope="module")
def book(study, tmp_path_factory):
    """Return the study's report with the levers of the worked example, opened."""
    path = tmp_path_factory.mktemp("levers") / "report.xlsx"
    data = replace(report_data(study[0]), levers=study_levers())
    path.write_bytes(report_bytes(study[0], data))
    return opened(path)


def _rows(book):
    sheet = book[LEVERS]
    heads = [cell.value for cell in sheet[FIRST_LEVER]]
    return [dict(zip(heads, row, strict=True)) for row in sheet.iter_rows(min_row=FIRST_LEVER + 1)]


@pytest.mark.slow
def test_every_change_stands_there_with_its_numbers(book):
    """Rows, their order and every number are those of the table; values in the unit that stands beside them."""
    rows, expected = _rows(book), shown_levers(study_levers()).to_dicts()
    keys = {
        "Over limit after [ppm]": "ppm_after", "Mass [%]": "mass_change_percent",
        "Stiffness [%]": "stiffness_change_percent", "von Mises after, torsion only [MPa]": "von_mises_MPa_after",
        "Bending [%]": "bending_stress_change_percent", "Relative cost": "relative_cost", "Rank": "rank",
        "In range": "in_range",
    }  # fmt: skip
    assert len(rows) == len(expected) == 10
    for row, lever in zip(rows, expected, strict=True):
        assert row["Variant"].value == lever["variant"]
        words = change_words(lever)
        assert row["Change"].value.startswith(words[:1].upper() + words[1:])
        for heading, key in keys.items():
            assert row[heading].value == lever[key], (heading, words)
        size = {"mm": 1.0, "µm": 1e-3}[row["Unit"].value]
        for heading, key, digits in (("Drawn value", "drawing_value", 1e-12), ("Exact value", "to_value", 5e-4)):
            value = row[heading].value
            assert (value and value * size) == (lever[key] and pytest.approx(lever[key], rel=digits))


@pytest.mark.slow
def test_the_cheapest_stands_out_and_what_cannot_is_grey_with_its_reason(book):
    """The row of rank 1 is green, rows that cannot do it are grey and say why."""
    rows = _rows(book)
    assert [row["Change"].fill.fgColor.rgb == "FFC6E5D8" for row in rows] == [True] + [False] * 9
    for row in rows:
        cannot = row["Why not, or what to mind"].value == NOMINAL_OVER
        assert (row["Change"].font.color is not None and row["Change"].font.color.rgb == "FF6B6B6B") == cannot
        assert (row["Drawn value"].value is None) == cannot


@pytest.mark.slow
def test_links_lead_to_pages_and_the_summary_leads_here(book):
    """A variant's first row leads to its page or to Explorer's list; topics of the Summary lead to their changes."""
    first = {}
    for row in _rows(book):
        cell = row["Variant"]
        if cell.value not in first:
            first[cell.value] = cell.coordinate
            title, place = cell.hyperlink.location.split("!")
            assert place == "B4" if title == "Explorer" else book[title.strip("'")][place].value == cell.value
            assert (title == "Explorer") is (cell.value == CASE_1)
    topics = {cell.value: cell.hyperlink for cell in book["Summary"]["A"] if cell.hyperlink}
    leads = {topic: topics[topic].location for topic in ("What to change", "What may be relaxed", "Length allowed")}
    assert list(leads.values()) == [f"Levers!{first[name]}" for name in (CASE_3, CASE_1, CASE_1)]


@pytest.mark.slow
def test_the_sheet_is_one_to_work_with(book):
    """It filters, its heading stays on screen and repeats on paper, it is one landscape page."""
    sheet = book[LEVERS]
    assert sheet.auto_filter.ref == f"A{FIRST_LEVER}:N{FIRST_LEVER + 10}"
    assert sheet.freeze_panes == f"C{FIRST_LEVER + 1}"
    assert sheet.print_title_rows == f"${FIRST_LEVER}:${FIRST_LEVER}"
    assert sheet.page_setup.orientation == "landscape"
    assert sheet.sheet_properties.pageSetUpPr.fitToPage
    assert {sheet.page_setup.fitToWidth, sheet.page_setup.fitToHeight} <= {1, None}


@pytest.mark.slow
def test_no_sheet_without_levers(study, tmp_path):
    """Where no variant has a limit there is nothing to meet: no sheet, and no topic that leads to one."""
    path = tmp_path / "report.xlsx"
    path.write_bytes(report_bytes(study[0], replace(report_data(study[0]), levers=study_levers().clear())))
    book = opened(path)
    assert LEVERS not in book.sheetnames
    assert "What to change" not in [cell.value for cell in book["Summary"]["A"]]
