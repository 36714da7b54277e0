"""What a drawing is made of: areas, lines and words at places in pixels, right and down, whatever writes them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

__all__ = ["LETTER", "Area", "Drawing", "Label", "Mark", "Point", "Stroke", "hatching"]

Point = tuple[float, float]

LETTER = 12
"""Height of letters [px]."""

_HATCHES = 7.0
"""Distance of hatching lines to the right [px]."""


@dataclass(frozen=True, kw_only=True)
class Area:
    """A closed, filled area; lines at 45° of the colour `hatch` lie on one that is cut."""

    points: tuple[Point, ...]
    fill: str
    hatch: str = ""


@dataclass(frozen=True, kw_only=True)
class Stroke:
    """A line through points; `dashed` as an axis is."""

    points: tuple[Point, ...]
    colour: str
    width: float = 1.0
    dashed: bool = False


@dataclass(frozen=True, kw_only=True)
class Label:
    """Words on their base line; `anchor` says which of their ends lies at the place."""

    x: float
    y: float
    words: str
    colour: str
    anchor: str = "start"


Mark = Area | Stroke | Label


@dataclass(frozen=True, kw_only=True)
class Drawing:
    """A drawing of a size [px]; `title` and `description` stand for it where it cannot be seen."""

    width: float
    height: float
    title: str
    description: str
    marks: tuple[Mark, ...]


def hatching(area: Area) -> Iterator[Stroke]:
    """Yield the lines on an area; all areas share the same ones.

    >>> square = Area(points=((0.0, 0.0), (14.0, 0.0), (14.0, 14.0), (0.0, 14.0)), fill="#ffffff", hatch="#000000")
    >>> [stroke.points for stroke in hatching(square)]
    [((0.0, 7.0), (7.0, 0.0)), ((0.0, 14.0), (14.0, 0.0)), ((7.0, 14.0), (14.0, 7.0))]
    """
    sums = [x + y for x, y in area.points]
    numbers = range(math.floor(min(sums) / _HATCHES) + 1, math.ceil(max(sums) / _HATCHES)) if area.hatch else ()
    for level in (number * _HATCHES for number in numbers):
        crossings = sorted(_crossings(area.points, level))
        for start, end in zip(crossings[::2], crossings[1::2], strict=False):
            yield Stroke(points=((start, level - start), (end, level - end)), colour=area.hatch, width=0.6)


def _crossings(outline: Sequence[Point], level: float) -> Iterator[float]:
    """Yield where x + y has a value on an outline, by x."""
    for (x1, y1), (x2, y2) in pairwise([*outline, outline[0]]):
        first, second = x1 + y1 - level, x2 + y2 - level
        if (first < 0) != (second < 0):
            yield x1 + (x2 - x1) * first / (first - second)
