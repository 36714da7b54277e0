"""The Sections sheet: where along the part the backlash arises."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexlash.report.extent import Extent
from flexlash.report.layout.styles import GRID, OUTLINE, PALETTE, Book
from flexlash.report.report_data import Drawn
from flexlash.report.wording.chart_words import largest_of
from flexlash.report.wording.labels import distinct_labels
from flexlash.schema.units import ARCMIN

__all__ = ["write_sections"]

_NAME = 30
_CHARTED = 30
_SEGMENTS = (
    ("tooth_band", "Tooth face", PALETTE["ink"]),
    ("rim", "Tooth rim", PALETTE["pale"]),
    ("wall", "Wall", PALETTE["blue"]),
    ("junction_fillet", "Junction fillet", PALETTE["sky"]),
    ("disk_body", "Disk", PALETTE["orange"]),
    ("hub_fillet", "Hub fillet", PALETTE["red"]),
)
_BESIDE = (
    ("backlash_arcmin", "Backlash [{angle}]", "angle"),
    ("disk_share", "Disk share", "share"),
    ("two_term_backlash_arcmin", "Two-term formula [{angle}]", "angle"),
    ("cylinder_only_backlash_arcmin", "Cylinder only [{angle}]", "angle"),
)
_FEW = 12
"""Most variants whose table fits below the chart on one page."""

_CHART_TOP, _CHART_WIDTH = 3, 1000
_CHART_ROWS = {True: 23, False: 32}
"""Rows that the chart of few variants takes, and that of more."""

_ROW_HEIGHT = 20
_SIZES = {True: 80, False: 90}
"""Size of print in per cent with few variants, and with more."""


def write_sections(book: Book, drawn: Sequence[Drawn], extent: Extent) -> None:
    """Write what each segment adds to the backlash, worst variants first."""
    sheet = book.sheet("Sections")
    sheet.write_string(0, 0, "Where the backlash arises", book.format("title"))
    sheet.set_row(0, 28)
    (note,) = book.headings(
        "Backlash of each segment at the entered dimensions [{angle}], from the open end to the hub; the sum is "
        "nominal."
    )
    if extent.large and extent.note:
        sheet.write_string(2, 0, extent.note, book.format("quiet"))
    elif extent.is_part:
        note += f" The {extent.words} variants."
    if len(drawn) > _CHARTED:
        note += f" The chart has the {_CHARTED} worst."
    sheet.write_string(1, 0, note, book.format("quiet"))
    names = [*(f"{name} [{{angle}}]" for _, name, _ in _SEGMENTS), *(heading for _, heading, _ in _BESIDE)]
    headings = book.headings(*names)
    sheet.set_column(0, 0, 28)
    sheet.set_column(1, len(headings), 13)
    few = len(drawn) <= _FEW
    header = _CHART_TOP + _CHART_ROWS[few] + 1
    sheet.write_row(header, 0, ("Variant", *headings), book.format("header"))
    sheet.set_row(header, 48)
    labels = distinct_labels([variant.row["variant"] for variant in drawn], _NAME)
    for row, (variant, label) in enumerate(zip(drawn, labels, strict=True), start=header + 1):
        sheet.write_string(row, 0, label, book.format("text"))
        for column, (segment, _, _) in enumerate(_SEGMENTS, start=1):
            angle = getattr(variant.computed.nominal, f"{segment}_windup")
            if isinstance(angle, float):
                book.write_figure(sheet, row, column, 2 * angle / ARCMIN, "angle")
        for column, (key, _, number) in enumerate(_BESIDE, start=1 + len(_SEGMENTS)):
            book.write_figure(sheet, row, column, variant.row[key], number)
    if drawn:
        _draw(book, sheet, header, drawn[:_CHARTED], labels)
    sheet.freeze_panes(0, 1)
    sheet.repeat_rows(header)
    sheet.set_print_scale(_SIZES[few])
    if not few:
        sheet.set_h_pagebreaks([header])


def _draw(book: Book, sheet: Any, header: int, drawn: Sequence[Drawn], labels: Sequence[str]) -> None:
    """Draw the segments of the worst variants as stacked bars."""
    chart = book.chart("bar", f"Backlash by segment, worst variants first [{book.angles.name}]", subtype="stacked")
    count = len(drawn)
    last = header + count
    for column, (_, name, colour) in enumerate(_SEGMENTS, start=1):
        chart.add_series({
            "name": name,
            "categories": ["Sections", header + 1, 0, last, 0],
            "values": ["Sections", header + 1, column, last, column],
            "fill": {"color": colour},
            "border": OUTLINE,
            "gap": 40,
        })  # fmt: skip
    chart.set_y_axis({"reverse": True, "interval_unit": 1, "num_font": {"size": 9}})
    chart.set_x_axis({"num_format": book.angles.decimals(1), "major_gridlines": GRID})
    angles = ((name, getattr(drawn[0].computed.nominal, f"{key}_windup")) for key, name, _ in _SEGMENTS)
    own = {name: book.angles.of(2 * angle / ARCMIN) for name, angle in angles if isinstance(angle, float)}
    text = f"Nominal backlash of {count} variants by segment, worst first; "
    text += f"{labels[0]}: {largest_of(own, book.angles.sign)}"
    size = (_CHART_WIDTH, _ROW_HEIGHT * _CHART_ROWS[count <= _FEW] - _ROW_HEIGHT // 2)
    book.insert(sheet, _CHART_TOP, 0, chart, size=size, text=text)
