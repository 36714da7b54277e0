"""Functions over ranges: what a formula says is what it comes to."""

from __future__ import annotations

import math

import openpyxl
import pytest
import xlsxwriter

from flexlash.report.live import Live, fill, put
from flexlash.report.trace.ranges import (
    PI,
    all_of,
    any_of,
    elsewhere,
    filled,
    greatest_in,
    is_number,
    least_in,
    magnitude,
    negation,
    number_in,
    place_of_first,
    place_of_greatest,
    total,
)
from libreoffice import convert, needs_libreoffice

NUMBERS = (3.0, -7.5, 9.0, 9.0, 0.25)
CELLS = "$A$1:$A$5"
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
}


@pytest.mark.parametrize("name", CASES)
def test_values(name):
    """Each expression carries the value that a reader works out by hand."""
    found, expected = CASES[name]
    assert found.value == expected
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
        for row, (found, _) in enumerate(CASES.values()):
            put(sheets[0], row, 3, found, None)
    again = openpyxl.load_workbook(convert(path, "xlsx", tmp_path), data_only=True).worksheets[0]
    for row, (name, (_, expected)) in enumerate(CASES.items(), start=1):
        assert again.cell(row, 4).value == pytest.approx(expected, rel=1e-15), name


def test_a_text_has_no_magnitude():
    """An error passes through instead of raising."""
    assert magnitude(Live("$A$1", "#N/A")).value == "#N/A"
