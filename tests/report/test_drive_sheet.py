"""The Drive sheet: its formulas come to the program's numbers, as submitted and after a reader's changes."""

from __future__ import annotations

import io

import openpyxl
import pytest
import xlsxwriter
from entry_books import entry_book
from libreoffice import convert_all, needs_libreoffice
from report_entries import error_cells, typed, values_of
from whole_drives import CASE_3, EVERY_KIND, GRINDING

from flexlash.analysis.drive_budget import budget_of, drive_shares
from flexlash.mechanics.catalogue_curve import catalogue_curve
from flexlash.pipeline import run
from flexlash.report.drive.drive_sheet import write_drive
from flexlash.report.drive.stored_drives import DRIVES_NOTE
from flexlash.report.layout.styles import Book
from flexlash.report.report_data import drawn_variants
from flexlash.schema.units import ARCMIN

VARIANTS = [
    CASE_3,
    CASE_3 | {"variant": "small", "mean_radius_mm": 40.6, "disk_inner_radius_mm": 20, "torque_Nm": 60},
    CASE_3 | {"variant": "no limit", "system_limit_arcmin": None, "cylinder_length_mm": 160},
    CASE_3 | {"variant": "size 100", "mean_radius_mm": 127, "torque_Nm": 4000},
    CASE_3 | {"variant": "unlisted", "mean_radius_mm": 10, "wall_thickness_mm": 0.5, "disk_inner_radius_mm": 5,
              "torque_Nm": 3, "cylinder_length_mm": 20},
]  # fmt: skip
RULES = ("mean", "rss_high", "bender_high", "mean_shift_high", "worst_case_high", "p99_865")


@pytest.fixture(scope="module")
def drive(tmp_path_factory):
    """Return the outcome of five variants with a source of every kind, and a workbook of Drive and Drives alone."""
    folder = tmp_path_factory.mktemp("drive")
    path = entry_book(folder / "a.xlsx", variants=VARIANTS, tolerances=GRINDING, other_sources=EVERY_KIND)
    outcome = run(path)
    assert outcome.counts["computed"] == len(VARIANTS), [found.message for found in outcome.findings]
    return outcome, _written(outcome, folder / "drive.xlsx")


def _written(outcome, path):
    """Write Drive and Drives alone."""
    buffer = io.BytesIO()
    workbook = xlsxwriter.Workbook(buffer)
    book = Book(workbook)
    stored = write_drive(book, outcome, drawn_variants(outcome))
    stored.write(book, DRIVES_NOTE)
    workbook.close()
    path.write_bytes(buffer.getvalue())
    return path


def _rows(values):
    """Return the rows of Drive by the text of their first cell, each as values by column; of several, the first."""
    sheet = {}
    for cell, value in values.items():
        letters = cell.rstrip("0123456789")
        sheet.setdefault(int(cell[len(letters) :]), {})[letters] = value
    rows = {}
    for _, row in sorted(sheet.items()):
        rows.setdefault(row.get("A"), row)
    return rows


def _assert_agrees(values, outcome, name):
    """Assert that the rules, shares and angles of the picked variant are the program's."""
    rows = _rows(values)
    result = outcome.results.filter(outcome.results["variant"] == name).row(0, named=True)
    names = ("Average (systematic)", "Root sum of squares", "Bender, 1.5 times that", "Mean shift",
             "Worst case", "Monte Carlo, P99.865")  # fmt: skip
    for rule, words in zip(RULES, names, strict=True):
        high = result[f"system_{rule}_arcmin"]
        assert rows[words]["G"] == pytest.approx(high, rel=1e-12), f"{name}: {rule}"
        limit = result["system_limit_arcmin"]
        assert rows[words].get("I") == (None if limit is None else pytest.approx(limit - high, abs=1e-9)), name
    budget = budget_of(outcome.validated, outcome.settings)
    shares = drive_shares(budget, result["mean_arcmin"] * ARCMIN, result["sd_arcmin"] * ARCMIN)
    for share in shares:
        row = rows["wind-up of the flexspline" if share.name == "wind-up" else share.name]
        told = (share.of_mean, share.of_variance, share.of_worst_case)
        assert [row[column] for column in "RST"] == pytest.approx(told, rel=1e-9), f"{name}: {share.name}"
    (computed,) = [one for one in outcome.computed.values() if one.variant.name == name]
    curve, torque = catalogue_curve(computed.nominal.mean_radius, 100), computed.variant.dimensions["torque"]
    if curve is not None and curve.third_stiffness is None:
        torque = min(torque, curve.second_torque)
    turned = 0.0 if curve is None else curve.angle(torque)
    assert rows["up to T"]["B"] == pytest.approx(turned, rel=1e-12), name
    assert rows["up to T"]["E"] == pytest.approx(rows["up to T"]["C"] / result["stiffness_Nm_per_rad"] / ARCMIN)


def test_stored_values_are_the_program_s(drive):
    """As it is written the sheet shows the worst variant, whose numbers are the program's, and no error."""
    outcome, path = drive
    values = values_of(path, "Drive")
    assert error_cells(values) == []
    _assert_agrees(values, outcome, values["B3"])


@pytest.mark.slow
@needs_libreoffice
def test_every_variant_and_a_reader_s_changes(drive, tmp_path):
    """Recalculated with each variant picked all formulas come to the program's; a changed deviation moves the rest."""
    outcome, path = drive
    names = [row["variant"] for row in VARIANTS]
    picked = [typed(path, tmp_path / f"{place}.xlsx", "Drive", {"B3": name}) for place, name in enumerate(names)]
    changed = typed(path, tmp_path / "changed.xlsx", "Drive", {"B3": names[0], "E8": 0.04, "B4": 0.0})
    *again, moved = convert_all([*picked, changed], "xlsx", tmp_path)
    for name, one in zip(names, again, strict=True):
        values = values_of(one, "Drive")
        assert error_cells(values) == [], name
        _assert_agrees(values, outcome, name)
    rows = _rows(values_of(moved, "Drive"))
    clearance = 0.02 / 80 / ARCMIN
    assert rows["tooth clearance"]["M"] == rows["tooth clearance"]["N"] == pytest.approx(clearance, rel=1e-12)
    assert rows["Mean shift"]["G"] == pytest.approx(rows["Root sum of squares"]["G"], rel=1e-12)


def test_without_other_sources_there_is_no_drive(tmp_path):
    """A submission without other sources, or with a faulty one, gets no sheet and no numbers of a drive."""
    faulty = [{"source": "play", "enter_as": "mm at radius", "upper_deviation": 1, "lower_deviation": 0}]
    for place, sources in enumerate(({}, {"other_sources": [*EVERY_KIND, *faulty]})):
        path = entry_book(tmp_path / f"{place}.xlsx", variants=[CASE_3], tolerances=GRINDING, **sources)
        outcome = run(path, tmp_path / f"{place}-report.xlsx")
        assert outcome.counts["computed"] == 1
        assert outcome.results["system_mean_arcmin"].to_list() == [None]
        assert "Drive" not in openpyxl.load_workbook(tmp_path / f"{place}-report.xlsx", read_only=True).sheetnames
