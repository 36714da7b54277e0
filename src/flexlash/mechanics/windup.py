"""One integral for every shape: the wind-up of a thin shell of revolution under torque.

A meridian of arc length s, radius r and thickness t winds up by U = T/(2πG) · ∫ ds/(r³ t). Each integral
below is one segment's share [1/m³]; `segment_windup` turns it into an angle. A disk that thins in a straight line is
worked in `tapered_disk`, fillets in `fillets`.
"""

from __future__ import annotations

import numpy as np

from flexlash.mechanics.elementary import box_cox, minimum, sin
from flexlash.schema.arrays import Quantity

__all__ = [
    "annulus_integral",
    "cone_integral",
    "face_on_rim",
    "growth_integral",
    "mean_radius_from_bore",
    "power_law_disk_integral",
    "power_law_growth",
    "rim_integral",
    "rim_radius",
    "segment_windup",
    "shear_modulus",
    "tooth_band_integral",
    "torque_over_modulus",
    "wall_integral",
]


def shear_modulus(youngs_modulus: Quantity, poisson_ratio: Quantity) -> Quantity:
    """Shear modulus of an isotropic material [Pa].

    Equation: G = E / (2 (1 + ν))
    Arguments: youngs_modulus E [Pa] and poisson_ratio ν [-], of any one shape.
    Valid: isotropic linear elasticity, 0 ≤ ν ≤ 0.5.
    Source: elasticity theory; the B3-160 article prints 8.10769e10 for what is 8.11538e10.

    >>> round(float(shear_modulus(211e9, 0.3)))
    81153846154
    """
    return youngs_modulus / (2 * (1 + poisson_ratio))


def mean_radius_from_bore(bore_diameter: Quantity, wall_thickness: Quantity) -> Quantity:
    """Radius of the middle of the wall [m].

    Equation: r_m = d/2 + Δ/2
    Arguments: bore_diameter d [m] and wall_thickness Δ [m], of any one shape.
    Valid: any tube.
    Source: geometry.

    >>> round(float(mean_radius_from_bore(0.160, 0.0016)), 9)
    0.0808
    """
    return (bore_diameter + wall_thickness) * 0.5


def rim_radius(mean_radius: Quantity, wall_thickness: Quantity, rim_thickness: Quantity) -> Quantity:
    """Radius of the middle of the tooth rim, which has the bore of the wall [m].

    Equation: r_b = r_m + (t_b − Δ)/2
    Arguments: mean_radius r_m and wall_thickness Δ of the wall, rim_thickness t_b [m], of any one shape.
    Valid: teeth counted as part of an even thickness.
    Source: geometry.

    >>> round(rim_radius(0.08, 0.0016, 0.0032), 9)
    0.0808
    """
    return mean_radius + (rim_thickness - wall_thickness) * 0.5


def torque_over_modulus(torque: Quantity, modulus: Quantity) -> Quantity:
    """Wind-up of a meridian per unit of its integral [m³].

    Equation: T/(2πG)
    Arguments: torque T [N·m] and shear modulus G [Pa], of any one shape.
    Valid: linear elasticity, torque carried by shear around the axis alone.
    Source: thin shells of revolution in torsion.

    >>> f"{torque_over_modulus(800.0, 8.1153846153846e10):.6e}"
    '1.568921e-09'
    """
    return torque / (2 * np.pi * modulus)


def segment_windup(torque: Quantity, modulus: Quantity, integral: Quantity) -> Quantity:
    """Wind-up angle of a segment [rad].

    Equation: U = T/(2πG) · I
    Arguments: torque T [N·m], shear modulus G [Pa] and the segment's integral I [1/m³], of any one shape.
    Valid: linear elasticity, torque carried by shear around the axis alone.
    Source: thin shells of revolution in torsion; for a tube it is U = T l/(G J_p), J_p = 2π r_m³ Δ.

    >>> f"{segment_windup(800.0, 8.1153846153846e10, wall_integral(0.16, 0.08, 0.0016)):.10e}"
    '3.0642983711e-04'
    """
    return torque_over_modulus(torque, modulus) * integral


def wall_integral(length: Quantity, mean_radius: Quantity, thickness: Quantity) -> Quantity:
    """Integral of a plain cylindrical wall [1/m³].

    Equation: I = l / (r_m³ Δ)
    Arguments: length l, mean_radius r_m and thickness Δ [m], of any one shape.
    Valid: thin wall; low by (Δ/2r_m)², so negligible up to Δ/r_m = 0.2.
    Source: Bredt's thin tube.

    >>> float(wall_integral(1.0, 1.0, 0.5))
    2.0
    """
    return length / (mean_radius * mean_radius * mean_radius * thickness)


def annulus_integral(inner_radius: Quantity, outer_radius: Quantity, thickness: Quantity) -> Quantity:
    """Integral of a flat disk or flange of even thickness [1/m³].

    Equation: I = (1/r_i² − 1/r_o²) / (2 t)
    Arguments: inner_radius r_i, outer_radius r_o and thickness t [m], of any one shape.
    Valid: flat annulus in pure in-plane shear.
    Source: r² τ t constant and r d(u/r)/dr = τ/G; B3-160 article, disk term.

    >>> float(annulus_integral(0.5, 1.0, 1.0))
    1.5
    """
    return (1 / (inner_radius * inner_radius) - 1 / (outer_radius * outer_radius)) / (2 * thickness)


def cone_integral(flat_integral: Quantity, semi_angle: Quantity) -> Quantity:
    """Integral of a conical disk, from that of the flat disk with the same radii and thicknesses [1/m³].

    Equation: I = I_flat / sin a
    Arguments: flat_integral I_flat [1/m³] and semi_angle a [rad] between cone and axis, of any one shape.
    Valid: thin cone, 0 < a ≤ π/2, thickness measured normal to it; a = π/2 is the flat disk.
    Source: the meridian integral with ds = dr / sin a.

    >>> round(float(cone_integral(annulus_integral(0.5, 1.0, 1.0), np.pi / 6)), 12)
    3.0
    """
    return flat_integral / sin(semi_angle)


def power_law_growth(inner_radius: Quantity, outer_radius: Quantity, exponent: Quantity) -> Quantity:
    """How far a disk that thins with a power of the radius reaches, beside its thickness and radius at the hub [-].

    Equation: g = ((r_o/r_i)^(n−2) − 1)/(n − 2), ln(r_o/r_i) at n = 2
    Arguments: inner_radius r_i and outer_radius r_o [m], exponent n [-], of any one shape.
    Valid: any exponent; (x^p − 1)/p is the Box–Cox function, steady as p vanishes.
    Source: the meridian integral in closed form.

    >>> f"{power_law_growth(0.04, 0.08, 3.0):.6f} {power_law_growth(0.04, 0.08, 2.0):.6f}"
    '1.000000 0.693147'
    """
    return box_cox(outer_radius / inner_radius, exponent - 2.0)


def growth_integral(growth: Quantity, inner_radius: Quantity, inner_thickness: Quantity) -> Quantity:
    """Integral of a disk that thins with a power of the radius, from its `power_law_growth` [1/m³].

    Equation: I = g / (t_i r_i²)
    Arguments: growth g [-], inner_radius r_i and inner_thickness t_i [m], of any one shape.
    Valid: thin disk.
    Source: the meridian integral in closed form.

    >>> growth_integral(1.0, 0.5, 2.0)
    2.0
    """
    return growth / (inner_thickness * inner_radius * inner_radius)


def power_law_disk_integral(
    inner_radius: Quantity, outer_radius: Quantity, inner_thickness: Quantity, exponent: Quantity
) -> Quantity:
    """Integral of a disk that thins with a power of the radius [1/m³].

    Equation: I = ∫ dr/(r³ t), t = t_i (r_i/r)^n: ((r_o/r_i)^(n−2) − 1) / ((n − 2) t_i r_i²), ln(r_o/r_i) at n = 2
    Arguments: inner_radius r_i, outer_radius r_o, inner_thickness t_i [m], exponent n [-], of any one shape.
    Valid: thin disk; n = 2 has the same shear stress at every radius.
    Source: the meridian integral in closed form.

    >>> f"{segment_windup(800.0, 8.1153846153846e10, power_law_disk_integral(0.04, 0.08, 0.004, 2)):.9e}"
    '1.699207821e-04'
    """
    return growth_integral(power_law_growth(inner_radius, outer_radius, exponent), inner_radius, inner_thickness)


def rim_integral(
    length: Quantity,
    mean_radius: Quantity,
    wall_thickness: Quantity,
    rim_thickness: Quantity,
) -> Quantity:
    """Integral of the tooth rim, which replaces as much of the wall [1/m³].

    Equation: I = b / (r_b³ t_b), r_b as of `rim_radius`
    Arguments: length b, mean_radius r_m and wall_thickness Δ of the wall, rim_thickness t_b [m].
    Valid: rim over the same bore as the wall, teeth counted as part of an even thickness.
    Source: the meridian integral.

    >>> float(rim_integral(0.02, 0.08, 0.0016, 0.0016)) == float(wall_integral(0.02, 0.08, 0.0016))
    True
    """
    return wall_integral(length, rim_radius(mean_radius, wall_thickness, rim_thickness), rim_thickness)


def face_on_rim(face_width: Quantity, rim_length: Quantity) -> Quantity:
    """Length of the teeth's face that lies on the tooth rim [m]; the rest of it lies on the wall.

    Equation: c = min(b, l_b)
    Arguments: face_width b and rim_length l_b [m], 0 without a rim, of any one shape.
    Valid: face and rim both begin at the open end.
    Source: geometry.

    >>> float(face_on_rim(0.01, 0.02)), float(face_on_rim(0.03, 0.02)), float(face_on_rim(0.01, 0.0))
    (0.01, 0.02, 0.0)
    """
    return minimum(face_width, rim_length)


def tooth_band_integral(
    face_width: Quantity,
    on_rim: Quantity,
    mean_radius: Quantity,
    wall_thickness: Quantity,
    rim_thickness: Quantity,
) -> Quantity:
    """Integral of the band that the teeth load, which replaces as much of rim and wall [1/m³].

    Equation: I = ∫ (x/b)² dx/(r³ t) from the open end: b/3 · [s³/(r_b³ t_b) + (1 − s³)/(r_m³ Δ)], s = c/b
    Arguments: face_width b and its length on_rim c as of `face_on_rim`; mean_radius r_m and wall_thickness Δ of the
        wall, rim_thickness t_b [m], that of the wall where there is no rim; of any one shape.
    Valid: torque taken up evenly over the face width and around the axis, by a wall that is thin beside it; c ≤ b. What
        the face width changes agrees with two-dimensional elasticity to 0.3 % of the wind-up with a rim, 0.6 % without;
        the whole lies within 1.3 % with a rim and disks up to 1.5 walls, 2.5 % with disks up to five walls.
    Source: the meridian integral; at x the band carries T x/b and yields the teeth there as much of their work, so
        that it counts a third of its length.

    >>> [round(tooth_band_integral(0.3, on_rim, 1.0, 0.1, 0.1), 9) for on_rim in (0.0, 0.2, 0.3)]
    [1.0, 1.0, 1.0]
    """
    share = on_rim / face_width
    third = face_width / 3
    in_rim = third * (share * share * share)
    rim = rim_integral(in_rim, mean_radius, wall_thickness, rim_thickness)
    return rim + wall_integral(third - in_rim, mean_radius, wall_thickness)
