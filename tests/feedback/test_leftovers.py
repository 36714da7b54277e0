"""What a workbook holds beside values is found, whoever wrote it, and by the limited process."""

from __future__ import annotations

import io
import zipfile

import pytest
import regenerate
import xlsxwriter

from flexlash.feedback.template.leftovers import leftovers_of
from flexlash.reading.limited_process import ask
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal

PIXEL = (
    b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR\x00\x00\x00\x01\x00\x00\x00\x01\x08\x06\x00\x00\x00\x1f\x15\xc4\x89\x00\x00"
    b"\x00\rIDATx\x9cc\xf8\xcf\xc0\xf0\x1f\x00\x05\x00\x01\xff\x89\x99=\x1d\x00\x00\x00\x00IEND\xaeB`\x82"
)


def _book():
    """Return a workbook with something of everything."""
    buffer = io.BytesIO()
    book = xlsxwriter.Workbook(buffer, {"in_memory": True})
    one, two = book.add_worksheet("One"), book.add_worksheet("Two")
    one.write_formula("B2", "=1+2", None, 3)
    one.write_formula("D9", '=IF(A1<>"","x","")', None, "")
    two.write_comment("C7", "ask")
    two.write_comment("A1", "here")
    one.insert_image("F1", "pixel.png", {"image_data": io.BytesIO(PIXEL)})
    two.insert_textbox("F1", "remember")
    chart = book.add_chart({"type": "line"})
    chart.add_series({"values": "=One!$B$2"})
    two.insert_chart("F9", chart)
    book.close()
    return buffer.getvalue()


def _with(data, parts):
    buffer = io.BytesIO(data)
    with zipfile.ZipFile(buffer, "a") as archive:
        for name, part in parts.items():
            archive.writestr(name, part)
    return buffer.getvalue()


def test_each_kind_is_found():
    """Formulas with their text, notes with their cell, charts, pictures and text boxes with their number."""
    found = leftovers_of(_book(), ReadingLimits())
    assert found.formulas == {"One": {(2, 2): "1+2", (9, 4): 'IF(A1<>"","x","")'}, "Two": {}}
    assert found.notes == {"One": [], "Two": [(1, 1), (7, 3)]}
    assert found.objects == {"chart": 1, "picture": 1, "text box or shape": 1}


@pytest.mark.parametrize(
    ("part", "name"),
    [
        ("xl/vbaProject.bin", "set of macros"),
        ("xl/pivotTables/pivotTable1.xml", "pivot table"),
        ("xl/threadedComments/threadedComment1.xml", "discussion"),
        ("xl/ctrlProps/ctrlProp1.xml", "form control"),
        ("xl/externalLinks/externalLink1.xml", "link to another workbook"),
    ],
)
def test_parts_tell_what_they_hold(part, name):
    """What no cell shows is known by the name of its part."""
    found = leftovers_of(_with(_book(), {part: b"<x/>"}), ReadingLimits())
    assert found.objects[name] == 1


def test_the_limited_process_finds_the_same():
    """What comes back from the process of its own is what is found in this one."""
    data = (regenerate.ROOT / "data" / "needs-fixing.xlsx").read_bytes()
    there = ask(leftovers_of, ReadingLimits(), data, ReadingLimits())
    assert there == leftovers_of(data, ReadingLimits())
    assert there.formulas["Variants"][13, 8] == "0.8*2"
    assert len(there.notes["Variants"]) == 29


def test_limits_hold():
    """A workbook beyond a limit is refused here as well."""
    with pytest.raises(Refusal):
        leftovers_of(_book(), ReadingLimits.of({"sheets": 1}))
