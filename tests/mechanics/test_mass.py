"""The mass of flexsplines against bodies of revolution that are integrated point by point."""

import math

import numpy as np
import pytest
from flexsplines import SHAPES, without
from grids import for_each

from flexlash.mechanics.flexspline import disk_radii, disk_thickness, radius_of
from flexlash.mechanics.mass import mass

STEPS = 20_001


def middle_sum(function, low, high):
    """Return the integral of a function by the midpoint rule."""
    width = (high - low) / STEPS
    return sum(function(low + (step + 0.5) * width) for step in range(STEPS)) * width


def corner(radius, fillet, into):
    """Return the volume of a fillet in a corner at a radius, that grows inwards (−1) or outwards (1)."""

    def height(across):
        return fillet - math.sqrt(fillet**2 - (fillet - across) ** 2)

    return middle_sum(lambda across: 2 * math.pi * (radius + into * across) * height(across), 0, fillet)


def volume(kind, sizes):
    """Return the volume of a flexspline, ring by ring."""
    radius, wall, length = radius_of(sizes), sizes["wall_thickness"], sizes["cylinder_length"]
    bore, rim = radius - wall / 2, sizes.get("rim_length", 0)
    total = math.pi * ((bore + wall) ** 2 - bore**2) * (length - rim)
    if rim:
        total += math.pi * ((bore + sizes["rim_thickness"]) ** 2 - bore**2) * rim
    if kind != "cylinder":
        slant = math.sin(sizes.get("disk_cone_angle", math.pi / 2))
        inner, outer = disk_radii(sizes)
        total += (
            middle_sum(lambda place: 2 * math.pi * place * float(disk_thickness(sizes, place)), inner, outer) / slant
        )
    if "hub_fillet_radius" in sizes:
        total += corner(sizes["disk_inner_radius"], sizes["hub_fillet_radius"], 1)
    if "junction_fillet_radius" in sizes:
        total += corner(bore, sizes["junction_fillet_radius"], -1)
    return total


@pytest.mark.slow
@for_each("shape", SHAPES)
def test_mass_is_that_of_the_rings(shape):
    """Every shape weighs what its rings and fillets weigh that are added up one by one."""
    kind, sizes = SHAPES[shape]
    assert float(mass(kind, sizes, 7850.0)) == pytest.approx(7850 * volume(kind, sizes), rel=1e-6)


def test_many_masses_are_those_of_each():
    """Arrays of dimensions give each flexspline's own mass, to the bit."""
    for kind, sizes in SHAPES.values():
        many = {name: np.full(5, size) for name, size in sizes.items()}
        assert mass(kind, many, 7850.0).tolist() == [float(mass(kind, sizes, 7850.0))] * 5


def test_a_longer_wall_weighs_what_is_added():
    """B3-160: 38.5 mm less of its wall take 16.7 % of 1.452 kg; without the disk 1.263 kg stay."""
    sizes = without(SHAPES["cup"][1], "cylinder_length")
    full, short = (float(mass("cup", sizes | {"cylinder_length": one}, 7850.0)) for one in (0.2, 0.1615))
    assert f"{full:.3f} {100 * (short / full - 1):.1f}" == "1.452 -16.7"
    assert f"{float(mass('cylinder', sizes | {'cylinder_length': 0.2}, 7850.0)):.3f}" == "1.263"
