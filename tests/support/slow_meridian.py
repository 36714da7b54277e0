"""The wind-up of a flexspline by slow quadrature along its meridian, apart from `flexlash.mechanics`.

Radius and thickness are plain functions of the place on the meridian; adaptive quadrature adds up
U = T/(2πG) · ∫ ds/(r³ t) between the kinks. A fillet's arc rises as a square root of the distance from where it is
steep, so there the distance is a square, and the square's root is what the quadrature steps in. Near its other end the
distance is counted from there, decade by decade, since a thin wall may be all that is left.
"""

import math
from itertools import pairwise

from scipy.integrate import quad

__all__ = ["slow_windup"]

_DECADES = 12
"""How near to the thin end of a fillet the decades go, as a power of ten of its radius."""


def _arc(fillet, back):
    """Return what a fillet adds to the thickness [m] at a distance [m] from where it ends on the thin side."""
    return back * back / (fillet + math.sqrt(fillet * fillet - back * back)) if back > 0 else 0.0


def _integral(integrand, start, end):
    """Return an integral over a smooth stretch; an empty one is 0."""
    return quad(integrand, start, end, epsabs=0, epsrel=1e-12, limit=500)[0] if end > start else 0.0


def _fillet_integral(integrand, fillet):
    """Return the integral over a fillet of a function of the distances [m] from its steep end and from its thin one."""
    steep = _integral(lambda root: 2 * root * integrand(root * root, fillet - root * root), 0.0, math.sqrt(fillet / 2))
    ends = [0.0] + [fillet / 2 * 10.0**-decade for decade in range(_DECADES, -1, -1)]
    return steep + sum(
        _integral(lambda back: integrand(fillet - back, back), start, end) for start, end in pairwise(ends)
    )


def _mean_radius(dimensions):
    """Return the radius of the middle of the wall [m]."""
    if "mean_radius" in dimensions:
        return dimensions["mean_radius"]
    return dimensions["bore_diameter"] / 2 + dimensions["wall_thickness"] / 2


def _shear_modulus(dimensions):
    """Return the shear modulus [Pa]."""
    if "shear_modulus" in dimensions:
        return dimensions["shear_modulus"]
    return dimensions["youngs_modulus"] / (2 * (1 + dimensions["poisson_ratio"]))


def _cylinder(dimensions):
    """Return ∫ dz/(r³ t) [1/m³] from the inner face of the disk to the open end."""
    wall, length = dimensions["wall_thickness"], dimensions["cylinder_length"]
    mean = _mean_radius(dimensions)
    fillet = dimensions.get("junction_fillet_radius", 0.0)
    rim = dimensions.get("rim_thickness", wall)
    rim_start = length - dimensions.get("rim_length", 0.0)

    face = dimensions.get("tooth_face_width", 0.0)

    def transmitted(height):
        # What a place passes on of the torque, and of the work of the teeth there.
        return min(1.0, (length - height) / face) ** 2 if face else 1.0

    def in_wall(_, back):
        added = _arc(fillet, back)
        return 1 / ((mean - added / 2) ** 3 * (wall + added))

    def in_rim():
        return 1 / ((mean - wall / 2 + rim / 2) ** 3 * rim)

    def loaded(height):
        return transmitted(height) * (in_rim() if height > rim_start else in_wall(height, 0.0))

    places = sorted({fillet, rim_start, length - face, length})
    return _fillet_integral(in_wall, fillet) + sum(
        _integral(loaded, start, end) for start, end in pairwise(places) if start >= fillet
    )


def _disk(dimensions):
    """Return ∫ ds/(r³ t) [1/m³] over the disk of a cup or the flange of a hat."""
    mean = _mean_radius(dimensions)
    inner, outer = dimensions.get("disk_inner_radius", mean), dimensions.get("disk_outer_radius", mean)
    fillet = dimensions.get("hub_fillet_radius", 0.0)

    def thickness(distance):
        if "disk_thickness_exponent" in dimensions:
            exponent = dimensions["disk_thickness_exponent"]
            return dimensions["disk_hub_thickness"] * (inner / (inner + distance)) ** exponent
        last = dimensions.get("disk_thickness", dimensions["wall_thickness"])
        first = dimensions.get("disk_hub_thickness", last)
        return first + (last - first) * (distance / (outer - inner))

    def in_disk(distance, back):
        return 1 / ((inner + distance) ** 3 * (thickness(distance) + _arc(fillet, back)))

    flat = _fillet_integral(in_disk, fillet) + _integral(lambda place: in_disk(place, 0.0), fillet, outer - inner)
    return flat / math.sin(dimensions.get("disk_cone_angle", math.pi / 2))


def slow_windup(flexspline_type, dimensions):
    """Return the wind-up [rad] of a flexspline as `cylinder`, `disk` and `total`.

    Dimensions are scalars in SI by the names of `flexlash.mechanics.flexspline.windups`; a blank disk thickness is
    the wall's, a blank disk radius the mean radius. With `disk_thickness_exponent` n the disk has the thickness
    t_h (r_ci/r)^n; with `disk_cone_angle` a between disk and axis its meridian is 1/sin a as long.
    """
    scale = dimensions["torque"] / (2 * math.pi * _shear_modulus(dimensions))
    cylinder = scale * _cylinder(dimensions) * dimensions.get("cylinder_calibration", 1.0)
    disk = 0.0
    if flexspline_type != "cylinder":
        disk = scale * _disk(dimensions) * dimensions.get("disk_calibration", 1.0)
    return {"cylinder": cylinder, "disk": disk, "total": cylinder + disk}
