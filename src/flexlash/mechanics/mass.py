"""The mass of a flexspline: what its segments weigh."""

from __future__ import annotations

import numpy as np

from flexlash.mechanics.elementary import box_cox, sin
from flexlash.mechanics.flexspline import Dimensions, disk_radii, disk_thickness, radius_of
from flexlash.mechanics.windup import rim_radius
from flexlash.schema.arrays import Array, Quantity

__all__ = ["fillet_volume", "mass", "ring_volume"]

_CORNER = 1 - np.pi / 4
"""Area of a fillet between two walls at right angles, beside the square of its radius."""

_CENTROID = (10 - 3 * np.pi) / (12 - 3 * np.pi)
"""Distance of the centroid of that area from either wall, beside the radius."""


def mass(flexspline_type: str, dimensions: Dimensions, density: Quantity) -> Array:
    """Mass of wall, tooth rim, disk or flange, and fillets [kg].

    Equation: m = ρ V, V = 2π ∫ r t ds along the meridian, fillets beside it: 2π r_m Δ (l − b) + 2π r_b t_b b
        + 2π ∫ r t dr / sin a + fillets
    Arguments: flexspline_type `cup`, `hat` or `cylinder`; dimensions in SI by name as for `flexspline.windups`;
        density ρ [kg/m³], of any one shape.
    Valid: thin walls; l is the inside depth and the disk reaches r_co. Hub, bolts and what teeth stand out above the
        rim's thickness are not counted.
    Source: geometry (Pappus).

    >>> b3_160 = {"cylinder_length": 0.2, "mean_radius": 0.08, "wall_thickness": 0.0016, "disk_inner_radius": 0.04}
    >>> f"{mass('cup', b3_160, 7850.0):.3f}"
    '1.452'
    """
    radius, wall = radius_of(dimensions), dimensions["wall_thickness"]
    rim_length, rim = dimensions.get("rim_length", 0.0), dimensions.get("rim_thickness", wall)
    volume = ring_volume(radius, wall, dimensions["cylinder_length"] - rim_length)
    volume = volume + ring_volume(rim_radius(radius, wall, rim), rim, rim_length)
    if flexspline_type != "cylinder":
        volume = volume + _disk_volume(dimensions)
    if "junction_fillet_radius" in dimensions:
        fillet = dimensions["junction_fillet_radius"]
        volume = volume + fillet_volume(radius - wall / 2, -fillet)
    if "hub_fillet_radius" in dimensions:
        volume = volume + fillet_volume(disk_radii(dimensions)[0], dimensions["hub_fillet_radius"])
    return np.asarray(density * volume)


def ring_volume(radius: Quantity, thickness: Quantity, length: Quantity) -> Quantity:
    """Volume of a cylindrical wall [m³].

    Equation: V = 2π r t l
    Arguments: radius r of the middle of the wall, its thickness t and length l [m], of any one shape.
    Valid: any tube; it is exact.
    Source: geometry (Pappus).

    >>> f"{ring_volume(0.08, 0.0016, 0.2):.5e}"
    '1.60850e-04'
    """
    return 2 * np.pi * radius * thickness * length


def fillet_volume(wall_radius: Quantity, fillet: Quantity) -> Quantity:
    """Volume of a fillet between a disk and a wall that stands on it [m³].

    Equation: V = 2π (r + c R) R² (1 − π/4), c = (10 − 3π)/(12 − 3π)
    Arguments: wall_radius r of the wall's face and fillet radius R [m], negative for a fillet inside the wall, of any
        one shape.
    Valid: right angles; R up to the radius of the wall.
    Source: geometry (Pappus): area and centroid of what a circle leaves of the square around its quarter.

    >>> f"{fillet_volume(0.04, 0.0035):.4e} {fillet_volume(0.08, -0.0035):.4e}"
    '6.7362e-07 1.3085e-06'
    """
    return 2 * np.pi * (wall_radius + _CENTROID * fillet) * fillet * fillet * _CORNER


def _disk_volume(dimensions: Dimensions) -> Quantity:
    """Return the volume of the disk or flange without fillets [m³]."""
    inner, outer = disk_radii(dimensions)
    if "disk_thickness_exponent" in dimensions:
        # ∫ r t dr with t = t_i (r_i/r)^n
        reach = box_cox(outer / inner, 2.0 - dimensions["disk_thickness_exponent"])
        moment: Quantity = dimensions["disk_hub_thickness"] * inner * inner * reach
    else:
        # r t is at most quadratic: Simpson's rule is exact.
        ends = [radius * disk_thickness(dimensions, radius) for radius in (inner, (inner + outer) / 2, outer)]
        moment = (outer - inner) / 6 * (ends[0] + 4 * ends[1] + ends[2])
    if "disk_cone_angle" in dimensions:
        moment = moment / sin(dimensions["disk_cone_angle"])
    return 2 * np.pi * moment
