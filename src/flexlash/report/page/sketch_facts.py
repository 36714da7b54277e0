"""A variant → the sketch of its part as the page of the service takes it."""

from __future__ import annotations

from typing import Literal

from flexlash.mechanics.sketch.drawing_marks import Area, Mark, Point, Stroke
from flexlash.mechanics.sketch.part_sketch import part_sketch
from flexlash.report.page.shape import Sketch, SketchMark
from flexlash.schema.variant import Variant

__all__ = ["sketch_facts"]


def sketch_facts(variant: Variant, name: str) -> Sketch:
    """Return the sketch of a variant of this short name."""
    drawing = part_sketch(variant.flexspline_type, variant.dimensions, name=name)
    return Sketch(
        width=round(drawing.width, 2),
        height=round(drawing.height, 2),
        title=drawing.title,
        description=drawing.description,
        marks=[_fact(mark) for mark in drawing.marks],
    )


def _fact(mark: Mark) -> SketchMark:
    if isinstance(mark, Area):
        return _blank("area", mark.points, mark.fill) | {"hatch": mark.hatch}
    if isinstance(mark, Stroke):
        return _blank("stroke", mark.points, mark.colour) | {"width": mark.width, "dashed": mark.dashed}
    return _blank("label", ((mark.x, mark.y),), mark.colour) | {"words": mark.words, "anchor": mark.anchor}


def _blank(kind: Literal["area", "stroke", "label"], points: tuple[Point, ...], colour: str) -> SketchMark:
    places = [[round(x, 2), round(y, 2)] for x, y in points]
    return SketchMark(kind=kind, points=places, colour=colour, hatch="", width=0.0, dashed=False, words="", anchor="")
