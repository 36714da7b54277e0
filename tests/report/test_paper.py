"""How wide tables are printed."""

from __future__ import annotations

import openpyxl
import pytest
import xlsxwriter

from flexlash.report.layout.paper import READABLE, SMALL, print_readably

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
