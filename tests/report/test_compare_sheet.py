"""The Compare sheet: boxes that can be drawn without calculation, for one variant as for hundreds."""

from __future__ import annotations

import re
import subprocess
import zipfile

import openpyxl
import pytest
import xlsxwriter
from libreoffice import convert_all, needs_pages
from report_charts import chart_titled, points_of
from report_entries import opened

from flexlash.pipeline import run
from flexlash.report.compare.compare_sheet import BOXES, write_compare
from flexlash.report.compare.compared import COMPARED_NOTE, compared_variants
from flexlash.report.compare.contributions_sheet import write_contributions
from flexlash.report.compare.ranking_sheet import write_ranking
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import drawn_variants
from flexlash.schema.angle_unit import ARC_MINUTES

AROUND = "Spread around the median of each variant"


@pytest.fixture(scope="module")
def many(tmp_path_factory):
    """Return the outcome and the report of more variants than boxes can be read."""
    folder = tmp_path_factory.mktemp("many")
    lines = [
        "variant,material,torque_Nm,cylinder_length_mm,mean_radius_mm,wall_thickness_mm,disk_inner_radius_mm",
        *(f"a rather long name of variant {number},20Cr2Ni4,{700 + number},160,80,1.6,40" for number in range(60)),
    ]
    (folder / "many.csv").write_text("\n".join(lines), encoding="utf-8")
    return run(folder / "many.csv", folder / "report.xlsx", method="random", samples=64), folder / "report.xlsx"


def _cells(path, heading, last):
    """Return the range of a column of the data sheet, and the numbers in it."""
    sheet = opened(path)["Compared"]
    (place,) = [cell.column for cell in sheet[2] if cell.value == heading]
    letter = openpyxl.utils.get_column_letter(place)
    end = f":${letter}${last}" if last > 3 else ""
    return f"Compared!${letter}$3{end}", [sheet.cell(row, place).value for row in range(3, last + 1)]


def _texts(path):
    return " ".join(str(cell.value) for row in opened(path)["Compare"].iter_rows() for cell in row if cell.value)


@pytest.mark.parametrize(
    ("title", "heading"),
    [("Backlash and limit", heading) for heading in ("P25", "P25 to P50", "P50 to P75", "Limit")]
    + [("Backlash and limit", whisker) for whisker in ("P2.5 to P25", "P75 to P97.5")]
    + [(AROUND, heading) for heading in ("P25 less P50", "P75 less P50", "P2.5 to P25", "P75 to P97.5")],
)
def test_boxes_and_whiskers_carry_their_points(study, title, heading):
    """Every part of a box is stored in its chart with the numbers of the data sheet, one per variant."""
    outcome, path = study
    cells, numbers = _cells(path, heading, 2 + len(outcome.computed))
    assert points_of(chart_titled(path, title), cells) == pytest.approx(dict(enumerate(numbers)), rel=1e-15)


def test_boxes_stand_on_a_column_that_is_not_seen(study):
    """The lowest part of a box has neither fill nor border nor legend, and its error bar points down."""
    chart = chart_titled(study[1], "Backlash and limit")
    first = re.findall(r"<c:ser>.*?</c:ser>", chart)[0]
    assert "<c:spPr><a:noFill/><a:ln><a:noFill/></a:ln></c:spPr>" in first
    assert '<c:errBarType val="minus"/><c:errValType val="cust"/>' in first
    assert '<c:legendEntry><c:idx val="0"/><c:delete val="1"/></c:legendEntry>' in chart


def test_the_axis_holds_all_whiskers_and_limits(study):
    """The upright axis begins below and ends above everything drawn."""
    outcome, path = study
    rows = [one.row for one in drawn_variants(outcome)]
    axis = re.search(r"<c:valAx>.*?</c:valAx>", chart_titled(path, "Backlash and limit"))[0]
    low, high = (float(re.search(rf'<c:{end} val="(.*?)"/>', axis)[1]) for end in ("min", "max"))
    assert low < min(row["p2_5_arcmin"] for row in rows) < max(row["p97_5_arcmin"] for row in rows) < high
    assert low > 0
    assert all(low < row["backlash_limit_arcmin"] < high for row in rows)


@pytest.mark.slow
def test_the_worst_of_many_have_boxes(many):
    """Of more variants than can be read the worst have boxes, and the sheet says so; without limits no limit."""
    path = many[1]
    chart = chart_titled(path, "Backlash")
    cells, numbers = _cells(path, "P25", 2 + BOXES)
    assert points_of(chart, cells) == pytest.approx(dict(enumerate(numbers)), rel=1e-15)
    assert numbers == sorted(numbers, reverse=True)
    assert "Compared!$I$" not in chart
    assert _texts(path).startswith(
        "Variants side by side The 40 worst of 60 computed variants, worst first (Ranking lists 60)."
    )


@pytest.mark.slow
def test_a_single_variant_has_its_box(table, sound, tmp_path):
    """One variant alone is drawn, and not called all of them."""
    path = tmp_path / "report.xlsx"
    run(table([sound]), path, method="random", samples=64)
    cells, numbers = _cells(path, "P25 to P50", 3)
    assert points_of(chart_titled(path, "Backlash and limit"), cells) == {0: pytest.approx(numbers[0], rel=1e-15)}
    assert "The only computed variant. Each box" in _texts(path)


def test_charts_are_described(study):
    """Both charts have an alternative text that tells the worst variants in numbers."""
    with zipfile.ZipFile(study[1]) as archive:
        drawings = "".join(archive.read(one).decode() for one in archive.namelist() if "drawings/drawing" in one)
    described = re.findall(r'descr="(Boxes [^"]+)"', drawings)
    assert len(described) == 2
    assert "11 variants, worst first, with their limits: B3-160 case 5 from " in described[0]
    assert "less the median of each, in the same order: B3-160 case 5 " in described[1]
    assert all("; and 8 more" in text for text in described)


def _alone(outcome, path):
    """Write the three sheets of the comparison and what they lead to, which are printed sooner than a whole report."""
    drawn = drawn_variants(outcome)
    compared = compared_variants(drawn, ARC_MINUTES)
    with xlsxwriter.Workbook(path) as workbook:
        book = Book(workbook)
        write_compare(book, outcome, drawn, compared)
        write_ranking(book, outcome, drawn, compared)
        write_contributions(book, outcome, drawn, compared)
        compared.write(book, COMPARED_NOTE)
        workbook.add_worksheet("Results")
    return path


@pytest.mark.slow
@needs_pages
def test_the_comparison_prints_on_whole_pages(study, many, tmp_path):
    """Compare and Contributions print on one page each, Ranking of a few dozen rows on one or two."""
    paths = [_alone(outcome, tmp_path / f"{place}.xlsx") for place, (outcome, _) in enumerate((study, many))]
    for document in convert_all(paths, "pdf", tmp_path):
        text = subprocess.run(["pdftotext", document, "-"], check=True, capture_output=True, text=True).stdout
        footers = [line for page in text.split("\f") for line in set(page.splitlines())]
        assert (footers.count("Compare"), footers.count("Contributions")) == (1, 1)
        assert footers.count("Ranking") in {1, 2}
