"""Reading: every cell at the address that its user sees, exactly as stored, and nothing judged or lost."""

import datetime
import hashlib
import io
import re
import zipfile

import openpyxl
import polars as pl
import pytest
import xlsxwriter
from read_files import read_submission

from flexlash.reading.gate import Refusal
from flexlash.reading.raw import ErrorCell, Unstored
from flexlash.schema.cell_addresses import column_letters

ERRORS = ["#REF!", "#DIV/0!", "#VALUE!", "#NAME?", "#N/A", "#NUM!", "#NULL!", "#SPILL!", "#CALC!"]


@pytest.fixture
def save(tmp_path):
    """Return a function that writes cells, by sheet and address, as a workbook and gives its path."""

    def write(sheets, change=None):
        book = openpyxl.Workbook()
        book.remove(book.active)
        for name, cells in sheets.items():
            sheet = book.create_sheet(name)
            for address, value in cells.items():
                sheet[address] = value
        if change:
            change(book)
        path = tmp_path / "submission.xlsx"
        book.save(path)
        return path

    return write


def _by_address(sheet):
    return {
        f"{column_letters(place)}{row}": value for row, cells in sheet.rows.items() for place, value in cells.items()
    }


def _altered(path, part, old, new):
    """Replace a piece of one part of a workbook in place."""
    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    text = parts[part].decode()
    assert re.search(old, text)
    parts[part] = re.sub(old, new, text).encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in parts.items():
            archive.writestr(name, data)
    return path


@pytest.mark.parametrize(
    ("number", "letters"),
    [(1, "A"), (26, "Z"), (27, "AA"), (52, "AZ"), (53, "BA"), (702, "ZZ"), (703, "AAA"), (16384, "XFD")],
)
def test_column_letters(number, letters):
    """Columns are lettered as Excel letters them."""
    assert column_letters(number) == letters


def test_addresses_survive_gaps(save):
    """Blank rows and columns before and between cells shift no address."""
    cells = {"B3": "x", "AB3": 1.5, "C70": "y", "A1000": 7}
    sheet = read_submission(save({"Variants": cells})).sheets["Variants"]
    assert _by_address(sheet) == cells
    assert list(sheet.rows) == [3, 70, 1000]


@pytest.mark.parametrize("claim", ["A1", "A1:A1", "A1:XFD1048576", "C9:D9"])
def test_the_dimension_record_is_not_believed(save, claim):
    """A sheet whose dimension record is too small, too large or elsewhere is read whole."""
    cells = {"A1": "x", "F1": "y", "A90": 3}
    path = save({"Variants": cells})
    _altered(path, "xl/worksheets/sheet1.xml", r'<dimension ref="[^"]*"', f'<dimension ref="{claim}"')
    assert _by_address(read_submission(path).sheets["Variants"]) == cells


def test_values_keep_their_kind(save):
    """Numbers, texts, truth values, dates and times are read as what they are."""
    cells = {
        "A1": 1.6,
        "B1": 160,
        "C1": -2.5e-300,
        "D1": "1.6",
        "E1": " spaced ",
        "F1": "Δ µ 20Cr2Ni4",
        "G1": True,
        "H1": False,
        "I1": datetime.datetime(2026, 4, 1),  # noqa: DTZ001
        "J1": datetime.time(12, 30),
        "K1": datetime.timedelta(days=2, hours=1),
        "L1": "'=2+2",
        "M1": "two\nlines",
        "N1": 0,
    }
    found = _by_address(read_submission(save({"Variants": cells})).sheets["Variants"])
    assert found == cells
    assert {address: type(value) for address, value in found.items()} == {
        address: type(value) for address, value in cells.items()
    }


def test_error_cells_are_told(tmp_path):
    """A cell that shows an Excel error is read as that error, never as blank or as text."""
    path = tmp_path / "a.xlsx"
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("Variants")
        for row, error in enumerate(ERRORS):
            sheet.write_formula(row, 2, "=1/0", None, error)
    assert _by_address(read_submission(path).sheets["Variants"]) == {
        f"C{row}": ErrorCell(error) for row, error in enumerate(ERRORS, start=1)
    }


@pytest.mark.parametrize("error", ["#FIELD!", "#BLOCKED!", "#CONNECT!", "#UNKNOWN!", "#BUSY!", "#GETTING_DATA"])
def test_newer_error_cells_are_told(save, error):
    """A cell stored as an error is an error whatever its word."""
    path = save({"Variants": {"A1": "#N/A"}})
    _altered(path, "xl/worksheets/sheet1.xml", "#N/A", error)
    assert read_submission(path).sheets["Variants"].rows == {1: {1: ErrorCell(error)}}


def test_formulas_without_a_result_are_told(save):
    """A formula whose result was never stored is told at its address, in the middle of data or in an empty row."""
    cells = {"A1": "x", "B1": "=1+1", "D1": 4, "C90": "=A1"}
    other = {"B2": "=1"}
    sheets = read_submission(save({"Variants": cells, "Notes": other})).sheets
    expected = {"A1": "x", "B1": Unstored(), "D1": 4, "C90": Unstored()}
    assert _by_address(sheets["Variants"]) == expected
    assert list(sheets["Variants"].rows) == [1, 90]
    assert _by_address(sheets["Notes"]) == {"B2": Unstored()}


def test_formulas_with_a_result_give_it(tmp_path):
    """A formula gives the result that was stored with it, to the last digit."""
    path = tmp_path / "a.xlsx"
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("Variants")
        for place, result in enumerate([1.6, 0, "cup", 0.1 + 0.2]):
            sheet.write_formula(0, place, "=A9", None, result)
    assert read_submission(path).sheets["Variants"].rows == {1: {1: 1.6, 2: 0, 3: "cup", 4: 0.30000000000000004}}


def test_what_is_hidden_is_read(save):
    """Hidden sheets, rows and columns hold data like others."""

    def hide(book):
        sheet = book["Variants"]
        sheet.row_dimensions[2].hidden = True
        sheet.column_dimensions["B"].hidden = True
        book["Materials"].sheet_state = "hidden"
        book["Settings"].sheet_state = "veryHidden"

    cells = {"A1": "x", "B1": "y", "A2": 1}
    sheets = read_submission(save({"Variants": cells, "Materials": {"A1": 1}, "Settings": {"A1": 2}}, hide)).sheets
    assert {name: _by_address(sheet) for name, sheet in sheets.items()} == {
        "Variants": cells,
        "Materials": {"A1": 1},
        "Settings": {"A1": 2},
    }


def test_a_merged_block_has_its_value_at_its_first_cell(save):
    """Of merged cells the first holds the value and the others are blank."""
    path = save({"Variants": {"A1": 1.6, "D2": 2}}, lambda book: book["Variants"].merge_cells("A1:C2"))
    assert _by_address(read_submission(path).sheets["Variants"]) == {"A1": 1.6, "D2": 2}


def test_an_empty_workbook_is_read(save):
    """A workbook without a single cell is read as such."""
    sheets = read_submission(save({"Variants": {}, "Other": {}})).sheets
    assert {name: sheet.rows for name, sheet in sheets.items()} == {"Variants": {}, "Other": {}}


def test_a_chart_sheet_is_passed_over(tmp_path):
    """A chart sheet holds no cells and hides none of the others."""
    path = tmp_path / "a.xlsx"
    with xlsxwriter.Workbook(path) as book:
        book.add_worksheet("Variants").write_number("A1", 1)
        chart = book.add_chart({"type": "line"})
        chart.add_series({"values": "=Variants!$A$1:$A$1"})
        book.add_chartsheet("Chart").set_chart(chart)
        book.add_worksheet("More").write_number("B2", 2)
    sheets = read_submission(path).sheets
    assert {name: _by_address(sheet) for name, sheet in sheets.items()} == {"Variants": {"A1": 1}, "More": {"B2": 2}}


def test_name_kind_and_fingerprint(save):
    """A submission carries its file's name without folder, its kind, and the SHA-256 of its bytes."""
    path = save({"Variants": {"A1": 1}})
    submission = read_submission(path)
    assert (submission.name, submission.kind, submission.delimiter) == ("submission.xlsx", "workbook", "")
    assert submission.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()


def test_document_properties(tmp_path):
    """What a workbook says it is, its template's version and its date come from its document properties."""
    path = tmp_path / "a.xlsx"
    with xlsxwriter.Workbook(path) as book:
        book.add_worksheet("Variants")
        book.set_properties({"created": datetime.datetime(2026, 1, 2, 3, 4, 5, tzinfo=datetime.UTC)})
        book.set_custom_property("flexlash", "report")
        book.set_custom_property("flexlash_template_version", 7, "number_int")
        book.set_custom_property("other", "x")
    submission = read_submission(path)
    assert (submission.role, submission.template_version) == ("report", "7")
    assert submission.modified.replace(tzinfo=None) == datetime.datetime(2026, 1, 2, 3, 4, 5)  # noqa: DTZ001


def test_a_workbook_of_another_program_says_nothing_of_itself(save):
    """A workbook without our properties has no role and no template version."""
    submission = read_submission(save({"Variants": {"A1": 1}}))
    assert (submission.role, submission.template_version) == ("", "")


@pytest.mark.parametrize("part", ["absent", "empty"])
def test_a_workbook_without_a_date_has_none(save, part):
    """A workbook that does not say when it was changed has no date, so that its report is the same tomorrow."""
    path = save({"Variants": {"A1": 1}})
    if part == "empty":
        _altered(path, "docProps/core.xml", r"<dcterms:modified.*?</dcterms:modified>", "")
    else:
        with zipfile.ZipFile(path) as archive:
            parts = {name: archive.read(name) for name in archive.namelist() if name != "docProps/core.xml"}
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, data in parts.items():
                archive.writestr(name, data)
        _altered(path, "[Content_Types].xml", r"<Override PartName=./docProps/core.xml.[^>]*>", "")
        _altered(path, "_rels/.rels", r"<Relationship [^>]*core-properties[^>]*>", "")
    assert read_submission(path).modified is None


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("<v>7</v>", "<v>seven</v>"),
        ('<c r="A1"[^>]*><v>7', '<c r="A1" t="s"><v>5'),
        ("<v>7</v>", "<v>nan</v>"),
    ],
)
def test_what_the_reader_cannot_read_is_damage(save, old, new):
    """A cell that no workbook program could have written makes the whole file damaged, in our words."""
    path = save({"Variants": {"A1": 7, "B1": "x"}})
    _altered(path, "xl/worksheets/sheet1.xml", old, new)
    with pytest.raises(Refusal) as caught:
        read_submission(path)
    assert (caught.value.code, caught.value.facts) == ("E102", {})


@pytest.mark.parametrize("stored", ["1_6.5", "١٦"])
def test_only_numbers_are_numbers(save, stored):
    """A numeric cell that holds no plain decimal number is never read as one."""
    path = save({"Variants": {"A1": 7}})
    _altered(path, "xl/worksheets/sheet1.xml", "<v>7</v>", f"<v>{stored}</v>")
    with pytest.raises(Refusal):
        read_submission(path)


def test_infinity_is_read_as_such(save):
    """A number beyond the range of doubles is read as infinite, for validation to refuse."""
    path = save({"Variants": {"A1": 1.5}})
    _altered(path, "xl/worksheets/sheet1.xml", "<v>1.5</v>", "<v>1e999</v>")
    assert read_submission(path).sheets["Variants"].rows == {1: {1: float("inf")}}


def test_a_delimited_text_is_the_variants_and_knows_how_it_was_written(tmp_path):
    """A delimited text is a submission with Variants alone that tells delimiter, encoding and decimal comma."""
    path = tmp_path / "submission.csv"
    path.write_bytes("variant;a\nMüller;1,6\n".encode("cp1252"))
    submission = read_submission(path)
    assert (submission.kind, list(submission.sheets)) == ("csv", ["Variants"])
    assert (submission.delimiter, submission.encoding) == (";", "Windows-1252")
    assert (submission.dialect.file, submission.dialect.comma_number) == ("submission.csv", (2, 2))


def test_damaged_parquet(tmp_path):
    """A Parquet file that cannot be read is damaged."""
    buffer = io.BytesIO()
    pl.DataFrame({"a": [1, 2, 3]}).write_parquet(buffer)
    path = tmp_path / "a.parquet"
    path.write_bytes(buffer.getvalue()[:-20])
    with pytest.raises(Refusal) as caught:
        read_submission(path)
    assert caught.value.code == "E102"
