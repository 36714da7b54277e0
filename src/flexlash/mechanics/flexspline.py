"""The flexspline as an ordered list of segments, from the open end to the clamped hub or bolt circle."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from flexlash.mechanics import fillets, windup
from flexlash.mechanics.elementary import power
from flexlash.mechanics.tapered_disk import tapered_disk_integral
from flexlash.schema.arrays import Array, Quantity

__all__ = [
    "CYLINDER_SEGMENTS",
    "DISK_SEGMENTS",
    "Dimensions",
    "backlash",
    "disk_radii",
    "disk_thickness",
    "modulus_of",
    "power_law_thickness",
    "radius_of",
    "tapered_thickness",
    "thickness_slope",
    "windups",
]

CYLINDER_SEGMENTS = ("tooth_band", "rim", "wall", "junction_fillet")
DISK_SEGMENTS = ("disk_body", "hub_fillet")

Dimensions = Mapping[str, Quantity]
"""The dimensions of flexsplines in SI, by name."""


def radius_of(dimensions: Dimensions) -> Quantity:
    """Mean radius of the wall [m], as given or from bore and wall.

    Equation: r_m as given, else d/2 + Δ/2
    Arguments: dimensions in SI by name, with mean_radius, or bore_diameter and wall_thickness, of any one shape.
    Valid: any tube.
    Source: geometry.

    >>> round(float(radius_of({"bore_diameter": 0.160, "wall_thickness": 0.0016})), 9)
    0.0808
    """
    if "mean_radius" in dimensions:
        return dimensions["mean_radius"]
    return windup.mean_radius_from_bore(dimensions["bore_diameter"], dimensions["wall_thickness"])


def modulus_of(dimensions: Dimensions) -> Quantity:
    """Shear modulus [Pa], as given or from Young's modulus and Poisson's ratio.

    Equation: G as given, else E / (2 (1 + ν))
    Arguments: dimensions in SI by name, with shear_modulus, or youngs_modulus and poisson_ratio, of any one shape.
    Valid: isotropic linear elasticity.
    Source: elasticity theory.

    >>> float(modulus_of({"shear_modulus": 8.1e10}))
    81000000000.0
    """
    if "shear_modulus" in dimensions:
        return dimensions["shear_modulus"]
    return windup.shear_modulus(dimensions["youngs_modulus"], dimensions["poisson_ratio"])


def disk_radii(dimensions: Dimensions) -> tuple[Quantity, Quantity]:
    """Inner and outer radius of the disk or flange [m]; a blank one is the mean radius.

    Equation: r_ci and r_co as given, else r_m
    Arguments: dimensions in SI by name as for `windups`.
    Valid: cups and hats.
    Source: geometry.

    >>> inner, outer = disk_radii({"mean_radius": 0.08, "disk_inner_radius": 0.04})
    >>> float(inner), float(outer)
    (0.04, 0.08)
    """
    mean_radius = radius_of(dimensions)
    return dimensions.get("disk_inner_radius", mean_radius), dimensions.get("disk_outer_radius", mean_radius)


def disk_thickness(dimensions: Dimensions, radius: Quantity) -> Quantity:
    """Thickness of the disk itself at a radius, normal to it and without fillets [m].

    Equation: t; or a straight line from t_h at r_ci to t at r_co; or t_h (r_ci/r)^n
    Arguments: dimensions in SI by name as for `windups`; radius [m], of any one shape with them.
    Valid: r_ci ≤ r ≤ r_co.
    Source: geometry.

    >>> tapered = {"wall_thickness": 0.0016, "mean_radius": 0.08, "disk_inner_radius": 0.04,
    ...            "disk_hub_thickness": 0.004}
    >>> round(float(disk_thickness(tapered, 0.06)), 9)
    0.0028
    """
    return _disk_profile(dimensions)(radius)


def _disk_profile(dimensions: Dimensions) -> Callable[[Quantity], Quantity]:
    """Return the thickness of the disk itself as a function of the radius."""
    even = dimensions.get("disk_thickness", dimensions["wall_thickness"])
    if "disk_hub_thickness" not in dimensions:
        return lambda _: even
    hub_thickness, (inner, outer) = dimensions["disk_hub_thickness"], disk_radii(dimensions)
    if "disk_thickness_exponent" in dimensions:
        exponent = dimensions["disk_thickness_exponent"]
        return lambda radius: power_law_thickness(radius, inner, hub_thickness, exponent)
    slope = thickness_slope(inner, outer, hub_thickness, even)
    return lambda radius: tapered_thickness(radius, inner, hub_thickness, slope)


def thickness_slope(inner_radius: Quantity, outer_radius: Quantity, hub: Quantity, edge: Quantity) -> Quantity:
    """Change of thickness per radius of a disk that thins in a straight line [-].

    Equation: k = (t − t_h) / (r_co − r_ci)
    Arguments: inner_radius r_ci and outer_radius r_co, thickness t_h at the hub, t at the edge [m], of any one shape.
    Valid: r_ci < r_co.
    Source: geometry.

    >>> thickness_slope(40.0, 80.0, 4.0, 2.0)
    -0.05
    """
    return (edge - hub) / (outer_radius - inner_radius)


def tapered_thickness(radius: Quantity, inner_radius: Quantity, hub: Quantity, slope: Quantity) -> Quantity:
    """Thickness at a radius of a disk that thins in a straight line [m].

    Equation: t(r) = t_h + k (r − r_ci)
    Arguments: radius r, inner_radius r_ci and thickness t_h at the hub [m], slope k [-], of any one shape.
    Valid: r_ci ≤ r ≤ r_co.
    Source: geometry.

    >>> tapered_thickness(60.0, 40.0, 4.0, -0.05)
    3.0
    """
    return hub + slope * (radius - inner_radius)


def power_law_thickness(radius: Quantity, inner_radius: Quantity, hub: Quantity, exponent: Quantity) -> Quantity:
    """Thickness at a radius of a disk that thins with a power of it [m].

    Equation: t(r) = t_h / (r/r_ci)^n
    Arguments: radius r, inner_radius r_ci and thickness t_h at the hub [m], exponent n [-], of any one shape.
    Valid: r_ci ≤ r ≤ r_co.
    Source: geometry.

    >>> float(power_law_thickness(80.0, 40.0, 4.0, 2.0))
    1.0
    """
    # Of a growth, since a decay would lose the digits of a disk that thins to nothing.
    return hub / power(radius / inner_radius, exponent)


def _cylinder_integrals(dimensions: Dimensions, mean_radius: Quantity) -> dict[str, Quantity]:
    """Integrals of tooth band, rim, plain wall and junction fillet [1/m³]."""
    thickness = dimensions["wall_thickness"]
    plain = dimensions["cylinder_length"]
    rim_length, rim_thickness = dimensions.get("rim_length", 0.0), dimensions.get("rim_thickness", thickness)
    on_rim: Quantity = 0.0
    integrals = {}
    if "tooth_face_width" in dimensions:
        face_width = dimensions["tooth_face_width"]
        on_rim = windup.face_on_rim(face_width, rim_length)
        band = (face_width, on_rim, mean_radius, thickness, rim_thickness)
        integrals["tooth_band"] = windup.tooth_band_integral(*band)
        plain = plain - (face_width - on_rim)
    if "rim_length" in dimensions:
        integrals["rim"] = windup.rim_integral(rim_length - on_rim, mean_radius, thickness, rim_thickness)
        plain = plain - rim_length
    if "junction_fillet_radius" in dimensions:
        fillet = dimensions["junction_fillet_radius"]
        integrals["junction_fillet"] = fillets.junction_fillet_integral(mean_radius, thickness, fillet)
        plain = plain - fillet
    return integrals | {"wall": windup.wall_integral(plain, mean_radius, thickness)}


def _disk_integrals(dimensions: Dimensions) -> dict[str, Quantity]:
    """Integrals of disk or flange and of the hub fillet [1/m³]; blanks are the same dimension elsewhere."""
    inner, outer = disk_radii(dimensions)
    integrals = {}
    start = inner
    thickness_at = _disk_profile(dimensions)
    if "hub_fillet_radius" in dimensions:
        fillet = dimensions["hub_fillet_radius"]
        integrals["hub_fillet"] = fillets.hub_fillet_integral(inner, fillet, thickness_at)
        start = inner + fillet
    if "disk_thickness_exponent" in dimensions:
        exponent = dimensions["disk_thickness_exponent"]
        body = windup.power_law_disk_integral(start, outer, thickness_at(start), exponent)
    elif "disk_hub_thickness" in dimensions:
        thickness = dimensions.get("disk_thickness", dimensions["wall_thickness"])
        body = tapered_disk_integral(start, outer, thickness_at(start), thickness)
    else:
        body = windup.annulus_integral(start, outer, thickness_at(start))
    if "disk_cone_angle" in dimensions:
        body = windup.cone_integral(body, dimensions["disk_cone_angle"])
    return integrals | {"disk_body": body}


def windups(flexspline_type: str, dimensions: Dimensions) -> dict[str, Quantity]:
    """Wind-up of each segment that the flexspline has [rad].

    Equation: U_i = c_i T/(2πG) · I_i, with c the calibration of cylinder or disk, 1 unless given
    Arguments: flexspline_type `cup`, `hat` or `cylinder`; dimensions in SI by name, of any one shape
        (variants,) or (variants, draws). A blank disk thickness is the wall's, a blank disk radius the mean
        radius: the same array, so the same random variable.
    Valid: axisymmetric load, at the open end or, with a tooth face width, over that; hub fillet within the disk, rim,
        tooth face and junction fillet within the cylinder.
    Source: the meridian integral; without refinements it is the two-term formula of the B3-160 article.

    >>> b3_160 = {"torque": 800.0, "cylinder_length": 0.16, "mean_radius": 0.08, "wall_thickness": 0.0016,
    ...           "disk_inner_radius": 0.04, "youngs_modulus": 211e9, "poisson_ratio": 0.3}
    >>> {segment: f"{angle:.7e}" for segment, angle in windups("cup", b3_160).items()}
    {'wall': '3.0642984e-04', 'disk_body': '2.2982238e-04'}
    """
    mean_radius = radius_of(dimensions)
    integrals = _cylinder_integrals(dimensions, mean_radius)
    if flexspline_type != "cylinder":
        integrals |= _disk_integrals(dimensions)
    torque, modulus = dimensions["torque"], modulus_of(dimensions)
    calibration = {
        segment: dimensions.get("cylinder_calibration" if segment in CYLINDER_SEGMENTS else "disk_calibration", 1.0)
        for segment in integrals
    }
    return {
        segment: windup.segment_windup(torque, modulus, integrals[segment]) * calibration[segment]
        for segment in (*CYLINDER_SEGMENTS, *DISK_SEGMENTS)
        if segment in integrals
    }


def backlash(flexspline_type: str, dimensions: Dimensions) -> Array:
    """Backlash from torsional deformation: the lag of the output when the torque reverses [rad].

    Equation: 2U = 2 Σ U_i
    Arguments: as for `windups`.
    Valid: as for `windups`; clearances and hysteresis come on top.
    Source: B3-160 article.

    >>> b3_160 = {"torque": 800.0, "cylinder_length": 0.16, "mean_radius": 0.08, "wall_thickness": 0.0016,
    ...           "disk_inner_radius": 0.04, "youngs_modulus": 211e9, "poisson_ratio": 0.3}
    >>> f"{backlash('cup', b3_160):.10e}"
    '1.0725044299e-03'
    """
    first, *others = windups(flexspline_type, dimensions).values()
    total = first
    for angle in others:
        total = total + angle
    return np.asarray(2 * total)
