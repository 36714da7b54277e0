"""Public workbooks, and those of other programs: the same cells as an independent reader sees, or the right refusal."""

import csv
import datetime
import math
import os
import warnings
from pathlib import Path

import openpyxl
import pytest
import python_calamine
import xlsxwriter
from here import WHERE, answer_here
from libreoffice import convert, needs_libreoffice
from read_files import read_submission

from flexlash.pipeline import check
from flexlash.reading.raw import ErrorCell, Unstored
from flexlash.reading.refusal import Refusal
from flexlash.schema.cell_addresses import column_letters

CORPUS = Path(os.environ.get("FLEXLASH_CORPUS", "no such folder"))
CODES = {
    "refuse:encrypted": {"E103"},
    "refuse:old-xls": {"E104"},
    "refuse:ods": {"E104"},
    "refuse:xlsb": {"E104"},
    "refuse:damaged": {"E102"},
    "refuse:not-a-workbook": {"E101", "E109"},
    "refuse:dtd-entity": {"E101", "E104", "E105"},
    "refuse-or-read:strict": {"E108"},
    "refuse-or-read:dialect": {"E102", "E108", "E109", "E110"},
    "readable:not-our-template": {"E108"},
}


class Judged:
    """What became of a file of the corpus."""

    def __init__(self, row):
        self.path = CORPUS / row["file"]
        expectation, _, rest = row["expectation"].partition(";")
        self.expectation = expectation.strip()
        self.count = int(rest.partition("cells=")[2] or -1)
        self.sheets = None
        with warnings.catch_warnings(record=True) as self.warned:
            warnings.simplefilter("always")
            try:
                submission = read_submission(self.path)
                self.sheets = submission.sheets if submission.kind == "workbook" else None
            except Refusal:
                self.sheets = None
            self.outcome = check(self.path)

    @property
    def codes(self):
        """Codes of the errors that were found."""
        return {found.code for found in self.outcome.findings if found.level == "error"}


@pytest.fixture(scope="module")
def judged():
    """Return what became of every file of the corpus; read here, since so many processes take their time."""
    if not CORPUS.is_dir():
        pytest.skip("FLEXLASH_CORPUS names no folder of public workbooks")
    lines = (CORPUS / "MANIFEST.tsv").read_text(encoding="utf-8").splitlines()
    rows = csv.DictReader([line for line in lines if not line.startswith("#")], delimiter="\t")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(WHERE, answer_here)
        return [Judged(row) for row in rows]


@pytest.mark.slow
@pytest.mark.public_workbooks
def test_every_public_workbook_ends_in_an_outcome(judged):
    """Every file of the corpus ends in one refusal with exit code 4."""
    assert len(judged) > 200
    assert {one.path.name: one.codes for one in judged if one.outcome.exit_code != 4 or not one.codes} == {}


@pytest.mark.slow
@pytest.mark.public_workbooks
def test_every_public_workbook_is_told_by_the_right_name(judged):
    """What the manifest calls encrypted, old, foreign, damaged or readable is told as such, both ways."""
    assert {
        one.path.name: (one.expectation, wrong) for one in judged if (wrong := one.codes - CODES[one.expectation])
    } == {}


@pytest.mark.slow
@pytest.mark.public_workbooks
def test_reading_warns_nobody(judged):
    """Reading a workbook raises no Python warning, which would reach the user's terminal."""
    assert {one.path.name: str(one.warned[0].message) for one in judged if one.warned} == {}


@pytest.mark.slow
@pytest.mark.public_workbooks
def test_strict_open_xml_is_read(judged):
    """Every public workbook of the Strict dialect is read, not refused."""
    strict = [one for one in judged if one.expectation == "refuse-or-read:strict"]
    assert len(strict) > 10
    assert [one.path.name for one in strict if one.sheets is None] == []


def _cells(sheets):
    return [cell for sheet in sheets.values() for row in sheet.rows.values() for cell in row.values()]


@pytest.mark.slow
@pytest.mark.public_workbooks
def test_public_workbooks_are_read_whole(judged):
    """From each readable workbook come as many cells as the manifest counts, with or without errors and empty texts."""
    bad = {}
    for one in judged:
        if one.sheets is not None and one.count >= 0:
            cells = _cells(one.sheets)
            filled = [cell for cell in cells if cell != ""]
            kept = [cell for cell in filled if not isinstance(cell, ErrorCell | Unstored)]
            if one.count not in {len(cells), len(filled), len(kept)}:
                bad[one.path.name] = (one.count, len(cells), len(filled), len(kept))
    assert bad == {}


def _alike(mine, other):
    """Whether two readers mean the same by a cell."""
    if isinstance(mine, ErrorCell | Unstored) or mine == "":
        return True
    if isinstance(mine, datetime.datetime | datetime.date | datetime.time | datetime.timedelta):
        return type(other) in {datetime.datetime, datetime.date, datetime.time, datetime.timedelta} and (
            abs(_seconds(mine) - _seconds(other)) < 1
        )
    if isinstance(mine, int | float) and isinstance(other, int | float):
        return mine == other or (math.isinf(mine) and math.isinf(other))
    return mine == other


def _seconds(moment):
    """Return a date, time or duration as seconds since the same beginning."""
    if isinstance(moment, datetime.timedelta):
        return moment.total_seconds()
    if isinstance(moment, datetime.time):
        return moment.hour * 3600 + moment.minute * 60 + moment.second + moment.microsecond / 1e6
    if not isinstance(moment, datetime.datetime):
        moment = datetime.datetime.combine(moment, datetime.time())
    return (moment - datetime.datetime(1899, 12, 30)).total_seconds()  # noqa: DTZ001


def _differences(sheets, path):
    """Return where our cells differ from what calamine reads, by sheet and place."""
    bad = {}
    try:
        oracle = python_calamine.CalamineWorkbook.from_path(path)
        tables = {name: oracle.get_sheet_by_name(name) for name in sheets}
    except python_calamine.CalamineError:
        return {("", 0, 0): ("", "calamine cannot read it")}
    for name, sheet in sheets.items():
        table = tables[name]
        if table.height * table.width > 500_000:
            continue
        rows = table.to_python(skip_empty_area=False)
        theirs = {(i, j): cell for i, row in enumerate(rows, 1) for j, cell in enumerate(row, 1) if cell != ""}
        ours = {(i, j): cell for i, row in sheet.rows.items() for j, cell in row.items()}
        for place in ours.keys() | theirs.keys():
            if not _alike(ours.get(place), theirs.get(place)):
                bad[name, *place] = (ours.get(place), theirs.get(place))
    return bad


SEEN_OTHERWISE = {
    "ExcelDataReader__Test_git_issue_694_TimeSpan.xlsx": "calamine leaves durations as texts",
    "PhpSpreadsheet__issue.3654.xlsx": "calamine takes a number format for a date's",
    "PhpSpreadsheet__utf16be.xlsx": "calamine does not read UTF-16",
    "exceljs__test-issue-176.xlsx": "calamine refuses a dimension record without columns",
    "test_files__LONumbers-2010.xlsx": "calamine takes number formats for dates' and negative times for positive ones",
}


@pytest.mark.slow
@pytest.mark.public_workbooks
def test_public_workbooks_are_read_alike_by_another_reader(judged):
    """Every cell of the readable workbooks is what calamine reads at its address, to the last bit, and none more."""
    bad = {}
    for one in judged:
        if one.sheets is not None and (pairs := _differences(one.sheets, one.path)):
            bad[one.path.name] = (len(pairs), list(pairs.items())[:3])
    assert {name: pairs for name, pairs in bad.items() if name not in SEEN_OTHERWISE} == {}
    assert bad.keys() >= SEEN_OTHERWISE.keys()


CELLS = {
    "A1": "variant",
    "B1": 0.1 + 0.7,
    "C1": -5e-300,
    "D1": 160,
    "B3": "Δ µ′ 𝄞 \n two",
    "C3": " spaced ",
    "D3": True,
    "A70": datetime.datetime(2026, 4, 1, 12, 30),  # noqa: DTZ001
    "AB70": "far",
    "A71": "=2+2",
}


def _by_openpyxl(path):
    book = openpyxl.Workbook()
    for address, value in CELLS.items():
        book.active[address] = value
        if value == "=2+2":
            book.active[address].data_type = "s"
    book.save(path)


def _by_xlsxwriter(path, **options):
    with xlsxwriter.Workbook(path, options) as book:
        sheet = book.add_worksheet("Sheet")
        date = book.add_format({"num_format": "yyyy-mm-dd hh:mm"})
        for address, value in CELLS.items():
            if isinstance(value, datetime.datetime):
                sheet.write_datetime(address, value, date)
            elif isinstance(value, str):
                sheet.write_string(address, value)
            else:
                sheet.write(address, value)


WRITERS = {
    "openpyxl": _by_openpyxl,
    "XlsxWriter": _by_xlsxwriter,
    "XlsxWriter with texts in the cells": lambda path: _by_xlsxwriter(path, constant_memory=True),
    "XlsxWriter with dates from 1904": lambda path: _by_xlsxwriter(path, date_1904=True),
}


def _by_address(path):
    (sheet,) = read_submission(path).sheets.values()
    rows = sheet.rows.items()
    return {f"{column_letters(place)}{row}": value for row, cells in rows for place, value in cells.items()}


@pytest.mark.parametrize("program", WRITERS)
def test_files_of_other_programs(program, tmp_path):
    """What each program writes is read as it was meant, and as calamine reads it."""
    path = tmp_path / "a.xlsx"
    WRITERS[program](path)
    assert _by_address(path) == CELLS
    assert _differences(read_submission(path).sheets, path) == {}


@pytest.mark.slow
@needs_libreoffice
def test_a_file_of_libreoffice(tmp_path):
    """What LibreOffice writes of a workbook is read as the workbook itself, its numbers to 15 digits."""
    path = tmp_path / "a.xlsx"
    _by_xlsxwriter(path)
    converted = convert(path, "xlsx", tmp_path)
    found = _by_address(converted)
    assert found.keys() == CELLS.keys()
    assert {address: value for address, value in found.items() if not isinstance(value, float)} == {
        address: value for address, value in CELLS.items() if not isinstance(value, float)
    }
    assert all(found[address] == pytest.approx(CELLS[address], rel=1e-14) for address in ("B1", "C1"))
    assert _differences(read_submission(converted).sheets, converted) == {}
