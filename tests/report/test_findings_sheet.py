"""The Findings sheet: each rule once with its fix, below it every finding with its links."""

from __future__ import annotations

from dataclasses import replace

import openpyxl
import pytest
from finding_examples import SUBMISSIONS

from flexlash.pipeline import run
from flexlash.report.layout.links import FIRST_FINDING, finding_list, rules_of
from flexlash.schema.findings import CATALOGUE
from flexlash.schema.result_columns import FINDINGS


@pytest.fixture
def report(table, sound, tmp_path):
    """Return outcome and Findings sheet of rows with one rule broken twice, one once, a long name, and a warning."""
    long = "sleeve with a name that is much longer than any column of a table"
    rows = [
        sound,
        {**sound, "variant": "a", "torque_Nm": ""},
        {**sound, "variant": long, "torque_Nm": ""},
        {**sound, "variant": "c", "wall_thickness_mm": "1,6 mm"},
        {**sound, "variant": "strained", "torque_Nm": 12000},
    ]
    outcome = run(table(rows), tmp_path / "report.xlsx", samples=256)
    return outcome, openpyxl.load_workbook(tmp_path / "report.xlsx")["Findings"]


@pytest.mark.slow
def test_each_rule_stands_once_on_top(report):
    """A line for each rule tells level, code, count, title, how to learn more and the fix."""
    outcome, sheet = report
    rules = rules_of(outcome)
    assert len(rules["E201"]) == 2
    for row, (code, group) in enumerate(rules.items(), start=5):
        cells = [cell.value for cell in sheet[row]]
        assert cells[:4] == [group[0].level, code, len(group), CATALOGUE[code].title]
        assert cells[6] == f"flexlash explain {code}"
        assert cells[7]
    fixes = {found.fix for found in rules["E201"]}
    assert sheet.cell(5, 8).value in fixes


@pytest.mark.slow
def test_the_list_is_complete_and_can_be_filtered(report):
    """Below the rules stands every finding, worst first, under a header with filters."""
    outcome, sheet = report
    header = FIRST_FINDING + len(rules_of(outcome))
    assert [cell.value for cell in sheet[header]] == [column.label for column in FINDINGS]
    last = header + len(outcome.findings)
    assert sheet.max_row == last
    assert sheet.auto_filter.ref == f"A{header}:J{last}"
    codes = [sheet.cell(row, 2).value for row in range(header + 1, last + 1)]
    assert codes == [found.code for found in finding_list(outcome)]


@pytest.mark.slow
def test_a_finding_names_its_column_and_leads_to_cell_and_result(report):
    """The column is named by label above key; cells lead to Submission, a variant where its name in Results does."""
    outcome, sheet = report
    results, linked = sheet.parent["Results"], []
    start = FIRST_FINDING + len(rules_of(outcome)) + 1
    for row, found in enumerate(finding_list(outcome), start=start):
        cells = {column.key: sheet.cell(row, place) for place, column in enumerate(FINDINGS, start=1)}
        if not found.cell or found.level == "info":
            continue
        assert cells["cell"].hyperlink.location == f"Submission!{found.cell}"
        name = results.cell(int(found.cell[1:]) + 1, 1)
        assert name.value == found.variant
        links = [cell.hyperlink and cell.hyperlink.location for cell in (cells["variant"], name)]
        assert links[0] == links[1]
        linked.append(links[0])
        assert len(cells["variant"].value) <= 30
        label, key = cells["column"].value.split("\n")
        assert key == found.column
        assert label in {"Torque T [N·m]", "Wall thickness Δ [mm]", "Backlash limit [arcmin]"}
    assert linked == [None] * 3 + ["'Failing variants'!A1"] * 2


@pytest.mark.slow
def test_nothing_found_is_said(table, sound, tmp_path):
    """Without findings the sheet says so and has neither rules nor filters."""
    outcome = run(table([sound]), tmp_path / "report.xlsx", samples=256)
    outcome = replace(outcome, findings=())
    from written import write_outcome

    sheet = openpyxl.load_workbook(write_outcome(outcome, tmp_path / "bare.xlsx"))["Findings"]
    assert [cell.value for cell in sheet["A"] if cell.value] == ["Findings", "Nothing was found."]
    assert sheet.auto_filter.ref is None


@pytest.mark.slow
def test_columns_of_one_key_are_called_by_their_own_sheet(tmp_path):
    """A step of Sweep is no drawing step of Levers, whatever the sheets of the report are called."""
    path, options = SUBMISSIONS["decided"](tmp_path)
    run(path, tmp_path / "report.xlsx", samples=16, method="random", **options)
    texts = {
        (row[1], row[3]): row[5]
        for row in openpyxl.load_workbook(tmp_path / "report.xlsx")["Findings"].iter_rows(values_only=True)
        if row[2] in {"Levers", "Sweep"}
    }
    assert texts["E368", "D4"] == "Step\nstep"
    assert texts["W463", "D3"] == "Drawing step\nstep"
