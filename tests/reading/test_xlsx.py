"""A workbook's bytes → its cells: right or refused, never silently otherwise."""

import contextlib
import datetime
import io
import random
import time
import tracemalloc
import zipfile
from xml.sax.saxutils import escape

import numpy as np
import openpyxl
import pytest
from small_workbook import (
    CORE,
    MAIN,
    OFFICE,
    RELATIONS,
    SHEET,
    STRINGS,
    STYLES,
    TYPES,
    WORKBOOK,
    archive_of,
    book_of,
    parts_of,
    relation,
    sheet_of,
    styles_of,
    workbook_part,
)  # fmt: skip

from flexlash.reading.raw import ErrorCell, Percentage, Unstored
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.xlsx import read_workbook

QUOTES = {'"': "&quot;"}
CORNERS = '<row r="1"><c r="A1"><v>1</v></c></row><row r="1048576"><c r="XFD1048576"><v>2</v></c></row>'


def _read(data, **limits):
    """Return the rows of the first sheet."""
    return read_workbook(data, ReadingLimits(**limits)).sheets[0].rows


def _refusal(data, **limits):
    """Return the refusal of a workbook, or None."""
    try:
        read_workbook(data, ReadingLimits(**limits))
    except Refusal as refusal:
        return refusal
    return None


def _row(*cells):
    return f'<row r="1">{"".join(cells)}</row>'


def _number(text, address="A1", **attributes):
    written = "".join(f' {name}="{value}"' for name, value in attributes.items())
    return f'<c r="{address}"{written}><v>{text}</v></c>'


@pytest.mark.parametrize(
    ("stored", "value"),
    [
        ("1.6", 1.6),
        ("0.1", 0.1),
        ("0.30000000000000004", 0.30000000000000004),
        ("5e-324", 5e-324),
        ("-1.7976931348623157E+308", -1.7976931348623157e308),
        ("16", 16),
        (" 16\n", 16),
        ("9007199254740993", 9007199254740992.0),
        ("1e999", float("inf")),
        ("-1" + "0" * 400, -float("inf")),
    ],
)
def test_numbers_to_the_last_bit(stored, value):
    """A number is the double that is stored; one beyond doubles is infinite, for validation to refuse."""
    ((found,),) = [row.values() for row in _read(book_of(_row(_number(stored)))).values()]
    assert (found, type(found)) == (value, type(value))


@pytest.mark.parametrize(
    ("stored", "number_format", "base", "value"),
    [
        ("45000", 14, "", datetime.datetime(2023, 3, 15)),  # noqa: DTZ001
        ("45000.5", 22, "", datetime.datetime(2023, 3, 15, 12)),  # noqa: DTZ001
        ("0.5", 21, "", datetime.time(12)),
        ("1.5", 46, "", datetime.timedelta(days=1, hours=12)),
        ("45000", 14, "1", datetime.datetime(2027, 3, 16)),  # noqa: DTZ001
        ("1e10", 14, "", ErrorCell("#VALUE!")),
        ("45000", 2, "", 45000),
    ],
)
def test_a_number_shown_as_a_date_is_a_date(stored, number_format, base, value):
    """A number in a date's format is that date, counted from 1900 or 1904; none that exists is an error."""
    book = workbook_part().replace("<sheets>", f'<workbookPr date1904="{base or 0}"/><sheets>')
    data = book_of(_row(_number(stored, s=1)), **{STYLES: styles_of(0, number_format), WORKBOOK: book})
    assert _read(data) == {1: {1: value}}


def test_styles_of_another_name_still_tell_dates():
    """A workbook whose styles are a part of another name shows its dates as dates."""
    links = parts_of()[RELATIONS].replace("styles.xml", "looks.xml")
    changed = {STYLES: None, "xl/looks.xml": styles_of(0, 14), RELATIONS: links}
    assert _read(book_of(_row(_number("45000", s=1)), **changed)) == {1: {1: datetime.datetime(2023, 3, 15)}}  # noqa: DTZ001


def test_texts_of_another_name_are_found():
    """Shared texts are those that the workbook refers to, whatever the list of types calls them."""
    links = parts_of()[RELATIONS].replace("sharedStrings.xml", "words.xml")
    words = {STRINGS: f'<sst xmlns="{MAIN}"><si><t>wrong</t></si></sst>', RELATIONS: links}
    words["xl/words.xml"] = f'<sst xmlns="{MAIN}"><si><t>right</t></si></sst>'
    assert _read(book_of(_row(_number("0", t="s")), **words)) == {1: {1: "right"}}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("<is><t>a</t></is>", "a"),
        ("<is><r><t>a</t></r><r><t xml:space='preserve'> b</t></r></is>", "a b"),
        ("<is><t>漢</t><rPh sb='0' eb='1'><t>kan</t></rPh></is>", "漢"),
        ("<is><t>a_x000D_b</t></is>", "a\rb"),
        ("<is><t>a_x005F_x000D_b</t></is>", "a_x000D_b"),
        ("<is><t>a_xD800_b</t></is>", "a_xD800_b"),
        ("<is><t>=cmd|' /C calc'!A0</t></is>", "=cmd|' /C calc'!A0"),
        ("<is><t>#N/A</t></is>", ErrorCell("#N/A")),
    ],
)
def test_texts(text, value):
    """Texts come with all their pieces, without their reading aid, as text whatever they begin with, shared or not."""
    assert _read(book_of(_row(f'<c r="A1" t="inlineStr">{text}</c>'))) == {1: {1: value}}
    shared = f'<sst xmlns="{MAIN}"><si><t>other</t></si>{text.replace("is>", "si>")}</sst>'
    assert _read(book_of(_row('<c r="A1" t="s"><v>1</v></c>'), **{STRINGS: shared})) == {1: {1: value}}


@pytest.mark.parametrize("dimension", ["A1", "A1:A1", "C9:D9", "A1:XFD1048576", "nonsense", ""])
def test_the_dimension_record_is_not_believed(dimension):
    """Whatever a sheet says of its size, all of it is read."""
    data = book_of(**{SHEET: sheet_of(CORNERS, before=f'<dimension ref="{dimension}"/>')})
    assert _read(data) == {1: {1: 1}, 1_048_576: {16_384: 2}}


def test_the_corners_of_a_sheet_cost_two_cells():
    """Values in A1 and XFD1048576, and a merge of all between, take no time and no memory for what is between."""
    merge = '<mergeCells><mergeCell ref="A1:XFD1048576"/></mergeCells>'
    data = book_of(**{SHEET: sheet_of(CORNERS, after=merge)})
    _read(data)
    tracemalloc.start()
    _read(data)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 8 * 2**20


def test_far_cells_cost_no_blank_ones():
    """Rows with a cell in the last column cost what rows with a cell in the first do."""
    spent = []
    for letters in ("A", "XFD"):
        rows = "".join(f'<row r="{row}"><c r="{letters}{row}"><v>1</v></c></row>' for row in range(1, 1001))
        data = book_of(rows)
        start = time.process_time()
        assert len(_read(data)) == 1000
        spent.append(time.process_time() - start)
    assert spent[1] < 3 * spent[0] + 0.2


def test_a_square_of_blank_cells_is_refused():
    """Blank cells by the million are refused by their number, whatever little they take."""
    letters = [f"{a}{b}" for a in "ABCDEFGHIJ" for b in "ABCDEFGHIJ"]
    rows = "".join(f'<row r="{row}">{"".join(f"<c r={chr(34)}{one}{row}{chr(34)}/>" for one in letters)}</row>'
                   for row in range(1, 41))  # fmt: skip
    refusal = _refusal(book_of(rows), cells=3_999)
    assert (refusal.code, refusal.facts["found"], refusal.facts["setting"]) == ("E110", "4,000", "cells")
    assert _read(book_of(rows), cells=4_000) == {}


def test_a_million_blank_rows_are_refused():
    """What shrinks too well to be a submission is refused, however few cells it holds."""
    assert _refusal(book_of('<row s="0"/>' * 1_100_000)).facts["setting"] == "compression"


def test_one_text_in_many_cells():
    """A long text that many cells share is refused before its copies fill the memory."""
    strings = f'<sst xmlns="{MAIN}"><si><t>{"x" * 32_767}</t></si></sst>'
    rows = "".join(f'<row r="{row}"><c t="s"><v>0</v></c></row>' for row in range(1, 41))
    refusal = _refusal(book_of(rows, **{STRINGS: strings}), unpacked_mebibytes=1)
    assert (refusal.code, refusal.facts["setting"]) == ("E110", "unpacked_mebibytes")
    assert len(_read(book_of(rows, **{STRINGS: strings}), unpacked_mebibytes=2)) == 40


def test_texts_are_not_counted_where_they_claim_to_be_many():
    """Four milliards of shared texts that are only claimed harm nobody."""
    claimed = f'<sst xmlns="{MAIN}" count="4294967295" uniqueCount="4294967295"><si><t>a</t></si></sst>'
    assert _read(book_of(_row(_number("0", t="s")), **{STRINGS: claimed})) == {1: {1: "a"}}


def test_cells_without_addresses_keep_their_places():
    """A cell without address follows the one before; elements of other programs in a row move nothing."""
    rows = '<row><x xmlns="urn:x"/><c><v>1</v></c><c/><c><v>2</v></c></row>'
    rows += '<row r="5"><c r="C5"><v>3</v></c><c><v>4</v></c></row>'
    assert _read(book_of(rows)) == {1: {1: 1, 3: 2}, 5: {3: 3, 4: 4}}


def test_errors_and_formulas_without_result_are_told():
    """Error cells are errors and formulas without a stored result are told as such, not as blanks."""
    cells = _row(
        _number("#REF!", t="e"), '<c r="B1"><f>1+1</f></c>', '<c r="C1" t="e"/>', '<c r="D1"><f>1</f><v>3</v></c>'
    )
    assert _read(book_of(cells)) == {1: {1: ErrorCell("#REF!"), 2: Unstored(), 3: ErrorCell("an error"), 4: 3}}


def test_formulas_are_told_by_sheet():
    """Formulas without a result are kept apart by the sheets they stand in."""
    links = parts_of()[RELATIONS].replace(
        "</Relationships>", relation(9, "worksheet", "worksheets/sheet2.xml") + "</Relationships>"
    )
    titles = ['<sheet name="S" sheetId="1" r:id="rId1"/>', '<sheet name="Δ &amp; more" sheetId="2" r:id="rId9"/>']
    second = {"xl/worksheets/sheet2.xml": sheet_of('<row r="7"><c r="C7"><f>1</f></c></row>')}
    cells = read_workbook(book_of(**{WORKBOOK: workbook_part(titles), RELATIONS: links, **second}), ReadingLimits())
    assert {sheet.name: sheet.rows for sheet in cells.sheets} == {"S": {1: {1: 1}}, "Δ & more": {7: {3: Unstored()}}}


def test_hidden_and_merged_are_told():
    """Hidden rows and merged areas come with the sheet."""
    sheet = sheet_of('<row r="3" hidden="1"><c r="A3"><v>1</v></c></row>', after='<mergeCell ref="A3:B4"/>')
    (found,) = read_workbook(book_of(**{SHEET: sheet}), ReadingLimits()).sheets
    assert (found.hidden_rows, found.merged, found.hidden) == ({3}, ((3, 1, 4, 2),), False)


def test_strict_open_xml_is_read_whole():
    """A workbook of the Strict dialect gives the cells that the usual one gives."""
    rows = _row(_number("1.6"), _number("1", "B1", t="s"), _number("45000", "C1", s=1))
    parts = parts_of(rows, **{STYLES: styles_of(0, 14)})
    strict = {
        name: text.replace(MAIN, "http://purl.oclc.org/ooxml/spreadsheetml/main").replace(
            OFFICE, "http://purl.oclc.org/ooxml/officeDocument/relationships"
        )
        for name, text in parts.items()
    }
    assert _read(archive_of(strict)) == _read(archive_of(parts)) != {}


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig", "iso-8859-1", "windows-1252"])
def test_parts_in_other_encodings(encoding):
    """A sheet in another encoding that it declares is read as in the usual one."""
    sheet = sheet_of(_row('<c r="A1" t="inlineStr"><is><t>1,6 µm</t></is></c>'))
    named = encoding.removesuffix("-sig")
    data = f'<?xml version="1.0" encoding="{named}"?>{sheet}'.encode(encoding)
    assert _read(book_of(**{SHEET: data})) == {1: {1: "1,6 µm"}}


PARTS_THAT_ANOTHER_READS = {
    "nonsense for custom properties": {"docProps/custom.xml": "<x/>"},
    "no XML for custom properties": {"docProps/custom.xml": "x"},
    "an entity in custom properties": {"docProps/custom.xml": '<!DOCTYPE x [<!ENTITY a "b">]><x/>'},
    "custom properties in UTF-16 with an entity": {
        "docProps/custom.xml": '<!DOCTYPE x [<!ENTITY a "b">]><x>&a;</x>'.encode("utf-16")
    },
    "no list of types": {TYPES: None},
    "a list of types without a workbook": {TYPES: f'<Types xmlns="{MAIN}"/>'},
    "styles that are none": {STYLES: f'<styleSheet xmlns="{MAIN}"><cellXfs><xf numFmtId="x"/></cellXfs></styleSheet>'},
}


@pytest.mark.parametrize("what", PARTS_THAT_ANOTHER_READS)
def test_no_error_of_a_library_comes_through(what):
    """Whatever is wrong in a part that only the library reads, the workbook is read or refused in our words."""
    refusal = _refusal(book_of(**PARTS_THAT_ANOTHER_READS[what]))
    assert refusal is None or (refusal.code in {"E102", "E105"} and refusal.facts == {})


def test_properties_say_what_a_workbook_is():
    """Role, template version and date are those of the document's properties."""
    custom = (
        '<Properties xmlns="http://schemas.openxmlformats.org/officeDocument/2006/custom-properties" '
        'xmlns:vt="http://schemas.openxmlformats.org/officeDocument/2006/docPropsVTypes">'
        '<property fmtid="{D5CDD505-2E9C-101B-9397-08002B2CF9AE}" pid="2" name="flexlash"><vt:lpwstr>report</vt:lpwstr>'
        '</property><property fmtid="{D5CDD505-2E9C-101B-9397-08002B2CF9AE}" pid="3" name="flexlash_template_version">'
        "<vt:i4>7</vt:i4></property></Properties>"
    )
    core = '<a xmlns:d="http://purl.org/dc/terms/"><d:modified>2026-01-02T03:04:05Z</d:modified></a>'
    cells = read_workbook(book_of(**{"docProps/custom.xml": custom, CORE: core}), ReadingLimits())
    assert (cells.role, cells.template_version) == ("report", "7")
    assert cells.modified == datetime.datetime(2026, 1, 2, 3, 4, 5)  # noqa: DTZ001


def test_a_flipped_bit_never_reads_as_another_value():
    """Wherever one bit of a workbook flips, it is refused or reads exactly as before."""
    rows = _row(_number("1.6"), _number("1", "B1", t="s"), '<c r="C1"><f>1</f></c>')
    data = book_of(rows, method=zipfile.ZIP_STORED)
    sound = read_workbook(data, ReadingLimits())
    draw = np.random.default_rng(7)
    read = 0
    for place, bit in draw.integers((0, 0), (len(data), 8), size=(300, 2)):
        changed = bytearray(data)
        changed[place] ^= 1 << bit
        with contextlib.suppress(Refusal):
            assert read_workbook(bytes(changed), ReadingLimits()) == sound
            read += 1
    assert 0 < read < 75


@pytest.mark.slow
def test_mutilated_parts_end_in_a_refusal_or_cells():
    """Parts with pieces deleted, doubled and swapped, checksums right, give cells or a refusal, and no other end."""
    parts = parts_of(_row(_number("1.6"), _number("1", "B1", t="s")), **{STYLES: styles_of(0, 14)})
    draw = random.Random(11)  # noqa: S311
    ends = set()
    for _ in range(300):
        changed = dict(parts)
        name = draw.choice(sorted(changed))
        text = changed[name]
        start, end = sorted(draw.sample(range(len(text)), 2))
        end = min(end, start + 20)
        changed[name] = draw.choice([
            text[:start] + text[end:], text[:end] + text[start:], text[:start] + draw.choice('0-9<>&"é\0') + text[end:]
        ])  # fmt: skip
        refusal = _refusal(archive_of(changed))
        ends.add(refusal.code if refusal else "read")
    assert {"read", "E102"} <= ends <= {"read", "E101", "E102", "E105", "E106", "E110"}


@pytest.mark.parametrize(
    ("number_format", "code", "percentage"),
    [(9, "", True), (10, "", True), (164, "0.0%", True), (164, '0.0" %"', False), (164, "0\\%", False), (2, "", False)],
)
def test_numbers_that_are_shown_as_percentages(number_format, code, percentage):
    """A number whose cell shows it times a hundred knows it; a percent sign that is merely shown does not count."""
    own = f'<numFmts count="1"><numFmt numFmtId="164" formatCode="{escape(code, QUOTES)}"/></numFmts>' if code else ""
    cells = f'<cellXfs><xf numFmtId="0"/><xf numFmtId="{number_format}"/></cellXfs>'
    styles = f'<styleSheet xmlns="{MAIN}">{own}{cells}</styleSheet>'
    found = _read(book_of(_row(_number("0.05", s="1"), _number("7", "B1")), **{STYLES: styles}))[1]
    assert found == {1: 0.05, 2: 7}
    assert [isinstance(value, Percentage) for value in found.values()] == [percentage, False]


def test_only_the_named_sheets_are_read():
    """Sheets that are not asked for are neither read nor counted, nor refused for what stands in them."""
    book = openpyxl.Workbook()
    for name, cells in (("Wanted", 3), ("Other", 300)):
        sheet = book.create_sheet(name)
        for row in range(1, cells + 1):
            sheet.cell(row, 1, row)
    buffer = io.BytesIO()
    book.save(buffer)
    limits = ReadingLimits(cells=3)
    found = read_workbook(buffer.getvalue(), limits, only=["Wanted", "Absent"])
    assert [(sheet.name, len(sheet.rows)) for sheet in found.sheets] == [("Wanted", 3)]
    with pytest.raises(Refusal) as refusal:
        read_workbook(buffer.getvalue(), limits)
    assert refusal.value.code == "E110"


def _lowered(rows):
    return rows.replace('r="A', 'r="a').replace('r="B', 'r="b')


def test_addresses_in_small_letters_are_the_same_addresses():
    """A workbook whose program writes a1 for A1 is read like any other, merged areas and formulas included."""
    rows = (
        _row('<c r="A1"><v>1.6</v></c>', '<c r="B1" t="s"><v>0</v></c>')
        + '<row r="2"><c r="B2"><f>B1</f></c><c r="C2" t="e"><v>#N/A</v></c></row>'
    )
    merges = '<mergeCells><mergeCell ref="A1:B1"/></mergeCells>'
    usual, small = (
        read_workbook(book_of(**{SHEET: sheet_of(text, after=after)}), ReadingLimits())
        for text, after in ((rows, merges), (_lowered(rows), merges.lower().replace("cell", "Cell")))
    )
    assert small == usual
    assert small.sheets[0].rows[1] == {1: 1.6, 2: "first"}


def test_a_text_where_its_kind_does_not_expect_it():
    """A cell of kind inlineStr is read by its text inside, which holds, or else by its value, as a text."""
    inside = '<c r="A1" t="inlineStr"><is><t>in</t></is><v>beside</v></c>'
    value = '<c r="B1" t="inlineStr"><v>160 _x0041_</v></c>'
    formula = '<c r="C1" t="inlineStr"><f>"x"</f><is><t>x</t></is></c>'
    error = '<c r="D1" t="inlineStr"><v>#REF!</v></c>'
    assert _read(book_of(_row(inside, value, formula, error))) == {
        1: {1: "in", 2: "160 A", 3: "x", 4: ErrorCell("#REF!")}
    }


def test_an_archive_of_a_mac_is_read():
    """What macOS puts beside the parts of a workbook changes nothing of what is read."""
    litter = {f"__MACOSX/._{name}": b"\0\5\x16\7<!DOCTYPE plist>" for name in parts_of()}
    assert _read(archive_of(parts_of() | {"__MACOSX/": "", ".DS_Store": b"\0"} | litter)) == _read(book_of())
