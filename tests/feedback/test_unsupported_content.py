"""What a marked copy cannot keep is said in words, in its list and to its caller; everything else is in it."""

from __future__ import annotations

import io
import zipfile

import pytest
from marking_samples import fault, loaded, own_workbook, rewritten, rich_workbook
from own_workbooks import READABLE, RICH

from flexlash.feedback.annotation import marked_copy

_ROOT = "_rels/.rels"
_ORIGIN = (
    b'<Relationship Id="rId99" Target="_xmlsignatures/origin.sigs" '
    b'Type="http://schemas.openxmlformats.org/package/2006/relationships/digital-signature/origin"/>'
)
_SIGNATURE = b"""<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship
 Id="rId1" Target="sig1.xml"
 Type="http://schemas.openxmlformats.org/package/2006/relationships/digital-signature/signature"/></Relationships>"""


def _with_parts(data, parts):
    buffer = io.BytesIO(data)
    with zipfile.ZipFile(buffer, "a") as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    return buffer.getvalue()


def _names(data):
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.mark.parametrize("make", [own_workbook, rich_workbook, *RICH.values()])
def test_nothing_is_lost(make):
    """Charts, pictures, sparklines, text boxes, tables and newer formats are in the copy, and none is named."""
    copy = marked_copy(make(), [fault()], "x")
    assert copy.lost == ()
    assert _names(copy.data).keys() >= _names(make()).keys()


@pytest.mark.parametrize(
    "part",
    [
        "xl/ctrlProps/ctrlProp1.xml",
        "xl/slicers/slicer1.xml",
        "xl/pivotTables/pivotTable1.xml",
        "xl/threadedComments/threadedComment1.xml",
        "customXml/item1.xml",
        "xl/connections.xml",
        "xl/model/item.data",
    ],
)
def test_parts_of_any_kind_stay(part):
    """A part of which flexlash knows nothing is in the copy byte for byte."""
    copy = marked_copy(_with_parts(own_workbook(), {part: b"\0\xff"}), [fault()], "x")
    assert copy.lost == ()
    assert _names(copy.data)[part] == b"\0\xff"


def test_macros_stay_in_a_file_that_may_hold_them_alone():
    """A copy that is to be a plain workbook has no macros and says so; one of the kind with macros keeps them."""
    data = READABLE["macros"][0]()
    plain, full = (marked_copy(data, [fault()], "x", macros=macros) for macros in (False, True))
    assert (plain.lost, full.lost) == (("macros",), ())
    assert "xl/vbaProject.bin" not in _names(plain.data)
    assert b"vbaProject" not in _names(plain.data)["xl/_rels/workbook.xml.rels"]
    assert b"sheet.main+xml" in _names(plain.data)["[Content_Types].xml"]
    assert _names(full.data)["xl/vbaProject.bin"] == _names(data)["xl/vbaProject.bin"]
    assert b"sheet.macroEnabled.main+xml" in _names(full.data)["[Content_Types].xml"]


def test_a_signature_goes_since_it_would_be_wrong():
    """A digital signature, which holds for the original alone, is not in the copy, and is named."""
    end = b"</Relationships>"
    data = rewritten(own_workbook(), _ROOT, end, _ORIGIN + end)
    parts = {"origin.sigs": b"", "sig1.xml": b"<Signature/>", "_rels/origin.sigs.rels": _SIGNATURE}
    copy = marked_copy(_with_parts(data, {f"_xmlsignatures/{name}": part for name, part in parts.items()}), [], "x")
    assert copy.lost == ("digital signatures (1)",)
    assert not [name for name in _names(copy.data) if "sig" in name]
    assert b"origin" not in _names(copy.data)[_ROOT]


def test_losses_stand_in_the_list_and_are_remembered():
    """The Findings sheet says what only the own file holds; a second marking still knows it."""
    once = marked_copy(READABLE["macros"][0](), [fault()], "x")
    again = marked_copy(once.data, [fault()], "x")
    assert again.lost == once.lost
    text = " ".join(str(row[0].value) for row in loaded(again.data).worksheets[0].iter_rows(max_row=6))
    assert "Your own file holds what this copy could not take over: macros." in text
