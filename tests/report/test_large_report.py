"""The report of a large batch: Results holds all of it, every other sheet the worst variants, and each says so."""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import replace

import pytest
from filled import SOUND
from libreoffice import convert, needs_libreoffice
from open_xml import faults_of, needs_validator
from report_entries import opened, without_charts

from flexlash.analysis.whole_batch import DRAWN, LARGE, WholeBatch, verdicts_of
from flexlash.comparison.sides import result_rows as compared_rows
from flexlash.feedback.template.template_workbook import Filling, template_bytes
from flexlash.pipeline import run
from flexlash.reading.read import Source, report_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.report.extent import MOST_FINDINGS, extent_of
from flexlash.report.failing.failing_places import MOST_PAGES
from flexlash.report.layout.links import FIRST_ROW, finding_list
from flexlash.report.report_data import ROW, ranked
from flexlash.report.wording.lever_sentences import CHANGE
from flexlash.report.workbook import report_bytes

ROWS = LARGE + 1
LOST = (5, 1000)
"""Places of rows that cannot be computed."""

SAID = {
    "Explorer": "A2",
    "Compare": "A2",
    "Ranking": "A2",
    "Contributions": "A2",
    "Trace": "A2",
    "Sensitivity": "A3",
    "Tolerances used": "A4",
    "Sections": "A3",
    "Strength": "A6",
    "Submission": "A1",
    "Curves": "A1",
    "Compared": "A1",
    "Inputs": "A1",
    "Scatter": "A1",
}
"""Where each sheet says which variants it shows."""


def _variants():
    """Return rows of which more than half have a limit below their nominal backlash, and some the tenth none."""
    for number in range(ROWS):
        row = {**SOUND, "variant": f"v{number:04d}", "torque_Nm": 500.0 + number % 1999, "backlash_limit_arcmin": 5.0}
        if number in LOST:
            row["torque_Nm"] = None
        if number % 10 == 0:
            row["backlash_limit_arcmin"] = None
        yield row


@pytest.fixture(scope="module")
def large(tmp_path_factory):
    """Return the outcome of one row more than a small submission has, and the path of its report."""
    folder = tmp_path_factory.mktemp("large")
    source, path = folder / "gears.xlsx", folder / "report.xlsx"
    source.write_bytes(template_bytes(Filling(variants=list(_variants()))))
    return run(source, path), path


@pytest.mark.slow
def test_a_row_more_than_a_small_submission_has_makes_it_large(large):
    """Up to 2,000 rows a report repeats every one; from 2,001 on it is that of a large submission."""
    outcome, _ = large
    assert (outcome.results.height, LARGE, DRAWN) == (2001, 2000, 500)
    assert extent_of(outcome).large
    assert not extent_of(replace(outcome, results=outcome.results.head(LARGE))).large


@pytest.mark.slow
def test_results_hold_every_row(large):
    """All rows stand in submitted order; names that are drawn lead to pages or to Explorer, others nowhere."""
    outcome, path = large
    book = opened(path)
    sheet, names = book["Results"], outcome.results["variant"].to_list()
    keys = [cell.value for cell in sheet[2]]
    written = list(sheet.iter_rows(min_row=FIRST_ROW + 1, max_row=sheet.max_row, values_only=True))
    assert [row[0] for row in written] == names
    for key in ("status", "backlash_arcmin", "p97_5_arcmin", "main_contributor", "findings"):
        place, values = keys.index(key), outcome.results[key].to_list()
        expected = [pytest.approx(value, rel=1e-15) if isinstance(value, float) else value for value in values]
        assert [row[place] for row in written] == expected
    drawn, leads = set(ranked(outcome).head(DRAWN)["variant"]), defaultdict(list)
    for row, name in enumerate(names, start=FIRST_ROW + 1):
        link = sheet.cell(row, 1).hyperlink
        assert (link is not None) == (name in drawn)
        if link:
            title, _, cell = link.location.partition("!")
            leads[title].append(name)
            assert book[title.strip("'")][cell].value == name if title != "Explorer" else cell == "B4"
    assert len(leads["'Failing variants'"]) == MOST_PAGES
    assert set(leads["Explorer"]) <= set(_picked(book))
    assert len(leads["Explorer"]) == DRAWN - MOST_PAGES


def _picked(book):
    """Return the names of the list of which Explorer's variant is picked."""
    rules = book["Explorer"].data_validations.dataValidation
    source = next(rule.formula1 for rule in rules if "B4" in rule.sqref)
    title, _, area = source.lstrip("=").partition("!")
    return [row[0].value for row in book[title.strip("'")][area.replace("$", "")]]


@pytest.mark.slow
def test_every_other_sheet_shows_the_worst_and_says_so(large):
    """A sentence at the top of each sheet says of how many variants it shows the 500 worst."""
    outcome, path = large
    book = opened(path)
    for title, cell in SAID.items():
        text = str(book[title][cell].value)
        assert re.search(rf"500 worst of 1,?999\b|40 worst of 1,999 .*Ranking lists {DRAWN}", text), (title, text)
    worst = ranked(outcome).head(DRAWN)["variant"].to_list()
    assert [cell.value for cell in book["Curves"]["A"][2:]] == worst
    assert [cell.value for cell in book["Inputs"]["A"][2:]] == worst
    shares = [cell.value for cell in book["Sensitivity"]["A"]]
    assert shares[shares.index("Variant") + 1 :] == worst


@pytest.mark.slow
def test_the_submission_repeats_the_worst_behind_their_row_numbers(large):
    """Every repeated row has its row number and its cells as read; findings link to the very cell they are about."""
    outcome, path = large
    book = opened(path)
    table, raw = outcome.validated.table, outcome.submission.sheets["Variants"]
    sheet, header = book["Submission"], table.heading.row
    assert sheet.cell(header + 1, 1).value == "Row"
    below = list(sheet.iter_rows(min_row=header + 2, values_only=True))
    assert [row[0] for row in below] == ranked(outcome).head(DRAWN)[ROW].to_list()
    for row in below:
        for column, value in raw.rows[row[0]].items():
            if column in table.heading.columns.values():
                assert row[column] == value
    findings, linked = book["Findings"], 0
    for row in range(1, findings.max_row + 1):
        cell = findings.cell(row, 4)
        if cell.hyperlink and cell.hyperlink.location.startswith("Submission!"):
            shown = book["Submission"][cell.hyperlink.location.partition("!")[2]]
            number, letters = int(re.sub(r"\D", "", cell.value)), re.sub(r"\d", "", cell.value)
            assert book["Submission"].cell(shown.row, 1).value == number
            assert shown.column == opened(path)["Submission"][f"{letters}1"].column + 1
            linked += 1
    assert linked > 100


@pytest.mark.slow
def test_findings_are_counted_and_the_first_thousand_listed(large):
    """Each rule stands with its count of all findings; a thousand are listed, errors first, and the rest is told."""
    outcome, path = large
    sheet = opened(path)["Findings"]
    found = finding_list(outcome)
    assert len(found) > MOST_FINDINGS
    column = [cell.value for cell in sheet["B"]]
    rules = {
        row[1]: row[2] for row in sheet.iter_rows(min_row=5, max_row=column.index("Code", 5) - 1, values_only=True)
    }
    counted = {code: sum(one.code == code for one in found) for code in {one.code for one in found}}
    assert {code: count for code, count in rules.items() if code} == counted
    listed = [(row[1], row[3]) for row in sheet.iter_rows(min_row=column.index("Code", 5) + 2, values_only=True)]
    assert listed == [(one.code, one.cell) for one in found[:MOST_FINDINGS]]
    more = len(found) - MOST_FINDINGS
    assert sheet["A3"].value.startswith(f"{MOST_FINDINGS} findings are listed below, {more} more are not; ")


@pytest.mark.slow
def test_summary_and_about_say_what_is_where(large):
    """The Summary counts all variants and says which sheet holds them; About says it of every sheet."""
    outcome, path = large
    book = opened(path)
    texts = {row[0]: row[1] for row in book["Summary"].iter_rows(values_only=True) if row[0]}
    assert texts["Computed"].startswith(
        "1999 of 2001 variants were computed. Results holds all of them; the other sheets show the 500 worst."
    )
    failing = verdicts_of(outcome.results, outcome.settings.verdict_bounds)[0]["fails"]
    assert f"{failing} of 1799 variants with a limit fail" in texts["Which fail"]
    assert re.search("Main contributor of (all )?1999 variants: ", texts["Why"])
    told = {row[0]: row[1] for row in book["About"].iter_rows(values_only=True)}
    assert told["Variants shown"].startswith("The 500 worst of 1999 variants; all are in Results.")
    assert any(str(text).startswith("Sheet Variants as read, of the 500 worst of 1999") for text in told.values())


@pytest.mark.slow
def test_the_report_carries_all_that_was_read(large):
    """The report alone gives back every row that was read, and all Results to be compared."""
    outcome, path = large
    carried = report_of(Source(name=path.name, data=path.read_bytes()), ReadingLimits())
    assert carried.submission.sheets["Variants"].rows == outcome.submission.sheets["Variants"].rows
    assert len(compared_rows(carried.results)) == ROWS


@pytest.mark.slow
@needs_validator
def test_a_large_report_is_valid(large):
    """Excel finds nothing to repair in it."""
    assert faults_of(large[1]) == []


@pytest.mark.long
@pytest.mark.slow
@needs_libreoffice
def test_formulas_of_a_large_report_give_their_stored_values(large, tmp_path):
    """Recalculated, the formulas of a large report keep their stored values."""
    path = without_charts(large[1], tmp_path / "report.xlsx")
    book, stored = opened(path), opened(path, data_only=True)
    again = opened(convert(path, "xlsx", tmp_path / "again"), data_only=True)
    count = 0
    for sheet in book:
        for row in sheet.iter_rows() if sheet.title not in {"Results", "Carried"} else ():
            for cell in row:
                if cell.data_type == "f":
                    before, after = (one[sheet.title][cell.coordinate].value for one in (stored, again))
                    same = pytest.approx(before, rel=1e-8, abs=1e-12) if isinstance(before, float) else before
                    assert after == same, f"{sheet.title}!{cell.coordinate}"
                    count += 1
    assert count > 4000


WHOLE = WholeBatch(
    rows=1_000_000,
    computed=999_998,
    results_file="gears-results.parquet",
    findings_file="gears-findings.parquet",
    verdicts={"meets": 990_000, "marginal": 5_000, "fails": 4_998},
    unsettled={"fails": 12},
    rules={"E201": 2, "W423": 120_000, "W411": 35_000},
)


@pytest.fixture(scope="module")
def worst_of_many(tmp_path_factory):
    """Return an outcome of six rows that stands for a million, and the path of its report."""
    source, path = tmp_path_factory.mktemp("whole") / "gears.csv", tmp_path_factory.mktemp("whole") / "report.xlsx"
    rows = [{**SOUND, "variant": f"v{number}", "backlash_limit_arcmin": 3.3 + 0.05 * number} for number in range(6)]
    lines = [",".join(rows[0]), *(",".join(map(str, row.values())) for row in rows)]
    source.write_text("\n".join(lines) + "\n", encoding="utf-8")
    outcome = replace(run(source), whole=WHOLE)
    path.write_bytes(report_bytes(outcome))
    return outcome, path


@pytest.mark.slow
def test_the_report_of_the_worst_of_a_million_says_where_all_are(worst_of_many):
    """Tiles and sentences count the whole submission; every sheet says that it has the worst, and where all are."""
    _, path = worst_of_many
    book = opened(path)
    note = "The 6 worst of 999,998 variants; all Results are in gears-results.parquet."
    assert book["Results"]["A1"].value == note
    assert [book["Results"].cell(row, 1).value for row in (2, 3, 4)] == ["Variant", "variant", "v0"]
    for title, cell in SAID.items():
        text = str(book[title][cell].value)
        assert re.search(r"6 worst of 999,998\b", text), (title, text)
    cells = [cell for row in book["Summary"].iter_rows(values_only=True) for cell in row if isinstance(cell, str)]
    for tile in ("999,998 of 1,000,000", "4998 fail?", "5000 marginal", "990,000 meet", "2 errors"):
        assert tile in cells
    texts = {row[0]: row[1] for row in book["Summary"].iter_rows(values_only=True) if row[0]}
    assert texts["Computed"] == (
        "999,998 of 1,000,000 variants were computed. This report shows the 6 worst of them; all Results are in "
        "gears-results.parquet, all findings in gears-findings.parquet."
    )
    assert texts["Which fail"].startswith("4998 of 999,998 variants with a limit fail, 12 of them not settled")
    for topic in ("Why", CHANGE, "Cylinder-only formula", "Strength"):
        assert texts[topic].startswith("Of the 6 worst: ")
    assert "155,000 warnings" in texts["Findings"]
    findings = [row[1:3] for row in book["Findings"].iter_rows(min_row=5, max_row=7, values_only=True)]
    assert findings == [("E201", 2), ("W411", 35_000), ("W423", 120_000)]
    assert "all are in gears-findings.parquet" in book["Findings"]["A3"].value
    told = {row[0]: row[1] for row in book["About"].iter_rows(values_only=True)}
    assert "gears-results.parquet" in told["Variants shown"]
    assert "gears-findings.parquet" in told["Variants shown"]


@pytest.mark.slow
def test_what_the_report_of_the_worst_of_a_million_carries_says_so(worst_of_many):
    """What is made of that report again bears the name of a part of the submission, not of the submission."""
    outcome, path = worst_of_many
    carried = report_of(Source(name=path.name, data=path.read_bytes()), ReadingLimits()).submission
    assert carried.name == "gears, 6 worst of 1000000.csv"
    assert carried.sheets["Variants"].rows == outcome.submission.sheets["Variants"].rows


@pytest.mark.slow
def test_without_a_file_of_all_results_none_is_promised(worst_of_many):
    """Where no file beside the report holds all Results, the report names the way to them and not its own sheet."""
    outcome, _ = worst_of_many
    extent = extent_of(replace(outcome, whole=replace(WHOLE, results_file="")))
    assert extent.note == "The 6 worst of 999,998 variants; run with -o NAME.parquet for all."


@pytest.mark.slow
@needs_validator
def test_the_report_of_the_worst_of_a_million_is_valid(worst_of_many):
    """Excel finds nothing to repair in it."""
    assert faults_of(worst_of_many[1]) == []
