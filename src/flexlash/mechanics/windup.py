"""One integral for every shape: the wind-up of a thin shell of revolution under torque.

A meridian of arc length s, radius r and thickness t winds up by U = T/(2πG) · ∫ ds/(r³ t). Each function
below is one segment's share of the integral [1/m³]; `segment_windup` turns it into an angle.
"""

from __future__ import annotations

import numpy as np
from scipy.special import boxcox, sindg

from flexlash.schema.arrays import Array

__all__ = [
    "NEARLY",
    "TAPER_PLACES",
    "TAPER_WEIGHTS",
    "annulus_integral",
    "cone_integral",
    "mean_radius_from_bore",
    "power_law_disk_integral",
    "rim_integral",
    "segment_windup",
    "shear_modulus",
    "tapered_disk_integral",
    "wall_integral",
]

NEARLY = 0.5
"""Relative change of t/r over a disk below which its thickness counts as nearly proportional to the radius."""

_TAPER_NODES, _TAPER_SHARES = np.polynomial.legendre.leggauss(10)
TAPER_PLACES, TAPER_WEIGHTS = (_TAPER_NODES + 1) / 2, _TAPER_SHARES / 2


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
        cancels, ten Gauss–Legendre points of ∫ v² dv/(a v + b) take its place.
    Source: the meridian integral in closed form.

    >>> f"{segment_windup(800.0, 8.1153846153846e10, tapered_disk_integral(0.04, 0.08, 0.004, 0.0016)):.10e}"
    '1.2086009619e-04'
    """
    low, high = 1 / np.asarray(outer_radius), 1 / np.asarray(inner_radius)
    reach = high - low
    start, end = low * outer_thickness, high * inner_thickness
    growth = end - start
    proportional = np.abs(growth) < NEARLY * start
    axis_thickness = np.where(proportional, 1.0, growth / np.where(reach == 0, 1.0, reach))
    slope = (inner_thickness - axis_thickness) / (inner_radius * axis_thickness)
    # The logarithm of SciPy, since NumPy's may round otherwise at another place of an array.
    closed = (reach * ((high + low) / 2 - slope) + slope * slope * boxcox(end / start, 0.0)) / axis_thickness
    total: Array | float = 0.0
    for place, weight in zip(TAPER_PLACES, TAPER_WEIGHTS, strict=True):
        curvature = low + reach * place
        total = total + weight * (curvature * curvature) / (start + growth * place)
    return np.asarray(np.where(proportional, total * reach, closed))


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
