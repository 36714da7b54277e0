"""The look of the report: one palette that colour-blind readers can tell apart, one set of cell formats."""

from __future__ import annotations

from collections.abc import Container
from typing import Any

import xlsxwriter

from flexlash.report.layout.report_worksheet import ReportWorksheet
from flexlash.schema.angle_unit import ARC_MINUTES, AngleUnit
from flexlash.schema.number_words import places

__all__ = ["GRID", "LINES", "OUTLINE", "PALETTE", "Book", "decimals_of", "literal", "number_code", "percent_of"]

PALETTE = {
    "ink": "#1F3A5F",
    "blue": "#0072B2",
    "sky": "#8CBFE0",
    "orange": "#E69F00",
    "amber": "#C28500",
    "red": "#D55E00",
    "green": "#009E73",
    "grey": "#6B6B6B",
    "rose": "#CC79A7",
    "dark red": "#A63603",
    "dark orange": "#8A5A00",
    "pale": "#D9E2EC",
}

LINES = ("blue", "red", "green", "ink", "rose", "grey")
"""Colours of lines and marks beside each other: those that are seen well on white."""

OUTLINE = {"color": PALETTE["ink"], "width": 0.5}
"""Around areas, since some fills are too light to be told from white."""

GRID = {"visible": True, "line": {"color": PALETTE["pale"]}}

_TABS = {"entry": PALETTE["orange"], "stored": PALETTE["grey"]}
"""Colours of the tabs of sheets with cells to change, and of sheets that only hold what others look up."""

_BASE = {"font_name": "Calibri", "font_size": 11, "valign": "vcenter"}
_NUMBERS = {
    "rad": "0.0000E+00",
    "arcmin": "0.0000",
    "arcsec": "0.00",
    "share": "0.00%",
    "plain": "0.000",
    "stiffness": "#,##0.0",
    "stress": "0.0",
    "count": "#,##0",
    "general": "General",
}
_FORMATS: dict[str, dict[str, Any]] = {
    "title": {"bold": True, "font_size": 18, "font_color": PALETTE["ink"]},
    "section": {
        "bold": True,
        "font_size": 13,
        "font_color": PALETTE["ink"],
        "bottom": 2,
        "bottom_color": PALETTE["ink"],
    },
    "text": {},
    "indented": {"indent": 1},
    "indented wrap": {"indent": 1, "text_wrap": True},
    "wrap": {"text_wrap": True},
    "topic": {"bold": True, "valign": "top", "font_color": PALETTE["ink"]},
    "said": {"text_wrap": True, "valign": "top"},
    "topic link": {"bold": True, "valign": "top", "font_color": PALETTE["blue"], "underline": 1},
    "quiet": {"font_color": "#595959", "italic": True},
    "note": {"font_color": "#595959", "italic": True, "text_wrap": True, "valign": "top"},
    "hint": {"font_color": "#595959", "italic": True, "align": "left"},
    "label": {"bold": True, "font_color": "#404040"},
    "big": {
        "bold": True,
        "font_size": 16,
        "align": "center",
        "font_color": PALETTE["ink"],
        "top": 1,
        "left": 1,
        "right": 1,
        "border_color": PALETTE["pale"],
    },
    "caption": {
        "align": "center",
        "valign": "top",
        "text_wrap": True,
        "font_color": "#595959",
        "bottom": 1,
        "left": 1,
        "right": 1,
        "border_color": PALETTE["pale"],
    },
    "header": {
        "bold": True,
        "text_wrap": True,
        "align": "center",
        "border": 1,
        "border_color": "#8EA9C1",
        "bg_color": PALETTE["pale"],
    },
    "key": {
        "text_wrap": True,
        "font_color": "#595959",
        "italic": True,
        "bottom": 1,
        "border_color": "#8EA9C1",
    },
    "link": {"font_color": PALETTE["blue"], "underline": 1},
    "wrap link": {"font_color": PALETTE["blue"], "underline": 1, "text_wrap": True},
    "indented link": {"font_color": PALETTE["blue"], "underline": 1, "indent": 1},
    "figure": {"align": "right"},
    "input": {"num_format": "@", "bg_color": "#FFF5D6", "border": 1, "border_color": PALETTE["orange"], "bold": True},
    "base": {"bg_color": "#FFF5D6", "bottom": 1, "bottom_color": PALETTE["orange"]},
    "more": {"bg_color": "#FBE3B8"},
    "less": {"bg_color": "#D3E7F5"},
    "turned": {
        "font_size": 10,
        "rotation": 90,
        "align": "center",
        "valign": "bottom",
        "border": 1,
        "border_color": "#8EA9C1",
        "bg_color": PALETTE["pale"],
    },
    "small figure": {"font_size": 10, "align": "center"},
    "error": {"bg_color": "#F8CBAD"},
    "warning": {"bg_color": "#FFE699"},
    "ok": {"bg_color": "#C6E5D8"},
}
_FORMATS |= {f"big {level}": _FORMATS["big"] | _FORMATS[level] for level in ("error", "warning", "ok")}
_CELLS = ("text", "indented", "indented wrap")
_FORMATS |= {f"{name} ok": _FORMATS[name] | _FORMATS["ok"] for name in _CELLS}
_FORMATS |= {f"{name} grey": _FORMATS[name] | {"font_color": "#6B6B6B"} for name in _CELLS}
_ON_PAGES = ("text", "label", "topic", "said", "quiet", "figure", "header", "link")
_FORMATS |= {f"page {name}": _FORMATS[name] | {"font_size": 10} for name in _ON_PAGES}
"""The smaller print of the pages of single variants."""


_MOST_DECIMALS = 8


def number_code(number: str) -> str:
    """Return a number format in Excel's letters, given so or by name."""
    return _NUMBERS.get(number, number)


def decimals_of(error: float | None, otherwise: str) -> str:
    """Return the number format that shows a number down to the first digit of its standard error.

    >>> decimals_of(0.0021, "plain"), decimals_of(None, "plain")
    ('0.000', 'plain')
    """
    if error is None or not error > 0:
        return otherwise
    decimals = max(0, min(_MOST_DECIMALS, places(error)))
    return "0." + "0" * decimals if decimals else "0"


def percent_of(error: float | None) -> str:
    """Return the number format of a share in per cent down to the first digit of its error.

    >>> percent_of(0.0021), percent_of(None)
    ('0.0%', 'share')
    """
    decimals = decimals_of(None if error is None else 100 * error, "share")
    return decimals if decimals == "share" else f"{decimals}%"


_UNLINKED = {"link": "text", "wrap link": "wrap", "indented link": "indented", "topic link": "topic"}
"""What a text looks like that leads nowhere, by what it looks like where it does."""


def literal(text: str) -> str:
    """Return a text of a submission as a chart shows it: none is taken for the address of a cell.

    A mark without width behind each exclamation mark keeps them apart, since XlsxWriter knows addresses by it alone.

    >>> literal("B3-160"), len(literal("B3!A1"))
    ('B3-160', 6)
    """
    return text.replace("!", "!\u2060")


class Book:
    """An XlsxWriter workbook with the report's formats and sheets, its angles in one unit.

    Only the sheets in `shown` can be seen, all where it is None.
    """

    def __init__(
        self, workbook: xlsxwriter.Workbook, shown: Container[str] | None = None, angles: AngleUnit = ARC_MINUTES
    ) -> None:
        self.workbook = workbook
        self.angles = angles
        self._shown = shown
        self._formats: dict[str, Any] = {}

    def shows(self, title: str) -> bool:
        """Return whether a sheet of this title can be seen, so that a link may lead there."""
        return self._shown is None or title in self._shown

    def unlinked(self, style: Any) -> Any:
        """Return what a text looks like that leads nowhere, in place of the format of a link."""
        for name, plain in _UNLINKED.items():
            if style is self._formats.get(f"{name} "):
                return self.format(plain)
        return style

    def format(self, name: str, number: str = "") -> Any:
        """Return a format by name, optionally with a number format by name or in Excel's letters."""
        key = f"{name} {number}"
        if key not in self._formats:
            properties = self.properties(name)
            if number:
                properties["num_format"] = number_code(number)
            self._formats[key] = self.workbook.add_format(properties)
        return self._formats[key]

    def headings(self, *texts: str) -> list[str]:
        """Return headings with the name of the unit of angles in place of `{angle}`."""
        return [text.replace("{angle}", self.angles.name) for text in texts]

    def write_figure(self, sheet: Any, row: int, column: int, value: float, number: str, *, look: str = "text") -> None:
        """Write a number in a number format by name; `angle`: it is an angle [arcmin], shown in the unit of angles."""
        if number == "angle":
            value, number = self.angles.of(value), self.angles.name
        sheet.write_number(row, column, value, self.format(look, number))

    @staticmethod
    def properties(name: str) -> dict[str, Any]:
        """Return what a format of this name is made of, for one that has borders of its own."""
        return {**_BASE, **_FORMATS[name]}

    def sheet(
        self,
        name: str,
        *,
        landscape: bool = True,
        pages_tall: int = 0,
        tab: str = "",
        kind: type[ReportWorksheet] = ReportWorksheet,
    ) -> Any:
        """Return a new sheet set up to print one page wide; `tab` says what is special: `entry` or `stored`."""
        sheet = self.workbook.add_worksheet(name, kind)
        sheet.book = self
        if not self.shows(name):
            sheet.hide()
        if tab:
            sheet.set_tab_color(_TABS[tab])
        if landscape:
            sheet.set_landscape()
        sheet.set_paper(9)
        sheet.set_margins(left=0.4, right=0.4, top=0.5, bottom=0.6)
        sheet.fit_to_pages(1, pages_tall)
        sheet.set_footer("&L&A&C&P / &N&Rflexlash report")
        sheet.hide_gridlines(2)
        return sheet

    def chart(self, kind: str, title: str, **options: Any) -> Any:
        """Return a chart with the report's fonts."""
        chart = self.workbook.add_chart({"type": kind, **options})
        chart.set_title({"name": literal(title), "name_font": {"size": 12, "color": PALETTE["ink"]}, "overlay": False})
        chart.set_legend({"position": "bottom"})
        return chart

    @staticmethod
    def insert(
        sheet: Any, row: int, column: int, chart: Any, *, size: tuple[int, int], text: str, right: int = 0
    ) -> None:
        """Put a chart of this size on a sheet, so far right of the column's edge [px], with its alternative text."""
        chart.set_size({"width": size[0], "height": size[1]})
        sheet.insert_chart(row, column, chart, {"description": text, "object_position": 2, "x_offset": right})
