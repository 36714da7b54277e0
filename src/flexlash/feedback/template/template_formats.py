"""The looks of the template's cells, by name."""

from __future__ import annotations

from typing import Any

from flexlash.feedback.template.cell_writer import DATE_FORMATS

__all__ = ["cell_formats"]

_BASE = {"font_name": "Calibri", "font_size": 11, "valign": "vcenter"}
_HEAD = {**_BASE, "bold": True, "text_wrap": True, "align": "center", "border": 1, "border_color": "#8EA9C1"}
_ENTRY = {**_BASE, "locked": False, "border": 1, "border_color": "#D9D9D9"}
_LEGEND = {**_BASE, "align": "center", "border": 1, "border_color": "#8EA9C1"}
_QUIET = {**_BASE, "italic": True, "font_color": "#595959"}

_LOOKS: dict[str, dict[str, Any]] = {
    "title": {**_BASE, "bold": True, "font_size": 16, "font_color": "#1F3A5F"},
    "hint": _QUIET,
    "meaning": {**_QUIET, "indent": 1},
    "live": {**_BASE, "bold": True, "font_color": "#1F3A5F"},
    "group": {**_BASE, "bold": True, "font_color": "#FFFFFF", "bg_color": "#1F3A5F"},
    "plain": _BASE,
    "header": {**_HEAD, "bg_color": "#D9E2EC"},
    "required": {**_HEAD, "bg_color": "#FFD966"},
    "required by some": {**_HEAD, "bg_color": "#FFEDB3"},
    "number": _ENTRY,
    "text": {**_ENTRY, "num_format": "@", "indent": 1},
    "number required": {**_ENTRY, "bg_color": "#FFF5D6"},
    "text required": {**_ENTRY, "num_format": "@", "bg_color": "#FFF5D6"},
    "status": {**_QUIET, "indent": 1},
    **{kind: {**_ENTRY, "num_format": form} for kind, form in DATE_FORMATS.items()},
    "good": {"font_color": "#006100", "bg_color": "#D5EBDD"},
    "open": {"font_color": "#7F4F00", "bg_color": "#FFE3B3"},
    "needed": {"font_color": "#000000", "bg_color": "#FFF5D6"},
    "missing": {"font_color": "#000000", "bg_color": "#FFC94D"},
    "unused": {"font_color": "#595959", "bg_color": "#D9D9D9"},
    "wrong": {"font_color": "#8F3A00", "bg_color": "#FBE3D3"},
    "legend needed": {**_LEGEND, "bg_color": "#FFF5D6"},
    "legend missing": {**_LEGEND, "bg_color": "#FFC94D"},
    "legend unused": {**_LEGEND, "font_color": "#595959", "bg_color": "#D9D9D9"},
    "legend wrong": {**_LEGEND, "font_color": "#8F3A00", "bg_color": "#FBE3D3"},
    "legend": _LEGEND,
    "legend words": {**_LEGEND, "align": "left", "text_wrap": True, "indent": 1},
    "link": {**_BASE, "font_color": "#1F5FA8", "underline": 1},
    "wrap": {**_BASE, "text_wrap": True, "valign": "top"},
}


def cell_formats(workbook: Any) -> dict[str, Any]:
    """Return the formats of a new workbook by name."""
    return {name: workbook.add_format(look) for name, look in _LOOKS.items()}
