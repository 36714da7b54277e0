"""Mending: a few cells of a workbook or table change, every other byte stays, and a list says what was done."""

import io
import time
import zipfile

import openpyxl
import pytest
from flexlash.feedback.fixing.splices import before_end, cell_spans, cell_xml, spliced, xml_text
from python_calamine import CalamineWorkbook

from flexlash.feedback.fixing.fix import Repair
from flexlash.feedback.fixing.fixed_table import mended_table
from flexlash.feedback.fixing.fixed_workbook import FIXES_SHEET, mended_workbook
from flexlash.reading.delimited import read_table
from flexlash.reading.products import mended_role
from flexlash.reading.raw import RawSheet
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.xlsx import read_workbook

LIMITS = ReadingLimits()
SHEET = b"""<x:worksheet xmlns:x="m"><x:sheetData><x:row r="2"><x:c r="B2" s="7"><x:v>1</x:v></x:c><x:c/><x:c r="E2"
 t="str" ><x:f>"a"</x:f><x:v>a</x:v></x:c></x:row><x:row><x:c s='3'/><x:c><x:v>5</x:v></x:c></x:row></x:sheetData>
</x:worksheet>"""


def _repair(cell, value, sheet="Variants", found="1,6"):
    return Repair(sheet=sheet, cell=cell, found=found, value=value, code="E202")


SPANS = {
    "B2": (b'<x:c r="B2" s="7"><x:v>1</x:v></x:c>', "7", False),
    "C2": (b"<x:c/>", "", False),
    "E2": (b'<x:c r="E2"\n t="str" ><x:f>"a"</x:f><x:v>a</x:v></x:c>', "", True),
    "A3": (b"<x:c s='3'/>", "3", False),
    "B3": (b"<x:c><x:v>5</x:v></x:c>", "", False),
}


@pytest.mark.parametrize("cell", SPANS)
def test_a_cell_is_found_where_it_stands(cell):
    """A cell's span is exactly its element, whether its address is written or counted."""
    text, style, is_formula = SPANS[cell]
    span = cell_spans(SHEET, frozenset({cell}))[cell]
    assert SHEET[span.start : span.end] == text
    assert (span.prefix, span.style, span.is_formula) == ("x:", style, is_formula)


def test_a_cell_that_is_not_there_has_no_span():
    """Cells that a sheet does not hold are absent."""
    assert cell_spans(SHEET, frozenset({"D2", "A9"})) == {}


def test_splicing_replaces_spans_alone():
    """Only the given spans change, in whatever order they are given."""
    assert spliced(b"abcdef", {(4, 5): b"EE", (1, 2): b""}) == b"acdEEf"
    assert spliced(b"abc", {}) == b"abc"


def test_before_the_end_of_an_element():
    """What is added stands before the last end of the element and takes its prefix."""
    assert before_end(b"<a:x><a:x>1</a:x></a:x>", "x", b"<@y/>") == b"<a:x><a:x>1</a:x><a:y/></a:x>"
    assert before_end(b"<x></x >", "x", b"<@y/>") == b"<x><y/></x >"
    with pytest.raises(ValueError, match="sheets"):
        before_end(b"<sheets/>", "sheets", b"")


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ('a<b & "c"', b"a&lt;b &amp; &quot;c&quot;"),
        ("Δ\x00\x0b", b"&#916;"),
        ("=1+1", b"=1+1"),
        ("\U0001f600", b"&#128512;"),
    ],
)
def test_texts_are_inert_in_any_encoding(text, written):
    """A text is written with references for what is not ASCII and without what XML does not allow."""
    assert xml_text(text) == written


def test_cells_as_xml():
    """Numbers keep all their digits, texts stand inside the cell."""
    assert cell_xml("D7", 0.1 + 0.2, "x:", "4") == b'<x:c r="D7" s="4"><x:v>0.30000000000000004</x:v></x:c>'
    assert cell_xml("D7", "a ") == b'<c r="D7" t="inlineStr"><is><t xml:space="preserve">a </t></is></c>'


@pytest.fixture(scope="module")
def book():
    """Return a workbook with a formula, a picture of its own and texts to mend."""
    workbook = openpyxl.Workbook()
    sheet = workbook.active
    sheet.title = "Variants"
    sheet.append(["Variant", "Wall", "Sum"])
    sheet.append(["A", "1,6", "=1+1"])
    sheet.append(["B", 1.6, 'x"<&'])
    workbook.create_sheet("It's").append(["IT 7"])
    buffer = io.BytesIO()
    workbook.save(buffer)
    return buffer.getvalue()


def _parts(data):
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_cells_change_and_nothing_else(book):
    """The mended workbook holds the new values, the formula, and every other part byte for byte."""
    wanted = [_repair("B2", 1.6), _repair("A1", "IT7", sheet="It's", found="IT 7")]
    data, made = mended_workbook(book, wanted, LIMITS)
    assert made == wanted
    before, after = _parts(book), _parts(data)
    changed = {name for name in before if before[name] != after[name]}
    assert changed <= {
        "xl/worksheets/sheet1.xml", "xl/worksheets/sheet2.xml", "xl/workbook.xml", "[Content_Types].xml",
        "xl/_rels/workbook.xml.rels", "_rels/.rels",
    }  # fmt: skip
    workbook = openpyxl.load_workbook(io.BytesIO(data))
    assert workbook.custom_doc_props["flexlash"].value == mended_role(book)
    sheet = workbook["Variants"]
    assert [[cell.value for cell in row] for row in sheet] == [
        ["Variant", "Wall", "Sum"],
        ["A", 1.6, "=1+1"],
        ["B", 1.6, 'x"<&'],
    ]
    assert CalamineWorkbook.from_filelike(io.BytesIO(data)).get_sheet_by_name("It's").to_python() == [["IT7"]]


def test_the_list_of_fixes(book):
    """A sheet lists every repair with what stood there, what stands there now, its finding and a link."""
    data, _ = mended_workbook(book, [_repair("B2", 1.6), _repair("A1", "IT7", sheet="It's", found="IT 7")], LIMITS)
    sheet = openpyxl.load_workbook(io.BytesIO(data))[FIXES_SHEET]
    assert [[cell.value for cell in row] for row in sheet.iter_rows(min_row=3)] == [
        ["Variants!B2", "1,6", "1.6", "E202"],
        ["It's!A1", "IT 7", "IT7", "E202"],
    ]
    assert "2 cells" in sheet["A1"].value
    assert [sheet[cell].hyperlink.location for cell in ("A3", "A4")] == ["'Variants'!B2", "'It''s'!A1"]


def test_formulas_and_absent_cells_are_left(book):
    """A formula is never replaced by a value, and a cell that is not there is not made."""
    data, made = mended_workbook(book, [_repair("C2", 2.0), _repair("Z9", 1.0), _repair("A1", "x", sheet="no")], LIMITS)
    assert made == []
    assert _parts(data) == _parts(book)


def test_two_repairs_of_one_cell(book):
    """Of two repairs of one cell the first is made."""
    _, made = mended_workbook(book, [_repair("B2", 1.6), _repair("B2", 16.0)], LIMITS)
    assert [one.value for one in made] == [1.6]


def test_the_same_bytes(book):
    """Mending twice gives the same bytes, and a mended workbook passes the gate."""
    first, again = (mended_workbook(book, [_repair("B2", 1.6)], LIMITS)[0] for _ in range(2))
    assert first == again
    assert read_workbook(first, LIMITS).sheets[0].rows[2][2] == 1.6


def test_a_mended_workbook_can_be_mended_again(book):
    """A second mending leaves the first list as it is and makes one of its own."""
    first, _ = mended_workbook(book, [_repair("B2", 1.6)], LIMITS)
    second, made = mended_workbook(first, [_repair("A2", "C")], LIMITS)
    assert len(made) == 1
    titles = openpyxl.load_workbook(io.BytesIO(second)).sheetnames
    assert titles == ["Variants", "It's", FIXES_SHEET, "flexlash Fixes 1"]


TABLES = {
    "comma": (b'a,b\nx,"1,6"\n\ny,2\n', "\ufeffa,b\r\nx,1.6\r\n,\r\ny,2\r\n"),
    "semicolon with decimal comma": (b"a;b\nx;1,6 mm\ny;2,5\n", "\ufeffa;b\r\nx;1,6\r\ny;2,5\r\n"),
    "an error word": (b"a;b\nx;1.6 mm\n#REF!;2\n", "\ufeffa;b\r\nx;1.6\r\n#REF!;2\r\n"),
}


@pytest.mark.parametrize("what", TABLES)
def test_tables_keep_their_manner(what):
    """A mended table keeps rows, delimiter and decimal sign."""
    data, expected = TABLES[what]
    assert mended_table(read_table(data, "Variants"), [_repair("B2", 1.6)]).decode() == expected


def test_a_long_and_wide_table_is_written_soon():
    """A cell far down and one far to the right cost no more than their rows."""
    rows = {1: {1: "a", 256: "b"}, 2: {1: "1,6"}, 50_000: {1: "x"}}
    start = time.process_time()
    data = mended_table(RawSheet(name="Variants", rows=rows), [_repair("A2", 1.6), _repair("C2", "new")])
    assert time.process_time() - start < 6
    assert data.splitlines()[1] == b"1.6,,new" + b"," * 253
    assert data.count(b"\r\n") == 50_000


def test_a_row_of_more_cells_than_headers_stays_one():
    """Mending one cell of a table never hides that a decimal comma may have split another."""
    sheet = read_table(b"variant,material,torque_Nm,notes\nA,s,1,6,\nB,s ,8,x\n", "Variants")
    again = read_table(mended_table(sheet, [_repair("B3", "s")]), "Variants")
    assert again.dialect.longer == sheet.dialect.longer == frozenset({2})
    assert again.rows[3][2] == "s"


def test_a_cell_whose_address_is_in_small_letters_is_mended():
    """A workbook whose program writes b2 for B2 is mended at B2."""
    part = SHEET.replace(b'"B2"', b'"b2"')
    assert cell_spans(part, frozenset({"B2"})).keys() == {"B2"}
