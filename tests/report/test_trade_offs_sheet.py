"""The sheet Trade-offs shows the decided numbers, and its charts draw the cells beside them."""

from __future__ import annotations

import io
import re
import zipfile

import openpyxl
import pytest
import xlsxwriter
from filled import SOUND, filled

from flexlash.decisions.spider import SPIDER_CHANGES, spider_of
from flexlash.decisions.trade_offs import trade_offs
from flexlash.pipeline import run
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import drawn_variants
from flexlash.report.tradeoffs.spider_block import SPIDER_ROWS
from flexlash.report.tradeoffs.trade_offs_sheet import SHEET, write_trade_offs
from flexlash.schema.units import ARCMIN

_LENGTHS = (100.0, 160.0, 200.0)


def _made(tmp_path, rows, **filling):
    """Return outcome, drawn variants, the sheet and the charts as XML of a submission of these rows."""
    submission = tmp_path / "submission.xlsx"
    submission.write_bytes(filled(rows, **filling))
    outcome, buffer = run(submission), io.BytesIO()
    drawn = drawn_variants(outcome)
    with xlsxwriter.Workbook(buffer, {"in_memory": True}) as workbook:
        workbook.add_worksheet("Summary")
        write_trade_offs(Book(workbook), outcome, drawn)
    with zipfile.ZipFile(buffer) as archive:
        charts = [archive.read(name).decode() for name in archive.namelist() if name.startswith("xl/charts/chart")]
    book = openpyxl.load_workbook(buffer)
    return outcome, drawn, book[SHEET] if SHEET in book.sheetnames else None, charts


def _cups():
    return [
        {**SOUND, "variant": f"l {length:g}, wall {wall}", "cylinder_length_mm": length, "wall_thickness_mm": wall}
        for length in _LENGTHS
        for wall in (1.6, 1.8)
    ]


def _table(sheet):
    """Return the rows of the table by heading, and the row of the sheet on which the first stands."""
    (top,) = (cell.row for cell in sheet["A"] if cell.value == "Variant")
    headings = {sheet.cell(top, column).value: column for column in range(1, 12)}
    rows = []
    for row in range(top + 1, sheet.max_row + 1):
        if sheet.cell(row, 2).value is None:
            break
        rows.append({heading: sheet.cell(row, column).value for heading, column in headings.items() if heading})
    return rows, top + 1


def test_the_table_has_the_numbers_of_results_and_of_the_trade_offs(tmp_path):
    """Each variant has its verdict, backlash, mass and cost, worst first; the fronts are those that are decided."""
    rows, levers = _cups(), [{"dimension": "wall_thickness", "cost_per_step": 2.0}]
    outcome, drawn, sheet, _ = _made(tmp_path, rows, levers=levers)
    table, _ = _table(sheet)
    computed = [one.computed for one in drawn]
    quantiles = [one.row["p99_865_arcmin"] * ARCMIN for one in drawn]
    base = [one.variant.row for one in computed].index(min(one.variant.row for one in computed))
    offers = trade_offs(computed, quantiles, outcome.validated.levers, base)
    assert [row["Variant"] for row in table] == [one.row["variant"] for one in drawn]
    for row, one, offer in zip(table, drawn, offers, strict=True):
        assert row["P99.865 [arcmin]"] == pytest.approx(one.row["p99_865_arcmin"], rel=1e-12)
        assert row["Nominal [arcmin]"] == pytest.approx(one.row["backlash_arcmin"], rel=1e-14)
        assert row["Mass [kg]"] == pytest.approx(offer.mass, rel=1e-12)
        assert row["Relative cost"] == pytest.approx(offer.cost, rel=1e-12)
        assert row["On the front of mass"] == ("yes" if offer.light else "no")
        assert row["On the front of cost"] == ("yes" if offer.cheap else "no")
    assert {row["On the front of mass"] for row in table} == {"yes", "no"}


def test_charts_draw_every_variant_and_name_the_front(tmp_path):
    """The first chart has as many points as there are variants, and the names of those on the front."""
    _, drawn, sheet, charts = _made(tmp_path, _cups())
    table, first = _table(sheet)
    on = {row["Variant"] for row in table if row["On the front of mass"] == "yes"}
    named = set(re.findall(r"<a:t>(l [^<]+)</a:t>", charts[0]))
    assert named == on
    last = first + len(drawn) - 1
    assert f"'{SHEET}'!$G${first}:$G${last}" in charts[0]
    assert len(charts) == 1 + 3


def test_a_spider_stands_for_each_of_the_three_worst(tmp_path):
    """Below the table the worst variants have their lines at each change, and their limits as parts of the nominal."""
    _, drawn, sheet, _ = _made(tmp_path, _cups())
    table, first = _table(sheet)
    top = first + len(table) + 1
    for number, one in enumerate(drawn[:3]):
        block = top + number * (SPIDER_ROWS + 1)
        assert sheet.cell(block, 1).value.startswith(f"Each dimension of “{one.row['variant']}” alone")
        lines = spider_of(one.computed)
        points = block + SPIDER_ROWS - len(SPIDER_CHANGES)
        for row, change in enumerate(SPIDER_CHANGES):
            assert sheet.cell(points + row, 1).value == pytest.approx(change, abs=1e-15)
            told = [sheet.cell(points + row, column).value for column in range(2, 2 + len(lines))]
            assert told == pytest.approx([line.backlash[row] for line in lines], abs=1e-15)
        limit = sheet.cell(points, 2 + len(lines)).value
        assert limit == pytest.approx(3.75 / one.row["backlash_arcmin"] - 1, rel=1e-9)
    assert sheet.cell(top + 3 * (SPIDER_ROWS + 1), 1).value is None


def test_without_a_density_no_mass_is_told_and_the_sheet_says_so(tmp_path):
    """A material without a density leaves mass and front out, and the chart; the notes say why."""
    material = {"material": "light", "youngs_modulus_GPa": 70.0, "poisson_ratio": 0.33}
    rows = [{**SOUND, "variant": name, "material": "light"} for name in ("a", "b")]
    _, _, sheet, charts = _made(tmp_path, rows, materials=[material])
    table, _ = _table(sheet)
    assert [row["Mass [kg]"] for row in table] == [None, None]
    assert [row["On the front of mass"] for row in table] == ["–", "–"]
    notes = " ".join(str(sheet.cell(row, 1).value) for row in range(2, 6))
    assert "2 variants have no mass here, since the material has no density." in notes
    assert len(charts) == 2


def test_the_percentile_is_that_of_the_target(tmp_path):
    """By a target of 99.99 % the sheet tells that percentile, which lies beyond P99.865."""
    _, drawn, sheet, _ = _made(tmp_path, [SOUND], settings={"target_percent": 99.99})
    ((row,), _) = _table(sheet)
    assert row["P99.99 [arcmin]"] > drawn[0].row["p99_865_arcmin"]
