"""Ribs across the disk and the wall, stretch by stretch along the meridian from the hub to the open end."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise

import numpy as np

from flexlash.mechanics.elasticity.mesh_lines import Lines, graded, nodes_on
from flexlash.mechanics.elasticity.part import SLACK, Part
from flexlash.schema.arrays import Array

__all__ = ["ARC", "disk_stretches", "fan", "ribs_of", "wall_stretches"]

ARC = 6
"""Cells along a fillet."""

RibsAt = Callable[[Array], tuple[Array, Array, Array, Array]]
"""Outer radius and height, inner radius and height of ribs at fractions from 0 to 1 of a stretch."""


def disk_stretches(part: Part, end: float) -> Iterator[tuple[Lines, RibsAt]]:
    """Yield the ribs of a cup's disk from the hub to a radius: those under the hub fillet, then the others."""
    start = part.clamp
    at_hub, at_end = (float(part.thickness(np.array([radius]))[0]) for radius in (start, end))
    if part.hub_fillet:

        def arc(fraction: Array) -> tuple[Array, Array, Array, Array]:
            angle = fraction * (math.pi / 2)
            radius = part.clamp + part.hub_fillet * (1 - np.cos(angle))
            return radius, -part.thickness(radius), radius, part.hub_fillet * (1 - np.sin(angle))

        yield tuple(np.linspace(0, 1, ARC + 1).tolist()), arc
        start += part.hub_fillet
    if end - start > SLACK * part.mean:
        stretch = math.log(end / start)

        def body(fraction: Array) -> tuple[Array, Array, Array, Array]:
            # Steps grow with the radius, since the twist goes as a power of it.
            radius = start * np.exp(stretch * fraction)
            top = -(part.bore - radius) * part.lean
            return radius, top - part.thickness(radius), radius, top

        first = part.grading.step(sharp=part.lean > 0, thickness=at_hub) / (start * stretch)
        last = part.grading.step(sharp=not part.junction_fillet, thickness=at_end) / (end * stretch)
        yield graded(0.0, 1.0, first, last, part.grading.cells), body


def fan(part: Part) -> Iterator[tuple[Lines, RibsAt]]:
    """Yield the ribs around the junction fillet, from the disk to the diagonal and from there to the wall."""
    fillet, bore = part.junction_fillet, part.bore
    base = float(part.thickness(np.array([part.outside]))[0])

    def on_arc(angle: Array) -> tuple[Array, Array]:
        return bore - fillet * (1 - np.sin(angle)), fillet * (1 - np.cos(angle))

    def to_diagonal(fraction: Array) -> tuple[Array, Array, Array, Array]:
        radius = bore - fillet + (part.outside - bore + fillet) * fraction
        return radius, -part.thickness(radius), *on_arc(fraction * (math.pi / 4))

    def from_diagonal(fraction: Array) -> tuple[Array, Array, Array, Array]:
        height = -base + (base + fillet) * fraction
        return np.full_like(fraction, part.outside), height, *on_arc((1 + fraction) * (math.pi / 4))

    for ribs_at in (to_diagonal, from_diagonal):
        yield tuple(np.linspace(0, 1, ARC + 1).tolist()), ribs_at


def wall_stretches(part: Part) -> Iterator[tuple[Lines, RibsAt]]:
    """Yield the ribs of the wall from the junction to the open end, between its stops and the step of the rim."""
    marks, longest = _wall_marks(part), part.grading.longest * math.sqrt(part.mean * part.wall)
    for low, high in pairwise(marks):

        def straight(fraction: Array, low: float = low, high: float = high) -> tuple[Array, Array, Array, Array]:
            height = low + (high - low) * fraction
            return np.full_like(fraction, part.outside), height, np.full_like(fraction, part.bore), height

        first, last = (marks[height] / (high - low) for height in (low, high))
        least = max(part.grading.cells, math.ceil((high - low) / longest - SLACK))
        yield graded(0.0, 1.0, first, last, least), straight


def _wall_marks(part: Part) -> dict[float, float]:
    """Return the heights on the wall between which it is meshed, in rising order, and the first mesh step at each."""
    start, step, end = part.junction_fillet, part.length - part.rim_length, part.length
    has_corner = part.kind != "cylinder" and not part.junction_fillet
    marks = dict.fromkeys((stop for stop in part.stops if start < stop < end), part.grading.stop * part.wall)
    marks[end] = part.grading.step(sharp=False, thickness=part.wall)
    marks[start] = part.grading.step(sharp=has_corner, thickness=part.wall)
    if step < end:
        marks[step] = part.grading.step(sharp=part.has_step, thickness=part.wall)
    heights = sorted(marks)
    near = {low for low, high in pairwise(heights) if high - low <= SLACK * part.length}
    return {height: marks[height] for height in heights if height not in near}


def ribs_of(stretches: Sequence[tuple[Lines, RibsAt]], refinement: int) -> tuple[Array, Array, Array, Array]:
    """Return outer radius and height, inner radius and height of the ribs of all stretches, end to end."""
    pieces: list[tuple[Array, Array, Array, Array]] = []
    for lines, ribs_at in stretches:
        ribs = ribs_at(nodes_on(lines, refinement))
        pieces.append(tuple(values[1 if pieces else 0 :] for values in ribs))  # type: ignore[arg-type]
    return tuple(np.concatenate(values) for values in zip(*pieces, strict=True))  # type: ignore[return-value]
