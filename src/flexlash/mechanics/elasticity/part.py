"""The dimensions that a half-section needs, and whether they make one."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from flexlash.mechanics.flexspline import disk_thickness, radius_of
from flexlash.schema.arrays import Array
from flexlash.schema.part_row import NumberRow, first_broken
from flexlash.schema.section_rules import SECTION_RULES

__all__ = ["BENDING", "SLACK", "TORSION", "Grading", "Part", "part_of", "section_problem"]

SLACK = 1e-9
"""Sums of decimals miss an edge by their last binary digit; relative to the radius."""

_FOIL = 1e-4
"""Least thickness over the mean radius: thinner ones defy rounding."""


@dataclass(frozen=True, kw_only=True)
class Grading:
    """How fine a mesh is.

    `corner`, `smooth` and `stop` are first steps over the thickness: at a sharp corner, where none is, and at a stop;
    `longest` is the longest step on the wall over √(r_m Δ), `cells` the least number of cells along a stretch.
    """

    corner: float
    smooth: float
    stop: float
    longest: float
    cells: int

    def step(self, *, sharp: bool, thickness: float) -> float:
        """Return the first mesh step at an end, from the thickness there."""
        return thickness * (self.corner if sharp else self.smooth)


TORSION = Grading(corner=0.02, smooth=0.3, stop=0.3, longest=math.inf, cells=6)
"""For the twist alone, which goes as the two-thirds power of the distance from a sharp corner."""

BENDING = Grading(corner=0.5, smooth=0.5, stop=0.2, longest=1.0, cells=2)
"""For two lobes, which bend the wall over lengths of √(r_m Δ) from where the bearing ends; its corners cost 5e-4."""


@dataclass(frozen=True, kw_only=True)
class Part:
    """The dimensions of one flexspline [m] as its half-section needs them; what it has not is 0.

    `clamp` is the radius where the disk is held; `lean` the fall of a conical disk per radius [-]; `thickness` the
    height of the disk along the axis at radii of any shape. `stops` are heights on the wall where mesh lines must
    stand, as where the teeth's load ends; `grading` says how fine the mesh is.
    """

    kind: str
    mean: float
    wall: float
    length: float
    clamp: float
    hub_fillet: float
    junction_fillet: float
    rim_length: float
    rim_thickness: float
    face_width: float
    lean: float
    thickness: Callable[[Array], Array]
    stops: tuple[float, ...] = ()
    grading: Grading = TORSION

    @property
    def bore(self) -> float:
        """Inner radius of the wall."""
        return self.mean - self.wall / 2

    @property
    def outside(self) -> float:
        """Outer radius of the wall."""
        return self.mean + self.wall / 2

    @property
    def rim_outside(self) -> float:
        """Outer radius of the tooth rim."""
        return self.bore + max(self.rim_thickness, self.wall)

    @property
    def has_step(self) -> bool:
        """Whether the rim stands out from the wall."""
        return self.rim_length > 0 and self.rim_outside > self.outside * (1 + SLACK)


def part_of(flexspline_type: str, dimensions: Mapping[str, float]) -> Part:
    """Return the dimensions of a half-section; blanks are the same dimension elsewhere."""
    mean = float(radius_of(dimensions))
    angle = dimensions.get("disk_cone_angle", math.pi / 2)
    length, face_width = dimensions["cylinder_length"], dimensions.get("tooth_face_width", 0.0)

    def thickness(radius: Array) -> Array:
        # Under the wall the disk goes on as thick as it is where it ends.
        end = min(dimensions.get("disk_outer_radius", mean), mean) if flexspline_type == "cup" else math.inf
        return np.zeros_like(radius) + disk_thickness(dimensions, np.minimum(radius, end)) / math.sin(angle)

    clamp = {"cup": "disk_inner_radius", "hat": "disk_outer_radius"}.get(flexspline_type, "mean_radius")
    return Part(
        kind=flexspline_type,
        mean=mean,
        wall=dimensions["wall_thickness"],
        length=length,
        clamp=dimensions.get(clamp, mean),
        hub_fillet=dimensions.get("hub_fillet_radius", 0.0),
        junction_fillet=dimensions.get("junction_fillet_radius", 0.0),
        rim_length=dimensions.get("rim_length", 0.0),
        rim_thickness=dimensions.get("rim_thickness", 0.0),
        face_width=face_width,
        lean=1 / math.tan(angle) if angle < math.pi / 2 - SLACK else 0.0,
        thickness=thickness,
        stops=(length - face_width,) if face_width else (),
    )


def section_problem(flexspline_type: str, dimensions: Mapping[str, float]) -> tuple[str, str] | None:
    """Return why the dimensions make no closed half-section: the dimension to blame and a clause; None if they do."""
    part = part_of(flexspline_type, dimensions)
    if foil := _foil(part, dimensions):
        return foil
    edge, flat = SLACK * part.mean, math.pi / 2 - SLACK
    row = NumberRow(type=flexspline_type, entries=dimensions, edge=edge, flat=flat)
    rule = first_broken(SECTION_RULES, row)
    return (rule.dimension, rule.words) if rule else None


def _foil(part: Part, dimensions: Mapping[str, float]) -> tuple[str, str] | None:
    """Return which dimension is too thin to solve, and why."""
    least = _FOIL * part.mean
    if part.wall < least:
        return "wall_thickness", "the wall is too thin a foil to solve"
    ends = np.array([part.clamp, dimensions.get("disk_outer_radius", part.mean), part.mean])
    has_foil = part.kind != "cylinder" and part.thickness(ends).min() < least
    if not has_foil:
        return None
    thin = "disk_hub_thickness" if "disk_hub_thickness" in dimensions else "disk_thickness"
    return thin if thin in dimensions else "wall_thickness", "the disk thins to a foil that cannot be solved"
