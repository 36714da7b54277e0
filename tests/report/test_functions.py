"""Worksheet functions: what a formula says is what it comes to."""

from __future__ import annotations

import math

import openpyxl
import pytest
import xlsxwriter
from grids import for_each
from libreoffice import convert, needs_libreoffice

from flexlash.report.formula.functions import (
    ABS,
    AND,
    COS,
    COUNTA,
    EXP,
    FIXED,
    IFERROR,
    INDEX,
    INT,
    ISNUMBER,
    LN,
    LOG10,
    MATCH,
    MAX,
    MEDIAN,
    MIN,
    NORM_S_DIST,
    NORM_S_INV,
    NOT,
    OR,
    PI,
    SIN,
    SQRT,
    SUM,
    N,
    match_exactly,
    on_sheet,
)
from flexlash.report.formula.live import Live, Range, fill, live, put

NUMBERS = (3.0, -7.5, 9.0, 9.0, 0.25)
CELLS = Range("$A$1:$A$5", NUMBERS)
BLOCK = Range("$A$1:$B$6", [*NUMBERS, "", "words", ""])
RISING, NAMES = Range("$F$1:$F$3", (1.0, 2.0, 4.0)), Range("$G$1:$G$3", ("abc", "a?", "a*"))
NUMBER, TEXT = Live("$A$2", NUMBERS[1]), Live("$B$1", "words")
CASES = {
    "sum": (SUM(CELLS), 13.75),
    "sum of a range with texts": (SUM(BLOCK), 13.75),
    "greatest of a range with texts": (MAX(BLOCK, -50.0), max(NUMBERS)),
    "least of texts alone": (MIN(NAMES), 0.0),
    "greatest": (MAX(CELLS), 9.0),
    "least": (MIN(CELLS), -7.5),
    "first place of the greatest": (MATCH(MAX(CELLS), CELLS, 0), 3.0),
    "magnitude": (ABS(NUMBER), 7.5),
    "a number": (ISNUMBER(NUMBER), True),
    "a text": (ISNUMBER(TEXT), False),
    "number in a cell": (N(NUMBER), -7.5),
    "no error": (IFERROR(NUMBER, 0.0), -7.5),
    "sum of numbers and a range": (SUM(CELLS, 1.0, NUMBER), 7.25),
    "number in a text": (N(TEXT), 0.0),
    "first place of a number": (MATCH(9.0, CELLS, 0), 3.0),
    "no place": (IFERROR(MATCH(8.0, CELLS, 0), 0.0), 0.0),
    "negation": (NOT(ISNUMBER(TEXT)), True),
    "negation of what holds": (NOT(ISNUMBER(NUMBER)), False),
    "not all": (AND(ISNUMBER(NUMBER), ISNUMBER(TEXT)), False),
    "all": (AND(ISNUMBER(NUMBER), NUMBER < 0), True),
    "any": (OR(ISNUMBER(NUMBER), ISNUMBER(TEXT)), True),
    "none of them": (OR(NUMBER > 0, ISNUMBER(TEXT)), False),
    "filled": (COUNTA(BLOCK), 6.0),
    "pi": (PI * 2, 2 * math.pi),
    "another sheet": (on_sheet("Other sheet", NUMBER), -7.5),
    "root": (SQRT(Live("$A$3", 9.0)), 3.0),
    "sine": (SIN(NUMBER), math.sin(-7.5)),
    "cosine": (COS(NUMBER), math.cos(-7.5)),
    "power of e": (EXP(NUMBER), math.exp(-7.5)),
    "logarithm": (LN(Live("$A$3", 9.0)), math.log(9.0)),
    "decimal logarithm": (LOG10(1000.0), 3.0),
    "whole": (INT(NUMBER), -8.0),
    "least of some": (MIN(NUMBER, 2.0, -8.0), -8.0),
    "greatest of some": (MAX(NUMBER, 2.0), 2.0),
    "middle of three": (MEDIAN(3.0, NUMBER, 2.0), 2.0),
    "share below a score": (NORM_S_DIST(-4.75), 1.0170832425687e-06),
    "share below no score": (NORM_S_DIST(live(0.0)), 0.5),
    "score of a share": (NORM_S_INV(0.975), 1.959963984540054),
    "a number as a text": (FIXED(NUMBER, 2), "-7.50"),
    "a number as a text without decimals": (FIXED(1234.6, 0), "1235"),
    "an entry": (INDEX(CELLS, live(2.0)), -7.5),
    "how many up to": (MATCH(live(2.2), RISING, 1), 2.0),
    "how many up to one of them": (MATCH(live(2.0), RISING, 1), 2.0),
    "none up to": (IFERROR(MATCH(live(0.5), RISING, 1), 0.0), 0.0),
    "place of a name": (match_exactly(live("a*"), NAMES), 3.0),
    "place of another letter case": (match_exactly(live("A?"), NAMES), 0.0),
    "place of no name": (match_exactly(live(""), NAMES), 0.0),
}


@for_each("name", CASES)
def test_values(name):
    """Each expression carries the value that a reader works out by hand."""
    found, expected = CASES[name]
    assert found.value == (pytest.approx(expected, rel=1e-12) if isinstance(expected, float) else expected)
    assert type(found.value) is type(expected)


@pytest.mark.slow
@needs_libreoffice
def test_a_spreadsheet_program_finds_the_same(tmp_path):
    """Recalculated, each formula comes to the value it was written with."""
    path = tmp_path / "ranges.xlsx"
    with xlsxwriter.Workbook(path) as workbook:
        sheets = [workbook.add_worksheet(), workbook.add_worksheet("Other sheet")]
        for sheet in sheets:
            for row, number in enumerate(NUMBERS):
                fill(sheet, row, 0, number, None)
            fill(sheet, 0, 1, "words", None)
        for row, (number, name) in enumerate(zip(RISING.values, NAMES.values, strict=True)):
            fill(sheets[0], row, 5, number, None)
            fill(sheets[0], row, 6, name, None)
        for row, (found, _) in enumerate(CASES.values()):
            put(sheets[0], row, 3, found, None)
    again = openpyxl.load_workbook(convert(path, "xlsx", tmp_path), data_only=True).worksheets[0]
    for row, (name, (_, expected)) in enumerate(CASES.items(), start=1):
        close = expected if isinstance(expected, str) else pytest.approx(expected, rel=1e-9)
        assert again.cell(row, 4).value == close, name


@pytest.mark.parametrize("of", [ABS, SQRT, NORM_S_DIST, NORM_S_INV, INT, lambda one: MIN(one, 1.0)])
def test_errors_and_texts_pass_through(of):
    """An error passes through a function instead of raising, and a text is no number."""
    assert of(Live("$A$1", "#N/A")).value == "#N/A"

    assert of(Live("$A$1", "words")).value == "#VALUE!"
