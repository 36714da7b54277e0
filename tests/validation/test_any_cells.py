"""Cells of any content in any column: findings in words, at places that exist, and nothing that acts."""

from __future__ import annotations

import contextlib
import csv
import datetime
import io
import json
import math
import re
import tempfile
import unicodedata
import zipfile
from pathlib import Path

import openpyxl
import pytest
import xlsxwriter
from edited_workbooks import reading_here
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from openpyxl.utils.exceptions import IllegalCharacterError

from flexlash.analysis.run_summary import finding_lines, summary_lines
from flexlash.pipeline import check, run
from flexlash.reading.raw import ErrorCell, RawSheet, Submission, Unstored
from flexlash.reading.read import ReadReport, Source
from flexlash.schema.cell_addresses import cell_ranges, column_letters
from flexlash.schema.columns import ENTRY_SHEETS, SETTINGS
from flexlash.schema.finding_catalogue import CATALOGUE

EXAMPLES = 40
FILES = 12
_FAST = {"derandomize": True, "deadline": None, "suppress_health_check": list(HealthCheck)}
_MOST_WORDS = 60
_HOSTILE = (
    "=1+1", "+1+1", "-1+1", "@SUM(A1)", "=cmd|' /C calc'!A0", '=HYPERLINK("http://example.org","x")', "{=1+1}", "B3!A1",
    "\t=1+1", "'=1",
    "http://example.org/x", "file:///etc/passwd", "mailto:a@example.org", "internal:'Findings'!A1", "external:x.xlsx",
    "{", "}", "{0}", "{place}", "{value!r:>{width}}", "%s", "%(x)s", "%n%n", "$(id)", "`id`", "\\",
    "\\x1b[31m", "\x1b[31mred",
    "\x00", "a\x07b", "a\rb", "a\nb", "\u202egnp.exe", "a\u2066b\u2069", "\u200b", "\ufeff", "\u00a0",
    "\ud800", "a\udfffb",
    "_x0000_", "_x001B_", "_x202E_", "👩\u200d🔧", "ﬁ", "İ", "ß", "x" * 300, "é" * 2000, "1.6", "1,6",
    "1.6 mm", "١٫٦", "１.６",
    "1e999", "nan", "inf", "-0", "0x1p3", "1_0", "1" * 400, "9" * 30 + " mm", "1e" + "9" * 50, "#REF!",
    "#N/A", "TRUE", "",
)  # fmt: skip
_NUMBERS = (
    math.nan, math.inf, -math.inf, 5e-324, -5e-324, 1.7976931348623157e308, -1e308, 0, -0.0, 1, -1, 2**53 + 1, 10**30,
    1e-300, 1.6, 0.5,
)  # fmt: skip
_MOMENTS = (
    datetime.date(1900, 1, 1), datetime.date(9999, 12, 31), datetime.datetime(2026, 4, 1, 12, 30),  # noqa: DTZ001
    datetime.datetime(2026, 4, 1), datetime.time(23, 59, 59, 999999), datetime.timedelta(days=-3, seconds=7),  # noqa: DTZ001
)  # fmt: skip
_TEXTS = st.one_of(
    st.sampled_from(_HOSTILE),
    st.text(max_size=40),
    st.text(st.characters(categories=("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp", "Mn")), max_size=8),
    st.text("0123456789.,eE+- mµ'°%/±", max_size=12),
)
_LISTED = (
    *ENTRY_SHEETS["Tolerances"],
    *ENTRY_SHEETS["Variants"],
    *ENTRY_SHEETS["Measurements"][:3],
    *(column for sheet in ("Other sources", "Levers", "Sweep") for column in ENTRY_SHEETS[sheet]),
    *SETTINGS,
)
_WORDS = st.sampled_from(
    [
        "Steel",
        "careful",
        "shop",
        "lathe",
        "IT7",
        "h13",
        "%",
        "mm",
        *(word for column in _LISTED for word in (*column.choices, column.key)),
    ]
)
_ANYTHING = st.one_of(
    _TEXTS,
    _WORDS,
    st.sampled_from(_NUMBERS),
    st.floats(),
    st.integers(),
    st.booleans(),
    st.sampled_from(_MOMENTS),
    st.sampled_from(("#REF!", "#DIV/0!", "#N/A", "#odd\x1b!")).map(ErrorCell),
    st.just(Unstored()),
)
_SOUND = {
    "Variants": [
        {"variant": f"V{number}", "material": "Steel", "torque_Nm": 800.0, "cylinder_length_mm": 160.0,
         "mean_radius_mm": 80.0,
         "wall_thickness_mm": 1.6, "disk_inner_radius_mm": 40.0, "tolerance_class": ("careful", "shop")[number % 2]}
        for number in range(6)
    ],
    "Materials": [{"material": "Steel", "youngs_modulus_GPa": 206.0, "poisson_ratio": 0.3}],
    "Tolerances": [
        {"tolerance_class": "careful", "dimension": "wall_thickness", "lower_deviation": -0.02, "upper_deviation": 0.02,
         "cp": 1.2, "cpk": 0.9},
        {"tolerance_class": "careful", "dimension": "cylinder_length", "grade": "IT11", "mean_shift": 0.01,
         "standard_deviation": 0.05},
        {"tolerance_class": "shop", "based_on": "careful"},
        {"tolerance_class": "shop", "dimension": "wall_thickness", "lower_deviation": -0.02, "upper_deviation": 0.02,
         "sample": "lathe"},
        {"tolerance_class": "shop", "dimension": "youngs_modulus", "lower_deviation": -2.0, "upper_deviation": 2.0,
         "deviation_unit": "%", "scatters_between": "lots"},
    ],
    "Settings": [{"setting": "seed", "value": 3.0}, {"setting": "coverage_percent", "value": 90.0}],
    "Measurements": [
        {"sample": "lathe", "part": f"L{number}", "use_as": "deviation", "wall_thickness_mm": deviation}
        for number, deviation in enumerate((0.001, -0.004, 0.003, 0.006, -0.002, 0.002, 0.005))
    ],
    "Correlations": [{"tolerance_class": "shop", "dimension_1": "wall_thickness", "dimension_2": "cylinder_length",
                      "correlation": 0.4}],
    "Other sources": [
        {"source": "clearance", "enter_as": "mm at radius", "value_arcmin": 0.01, "radius_mm": 80.0},
        {"source": "coupling", "lower_deviation": 0.0, "upper_deviation": 20.0, "side": "input", "ratio": 100.0},
        {"source": "runout", "lower_deviation": -0.1, "upper_deviation": 0.1, "kind": "random"},
    ],
    "Levers": [
        {"dimension": "cylinder_length", "lowest": 120.0, "highest": 200.0, "step": 0.5},
        {"dimension": "torque", "may_change": "no"},
        {"dimension": "material", "cost_per_step": 30.0},
    ],
    "Sweep": [
        {"variant": "V1", "dimension": "cylinder_length", "from": 120.0, "to": 200.0, "step": 20.0},
        {"dimension": "wall_thickness", "from": 1.4, "to": 1.8, "step": 0.2, "second_dimension": "disk_inner_radius",
         "second_from": 40.0, "second_to": 50.0, "second_step": 5.0},
    ],
}  # fmt: skip


def _heads(sheet):
    """Return the place of every key of a sheet, and one extra column behind them."""
    return {column.key: place for place, column in enumerate(ENTRY_SHEETS[sheet], start=1)} | {
        "own": len(ENTRY_SHEETS[sheet]) + 1
    }


def _rows(sheet):
    """Return the sound rows of a sheet below a header row of keys."""
    heads = _heads(sheet)
    rows = {1: {place: key for key, place in heads.items()}}
    for number, record in enumerate(_SOUND[sheet], start=2):
        rows[number] = {heads[key]: value for key, value in record.items()}
    return rows


def _somewhere(first_row):
    """Return the strategy of a sheet, a row, a column and a content."""
    places = [(sheet, place) for sheet in ENTRY_SHEETS for place in _heads(sheet).values()]
    rows = st.integers(first_row, 9)
    return st.builds(lambda at, row, value: (*at, row, value), st.sampled_from(places), rows, _ANYTHING)


_CELLS = st.lists(_somewhere(2), min_size=1, max_size=30)
_CELLS_AND_HEADERS = st.lists(_somewhere(1), min_size=1, max_size=30)


def _submission(cells, kind):
    """Return a sound submission with some of its cells replaced."""
    rows = {sheet: _rows(sheet) for sheet in ENTRY_SHEETS}
    for sheet, place, row, value in cells:
        rows[sheet].setdefault(row, {})[place] = value
    sheets = {
        name: RawSheet(name=name, rows=dict(sorted(of.items())), numbers_are_texts=kind == "csv")
        for name, of in rows.items()
    }
    return Submission(name="any {0} %s.xlsx", sha256="", kind=kind, sheets=sheets)


def _given(submission):
    """Return a submission that needs no reading."""
    return ReadReport(name="given.csv", submission=submission, results=None, version="")


def _is_plain(text):
    """Whether a text can go to a terminal: no control, direction or half characters, no line ends."""
    return not any(unicodedata.category(character) in {"Cc", "Cf", "Cs", "Zl", "Zp"} for character in text)


def _expect_words(outcome):
    """Every finding is told in few plain words, at a cell that is there."""
    sheets = outcome.submission.sheets
    for found in outcome.findings:
        assert found.code in CATALOGUE
        assert len(found.message.split()) <= _MOST_WORDS, found
        for text in (found.message, found.fix, found.value, found.suggestion, found.variant, found.column):
            assert _is_plain(text), found
        if found.cell:
            rows = sheets[found.sheet].rows
            match = re.fullmatch(r"([A-Z]{1,3})([1-9]\d*)", found.cell)
            assert cell_ranges([found.address]) == found.cell
            assert int(match[2]) <= max(rows) + 1
            assert match[1] in {column_letters(place) for place in range(1, max(map(max, rows.values())) + 2)}
    assert json.loads(json.dumps(outcome.as_dictionary(), allow_nan=False)) == outcome.as_dictionary()
    json.dumps(outcome.as_dictionary(), ensure_ascii=False).encode()
    for line in (*(line for _, line in finding_lines(outcome.findings)), *summary_lines(outcome, "x.xlsx", ran=False)):
        assert _is_plain(line), line


def _unusable(submission):
    """Return the rows of Variants that hold something else than a finite number in a column of numbers."""
    numbers = {_heads("Variants")[column.key] for column in ENTRY_SHEETS["Variants"] if column.is_number}
    blank = " \t\r\n\u00a0\u200b\ufeff"
    return {
        row
        for row, cells in submission.sheets["Variants"].rows.items()
        for place, value in cells.items()
        if row > 1 and place in numbers and not (isinstance(value, str) and not value.strip(blank))
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value)
    }


@pytest.mark.slow
@settings(max_examples=EXAMPLES, **_FAST)
@given(cells=_CELLS)
@example(cells=[("Variants", 6, 2, 1.7976931348623157e308)])
def test_any_cells_of_a_workbook(cells):
    """Whatever cells hold, findings are words at places that exist, and no row with an unusable number is computed."""
    submission = _submission(cells, "workbook")
    outcome = check(_given(submission))
    _expect_words(outcome)
    assert not _unusable(submission) & outcome.computed.keys()


@pytest.mark.slow
@settings(max_examples=EXAMPLES // 2, **_FAST)
@given(cells=_CELLS_AND_HEADERS, kind=st.sampled_from(("workbook", "csv", "parquet")))
def test_any_headers(cells, kind):
    """Headers may hold anything as well, in every kind of submission."""
    _expect_words(check(_given(_submission(cells, kind))))


_WRITABLE = re.compile("[^\ud800-\udfff]*")


def _texts_of(cells):
    """Return cells that hold texts that a file can hold."""
    return [(sheet, place, row, str(value)) for sheet, place, row, value in cells if _WRITABLE.fullmatch(str(value))]


def _with_xlsxwriter(submission):
    """Return a workbook with every value written as what it is."""
    buffer = io.BytesIO()
    book = xlsxwriter.Workbook(buffer, {"in_memory": True, "nan_inf_to_errors": True})
    for name, raw in submission.sheets.items():
        sheet = book.add_worksheet(name)
        for row, cells in raw.rows.items():
            for place, value in cells.items():
                write = sheet.write_string if isinstance(value, str) else sheet.write_number
                write(row - 1, place - 1, value)
    book.close()
    return buffer.getvalue()


def _with_openpyxl(submission):
    """Return a workbook as a script would write it: what begins with = is a formula without a result."""
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, raw in submission.sheets.items():
        sheet = book.create_sheet(name)
        for row, cells in raw.rows.items():
            for place, value in cells.items():
                with contextlib.suppress(IllegalCharacterError):
                    sheet.cell(row, place, value)
    buffer = io.BytesIO()
    book.save(buffer)
    return buffer.getvalue()


def _with_csv(submission):
    """Return the Variants table as delimited text."""
    buffer = io.StringIO()
    rows = submission.sheets["Variants"].rows
    writer = csv.writer(buffer)
    for row in range(1, max(rows) + 1):
        writer.writerow([rows.get(row, {}).get(place, "") for place in range(1, len(rows[1]) + 1)])
    return buffer.getvalue().encode()


def _expect_inert(data, titles):
    """No cell of these sheets is a formula, and no sheet leads out of the workbook."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    book = openpyxl.load_workbook(io.BytesIO(data))
    assert {title for title in titles if title in book.sheetnames}
    formulas = [
        cell.coordinate
        for title in titles
        if title in book.sheetnames
        for row in book[title].iter_rows()
        for cell in row
        if cell.data_type == "f"
    ]
    assert formulas == []
    assert not any(b'TargetMode="External"' in part for part in parts.values())
    assert not any("externalLink" in name for name in parts)
    for part in parts.values():
        for formula in re.findall(
            rb"<f[^>]*>([^<]*)</f>|<formula>([^<]*)</formula>|<formula1>([^<]*)</formula1>", part
        ):
            text = b"".join(formula).decode()
            assert not any(word in text for word in ("calc'", "example.org", "passwd", "SUM(A1)")), text


@pytest.mark.slow
@settings(max_examples=FILES, **_FAST)
@given(cells=_CELLS, write=st.sampled_from((_with_xlsxwriter, _with_openpyxl, _with_csv)))
def test_any_cells_of_a_file(cells, write):
    """Texts that went through a real file are told as plainly, and its marked copy holds them as texts."""
    submission = _submission(_texts_of(cells), "workbook")
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, "copy.xlsx")
        with reading_here():
            outcome = check(Source(name="any.xlsx", data=write(submission)), marked_copy=copy)
        _expect_words(outcome)
        if outcome.written.marked_copy and write is not _with_openpyxl:
            _expect_inert(copy.read_bytes(), (*ENTRY_SHEETS, "Findings"))


@pytest.mark.slow
@settings(max_examples=FILES, **_FAST)
@given(cells=_CELLS_AND_HEADERS)
def test_any_texts_in_the_marked_copy_of_a_table(cells):
    """A table's marked copy holds its texts as texts."""
    with tempfile.TemporaryDirectory() as folder:
        outcome = check(_given(_submission(cells, "csv")), marked_copy=Path(folder, "copy.xlsx"))
        if outcome.written.marked_copy:
            _expect_inert(outcome.written.marked_copy.read_bytes(), (*ENTRY_SHEETS, "Findings"))


_NAMED = [("Variants", 1, row, text) for row, text in enumerate(_HOSTILE[:26], start=2)]
_REMARKED = [("Variants", _heads("Variants")["notes"], row, text) for row, text in enumerate(_HOSTILE, start=2)]


@pytest.mark.slow
@pytest.mark.parametrize("cells", [_NAMED, _REMARKED], ids=["names", "remarks"])
def test_any_texts_in_the_report(cells, tmp_path):
    """Names and remarks of computed rows stay texts in every sheet of the report that shows them, and in Results."""
    rows = [("Variants", place, row, value) for row in range(2, 60) for place, value in _rows("Variants")[3].items()]
    named = [("Variants", 1, row, f"N{row}") for row in range(2, 60)]
    own = [("Variants", len(ENTRY_SHEETS["Variants"]) + 1, row, text) for row, text in enumerate(_HOSTILE, start=2)]
    renamed = [(*cell[:3], f"{cell[3]} {cell[2]}") if cell[1] == 1 else cell for cell in cells]
    limits = [("Variants", _heads("Variants")["backlash_limit_arcmin"], row, 1.0) for row in range(2, 60)]
    submission = _submission([*rows, *named, *limits, *renamed, *own], "workbook")
    outcome = run(_given(submission), tmp_path / "report.xlsx", method="random", samples=256)
    _expect_words(outcome)
    assert outcome.counts["computed"] > 50
    _expect_inert(
        (tmp_path / "report.xlsx").read_bytes(), ("Results", "Findings", "Submission", "Materials", "Tolerances")
    )
    told = list(summary_lines(outcome, "x.xlsx", ran=True))
    assert any("of units are over" in line for line in told)
    assert all(map(_is_plain, told))
