"""Mending: a few cells of a workbook or table change, every other byte stays, and a list says what was done."""

import io
import time
import zipfile

import openpyxl
import pytest
from python_calamine import CalamineWorkbook

from flexlash.feedback.fixing.fix import Fix
from flexlash.feedback.fixing.fixed_table import fixed_table
from flexlash.feedback.fixing.fixed_workbook import FIXES_SHEET, fixed_workbook
from flexlash.feedback.splicing.sheet_spans import SheetSpans, cell_xml
from flexlash.feedback.splicing.xml_spans import (
    appended,
    element_spans,
    in_order,
    in_utf_8,
    spliced,
    with_attributes,
    xml_text,
)
from flexlash.reading.delimited import read_table
from flexlash.reading.products import fixed_role
from flexlash.reading.raw import RawSheet
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.xlsx import read_workbook
from flexlash.schema.cell_addresses import cell_address

LIMITS = ReadingLimits()
SHEET = b"""<x:worksheet xmlns:x="m"><x:sheetData><x:row r="2"><x:c r="B2" s="7"><x:v>1</x:v></x:c><x:c/><x:c r="E2"
 t="str" ><x:f>"a"</x:f><x:v>a</x:v></x:c></x:row><x:row><x:c s='3'/><x:c><x:v>5</x:v></x:c></x:row></x:sheetData>
</x:worksheet>"""


def _repair(cell, value, sheet="Variants", found="1,6"):
    return Fix(sheet=sheet, cell=cell, found=found, value=value, code="E202")


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
    spans = SheetSpans(SHEET, [cell_address(cell)])
    (span,) = spans.cells.values()
    assert SHEET[span.start : span.end] == text
    assert (span.prefix, span.style, span.is_formula) == ("x:", style, is_formula)
    assert spans.gaps == []


GAPS = {
    "A2 before a cell": ("A2", b"<x:c/>", b'<x:row r="2"><x:c/><x:c r="B2"'),
    "D2 between cells": ("D2", b"<x:c/>", b'<x:c/><x:c/><x:c r="E2"'),
    "G2 behind the last": ("G2", b"<x:c/>", b"<x:v>a</x:v></x:c><x:c/></x:row><x:row>"),
    "A1 before a row": ("A1", b"<x:c/>", b'<x:sheetData><x:row r="1"><x:c/></x:row><x:row r="2">'),
    "A9 behind the last row": ("A9", b"<x:c/>", b'</x:row><x:row r="9"><x:c/></x:row></x:sheetData>'),
}


@pytest.mark.parametrize("what", GAPS)
def test_a_cell_that_is_not_there_has_a_place(what):
    """Where a cell or its row is absent, its place keeps rows and columns in order."""
    address, new, expected = GAPS[what]
    spans = SheetSpans(SHEET, [cell_address(address)])
    (gap,) = spans.gaps
    assert not spans.cells
    assert expected in spliced(SHEET, [(gap.start, gap.end, gap.before + new + gap.after)])


@pytest.mark.parametrize(
    ("sheet", "expected"),
    [
        (b"<s><sheetData/></s>", b'<s><sheetData><row r="1">C</row><row r="3">C</row></sheetData></s>'),
        (
            b'<s><sheetData><row r="3" ht="9" /></sheetData></s>',
            b'<s><sheetData><row r="1">C</row><row r="3" ht="9">C</row></sheetData></s>',
        ),
        (
            b'<s><sheetData><row r="1"/><row r="2"/></sheetData></s>',
            b'<s><sheetData><row r="1">C</row><row r="2"/><row r="3">C</row></sheetData></s>',
        ),
    ],
)
def test_empty_elements_get_tags_of_their_own(sheet, expected):
    """Cells find their place in rows, and rows in a sheet, that are written as empty elements."""
    gaps = SheetSpans(sheet, [(1, 1), (3, 2)]).gaps
    assert spliced(sheet, [(gap.start, gap.end, gap.before + b"C" + gap.after) for gap in gaps]) == expected


def test_splicing_replaces_spans_alone():
    """Only the given spans change, in whatever order they are given; what is put in one place keeps its order."""
    assert spliced(b"abcdef", [(4, 5, b"EE"), (1, 2, b""), (3, 3, b"1"), (3, 3, b"2")]) == b"ac12dEEf"
    assert spliced(b"abc", []) == b"abc"


def test_what_is_appended_stands_in_an_element():
    """What is added stands before the end of the element, or behind its beginning, and takes its prefix."""
    assert appended(b"<a:x>1<b/></a:x>", "x", b"<@y></@y>") == b"<a:x>1<b/><a:y></a:y></a:x>"
    assert appended(b"<x></x >", "x", b"<@y/>", first=True) == b"<x><y/></x >"
    assert appended(b'<a><x b=">" /></a>', "x", b"<@y/>") == b'<a><x b=">"><y/></x></a>'
    with pytest.raises(ValueError, match="sheets"):
        appended(b"<workbook/>", "sheets", b"")


@pytest.mark.parametrize(
    ("part", "expected"),
    [
        (b"<w><a/><c/></w>", b"<w><a/><b/><c/></w>"),
        (b"<w><b>1</b><c/></w>", b"<w><b>1</b><b/><c/></w>"),
        (b"<p:w><p:c/></p:w>", b"<p:w><p:b/><p:c/></p:w>"),
        (b"<w/>", b"<w><b/></w>"),
    ],
)
def test_a_child_stands_where_the_schema_wants_it(part, expected):
    """A new child stands behind all that come before it in the order of the schema."""
    assert in_order(part, ("a", "b", "c"), "b", b"<@b/>") == expected


def test_attributes_are_set_in_their_place():
    """An attribute changes where it stands, a new one is the last, and another one's end is not taken for it."""
    assert with_attributes(b"<c x:s='1' s='2' t=\"s\"/>", s="3") == b'<c x:s=\'1\' s="3" t="s"/>'
    assert with_attributes(b"<c>", s="3", t=None) == b'<c s="3">'
    assert with_attributes(b'<c s="3" />', s=None) == b"<c />"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-16-le", "utf-16-be", "iso-8859-1"])
def test_a_part_of_any_encoding_can_be_spliced(encoding):
    """A part in UTF-16 is taken in UTF-8, any other as it is."""
    text = f'<?xml version="1.0" encoding="{encoding}"?><a>\u00b5</a>'
    part = in_utf_8(text.encode(encoding))
    assert (part == text.encode(encoding)) == (not encoding.startswith("utf-16"))
    assert element_spans(appended(part, "a", b"<@b>1</@b>"), ("b",))[1].text == "1"


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("a\rb", b"a&#13;b"),
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
    """Return a workbook with a formula, a picture of its own and texts to fix."""
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
    """The fixed workbook holds the new values, the formula, and every other part byte for byte."""
    wanted = [_repair("B2", 1.6), _repair("A1", "IT7", sheet="It's", found="IT 7")]
    data, made = fixed_workbook(book, wanted, LIMITS)
    assert made == wanted
    before, after = _parts(book), _parts(data)
    changed = {name for name in before if before[name] != after[name]}
    assert changed <= {
        "xl/worksheets/sheet1.xml", "xl/worksheets/sheet2.xml", "xl/workbook.xml", "[Content_Types].xml",
        "xl/_rels/workbook.xml.rels", "_rels/.rels",
    }  # fmt: skip
    workbook = openpyxl.load_workbook(io.BytesIO(data))
    assert workbook.custom_doc_props["flexlash"].value == fixed_role(book)
    sheet = workbook["Variants"]
    assert [[cell.value for cell in row] for row in sheet] == [
        ["Variant", "Wall", "Sum"],
        ["A", 1.6, "=1+1"],
        ["B", 1.6, 'x"<&'],
    ]
    assert CalamineWorkbook.from_filelike(io.BytesIO(data)).get_sheet_by_name("It's").to_python() == [["IT7"]]


def test_the_list_of_fixes(book):
    """A sheet lists every fix with what stood there, what stands there now, its finding and a link."""
    data, _ = fixed_workbook(book, [_repair("B2", 1.6), _repair("A1", "IT7", sheet="It's", found="IT 7")], LIMITS)
    sheet = openpyxl.load_workbook(io.BytesIO(data))[FIXES_SHEET]
    assert [[cell.value for cell in row] for row in sheet.iter_rows(min_row=3)] == [
        ["Variants!B2", "1,6", "1.6", "E202"],
        ["It's!A1", "IT 7", "IT7", "E202"],
    ]
    assert "2 cells" in sheet["A1"].value
    assert [sheet[cell].hyperlink.location for cell in ("A3", "A4")] == ["'Variants'!B2", "'It''s'!A1"]


def test_formulas_and_absent_cells_are_left(book):
    """A formula is never replaced by a value, and a cell that is not there is not made."""
    data, made = fixed_workbook(book, [_repair("C2", 2.0), _repair("Z9", 1.0), _repair("A1", "x", sheet="no")], LIMITS)
    assert made == []
    assert _parts(data) == _parts(book)


def test_two_repairs_of_one_cell(book):
    """Of two fixes of one cell the first is made."""
    _, made = fixed_workbook(book, [_repair("B2", 1.6), _repair("B2", 16.0)], LIMITS)
    assert [one.value for one in made] == [1.6]


def test_the_same_bytes(book):
    """Fixing twice gives the same bytes, and a fixed workbook passes the gate."""
    first, again = (fixed_workbook(book, [_repair("B2", 1.6)], LIMITS)[0] for _ in range(2))
    assert first == again
    assert read_workbook(first, LIMITS).sheets[0].rows[2][2] == 1.6


def test_a_fixed_workbook_can_be_fixed_again(book):
    """A second fixing leaves the first list as it is and makes one of its own."""
    first, _ = fixed_workbook(book, [_repair("B2", 1.6)], LIMITS)
    second, made = fixed_workbook(first, [_repair("A2", "C")], LIMITS)
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
    """A fixed table keeps rows, delimiter and decimal sign."""
    data, expected = TABLES[what]
    assert fixed_table(read_table(data, "Variants"), [_repair("B2", 1.6)]).decode() == expected


@pytest.mark.slow
def test_a_long_and_wide_table_is_written_soon():
    """A cell far down and one far to the right cost no more than their rows."""
    rows = {1: {1: "a", 256: "b"}, 2: {1: "1,6"}, 50_000: {1: "x"}}
    start = time.process_time()
    data = fixed_table(RawSheet(name="Variants", rows=rows), [_repair("A2", 1.6), _repair("C2", "new")])
    assert time.process_time() - start < 6
    assert data.splitlines()[1] == b"1.6,,new" + b"," * 253
    assert data.count(b"\r\n") == 50_000


def test_a_row_of_more_cells_than_headers_stays_one():
    """Mending one cell of a table never hides that a decimal comma may have split another."""
    sheet = read_table(b"variant,material,torque_Nm,notes\nA,s,1,6,\nB,s ,8,x\n", "Variants")
    again = read_table(fixed_table(sheet, [_repair("B3", "s")]), "Variants")
    assert again.dialect.longer == sheet.dialect.longer == frozenset({2})
    assert again.rows[3][2] == "s"


def test_a_cell_whose_address_is_in_small_letters_is_fixed():
    """A workbook whose program writes b2 for B2 is fixed at B2."""
    part = SHEET.replace(b'"B2"', b'"b2"')
    assert SheetSpans(part, [(2, 2)]).cells.keys() == {(2, 2)}
