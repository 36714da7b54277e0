"""One integral for every shape: the wind-up of a thin shell of revolution under torque.

A meridian of arc length s, radius r and thickness t winds up by U = T/(2πG) · ∫ ds/(r³ t). Each function
below is one segment's share of the integral [1/m³]; `segment_windup` turns it into an angle.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.special import boxcox, sindg

from flexlash.arrays import Array

__all__ = [
    "annulus_integral",
    "cone_integral",
    "hub_fillet_integral",
    "junction_fillet_integral",
    "mean_radius_from_bore",
    "power_law_disk_integral",
    "rim_integral",
    "segment_windup",
    "shear_modulus",
    "tapered_disk_integral",
    "wall_integral",
]

_NEARLY = 0.1
"""Relative change of t/r over a disk below which its thickness counts as nearly proportional to the radius."""

_TAPER_NODES, _TAPER_SHARES = np.polynomial.legendre.leggauss(6)
_TAPER_PLACES, _TAPER_WEIGHTS = (_TAPER_NODES + 1) / 2, _TAPER_SHARES / 2
_ARC_NODES, _ARC_WEIGHTS = np.polynomial.legendre.leggauss(12)
_ARC_ANGLES = (_ARC_NODES + 1) * np.pi / 4
_ARC_STEPS = _ARC_WEIGHTS * np.pi / 4

_FITTED = (
    (0.0814393410996599, 0.16529866972037566),
    (0.25821157583711407, 0.19208838252972127),
    (0.47109223622392854, 0.23505735771838746),
    (0.7274664878100502, 0.2750983196290333),
    (1.0111507847150607, 0.28485302680318736),
    (1.279446758070356, 0.24240361387908071),
    (1.4792660625622378, 0.15055964925008272),
)
"""Angles p from the wall and weights of a rule from 0 to π/2 fitted to the junction fillet's integrands."""

_JUNCTION_RULE = tuple((float(1 - np.cos(angle)), float(8 * weight * np.cos(angle))) for angle, weight in _FITTED)
"""Share of the fillet radius by which the wall is thickened, and weight; 8 since the radius is doubled."""


def shear_modulus(youngs_modulus: Array | float, poisson_ratio: Array | float) -> Array:
    """Shear modulus of an isotropic material [Pa].

    Equation: G = E / (2 (1 + ν))
    Arguments: youngs_modulus E [Pa] and poisson_ratio ν [-], of any one shape.
    Valid: isotropic linear elasticity, 0 ≤ ν ≤ 0.5.
    Source: elasticity theory; the B3-160 article prints 8.10769e10 for what is 8.11538e10.

    >>> round(float(shear_modulus(211e9, 0.3)))
    81153846154
    """
    return np.asarray(youngs_modulus / (2 * (1 + poisson_ratio)))


def mean_radius_from_bore(bore_diameter: Array | float, wall_thickness: Array | float) -> Array:
    """Radius of the middle of the wall [m].

    Equation: r_m = d/2 + Δ/2
    Arguments: bore_diameter d [m] and wall_thickness Δ [m], of any one shape.
    Valid: any tube.
    Source: geometry.

    >>> round(float(mean_radius_from_bore(0.160, 0.0016)), 9)
    0.0808
    """
    return np.asarray((bore_diameter + wall_thickness) * 0.5)


def segment_windup(torque: Array | float, modulus: Array | float, integral: Array | float) -> Array:
    """Wind-up angle of a segment [rad].

    Equation: U = T/(2πG) · I
    Arguments: torque T [N·m], shear modulus G [Pa] and the segment's integral I [1/m³], of any one shape.
    Valid: linear elasticity, torque carried by shear around the axis alone.
    Source: thin shells of revolution in torsion; for a tube it is U = T l/(G J_p), J_p = 2π r_m³ Δ.

    >>> f"{segment_windup(800.0, 8.1153846153846e10, wall_integral(0.16, 0.08, 0.0016)):.10e}"
    '3.0642983711e-04'
    """
    return np.asarray(torque / (2 * np.pi * modulus) * integral)


def wall_integral(length: Array | float, mean_radius: Array | float, thickness: Array | float) -> Array:
    """Integral of a plain cylindrical wall [1/m³].

    Equation: I = l / (r_m³ Δ)
    Arguments: length l, mean_radius r_m and thickness Δ [m], of any one shape.
    Valid: thin wall; low by (Δ/2r_m)², so negligible up to Δ/r_m = 0.2.
    Source: Bredt's thin tube.

    >>> float(wall_integral(1.0, 1.0, 0.5))
    2.0
    """
    return np.asarray(length / (mean_radius * mean_radius * mean_radius * thickness))


def annulus_integral(inner_radius: Array | float, outer_radius: Array | float, thickness: Array | float) -> Array:
    """Integral of a flat disk or flange of even thickness [1/m³].

    Equation: I = (1/r_i² − 1/r_o²) / (2 t)
    Arguments: inner_radius r_i, outer_radius r_o and thickness t [m], of any one shape.
    Valid: flat annulus in pure in-plane shear.
    Source: r² τ t constant and r d(u/r)/dr = τ/G; B3-160 article, disk term.

    >>> float(annulus_integral(0.5, 1.0, 1.0))
    1.5
    """
    return np.asarray((1 / (inner_radius * inner_radius) - 1 / (outer_radius * outer_radius)) / (2 * thickness))


def cone_integral(flat_integral: Array | float, semi_angle: Array | float) -> Array:
    """Integral of a conical disk, from that of the flat disk with the same radii and thicknesses [1/m³].

    Equation: I = I_flat / sin a
    Arguments: flat_integral I_flat [1/m³] and semi_angle a [rad] between cone and axis, of any one shape.
    Valid: thin cone, 0 < a ≤ π/2, thickness measured normal to it; a = π/2 is the flat disk.
    Source: the meridian integral with ds = dr / sin a.

    >>> round(float(cone_integral(annulus_integral(0.5, 1.0, 1.0), np.pi / 6)), 12)
    3.0
    """
    # The sine of SciPy, since NumPy's may round otherwise at another place of an array.
    return np.asarray(flat_integral / sindg(np.asarray(semi_angle) * (180 / np.pi)))


def power_law_disk_integral(
    inner_radius: Array | float, outer_radius: Array | float, inner_thickness: Array | float, exponent: Array | float
) -> Array:
    """Integral of a disk that thins with a power of the radius [1/m³].

    Equation: I = ∫ dr/(r³ t), t = t_i (r_i/r)^n: ((r_o/r_i)^(n−2) − 1) / ((n − 2) t_i r_i²), ln(r_o/r_i) at n = 2
    Arguments: inner_radius r_i, outer_radius r_o, inner_thickness t_i [m], exponent n [-], of any one shape.
    Valid: thin disk; n = 2 has the same shear stress at every radius.
    Source: the meridian integral in closed form; (x^p − 1)/p is the Box–Cox function, steady as p vanishes.

    >>> f"{segment_windup(800.0, 8.1153846153846e10, power_law_disk_integral(0.04, 0.08, 0.004, 2)):.9e}"
    '1.699207821e-04'
    """
    growth = boxcox(outer_radius / np.asarray(inner_radius), np.asarray(exponent) - 2.0)
    return np.asarray(growth / (inner_thickness * inner_radius * inner_radius))


def tapered_disk_integral(
    inner_radius: Array | float,
    outer_radius: Array | float,
    inner_thickness: Array | float,
    outer_thickness: Array | float,
) -> Array:
    """Integral of a disk that thins in a straight line [1/m³].

    Equation: I = ∫ v dv/t over v = 1/r, t = a + b r: [v²/2 − v b/a + (b/a)² ln(a v + b)]/a between the radii
    Arguments: inner_radius, outer_radius, inner_thickness, outer_thickness [m], of any one shape.
    Valid: thin disk; error below 1e-14. Where t is nearly proportional to r, so that a vanishes and the closed form
        cancels, six Gauss–Legendre points of ∫ v² dv/(a v + b) take its place.
    Source: the meridian integral in closed form.

    >>> f"{segment_windup(800.0, 8.1153846153846e10, tapered_disk_integral(0.04, 0.08, 0.004, 0.0016)):.10e}"
    '1.2086009619e-04'
    """
    low, high = 1 / np.asarray(outer_radius), 1 / np.asarray(inner_radius)
    reach = high - low
    start, end = low * outer_thickness, high * inner_thickness
    growth = end - start
    proportional = np.abs(growth) < _NEARLY * start
    axis_thickness = np.where(proportional, 1.0, growth / np.where(reach == 0, 1.0, reach))
    slope = (inner_thickness - axis_thickness) / (inner_radius * axis_thickness)
    # The logarithm of SciPy, since NumPy's may round otherwise at another place of an array.
    closed = (reach * ((high + low) / 2 - slope) + slope * slope * boxcox(end / start, 0.0)) / axis_thickness
    total: Array | float = 0.0
    for place, weight in zip(_TAPER_PLACES, _TAPER_WEIGHTS, strict=True):
        curvature = low + reach * place
        total = total + weight * (curvature * curvature) / (start + growth * place)
    return np.asarray(np.where(proportional, total * reach, closed))


def hub_fillet_integral(
    inner_radius: Array | float, fillet_radius: Array | float, thickness_at: Callable[[Array], Array | float]
) -> Array:
    """Integral of the disk's inmost ring, thickened by the hub fillet [1/m³].

    Equation: I = ∫ dr/(r³ (t + a)), r from r_ci to r_ci + R, a = R (1 − sin q), r = r_ci + R (1 − cos q)
    Arguments: inner_radius r_ci and fillet_radius R [m], of any one shape; thickness_at gives the thickness t of
        the disk itself [m] at radii of that shape.
    Valid: R up to the width of the disk; twelve Gauss–Legendre points in q, error below 1e-10 at R = 2t and
        below 1e-7 at R = 20t.
    Source: the meridian integral with the fillet on the inner face; the substitution tames the steep end.

    >>> f"{hub_fillet_integral(0.04, 0.0035, lambda _: 0.0016):.6e}"
    '2.202297e+04'
    """
    total: Array | float = 0.0
    for angle, step in zip(_ARC_ANGLES, _ARC_STEPS, strict=True):
        radius = np.asarray(inner_radius + fillet_radius * (1 - np.cos(angle)))
        thickness = thickness_at(radius) + fillet_radius * (1 - np.sin(angle))
        total = total + step * np.sin(angle) / (radius * radius * radius * thickness)
    return np.asarray(total * fillet_radius)


def junction_fillet_integral(
    mean_radius: Array | float, thickness: Array | float, fillet_radius: Array | float
) -> Array:
    """Integral of the wall's first ring, thickened inwards by the fillet in the corner [1/m³].

    Equation: I = ∫ dz/((r_m − a/2)³ (Δ + a)), z from 0 to R, a = R (1 − cos p), z = R (1 − sin p)
    Arguments: mean_radius r_m, thickness Δ and fillet_radius R [m], of any one shape.
    Valid: R up to the radius of the bore; error below 1e-9 up to R = 3Δ and below 1e-6 up to R = 20Δ, by seven
        points and weights fitted to integrands 1/((r_m − a/2)³ (Δ + a)) of this range.
    Source: the meridian integral; the middle of the wall moves inwards by half of what the fillet adds.

    >>> f"{junction_fillet_integral(0.0808, 0.0016, 0.0035):.6e}"
    '3.119550e+03'
    """
    total: Array | float = 0.0
    for rise, weight in _JUNCTION_RULE:
        added = fillet_radius * rise
        diameter = 2 * mean_radius - added
        total = total + weight / (diameter * diameter * diameter * (thickness + added))
    return np.asarray(total * fillet_radius)


def rim_integral(
    length: Array | float,
    mean_radius: Array | float,
    wall_thickness: Array | float,
    rim_thickness: Array | float,
) -> Array:
    """Integral of the tooth rim, which replaces as much of the wall [1/m³].

    Equation: I = b / ((r_m − Δ/2 + t_r/2)³ t_r)
    Arguments: length b, mean_radius r_m and wall_thickness Δ of the wall, rim_thickness t_r [m].
    Valid: rim over the same bore as the wall, teeth counted as part of an even thickness.
    Source: the meridian integral.

    >>> float(rim_integral(0.02, 0.08, 0.0016, 0.0016)) == float(wall_integral(0.02, 0.08, 0.0016))
    True
    """
    return wall_integral(length, mean_radius + (rim_thickness - wall_thickness) * 0.5, rim_thickness)
