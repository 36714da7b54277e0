"""Rows that are given at once stand in the workbook as rows written cell by cell do."""

from __future__ import annotations

import io
from random import Random

import openpyxl
import xlsxwriter
from open_xml import faults_of, needs_validator

from flexlash.report.layout.given_rows import GivenRows
from flexlash.report.layout.styles import Book

TEXTS = ("", " both ends ", "a<b & c>d", 'say "x"', "_x0041_", "tab\there", "two\nlines", "\x01", "尺𝄞", "=1+1", "ok")
FIRST, ROWS = 3, 1203


def _columns(book):
    """Return columns of numbers, texts and blanks with formats that change from cell to cell."""
    source = Random(5)  # noqa: S311
    styles = [book.format("text"), book.format("text", "0.00"), book.format("link"), book.format("indented", "0.0%")]
    numbers = [None, 0.0, -0.0, 1.5, -2e-300, 1 / 3, 123456789.123456789, 1e22]
    for values in (numbers, TEXTS, (*numbers, *TEXTS), (None,)):
        column = [source.choice(values) for _ in range(ROWS)]
        yield column, [source.choice(styles) for _ in range(ROWS)]


def _written(*, given):
    """Return a workbook whose rows are given at once, or written cell by cell."""
    buffer = io.BytesIO()
    with xlsxwriter.Workbook(buffer, {"in_memory": True}) as workbook:
        book = Book(workbook)
        sheet = book.sheet("Results", kind=GivenRows) if given else book.sheet("Results")
        columns = list(_columns(book))
        sheet.write_row(FIRST - 1, 0, ("a", "b", "c", "d"), book.format("header"))
        if given:
            sheet.give(FIRST, columns, {FIRST + 4: 31.5})
        else:
            sheet.set_row(FIRST + 4, 31.5)
            for column, (values, styles) in enumerate(columns):
                for row, (value, style) in enumerate(zip(values, styles, strict=True), start=FIRST):
                    if value is not None:
                        (sheet.write_string if isinstance(value, str) else sheet.write_number)(
                            row, column, value, style
                        )
        sheet.write_url(FIRST + 7, 1, "internal:Results!A1", book.format("link"), "its own")
        sheet.write_number(FIRST + 9, 6, 7.0, book.format("text"))
    return buffer


def test_given_rows_are_those_written_cell_by_cell():
    """Values, texts, formats, heights, links and what stands beside are the same, cell by cell."""
    sheets = [openpyxl.load_workbook(_written(given=given))["Results"] for given in (True, False)]
    assert sheets[0].dimensions == sheets[1].dimensions == f"A{FIRST}:G{FIRST + ROWS}"
    for ours, plain in zip(*(sheet.iter_rows() for sheet in sheets), strict=True):
        for one, other in zip(ours, plain, strict=True):
            assert (one.value, one.data_type, one.number_format) == (other.value, other.data_type, other.number_format)
            assert (repr(one.font), repr(one.alignment)) == (repr(other.font), repr(other.alignment))
            assert (one.hyperlink and one.hyperlink.location) == (other.hyperlink and other.hyperlink.location)
    heights = [sheet.row_dimensions[FIRST + 5].height for sheet in sheets]
    assert heights == [31.5, 31.5]


@needs_validator
def test_given_rows_are_valid(tmp_path):
    """Excel finds nothing to repair in a sheet of given rows."""
    (tmp_path / "given.xlsx").write_bytes(_written(given=True).getvalue())
    assert faults_of(tmp_path / "given.xlsx") == []
