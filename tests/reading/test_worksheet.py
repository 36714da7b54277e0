"""One walk through a worksheet: what it notes, and what it refuses because readers would take it for something else."""

import pytest
from small_workbook import MAIN, ONE, sheet_of

from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.worksheet import Worksheet


def _walked(rows, *, styles=1, strings=2, after="", **limits):
    data = rows if rows.startswith("<worksheet") else sheet_of(rows, after=after)
    return Worksheet(data.encode(), ReadingLimits(**limits), styles, strings)


def _refused(rows, **options):
    """Return the code by which rows are refused, or None."""
    try:
        _walked(rows, **options)
    except Refusal as refusal:
        return refusal.code
    return None


def _cell(inside, **attributes):
    written = "".join(f' {name}="{value}"' for name, value in {"r": "A1", **attributes}.items())
    return f'<row r="1"><c{written}>{inside}</c></row>'


REFUSED = {
    "rows out of order": '<row r="2"/><row r="1"/>',
    "a row twice": '<row r="2"/><row r="2"/>',
    "a row without number after one beyond": '<row r="1048576"/><row/>',
    "a row 0": '<row r="0"/>',
    "a row beyond Excel": '<row r="1048577"/>',
    "a row 2,000,000,000": '<row r="2000000000"/>',
    "a row that is no number": '<row r="x"/>',
    "a row with a fraction": '<row r="1.0"/>',
    "a negative row": '<row r="-1"/>',
    "a row in other digits": '<row r="١"/>',
    "a row inside a row": '<row r="1"><c r="A1"><v>1</v></c><row r="2"><c r="A2"><v>2</v></c></row></row>',
    "a row outside the rows": f'<worksheet xmlns="{MAIN}"><row r="1"/><sheetData/></worksheet>',
    "a row behind the rows": f'<worksheet xmlns="{MAIN}"><sheetData/><x><row r="1"/></x></worksheet>',
    "rows in two places": f'<worksheet xmlns="{MAIN}"><sheetData/><sheetData/></worksheet>',
    "cells out of order": '<row r="1"><c r="B1"/><c r="A1"/></row>',
    "cells out of order behind Z": '<row r="1"><c r="AA1"/><c r="Z1"/></row>',
    "a cell twice": '<row r="1"><c r="B1"/><c r="B1"/></row>',
    "a cell behind one without address": '<row r="1"><c/><c r="A1"/></row>',
    "a cell in another row": '<row r="1"><c r="A2"/></row>',
    "a cell outside any row": '<c r="A1"/>',
    "a cell inside a cell": _cell("<c><v>1</v></c>"),
    "a cell beyond Excel": '<row r="1"><c r="XFE1"/></row>',
    "a cell without letters": '<row r="1"><c r="1"/></row>',
    "an absolute reference": '<row r="1"><c r="$A$1"/></row>',
    "a padded row number": '<row r="1"><c r="A01"/></row>',
    "an address of two cells": '<row r="1"><c r="A1:B1"/></row>',
    "a style that does not exist": _cell("<v>1</v>", s=1),
    "a style before the first": _cell("<v>1</v>", s=-1),
    "a shared text that does not exist": _cell("<v>2</v>", t="s"),
    "a shared text before the first": _cell("<v>-1</v>", t="s"),
    "a shared text 4,294,967,295": _cell("<v>4294967295</v>", t="s"),
    "a shared text that is no number": _cell("<v>first</v>", t="s"),
    "an unknown kind of cell": _cell("<v>1</v>", t="x"),
    "a number with an underscore": _cell("<v>1_000</v>"),
    "a number with a decimal comma": _cell("<v>1,6</v>"),
    "a number in other digits": _cell("<v>١٦</v>"),
    "a word for a number": _cell("<v>seven</v>"),
    "not a number": _cell("<v>nan</v>"),
    "infinity in words": _cell("<v>inf</v>"),
    "a hexadecimal number": _cell("<v>0x10</v>"),
    "two numbers in one": _cell("<v>1 6</v>"),
    "two values in one cell": _cell("<v>1</v><v>6</v>"),
    "markup in a value": _cell("<v><b>1</b></v>"),
    "markup beside a value": _cell("<v>1<b/>6</v>"),
    "a text in a number": _cell("<is><t>1</t></is>"),
    "two texts in one cell": _cell("<is><t>1</t></is><is><t>6</t></is>", t="inlineStr"),
    "a truth value that is none": _cell("<v>2</v>", t="b"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_what_readers_would_take_for_something_else_is_damage(what):
    """What is out of order, without target or ambiguous is refused as damage."""
    assert _refused(REFUSED[what]) == "E102"


ACCEPTED = {
    "cells without addresses": ("<row><c><v>1</v></c><c/></row><row><c/></row>", 3),
    "cells partly without addresses": ('<row r="3"><c r="B3"/><c/></row>', 2),
    "the corners of Excel": ('<row r="1"><c r="A1"/></row><row r="1048576"><c r="XFD1048576"/></row>', 2),
    "an exponent": (_cell("<v>-1.6E-05</v>"), 1),
    "blanks around a number": (_cell("<v> 1.6\n</v>"), 1),
    "a number beyond doubles": (_cell("<v>1e999</v>"), 1),
    "a point without digits behind": (_cell("<v>1.</v>"), 1),
    "a comment in a value": (_cell("<v>1<!-- not -->6</v>"), 1),
    "a truth value in words": (_cell("<v>true</v>", t="b"), 1),
    "the last text": (_cell("<v>1</v>", t="s"), 1),
    "a text": (_cell("<is><t>1_000</t></is>", t="inlineStr"), 1),
    "an empty text": (_cell("<is/>", t="inlineStr"), 1),
    "a result that is a text": (_cell("<f>A2</f><v>1_000</v>", t="str"), 1),
    "a cell of another namespace": (f'{ONE}<row r="2"><c xmlns="urn:x" r="x"/></row>', 1),
    "an extension behind the cells": ('<row r="1"><c r="A1"/><extLst><ext/></extLst></row>', 1),
    "addresses in small letters": ('<row r="1"><c r="a1"><v>1</v></c><c r="ab1"/></row>', 2),
    "a text and a value beside it": (_cell("<is><t>a</t></is><v>1</v>", t="inlineStr"), 1),
    "no cell": ("", 0),
}  # fmt: skip


@pytest.mark.parametrize("what", ACCEPTED)
def test_what_is_unusual_and_clear_is_walked_through(what):
    """What is unusual and yet has one meaning is let through, and its cells are counted."""
    rows, cells = ACCEPTED[what]
    assert _walked(rows).cells == cells


FORMULAS = {
    '<c r="A1"><f>1+1</f></c>': [(1, 1)],
    '<c r="A1"><f>1+1</f><v></v></c>': [(1, 1)],
    '<c r="A1"><f>1+1</f><v/></c>': [(1, 1)],
    "<c><v>1</v></c><c><f>1+1</f></c>": [(1, 2)],
    '<c r="A1"><f>1+1</f><v>2</v></c>': [],
    '<c r="A1"><f>1+1</f><v>0</v></c>': [],
    '<c r="A1" t="str"><f>""</f><v></v></c>': [],
    '<c r="A1" t="str"><f>"x"</f><v>x</v></c>': [],
    '<c r="A1" t="e"><f>1/0</f><v>#DIV/0!</v></c>': [],
    '<c r="A1"><v>2</v></c><c r="AB1"><f>A1</f></c>': [(1, 28)],
    '<c r="A1"><f t="shared" ref="A1:B1" si="0">1</f></c><c r="B1"><f t="shared" si="0"/></c>': [(1, 1), (1, 2)],
    '<c r="A1"><f t="array" ref="A1:A1">1</f><v>1</v></c>': [],
    '<c r="A1" t="inlineStr"><f>"x"</f><is><t>x</t></is></c>': [],
    '<c r="A1" t="inlineStr"><f>"x"</f><v>x</v></c>': [],
    '<c r="A1" t="inlineStr"><f>"x"</f></c>': [(1, 1)],
    '<c r="A1"/>': [],
}


@pytest.mark.parametrize("cells", FORMULAS)
def test_formulas_without_a_stored_result_are_noted(cells):
    """A formula whose result was never stored is noted by row and column; an empty text is a result."""
    assert _walked(f'<row r="1">{cells}</row>').unstored == FORMULAS[cells]


ERROR_CELLS = {
    '<c r="A1" t="e"><v>#REF!</v></c>': [(1, 1)],
    '<c r="A1" t="e"><f>1/0</f><v>#DIV/0!</v></c>': [(1, 1)],
    '<c><v>1</v></c><c t="e"><v>#N/A</v></c>': [(1, 2)],
    '<c r="A1" t="e"><v>#NEWWORD!</v></c>': [(1, 1)],
    '<c r="A1" t="e"/>': [(1, 1)],
    '<c r="A1" t="inlineStr"><is><t>#REF!</t></is></c>': [],
    '<c r="A1"><v>1</v></c>': [],
}


@pytest.mark.parametrize("cells", ERROR_CELLS)
def test_error_cells_are_noted(cells):
    """A cell stored as an error is noted by row and column, whatever its word."""
    assert _walked(f'<row r="1">{cells}</row>').errors == ERROR_CELLS[cells]


@pytest.mark.parametrize(
    ("rows", "hidden"),
    [
        ('<row r="2" hidden="1"><c r="A2"/></row>', [2]),
        ('<row r="2" hidden="true"><c r="A2"/></row><row r="4" hidden="1"><c r="A4"/></row>', [2, 4]),
        ('<row r="2" hidden="0"><c r="A2"/></row><row r="3"><c r="A3"/></row>', []),
        ('<row r="2" hidden="1"/>', []),
    ],
)
def test_hidden_rows_with_cells_are_noted(rows, hidden):
    """Hidden rows that hold cells are noted, others are not."""
    assert _walked(rows).hidden_rows == hidden


@pytest.mark.parametrize(
    ("reference", "area"),
    [
        ("A1:XFD1048576", (1, 1, 1048576, 16384)),
        ("B2:AA3", (2, 2, 3, 27)),
        ("b2:aA3", (2, 2, 3, 27)),
        ("C4", (4, 3, 4, 3)),
    ],
)
def test_merged_areas_are_noted(reference, area):
    """Merged areas are noted by their corners, even that of the whole sheet."""
    after = f'<mergeCells><mergeCell ref="{reference}"/></mergeCells>'
    assert _walked(ONE, after=after).merged == [area]


@pytest.mark.parametrize("reference", ["", "A", "A1:", "A1:XFE1", "A1:A1048577", "A1:B2:C3", "$A$1:$B$2"])
def test_a_merged_area_that_is_none_is_damage(reference):
    """A merged area without two corners on the sheet is damage."""
    assert _refused(ONE, after=f'<mergeCell ref="{reference}"/>') == "E102"


def _merges(number):
    return "".join(f'<mergeCell ref="A{row}:B{row}"/>' for row in range(1, number + 1))


@pytest.mark.slow
def test_merged_areas_at_their_limit():
    """A sheet may have 100,000 merged areas, not 100,001."""
    assert _refused(ONE, after=_merges(100_000)) is None
    assert _refused(ONE, after=_merges(100_001)) == "E110"


def test_a_text_as_the_value_of_a_cell_that_should_hold_it_inside():
    """A cell that says to hold its text inside, and has it as its value, is noted with that text."""
    rows = f'<row r="2">{_cell("<v>1 &amp; 2</v>", r="B2", t="inlineStr")[11:]}'
    assert _walked(rows).texts == {(2, 2): "1 & 2"}
    assert _walked(_cell("<is><t>a</t></is><v>1</v>", t="inlineStr")).texts == {}


@pytest.mark.parametrize("shape", ["<is><t>{}</t></is>", "<is><r><t>abc</t></r><r><t>{:.32764}</t></r></is>"])
def test_a_text_at_its_limit(shape):
    """A cell's own text may have 32,767 characters; one more is refused."""
    assert _refused(_cell(shape.format("x" * 32_767), t="inlineStr")) is None
    assert _refused(_cell(shape.replace(":.32764", "").format("x" * 32_768), t="inlineStr")) == "E110"


def test_a_long_attribute_is_passed_over():
    """An attribute of many megabytes costs its length, not its square."""
    assert _walked(f'<row r="1" x="{"a" * 2_000_000}"><c r="A1"/></row>').cells == 1
