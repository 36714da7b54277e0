"""A printed template can be read: letters of seven points, columns on pages side by side, nothing below another."""

from __future__ import annotations

import io
import itertools
import math

import openpyxl
import pytest
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.print_settings import PrintArea

from flexlash.feedback.template.filling import Filling
from flexlash.feedback.template.template_workbook import TITLES, template_bytes
from flexlash.schema.columns import OPTIONAL_SHEETS

A4_ACROSS = (11.69 - 0.8) * 96
"""Pixels between the margins."""


@pytest.fixture(scope="module")
def book():
    """Return a template with all sheets."""
    return openpyxl.load_workbook(io.BytesIO(template_bytes(Filling(optional=OPTIONAL_SHEETS))))


def _widths(sheet, last):
    """Return how wide the columns up to one are [px]."""
    known = {}
    for one in sheet.column_dimensions.values():
        known |= dict.fromkeys(range(one.min, one.max + 1), math.floor(one.width * 7 + 0.5))
    return [known.get(column, 64) for column in range(1, last + 1)]


def _pages(sheet):
    """Return the size of print, and the columns of each page but the repeated one."""
    area = sheet.print_area
    last = next(iter(PrintArea.from_string(area).ranges)).max_col if area else sheet.max_column
    if sheet.sheet_properties.pageSetUpPr and sheet.sheet_properties.pageSetUpPr.fitToPage:
        return min(1.0, A4_ACROSS / sum(_widths(sheet, last))), [range(1, last + 1)]
    ends = [*(one.id for one in sheet.col_breaks.brk), last]
    return sheet.page_setup.scale / 100, [range(start + 1, end + 1) for start, end in itertools.pairwise([0, *ends])]


@pytest.mark.parametrize("name", [*TITLES, "Dictionary"])
def test_a_printed_sheet_has_letters_of_seven_points(book, name):
    """Each page holds its columns, after the first one with the names, at a size of 7 points or more."""
    sheet = book[name]
    scale, pages = _pages(sheet)
    assert 11 * scale >= 7, scale
    widths = _widths(sheet, pages[-1][-1])
    for place, columns in enumerate(pages):
        named = widths[0] if place and sheet.print_title_cols == "$A:$A" else 0
        assert (named > 0) == (place > 0)
        assert (named + sum(widths[column - 1] for column in columns)) * scale <= A4_ACROSS, place


def test_what_a_cup_needs_is_on_the_first_page(book):
    """Columns break where a group of them ends: the first page of Variants holds those that a row must have."""
    _, pages = _pages(book["Variants"])
    headers = [book["Variants"].cell(4, column).value for column in pages[0]]
    assert headers[-1] == "Disk outer radius r_co [mm]"
    assert get_column_letter(pages[1][0]) == "L"
    assert len(pages) == 3


def test_rows_of_the_dictionary_are_as_high_as_their_texts(book):
    """No text runs into the row below, in programs that leave heights as they are stored."""
    sheet = book["Dictionary"]
    for row in range(2, sheet.max_row + 1):
        for cell in sheet[row]:
            lines = len(str(cell.value or "")) / (1.3 * sheet.column_dimensions[cell.column_letter].width)
            assert (sheet.row_dimensions[row].height or 15) >= 15 * math.ceil(lines), cell.coordinate
