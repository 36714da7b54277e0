"""The flexspline's half-section as a lattice of curved quadrilaterals, graded towards its corners.

A half-section lies in the plane of radius and height. Height 0 is the inner face of the disk where it meets the
wall; the open end is at the cylinder length. Nodes form a lattice of columns and rows; a cell takes three by three
of them and shares the outer ones with its neighbours. Where the part is L-shaped, cells of the lattice are absent.

Columns follow the meridian through the disk, rows go across it. A sharp corner is turned by letting the disk's
columns under the wall rise into it; a corner with a fillet by a fan of columns around the fillet.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from flexlash.arrays import Array
from flexlash.elasticity.part import SLACK, Part, part_of, section_problem

__all__ = ["HalfSection", "half_section"]

_GROWTH = 2.5
"""Factor by which mesh steps grow from one to the next, away from a fine end."""

_CORNER = 0.02
"""Mesh step at a sharp corner over the thickness: there the twist goes as the two-thirds power of the distance."""

_SMOOTH = 0.3
"""Mesh step where no sharp corner is, over the thickness."""

_ARC = 6
"""Cells along a fillet."""

_LONG = 6
"""Least number of cells along a stretch of the meridian."""

Place = Callable[[Array], tuple[Array, Array, Array, Array]]
"""Outer radius and height, inner radius and height of ribs at places from 0 to 1 along a stretch."""

Lines = tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class HalfSection:
    """Nodes of a half-section and what its edges are.

    `radius` and `height` [m] have shape (2 columns + 1, 2 rows + 1) and are NaN where no cell needs them; `cells`
    (columns, rows) says which exist. `clamped`, `loaded` and `hub_fillet` mark the nodes of these edges.
    `details` are places worth a closer look: what is there, radius, height, and reach around them [m].
    """

    radius: Array
    height: Array
    cells: Array
    clamped: Array
    loaded: Array
    hub_fillet: Array
    details: tuple[tuple[str, float, float, float], ...] = ()


def half_section(flexspline_type: str, dimensions: Mapping[str, float], refinement: int = 0) -> HalfSection:
    """Return the half-section of a flexspline; every refinement halves all cells both ways.

    `dimensions` in SI by name, as for `flexspline.windups`, but scalars. Raises ValueError where
    `section_problem` names a problem.
    """
    problem = section_problem(flexspline_type, dimensions)
    if problem:
        raise ValueError(problem[1])
    part = part_of(flexspline_type, dimensions)
    turned = part.kind == "cylinder" or part.junction_fillet > 0
    section = _along_the_meridian(part, refinement) if turned else _around_the_corner(part, refinement)
    return replace(section, details=tuple(_details(part)))


def _details(part: Part) -> Iterator[tuple[str, float, float, float]]:
    """Yield where hub, junction and rim step are, and how far around them stress is disturbed."""
    if part.kind != "cylinder":
        at_clamp, at_wall = (float(part.thickness(np.array([radius]))[0]) for radius in (part.clamp, part.mean))
        inwards = 1 if part.kind == "cup" else -1
        reach = 1.5 * max(2 * at_clamp, part.hub_fillet)
        drop = abs(part.clamp - part.bore) * part.lean
        name = "hub" if part.kind == "cup" else "bolt circle"
        yield name, part.clamp + inwards * 0.7 * reach, part.hub_fillet / 2 - at_clamp / 2 - drop, reach
        yield "junction", part.mean, 0.0, 2 * max(part.wall, at_wall, part.junction_fillet)
    if part.has_step:
        reach = 2 * max(part.wall, part.rim_outside - part.outside)
        yield "rim step", part.outside, part.length - part.rim_length, reach


# Mesh lines


def _graded(start: float, end: float, first: float, last: float, least: int = 1) -> Lines:
    """Return mesh lines from start to end, the steps growing from `first` and from `last` towards the middle."""
    low, high = [start], [end]
    below, above = min(first, (end - start) / least), min(last, (end - start) / least)
    longest = (end - start) / least
    while high[-1] - low[-1] > below + above:
        if below <= above:
            low.append(low[-1] + below)
            below = min(below * _GROWTH, longest)
        else:
            high.append(high[-1] - above)
            above = min(above * _GROWTH, longest)
    gap = high[-1] - low[-1]
    pieces = max(1, math.ceil(gap / max(below, above) - SLACK))
    return (*low, *(low[-1] + gap * place / pieces for place in range(1, pieces)), *reversed(high))


def _nodes(lines: Sequence[float], refinement: int) -> Array:
    """Return the nodes on mesh lines: each cell is halved once for its middle node and once per refinement."""
    found = np.asarray(lines, dtype=float)
    for _ in range(refinement + 1):
        halves = np.empty(2 * len(found) - 1)
        halves[::2] = found
        halves[1::2] = (found[:-1] + found[1:]) / 2
        found = halves
    return found


def _step(*, sharp: bool, thickness: float) -> float:
    return thickness * (_CORNER if sharp else _SMOOTH)


# Ribs across the disk and the wall


def _disk_stretches(part: Part, end: float) -> Iterator[tuple[Lines, Place]]:
    """Yield the ribs of a cup's disk from the hub to a radius: those under the hub fillet, then the others."""
    start = part.clamp
    at_hub, at_end = (float(part.thickness(np.array([radius]))[0]) for radius in (start, end))
    if part.hub_fillet:

        def arc(place: Array) -> tuple[Array, Array, Array, Array]:
            angle = place * (math.pi / 2)
            radius = part.clamp + part.hub_fillet * (1 - np.cos(angle))
            return radius, -part.thickness(radius), radius, part.hub_fillet * (1 - np.sin(angle))

        yield tuple(np.linspace(0, 1, _ARC + 1).tolist()), arc
        start += part.hub_fillet
    if end - start > SLACK * part.mean:
        stretch = math.log(end / start)

        def body(place: Array) -> tuple[Array, Array, Array, Array]:
            # Steps grow with the radius, since the twist goes as a power of it.
            radius = start * np.exp(stretch * place)
            top = -(part.bore - radius) * part.lean
            return radius, top - part.thickness(radius), radius, top

        first = _step(sharp=part.lean > 0, thickness=at_hub) / (start * stretch)
        last = _step(sharp=not part.junction_fillet, thickness=at_end) / (end * stretch)
        yield _graded(0.0, 1.0, first, last, _LONG), body


def _fan(part: Part) -> Iterator[tuple[Lines, Place]]:
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
        yield tuple(np.linspace(0, 1, _ARC + 1).tolist()), place


def _wall_stretches(part: Part) -> Iterator[tuple[Lines, Place]]:
    """Yield the ribs of the wall from the junction to the open end: those of the plain wall, then those of the rim."""
    start, step = part.junction_fillet, part.length - part.rim_length
    corner = part.kind != "cylinder" and not part.junction_fillet
    for low, high, sharp in ((start, step, (corner, part.has_step)), (step, part.length, (part.has_step, False))):
        if high - low > SLACK * part.length:

            def straight(place: Array, low: float = low, high: float = high) -> tuple[Array, Array, Array, Array]:
                height = low + (high - low) * place
                return np.full_like(place, part.outside), height, np.full_like(place, part.bore), height

            first, last = (_step(sharp=one, thickness=part.wall) / (high - low) for one in sharp)
            yield _graded(0.0, 1.0, first, last, _LONG), straight


def _ribs(stretches: Sequence[tuple[Lines, Place]], refinement: int) -> tuple[Array, Array, Array, Array]:
    """Return outer radius and height, inner radius and height of the ribs of all stretches, end to end."""
    found: list[tuple[Array, Array, Array, Array]] = []
    for lines, place in stretches:
        ribs = place(_nodes(lines, refinement))
        found.append(tuple(values[1 if found else 0 :] for values in ribs))  # type: ignore[arg-type]
    return tuple(np.concatenate(values) for values in zip(*found, strict=True))  # type: ignore[return-value]


def _ends(low_is_sharp: bool, high_is_sharp: bool) -> tuple[float, float]:  # noqa: FBT001
    """Return the first mesh steps at both ends of a thickness of 1."""
    return (_CORNER if low_is_sharp else _SMOOTH), (_CORNER if high_is_sharp else _SMOOTH)


def _across(*, inside: bool, outside: bool) -> Lines:
    """Return mesh lines across a thickness, 0 outside to 1 inside, graded towards the faces that have a corner."""
    return _graded(0.0, 1.0, *_ends(outside, inside), 2)


# Lattices


def _along_the_meridian(part: Part, refinement: int) -> HalfSection:
    """Return the half-section whose columns follow the meridian throughout; a rim adds rows outside the wall."""
    disk = [*_disk_stretches(part, part.bore - part.junction_fillet), *_fan(part)] if part.kind == "cup" else []
    outer_radius, outer_height, inner_radius, inner_height = _ribs([*disk, *_wall_stretches(part)], refinement)
    outwards = _rim_nodes(part, refinement)[::-1]
    rim = len(outwards)
    inwards = _nodes(_across(inside=False, outside=rim > 0), refinement)
    section = _blank(len(outer_radius), rim + len(inwards))
    section.radius[:, rim:] = outer_radius[:, None] + (inner_radius - outer_radius)[:, None] * inwards
    section.height[:, rim:] = outer_height[:, None] + (inner_height - outer_height)[:, None] * inwards
    section.cells[:, rim // 2 :] = True
    if rim:
        start = _rim_start(part, outer_height)
        section.radius[start:, :rim] = outwards
        section.height[start:, :rim] = outer_height[start:, None]
        section.cells[start // 2 :, : rim // 2] = True
    section.clamped[0, rim:] = True
    section.loaded[-1, :] = True
    section.hub_fillet[: _arc_nodes(part, refinement), -1] = True
    return section


def _around_the_corner(part: Part, refinement: int) -> HalfSection:
    """Return the half-section of a sharp corner: rows through the disk, and above them those of the wall.

    The columns under the wall rise into it. Beyond them stand those of a hat's flange, low, and of the rim, high.
    """
    low, bottom, top = _floor(part, refinement)
    upwards = _nodes(_across(inside=True, outside=part.lean > 0), refinement)
    heights = _ribs([*_wall_stretches(part)], refinement)[1]
    rim = _rim_nodes(part, refinement)
    floor = len(upwards) - 1
    bore, outside = (int(np.argmax(low >= radius * (1 - SLACK))) for radius in (part.bore, part.outside))
    section = _blank(max(len(low), outside + 1 + len(rim)), floor + len(heights))
    section.radius[: len(low), : floor + 1] = low[:, None]
    section.height[: len(low), : floor + 1] = bottom[:, None] + (top - bottom)[:, None] * upwards
    section.cells[: len(low) // 2, : floor // 2] = True
    wall = slice(bore, outside + 1)
    section.radius[wall, floor:] = low[wall, None]
    section.height[wall, floor:] = heights
    section.cells[bore // 2 : outside // 2, floor // 2 :] = True
    if len(rim):
        start = floor + _rim_start(part, heights)
        beyond = slice(outside + 1, outside + 1 + len(rim))
        section.radius[beyond, start:] = rim[:, None]
        section.height[beyond, start:] = heights[start - floor :]
        section.cells[outside // 2 : (outside + len(rim)) // 2, start // 2 :] = True
    section.clamped[0 if part.kind == "cup" else len(low) - 1, : floor + 1] = True
    section.loaded[bore : outside + 1 + len(rim), -1] = True
    section.hub_fillet[: _arc_nodes(part, refinement), floor] = True
    return section


def _floor(part: Part, refinement: int) -> tuple[Array, Array, Array]:
    """Return radius, lower and upper height of the columns through disk, corner and flange."""
    corners = (part.kind == "cup", part.kind == "hat" or part.has_step)
    across = _nodes(_graded(0.0, 1.0, *_ends(*corners), 2), refinement)
    low = part.bore + part.wall * across
    if part.kind == "cup":
        radius, lower, _, upper = _ribs([*_disk_stretches(part, part.bore)], refinement)
        base = (
            np.full_like(low, -float(part.thickness(np.array([part.bore]))[0])) if part.lean else -part.thickness(low)
        )
        return (
            np.concatenate([radius[:-1], low]),
            np.concatenate([lower[:-1], base]),
            np.concatenate([upper[:-1], np.zeros_like(low)]),
        )
    width = part.clamp - part.outside
    first = _step(sharp=True, thickness=float(part.thickness(np.array([part.outside]))[0]))
    last = first * _SMOOTH / _CORNER
    flange = part.outside + width * _nodes(_graded(0.0, 1.0, first / width, last / width, _LONG), refinement)
    low = np.concatenate([low, flange[1:]])
    top = -(low - part.outside) * part.lean * (low > part.outside)
    return low, top - part.thickness(low), top


def _rim_nodes(part: Part, refinement: int) -> Array:
    """Return the radii of nodes in the part of the rim that stands out from the wall, the wall's own left out."""
    if not part.has_step:
        return np.zeros(0)
    first = _step(sharp=True, thickness=min(part.wall, part.rim_outside - part.outside))
    last = _step(sharp=False, thickness=part.rim_outside - part.outside)
    return _nodes(_graded(part.outside, part.rim_outside, first, last, 2), refinement)[1:]


def _rim_start(part: Part, heights: Array) -> int:
    """Return the node at which the rim begins."""
    return int(np.argmax(heights >= part.length - part.rim_length - SLACK * part.length))


def _arc_nodes(part: Part, refinement: int) -> int:
    """Return the number of nodes along the hub fillet."""
    return 2 ** (refinement + 1) * _ARC + 1 if part.hub_fillet else 0


def _blank(columns: int, rows: int) -> HalfSection:
    """Return a lattice of nodes without cells."""
    shape = (columns, rows)
    return HalfSection(
        radius=np.full(shape, np.nan),
        height=np.full(shape, np.nan),
        cells=np.zeros((columns // 2, rows // 2), dtype=bool),
        clamped=np.zeros(shape, dtype=bool),
        loaded=np.zeros(shape, dtype=bool),
        hub_fillet=np.zeros(shape, dtype=bool),
    )
