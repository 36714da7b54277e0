"""The setting angle_unit: a report in arc seconds is that in arc minutes, each angle sixty times and every unit named.

Raw data keep their units: Results, what was submitted, Findings on it, and the worked steps of Trace.
"""

from __future__ import annotations

import re
import zipfile
from dataclasses import replace

import openpyxl
import pytest
from filled import filled
from libreoffice import convert
from report_entries import opened, typed
from whole_drives import CASE_3, EVERY_KIND, GRINDING

from flexlash.analysis.run_summary import detail_lines
from flexlash.cli.levers_lines import levers_lines
from flexlash.pipeline import run
from flexlash.report.page.page_facts import Found, page_facts
from flexlash.report.pictures.variant_charts import variant_charts
from flexlash.report.report_data import report_data
from flexlash.report.workbook import report_bytes

ROWS = [
    CASE_3,
    CASE_3 | {"variant": "short", "cylinder_length_mm": 120, "rated_torque_Nm": 400},
    CASE_3 | {"variant": "free", "material": "Ti-6Al-4V", "backlash_limit_arcmin": None, "system_limit_arcmin": None},
]
SWEEPS = [
    {"variant": "short", "dimension": "disk_inner_radius", "from": 35, "to": 50, "step": 5},
    {"variant": "B3-160 case 3", "dimension": "cylinder_length", "from": 150, "to": 250, "step": 50,
     "second_dimension": "disk_inner_radius", "second_from": 40, "second_to": 50, "second_step": 10},
]  # fmt: skip
RAW = frozenset({
    "Results", "Submission", "Materials", "Tolerances", "Other sources", "Sweep entered", "Settings", "Findings",
    "Levers", "Contributions", "Allocation", "Tolerances used", "Bars", "Curves", "Inputs", "Scatter",
    "Trace spread", "Trace steps", "Trace slope",
})  # fmt: skip
"""Sheets that tell no angle in the unit of the report: none at all, or those of a column with a unit of its own."""

ANGLES_OF = {
    "Summary": 15, "Failing variants": 0, "Explorer": 100, "Compare": 0, "Compared": 30, "Ranking": 30,
    "Sensitivity": 10, "Sections": 10, "Strength": 2, "Trade-offs": 10, "Drive": 60, "Drives": 20, "Sweep": 20,
    "Swept": 400, "Pages": 50, "Trace": 5,
}  # fmt: skip
"""The other sheets with a number of angles that each has at least."""

OWN_UNIT = {
    "Explorer": r'".*arcmin or arcsec.*',
    "Drive": "arcmin",
    "Trace": r"arcmin|N·m/arcmin|◄.*",
    "Sweep": r"[EW]\d{3} .*",
}
"""Texts that name arc minutes all the same: units to choose from, sources as entered, lines of Trace, findings."""

SCALES = {"Explorer": r"T2|O\d+"}
"""Cells with the factor of the unit, and what is worked out from it."""

_NEAR = 1e-7
"""How far a stored figure of nine digits may be from sixty times another."""


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory):
    """Return the outcome of one run in each unit: only what a reader is told differs."""
    path = tmp_path_factory.mktemp("units") / "submission.xlsx"
    path.write_bytes(filled(ROWS, tolerances=GRINDING, other_sources=EVERY_KIND, sweep=SWEEPS))
    outcome = run(path, None, samples=64)
    seconds = replace(outcome, settings=replace(outcome.settings, angle_unit="arcsec"))
    return {"arcmin": outcome, "arcsec": seconds}


@pytest.fixture(scope="module")
def drawn(outcomes):
    """Return what the report in each unit draws."""
    return {unit: report_data(outcome) for unit, outcome in outcomes.items()}


@pytest.fixture(scope="module")
def reports(outcomes, drawn, tmp_path_factory):
    """Return the report in each unit."""
    folder = tmp_path_factory.mktemp("reports")
    paths = {unit: folder / f"{unit}.xlsx" for unit in outcomes}
    for unit, outcome in outcomes.items():
        paths[unit].write_bytes(report_bytes(outcome, drawn[unit]))
    return paths


@pytest.fixture(scope="module")
def books(reports):
    """Return the stored values of each report."""
    return {unit: openpyxl.load_workbook(path, data_only=True) for unit, path in reports.items()}


def _pairs(books, sheet):
    """Yield the cells of a sheet that hold something, in either unit."""
    for rows in zip(*(books[unit][sheet].iter_rows() for unit in ("arcmin", "arcsec")), strict=True):
        for cell, other in zip(*rows, strict=True):
            if cell.value is not None or other.value is not None:
                yield cell.coordinate, cell.value, other.value


def _times(minutes, seconds):
    """Return how many times as many a number is in arc seconds: 1, 60, or 3600 of a square; else None."""
    powers = (1, 60, 3600)
    return next((times for times in powers if seconds == pytest.approx(times * minutes, rel=_NEAR, abs=1e-12)), None)


@pytest.mark.slow
def test_every_angle_is_sixty_times_as_many(books):
    """A number of a told sheet is the same in both units, or an angle; of raw data every cell is the same."""
    assert (
        set(books["arcmin"].sheetnames) == set(books["arcsec"].sheetnames) == RAW | {*ANGLES_OF} | {"About", "Carried"}
    )
    offenders = []
    for sheet in books["arcmin"].sheetnames:
        angles = 0
        for place, minutes, seconds in _pairs(books, sheet):
            if sheet in RAW and minutes != seconds and "″" not in str(seconds):
                offenders.append((sheet, place, minutes, seconds))
            if isinstance(minutes, int | float) and isinstance(seconds, int | float) and sheet in ANGLES_OF:
                times = _times(minutes, seconds)
                angles += times == 60
                is_known = times in {1, 60} or (times == 3600 and sheet == "Drive")
                if not is_known and not re.fullmatch(SCALES.get(sheet, ""), place):
                    offenders.append((sheet, place, minutes, seconds))
        assert angles >= ANGLES_OF.get(sheet, 0), (sheet, angles)
    assert offenders == []


@pytest.mark.slow
def test_every_unit_is_named(books, reports):
    """A heading says arcsec where it said arcmin, a sentence ″ where it said ′; charts as well."""
    offenders = [
        (sheet, place, seconds)
        for sheet in ANGLES_OF
        for place, _, seconds in _pairs(books, sheet)
        if re.search("arcmin|′", str(seconds)) and not re.fullmatch(OWN_UNIT.get(sheet, ""), str(seconds))
    ]
    assert offenders == []
    charts = {unit: _charts(path) for unit, path in reports.items()}
    assert charts["arcmin"].count("[arcmin]") == charts["arcsec"].count("[arcsec]") > 5
    assert charts["arcmin"].count("′") == charts["arcsec"].count("″") > 20
    assert not re.search("arcmin|′", charts["arcsec"])


def _charts(path):
    """Return all charts of a workbook, and what is said of them, without the numbers that they keep of cells."""
    with zipfile.ZipFile(path) as archive:
        names = [name for name in archive.namelist() if re.match("xl/(charts|drawings)/[^/]*xml", name)]
        return "".join(archive.read(name).decode() for name in names)


def test_page_and_screen_follow(outcomes, drawn):
    """The page's numbers, texts and pictures, and what the screen says, are in the unit as well."""
    facts = {
        unit: page_facts(outcome, Found.of(outcome, ran=True), ran=True, data=drawn[unit])
        for unit, outcome in outcomes.items()
    }
    assert [one["chart"]["unit"] for one in facts.values()] == [*facts]
    minutes, seconds = ([*_numbers(one)] for one in facts.values())
    assert seconds == pytest.approx([60 * number for number in minutes], rel=1e-12)
    units = [
        {one["unit"] for one in page["numbers"]} & {*facts} for page in (one["variants"][0] for one in facts.values())
    ]
    assert units == [{"arcmin"}, {"arcsec"}]
    signs = {"arcmin": "′", "arcsec": "″"}
    texts = {unit: "\n".join(_texts(outcomes[unit], drawn[unit], one)) for unit, one in facts.items()}
    assert texts["arcmin"].count("′") > 30
    for unit, text in texts.items():
        assert set(re.findall("[′″]", text)) == {signs[unit]}


def _numbers(facts):
    """Yield angles of the page: the chart of all variants, and a variant's density, causes and segments."""
    for one in facts["chart"]["variants"]:
        yield from (one[key] for key in ("low", "median", "high", "nominal"))
    page = facts["variants"][0]
    yield from (page["density"][key] for key in ("start", "width", "nominal", "mean", "limit"))
    yield from (one[key] for one in page["shares"] for key in ("low", "high"))
    yield from (one["backlash"] for one in page["segments"])


def _texts(outcome, data, facts):
    """Yield what page and screen say, the pictures of a variant among it."""
    page = facts["variants"][0]
    yield from detail_lines(outcome, ran=True)
    yield from (text for text, _ in levers_lines(outcome.results, data.levers, 100, outcome.settings.angles))
    yield from (str(cell) for row in facts["table"] for cell in row.values())
    yield from (sentence["text"] for sentence in [*facts["sentences"], *page["sentences"]])
    pictures = variant_charts(page["density"], page["shares"], page["segments"])
    yield from (picture.inline() for picture in pictures.values())


@pytest.mark.slow
def test_the_cell_on_the_summary_turns_it_back(reports, books, tmp_path):
    """A report in arc seconds whose cell says arcmin shows on Summary and Explorer what one in arc minutes does."""
    turned = convert(typed(reports["arcsec"], tmp_path / "turned.xlsx", "Summary", {"L2": "arcmin"}), "xlsx", tmp_path)
    turned = {"arcsec": opened(turned, data_only=True), "arcmin": books["arcmin"]}
    for sheet in ("Summary", "Explorer"):
        pairs = list(_pairs(turned, sheet))
        numbers = [(one, other) for _, one, other in pairs if isinstance(one, float) and isinstance(other, float)]
        assert len(numbers) >= ANGLES_OF[sheet]
        assert [other for _, other in numbers] == pytest.approx([one for one, _ in numbers], rel=1e-9)
