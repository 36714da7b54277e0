"""How marks look: fills told apart by lightness as well as by hue, notes as large as their text, texts as texts."""

from __future__ import annotations

import re
import textwrap
from typing import Any

from openpyxl.comments import Comment
from openpyxl.styles import PatternFill
from openpyxl.styles.cell_style import StyleArray

from flexlash.schema.finding_catalogue import Level

__all__ = ["AUTHOR", "FILLS", "level_of", "note", "plain", "put", "wear", "worn"]

AUTHOR = "flexlash"

_COLOURS: dict[Level, str] = {"error": "FFF2A285", "warning": "FFFFE9A3"}
FILLS = {level: PatternFill("solid", fgColor=colour, bgColor=colour) for level, colour in _COLOURS.items()}
"""Fill of a guilty cell by its worst level."""

_LEVELS: dict[str, Level] = {colour: level for level, colour in _COLOURS.items()}

_FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_ESCAPED = re.compile(r"_(?=x[0-9A-Fa-f]{4}_)")
_LONGEST_TEXT = 32_000

_NOTE_WIDTH = 330
_LETTERS = 50
_LINE_HEIGHT = 17
_MOST_LINES = 34


def level_of(fill: Any) -> Level | None:
    """Return the level whose fill this is, None for a fill of the user's."""
    return _LEVELS.get(fill.fgColor.rgb) if fill.fill_type == "solid" and fill.fgColor.type == "rgb" else None


def worn(cell: Any) -> int:
    """Return the number of a cell's fill among those of its workbook."""
    return int(cell._style.fillId) if cell._style else 0  # noqa: SLF001


def wear(cell: Any, number: int) -> None:
    """Give a cell a fill of its workbook by number and leave the rest of its format."""
    cell._style = StyleArray(cell._style) if cell._style else StyleArray()  # noqa: SLF001
    cell._style.fillId = number  # noqa: SLF001


def plain(text: object) -> str:
    """Return a text that a workbook can hold: no control characters, no escapes, not too long.

    >>> plain(f"1{chr(0)}.6 _x000D_")
    '1.6 _x005F_x000D_'
    """
    return _ESCAPED.sub("_x005F_", _FORBIDDEN.sub("", str(text)))[:_LONGEST_TEXT]


def put(cell: Any, text: object) -> None:
    """Write a text as a text, even one that looks like a formula or an error."""
    cell._value, cell.data_type = plain(text), "s"  # noqa: SLF001


def note(text: str, author: str) -> Comment:
    """Return a note large enough for its text."""
    lines = sum(max(1, len(textwrap.wrap(line, _LETTERS))) for line in text.splitlines())
    height = _LINE_HEIGHT * (min(lines, _MOST_LINES) + 1)
    return Comment(_FORBIDDEN.sub("", text)[:_LONGEST_TEXT], author, height=height, width=_NOTE_WIDTH)
