"""How wide tables are printed."""

from __future__ import annotations

import openpyxl
import pytest
import xlsxwriter

from flexlash.report.layout.paper import READABLE, SMALL, Listed, print_one_page, print_readably
from flexlash.report.layout.styles import Book

WIDTHS = {
    "few": ([20, *[10] * 10], READABLE, None),
    "many": ([20, *[10] * 40], READABLE, READABLE),
    "nearly too many, smaller letters": ([20, *[10] * 20], SMALL, None),
    "nearly too many": ([20, *[10] * 20], READABLE, READABLE),
}


@pytest.mark.parametrize("case", WIDTHS)
def test_letters_are_never_too_small(tmp_path, case):
    """Columns that fit are one page wide; others are printed at a size that can be read, the first column repeated."""
    widths, least, scale = WIDTHS[case]
    path = tmp_path / "book.xlsx"
    with xlsxwriter.Workbook(path) as book:
        print_readably(book.add_worksheet("Sheet"), widths, breaks=[3, 7], least=least)
    sheet = openpyxl.load_workbook(path)["Sheet"]
    assert bool(sheet.sheet_properties.pageSetUpPr and sheet.sheet_properties.pageSetUpPr.fitToPage) == (scale is None)
    if scale is None:
        assert sheet.page_setup.fitToHeight == 0
        assert sheet.print_title_cols is None
    else:
        assert sheet.page_setup.scale == scale
        assert sheet.print_title_cols == "$A:$A"
        assert sheet.page_setup.pageOrder == "overThenDown"
        assert [one.id for one in sheet.col_breaks.brk] == [3, 7]


def _printed(path, widths, rows, **asked):
    """Return the area that is printed of a sheet with so many rows, and what the head of its page says."""
    with xlsxwriter.Workbook(path) as workbook:
        print_one_page(Book(workbook).sheet("Sheet"), widths, rows - 1, **asked)
    sheet = openpyxl.load_workbook(path)["Sheet"]
    return sheet.print_area.replace("$", "").partition("!")[2], sheet.oddHeader.right.text


def test_the_head_of_a_page_says_what_is_left_out(tmp_path):
    """Rows are counted and columns named, a few and how many more; what is hidden or without a name is not missed."""
    names = ["Variant", *[f"R&D {number}" for number in range(1, 31)]]
    listed = Listed(noun="variants", first=2, columns=names)
    area, head = _printed(tmp_path / "a.xlsx", [20, *[10] * 30], 500, listed=listed)
    columns = "R&&D 18, R&&D 19, R&&D 20, R&&D 21, R&&D 22, R&&D 23, R&&D 24, R&&D 25 and 5 more"
    assert area == "A1:R50"
    assert head == f"Printed: the first 48 of 498 variants; without the columns {columns}"
    area, head = _printed(tmp_path / "b.xlsx", [20, *[0] * 29, 10], 20, listed=listed)
    assert (area, head) == ("A1:AE20", None)
    listed = Listed(noun="variants", columns=["Variant", *[""] * 29, "Notes"])
    assert _printed(tmp_path / "c.xlsx", [20, *[10] * 30], 20, listed=listed)[1] == "Printed: without the column Notes"
    assert _printed(tmp_path / "d.xlsx", [20], 90) == ("A1:A33", "Printed: the beginning of this sheet")


def test_a_page_ends_with_a_part_unless_the_first_is_too_long(tmp_path):
    """Parts are whole and counted; the first is cut where it has no room alone, rather than printed too small."""
    listed, wide = Listed(noun="studies"), [150, 50]
    assert _printed(tmp_path / "a.xlsx", wide, 90, ends=[19, 39, 59], listed=listed) == (
        "A1:B40", "Printed: the first 2 of 4 studies",
    )  # fmt: skip
    assert _printed(tmp_path / "b.xlsx", wide, 90, ends=[19], listed=listed) == (
        "A1:B20", "Printed: the first of 2 studies",
    )  # fmt: skip
    area, head = _printed(tmp_path / "c.xlsx", wide, 120, ends=[99], listed=listed)
    assert head == "Printed: the beginning of this sheet"
    assert int(area.rpartition("B")[2]) * 15 * 7 / 11 <= 512
    area, head = _printed(tmp_path / "d.xlsx", wide, 120, smallest=10, listed=listed)
    assert head == "Printed: the beginning of this sheet"
    assert int(area.rpartition("A")[2]) * 15 * 7 / 10 <= 512
