"""The Sweep sheet: sentences, charts with the right numbers behind them, the contour of the limit."""

from __future__ import annotations

import zipfile

import openpyxl
import pytest
from open_xml import faults_of, needs_validator
from report_charts import chart_titled, points_of
from swept import asked, sweep_row, swept

from flexlash.feedback.template.template_workbook import study as published
from flexlash.feedback.template.template_workbook import template_bytes
from flexlash.pipeline import check, run
from flexlash.report.sweeps.sweep_curves import grid_of
from flexlash.report.wording.sweep_words import allowed_sentence, allowed_words, study_sentences, study_title
from flexlash.report.workbook import report_bytes
from flexlash.schema.angle_unit import ARC_MINUTES

THIRD = "B3-160 case 3"
LENGTHS = ("cylinder_length_mm", (100, 200, 20))
HUBS = ("disk_inner_radius_mm", (40, 60, 5))
WALLS = ("wall_thickness_mm", (1.4, 1.8, 0.2))
TARGET = 99.865


@pytest.fixture(scope="module")
def submission(tmp_path_factory):
    """Return the published study, checked."""
    path = tmp_path_factory.mktemp("study") / "study.xlsx"
    path.write_bytes(template_bytes(published()))
    return check(path)


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """Return the path of a report with a sweep over one dimension, one over two, and one with impossible points."""
    folder = tmp_path_factory.mktemp("report")
    (folder / "study.xlsx").write_bytes(template_bytes(published()))
    outcome = asked(
        run(folder / "study.xlsx", jobs=1),
        sweep_row(THIRD, LENGTHS),
        sweep_row(THIRD, HUBS, WALLS),
        sweep_row("B3-160 case 1", ("disk_inner_radius_mm", (60, 100, 20))),
    )
    path = folder / "report.xlsx"
    path.write_bytes(report_bytes(outcome))
    assert report_bytes(outcome) == path.read_bytes()
    return path


@pytest.fixture(scope="module")
def sheet(report):
    """Return the sheet."""
    return openpyxl.load_workbook(report)["Sweep"]


def _texts(sheet):
    return [cell.value for row in sheet.iter_rows() for cell in row if isinstance(cell.value, str)]


def _row_of(sheet, text):
    return next(row[0].row for row in sheet.iter_rows(max_col=1) if row[0].value == text)


@pytest.mark.slow
def test_the_sentences_and_the_table(sheet):
    """Length may be at most 161.85 mm; the table below has the printed numbers in its rows."""
    texts = _texts(sheet)
    assert f"{THIRD}: cylinder length from 100 to 200 mm" in texts
    assert "Cylinder length must be at most 161.85 mm for 99.865 % of units within 3.8′." in texts
    crossed = "the nominal backlash at 168.58 mm, P97.5 at 164.09 mm, P99.865 at 161.85 mm"
    assert f"3.8′ is crossed by {crossed}." in texts
    first = _row_of(sheet, "Cylinder length [mm]") + 1
    rows = [[sheet.cell(first + place, column).value for column in (1, 2)] for place in range(6)]
    assert [value for value, _ in rows] == [100, 120, 140, 160, 180, 200]
    assert [round(backlash, 3) for _, backlash in rows] == [2.897, 3.160, 3.424, 3.687, 3.950, 4.214]


@pytest.mark.slow
def test_the_band_the_limit_and_the_crossings_are_in_the_chart(report, submission):
    """What is stacked adds up to P2.5, P97.5 and P99.865 at each point; the limit is a line; crossings are marked."""
    (study,) = swept(submission, sweep_row(THIRD, LENGTHS))
    chart = chart_titled(report, f"Backlash of {THIRD}")
    book = openpyxl.load_workbook(report)["Swept"]
    headings = {cell.value: cell.column_letter for cell in book[2]}
    places = grid_of(study).places
    last = 2 + len(places)

    def column(what):
        letter = headings[f"1 {what}"]
        return points_of(chart, f"Swept!${letter}$3:${letter}${last}")

    stacked = [column(what) for what in ("P2.5", "P2.5 to P97.5", "P97.5 to P99.865")]
    keys = ("p2_5_arcmin", "p97_5_arcmin", "p99_865_arcmin")
    for point in study.results.iter_rows(named=True):
        place = places.index(point["cylinder_length_mm"])
        sums = [sum(one[place] for one in stacked[:count]) for count in (1, 2, 3)]
        assert sums == pytest.approx([point[key] for key in keys], abs=1e-12)
    assert set(column("Limit").values()) == {3.8}
    for what, value in (("nominal", 168.58), ("P97.5", 164.09), ("P99.865", 161.85)):
        ((place, height),) = column(f"{what} crosses").items()
        assert height == 3.8
        assert places[place] == pytest.approx(value, abs=0.5 * 100 / (len(places) - 1))
        assert f"{'Nominal' if what == 'nominal' else what} crosses at {value:g} mm" in chart


@pytest.mark.slow
def test_the_contour_parts_what_meets_the_limit(sheet):
    """A thick border stands between two cells if and only if one of them is above the limit and one below."""
    top = _row_of(sheet, "Disk inner radius [mm]") + 1
    numbers = {(row, column): sheet.cell(top + row, 2 + column) for row in range(5) for column in range(3)}
    borders = 0
    for (row, column), cell in numbers.items():
        for side, other in (("right", (row, column + 1)), ("bottom", (row + 1, column))):
            if other in numbers:
                crosses = (cell.value <= 3.8) != (numbers[other].value <= 3.8)
                assert (getattr(cell.border, side).style == "thick") == crosses, (cell.coordinate, side)
                borders += crosses
    assert borders == 5
    below = [sheet.cell(top + 7, 2 + column).value for column in range(3)]
    assert below == ["≥ 54.365", "≥ 45.836", "≥ 40.37"]


@pytest.mark.slow
def test_impossible_points_have_no_numbers(sheet):
    """The rows of hubs outside the disk are there, blank but for what is wrong; a sentence counts them."""
    texts = _texts(sheet)
    wrong = "Disk inner radius r_ci = 80 mm: less than the disk's outer radius 80 mm is required."
    assert f"2 of 3 points are not computed: E303 {wrong}" in texts
    row = next(cell.row for line in sheet.iter_rows() for cell in line if cell.value == f"E303 {wrong}")
    assert [sheet.cell(row, column).value for column in range(1, 10)] == [80] + [None] * 8


@pytest.mark.slow
@needs_validator
def test_excel_opens_it(report):
    """The workbook is sound Open XML."""
    assert faults_of(report) == []


@pytest.mark.slow
def test_no_sweep_no_sheet(study):
    """A report that nobody asked a study of has neither the sheet nor its stored numbers."""
    with zipfile.ZipFile(study[1]) as archive:
        names = archive.read("xl/workbook.xml").decode()
    assert 'name="Sweep"' not in names
    assert 'name="Swept"' not in names


@pytest.mark.slow
def test_the_summary_says_it_and_leads_there(report):
    """What length is still allowed stands on the Summary, beside a link to the sheet."""
    summary = openpyxl.load_workbook(report)["Summary"]
    row = next(cell.row for (cell,) in summary.iter_rows(max_col=1) if cell.value == "Sweep")
    assert summary.cell(row, 1).hyperlink.location == "Sweep!A1"
    assert summary.cell(row, 2).value == (
        f"{THIRD}: Cylinder length must be at most 161.85 mm for 99.865 % of units within 3.8′. "
        "B3-160 case 1: With disk inner radius 60 mm, 99.865 % of units are within 3.8′. "
        "1 more study on the sheet Sweep."
    )


SENTENCES = {
    ("B3-160 case 1", LENGTHS): "Cylinder length may grow to 161.85 mm for 99.865 % of units within 3.8′.",
    (THIRD, ("cylinder_length_mm", (100, 120, 20))): (
        "Every computed cylinder length from 100 to 120 mm keeps 99.865 % of units within 3.8′."
    ),
    (THIRD, ("cylinder_length_mm", (180, 200, 20))): (
        "No computed cylinder length from 180 to 200 mm keeps 99.865 % of units within 3.8′."
    ),
    (THIRD, ("disk_inner_radius_mm", (30, 90, 10))): (
        "Disk inner radius must be at least 45.836 mm for 99.865 % of units within 3.8′."
    ),
    (THIRD, ("disk_thickness_mm", (1.6, 3, 0.2))): (
        "Disk thickness must be at least 2.3455 mm for 99.865 % of units within 3.8′."
    ),
}


@pytest.mark.slow
def test_what_is_allowed_is_said(submission):
    """Nothing, all, up to a value, from a value on: rounded so that the value told is allowed itself."""
    for (variant, dimension), sentence in SENTENCES.items():
        (study,) = swept(submission, sweep_row(variant, dimension))
        assert allowed_sentence(study, TARGET, ARC_MINUTES) == sentence
        assert sentence in study_sentences(study, TARGET, ARC_MINUTES)


@pytest.mark.slow
def test_two_dimensions_say_how_to_read_them(submission):
    """The sentence names the number in the cells; the cell below each column what is allowed."""
    (study,) = swept(submission, sweep_row(THIRD, HUBS, ("wall_thickness_mm", (1.6, 2.4, 0.8))))
    assert study_title(study) == f"{THIRD}: disk inner radius from 40 to 60 mm and wall thickness from 1.6 to 2.4 mm"
    assert study_sentences(study, TARGET, ARC_MINUTES)[0].startswith(
        "Each cell is P99.865, the backlash that 99.865 % of units"
    )
    assert [allowed_words(study, TARGET, second) for second in (1.6, 2.4)] == ["≥ 45.836", "all"]
