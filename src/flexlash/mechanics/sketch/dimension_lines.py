"""Dimension lines of a drawing: with an arrow at both ends, or from outside at what is thin."""

from __future__ import annotations

import math
from collections.abc import Iterator

from flexlash.mechanics.sketch.drawing_marks import Area, Label, Mark, Point, Stroke

__all__ = ["GREY", "INK", "extension", "measure", "measure_across"]

INK, GREY = "#1b2a41", "#56637a"
"""Dimension lines with their words, and what leads to them."""

_ARROW = (6.0, 2.0)
"""Length of an arrow's head, and half its width [px]."""

_OUTSIDE = 18.0
"""Length of an arrow from outside [px]."""


def measure(start: Point, end: Point, words: str, place: Point, anchor: str = "middle") -> Iterator[Mark]:
    """Yield a dimension line with an arrow at both ends and its words."""
    yield Stroke(points=(start, end), colour=INK, width=0.8)
    yield _arrow(start, end)
    yield _arrow(end, start)
    yield Label(x=place[0], y=place[1], words=words, colour=INK, anchor=anchor)


def _arrow(tip: Point, tail: Point) -> Area:
    """Return the head of an arrow."""
    length = math.dist(tip, tail) or 1.0
    along = ((tail[0] - tip[0]) / length, (tail[1] - tip[1]) / length)
    back, half = _ARROW
    middle = (tip[0] + back * along[0], tip[1] + back * along[1])
    aside = (-along[1] * half, along[0] * half)
    return Area(
        points=(tip, (middle[0] + aside[0], middle[1] + aside[1]), (middle[0] - aside[0], middle[1] - aside[1])),
        fill=INK,
    )


def measure_across(low: Point, high: Point, words: str, place: Point, anchor: str) -> Iterator[Mark]:
    """Yield the dimension of what is thin: two arrows that point at it from outside."""
    length = math.dist(low, high) or 1.0
    along = ((high[0] - low[0]) / length, (high[1] - low[1]) / length)
    for tip, sign in ((low, -1.0), (high, 1.0)):
        tail = (tip[0] + sign * _OUTSIDE * along[0], tip[1] + sign * _OUTSIDE * along[1])
        yield Stroke(points=(tip, tail), colour=INK, width=0.8)
        yield _arrow(tip, tail)
    yield Label(x=place[0], y=place[1], words=words, colour=INK, anchor=anchor)


def extension(start: Point, end: Point) -> Stroke:
    """Return a thin line that leads from an edge to its dimension line."""
    return Stroke(points=(start, end), colour=GREY, width=0.5)
