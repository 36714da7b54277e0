"""Pictures as inline SVG: elements with attributes alone, so that a policy without inline style shows them.

A picture is as wide as its place. Everything across is in per cent of that and letters keep their size, so that they
can be read on a telephone as well as on paper. `standing_alone.py` gives one a width, as a file needs.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeGuard
from xml.etree.ElementTree import Element, SubElement, tostring

from flexlash.report.layout.axes import Axis, axis_over
from flexlash.schema.findings import readable, shown

__all__ = [
    "AMBER",
    "BLUE",
    "DARK_AMBER",
    "DARK_VERMILION",
    "GREEN",
    "GREY",
    "INK",
    "SKY",
    "TRACK",
    "VERMILION",
    "Picture",
    "Scale",
    "finite",
    "number",
]

INK, GREY, TRACK = "#1b2a41", "#56637a", "#dde3ec"
BLUE, SKY, VERMILION, AMBER, GREEN = "#0072b2", "#8cbfe0", "#d55e00", "#e69f00", "#0f6b4f"
DARK_VERMILION, DARK_AMBER = "#a63603", "#8a5a00"
"""For letters: vermilion and amber themselves are too light to be read on white."""

_LETTER = 13
_ACROSS, _BETWEEN = 36, 2
"""Letters for which there is room across a telephone, and between two numbers."""

_FINEST = 1e-6
_GAP = 0.8
"""Per cent of the width between a line and its words."""

_EDGE = 2.0
"""Per cent of the width that stay free at both ends of a scale."""


def finite(value: float | None) -> TypeGuard[float]:
    """Return whether there is a number that can be drawn."""
    return value is not None and math.isfinite(value)


def number(value: float, step: float | None = None) -> str:
    """Return a number as an axis or a label shows it, in four digits or in those of the axis's step.

    >>> number(3.8), number(1234567.0), number(4.25, 0.05), number(-0.0), number(2e-7)
    ('3.8', '1.235e+06', '4.25', '0', '2e-07')
    """
    value += 0.0
    if step is None or not _FINEST <= step < 1 / _FINEST:
        return f"{value:.4g}"
    return f"{value:.{max(0, -math.floor(math.log10(step) + 1e-9))}f}"


class Scale:
    """A scale from edge to edge whose ends are round numbers around some values."""

    def __init__(self, values: Sequence[float]) -> None:
        """Make the scale; without values it is one from 0 to 1."""
        self.axis: Axis = axis_over(values or (0.0, 1.0))

    def per_cent(self, value: float) -> float:
        """Return where a value of the scale lies, in per cent of the width."""
        share = (value - self.axis.low) / ((self.axis.high - self.axis.low) or 1.0)
        return _EDGE + (100 - 2 * _EDGE) * share

    @property
    def ticks(self) -> list[tuple[float, str]]:
        """Where the grid's lines are, with the number at each: an empty text where there are too many numbers."""
        count = round((self.axis.high - self.axis.low) / self.axis.step)
        values = [self.axis.low + index * self.axis.step for index in range(count + 1)]
        words = [number(value, self.axis.step) for value in values]
        every = math.ceil(sum(len(word) + _BETWEEN for word in words) / _ACROSS)
        return [
            (self.per_cent(value), word if index % every == 0 else "")
            for index, (value, word) in enumerate(zip(values, words, strict=True))
        ]


class Picture:
    """A picture that grows downwards."""

    def __init__(self, name: str, title: str, description: str, height: float) -> None:
        """Begin a picture: `name` makes its IDs, `title` and `description` stand for it where it cannot be seen."""
        self.title = title
        self._root = Element(
            "svg", {"xmlns": "http://www.w3.org/2000/svg", "role": "img", "class": "picture", "width": "100%",
                    "height": _short(height), "aria-labelledby": f"{name}-title {name}-words"},
        )  # fmt: skip
        for ending, element, text in (("title", "title", title), ("words", "desc", description)):
            SubElement(self._root, element, {"id": f"{name}-{ending}"}).text = readable(text)

    def text(
        self, x: float, y: float, words: str, *, anchor: str = "start", colour: str = INK, bold: bool = False,
        longest: int = 40,
    ) -> None:  # fmt: skip
        """Write words at x [%] and y [px], on a white edge; of longer ones the whole is told where one points."""
        element = SubElement(
            self._root, "text",
            {"x": f"{_short(x)}%", "y": _short(y), "text-anchor": anchor, "fill": colour, "font-size": str(_LETTER),
             "stroke": "#ffffff", "stroke-width": "3", "stroke-linejoin": "round", "paint-order": "stroke"},
        )  # fmt: skip
        if bold:
            element.set("font-weight", "600")
        element.text = shown(words, longest=longest)
        if element.text != words:
            SubElement(element, "title").text = readable(words)

    def bar(self, start: float, end: float, y: float, height: float, colour: str, *, least: float = 0.0) -> None:
        """Draw a bar between two places [%], at least so many per cent wide."""
        middle, width = (start + end) / 2, max(end - start, least)
        SubElement(
            self._root, "rect",
            {"x": f"{_short(middle - width / 2)}%", "y": _short(y), "width": f"{_short(width)}%",
             "height": _short(height), "fill": colour},
        )  # fmt: skip

    def line(
        self, x: float, top: float, bottom: float, colour: str, *, width: float = 1.0, dashed: bool = False
    ) -> None:
        """Draw an upright line at x [%]."""
        element = SubElement(
            self._root, "line",
            {"x1": f"{_short(x)}%", "x2": f"{_short(x)}%", "y1": _short(top), "y2": _short(bottom), "stroke": colour,
             "stroke-width": _short(width)},
        )  # fmt: skip
        if dashed:
            element.set("stroke-dasharray", "5 3")

    def level(self, y: float, colour: str = TRACK) -> None:
        """Draw a line across."""
        SubElement(
            self._root, "line",
            {"x1": "0", "x2": "100%", "y1": _short(y), "y2": _short(y), "stroke": colour, "stroke-width": "1"},
        )  # fmt: skip

    def area(self, points: Sequence[tuple[float, float]], y: float, height: float, colour: str) -> None:
        """Fill the area below points, each given in per cent of the width and as a share of the height."""
        if len(points) < 2:  # noqa: PLR2004
            return
        box = SubElement(
            self._root, "svg",
            {"x": "0", "y": _short(y), "width": "100%", "height": _short(height), "viewBox": "0 0 1000 1000",
             "preserveAspectRatio": "none", "aria-hidden": "true"},
        )  # fmt: skip
        outline = [(points[0][0], 0.0), *points, (points[-1][0], 0.0)]
        drawn = " ".join(f"{_short(10 * x)},{_short(1000 - 1000 * share)}" for x, share in outline)
        SubElement(box, "polygon", {"points": drawn, "fill": colour})

    def grid(self, scale: Scale, top: float, bottom: float, unit: str) -> None:
        """Draw a scale's lines, and its numbers below them with the unit."""
        for x, words in scale.ticks:
            self.line(x, top, bottom, TRACK)
            if words:
                anchor = "start" if x < 2 * _EDGE else "end" if x > 100 - 2 * _EDGE else "middle"
                self.text(x, bottom + 16, f"{words}{unit}", anchor=anchor, colour=GREY)

    def limit(self, scale: Scale, value: float, top: float, bottom: float, words: str) -> None:
        """Draw a limit as a dashed line with its words at the top, on that side of it where there is room."""
        x = scale.per_cent(value)
        self.line(x, top, bottom, DARK_VERMILION, width=1.5, dashed=True)
        self.beside(x, top - 5, words, DARK_VERMILION)

    def beside(self, x: float, y: float, words: str, colour: str) -> None:
        """Write words at a place [%], toward the side with more room."""
        is_left = x < 50  # noqa: PLR2004
        self.text(x + (_GAP if is_left else -_GAP), y, words, anchor="start" if is_left else "end", colour=colour)

    def inline(self) -> str:
        """Return the picture as HTML takes it, everything in it escaped as XML."""
        return tostring(self._root, encoding="unicode")


def _short(value: float) -> str:
    return f"{value:.2f}".rstrip("0").rstrip(".")
