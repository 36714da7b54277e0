"""The data sheets: what is printed of them, and how wide their columns are."""

from __future__ import annotations

import openpyxl
import pytest
import xlsxwriter

from flexlash.report.formula.stored import FIRST_ROW, Stored
from flexlash.report.layout.styles import PALETTE, Book

NOTE = "What stands here, in a sentence that is longer than one column is wide, since it names all columns. " * 2


def _sheet(path, count, columns=60):
    """Return a data sheet of so many variants."""
    rows = [
        {"Variant": f"v{number}", "Words": "w" * 33, **{f"n {place}": 1.5 for place in range(columns)}}
        for number in range(count)
    ]
    with xlsxwriter.Workbook(path) as workbook:
        Stored("Data", rows).write(Book(workbook), NOTE)
    return openpyxl.load_workbook(path)["Data"]


@pytest.mark.slow
@pytest.mark.parametrize(("count", "last"), [(0, FIRST_ROW + 1), (3, FIRST_ROW + 3), (600, FIRST_ROW + 12)])
def test_the_first_rows_alone_are_printed(tmp_path, count, last):
    """However many variants and columns there are, one page is printed; it says why, and its note is whole."""
    sheet = _sheet(tmp_path / "book.xlsx", count)
    corner = sheet.print_area.split("$")
    assert int(corner[-1]) == last
    assert sheet.page_setup.fitToWidth in {1, None}
    assert "not meant for print" in sheet["A1"].value
    (merged,) = sheet.merged_cells.ranges
    assert merged.coord == f"A1:{corner[-2]}1"
    assert sheet["A1"].alignment.wrap_text
    assert sheet.row_dimensions[1].height >= 30
    assert sheet.sheet_properties.tabColor.rgb.endswith(PALETTE["grey"].lstrip("#"))


def test_texts_are_not_cut(tmp_path):
    """A column of texts is as wide as the longest."""
    sheet = _sheet(tmp_path / "book.xlsx", 3)
    assert sheet.column_dimensions["B"].width >= 33
