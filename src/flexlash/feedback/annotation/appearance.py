"""How marks look: fills told apart by lightness as well as by hue, texts as texts."""

from __future__ import annotations

import re

from flexlash.schema.finding_catalogue import Level

__all__ = ["COLOURS", "FILLS", "legible", "plain", "solid"]

COLOURS: dict[Level, str] = {"error": "FFF2A285", "warning": "FFFFE9A3"}
"""Colour of a guilty cell by its worst level."""

_FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_ESCAPED = re.compile(r"_(?=x[0-9A-Fa-f]{4}_)")
_LONGEST_TEXT = 32_000


def solid(colour: str) -> bytes:
    """Return the fill of a colour as XML."""
    text = (
        f'<@fill><@patternFill patternType="solid"><@fgColor rgb="{colour}"/><@bgColor rgb="{colour}"/>'
        "</@patternFill></@fill>"
    )
    return text.encode()


FILLS: dict[Level, bytes] = {level: solid(colour) for level, colour in COLOURS.items()}
"""Fill of a guilty cell as XML."""


def legible(text: object) -> str:
    """Return a text without control characters, and not too long for a cell."""
    return _FORBIDDEN.sub("", str(text))[:_LONGEST_TEXT]


def plain(text: object) -> str:
    """Return a text that a cell can hold: legible, and without what a reader would take for an escape.

    >>> plain(f"1{chr(0)}.6 _x000D_")
    '1.6 _x005F_x000D_'
    """
    return _ESCAPED.sub("_x005F_", legible(text))[:_LONGEST_TEXT]
