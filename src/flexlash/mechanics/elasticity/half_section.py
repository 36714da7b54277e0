"""The flexspline's half-section as a lattice of curved quadrilaterals, graded towards its corners.

A half-section lies in the plane of radius and height. Height 0 is the inner face of the disk where it meets the
wall; the open end is at the cylinder length. Nodes form a lattice of columns and rows; a cell takes three by three
of them and shares the outer ones with its neighbours. Where the part is L-shaped, cells of the lattice are absent.

Columns follow the meridian through the disk, rows go across it. A sharp corner is turned by letting the disk's
columns under the wall rise into it; a corner with a fillet by a fan of columns around the fillet.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flexlash.mechanics.elasticity.mesh_lines import across, graded, nodes_on
from flexlash.mechanics.elasticity.part import SLACK, Part, part_of, section_problem
from flexlash.mechanics.elasticity.ribs import ARC, disk_stretches, fan, ribs_of, wall_stretches
from flexlash.schema.arrays import Array

__all__ = ["HalfSection", "half_section", "section_of"]


@dataclass(frozen=True, kw_only=True)
class HalfSection:
    """Nodes of a half-section and what its edges are.

    `radius` and `height` [m] have shape (2 columns + 1, 2 rows + 1) and are NaN where no cell needs them; `cells`
    (columns, rows) says which exist. `clamped`, `loaded`, `hub_fillet`, `junction_fillet` and `bore` mark the nodes of
    these edges; what is loaded is the open end or, where it `has_face`, the outer face as far as the teeth reach.
    `details` are places worth a closer look: what is there, radius, height, and reach around them [m].
    """

    radius: Array
    height: Array
    cells: Array
    clamped: Array
    loaded: Array
    hub_fillet: Array
    junction_fillet: Array
    bore: Array
    has_face: bool = False
    details: tuple[tuple[str, float, float, float], ...] = ()


def half_section(flexspline_type: str, dimensions: Mapping[str, float], refinement: int = 0) -> HalfSection:
    """Return the half-section of a flexspline; every refinement halves all cells both ways.

    `dimensions` in SI by name, as for `flexspline.windups`, but scalars. Raises ValueError where
    `section_problem` names a problem.
    """
    problem = section_problem(flexspline_type, dimensions)
    if problem:
        raise ValueError(problem[1])
    return section_of(part_of(flexspline_type, dimensions), refinement)


def section_of(part: Part, refinement: int = 0) -> HalfSection:
    """Return the half-section of a part that has no `section_problem`."""
    turned = part.kind == "cylinder" or part.junction_fillet > 0
    section = _along_the_meridian(part, refinement) if turned else _around_the_corner(part, refinement)
    return replace(section, details=tuple(_details(part)), has_face=part.face_width > 0, **_wall_edges(part, section))


def _wall_edges(part: Part, section: HalfSection) -> dict[str, Any]:
    """Return the nodes on the bore of the wall, and those that the teeth load where they have a width."""
    radius, height, slack = section.radius, section.height, SLACK * part.length
    edges = {"bore": (np.abs(radius - part.bore) <= slack) & (height >= part.junction_fillet - slack)}
    if part.face_width:
        step = part.length - part.rim_length if part.has_step else part.length
        on_wall = (np.abs(radius - part.outside) <= slack) & (height <= step + slack)
        on_rim = (np.abs(radius - part.rim_outside) <= slack) & (height >= step - slack)
        edges["loaded"] = (on_wall | on_rim) & (height >= part.length - part.face_width - slack)
    return edges


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


def _along_the_meridian(part: Part, refinement: int) -> HalfSection:
    """Return the half-section whose columns follow the meridian throughout; a rim adds rows outside the wall."""
    disk = [*disk_stretches(part, part.bore - part.junction_fillet)] if part.kind == "cup" else []
    around = [*fan(part)] if part.kind == "cup" else []
    outer_radius, outer_height, inner_radius, inner_height = ribs_of(
        [*disk, *around, *wall_stretches(part)], refinement
    )
    outwards = _rim_nodes(part, refinement)[::-1]
    rim = len(outwards)
    inwards = nodes_on(across(part.grading, low_is_sharp=rim > 0, high_is_sharp=False), refinement)
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
    if around:
        ends = np.cumsum([sum(len(lines) - 1 for lines, _ in stretches) for stretches in (disk, around)])
        start, end = ends * 2 ** (refinement + 1)
        section.junction_fillet[start : end + 1, -1] = True
    section.hub_fillet[: _arc_nodes(part, refinement), -1] = True
    return section


def _around_the_corner(part: Part, refinement: int) -> HalfSection:
    """Return the half-section of a sharp corner: rows through the disk, and above them those of the wall.

    The columns under the wall rise into it. Beyond them stand those of a hat's flange, low, and of the rim, high.
    """
    low, bottom, top = _floor(part, refinement)
    upwards = nodes_on(across(part.grading, low_is_sharp=part.lean > 0, high_is_sharp=True), refinement)
    heights = ribs_of([*wall_stretches(part)], refinement)[1]
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
    lines = across(part.grading, low_is_sharp=part.kind == "cup", high_is_sharp=part.kind == "hat" or part.has_step)
    low = part.bore + part.wall * nodes_on(lines, refinement)
    if part.kind == "cup":
        radius, lower, _, upper = ribs_of([*disk_stretches(part, part.bore)], refinement)
        base = (
            np.full_like(low, -float(part.thickness(np.array([part.bore]))[0])) if part.lean else -part.thickness(low)
        )
        return (
            np.concatenate([radius[:-1], low]),
            np.concatenate([lower[:-1], base]),
            np.concatenate([upper[:-1], np.zeros_like(low)]),
        )
    width = part.clamp - part.outside
    thickness = float(part.thickness(np.array([part.outside]))[0])
    first, last = (part.grading.step(sharp=sharp, thickness=thickness) for sharp in (True, False))
    flange = part.outside + width * nodes_on(
        graded(0.0, 1.0, first / width, last / width, part.grading.cells), refinement
    )
    low = np.concatenate([low, flange[1:]])
    top = -(low - part.outside) * part.lean * (low > part.outside)
    return low, top - part.thickness(low), top


def _rim_nodes(part: Part, refinement: int) -> Array:
    """Return the radii of nodes in the part of the rim that stands out from the wall, the wall's own left out."""
    if not part.has_step:
        return np.zeros(0)
    first = part.grading.step(sharp=True, thickness=min(part.wall, part.rim_outside - part.outside))
    last = part.grading.step(sharp=False, thickness=part.rim_outside - part.outside)
    return nodes_on(graded(part.outside, part.rim_outside, first, last, 2), refinement)[1:]


def _rim_start(part: Part, heights: Array) -> int:
    """Return the node at which the rim begins."""
    return int(np.argmax(heights >= part.length - part.rim_length - SLACK * part.length))


def _arc_nodes(part: Part, refinement: int) -> int:
    """Return the number of nodes along the hub fillet."""
    return 2 ** (refinement + 1) * ARC + 1 if part.hub_fillet else 0


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
        junction_fillet=np.zeros(shape, dtype=bool),
        bore=np.zeros(shape, dtype=bool),
    )
