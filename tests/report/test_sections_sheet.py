"""The Sections sheet on paper: chart and table on one page, or the table on pages of its own."""

from __future__ import annotations

import openpyxl
import pytest

from flexlash.pipeline import run


@pytest.mark.slow
@pytest.mark.parametrize(("count", "breaks"), [(12, 0), (13, 1)])
def test_a_long_table_begins_on_a_page_of_its_own(table, sound, tmp_path, count, breaks):
    """Up to twelve variants stand below the chart; more begin on a new page, and names cut alike are told apart."""
    rows = [
        {**sound, "variant": f"a name that is the same for all of them, {number}", "torque_Nm": 700.0 + number}
        for number in range(count)
    ]
    run(table(rows), tmp_path / "report.xlsx", method="random", samples=64)
    sheet = openpyxl.load_workbook(tmp_path / "report.xlsx")["Sections"]
    header = next(cell.row for cell in sheet["A"] if cell.value == "Variant")
    assert [one.id for one in sheet.row_breaks.brk] == [header - 1] * breaks
    assert sheet.print_title_rows == f"${header}:${header}"
    assert len({cell.value for cell in sheet["A"][header:]}) == count
