"""Workbooks and findings for the tests of the marked copy, and what can be seen of a workbook."""

from __future__ import annotations

import io
import warnings
import zipfile

import openpyxl
import xlsxwriter
from openpyxl.comments import Comment
from openpyxl.formatting.rule import FormulaRule
from openpyxl.styles import Font, PatternFill, Protection
from openpyxl.utils import get_column_letter
from openpyxl.workbook.defined_name import DefinedName
from openpyxl.worksheet.datavalidation import DataValidation

from flexlash.schema.findings import Finding

__all__ = ["fault", "loaded", "look", "notes", "own_workbook", "rewritten", "rich_workbook"]


def fault(sheet="Data", cell="B2", level="error", code="E202", **words):
    """Return a finding on a cell."""
    texts = {"message": f"{sheet}!{cell} is wrong.", "fix": "Fix it.", **words}
    return Finding(level=level, code=code, sheet=sheet, cell=cell, **texts)


def loaded(data):
    """Return a workbook as openpyxl alone reads it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return openpyxl.load_workbook(io.BytesIO(data))


def rewritten(data, part, old, new):
    """Return a workbook with some bytes of one part replaced by others."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as archive, zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as target:
        for name in archive.namelist():
            content = archive.read(name)
            assert name != part or old in content
            target.writestr(name, content.replace(old, new) if name == part else content)
    return buffer.getvalue()


def own_workbook():
    """Return an engineer's workbook with something of everything that must stay as it is."""
    workbook = openpyxl.Workbook()
    data = workbook.active
    data.title = "Data"
    for row in range(1, 8):
        for column in range(1, 5):
            data.cell(row, column, row * 10 + column + 0.125)
    data["A1"] = "a text"
    data["C1"] = 0.1 + 0.2
    data["D1"] = "=SUM(B2:B7)"
    data["B2"].fill = PatternFill("solid", fgColor="FF00B050")
    data["B2"].font = Font(bold=True, color="FFFFFFFF")
    data["B2"].number_format = "0.00"
    data["B2"].protection = Protection(locked=False)
    data["B2"].comment = Comment("JM: measured twice", "JM")
    data["C3"].comment = Comment("only theirs", "JM")
    data["B3"].fill = PatternFill("lightGrid", fgColor="FF0070C0", bgColor="FFFFFFFF")
    data["F6"].hyperlink = "https://example.org/x"
    data["F6"].value = None
    data["F6"].font = Font(italic=True)
    data.merge_cells("A9:C10")
    data["A9"] = "over three columns"
    data.column_dimensions["H"].fill = PatternFill("solid", fgColor="FFDDEBF7")
    data.column_dimensions["H"].number_format = "0.0"
    data.column_dimensions["H"].width = 31
    data.column_dimensions["G"].hidden = True
    data.row_dimensions[4].hidden = True
    data.row_dimensions[5].outlineLevel = 1
    rule = DataValidation(type="list", formula1="fl_names", showErrorMessage=True, sqref="B2:B7")
    data.add_data_validation(rule)
    red = PatternFill(bgColor="FFFF0000")
    data.conditional_formatting.add("B2:C4", FormulaRule(formula=["B2>1"], fill=red))
    data.freeze_panes = "B2"
    data.print_area = "A1:D9"
    data.print_title_rows = "1:1"
    data.page_setup.orientation = "landscape"
    data.protection.enable()
    theirs = workbook.create_sheet("Findings")
    theirs["A1"] = "an own sheet of this name"
    hidden = workbook.create_sheet("It's hidden")
    hidden.sheet_state = "hidden"
    hidden["B2"] = 7
    hidden["B2"].fill = PatternFill("solid", fgColor="FF7030A0")
    data.sheet_view.tabSelected = hidden.sheet_view.tabSelected = True
    workbook.defined_names["fl_names"] = DefinedName("fl_names", attr_text="'It''s hidden'!$B$2:$B$4")
    buffer = io.BytesIO()
    workbook.save(buffer)
    return buffer.getvalue()


def rich_workbook():
    """Return a workbook with parts that cannot be carried over, and with dates, rich text and many digits."""
    buffer = io.BytesIO()
    workbook = xlsxwriter.Workbook(buffer, {"in_memory": True})
    sheet = workbook.add_worksheet("Data")
    sheet.write_column(0, 0, [1 / 3, 0.3, 123456789.1234568, 5e-324])
    sheet.write_number(4, 0, 45000.123456789012, workbook.add_format({"num_format": "yyyy-mm-dd hh:mm"}))
    sheet.write_number(5, 0, 3_000_000, workbook.add_format({"num_format": "yyyy-mm-dd"}))
    sheet.write_rich_string(6, 0, "half ", workbook.add_format({"bold": True}), "bold", " ", "text")
    sheet.write_string(7, 0, "=1+1")
    sheet.write_string(8, 0, "a\rb_x0041_c")
    sheet.write_formula(9, 0, "=A1*2", None, 2 / 3)
    sheet.insert_textbox(12, 1, "a text box")
    sheet.add_sparkline(0, 4, {"range": "Data!A1:A4"})
    sheet.conditional_format("A1:A4", {"type": "data_bar", "data_bar_2010": True})
    chart = workbook.add_chart({"type": "line"})
    chart.add_series({"values": "=Data!$A$1:$A$4"})
    sheet.insert_chart("G2", chart)
    workbook.close()
    return rewritten(buffer.getvalue(), "xl/worksheets/sheet1.xml", b"<v>0.3</v>", b"<v>0.30000000000000004</v>")


def _shade(fill):
    if fill.fill_type in {None, "solid"}:
        return fill.fgColor.rgb if fill.fill_type else None
    return (fill.fill_type, fill.fgColor.rgb, fill.bgColor.rgb)


def look(data):
    """Return value and fill of every cell of the user's sheets, by sheet and address, plain blank cells left out."""
    found = {}
    for sheet in loaded(data).worksheets:
        if sheet["A1"].value == "flexlash marks" or str(sheet["A1"].value).startswith("flexlash: "):
            continue
        for row in sheet.iter_rows():
            for cell in row:
                value = getattr(cell.value, "text", cell.value)
                shade = _shade(cell.fill)
                if value is not None or (shade and shade != _shade(_column(sheet, cell).fill)):
                    found[sheet.title, cell.coordinate] = (value, shade)
    return found


def _column(sheet, cell):
    return sheet.column_dimensions[get_column_letter(cell.column)]


def notes(data):
    """Return the text and author of every note, by sheet and address."""
    return {
        (sheet.title, cell.coordinate): (cell.comment.text, cell.comment.author)
        for sheet in loaded(data).worksheets
        for row in sheet.iter_rows()
        for cell in row
        if cell.comment
    }
