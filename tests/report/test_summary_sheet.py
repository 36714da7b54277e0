"""The Summary sheet: one printed page, its table and chart, links that lead somewhere, texts that fit."""

from __future__ import annotations

import itertools
import math
import re
import statistics
import subprocess
import zipfile

import openpyxl
import pytest
import regenerate
import xlsxwriter
from libreoffice import convert_all, needs_pages
from report_entries import opened
from said import said_of

from flexlash.pipeline import run
from flexlash.report.failing.failing_places import FAILING
from flexlash.report.layout.styles import PALETTE, Book
from flexlash.report.layout.wrapping import LINE_HEIGHT, lines_of
from flexlash.report.report_data import drawn_variants, report_data
from flexlash.report.summary.relative_bars import relative_bars
from flexlash.report.summary.summary_chart import CHARTED
from flexlash.report.summary.summary_sheet import write_summary
from flexlash.report.wording.verdict import verdict_rules, verdict_word
from flexlash.schema.entry_words import dimension_words
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.number_words import brief_share

_ASCENT_AND_DESCENT = 1.22
"""Height of a word's box over the size of its letters, in Calibri and Carlito."""

FILLS = {"fails": "FFF8CBAD", "marginal": "FFFFE699", "meets": "FFC6E5D8"}
NUMBERS = ("backlash_limit_arcmin", "backlash_arcmin", "p97_5_arcmin", "p99_865_arcmin")
KEY_FIGURES = (1, 2, 6, 9, 11)
"""Columns of the key figures, in the sixth row above their captions."""


def _row(sheet, words):
    """Return the number of the row whose first cell holds these words."""
    return next(row for row in range(1, sheet.max_row + 1) if sheet.cell(row, 1).value == words)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return the folder of this module's reports."""
    return tmp_path_factory.mktemp("summary")


def _many(count, first=700.0):
    """Return variants from within to far over a limit; every seventh is a hat, every fifth has none."""
    rows = []
    for number in range(count):
        row = {"variant": f"V{number:04d} of a study", "flexspline_type": "cup", "material": "20Cr2Ni4"}
        row |= {"torque_Nm": first + 400 * number / count, "cylinder_length_mm": 160, "mean_radius_mm": 80}
        row |= {"wall_thickness_mm": 1.6, "disk_inner_radius_mm": 40, "disk_outer_radius_mm": ""}
        row["backlash_limit_arcmin"] = "" if number % 5 == 4 else 3.75
        if number % 7 == 6:
            row |= {"flexspline_type": "hat", "disk_inner_radius_mm": "", "disk_outer_radius_mm": 100}
        rows.append(row)
    return rows


def test_key_figures_and_their_rule(study):
    """Computed, verdicts and findings stand in words above their rule; only what occurs is coloured."""
    sheet = opened(study[1])["Summary"]
    places = KEY_FIGURES
    assert [sheet.cell(5, place).value for place in places] == [
        "11 of 11",
        "3 fail",
        "0 marginal",
        "8 meet",
        "5 warnings",
    ]
    captions = [sheet.cell(6, place).value for place in places]
    assert captions == ["variants computed", *verdict_rules(VerdictBounds()).values(), "see Findings"]
    fills = [sheet.cell(5, place).fill.fgColor.rgb for place in places]
    assert fills == ["00000000", FILLS["fails"], "00000000", FILLS["meets"], "00000000"]


def test_every_sentence_stands_beside_its_topic(study):
    """The sheet holds every sentence, merged across the table and as high as its lines."""
    outcome, path = study
    sheet = opened(path)["Summary"]
    merged = {str(area) for area in sheet.merged_cells.ranges}
    for topic, text in said_of(outcome).items():
        row = _row(sheet, topic)
        assert sheet.cell(row, 2).value == text
        assert f"B{row}:L{row}" in merged
        assert sheet.cell(row, 2).alignment.wrap_text
        width = sum(sheet.column_dimensions[letter].width for letter in "BCDEFGHIJKL")
        assert sheet.row_dimensions[row].height >= LINE_HEIGHT * lines_of(text, width)


def _listed(sheet):
    """Return the rows of the table."""
    first = _row(sheet, "Variant") + 1
    return list(itertools.takewhile(lambda row: sheet.cell(row, 2).value is not None, range(first, sheet.max_row)))


def test_the_table_holds_the_worst_with_their_numbers(study):
    """Each row repeats a variant's results beside what first order, worst case and normal theory say, worst first."""
    outcome, path = study
    sheet = openpyxl.load_workbook(path, data_only=True)["Summary"]
    rows = _listed(sheet)
    assert len(rows) >= 3
    for row, one in zip(rows, drawn_variants(outcome), strict=False):
        cells = [sheet.cell(row, place) for place in range(1, 13)]
        name, verdict, *numbers, excess, first_order, worst, share, normal, cause = (cell.value for cell in cells)
        result = one.row
        assert name == result["variant"]
        assert verdict == verdict_word(result, VerdictBounds())
        assert cells[1].fill.fgColor.rgb == FILLS[verdict]
        assert numbers == [pytest.approx(result[key], rel=1e-15) for key in NUMBERS]
        assert excess == pytest.approx(result["p99_865_arcmin"] - result["backlash_limit_arcmin"], rel=1e-12)
        assert first_order == pytest.approx(result["mean_arcmin"] + 3 * result["first_order_sd_arcmin"], rel=1e-12)
        assert worst == pytest.approx(result["worst_case_high_arcmin"], rel=1e-12)
        assert share == brief_share(result)
        z = (result["backlash_limit_arcmin"] - result["mean_arcmin"]) / result["sd_arcmin"]
        below = statistics.NormalDist().cdf(z)
        assert normal == ("practically all" if z < -8 else f"{100 * (1 - below):.3g} %" if z < 0 else normal)
        main = dimension_words(result["main_contributor"])
        assert cause == f"{main} ({100 * result['main_contributor_share']:.0f} %)"


def test_one_cell_turns_angles_into_arc_seconds(study):
    """Every angle of the table is a formula on the unit's cell, stored as arcmin; the Explorer's unit follows it."""
    book = openpyxl.load_workbook(study[1])
    sheet = book["Summary"]
    assert sheet["L2"].value == "arcmin"
    assert '"arcmin,arcsec"' in {str(one.formula1) for one in sheet.data_validations.dataValidation}
    for row in _listed(sheet):
        for place in range(3, 10):
            assert re.fullmatch(r'=IF\(\$L\$2="arcsec",60,1\)\*.+', sheet.cell(row, place).value)
    assert book["Explorer"]["B5"].value == "=Summary!$L$2"
    assert openpyxl.load_workbook(study[1], data_only=True)["Explorer"]["B5"].value == "arcmin"


@pytest.mark.slow
def test_links_lead_to_their_variants(table, sound, tmp_path):
    """A name leads to the page that bears it, that of one that meets its limit to Explorer; Findings to its sheet."""
    rows = [{**sound, "variant": "bad", "torque_Nm": ""}, {**sound, "variant": "good", "backlash_limit_arcmin": 30.0}]
    failing = {**sound, "backlash_limit_arcmin": 2.0}
    called = ("=1+1", "x" * 90)
    rows += [{**failing, "variant": name, "torque_Nm": 700 + place} for place, name in enumerate(called)]
    outcome = run(table(rows), tmp_path / "report.xlsx", samples=64)
    book = opened(tmp_path / "report.xlsx")
    sheet = book["Summary"]
    first, met = _row(sheet, "Variant") + 1, []
    for row, one in enumerate(drawn_variants(outcome), start=first):
        link, names = sheet.cell(row, 1).hyperlink, [sheet.cell(row, 1).value]
        assert link.target is None
        if sheet.cell(row, 2).value.startswith("meets"):
            met.append(one.row["variant"])
            assert link.location == "Explorer!B4"
        else:
            title, cell = link.location.split("!")
            assert title == f"'{FAILING}'"
            names.append(book[FAILING][cell].value)
        for name in names:
            start, _, end = name.partition("…")
            assert one.row["variant"].startswith(start)
            assert one.row["variant"].endswith(end)
        assert sheet.cell(row, 1).data_type == "s"
    assert met == ["good"]
    title = sheet.cell(_row(sheet, "Findings"), 1).hyperlink.location.split("!")[0]
    assert title in book.sheetnames


def test_distances_are_the_same_in_sentence_and_table(study):
    """What a sentence says a failing variant is over its limit by is what its row of the table shows."""
    sheet = openpyxl.load_workbook(study[1], data_only=True)["Summary"]
    cells = [sheet.cell(row, 7) for row in _listed(sheet)[:3]]
    shown = [f"{cell.value:.{len(cell.number_format.split(';')[0].partition('.')[2])}f}" for cell in cells]
    assert re.findall(r"([\d.]+)′ over", sheet.cell(_row(sheet, "Which fail"), 2).value) == shown
    assert shown == ["2.512", "0.514", "0.169"]


@pytest.mark.slow
def test_verdicts_of_few_points_have_a_mark(folder, table, sound):
    """By 64 draws eight variants meet with a ? in cell and key figure, in the same colour, and shares an ≈."""
    study = regenerate.ROOT / "data" / "b3-160-study.xlsx"
    run(study, folder / "few.xlsx", method="random", samples=64)
    sheet = opened(folder / "few.xlsx")["Summary"]
    assert [sheet.cell(5, place).value for place in KEY_FIGURES[1:4]] == ["3 fail", "0 marginal", "8 meet?"]
    assert sheet.cell(6, 9).value == f"{verdict_rules(VerdictBounds())['meets']}; 8 not settled"
    assert sheet.cell(5, 9).fill.fgColor.rgb == FILLS["meets"]
    rows = _listed(sheet)
    cells = [sheet.cell(row, 2) for row in rows]
    assert [cell.value for cell in cells] == ["fails"] * 3 + ["meets?"] * (len(rows) - 3)
    assert {cell.fill.fgColor.rgb for cell in cells[3:]} <= {FILLS["meets"]}
    run(table([{**sound, "backlash_limit_arcmin": 30.0}]), folder / "one of few.xlsx", method="random", samples=64)
    alone = opened(folder / "one of few.xlsx")["Summary"]
    cell = alone.cell(_listed(alone)[0], 2)
    assert (cell.value, cell.fill.fgColor.rgb) == ("meets?", FILLS["meets"])
    assert sheet.cell(rows[0], 12).value == "Young's modulus (≈68 %)"


def test_further_sheets_and_a_line_to_sign(study):
    """Below the table a link leads to Explorer, one to Trace if it is seen; the page ends with room for a name."""
    book = opened(study[1])
    sheet = book["Summary"]
    row = _row(sheet, "Pick a variant in")
    assert sheet.cell(row, 2).hyperlink.location == "Explorer!A1"
    assert (sheet.cell(row, 3).hyperlink is not None) == (book["Trace"].sheet_state == "visible")
    assert re.fullmatch(r"Reviewed by _+   Date _+", sheet.cell(sheet.max_row, 1).value)
    assert sheet.print_area.endswith(f"$L${sheet.max_row}")


@pytest.mark.slow
def test_numbers_have_no_separators(study, folder, table, sound):
    """However many lines or points there are, thousands are written in one way on the whole page."""
    run(table([sound]), folder / "many points.xlsx", method="sobol")
    for path in (study[1], folder / "many points.xlsx"):
        rows = opened(path, data_only=True)["Summary"].iter_rows(values_only=True)
        texts = [value for row in rows for value in row if isinstance(value, str)]
        assert not any(re.search(r"\d,\d", text) for text in texts)
    assert any("32768 points per variant" in text for text in texts)


@pytest.mark.slow
def test_long_names_of_the_table_stay_apart(table, sound, tmp_path):
    """Names that begin alike are cut in their middle, so that each row of the table has its own."""
    names = [f"A Name That Is The Same For Thirty Letters, Wall {wall} mm" for wall in ("1.6", "1.7", "1.8")]
    run(table([{**sound, "variant": name} for name in names]), tmp_path / "report.xlsx", samples=64)
    sheet = opened(tmp_path / "report.xlsx")["Summary"]
    first = _row(sheet, "Variant") + 1
    labels = [sheet.cell(row, 1).value for row in range(first, first + 3)]
    assert len(set(labels)) == 3
    assert all(re.fullmatch(r"A Name[^…]*…[^…]*1\.[678] mm", label) for label in labels)
    width = sheet.column_dimensions["A"].width
    assert all(lines_of(label, width) == 1 for label in labels)


def test_where_the_numbers_come_from(study):
    """Name, date, sha256, version, method, seed and lines stand on the page; nothing of the time of the run."""
    outcome, path = study
    texts = "\n".join(str(cell.value) for row in opened(path)["Summary"].iter_rows() for cell in row if cell.value)
    assert "Submission b3-160-study.xlsx; last changed 2026-01-01" in texts
    assert f"sha256 {outcome.submission.sha256}" in texts
    assert re.search(r"flexlash \d+\.\d+\.\d+, method line, seed 0, \d+ (to \d+ )?lines per variant\.", texts)


@pytest.mark.slow
def test_a_file_without_a_date_has_none(table, sound, tmp_path):
    """A table has no date of its own, so none is told."""
    run(table([sound]), tmp_path / "report.xlsx", samples=64)
    sheet = opened(tmp_path / "report.xlsx")["Summary"]
    texts = [str(cell.value) for cell in sheet["A"] if cell.value]
    assert "Submission submission.csv" in texts
    assert not any("last changed" in text for text in texts)


def _chart(path):
    """Return the text of the Summary's chart."""
    with zipfile.ZipFile(path) as archive:
        return archive.read("xl/charts/chart1.xml").decode()


def test_the_chart_shows_a_narrow_spread_beside_the_limit(study):
    """Bars are in per cent of the limit, by verdict, on a scale of ten per cent; who is beyond stands at its end."""
    outcome, path = study
    drawn = drawn_variants(outcome)
    text = _chart(path)
    assert [float(re.search(rf'<c:{end} val="([^"]+)"', text)[1]) for end in ("min", "max")] == [-10, 10]
    bars = opened(path)["Bars"]
    headings = [cell.value for cell in bars[2]]
    for number, one in enumerate(drawn, start=3):
        told = dict(zip(headings, (cell.value for cell in bars[number]), strict=False))
        result, limit = one.row, one.row["backlash_limit_arcmin"]
        low, median, high, top = (
            100 * (result[f"{key}_arcmin"] - limit) / limit for key in ("p2_5", "p50", "p97_5", "p99_865")
        )
        verdict = verdict_word(result, VerdictBounds())
        if abs(median) > 10:
            assert told["above" if median > 0 else "below"] == math.copysign(10, median)
            assert told["off"] == pytest.approx(median, abs=0.05)
            assert told[verdict] is None
        else:
            assert told[verdict] == pytest.approx(median)
            assert told[verdict] - told["down"] == pytest.approx(max(low, -10))
            assert told[verdict] + told["up"] == pytest.approx(min(high, 10))
            assert told["P99.865"] == pytest.approx(top)
    for verdict, colour, mark in (("fails", "dark red", "diamond"), ("meets", "blue", "circle")):
        series = next(
            one for one in re.findall(r"<c:ser>.*?</c:ser>", text, re.DOTALL) if f"<c:v>{verdict}</c:v>" in one
        )
        assert PALETTE[colour].strip("#") in re.search(r"<c:errBars>.*?</c:errBars>", series, re.DOTALL)[0]
        assert f'<c:symbol val="{mark}"/>' in series


@pytest.mark.slow
def test_more_variants_than_fit_are_said(table, tmp_path, monkeypatch):
    """The table lists the worst that fit and the chart the sixty worst; both say of how many, not of how many drawn."""
    monkeypatch.setattr("flexlash.report.report_data.DRAWN", 70)
    run(table(_many(80)), tmp_path / "report.xlsx", samples=64)
    texts = [str(cell.value) for cell in opened(tmp_path / "report.xlsx")["Summary"]["A"] if cell.value]
    assert any(re.match(r"The \d+ worst of 80 are listed; all are in Results\.", text) for text in texts)
    shown = int(re.search(r": the (\d+) worst of 80<", _chart(tmp_path / "report.xlsx"))[1])
    assert 50 < shown <= 60


@pytest.mark.slow
def test_nothing_computed_still_has_a_page(table, sound, tmp_path):
    """A submission without a computed row has its Summary without table, chart and link to a variant."""
    outcome = run(table([{**sound, "torque_Nm": ""}]))
    path = _alone(outcome, report_data(outcome), tmp_path / "report.xlsx", 9)
    values = [cell.value for cell in opened(path)["Summary"]["A"]]
    assert "0 of 1" in values
    assert "Variant" not in values


def _alone(outcome, data, path, paper):
    """Write the Summary of an outcome, what it draws on and what it leads to, for paper of this number."""
    with xlsxwriter.Workbook(str(path)) as workbook:
        book = Book(workbook)
        bars = relative_bars(data.drawn, outcome.settings.verdict_bounds, CHARTED)
        write_summary(book, outcome, data, bars)
        workbook.get_worksheet_by_name("Summary").set_paper(paper)
        bars.write(book, "")
        workbook.add_worksheet("Results")
        workbook.add_worksheet("Findings")
    return path


def _words(document):
    """Return the letters of a document's first page cell by cell, without spaces."""
    command = ["pdftotext", "-l", "1", document, "-"]
    return "".join(subprocess.run(command, check=True, capture_output=True, text=True).stdout.split())


@pytest.mark.slow
@needs_pages
def test_the_summary_prints_whole_on_one_page_of_either_paper(study, table, sound, tmp_path, monkeypatch):
    """On A4 and Letter the Summary is one page that holds every sentence whole, to its last line, in readable size."""
    folder = regenerate.ROOT / "data"
    long = [{**row, "variant": f"{row['variant']} {'W' * 60}"} for row in _many(20)]
    sources = {
        "catalogue": folder / "catalogue-sizes.xlsx",
        "few": folder / "b3-160-study.xlsx",
        "fixing": folder / "needs-fixing.xlsx",
        "one": table([sound], "one.csv"),
        "many": table(_many(600), "many.csv"),
        "long": table(long, "long.csv"),
    }
    # As many curves as the chart can hold.
    monkeypatch.setattr("flexlash.report.report_data.DRAWN", 70)
    few = {"method": "random", "samples": 64}
    outcomes = {name: run(source, **(few if name == "few" else {})) for name, source in sources.items()}
    outcomes["study"] = study[0]
    data = {name: report_data(outcome) for name, outcome in outcomes.items()}
    papers = {9: r"595\.\d+ x 841\.\d+", 1: "612 x 792"}
    asked = [(paper, name) for paper in papers for name in outcomes]
    paths = [_alone(outcomes[name], data[name], tmp_path / f"{paper}-{name}.xlsx", paper) for paper, name in asked]
    for (paper, name), document in zip(asked, convert_all(paths, "pdf", tmp_path), strict=True):
        facts = subprocess.run(["pdfinfo", document], check=True, capture_output=True, text=True).stdout
        assert re.search(rf"Page size: +{papers[paper]}", facts)
        # pdftotext drops a hyphen at which a line ends.
        page = _words(document).replace("-", "")
        for topic, text in said_of(outcomes[name]).items():
            for line in text.split("\n"):
                assert "".join(line.split()).replace("-", "") in page, topic
        assert "Maincontributor" in page
        assert "Methodandlimitsofthemodel:sheetAbout." in page
        assert "Reviewedby____" in page
        assert _text_size(document) > 7


def _text_size(document):
    """Return the size [pt] of the topics on a page, which is that of the sentences."""
    command = ["pdftotext", "-bbox", "-l", "1", document, "-"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    heights = re.findall(r'yMin="([\d.]+)" xMax="[\d.]+" yMax="([\d.]+)">(?:What|Computed)<', text)
    return min(float(high) - float(low) for low, high in heights) / _ASCENT_AND_DESCENT
