"""The wind-up by two-dimensional elasticity, without the thin shell's assumptions: a check on the meridian integral.

A body of revolution under torque twists by φ(r, z) with ∇·(G r³ ∇φ) = 0 on its half-section. The finite elements
are scikit-fem's quadrilaterals of second order with curved edges. Two meshes, one with every cell of the other
halved both ways, tell how far the result is converged.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from flexlash.mechanics import windup
from flexlash.mechanics.elasticity.half_section import HalfSection, half_section
from flexlash.mechanics.elasticity.section_mesh import face_shares, section_mesh
from flexlash.mechanics.flexspline import modulus_of
from flexlash.schema.argument_checks import number, of_type, one_of
from flexlash.schema.arrays import Array
from flexlash.schema.columns import DIMENSIONS

__all__ = ["ElasticityCheck", "UnitTwist", "elasticity_check", "require_dimensions", "unit_twist"]

_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
_POINTS, _SHARES = (_GAUSS + 1) / 2, _WEIGHTS / 2
"""Gauss points from 0 to 1: exact for r³ times an edge's quadratic shape functions."""


_CONVERGED = 5e-4
"""Change of the wind-up from one mesh to the next at which refining ends."""

_PEAK_CONVERGED = 0.03
"""Change of the peak stress from one mesh to the next above which it is not told."""

_CHANCE = 5e-6
"""Added to the change, as a share, since two meshes may agree by chance."""

_REFINEMENTS = 2


@dataclass(frozen=True, kw_only=True)
class UnitTwist:
    """The twist on one mesh, free of torque and material.

    `integral` is that of ds/(r³ t) along a meridian [1/m³]; `stress` is r|∇φ| at the Gauss points of all cells
    (cells, 9), `hub_stress` and `junction_stress` its greatest values along the two fillets [1/m³], None without: the
    shear stress is T/(2π) of them.
    """

    integral: float
    stress: Array
    hub_stress: float | None
    junction_stress: float | None


@dataclass(frozen=True, kw_only=True)
class ElasticityCheck:
    """The elasticity check of one flexspline, in SI.

    `windup` [rad], its `error` as a share of it, the greatest shear stress along hub fillet and junction fillet [Pa],
    None without the fillet or where it has not settled to 3 %, and for a picture the finer half-section with the shear
    stress at the Gauss points of its cells (cells, 9) [Pa].
    """

    windup: float
    error: float
    hub_fillet_shear: float | None
    junction_fillet_shear: float | None
    section: HalfSection
    shear: Array


_EITHER = (("mean_radius", "bore_diameter"), ("shear_modulus", "youngs_modulus"), ("shear_modulus", "poisson_ratio"))
_CLAMPS = {"cup": ("disk_inner_radius",), "hat": ("disk_outer_radius",), "cylinder": ()}
"""What each type needs besides torque, cylinder_length, wall_thickness and one of each of these."""


def require_dimensions(flexspline_type: str, dimensions: Mapping[str, float]) -> None:
    """Raise TypeError or ValueError for a type or dimension that is none, with its name."""
    one_of("flexspline_type", flexspline_type, _CLAMPS)
    for name, value in of_type("dimensions", dimensions, Mapping, "a mapping of names to numbers").items():
        one_of("a name of dimensions", name, DIMENSIONS)
        if number(f"dimensions[{name!r}]", value) < 0:
            raise ValueError(f"dimensions[{name!r}] = {value:g}: a number of at least 0 is required")
    needed = [(name,) for name in ("torque", "cylinder_length", "wall_thickness", *_CLAMPS[flexspline_type])]
    for names in (*needed, *_EITHER):
        if dimensions.keys().isdisjoint(names):
            raise ValueError(f"dimensions without {' or '.join(names)}: a {flexspline_type} needs it")


def elasticity_check(flexspline_type: str, dimensions: Mapping[str, float]) -> ElasticityCheck:
    """Wind-up of a flexspline by two-dimensional elasticity, with its own error.

    Equation: ∇·(G r³ ∇φ) = 0; φ = 0 at the hub bore, of a hat at the bolt circle, of a tube at its end; at the open
        end the torque enters as shear traction ∝ r, and the wind-up is the work of that traction over the torque
    Arguments: flexspline_type and dimensions in SI by name as for `flexspline.windups`, but scalars; calibrations
        are not used.
    Valid: linear elasticity, load even around the axis; raises ValueError where `section_problem` names a problem,
        TypeError or ValueError, with its name, for a dimension that is unknown, missing or no number.
        The error is the change from the mesh before and 5e-6, which is greater than what remains.
    Source: Michell's torsion of bodies of revolution; Timoshenko and Goodier, Theory of Elasticity.

    >>> from flexlash.mechanics.elasticity import is_available
    >>> plain = {"torque": 800.0, "cylinder_length": 0.16, "mean_radius": 0.0808, "wall_thickness": 0.0016,
    ...          "disk_inner_radius": 0.04, "shear_modulus": 8.10769e10}
    >>> f"{elasticity_check('cup', plain).windup:.3e}" if is_available() else "5.294e-04"
    '5.294e-04'
    """
    require_dimensions(flexspline_type, dimensions)
    section = half_section(flexspline_type, dimensions)
    before = twist = unit_twist(section)
    error = math.inf
    for refinement in range(1, _REFINEMENTS + 1):
        before = twist
        section = half_section(flexspline_type, dimensions, refinement)
        twist = unit_twist(section)
        error = abs(twist.integral / before.integral - 1) + _CHANCE
        if error < _CONVERGED:
            break
    torque = dimensions["torque"]
    per_stress = torque / (2 * math.pi)
    hub, junction = (
        _settled(*stresses)
        for stresses in ((before.hub_stress, twist.hub_stress), (before.junction_stress, twist.junction_stress))
    )
    return ElasticityCheck(
        windup=float(windup.segment_windup(torque, modulus_of(dimensions), twist.integral)),
        error=error,
        hub_fillet_shear=None if hub is None else per_stress * hub,
        junction_fillet_shear=None if junction is None else per_stress * junction,
        section=section,
        shear=per_stress * twist.stress,
    )


def _settled(before: float | None, after: float | None) -> float | None:
    """Return a peak stress, None where it still changes from mesh to mesh."""
    if before is None or after is None or abs(after / before - 1) > _PEAK_CONVERGED:
        return None
    return after


def unit_twist(section: HalfSection) -> UnitTwist:
    """Return the twist of a half-section under a torque of 2πG."""
    from skfem import Basis, BilinearForm, ElementQuad2, condense, solve
    from skfem.helpers import dot, grad

    mesh, number = section_mesh(section)
    basis = Basis(mesh, ElementQuad2(), intorder=6)
    stiffness = BilinearForm(lambda u, v, w: w.x[0] ** 3 * dot(grad(u), grad(v))).assemble(basis)
    load = np.zeros(basis.N)
    load[number[section.loaded]] = (_face_load if section.has_face else _end_load)(section)
    twist = solve(*condense(stiffness, load, D=number[section.clamped]))
    inner = np.stack(np.meshgrid(_POINTS, _POINTS, indexing="ij")).reshape(2, -1)
    stress = _stress(Basis(mesh, ElementQuad2(), quadrature=(inner, np.ones(9))), twist)
    edge = np.stack([_POINTS, np.ones(3)])

    def peak(marks: Array) -> float | None:
        cells = np.nonzero(marks[1::2, 2::2][section.cells])[0]
        if not len(cells):
            return None
        along = Basis(mesh, ElementQuad2(), quadrature=(edge, np.ones(3)), elements=cells)
        return float(_stress(along, twist).max())

    return UnitTwist(
        integral=float(load @ twist),
        stress=stress,
        hub_stress=peak(section.hub_fillet),
        junction_stress=peak(section.junction_fillet),
    )


def _face_load(section: HalfSection) -> Array:
    """Return the nodal loads of unit torque over 2π on the face that the teeth load, the traction even."""
    moments = (face_shares(section) * section.radius * section.radius)[section.loaded]
    return np.asarray(moments / moments.sum())


def _end_load(section: HalfSection) -> Array:
    """Return the nodal loads of unit torque over 2π on the open end's nodes, the traction growing with the radius."""
    radius = section.radius[section.loaded]
    low, high = radius[:-2:2, None], radius[2::2, None]
    point = low + (high - low) * _POINTS
    share = (high - low) * _SHARES * point**3 * 4 / (radius[-1] ** 4 - radius[0] ** 4)
    shapes = ((1 - _POINTS) * (1 - 2 * _POINTS), 4 * _POINTS * (1 - _POINTS), _POINTS * (2 * _POINTS - 1))
    load = np.zeros(len(radius))
    for start, shape in enumerate(shapes):
        nodes = slice(start, len(radius) - 2 + start, 2)
        load[nodes] += (share * shape).sum(axis=1)
    return load


def _stress(basis: Any, twist: Array) -> Array:
    """Return r|∇φ| at the points of a basis (cells, points)."""
    across, along = basis.interpolate(twist).grad
    radius = np.asarray(basis.global_coordinates())[0]
    return np.asarray(radius * np.sqrt(across * across + along * along))
