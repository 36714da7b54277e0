"""Delimited texts of all countries: the right cells at the right addresses, and what was recognised is told."""

from __future__ import annotations

import time
import tracemalloc

import pytest

from flexlash.reading.delimited import WINDOWS, read_table
from flexlash.reading.raw import CommaNumber, DoubtfulNumber, ErrorCell
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal


def _read(content):
    """Return a text, or bytes, as a sheet."""
    return read_table(content if isinstance(content, bytes) else content.encode(), "Variants", "a.csv")


def _refused(content):
    with pytest.raises(Refusal) as caught:
        _read(content)
    return caught.value.code


TABLES = {
    "plain": ("a,b\n1,2\n", {1: {1: "a", 2: "b"}, 2: {1: "1", 2: "2"}}),
    "carriage returns": ("a,b\r\n1,2\r\n", {1: {1: "a", 2: "b"}, 2: {1: "1", 2: "2"}}),
    "byte order mark": ("\ufeffa,b\n", {1: {1: "a", 2: "b"}}),
    "semicolon": ("a;b\n1,5;2\n", {1: {1: "a", 2: "b"}, 2: {1: "1,5", 2: "2"}}),
    "tab": ("a\tb\n1,5\t2\n", {1: {1: "a", 2: "b"}, 2: {1: "1,5", 2: "2"}}),
    "blank lines": ("\n\na,b\n\n1,2\n\n", {3: {1: "a", 2: "b"}, 5: {1: "1", 2: "2"}}),
    "blank cells": ("a,,c\n,,\n, ,3\n", {1: {1: "a", 3: "c"}, 3: {3: "3"}}),
    "quoted line break": ('a,b\n"x\ny",2\nz,3\n', {1: {1: "a", 2: "b"}, 2: {1: "x\ny", 2: "2"}, 3: {1: "z", 2: "3"}}),
    "quoted delimiter": ('a,b\n"x,y",2\n', {1: {1: "a", 2: "b"}, 2: {1: "x,y", 2: "2"}}),
    "quoted quote": ('a,b\n"5"" pipe",2\n', {1: {1: "a", 2: "b"}, 2: {1: '5" pipe', 2: "2"}}),
    "ragged": ("a,b,c\n1\n1,2,3,4\n", {1: {1: "a", 2: "b", 3: "c"}, 2: {1: "1"}, 3: {1: "1", 2: "2", 3: "3", 4: "4"}}),
    "no last line end": ("a,b\n1,2", {1: {1: "a", 2: "b"}, 2: {1: "1", 2: "2"}}),
    "one column": ("a\n1\n", {1: {1: "a"}, 2: {1: "1"}}),
    "spaces kept": ("a,b\n x ,2\n", {1: {1: "a", 2: "b"}, 2: {1: " x ", 2: "2"}}),
    "only white space": (" \n\t\n", {}),
}


@pytest.mark.parametrize("what", TABLES)
def test_csv_rows_are_numbered_as_excel_shows_them(what):
    """A CSV file's cells have the addresses that Excel would show, with the header in row 1 or where it stands."""
    content, rows = TABLES[what]
    assert _read(content).rows == rows


@pytest.mark.parametrize(
    ("content", "delimiter"),
    [
        ("a,b\n", ","),
        ("a;b\n", ";"),
        ("a\tb\n", "\t"),
        ("a\n1;2;3\n", ";"),
        ("a;b;c\n1,5;2,5;3,5\n1,6;2,6;3,6\n", ";"),
        ("a\tb\n1,5;2\t3\n", "\t"),
        ("a,b\nx;y;z,1\n", ","),
        ('a,b\n"1;2;3","4;5;6"\n', ","),
        ("a|b\n1,5|2\n", "|"),
        ("a\n1\n", ","),
        ("", ","),
    ],
)
def test_the_delimiter_makes_even_rows(content, delimiter):
    """Of comma, semicolon, tab and bar that is the delimiter which makes the most rows of one width."""
    assert _read(content).dialect.delimiter == delimiter


DECIMAL_COMMAS = """a;b;c;d;e;f
1,1;1,2;1,3;1,4;;
2,1;2,2;2,3;2,4;x;
3,1;3,2;3,3;3,4;;y
"""


def test_decimal_commas_do_not_pass_for_delimiters():
    """A table with semicolons and decimal commas has semicolons, also where the last cells are blank."""
    assert _read(DECIMAL_COMMAS).dialect.delimiter == ";"


@pytest.mark.parametrize("title", ["Study of spring", "Study, spring, 2026"])
def test_a_title_above_does_not_tell_the_delimiter(title):
    """A line of title above the header row does not hide that the table has semicolons."""
    assert _read(f"{title}\nvariant;material\nA;20Cr2Ni4\n").rows[3] == {1: "A", 2: "20Cr2Ni4"}


def test_lines_of_an_old_mac():
    """A table saved as CSV (Macintosh) is read."""
    assert _read("a,b\r1,2\r").rows == {1: {1: "a", 2: "b"}, 2: {1: "1", 2: "2"}}


@pytest.mark.parametrize("content", ['a,b\n"x,2\n', 'a,b\n"x"y,2\n', 'a,b\n"' + "x\n" * 200_000])
def test_a_broken_table_is_damage(content):
    """Quotes that do not match make a table damaged."""
    assert _refused(content) == "E102"


@pytest.mark.parametrize("length", [32_768, 200_000])
@pytest.mark.parametrize("table", ["{},b\n1,2\n", "a,b\n1,{}\n", '"{}";b\n1;2\n', "{}\n1\n"])
def test_a_cell_without_end_is_too_long(length, table):
    """A cell of more characters than a workbook's may have is refused by that limit, wherever it stands."""
    with pytest.raises(Refusal) as caught:
        _read(table.format("x" * length))
    assert (caught.value.code, caught.value.facts["setting"]) == ("E110", "characters")
    assert _read("a,b\n1,{}\n".format("x" * 32_767)).rows[2][2] == "x" * 32_767


def test_an_open_quote_in_a_later_column_is_damage():
    """A quote that does not close makes a table damaged in whichever column it stands."""
    assert _refused('variant,material,notes\nA,20Cr2Ni4,"open\nB,20Cr2Ni4,x\n') == "E102"


@pytest.mark.parametrize("error", ["#REF!", "#N/A"])
def test_error_words_of_a_table_are_errors(error):
    """An Excel error that was saved as CSV is an error there too."""
    assert _read(f"variant,material\n{error},20Cr2Ni4\n").rows[2][1] == ErrorCell(error)


def test_a_table_beside_is_named_as_asked():
    """A CSV file given beside a submission becomes the sheet that it stands for."""
    sheet = read_table(b"a;b\n", "Tolerances", "fine.csv")
    assert (sheet.name, sheet.dialect.file) == ("Tolerances", "fine.csv")


@pytest.mark.parametrize("line", ["sep=;", "SEP=;", '"sep=;"'])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_a_line_for_excel_tells_the_delimiter_and_is_no_row(line, end, mark):
    """The line sep=; wins over what the rows look like, and Excel counts the rows from below it."""
    sheet = _read(f"{mark}{line}{end}a,b;c,d{end}1,2;3,4{end}")
    assert sheet.dialect.delimiter == ";"
    assert sheet.rows[1] == {1: "a,b", 2: "c,d"}


ENCODINGS = {
    "utf-8": "UTF-8",
    "utf-8-sig": "UTF-8",
    "utf-16": "UTF-16",
    "cp1252": WINDOWS,
    "latin-1": WINDOWS,
}


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_encodings_of_excel_are_read_and_told(encoding):
    """A table in UTF-8, in UTF-16 with its mark or in Windows-1252 is read letter by letter and says which it was."""
    sheet = _read("Länge [µm]\tb\nMüller\t5\n".encode(encoding))
    assert sheet.rows == {1: {1: "Länge [µm]", 2: "b"}, 2: {1: "Müller", 2: "5"}}
    assert sheet.dialect.encoding == ENCODINGS[encoding]


@pytest.mark.parametrize("mark", ["", "\ufeff"])
@pytest.mark.parametrize("order", ["utf-16-le", "utf-16-be"])
def test_both_byte_orders(order, mark):
    """UTF-16 is read in the order of bytes that its mark tells, or else the zeros beside its ASCII letters."""
    sheet = _read(f"{mark}Länge\tΔ\n1,6\tx\n".encode(order))
    assert sheet.rows == {1: {1: "Länge", 2: "Δ"}, 2: {1: "1,6", 2: "x"}}
    assert sheet.dialect.encoding == "UTF-16"


@pytest.mark.parametrize("order", ["utf-32-le", "utf-32-be"])
def test_four_bytes_a_letter(order):
    """UTF-32 with its mark is read."""
    assert _read("\ufeffa;Δ\n1;2\n".encode(order)).rows[1] == {1: "a", 2: "Δ"}


def test_a_text_that_other_encodings_would_show_otherwise_has_an_address():
    """In Windows-1252 the first cell beyond ASCII is named, in Unicode none."""
    table = "a,b\nx,Müller\ny,Möller\n"
    assert _read(table.encode("cp1252")).dialect.foreign_text == (2, 2)
    assert _read(table).dialect.foreign_text is None


UNREADABLE = {
    "no letter of Windows-1252": ("E107", b"a,b\nx," + b"\x81\x8d\n"),
    "control characters and no Unicode": ("E107", b"a,b\n\x01\xe4,2\n"),
    "Unicode cut off": ("E107", "a,b\n".encode("utf-16")[:-1]),
    "Unicode without its mark, cut off": ("E102", "a,b\n1,2\n".encode("utf-16-le")[:-1]),
    "UTF-8 with its mark and a wrong byte": ("E107", b"\xef\xbb\xbfa,b\n\xe4,2\n"),
    "a zero far down": ("E102", b"a,b\n" * 2000 + b"\0,2\n"),
}


@pytest.mark.parametrize("what", UNREADABLE)
def test_what_is_no_text_is_refused(what):
    """Bytes that have no meaning as a table's text are refused, never shown as other letters."""
    code, content = UNREADABLE[what]
    assert _refused(content) == code


NUMBERS = {
    "one comma is beyond doubt": ("a;b\n1,6;800\n", [(2, 1)], []),
    "thousandths beside it": ("a;b\n1,6;1,234\n", [(2, 1), (2, 2)], []),
    "signs and powers": ("a;b\n-0,02;1,5e3\n", [(2, 1), (2, 2)], []),
    "below one": ("a;b\n0,125;,5\n", [(2, 1), (2, 2)], []),
    "more digits before": ("a;b\n1600,125;2\n", [(2, 1)], []),
    "tab": ("a\tb\n1,6\t800\n", [(2, 1)], []),
    "bar": ("a|b\n1,6|800\n", [(2, 1)], []),
    "spaces around": ("a;b\n 1,6 ;800\n", [(2, 1)], []),
    "texts with commas are no numbers": ("a;b\n1,6 mm;x,5\n", [], []),
    "only thousands or thousandths": ("a;b\n1,234;800\n", [], []),
    "a point elsewhere": ("a;b\n1,6;2.5\n", [], []),
    "a point that may be thousands": ("a;b\n1,6;1.600\n", [(2, 1)], [(2, 2)]),
    "both signs in one number": ("a;b;c\n1.200,5;1,6;1.200\n", [(2, 2)], [(2, 3)]),
    "a lone comma among points, and thousandths": ("a;b;c;d\n1.6;1.7;1.8;1,7\n1.200;;;\n", [], []),
    "a comma that may be thousands beside such a point": ("a;b;c\n1,6;1,234;1.600\n", [(2, 1)], [(2, 2), (2, 3)]),
    "a lone point among commas": ("a;b;c;d\n1,6;1,7;1,8;1.7\n", [(2, 1), (2, 2), (2, 3)], [(2, 4)]),
    "too few commas for a lone point": ("a;b;c\n1,6;1,7;1.7\n", [], []),
    "a lone comma among points": ("a;b;c;d\n1.6;1.7;1.8;1,7\n", [], []),
    "undecided, with a point that may be thousands": ("a;b;c\n1,6;1.7;1.200\n", [], [(2, 1), (2, 3)]),
    "both signs alone, with such a point": ("a;b\n1.200,5;1.200\n", [], [(2, 1), (2, 2)]),
    "points before three digits alone": ("a;b\n1.050;160\n", [], [(2, 1)]),
    "such points in a table of tabs": ("a\tb\n12.500\t-1.050\n", [], [(2, 1), (2, 2)]),
    "such points in a table of bars": ("a|b\n1.050|160\n", [], [(2, 1)]),
    "such points beside texts": ("a;b\n1.050;1.5 mm\n2.500;x.5\n", [], [(2, 1), (3, 1)]),
    "such points beside points of thousands": ("a;b\n1.050;1.234.567\n", [], [(2, 1), (2, 2)]),
    "one decimal proves the point": ("a;b\n1.050;1.6\n", [], []),
    "two decimals prove the point": ("a;b\n1.050;80.25\n", [], []),
    "four decimals prove the point": ("a;b\n1.050;1.6000\n", [], []),
    "a zero before it proves the point": ("a;b\n1.050;0.050\n", [], []),
    "no digit before it proves the point": ("a;b\n1.050;.050\n", [], []),
    "four digits before it prove the point": ("a;b\n1.050;1600.125\n", [], []),
    "a power proves the point": ("a;b\n1.050;1.600e3\n", [], []),
    "commas of thousands prove the point": ("a;b\n1.050;1,200.5\n", [], []),
    "points as decimals and commas as thousands": ("a;b;c\n1,200.5;1.6;1,200\n", [], []),
    "a point before thousandths": ("a;b\n1,6;0.600\n", [], []),
    "points alone": ("a;b\n1.600;2.5\n", [], []),
    "comma-separated": ('a,b\n"1,6",800\n', [], []),
    "comma-separated, with points": ("a,b\n1.050,160\n", [], []),
    "comma-separated, with a quoted comma and such a point": ('a,b\n"1,6",1.050\n', [], [(2, 1), (2, 2)]),
    "comma-separated, with a comma that may be thousands": ('a,b\n"1,050",1.050\n', [], []),
    "comma-separated, with points that prove it": ('a,b,c,d,e\n"1,6",1.050,1.6,1.7,1.8\n', [], []),
}


@pytest.mark.parametrize("what", NUMBERS)
def test_numbers_with_a_decimal_comma(what):
    """Numbers have a decimal comma where one can be nothing else and no point contradicts; doubt marks its numbers."""
    content, commas, doubtful = NUMBERS[what]
    sheet = _read(content)
    found = {CommaNumber: [], DoubtfulNumber: []}
    for number, cells in sheet.rows.items():
        for place, cell in cells.items():
            found.get(type(cell), []).append((number, place))
    assert (found[CommaNumber], found[DoubtfulNumber]) == (commas, doubtful)
    assert sheet.dialect.comma_number == (commas[0] if commas else None)


def test_the_first_number_named_is_beyond_doubt():
    """The example that is told of a table is no number that might mean thousands."""
    assert _read("a;b\n1,234;1,6\n").dialect.comma_number == (2, 2)


NAMED = "variant;material;torque_Nm;wall_thickness_mm;Revision\n{};20Cr2Ni4;{};2;{}\n"


@pytest.mark.parametrize(("variant", "revision"), [("1.5", "A"), ("A", "1.2"), ("1,5", "1,2"), ("A", "12.11.2026")])
def test_only_numbers_tell_what_a_point_is(variant, revision):
    """A name or a revision that looks like a number proves nothing."""
    sheet = _read(NAMED.format(variant, "1.050", revision))
    kinds = {place: type(cell) for place, cell in sheet.rows[2].items()}
    assert (kinds[1], kinds[2], kinds[3], kinds[4]) == (str, str, DoubtfulNumber, str)
    assert sheet.dialect.comma_number is None


def test_own_columns_are_in_doubt_as_well():
    """A number of a column that is not the template's own proves nothing, but is in doubt like the others."""
    sheet = _read(NAMED.format("A", "1.050", "1.200"))
    assert {place for place, cell in sheet.rows[2].items() if type(cell) is DoubtfulNumber} == {3, 5}
    sheet = _read(NAMED.format("A", "800", "1.200"))
    assert type(sheet.rows[2][5]) is DoubtfulNumber
    sheet = _read(NAMED.format("1,5", "1,6", "1,7"))
    assert [type(sheet.rows[2][place]) for place in (1, 3, 5)] == [str, CommaNumber, CommaNumber]


@pytest.mark.parametrize("comma", ["2", "2,5"])
@pytest.mark.parametrize("point", ["2", "2.5"])
def test_the_answer_never_depends_on_a_decimal_comma_elsewhere(comma, point):
    """A point before three digits is in doubt with a decimal comma beside it and without one."""
    cells = [[f"V{row}", "20Cr2Ni4", "1.050", point] for row in range(4)] + [["W", "20Cr2Ni4", "800", comma]]
    sheet = _read("variant;material;torque_Nm;wall_thickness_mm\n" + "\n".join(map(";".join, cells)))
    assert {type(sheet.rows[row][3]) for row in range(2, 6)} == ({str} if point == "2.5" else {DoubtfulNumber})


SPLIT = "variant,material,torque_Nm,wall_thickness_mm,notes\n"


@pytest.mark.parametrize(
    ("rows", "longer"),
    [
        ("A,s,800,1,6,\n", {2}),
        ("A,s,800,2,\nB,s,800,1,6,\n\nC,s,800,1,6,\n", {3, 5}),
        ("A,s,800,2,x\nB,s,800\n", set()),
        ("A,s,800,1,6,\nB,s,0.8,2,x\n", set()),
        ('A,s,"800,5",1,6,\n', {2}),
    ],
)
def test_a_row_with_one_value_more_than_headers(rows, longer):
    """A row of more cells than headers is noted, also where the last is blank, unless numbers have decimal points."""
    assert _read(SPLIT + rows).dialect.longer == longer


def test_rows_above_the_headers_and_other_delimiters_do_not_count():
    """A title may be wider than the header row, and a semicolon too many at each end is no split number."""
    assert _read("Study,of,many,things,in,one\n" + SPLIT + "A,s,800,2,\n").dialect.longer == frozenset()
    assert _read(SPLIT.replace(",", ";") + "A;s;800;2;;\n").dialect.longer == frozenset()


def _measured(content, **limits):
    """Return the refusal of a table, the processor seconds and the most memory [MiB] that reading took."""
    tracemalloc.start()
    start = time.process_time()
    with pytest.raises(Refusal) as caught:
        read_table(content, "Variants", "a.csv", ReadingLimits(**limits))
    seconds = time.process_time() - start
    peak = tracemalloc.get_traced_memory()[1] / 2**20
    tracemalloc.stop()
    return caught.value.facts["setting"], seconds, peak


ENDLESS = {
    "a million columns": ("columns", lambda: b",".join(b"c%d" % number for number in range(1_000_000))),
    "commas": ("columns", lambda: b"," * (20 * 2**20)),
    "rows of commas": ("columns", lambda: (b"," * 300 + b"x\n") * 60_000),
    "line ends": ("table_rows", lambda: b"a,b\n" + b"\n" * 19_000_000 + b"1,2"),
    "short rows": ("table_rows", lambda: b"a,b\n" + b"1,2\n" * 5_000_000),
    "short rows behind a quote": ("table_rows", lambda: b'"a",b\n' + b"\n" * 19_000_000 + b"1,2"),
    "cells": ("table_cells", lambda: (b",".join([b"ab"] * 200) + b"\n") * 34_000),
    "one record over many lines": ("columns", lambda: b"a,b\n" + b'"x\n",' * 3_000_000),
    "quotes": ("characters", lambda: b'"' * (20 * 2**20)),
    "blanks": ("characters", lambda: b" " * 19_000_000 + b"\n,"),
}  # fmt: skip


SMALLER = {"short rows behind a quote": {"table_rows": 50_000}, "cells": {"table_cells": 50_000}}
"""Limits of what takes long while memory is traced."""


@pytest.mark.slow
@pytest.mark.parametrize("what", ENDLESS)
def test_counts_refuse_before_clocks(what):
    """Rows, columns, cells and characters without end are counted while reading, in little time and memory."""
    setting, make = ENDLESS[what]
    found, seconds, peak = _measured(make(), **SMALLER.get(what, {}))
    assert found == setting
    assert seconds < 10
    assert peak < 280


def test_limits_of_tables_at_their_value():
    """A table at a limit of rows, columns or cells is read; one more is refused."""
    table = b"a,b,c\n1,2,3\n4,5,6"
    for setting, value in (("table_rows", 3), ("columns", 3), ("table_cells", 9)):
        assert len(read_table(table, "Variants", limits=ReadingLimits(**{setting: value})).rows) == 3
        assert _measured(table, **{setting: value - 1})[0] == setting


def test_blank_cells_at_the_end_are_no_columns():
    """Excel's CSV of a sheet with formats far to the right has thousands of blank cells a row, which do not count."""
    assert _read("a,b" + "," * 16_382 + "\n1,2" + "," * 16_382).rows == {1: {1: "a", 2: "b"}, 2: {1: "1", 2: "2"}}


def test_texts_that_are_alike_are_held_once():
    """A table of many like rows needs little more memory than its rows."""
    rows = _read("a,b\n" + "20Cr2Ni4,standard class\n" * 1000).rows
    assert len({id(cell) for cells in rows.values() for cell in cells.values()}) == 4
