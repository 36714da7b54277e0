"""Fills on guilty cells of a worksheet, and taking them away again by the record of an earlier marking."""

from __future__ import annotations

from collections.abc import Mapping

from flexlash.feedback.splicing.sheet_spans import SheetSpans, cell_xml
from flexlash.feedback.splicing.stylesheet import Stylesheet
from flexlash.feedback.splicing.xml_spans import ElementSpan, element_spans, spliced, with_attributes
from flexlash.schema.cell_addresses import CellAddress

__all__ = ["fill_cells", "restore_cells"]

Cell = tuple[int, int]
"""Row and column."""


def fill_cells(part: bytes, styles: Stylesheet, fills: Mapping[Cell, int]) -> tuple[bytes, dict[Cell, str]]:
    """Return a worksheet whose cells have these fills, and the format that each cell had before.

    A cell that is not there yet gets the format of its row or column.
    """
    spans = SheetSpans(part, fills)
    before: dict[Cell, str] = {}
    changes = []
    for cell, span in spans.cells.items():
        before[cell] = span.style
        tag = with_attributes(part[span.start : span.inner], s=styles.with_fill(span.style, fills[cell]))
        changes.append((span.start, span.inner, tag))
    columns = [span for span in element_spans(part, ("col",))[1:] if span.attributes.get("style")]
    for gap in spans.gaps:
        new = []
        for column in gap.columns:
            cell = gap.row, column
            before[cell] = gap.style or _column_style(columns, column)
            style = styles.with_fill(before[cell], fills[cell])
            new.append(cell_xml(str(CellAddress(*cell)), None, spans.prefix, style))
        changes.append((gap.start, gap.end, gap.before + b"".join(new) + gap.after))
    return spliced(part, changes), before


def restore_cells(part: bytes, styles: Stylesheet, ours: set[int], before: Mapping[Cell, str]) -> bytes:
    """Return a worksheet whose cells with one of our fills have the one that they had before.

    A mark that was moved, as by sorting, takes what was recorded for another cell of its column.
    """
    marked = styles.styles_with(ours)
    spans = SheetSpans(part, (), marked.__contains__)
    spare = {column: style for (row, column), style in before.items() if (row, column) not in spans.cells}
    changes = []
    for cell, span in spans.cells.items():
        like = before[cell] if cell in before else spare.get(cell[1], "0")
        style = styles.with_fill(span.style, styles.fill(like), like)
        changes.append((span.start, span.inner, with_attributes(part[span.start : span.inner], s=style or None)))
    return spliced(part, changes)


def _column_style(columns: list[ElementSpan], column: int) -> str:
    """Return the format of a column, an empty text when it has none."""
    return next(
        (
            one.attributes["style"]
            for one in columns
            if int(one.attributes["min"]) <= column <= int(one.attributes["max"])
        ),
        "",
    )
