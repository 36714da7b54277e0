"""The Sections sheet: where along the part the backlash arises."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexlash.findings import shown
from flexlash.report.selection import Drawn
from flexlash.report.styles import GRID, PALETTE, Book
from flexlash.units import ARCMIN

__all__ = ["write_sections"]

_NAME = 30
_CHARTED = 30
_SEGMENTS = (
    ("rim", "Tooth rim", PALETTE["pale"]),
    ("wall", "Wall", PALETTE["blue"]),
    ("junction_fillet", "Junction fillet", PALETTE["sky"]),
    ("disk_body", "Disk", PALETTE["orange"]),
    ("hub_fillet", "Hub fillet", PALETTE["red"]),
)
_BESIDE = (
    ("backlash_arcmin", "Backlash [arcmin]", "arcmin"),
    ("disk_share", "Disk share", "share"),
    ("two_term_backlash_arcmin", "Two-term formula [arcmin]", "arcmin"),
    ("cylinder_only_backlash_arcmin", "Cylinder only [arcmin]", "arcmin"),
)
_CHART_ROWS = 23
_HEADER = 4 + _CHART_ROWS


def write_sections(book: Book, drawn: Sequence[Drawn], computed: int) -> None:
    """Write what each segment adds to the backlash, worst variants first."""
    sheet = book.sheet("Sections")
    sheet.write_string(0, 0, "Where the backlash arises", book.format("title"))
    sheet.set_row(0, 28)
    note = (
        "Backlash of each segment at the entered dimensions [arcmin], from the open end to the hub; the sum is nominal."
    )
    if len(drawn) < computed:
        note += f" The {len(drawn)} worst of {computed} variants."
    sheet.write_string(1, 0, note, book.format("quiet"))
    headings = [*(f"{name} [arcmin]" for _, name, _ in _SEGMENTS), *(heading for _, heading, _ in _BESIDE)]
    sheet.set_column(0, 0, 28)
    sheet.set_column(1, len(headings), 13)
    for place, heading in enumerate(("Variant", *headings)):
        sheet.write_string(_HEADER, place, heading, book.format("header"))
    sheet.set_row(_HEADER, 48)
    for row, one in enumerate(drawn, start=_HEADER + 1):
        sheet.write_string(row, 0, shown(one.row["variant"], longest=_NAME), book.format("text"))
        for place, (segment, _, _) in enumerate(_SEGMENTS, start=1):
            angle = one.computed.nominal.get(f"{segment}_windup")
            if isinstance(angle, float):
                sheet.write_number(row, place, 2 * angle / ARCMIN, book.format("text", "arcmin"))
        for place, (key, _, number) in enumerate(_BESIDE, start=1 + len(_SEGMENTS)):
            sheet.write_number(row, place, one.row[key], book.format("text", number))
    if drawn:
        _draw(book, sheet, min(len(drawn), _CHARTED))
    sheet.freeze_panes(0, 1)
    sheet.repeat_rows(_HEADER)


def _draw(book: Book, sheet: Any, count: int) -> None:
    """Draw the segments of the worst variants as stacked bars."""
    chart = book.chart("bar", "Backlash by segment, worst variants first [arcmin]", subtype="stacked")
    last = _HEADER + count
    for place, (_, name, colour) in enumerate(_SEGMENTS, start=1):
        chart.add_series({
            "name": name,
            "categories": ["Sections", _HEADER + 1, 0, last, 0],
            "values": ["Sections", _HEADER + 1, place, last, place],
            "fill": {"color": colour},
            "border": {"color": "#FFFFFF", "width": 0.5},
            "gap": 40,
        })  # fmt: skip
    chart.set_y_axis({"reverse": True, "num_font": {"size": 9}})
    chart.set_x_axis({"num_format": "0.0", "major_gridlines": GRID})
    book.insert(sheet, 3, 0, chart, size=(1000, 450), text="Backlash of each segment of the worst variants")
