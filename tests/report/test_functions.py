"""Worksheet functions: what a formula says is what it comes to."""

from __future__ import annotations

import math

import openpyxl
import pytest
import xlsxwriter
from grids import for_each
from libreoffice import convert, needs_libreoffice

from flexlash.report.formula.functions import (
    PI,
    all_of,
    any_of,
    cosine,
    count_up_to,
    decimal_logarithm,
    elsewhere,
    entry_of,
    exponential,
    filled,
    fixed,
    greatest,
    greatest_in,
    is_number,
    least,
    least_in,
    logarithm,
    magnitude,
    middle,
    negation,
    normal_score,
    normal_share,
    number_in,
    place_of_first,
    place_of_greatest,
    place_of_name,
    root,
    sine,
    total,
    whole,
)
from flexlash.report.formula.live import Live, fill, live, put

NUMBERS = (3.0, -7.5, 9.0, 9.0, 0.25)
CELLS = "$A$1:$A$5"
RISING, NAMES = (1.0, 2.0, 4.0), ("abc", "a?", "a*")
NUMBER, TEXT = Live("$A$2", NUMBERS[1]), Live("$B$1", "words")
CASES = {
    "sum": (total(CELLS, NUMBERS), 13.75),
    "greatest": (greatest_in(CELLS, NUMBERS), 9.0),
    "least": (least_in(CELLS, NUMBERS), -7.5),
    "first place of the greatest": (place_of_greatest(CELLS, NUMBERS), 3.0),
    "magnitude": (magnitude(NUMBER), 7.5),
    "a number": (is_number(NUMBER), True),
    "a text": (is_number(TEXT), False),
    "number in a cell": (number_in(NUMBER), -7.5),
    "number in a text": (number_in(TEXT), 0.0),
    "first place of a number": (place_of_first(9.0, CELLS, NUMBERS), 3.0),
    "no place": (place_of_first(8.0, CELLS, NUMBERS), 0.0),
    "negation": (negation(is_number(TEXT)), True),
    "negation of what holds": (negation(is_number(NUMBER)), False),
    "not all": (all_of(is_number(NUMBER), is_number(TEXT)), False),
    "all": (all_of(is_number(NUMBER), NUMBER < 0), True),
    "any": (any_of(is_number(NUMBER), is_number(TEXT)), True),
    "none of them": (any_of(NUMBER > 0, is_number(TEXT)), False),
    "filled": (filled("$A$1:$B$6", [*NUMBERS, "", "words", ""]), 6.0),
    "pi": (PI * 2, 2 * math.pi),
    "another sheet": (elsewhere("Other sheet", NUMBER), -7.5),
    "root": (root(Live("$A$3", 9.0)), 3.0),
    "sine": (sine(NUMBER), math.sin(-7.5)),
    "cosine": (cosine(NUMBER), math.cos(-7.5)),
    "power of e": (exponential(NUMBER), math.exp(-7.5)),
    "logarithm": (logarithm(Live("$A$3", 9.0)), math.log(9.0)),
    "decimal logarithm": (decimal_logarithm(1000.0), 3.0),
    "whole": (whole(NUMBER), -8.0),
    "least of some": (least(NUMBER, 2.0, -8.0), -8.0),
    "greatest of some": (greatest(NUMBER, 2.0), 2.0),
    "middle of three": (middle(3.0, NUMBER, 2.0), 2.0),
    "share below a score": (normal_share(-4.75), 1.0170832425687e-06),
    "share below no score": (normal_share(live(0.0)), 0.5),
    "score of a share": (normal_score(0.975), 1.959963984540054),
    "a number as a text": (fixed(NUMBER, 2), "-7.50"),
    "a number as a text without decimals": (fixed(1234.6, 0), "1235"),
    "an entry": (entry_of(CELLS, live(2.0), NUMBERS), -7.5),
    "how many up to": (count_up_to(live(2.2), "$F$1:$F$3", RISING), 2.0),
    "how many up to one of them": (count_up_to(live(2.0), "$F$1:$F$3", RISING), 2.0),
    "none up to": (count_up_to(live(0.5), "$F$1:$F$3", RISING), 0.0),
    "place of a name": (place_of_name(live("a*"), "$G$1:$G$3", NAMES), 3.0),
    "place of another letter case": (place_of_name(live("A?"), "$G$1:$G$3", NAMES), 0.0),
    "place of no name": (place_of_name(live(""), "$G$1:$G$3", NAMES), 0.0),
}


@for_each("name", CASES)
def test_values(name):
    """Each expression carries the value that a reader works out by hand."""
    found, expected = CASES[name]
    assert found.value == (pytest.approx(expected, rel=1e-12) if isinstance(expected, float) else expected)
    assert type(found.value) is type(expected)


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
        for row, (number, name) in enumerate(zip(RISING, NAMES, strict=True)):
            fill(sheets[0], row, 5, number, None)
            fill(sheets[0], row, 6, name, None)
        for row, (found, _) in enumerate(CASES.values()):
            put(sheets[0], row, 3, found, None)
    again = openpyxl.load_workbook(convert(path, "xlsx", tmp_path), data_only=True).worksheets[0]
    for row, (name, (_, expected)) in enumerate(CASES.items(), start=1):
        close = expected if isinstance(expected, str) else pytest.approx(expected, rel=1e-9)
        assert again.cell(row, 4).value == close, name


@pytest.mark.parametrize("of", [magnitude, root, normal_share, normal_score, whole, lambda one: least(one, 1.0)])
def test_errors_and_texts_pass_through(of):
    """An error passes through a function instead of raising, and a text is no number."""
    assert of(Live("$A$1", "#N/A")).value == "#N/A"
    if of is not magnitude:
        assert of(Live("$A$1", "words")).value == "#VALUE!"
