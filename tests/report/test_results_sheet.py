"""The Results sheet: links, columns passed through, what can be folded away, what is rounded."""

from __future__ import annotations

import io

import openpyxl
import pytest
from filled import SOUND, filled
from openpyxl.utils import get_column_letter

from flexlash.pipeline import run
from flexlash.report.layout.links import finding_list, finding_rows
from flexlash.report.results_sheet import AS_SUBMITTED, FIRST_ROW
from flexlash.schema.result_columns import RESULTS

FIRST = (
    "variant", "verdict", "backlash_arcmin", "p97_5_arcmin", "p99_865_arcmin", "backlash_limit_arcmin",
    "ppm_over_limit", "sd_arcmin", "main_contributor", "main_contributor_share", "von_mises_MPa", "status",
)  # fmt: skip
"""What a reader wants first, in this order."""

LAST = ("notes", "findings")
FOLDED = [column.key for column in RESULTS if column.key not in {*FIRST, *LAST}]
COLUMNS = {key: number for number, key in enumerate((*FIRST, *FOLDED, *LAST), start=1)}
"""The column of the sheet, from 1, by its key."""


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """Return the outcome and the report of a workbook with three rows, two extra columns and a percentage."""
    rows = [
        {**SOUND, "notes": "first", "backlash_limit_arcmin": 30.0},
        {**SOUND, "variant": "strained", "torque_Nm": 12000.0},
        {**SOUND, "variant": "empty", "torque_Nm": None},
    ]
    folder = tmp_path_factory.mktemp("results")
    path = folder / "submission.xlsx"
    book = openpyxl.load_workbook(io.BytesIO(filled(rows)))
    sheet = book["Variants"]
    header = next(row[0].row for row in sheet.iter_rows() if row[0].value == "Variant" and row[1].value)
    right = sheet.max_column
    for place, (title, values) in enumerate(
        {"Order no.": (4711, "=A1", None), "Scrap": (0.05, "low", 3)}.items(), start=right + 1
    ):
        sheet.cell(header, place, title)
        for row, value in enumerate(values, start=header + 1):
            sheet.cell(row, place).value = value
            if value == "=A1":
                sheet.cell(row, place).data_type = "s"
    sheet.cell(header + 1, right + 2).number_format = "0%"
    book.save(path)
    outcome = run(path, folder / "report.xlsx", samples=256)
    return outcome, openpyxl.load_workbook(folder / "report.xlsx")


@pytest.mark.slow
def test_other_columns_of_the_submission_pass_through(report):
    """Columns that flexlash does not know stand at the right end, as they were read, and not in the frame."""
    outcome, book = report
    rows = list(book["Results"].iter_rows(min_col=len(COLUMNS) + 1))
    assert [cell.value for cell in rows[0]] == ["Order no.", "Scrap"]
    assert [cell.value for cell in rows[1]] == [AS_SUBMITTED, AS_SUBMITTED]
    assert [[cell.value for cell in row] for row in rows[2:]] == [[4711, 0.05], ["=A1", "low"], [None, 3]]
    assert rows[2][1].number_format == "0%"
    assert rows[3][0].data_type == "s"
    assert outcome.results.columns == [column.key for column in RESULTS]
    assert book["Results"].auto_filter.ref.endswith(f"{rows[0][1].column_letter}5")


def test_each_variant_leads_to_its_page_or_to_explorer(report):
    """A name leads to the printed page of a variant that misses its limit, that of another to Explorer's list."""
    outcome, book = report
    results, pages = book["Results"], book["Failing variants"]
    lead = []
    for row in range(FIRST_ROW + 1, FIRST_ROW + 1 + outcome.results.height):
        cell = results.cell(row, 1)
        if cell.hyperlink is None:
            assert results.cell(row, COLUMNS["status"]).value == "error"
            continue
        sheet, _, address = cell.hyperlink.location.partition("!")
        lead.append(sheet)
        if sheet == "Explorer":
            assert address == "B4"
        else:
            assert pages[address].value == cell.value
        assert (sheet == "Explorer") == (results.cell(row, COLUMNS["verdict"]).value in {"meets", "–"})
    assert lead == ["Explorer", "'Failing variants'"]
    assert book["Explorer"]["B4"].value in outcome.results["variant"].to_list()


def test_findings_of_a_row_lead_to_the_first_of_them(report):
    """The cell of a row's findings leads to the first row of Findings that is about it; no findings, no link."""
    outcome, book = report
    cells = [book["Results"].cell(row, COLUMNS["findings"]) for row in range(FIRST_ROW + 1, FIRST_ROW + 4)]
    rows = finding_rows(outcome)
    assert cells[0].value is None
    assert cells[0].hyperlink is None
    for cell, one in zip(cells[1:], outcome.validated.submitted[1:], strict=True):
        assert cell.hyperlink.location == f"Findings!A{rows[one[0]] + 1}"
        target = book["Findings"].cell(rows[one[0]] + 1, 5)
        assert target.value == one[1]
    assert len(finding_list(outcome)) >= 2


def test_what_few_need_is_folded_away(report):
    """Verdict, backlash, spread and limit come first; notes, findings and own columns last; all else is folded away."""
    sheet = report[1]["Results"]
    assert [cell.value for cell in sheet[2]][: len(FIRST)] == list(FIRST)
    folded = set()
    for dimension in sheet.column_dimensions.values():
        assert dimension.hidden == (dimension.outlineLevel == 1)
        folded |= set(range(dimension.min, dimension.max + 1)) if dimension.hidden else set()
    assert folded == {COLUMNS[key] for key in FOLDED}
    assert sheet.column_dimensions[get_column_letter(COLUMNS["notes"])].collapsed


def test_errors_are_rounded_and_values_are_not(report):
    """Standard errors hold four digits, estimated shares four decimals, every other number all of its digits."""
    outcome, book = report
    row = outcome.results.row(0, named=True)
    cells = {key: book["Results"].cell(FIRST_ROW + 1, COLUMNS[key]).value for key in row}
    assert cells["mean_standard_error_arcmin"] == float(f"{row['mean_standard_error_arcmin']:.4g}")
    assert cells["main_contributor_share"] == round(row["main_contributor_share"], 4)
    assert cells["mean_standard_error_arcmin"] != row["mean_standard_error_arcmin"]
    for key in ("mean_arcmin", "disk_share", "sd_arcmin", "windup_rad", "probability_over_limit_low", "skewness"):
        assert cells[key] == pytest.approx(row[key], rel=1e-15)


def test_shares_are_drawn_as_bars(report):
    """Three columns of shares have bars from 0 to 1, verdict and status their three colours."""
    formats = {str(area.sqref): [rule.type for rule in rules]
               for area, rules in report[1]["Results"].conditional_formatting._cf_rules.items()}  # fmt: skip
    bars = [area for area, kinds in formats.items() if kinds == ["dataBar"]]
    assert len(bars) == 3
    assert [kinds for kinds in formats.values() if len(kinds) == 3] == [["beginsWith"] * 3, ["cellIs"] * 3]


@pytest.mark.slow
def test_the_limit_is_as_entered(table, sound, tmp_path):
    """A limit of 3.8 stands as 3.8 in the frame and in every sheet, not as 3.7999999999999994."""
    outcome = run(table([{**sound, "backlash_limit_arcmin": 3.8}]), tmp_path / "report.xlsx", samples=256)
    assert outcome.results["backlash_limit_arcmin"].to_list() == [3.8]
    book = openpyxl.load_workbook(tmp_path / "report.xlsx")
    numbers = [cell.value for sheet in book for row in sheet.iter_rows() for cell in row if cell.data_type == "n"]
    near = [number for number in numbers if isinstance(number, float) and abs(number - 3.8) < 1e-9]
    assert len(near) >= 4
    assert set(near) == {3.8}


def test_one_page_is_printed(report):
    """What comes first is printed, on one page."""
    sheet = report[1]["Results"]
    assert [one or 1 for one in (sheet.page_setup.fitToWidth, sheet.page_setup.fitToHeight)] == [1, 1]
    assert sheet.sheet_properties.pageSetUpPr.fitToPage
    assert sheet.print_title_rows == "$1:$2"


@pytest.mark.slow
def test_long_notes_are_wrapped(table, sound, tmp_path):
    """A long note is wrapped in a row that is high enough; a row without one has the usual height."""
    rows = [{**sound, "notes": "word " * 60}, {**sound, "variant": "b", "notes": "short"}]
    run(table(rows), tmp_path / "report.xlsx", samples=256)
    sheet = openpyxl.load_workbook(tmp_path / "report.xlsx")["Results"]
    cell = sheet.cell(FIRST_ROW + 1, COLUMNS["notes"])
    assert cell.alignment.wrap_text
    assert sheet.column_dimensions[cell.column_letter].width == pytest.approx(90, abs=1)
    assert sheet.row_dimensions[FIRST_ROW + 1].height >= 4 * 15
    assert sheet.row_dimensions[FIRST_ROW + 2].height is None
