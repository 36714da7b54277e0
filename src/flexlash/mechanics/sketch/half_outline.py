"""The outline of a flexspline's half-section, as a drawing shows it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from flexlash.mechanics.elasticity.part import Part
from flexlash.mechanics.sketch.drawing_marks import Point

__all__ = ["outlines"]

_ARC, _PROFILE = 12, 24
"""Steps along a fillet and along a disk whose thickness changes."""


def outlines(part: Part, disk_end: float) -> list[list[Point]]:
    """Return the closed outlines of a part: height above the inner face of the disk and radius [m] of each corner.

    `disk_end` is the radius r_co where the disk of a cup ends. Where it is not within the wall, disk and wall are an
    outline each, as the formula takes them.
    """
    if part.kind == "cylinder":
        return [[*_open_end(part), (0.0, part.outside), (0.0, part.bore)]]
    if part.kind == "hat":
        return [_hat(part)]
    if part.bore <= disk_end <= part.outside:
        return [_cup(part)]
    wall: list[Point] = [*_open_end(part), (0.0, part.outside), (0.0, part.bore)]
    return [[*_top(part, part.clamp, disk_end, part.hub_fillet), *_bottom(part, disk_end, part.clamp)], wall]


def _open_end(part: Part) -> list[Point]:
    """Return the wall's open end, from the bore around the rim to the outer face."""
    end, step = part.length, part.length - part.rim_length
    if not part.has_step:
        return [(end, part.bore), (end, part.outside)]
    return [(end, part.bore), (end, part.rim_outside), (step, part.rim_outside), (step, part.outside)]


def _cup(part: Part) -> list[Point]:
    """Return a cup: inner face from the hub to the open end, outer face back."""
    fillet = part.junction_fillet
    inner = _top(part, part.clamp, part.bore - fillet, part.hub_fillet)
    corner = _arc((fillet, part.bore - fillet), fillet, math.pi, math.pi / 2) if fillet else [(0.0, part.bore)]
    # Under the wall the outer face of a cone is flat.
    under_wall = [(_base(part, part.bore), part.outside)] if part.lean else _bottom(part, part.outside, part.bore)
    return [*inner, *corner, *_open_end(part), *under_wall, *_bottom(part, part.bore, part.clamp)]


def _hat(part: Part) -> list[Point]:
    """Return a hat: the wall's bore goes down to the outer face of its flange."""
    outer = [(-_fall(part, radius), radius) for radius in _radii(part.clamp, part.outside)]
    return [
        *_open_end(part),
        *reversed(outer),
        *_bottom(part, part.clamp, part.outside),
        (_base(part, part.outside), part.bore),
    ]


def _top(part: Part, start: float, end: float, fillet: float) -> list[Point]:
    """Return the inner face of a cup's disk, from the hub outwards."""
    rounded = _arc((fillet, start + fillet), fillet, -math.pi / 2, -math.pi) if fillet else []
    return [*rounded, *((-_fall(part, radius), radius) for radius in _radii(start + fillet, end))]


def _bottom(part: Part, start: float, end: float) -> list[Point]:
    """Return the outer face of the disk between two radii."""
    return [(_base(part, radius), radius) for radius in _radii(start, end)]


def _radii(start: float, end: float) -> Sequence[float]:
    return [float(radius) for radius in np.linspace(start, end, _PROFILE + 1)]


def _base(part: Part, radius: float) -> float:
    """Return the height of the disk's outer face."""
    return -_fall(part, radius) - float(part.thickness(np.array([radius]))[0])


def _fall(part: Part, radius: float) -> float:
    """Return how far a conical disk's inner face lies below its edge at the wall."""
    return max(0.0, part.bore - radius if part.kind == "cup" else radius - part.outside) * part.lean


def _arc(centre: Point, radius: float, start: float, end: float) -> list[Point]:
    """Return points along a circle between two angles [rad], both ends with them."""
    angles = np.linspace(start, end, _ARC + 1)
    return [(centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)) for angle in angles]
