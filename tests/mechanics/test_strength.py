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


def tapered(disk):
    """Return stress and radius of a disk that thins in a straight line from its hub thickness to its thickness."""
    inner, hub = disk["inner_radius"], disk["hub_thickness"]
    slope = (disk["thickness"] - hub) / (disk["outer_radius"] - inner)
    return strength.disk_shear(
        torque=disk["torque"],
        inner_radius=inner,
        outer_radius=disk["outer_radius"],
        fillet_radius=disk["fillet_radius"],
        thickness_at=lambda radius: hub + slope * (radius - inner),
    )


def power_law(exponent, hub_thickness=0.004, fillet_radius=0.0):
    """Return stress and radius of a disk 40 → 80 mm at 800 N·m that thins with a power of the radius."""
    return strength.disk_shear(
        torque=800.0,
        inner_radius=0.04,
        outer_radius=0.08,
        fillet_radius=fillet_radius,
        thickness_at=lambda radius: hub_thickness * (0.04 / radius) ** exponent,
    )


def slow_stresses(torque, inner_radius, outer_radius, hub_thickness, thickness, fillet_radius):  # noqa: PLR0917
    """Return a hundred thousand radii of a tapered disk and the shear stress there, arc written as in the drawing."""
    width, fillet = outer_radius - inner_radius, fillet_radius
    advance = np.concatenate([np.linspace(0, width, 100_001), fillet * np.linspace(0, 1, 20_001) ** 3])
    inside = np.clip(fillet - advance, 0, None)
    arc = np.where(advance < fillet, fillet - np.sqrt(np.clip(fillet**2 - inside**2, 0, None)), 0.0)
    local = hub_thickness + (thickness - hub_thickness) * advance / width + arc
    return inner_radius + advance, torque / (2 * math.pi * (inner_radius + advance) ** 2 * local)


def slow_hub_shear(disk):
    """Return the greatest of the slow stresses."""
    return float(slow_stresses(**disk)[1].max())


@pytest.mark.parametrize(
    ("radius", "expected"),
    [(0.080, 12.434), (0.040, 49.736)],
)
def test_published_case(radius, expected):
    """B3-160 at 800 N·m has 12.434 MPa in the wall and 49.736 MPa at the hub."""
    assert strength.shear_stress(800.0, radius, 0.0016) / 1e6 == pytest.approx(expected, abs=5e-4)


def test_von_mises_of_the_published_case():
    """The hub's shear stress of B3-160 is a von Mises stress of 86.145 MPa."""
    shear, _ = tapered(EVEN)
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


@pytest.mark.slow
@thorough
@given(disk=disks())
def test_disk_shear_against_a_slow_search(disk):
    """The greatest shear stress in a tapered, filleted disk is that of a slow search, low by less than 1e-6."""
    found, exact = float(tapered(disk)[0]), slow_hub_shear(disk)
    assert found == pytest.approx(exact, rel=1e-6)


@pytest.mark.slow
@thorough
@given(disk=disks())
def test_the_stress_acts_at_its_radius(disk):
    """The radius lies in the disk, and the stress there is the one that is returned."""
    stress, radius = map(float, tapered(disk))
    inner, outer, fillet = disk["inner_radius"], disk["outer_radius"], disk["fillet_radius"]
    assert inner <= radius <= outer * (1 + 1e-15)
    inside = max(fillet - (radius - inner), 0.0)
    arc = fillet - math.sqrt(max(fillet**2 - inside**2, 0.0)) if radius - inner < fillet else 0.0
    slope = (disk["thickness"] - disk["hub_thickness"]) / (outer - inner)
    local = disk["hub_thickness"] + slope * (radius - inner) + arc
    # Close to the fillet's steep end at the hub an arc as drawn loses half of its digits.
    assert stress == pytest.approx(float(strength.shear_stress(disk["torque"], radius, local)), rel=1e-6)


@pytest.mark.parametrize("multiple", [1, 3, 5, 10, 20, 100])
def test_disk_shear_has_the_stated_error(multiple):
    """The search is low by less than 1e-6, as its docstring says, for a fillet of any multiple of the thickness."""
    fillet = multiple * 0.0016
    for inner in (0.010, 0.040, 0.120):
        disk = EVEN | {"inner_radius": inner, "outer_radius": inner + max(0.04, fillet), "fillet_radius": fillet}
        assert float(tapered(disk)[0]) >= slow_hub_shear(disk) * (1 - 1e-6)


@thorough
@given(disk=disks(), factor=st.floats(1.0, 2.0))
def test_thicker_disk_is_never_stressed_more(disk, factor):
    """A disk thicker throughout is never stressed more; more torque stresses it in proportion, at the same radius."""
    stress, radius = tapered(disk)
    thicker = {name: disk[name] * factor for name in ("hub_thickness", "thickness")}
    assert tapered(disk | thicker)[0] <= stress * (1 + 1e-6)
    assert tapered(disk | {"torque": 2 * disk["torque"]}) == (2 * stress, radius)


def test_even_disk_governs_at_the_hub():
    """An even disk without fillet has its greatest shear stress at the hub radius."""
    stress, radius = tapered(EVEN)
    assert stress == pytest.approx(float(strength.shear_stress(800.0, 0.04, 0.0016)), rel=1e-15)
    assert radius == 0.04


def test_thin_edge_can_govern():
    """A disk that thins strongly towards the cylinder has its greatest shear stress there, not at the hub."""
    stress, radius = tapered(EVEN | {"hub_thickness": 0.008, "thickness": 0.0005})
    assert stress == pytest.approx(float(strength.shear_stress(800.0, 0.08, 0.0005)), rel=1e-12)
    assert radius == pytest.approx(0.08, rel=1e-15)


def test_hub_fillet_relieves_the_hub():
    """A hub fillet of 3.5 mm moves the greatest shear stress of B3-160 outwards, into the fillet, and lowers it."""
    even, _ = tapered(EVEN)
    relieved, radius = tapered(EVEN | {"fillet_radius": 0.0035})
    assert strength.shear_stress(800.0, 0.0435, 0.0016) * 0.999 < relieved < even
    assert 0.0420 < radius < 0.0435


def test_constant_shear_disk():
    """A disk that thins as 1/r² has the same stress at every radius, so that any radius of the disk may stand."""
    stress, radius = power_law(2.0)
    assert stress == pytest.approx(float(strength.shear_stress(800.0, 0.04, 0.004)), rel=1e-14)
    assert stress == pytest.approx(float(strength.shear_stress(800.0, 0.08, 0.001)), rel=1e-14)
    assert 0.04 <= radius <= 0.08


@pytest.mark.parametrize(("exponent", "place"), [(0.0, 0.04), (1.9, 0.04), (2.1, 0.08), (5.0, 0.08)])
def test_power_law_disk_governs_at_an_edge(exponent, place):
    """A disk that thins slower than 1/r² is stressed most at its hub, one that thins faster at the cylinder."""
    stress, radius = power_law(exponent)
    thickness = 0.004 * (0.04 / place) ** exponent
    assert stress == pytest.approx(float(strength.shear_stress(800.0, place, thickness)), rel=1e-13)
    assert radius == pytest.approx(place, rel=1e-15)


def test_hub_fillet_on_a_constant_shear_disk():
    """A hub fillet on a disk that thins as 1/r² relieves its ring alone: the stress acts outside and is the same."""
    stress, radius = power_law(2.0, fillet_radius=0.0035)
    assert stress == pytest.approx(float(strength.shear_stress(800.0, 0.04, 0.004)), rel=1e-14)
    assert 0.0435 * (1 - 1e-12) <= radius <= 0.08


def test_greatest_stress_inside_the_disk():
    """A disk that is thinnest between hub and cylinder is stressed most where r² t is least, found within 1e-6."""

    def waisted(radius):
        return 0.001 + 20 * (radius - 0.06) ** 2

    stress, radius = strength.disk_shear(
        torque=800.0, inner_radius=0.04, outer_radius=0.08, fillet_radius=0.0, thickness_at=waisted
    )
    # r² t is least where 0.001 + 20 x² + 20 x r = 0 with x = r − 0.06: 40 r² − 3.6 r + 0.073 = 0.
    exact = (3.6 + math.sqrt(3.6**2 - 4 * 40 * 0.073)) / 80
    assert 0.05 < exact < 0.06
    assert stress == pytest.approx(float(strength.shear_stress(800.0, exact, waisted(exact))), rel=1e-6)
    assert radius == pytest.approx(exact, rel=1e-3)


def test_taper_is_stressed_least_inside():
    """A taper from 4 to 1 mm has r² t greatest inside, so that one of its edges governs, here both alike."""
    stress, radius = tapered(EVEN | {"hub_thickness": 0.004, "thickness": 0.001})
    assert stress == pytest.approx(float(strength.shear_stress(800.0, 0.04, 0.004)), rel=1e-12)
    assert min(abs(float(radius) - edge) for edge in (0.04, 0.08)) < 1e-12


def test_fillet_across_the_whole_disk():
    """A fillet as wide as the disk, or by rounding a little wider, is searched up to the disk's rim."""
    disk = EVEN | {"outer_radius": 0.05, "fillet_radius": 0.01}
    whole, radius = tapered(disk)
    assert whole == pytest.approx(slow_hub_shear(disk), rel=1e-6)
    wider = tapered(disk | {"fillet_radius": 0.01 * (1 + 1e-12)})
    assert wider == pytest.approx((float(whole), float(radius)), rel=1e-9)


def test_arrays_equal_scalars_bit_for_bit():
    """Stresses and radii of shape (variants,) equal scalar calls bit for bit."""
    generator = np.random.default_rng(3)
    sizes = EVEN | {"hub_thickness": 0.003, "fillet_radius": 0.0035}
    table = {name: size * (1 + 0.05 * generator.random(7)) for name, size in sizes.items()}
    together = tapered(table)
    assert [one.shape for one in together] == [(7,), (7,)]
    for place in range(7):
        own = {name: float(column[place]) for name, column in table.items()}
        assert tuple(map(float, tapered(own))) == tuple(float(one[place]) for one in together)
    columns = (table["torque"], table["inner_radius"], table["thickness"])
    together = strength.shear_stress(*columns)
    alone = [float(strength.shear_stress(*map(float, row))) for row in zip(*columns, strict=True)]
    assert alone == together.tolist()
    assert [float(strength.von_mises_stress(one)) for one in together] == strength.von_mises_stress(together).tolist()
    assert [one.shape for one in tapered(EVEN)] == [(), ()]


B3_160 = {"radius": 0.08, "thickness": 0.0016, "length": 0.16}


def test_buckling_of_the_published_case():
    """B3-160 of steel buckles at 561.6 MPa of wall shear."""
    assert strength.buckling_shear(211e9, **B3_160) / 1e6 == pytest.approx(561.6, abs=0.05)


@thorough
@given(
    young=st.floats(1e10, 5e11), radius=st.floats(0.005, 0.2), ratio=st.floats(0.003, 0.2), length=st.floats(0.1, 10)
)
def test_buckling_as_the_manual_prints_it(young, radius, ratio, length):
    """The buckling stress is 0.747 · 0.67 E (r/t)^(−5/4) (l/r)^(−½)."""
    found = strength.buckling_shear(young, radius, ratio * radius, length * radius)
    assert found == pytest.approx(0.747 * 0.67 * young * ratio**1.25 * length**-0.5, rel=1e-13)


def test_buckling_rises_with_thickness_and_falls_with_length():
    """Sixteen times as thick a wall buckles at 32 times the stress, four times as long a one at half."""
    once = float(strength.buckling_shear(211e9, 0.08, 0.0001, 0.16))
    assert strength.buckling_shear(211e9, 0.08, 0.0016, 0.16) == pytest.approx(32 * once, rel=1e-14)
    assert strength.buckling_shear(211e9, 0.08, 0.0001, 0.64) == pytest.approx(once / 2, rel=1e-14)
    assert strength.buckling_shear(422e9, 0.08, 0.0001, 0.16) == pytest.approx(2 * once, rel=1e-15)


# γZ = 50 with γ = 0.67^(4/3), ν = 0.3; and l/r = 6.5 √50.
SHORTEST = math.sqrt(50 / (0.67 ** (4 / 3) * math.sqrt(1 - 0.3**2)) * 0.08 * 0.0016)
LONGEST = 6.5 * math.sqrt(50) * 0.08


@pytest.mark.parametrize(
    ("length", "expected"),
    [
        (0.001, -1),
        (SHORTEST * (1 - 1e-9), -1),
        (SHORTEST * (1 + 1e-9), 0),
        (0.16, 0),
        (LONGEST * (1 - 1e-9), 0),
        (LONGEST * (1 + 1e-9), 1),
        (100.0, 1),
    ],
)
def test_buckling_range(length, expected):
    """The formula is meant for γZ above 50 and for l/r below 6.5 √(r/t): shorter −1, meant 0, longer 1."""
    assert strength.buckling_range(0.3, 0.08, 0.0016, length) == expected


def test_buckling_range_of_a_greater_poisson_ratio_begins_later():
    """√(1 − ν²) in Z moves the lower end up as ν grows."""
    assert strength.buckling_range(0.0, 0.08, 0.0016, SHORTEST) == 0
    assert strength.buckling_range(0.5, 0.08, 0.0016, SHORTEST) == -1


@pytest.mark.parametrize("stress", [86.145e6, 1080e6, 2000e6])
def test_elastic_limit_torque_makes_the_stress_the_strength(stress):
    """At the elastic limit torque the stress, which is proportional to the torque, is the yield strength."""
    limit = strength.limit_torque(800.0, stress, 1080e6)
    assert stress * limit / 800 == pytest.approx(1080e6, rel=1e-14)
    assert (limit > 800) == (stress < 1080e6)


def test_elastic_limit_of_the_published_case():
    """B3-160 of 1080 MPa yields from 10030 N·m on."""
    stress = strength.von_mises_stress(tapered(EVEN)[0])
    assert strength.limit_torque(800.0, stress, 1080e6) == pytest.approx(10_030, abs=0.5)


@pytest.mark.parametrize(
    ("function", "arguments"),
    [
        (strength.buckling_shear, (211e9, 0.08, 0.0016, 0.16)),
        (strength.buckling_range, (0.3, 0.08, 0.0016, SHORTEST)),
        (strength.limit_torque, (800.0, 86e6, 1080e6)),
    ],
    ids=lambda given_one: getattr(given_one, "__name__", ""),
)
def test_limits_of_arrays_equal_scalars_bit_for_bit(function, arguments):
    """Buckling and yield of shape (variants,) equal scalar calls bit for bit."""
    generator = np.random.default_rng(4)
    table = [argument * (0.95 + 0.1 * generator.random(30)) for argument in arguments]
    together = function(*table)
    assert together.shape == (30,)
    assert [float(function(*map(float, row))) for row in zip(*table, strict=True)] == together.tolist()
    assert len(set(together.tolist())) > 1


def test_a_wall_of_usual_length_buckles_by_the_published_formula():
    """Within the range of NASA SP-8007 the wall's buckling stress is that of its formula."""
    for length in (0.11, 0.16, 0.5, 3.0):
        assert strength.buckling_range(0.3, 0.08, 0.0016, length) == 0
        found = strength.wall_buckling_shear(211e9, 0.3, 0.08, 0.0016, length)
        assert found == strength.buckling_shear(211e9, 0.08, 0.0016, length)


def test_a_very_short_wall_buckles_as_a_plate():
    """A wall much shorter than its radius buckles no earlier than a long plate in shear, nor than the formula says."""
    length, thickness = 0.008, 0.0002
    plate = 5.35 * math.pi**2 * 206e9 / (12 * (1 - 0.3**2)) * (thickness / length) ** 2
    found = strength.wall_buckling_shear(206e9, 0.3, 0.08, thickness, length)
    assert found == pytest.approx(plate, rel=1e-12)
    assert found > strength.buckling_shear(206e9, 0.08, thickness, length)
    longer = strength.wall_buckling_shear(206e9, 0.3, 0.08, thickness, 0.02)
    assert longer == strength.buckling_shear(206e9, 0.08, thickness, 0.02)


def test_a_long_tube_buckles_whatever_its_length():
    """Beyond the formula's range the stress no longer falls with the length; it meets the formula at the border."""
    border = 6.5 * 0.08 * math.sqrt(0.08 / 0.0016)
    within, beyond, far = (
        float(strength.wall_buckling_shear(211e9, 0.3, 0.08, 0.0016, length))
        for length in (border * 0.999, border * 1.001, 10 * border)
    )
    assert beyond == far == pytest.approx(0.67 * 0.272 * 211e9 * 0.91**-0.75 * 0.02**1.5, rel=1e-12)
    assert within == pytest.approx(beyond, rel=0.01)
