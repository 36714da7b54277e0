"""Shear stresses against a slow search, and the von Mises stress of pure shear."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.mechanics import strength

thorough = settings(deadline=None, max_examples=60, derandomize=True)


EVEN = {
    "torque": 800.0,
    "inner_radius": 0.040,
    "outer_radius": 0.080,
    "hub_thickness": 0.0016,
    "thickness": 0.0016,
    "fillet_radius": 0.0,
}


@st.composite
def disks(draw):
    """Draw a disk under torque, tapered, with or without a hub fillet, in SI."""
    inner = draw(st.floats(0.005, 0.1))
    width = inner * draw(st.floats(0.1, 3.0))
    hub = inner * draw(st.floats(0.01, 0.2))
    thickness = hub * draw(st.floats(0.1, 3.0))
    fillet = draw(st.just(0.0) | st.floats(0.01, 1.0)) * min(width, 4 * min(hub, thickness))
    return {
        "torque": draw(st.floats(1.0, 5000.0)),
        "inner_radius": inner,
        "outer_radius": inner + width,
        "hub_thickness": hub,
        "thickness": thickness,
        "fillet_radius": fillet,
    }


def slow_hub_shear(torque, inner_radius, outer_radius, hub_thickness, thickness, fillet_radius):  # noqa: PLR0917
    """Return the greatest shear stress over a hundred thousand radii, arc written as in the drawing."""
    width, fillet = outer_radius - inner_radius, fillet_radius
    advance = np.concatenate([np.linspace(0, width, 100_001), fillet * np.linspace(0, 1, 20_001) ** 3])
    inside = np.clip(fillet - advance, 0, None)
    arc = np.where(advance < fillet, fillet - np.sqrt(np.clip(fillet**2 - inside**2, 0, None)), 0.0)
    local = hub_thickness + (thickness - hub_thickness) * advance / width + arc
    return float((torque / (2 * math.pi * (inner_radius + advance) ** 2 * local)).max())


@pytest.mark.parametrize(
    ("radius", "expected"),
    [(0.080, 12.434), (0.040, 49.736)],
)
def test_published_case(radius, expected):
    """B3-160 at 800 N·m has 12.434 MPa in the wall and 49.736 MPa at the hub."""
    assert strength.shear_stress(800.0, radius, 0.0016) / 1e6 == pytest.approx(expected, abs=5e-4)


def test_von_mises_of_the_published_case():
    """The hub's shear stress of B3-160 is a von Mises stress of 86.145 MPa."""
    shear = strength.hub_shear(**EVEN)
    assert strength.von_mises_stress(shear) / 1e6 == pytest.approx(86.145, abs=5e-4)


@thorough
@given(torque=st.floats(0.1, 1e4), radius=st.floats(0.005, 0.2), thickness=st.floats(1e-4, 1e-2))
def test_shear_carries_the_torque(torque, radius, thickness):
    """The shear stress times the ring's area times its radius is the torque."""
    stress = strength.shear_stress(torque, radius, thickness)
    assert stress * (2 * math.pi * radius * thickness) * radius == pytest.approx(torque, rel=1e-14)


@thorough
@given(shear=st.floats(0, 1e10))
def test_von_mises_is_root_three_times_the_shear(shear):
    """In pure shear the von Mises stress squared is three times the shear stress squared."""
    assert strength.von_mises_stress(shear) ** 2 == pytest.approx(3 * shear**2, rel=1e-14)


@thorough
@given(disk=disks())
def test_hub_shear_against_a_slow_search(disk):
    """The greatest shear stress in a tapered, filleted disk is that of a slow search, low by less than 1e-5."""
    found, exact = float(strength.hub_shear(**disk)), slow_hub_shear(**disk)
    assert found == pytest.approx(exact, rel=1e-5)
    assert found <= exact * (1 + 1e-6)


@pytest.mark.parametrize("multiple", [1, 3, 5, 10, 20, 100])
def test_hub_shear_has_the_stated_error(multiple):
    """The search is low by less than 1e-5, as its docstring says, for a fillet of any multiple of the thickness."""
    fillet = multiple * 0.0016
    for inner in (0.010, 0.040, 0.120):
        disk = EVEN | {"inner_radius": inner, "outer_radius": inner + max(0.04, fillet), "fillet_radius": fillet}
        assert float(strength.hub_shear(**disk)) >= slow_hub_shear(**disk) * (1 - 1e-5)


@thorough
@given(disk=disks(), factor=st.floats(1.0, 2.0))
def test_thicker_disk_is_never_stressed_more(disk, factor):
    """A disk thicker throughout is never stressed more; more torque stresses it in proportion."""
    stress = strength.hub_shear(**disk)
    thicker = {name: disk[name] * factor for name in ("hub_thickness", "thickness")}
    assert strength.hub_shear(**disk | thicker) <= stress * (1 + 1e-5)
    assert strength.hub_shear(**disk | {"torque": 2 * disk["torque"]}) == 2 * stress


def test_even_disk_governs_at_the_hub():
    """An even disk without fillet has its greatest shear stress at the hub radius."""
    even = strength.hub_shear(**EVEN)
    assert even == pytest.approx(float(strength.shear_stress(800.0, 0.04, 0.0016)), rel=1e-15)


def test_thin_edge_can_govern():
    """A disk that thins strongly towards the cylinder has its greatest shear stress there, not at the hub."""
    found = strength.hub_shear(**EVEN | {"hub_thickness": 0.008, "thickness": 0.0005})
    assert found == pytest.approx(float(strength.shear_stress(800.0, 0.08, 0.0005)), rel=1e-12)


def test_hub_fillet_relieves_the_hub():
    """A hub fillet of 3.5 mm moves the greatest shear stress of B3-160 outwards and lowers it."""
    even = strength.hub_shear(**EVEN)
    relieved = strength.hub_shear(**EVEN | {"fillet_radius": 0.0035})
    assert strength.shear_stress(800.0, 0.0435, 0.0016) * 0.999 < relieved < even


def test_fillet_across_the_whole_disk():
    """A fillet as wide as the disk, or by rounding a little wider, is searched up to the disk's rim."""
    disk = EVEN | {"outer_radius": 0.05, "fillet_radius": 0.01}
    whole = strength.hub_shear(**disk)
    assert whole == pytest.approx(slow_hub_shear(**disk), rel=1e-5)
    wider = strength.hub_shear(**disk | {"fillet_radius": 0.01 * (1 + 1e-12)})
    assert wider == pytest.approx(float(whole), rel=1e-9)


def test_arrays_equal_scalars_bit_for_bit():
    """Stresses of shape (variants,) equal scalar calls bit for bit."""
    generator = np.random.default_rng(3)
    sizes = EVEN | {"hub_thickness": 0.003, "fillet_radius": 0.0035}
    table = {name: size * (1 + 0.05 * generator.random(7)) for name, size in sizes.items()}
    together = strength.hub_shear(**table)
    assert together.shape == (7,)
    for place in range(7):
        own = {name: float(column[place]) for name, column in table.items()}
        assert float(strength.hub_shear(**own)) == together[place]
    columns = (table["torque"], table["inner_radius"], table["thickness"])
    together = strength.shear_stress(*columns)
    alone = [float(strength.shear_stress(*map(float, row))) for row in zip(*columns, strict=True)]
    assert alone == together.tolist()
    assert [float(strength.von_mises_stress(one)) for one in together] == strength.von_mises_stress(together).tolist()
    assert strength.hub_shear(**EVEN).shape == ()
