"""The sketch of a part: its half-section to scale, with the symbols of the template and the sizes that were entered."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from flexlash.mechanics.elasticity.part import Part, part_of
from flexlash.mechanics.sketch.dimension_lines import GREY, INK, extension, measure, measure_across
from flexlash.mechanics.sketch.drawing_marks import Area, Drawing, Label, Mark, Point, Stroke
from flexlash.mechanics.sketch.half_outline import outlines
from flexlash.schema.arrays import Array

__all__ = ["part_sketch"]

_STEEL, _HATCH, _ROUND = "#eaf1fa", "#7fa6cf", "#a63603"
_LEFT, _RIGHT, _TOP, _BELOW = 84.0, 100.0, 46.0, 14.0
"""Room around the part for dimensions [px]."""

_FIRST, _SECOND = 30.0, 92.0
"""How far left of the part the radii of the disk stand, where there are two of them [px]."""

_WIDEST, _HIGHEST, _LEAST_WIDTH = 320.0, 210.0, 150.0
"""What the part itself takes at most, and the picture between its margins at least [px]."""

_HUB = 26.0
"""How far the hub stands out on both sides, which no dimension says [px]."""

_SYMBOLS = {"disk_inner_radius": "r_ci", "disk_outer_radius": "r_co"}
_LEVEL = 15.0
_MM = 1e-3


@dataclass(frozen=True, kw_only=True)
class _Sheet:
    """Where the half-section lies on the drawing: heights go right from `left`, radii up from `axis` [px].

    `scale` is in pixels a metre; `depth` is how far the disk reaches below its inner face [m].
    """

    part: Part
    entered: Mapping[str, float]
    with_sizes: bool
    scale: float
    depth: float
    left: float
    axis: float

    def at(self, height: float, radius: float) -> Point:
        """Return the place of a point of the part."""
        return self.left + self.scale * height, self.axis - self.scale * radius

    def words(self, symbol: str, name: str, factor: float = 1 / _MM) -> str:
        """Return a symbol with the size that was entered for a dimension."""
        return f"{symbol} {factor * self.entered[name]:.6g}" if self.with_sizes and name in self.entered else symbol


def part_sketch(
    flexspline_type: str, dimensions: Mapping[str, float], *, name: str = "", with_sizes: bool = True
) -> Drawing:
    """Return the sketch of a cup, hat or cylinder.

    `dimensions` in SI by name, as for `flexspline.windups`, but scalars: those that are blank are left out, as in
    `Variant.dimensions`. The sizes are printed in mm. Without sizes the sketch shows what the symbols mean.
    """
    part = part_of(flexspline_type, dimensions)
    highest = max(
        part.rim_outside if part.has_step else part.outside, part.clamp, dimensions.get("disk_outer_radius", 0.0)
    )
    depth = -min(height for outline in _outlines(part, dimensions) for height, _ in outline)
    scale = min(_WIDEST / (part.length + depth), _HIGHEST / highest)
    margin = _LEFT + (_SECOND - _FIRST) * (len(_disk_radii(part, dimensions)) > 1)
    sheet = _Sheet(
        part=part,
        entered=dimensions,
        with_sizes=with_sizes,
        scale=scale,
        depth=depth,
        left=margin + scale * depth,
        axis=_TOP + scale * highest,
    )
    width = max(scale * (part.length + depth), _LEAST_WIDTH) + margin + _RIGHT
    measures = [mark for some in (_along, _radii, _thicknesses, _rounds) for mark in some(sheet)]
    title = f"Half-section of {name or f'a {flexspline_type}'}"
    return Drawing(
        width=width,
        height=sheet.axis + _BELOW,
        title=title,
        description=_description(measures, flexspline_type),
        marks=(*_body(sheet, width), *measures),
    )


def _outlines(part: Part, dimensions: Mapping[str, float]) -> list[list[Point]]:
    return outlines(part, dimensions.get("disk_outer_radius", part.mean))


def _description(measures: Sequence[Mark], flexspline_type: str) -> str:
    """Return the sketch in words."""
    said = ", ".join(mark.words for mark in measures if isinstance(mark, Label))
    clamped = {"cup": "held at its hub", "hat": "held at its bolt circle"}.get(flexspline_type, "held at its end")
    return f"A {flexspline_type} drawn to scale above its axis, {clamped}, open end to the right. Shown: {said}."


def _body(sheet: _Sheet, width: float) -> Iterator[Mark]:
    """Yield axis, what holds the part, and the part itself."""
    yield Stroke(points=((14.0, sheet.axis), (width - 14.0, sheet.axis)), colour=GREY, dashed=True)
    held = _held(sheet)
    yield Area(points=tuple(held), fill="#f3f4f6", hatch="#b8bfca")
    yield Stroke(points=(*held, held[0]), colour=GREY)
    shapes = [[sheet.at(*point) for point in outline] for outline in _outlines(sheet.part, sheet.entered)]
    for shape in shapes:
        yield Area(points=tuple(shape), fill=_STEEL, hatch=_HATCH)
    for shape in shapes:
        yield Stroke(points=(*shape, shape[0]), colour=INK, width=1.4)


def _held(sheet: _Sheet) -> list[Point]:
    """Return the block that holds the part, whose size no dimension says."""
    part = sheet.part
    left, right = sheet.at(-sheet.depth, 0.0)[0], sheet.at(0.0, 0.0)[0]
    if part.kind == "cup":
        left, top = left - _HUB / 2, sheet.at(0.0, part.clamp)[1]
        return [(left, top), (_hub_end(sheet), top), (_hub_end(sheet), sheet.axis), (left, sheet.axis)]
    if part.kind == "hat":
        top = sheet.at(0.0, part.clamp)[1]
        return [(left - 5.0, top), (left - 5.0, top - _HUB / 2), (right + 5.0, top - _HUB / 2), (right + 5.0, top)]
    outer, inner = sheet.at(0.0, part.outside)[1], sheet.at(0.0, part.bore)[1]
    return [(left - 12.0, outer - 8.0), (left, outer - 8.0), (left, inner + 8.0), (left - 12.0, inner + 8.0)]


def _hub_end(sheet: _Sheet) -> float:
    """Return where a cup's hub ends on the side of the teeth, or the inner face of another part [px]."""
    part, (face, _) = sheet.part, sheet.at(0.0, 0.0)
    if part.kind != "cup":
        return face
    return face + max(_HUB, sheet.scale * part.hub_fillet) - sheet.scale * max(0.0, part.bore - part.clamp) * part.lean


def _along(sheet: _Sheet) -> Iterator[Mark]:
    """Yield what is measured along the axis: cylinder length, tooth rim, tooth face."""
    part = sheet.part
    (left, bore), (right, _) = sheet.at(0.0, part.bore), sheet.at(part.length, 0.0)
    level = min(bore + max(44.0, 2.0 * sheet.scale * part.junction_fillet), sheet.axis - 24.0)
    yield extension((right, bore), (right, level + 4.0))
    words = sheet.words("l", "cylinder_length")
    yield from measure((left, level), (right, level), words, (left + 0.6 * (right - left), level - 4.0))
    top = sheet.at(0.0, part.rim_outside if part.has_step else part.outside)[1]
    for name, symbol in (("rim_length", "rim length"), ("tooth_face_width", "tooth face")):
        if sheet.entered.get(name, 0.0) > 0:
            top -= _LEVEL
            start = sheet.at(part.length - sheet.entered[name], 0.0)[0]
            for x in (start, right):
                yield extension((x, top + _LEVEL), (x, top - 3.0))
            yield from measure(
                (start, top), (right, top), sheet.words(symbol, name), (right + 14.0, top + 4.0), "start"
            )


def _radii(sheet: _Sheet) -> Iterator[Mark]:
    """Yield what is measured from the axis: mean radius or bore, radii of the disk."""
    part = sheet.part
    x = max(sheet.at(0.4 * part.length, 0.0)[0], _hub_end(sheet) + 12.0)
    given_bore = "bore_diameter" in sheet.entered and "mean_radius" not in sheet.entered
    words = sheet.words("bore ø", "bore_diameter") if given_bore else sheet.words("r_m", "mean_radius")
    end = (x, sheet.at(0, part.bore if given_bore else part.mean)[1])
    yield extension((min(x, sheet.at(part.length, 0.0)[0]), end[1]), (x + 4.0, end[1]))
    yield from measure((x, sheet.axis), end, words, (x + 5.0, sheet.axis - 8.0), "start")
    edge = sheet.left - sheet.scale * sheet.depth
    for name, step in zip(_disk_radii(part, sheet.entered), (_FIRST, _SECOND), strict=False):
        x, y = edge - step, sheet.at(0.0, sheet.entered[name])[1]
        yield extension((edge, y), (x - 4.0, y))
        words = sheet.words(_SYMBOLS[name], name)
        yield from measure((x, sheet.axis), (x, y), words, (x - 5.0, sheet.axis - 8.0), "end")


def _disk_radii(part: Part, dimensions: Mapping[str, float]) -> list[str]:
    """Return the radii of the disk that were entered, the first of them next to the part."""
    return [name for name in _SYMBOLS if name in dimensions and part.kind != "cylinder"]


def _thicknesses(sheet: _Sheet) -> Iterator[Mark]:
    """Yield wall, rim and disk thickness."""
    part = sheet.part
    x, low = sheet.at(0.72 * (part.length - part.rim_length * part.has_step), part.bore)
    high = sheet.at(0.0, part.outside)[1]
    yield from measure_across((x, low), (x, high), sheet.words("Δ", "wall_thickness"), (x + 5.0, high - 8.0), "start")
    if part.has_step:
        right, rim = sheet.at(part.length, part.rim_outside)
        words = sheet.words("rim", "rim_thickness")
        yield extension((right, low), (right + 10.0, low))
        yield extension((right, rim), (right + 10.0, rim))
        yield from measure_across((right + 8.0, low), (right + 8.0, rim), words, (right + 13.0, low + 16.0), "start")
    if part.kind != "cylinder":
        yield from _disk_thickness(sheet)


def _disk_thickness(sheet: _Sheet) -> Iterator[Mark]:
    """Yield the thickness of the disk where it is even, or at both ends where it thins."""
    part, entered = sheet.part, sheet.entered
    end = entered.get("disk_outer_radius", part.bore) if part.kind == "cup" else part.outside
    tapers = "disk_hub_thickness" in entered
    middle = part.clamp + 0.55 * (end - part.clamp)
    words = "t = Δ" if "disk_thickness" not in entered else sheet.words("t", "disk_thickness")
    if tapers:
        words = sheet.words("t_hub", "disk_hub_thickness")
        words += f" … {entered['disk_thickness'] / _MM:.6g}" if sheet.with_sizes and "disk_thickness" in entered else ""
    lean = part.lean * max(0.0, part.bore - middle if part.kind == "cup" else middle - part.outside)
    thick = float(part.thickness(_one(middle))[0])
    right, left = sheet.at(-lean, middle), sheet.at(-lean - thick, middle)
    # Left of a hat's flange stands its radius.
    x, anchor = (right[0] + 21.0, "start") if part.kind == "hat" else (left[0] - 21.0, "end")
    yield from measure_across(left, right, words, (x, left[1] + 4.0), anchor)
    if "disk_thickness_exponent" in entered and sheet.with_sizes:
        exponent = f"n {entered['disk_thickness_exponent']:.6g}"
        yield Label(x=x, y=left[1] + 20.0, words=exponent, colour=INK, anchor=anchor)


def _one(value: float) -> Array:
    return np.array([value])


def _rounds(sheet: _Sheet) -> Iterator[Mark]:
    """Yield fillets and the angle of a cone in words beside them."""
    part = sheet.part
    for name, words, size, centre, turn in (
        ("junction_fillet_radius", "junction fillet R", part.junction_fillet, part.bore - part.junction_fillet, 1.0),
        ("hub_fillet_radius", "hub fillet R", part.hub_fillet, part.clamp + part.hub_fillet, -1.0),
    ):
        if size:
            middle = sheet.at(size * (1 - math.sqrt(0.5)), centre + turn * size * math.sqrt(0.5))
            x, y = sheet.at(size, centre)[0] + 12.0, middle[1] + turn * 16.0
            yield Stroke(points=(middle, (x, y)), colour=_ROUND, width=0.7)
            yield Label(x=x + 3.0, y=y + 4.0, words=sheet.words(words, name), colour=_ROUND)
    if part.lean:
        x, y = sheet.at(0.0, (part.clamp + part.mean) / 2)
        angle = 180 / math.pi * sheet.entered["disk_cone_angle"]
        words = f"cone {angle:.5g}°" if sheet.with_sizes else "cone angle"
        yield Label(x=x + 8.0, y=y + 22.0, words=words, colour=_ROUND)
