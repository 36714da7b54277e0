"""The catalogue's drive beside the flexspline on the sheet Drive: how far each turns under torque, table and chart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from flexlash.mechanics.catalogue_curve import first_slope, later_slope
from flexlash.report.drive.drive_page import BESIDE, LETTERS, SHEET, DrivePage
from flexlash.report.drive.stored_drives import result_label
from flexlash.report.formula.closed_forms import worked
from flexlash.report.formula.functions import AND, IF, MIN, NOT, OR
from flexlash.report.formula.live import Live, put
from flexlash.report.layout.styles import GRID, PALETTE, Book

__all__ = ["CATALOGUE_NOTES", "write_catalogue"]

CATALOGUE_NOTES = (
    "The whole drive of the catalogue: its input held, from no torque to one side, flexspline, teeth and bearings "
    "together. φ = T1/K1 + (T2 − T1)/K2 + (T − T2)/K3, as far as T goes.",
    "Beside it the flexspline's own straight line T/K, a part of such an angle. Neither holds plays. Backlash from "
    "wind-up is twice the flexspline's angle, since the torque reverses.",
)
_LISTED = ("Size", "Ratio from", "T1 [N·m]", "T2 [N·m]", "K1 [N·m/rad]", "K2 [N·m/rad]", "K3 [N·m/rad]")
_POINTS = ("no torque", "up to T1", "up to T2", "up to T")
_HEADS = ("Torque", "Whole drive [rad]", "Torque [N·m]", "Whole drive [{angle}]", "Flexspline [{angle}]")
_RADIANS, _TORQUE, _DRIVE, _OWN = range(1, 5)
_WHOLE = "#,##0"
_HIGH = 48
_CHART, _CHART_ROWS = (460, 330), 14
_FOUND, _BEYOND = "of the catalogue", "none: beyond its sizes"


def write_catalogue(page: DrivePage, top: int, ratio: float | None) -> int:
    """Write the block below its title in row `top`, with its chart beside it; return the row after both.

    `ratio` is that of the drive, None where it is not known.
    """
    book, sheet = page.book, page.sheet
    page.section(top, "Beside it: the catalogue's whole drive of the nearest size")
    which = (
        f"Of the listed ratios the greatest up to that of the entered input side, {ratio:g}."
        if ratio is not None
        else "No ratio is entered, or several are: the least stiff of the listed ratios."
    )
    row = page.notes(top + 1, *CATALOGUE_NOTES, which)
    listed = _write_listed(page, row)
    begin = row + 4
    sheet.write_row(begin - 1, 0, book.headings(*_HEADS), book.format("header"))
    sheet.set_row(begin - 1, _HIGH)
    far = IF(listed.reaches, listed.torque, listed.second)
    ends = (0.0 * listed.torque, MIN(listed.torque, listed.first), MIN(listed.torque, listed.second), far)
    for row, (words, end) in enumerate(zip(_POINTS, ends, strict=True), start=begin):
        sheet.write_string(row, 0, words, book.format("text"))
        without = listed.torque if words == _POINTS[-1] else 0.0
        at = put(sheet, row, _TORQUE, IF(listed.is_found, end, without), book.format("text", "plain"))
        turned = put(sheet, row, _RADIANS, IF(listed.is_found, listed.angle(at), 0.0), book.format("text", "rad"))
        put(sheet, row, _DRIVE, turned / page.radians, book.format("text", book.angles.name))
        put(sheet, row, _OWN, at / listed.own / page.radians, book.format("text", book.angles.name))
    short = IF(listed.reaches, "", "◄ the catalogue lists no third slope: shown up to T2")
    said = IF(listed.is_found, short, "◄ no drive of such a size is listed")
    put(sheet, begin + len(_POINTS) - 1, _OWN + 1, said, book.format("hint"))
    text = "How far the catalogue's whole drive and the flexspline alone turn over the torque, to one side; "
    text += f"of the variant picked when the report was written up to {listed.torque.value:.4g} N·m"
    book.insert(sheet, top + 1, BESIDE, _chart(book, begin), size=_CHART, text=text)
    return max(begin + len(_POINTS), top + 1 + _CHART_ROWS)


@dataclass(frozen=True, kw_only=True)
class _Listed:
    """What the catalogue lists for the picked variant, as references; texts where it lists none."""

    torque: Live
    first: Live
    second: Live
    slopes: tuple[Live, Live, Live]
    own: Live
    is_found: Live

    @property
    def has_third(self) -> Live:
        """Whether a third slope is listed."""
        return NOT(self.slopes[2].equals(""))

    @property
    def reaches(self) -> Live:
        """Whether the slopes reach as far as the torque."""
        return OR(self.torque <= self.second, self.has_third)

    def angle(self, at: Live) -> Live:
        """Return the angle [rad] at a torque."""
        one, two, three = self.slopes
        low = worked(first_slope, at, self.first, one) + worked(later_slope, at, self.first, self.second, two)
        third = worked(later_slope, at, self.second, at, three)
        return low + IF(AND(at > self.second, self.has_third), third, 0.0)


def _write_listed(page: DrivePage, row: int) -> _Listed:
    """Write what the catalogue lists, below its headings."""
    book, sheet = page.book, page.sheet
    headings = ("Nearest drive", "Torque T [N·m]", *_LISTED, "Flexspline K [N·m/rad]")
    sheet.write_row(row, 0, headings, book.format("header"))
    sheet.set_row(row, _HIGH)
    keys = ("Torque [N·m]", *_LISTED, result_label("stiffness_Nm_per_rad", book.angles))
    torque, size, _, first, second, one, two, three, own = (
        put(sheet, row + 1, column, page.looked_up(key), book.format("text", _WHOLE))
        for column, key in enumerate(keys, start=1)
    )
    found = put(sheet, row + 1, 0, IF(size.equals(""), _BEYOND, _FOUND), book.format("text"))
    return _Listed(
        torque=torque,
        first=first,
        second=second,
        slopes=(one, two, three),
        own=own,
        is_found=found.equals(_FOUND),
    )


def _chart(book: Book, begin: int) -> Any:
    """Return the angles over the torque, from the table that begins in a row."""
    chart = book.chart("scatter", "Torque and angle, to one side", subtype="straight_with_markers")
    last = begin + len(_POINTS) - 1
    for column, label, colour in (
        (_DRIVE, "whole drive of the catalogue", "grey"),
        (_OWN, "flexspline alone", "blue"),
    ):
        chart.add_series({
            "name": label,
            "categories": [SHEET, begin, _TORQUE, last, _TORQUE],
            "values": [SHEET, begin, column, last, column],
            "line": {"color": PALETTE[colour], "width": 2},
            "marker": {"type": "circle", "size": 5, "fill": {"color": PALETTE[colour]}},
        })  # fmt: skip
    look = {"min": 0, "major_gridlines": GRID, "num_font": LETTERS, "name_font": LETTERS | {"bold": False}}
    chart.set_x_axis({"name": "Torque [N·m]", **look})
    chart.set_y_axis({"name": f"Angle [{book.angles.name}]", **look})
    chart.set_legend({"position": "bottom", "font": LETTERS})
    return chart
