"""The printed pages of failing variants."""

from __future__ import annotations

import io
import re
import warnings
import zipfile

import openpyxl
import pytest
import xlsxwriter
from filled import SOUND, filled
from report_entries import opened

from flexlash.analysis import tolerance_spread
from flexlash.pipeline import run
from flexlash.report.failing.failing_places import FAILING, MOST_PAGES, PAGE_ROWS, failing_variants, variant_targets
from flexlash.report.failing.failing_sheet import write_failing
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import ROW, drawn_variants, report_data
from flexlash.schema.units import ARCMIN


@pytest.fixture(scope="module")
def pages(study):
    """Return the outcome of the study, its variants that miss their limit, and the sheet of their pages."""
    outcome, path = study
    return outcome, failing_variants(drawn_variants(outcome), outcome.settings.verdict_bounds), opened(path)[FAILING]


def _page(sheet, place):
    """Return the texts and numbers of a page by row, hidden rows left out."""
    rows = range(place * PAGE_ROWS + 1, (place + 1) * PAGE_ROWS + 1)
    return {
        row: [cell.value for cell in sheet[row] if cell.value is not None]
        for row in rows
        if not sheet.row_dimensions[row].hidden
    }


def test_each_failing_variant_has_a_page(pages):
    """Each variant that misses its limit has a page, worst first, with its name and its verdict as a word."""
    outcome, variants, sheet = pages
    missing = [row for row in outcome.results.iter_rows(named=True) if (row["probability_over_limit"] or 0) > 0.00135]
    assert {one.row["variant"] for one in variants} == {row["variant"] for row in missing}
    for place, one in enumerate(variants):
        heading = _page(sheet, place)[place * PAGE_ROWS + 1]
        word = "fails" if one.row["probability_over_limit"] > 0.025 else "marginal"
        assert heading == [one.row["variant"], word]
    assert [one.id for one in sheet.row_breaks.brk] == [place * PAGE_ROWS for place in range(1, len(variants))]


def test_a_page_says_what_is_compared_and_which_limits_were_used(pages):
    """Torque, limit and "full torque (2U)" stand below the name; limits are those of the drawing, in mm."""
    _, variants, sheet = pages
    for place, one in enumerate(variants):
        page = _page(sheet, place)
        told = str(page[place * PAGE_ROWS + 2][0])
        torque, limit = one.computed.variant.dimensions["torque"], one.row["backlash_limit_arcmin"]
        assert f"torque {torque:g} N·m · limit {limit:g}′ · compared at full torque (2U)" in told
        rows = {str(cells[0]): cells for cells in page.values() if cells}
        used = rows["Cylinder length l [mm]"]
        limits = one.computed.limits["cylinder_length"]
        numbers = [float(str(text)) for text in used[1:4]]
        expected = [one.computed.variant.dimensions["cylinder_length"], limits.low, limits.high]
        assert numbers == pytest.approx([1e3 * value for value in expected], abs=1e-9)
        assert used[5] == limits.scatters_between == "parts"
        assert rows["Young's modulus E [GPa]"][5] == "lots"


def test_a_page_has_the_cheapest_changes(study, pages):
    """No more than five changes stand on a page, those of the sheet Levers in its order, with the units still over."""
    _, path = study
    _, variants, sheet = pages
    levers = opened(path)["Levers"]
    for place, one in enumerate(variants):
        rows = [row for row in levers.iter_rows(values_only=True) if row[0] == one.row["variant"] and row[12]]
        page = [cells for cells in _page(sheet, place).values() if cells]
        begin = next(number for number, cells in enumerate(page) if cells[0] == "Cheapest changes, each alone") + 1
        shown = [cells[:2] for cells in page[begin:] if len(cells) > 2]
        assert shown == [[row[1], row[5]] for row in rows[:5]]
        assert shown


def test_a_page_draws_part_density_causes_and_segments(study, pages):
    """Each page has its part as a vector drawing and three native charts, each with a text for who cannot see them."""
    _, path = study
    _, variants, _ = pages
    with zipfile.ZipFile(path) as archive:
        names = archive.namelist()
        drawings = [archive.read(name).decode() for name in names if re.match(r"xl/drawings/drawing\d+\.xml", name)]
        drawing = next(text for text in drawings if "<xdr:pic>" in text)
        assert sum(name.endswith(".emf") for name in names) == len(variants)
    assert drawing.count("<xdr:pic>") == len(variants)
    assert drawing.count("<c:chart ") == 3 * len(variants)
    texts = re.findall(r'descr="([^"]+)"', drawing)
    assert len(texts) == 4 * len(variants)
    assert sum(text.startswith("Half-section of ") for text in texts) == len(variants)


def test_a_script_is_warned_of_the_drawings_alone(study, pages):
    """Opened by openpyxl to be changed, a report warns of each drawing that is left out; only read, of nothing."""
    pytest.importorskip("PIL")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        openpyxl.load_workbook(study[1])
    told = [str(one.message) for one in caught]
    assert told == ["wmf image format is not supported so the image is being dropped"] * len(pages[1])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        openpyxl.load_workbook(study[1], read_only=True).close()


def test_the_density_has_limit_nominal_and_mean(pages, study):
    """Behind the density stand the lines at the numbers of Results, and bins whose heights add up to all units."""
    _, variants, _ = pages
    stored = opened(study[1])["Pages"]
    headings = [cell.value for cell in stored[2]]
    for row, one in enumerate(variants, start=3):
        cells = dict(zip(headings, (cell.value for cell in stored[row]), strict=True))
        for line, key in (("Limit", "backlash_limit"), ("Nominal", "backlash"), ("Mean", "mean")):
            assert cells[f"{line} from"] == cells[f"{line} to"] == pytest.approx(one.row[f"{key}_arcmin"], rel=1e-14)
        bins = [(cells[f"Middle {n}"], cells[f"Within {n}"] or 0, cells[f"Over {n}"] or 0) for n in range(1, 41)]
        assert sum(within + over for _, within, over in bins) == pytest.approx(1, abs=0.01)
        assert all(over == 0 for middle, _, over in bins if middle <= one.row["backlash_limit_arcmin"])
        assert bins[0][0] >= one.curve.edges[0] / ARCMIN


def test_a_line_beyond_the_axis_is_told(pages, study):
    """A limit too far from the distribution to be drawn beside it stands in legend and alternative text with its side.

    The axis stays that of the distribution; a line that is drawn says nothing of a side.
    """
    _, path = study
    _, variants, _ = pages
    told = []
    with zipfile.ZipFile(path) as archive:
        names = [name for name in archive.namelist() if name.startswith("xl/charts/chart")]
        charts = [text for text in (archive.read(name).decode() for name in names) if "Share of units by" in text]
        drawings = "".join(archive.read(name).decode() for name in archive.namelist() if "drawings/drawing" in name)
    for one in variants:
        name, limit = one.row["variant"], one.row["backlash_limit_arcmin"]
        high, low = (float(one.curve.edges[place]) / ARCMIN for place in (-1, 0))
        is_far = not low - 3 * (high - low) <= limit <= high + 3 * (high - low)
        words = f"Limit {limit:g}′{', off to the left' * is_far}"
        (chart,) = [text for text in charts if f"Pages!$B${3 + len(told)}:" in text]
        assert f"{words}</c:v>" in chart
        assert re.search(rf'descr="{re.escape(name)}: histogram [^"]*; {words.lower()},', drawings)
        least = float(re.search(r'<c:min val="([\d.]+)"/>', chart)[1])
        assert (least <= limit) == (not is_far)
        told.append(is_far)
    assert set(told) == {True, False}


def _failing_parts(outcome):
    """Return every part of a workbook that has the pages of failing variants alone, by name."""
    buffer = io.BytesIO()
    with xlsxwriter.Workbook(buffer) as workbook:
        book = Book(workbook)
        write_failing(book, outcome, report_data(outcome)).write(book, "")
    with zipfile.ZipFile(buffer) as archive:
        return {name: archive.read(name) for name in archive.namelist() if not name.startswith("docProps")}


def test_the_pages_are_the_same_whatever_computes_them(tmp_path, monkeypatch):
    """Computed here at once, or by two worker processes row by row, the pages have the same bytes, drawings too."""
    rows = [{**SOUND, "variant": f"v{n}", "torque_Nm": 810.0 + 5 * n, "backlash_limit_arcmin": 3.7} for n in range(2)]
    path = tmp_path / "two.xlsx"
    path.write_bytes(filled(rows))
    here = _failing_parts(run(path, jobs=1))
    assert sum(name.endswith(".emf") for name in here) == len(rows)
    monkeypatch.setattr(tolerance_spread, "ROWS_PER_WORKER", 1)
    monkeypatch.setattr("flexlash.tolerance.row_batches._ROWS_PER_BATCH", 1)
    assert _failing_parts(run(path, jobs=2)) == here


@pytest.mark.slow
def test_no_more_than_ten_have_a_page_and_none_where_all_meet(tmp_path):
    """Of many that fail the ten worst have a page and the others lead to Explorer; where all meet there is no sheet."""
    rows = [{**SOUND, "variant": f"v{n}", "torque_Nm": 900 + n, "backlash_limit_arcmin": 0.5} for n in range(13)]
    path = tmp_path / "many.xlsx"
    path.write_bytes(filled(rows))
    outcome = run(path, tmp_path / "report.xlsx", samples=64, method="random")
    drawn = drawn_variants(outcome)
    targets = variant_targets(drawn, outcome.settings.verdict_bounds)
    assert [targets[one.row[ROW]].partition("!")[0] for one in drawn] == [FAILING] * MOST_PAGES + ["Explorer"] * 3
    path.write_bytes(filled([{**SOUND, "backlash_limit_arcmin": 60}]))
    run(path, tmp_path / "sound.xlsx", samples=64, method="random")
    assert FAILING not in openpyxl.load_workbook(tmp_path / "sound.xlsx").sheetnames
