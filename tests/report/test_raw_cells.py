"""Cells of the submission in the report: numbers as numbers, percentages as shown, the rest as inert texts."""

from __future__ import annotations

import datetime
import io

import openpyxl
import pytest
import xlsxwriter

from flexlash.reading.raw import CommaNumber, ErrorCell, Percentage, Unstored
from flexlash.report.layout.raw_cells import write_raw
from flexlash.report.layout.styles import Book

CASES = {
    "number": (1.25, 1.25, "General"),
    "whole number": (3, 3, "General"),
    "5%": (Percentage(0.05), 0.05, "0%"),
    "12.5%": (Percentage(0.125), 0.125, "0.0%"),
    "0.1%": (Percentage(0.001), 0.001, "0.0%"),
    "a third in per cent": (Percentage(1 / 3), 1 / 3, "0.0000000000%"),
    "truth": (True, "TRUE", "General"),
    "date": (datetime.date(2026, 4, 1), "2026-04-01", "General"),
    "error": (ErrorCell("#REF!"), "#REF!", "General"),
    "formula": (Unstored(), "(formula without a stored result)", "General"),
    "text like a formula": ("=1+1", "=1+1", "General"),
    "text like a link": ("http://example.org", "http://example.org", "General"),
    "decimal comma": (CommaNumber("1,6"), "1,6", "General"),
    "control character": ("a\x07b", "a·b", "General"),
    "long text": ("x" * 2000, "x" * 999 + "…", "General"),
    "infinity": (float("inf"), "inf", "General"),
}


@pytest.mark.parametrize("case", CASES)
def test_a_raw_value_keeps_what_it_is(case):
    """A value stands in the report as it was read, shown as its cell showed it, and cannot act."""
    value, expected, number_format = CASES[case]
    buffer = io.BytesIO()
    workbook = xlsxwriter.Workbook(buffer, {"strings_to_urls": False})
    write_raw(Book(workbook), workbook.add_worksheet(), (0, 0), value)
    workbook.close()
    cell = openpyxl.load_workbook(buffer).active["A1"]
    assert cell.value == expected
    assert cell.data_type == ("s" if isinstance(expected, str) else "n")
    assert cell.number_format == number_format
