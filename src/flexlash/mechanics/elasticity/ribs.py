"""Ribs across the disk and the wall, stretch by stretch along the meridian from the hub to the open end."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from flexlash.mechanics.elasticity.mesh_lines import Lines, graded, nodes_on, step_at
from flexlash.mechanics.elasticity.part import SLACK, Part
from flexlash.schema.arrays import Array

__all__ = ["ARC", "LONG", "disk_stretches", "fan", "ribs_of", "wall_stretches"]

ARC = 6
"""Cells along a fillet."""

LONG = 6
"""Least number of cells along a stretch of the meridian."""

Place = Callable[[Array], tuple[Array, Array, Array, Array]]
"""Outer radius and height, inner radius and height of ribs at places from 0 to 1 along a stretch."""


def disk_stretches(part: Part, end: float) -> Iterator[tuple[Lines, Place]]:
    """Yield the ribs of a cup's disk from the hub to a radius: those under the hub fillet, then the others."""
    start = part.clamp
    at_hub, at_end = (float(part.thickness(np.array([radius]))[0]) for radius in (start, end))
    if part.hub_fillet:

        def arc(place: Array) -> tuple[Array, Array, Array, Array]:
            angle = place * (math.pi / 2)
            radius = part.clamp + part.hub_fillet * (1 - np.cos(angle))
            return radius, -part.thickness(radius), radius, part.hub_fillet * (1 - np.sin(angle))

        yield tuple(np.linspace(0, 1, ARC + 1).tolist()), arc
        start += part.hub_fillet
    if end - start > SLACK * part.mean:
        stretch = math.log(end / start)

        def body(place: Array) -> tuple[Array, Array, Array, Array]:
            # Steps grow with the radius, since the twist goes as a power of it.
            radius = start * np.exp(stretch * place)
            top = -(part.bore - radius) * part.lean
            return radius, top - part.thickness(radius), radius, top

        first = step_at(sharp=part.lean > 0, thickness=at_hub) / (start * stretch)
        last = step_at(sharp=not part.junction_fillet, thickness=at_end) / (end * stretch)
        yield graded(0.0, 1.0, first, last, LONG), body


def fan(part: Part) -> Iterator[tuple[Lines, Place]]:
    """Yield the ribs around the junction fillet, from the disk to the diagonal and from there to the wall."""
    fillet, bore = part.junction_fillet, part.bore
    base = float(part.thickness(np.array([part.outside]))[0])

    def on_arc(angle: Array) -> tuple[Array, Array]:
        return bore - fillet * (1 - np.sin(angle)), fillet * (1 - np.cos(angle))

    def to_diagonal(place: Array) -> tuple[Array, Array, Array, Array]:
        radius = bore - fillet + (part.outside - bore + fillet) * place
        return radius, -part.thickness(radius), *on_arc(place * (math.pi / 4))

    def from_diagonal(place: Array) -> tuple[Array, Array, Array, Array]:
        height = -base + (base + fillet) * place
        return np.full_like(place, part.outside), height, *on_arc((1 + place) * (math.pi / 4))

    for place in (to_diagonal, from_diagonal):
        yield tuple(np.linspace(0, 1, ARC + 1).tolist()), place


def wall_stretches(part: Part) -> Iterator[tuple[Lines, Place]]:
    """Yield the ribs of the wall from the junction to the open end: those of the plain wall, then those of the rim."""
    start, step = part.junction_fillet, part.length - part.rim_length
    corner = part.kind != "cylinder" and not part.junction_fillet
    for low, high, sharp in ((start, step, (corner, part.has_step)), (step, part.length, (part.has_step, False))):
        if high - low > SLACK * part.length:

            def straight(place: Array, low: float = low, high: float = high) -> tuple[Array, Array, Array, Array]:
                height = low + (high - low) * place
                return np.full_like(place, part.outside), height, np.full_like(place, part.bore), height

            first, last = (step_at(sharp=one, thickness=part.wall) / (high - low) for one in sharp)
            yield graded(0.0, 1.0, first, last, LONG), straight


def ribs_of(stretches: Sequence[tuple[Lines, Place]], refinement: int) -> tuple[Array, Array, Array, Array]:
    """Return outer radius and height, inner radius and height of the ribs of all stretches, end to end."""
    found: list[tuple[Array, Array, Array, Array]] = []
    for lines, place in stretches:
        ribs = place(nodes_on(lines, refinement))
        found.append(tuple(values[1 if found else 0 :] for values in ribs))  # type: ignore[arg-type]
    return tuple(np.concatenate(values) for values in zip(*found, strict=True))  # type: ignore[return-value]
