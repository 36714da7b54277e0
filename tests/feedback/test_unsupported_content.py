"""What a marked copy cannot carry over is said in words, in its list and to its caller."""

from __future__ import annotations

import io
import zipfile

import pytest
from marking_samples import fault, loaded, own_workbook, rich_workbook

from flexlash.feedback.annotation import marked_copy


def _with_part(data, name, content=b"<x/>"):
    buffer = io.BytesIO(data)
    with zipfile.ZipFile(buffer, "a") as archive:
        archive.writestr(name, content)
    return buffer.getvalue()


def test_an_ordinary_workbook_loses_nothing():
    """Nothing is said to be lost where nothing is."""
    assert marked_copy(own_workbook(), [fault()], "x").lost == ()


def test_extended_parts_are_lost_and_named():
    """Text boxes, sparklines and formats of newer kinds are named with their number; a chart's finish is as well."""
    lost = marked_copy(rich_workbook(), [fault()], "x").lost
    assert set(lost) == {
        "text boxes and shapes (1)",
        "sparklines (1)",
        "conditional formats of newer kinds (1)",
        "fine formatting of charts (1)",
    }


@pytest.mark.parametrize(
    ("part", "content", "words"),
    [
        ("xl/vbaProject.bin", b"x", "macros"),
        ("xl/ctrlProps/ctrlProp1.xml", b"<x/>", "form controls (1)"),
        ("xl/drawings/vmlDrawing9.vml", b'<x ObjectType="Button"/><x ObjectType="Note"/>', "form controls (1)"),
        ("xl/slicers/slicer1.xml", b"<x/>", "slicers (1)"),
        ("xl/charts/chart7.xml", b"<x/>", "charts (1)"),
        ("xl/pivotTables/pivotTable1.xml", b"<x/>", "pivot tables (1)"),
        ("xl/externalLinks/externalLink1.xml", b"<x/>", "external links (1)"),
        ("xl/drawings/drawing9.xml", b"<xdr:pic><xdr:pic>", "pictures (2)"),
        (
            "xl/drawings/drawing9.xml",
            b"<xdr:sp a=''/><mc:Fallback><xdr:sp /></mc:Fallback>",
            "text boxes and shapes (1)",
        ),
        (
            "xl/threadedComments/threadedComment1.xml",
            b"<ThreadedComments><threadedComment ref='A1'/></ThreadedComments>",
            "threaded comments, their text kept as notes (1)",
        ),
        ("customXml/item1.xml", b"<x/>", "custom XML data"),
        ("xl/connections.xml", b"<x/>", "data connections (1)"),
    ],
)
def test_parts_that_cannot_be_carried_over_are_named(part, content, words):
    """Each kind of part that the copy does not hold has its word."""
    assert marked_copy(_with_part(own_workbook(), part, content), [fault()], "x").lost == (words,)


def test_losses_stand_in_the_list_and_are_remembered():
    """The Findings sheet says what only the own file holds; a second marking still knows it."""
    once = marked_copy(rich_workbook(), [fault()], "x")
    again = marked_copy(once.data, [fault()], "x")
    assert again.lost == once.lost
    text = " ".join(str(row[0].value) for row in loaded(again.data).worksheets[0].iter_rows(max_row=6))
    assert "sparklines (1)" in text
    assert "Your own file" in text
