"""The whole valid range of cups, hats and cylinders against slow quadrature along the meridian."""

import math
from itertools import product, starmap

import numpy as np
import pytest
from grids import for_each
from hypothesis import given, settings
from hypothesis import strategies as st
from slow_meridian import slow_windup

from flexlash.mechanics.flexspline import CYLINDER_SEGMENTS, backlash, windups

thorough = settings(deadline=None, max_examples=300, derandomize=True)
brief = settings(deadline=None, max_examples=60, derandomize=True)

AGREEMENT = 1e-6
"""Relative difference of the total wind-up that the slow quadrature is allowed to find."""

REFINEMENTS = (
    "disk_hub_thickness",
    "hub_fillet_radius",
    "junction_fillet_radius",
    "rim_length",
    "rim_thickness",
    "tooth_face_width",
)

B3_160 = {
    "torque": 800.0,
    "cylinder_length": 0.16,
    "mean_radius": 0.08,
    "wall_thickness": 0.0016,
    "disk_inner_radius": 0.04,
    "shear_modulus": 211e9 / 2.6,
}


def without(dimensions, *names):
    """Return dimensions without some of them."""
    return {name: size for name, size in dimensions.items() if name not in names}


def mean_radius(dimensions):
    """Return the radius of the middle of the wall [m]."""
    return dimensions.get("mean_radius", (dimensions.get("bore_diameter", 0.0) + dimensions["wall_thickness"]) / 2)


def multiples(low, high):
    """Return factors that are spread evenly over their decades."""
    return st.floats(math.log(low), math.log(high)).map(math.exp)


def maybe(draw, **strategies):
    """Return what is drawn from strategies, or nothing."""
    return {name: draw(strategy) for name, strategy in strategies.items()} if draw(st.booleans()) else {}


@st.composite
def cylinders(draw):
    """Draw a cylinder: mean radius 10 to 200 mm or its bore, wall 0.3 to 10 % of it, perhaps a rim or a tooth face."""
    mean = draw(st.floats(0.010, 0.200))
    wall = mean * draw(st.floats(0.003, 0.1))
    length = mean * draw(multiples(0.2, 5.0))
    cylinder = {"torque": draw(multiples(0.1, 1e4)), "cylinder_length": length, "wall_thickness": wall}
    cylinder |= {"bore_diameter": 2 * mean - wall} if draw(st.booleans()) else {"mean_radius": mean}
    if draw(st.booleans()):
        cylinder["shear_modulus"] = draw(st.floats(1e10, 1e11))
    else:
        cylinder |= {"youngs_modulus": draw(st.floats(1e10, 2.5e11)), "poisson_ratio": draw(st.floats(0.0, 0.5))}
    if draw(st.booleans()):
        cylinder |= {"rim_length": length * draw(st.floats(0.01, 0.99)), "rim_thickness": wall * draw(st.floats(1, 5))}
    cylinder |= maybe(draw, tooth_face_width=st.floats(0.01, 1.0).map(lambda share: length * share))
    return cylinder | maybe(draw, cylinder_calibration=st.floats(0.5, 2.0))


@st.composite
def hats(draw):
    """Draw a hat: a cylinder with an outward flange from its mean radius or close to it."""
    hat = draw(cylinders())
    mean, wall = mean_radius(hat), hat["wall_thickness"]
    hat["disk_outer_radius"] = mean * (1 + draw(multiples(0.01, 2.0)))
    hat |= maybe(draw, disk_thickness=multiples(0.2, 5.0).map(lambda factor: wall * factor))
    hat |= maybe(draw, disk_inner_radius=st.floats(0.95, 1.005).map(lambda factor: mean * factor))
    return hat | maybe(draw, disk_calibration=st.floats(0.5, 2.0))


@st.composite
def plain_cups(draw):
    """Draw a cup: a cylinder with a disk inwards to a hub of a tenth to 95 % of its radius."""
    cup = draw(cylinders())
    mean, wall = mean_radius(cup), cup["wall_thickness"]
    cup["disk_inner_radius"] = mean * draw(st.floats(0.1, 0.95))
    cup |= maybe(draw, disk_outer_radius=st.floats(0.96, 1.1).map(lambda factor: mean * factor))
    cup |= maybe(draw, disk_thickness=multiples(0.2, 5.0).map(lambda factor: wall * factor))
    return cup | maybe(draw, disk_calibration=st.floats(0.5, 2.0))


def disk_width(cup):
    """Return the width of a cup's disk [m]."""
    return cup.get("disk_outer_radius", mean_radius(cup)) - cup["disk_inner_radius"]


def with_junction_fillet(draw, cup):
    """Return a cup with a fillet in the corner, 0.01 to 20 walls, that fits beside rim, teeth and in the bore."""
    wall = cup["wall_thickness"]
    taken = max(cup.get("rim_length", 0.0), cup.get("tooth_face_width", 0.0))
    room = min(cup["cylinder_length"] - taken, mean_radius(cup) - wall / 2)
    return cup | {"junction_fillet_radius": min(wall * draw(multiples(0.01, 20.0)), room)}


def with_hub_fillet(draw, cup, thickness):
    """Return a cup with a fillet at its hub, 0.01 to 20 times a thickness and no wider than its disk."""
    return cup | {"hub_fillet_radius": min(thickness * draw(multiples(0.01, 20.0)), disk_width(cup))}


@st.composite
def cups(draw):
    """Draw a cup with any refinements: taper both ways up to fivefold, fillets, rim."""
    cup = draw(plain_cups())
    disk = cup.get("disk_thickness", cup["wall_thickness"])
    cup |= maybe(draw, disk_hub_thickness=multiples(0.2, 5.0).map(lambda factor: disk * factor))
    if draw(st.booleans()):
        cup = with_hub_fillet(draw, cup, min(disk, cup.get("disk_hub_thickness", disk)))
    if draw(st.booleans()):
        cup = with_junction_fillet(draw, cup)
    return cup


@st.composite
def power_law_cups(draw):
    """Draw a cup whose disk thins or thickens with a power of the radius, perhaps with fillets."""
    cup = without(draw(plain_cups()), "disk_thickness")
    cup["disk_hub_thickness"] = cup["wall_thickness"] * draw(multiples(0.5, 5.0))
    cup["disk_thickness_exponent"] = draw(st.sampled_from([0.0, 1.0, 2.0, 3.0]) | st.floats(0.0, 10.0))
    if draw(st.booleans()):
        outer = cup["disk_inner_radius"] + disk_width(cup)
        last = cup["disk_hub_thickness"] * (cup["disk_inner_radius"] / outer) ** cup["disk_thickness_exponent"]
        cup = with_hub_fillet(draw, cup, min(cup["disk_hub_thickness"], last))
    if draw(st.booleans()):
        cup = with_junction_fillet(draw, cup)
    return cup


@st.composite
def extreme_cups(draw):
    """Draw a cup unlike any that is made, yet a part: the widest fillets, a disk that thins by up to eight decades."""
    hub = draw(multiples(1e-3, 0.99))
    wall = draw(multiples(1e-5, 0.3))
    cup = {
        "torque": 1.0,
        "shear_modulus": 1.0,
        "mean_radius": 1.0,
        "wall_thickness": wall,
        "cylinder_length": draw(multiples(1e-2, 1e2)),
        "disk_inner_radius": hub,
        "hub_fillet_radius": (1 - hub) * draw(multiples(1e-4, 1.0) | st.just(1.0)),
    }
    cup["junction_fillet_radius"] = min(cup["cylinder_length"], 1 - wall / 2) * draw(multiples(1e-4, 1.0))
    if draw(st.booleans()):
        cup["disk_hub_thickness"] = wall * draw(multiples(1e-3, 1e3))
        if draw(st.booleans()):
            most = min(10.0, math.log(1e8) / -math.log(hub))
            cup["disk_thickness_exponent"] = draw(st.just(most) | st.floats(0.0, most))
    return cup


cone_angles = st.floats(0.1, math.pi / 2) | st.just(math.pi / 2)

shapes = st.one_of(
    st.tuples(st.just("cup"), cups()), st.tuples(st.just("hat"), hats()), st.tuples(st.just("cylinder"), cylinders())
)


def windup(kind, dimensions):
    """Return the wind-up of the whole flexspline [rad]."""
    return float(backlash(kind, dimensions)) / 2


def assert_agrees(kind, dimensions):
    """Assert that a flexspline, and its cylinder apart from its disk, wind up as slow quadrature says."""
    exact = slow_windup(kind, dimensions)
    room = AGREEMENT * exact["total"]
    assert windup(kind, dimensions) == pytest.approx(exact["total"], rel=AGREEMENT)
    angles = {segment: float(angle) for segment, angle in windups(kind, dimensions).items()}
    cylinder = sum(angle for segment, angle in angles.items() if segment in CYLINDER_SEGMENTS)
    assert cylinder == pytest.approx(exact["cylinder"], rel=0, abs=room)
    assert sum(angles.values()) - cylinder == pytest.approx(exact["disk"], rel=0, abs=room)


def assert_same_bits(kind, dimensions, pairs):
    """Assert that segments of arrays (n,) and of (n, 1) with (1, m) have the bits of scalars at the same place."""
    generator = np.random.default_rng(3)
    single = {name: size * (1 - 0.02 * generator.random(9)) for name, size in dimensions.items()}
    crossed = {
        name: size * (1 - 0.02 * generator.random((5, 1) if upright else (1, 7)))
        for (name, size), upright in zip(dimensions.items(), pairs, strict=True)
    }
    for table, shape in ((single, (9,)), (crossed, (5, 7))):
        together = windups(kind, table)
        for place in np.ndindex(shape):
            own = {name: float(np.broadcast_to(column, shape)[place]) for name, column in table.items()}
            alone = windups(kind, own)
            assert list(alone) == list(together)
            for segment, angle in alone.items():
                assert np.shape(angle) == ()
                assert float(angle) == np.broadcast_to(together[segment], shape)[place], segment


def test_slow_quadrature_of_the_published_cup():
    """The slow quadrature itself has the exact two terms of the plain B3-160 cup."""
    exact = slow_windup("cup", B3_160)
    assert exact["cylinder"] == pytest.approx(3.0642983711e-4, rel=2e-11)
    assert exact["disk"] == pytest.approx(2.2982237784e-4, rel=2e-11)
    assert exact["total"] == exact["cylinder"] + exact["disk"]


@pytest.mark.parametrize(
    ("changes", "disk"),
    [
        ({"disk_hub_thickness": 0.004}, 1.2086009619e-4),
        ({"disk_hub_thickness": 0.004, "disk_thickness_exponent": 2.0}, 1.699207821e-4),
        ({"disk_cone_angle": math.radians(30)}, 2 * 2.2982237784e-4),
    ],
    ids=["taper", "constant shear", "cone"],
)
def test_slow_quadrature_of_known_disks(changes, disk):
    """The slow quadrature itself has the published wind-up of a taper, of constant shear stress and of a cone."""
    assert slow_windup("cup", B3_160 | changes)["disk"] == pytest.approx(disk, rel=3e-10)


@pytest.mark.slow
@thorough
@given(cup=cups())
def test_cups_by_quadrature(cup):
    """Any valid cup winds up as slow quadrature along its meridian says."""
    assert_agrees("cup", cup)


BOUND = 3e-7
"""Relative error that the hub fillet's integral promises for every part, up to a fillet of 1000 hub radii."""


@pytest.mark.slow
@thorough
@given(cup=extreme_cups())
def test_extreme_cups_by_quadrature(cup):
    """However wide the fillets and however the disk thins, disk and cylinder each keep their promised error."""
    exact = slow_windup("cup", cup)
    angles = {segment: float(angle) for segment, angle in windups("cup", cup).items()}
    cylinder = sum(angle for segment, angle in angles.items() if segment in CYLINDER_SEGMENTS)
    assert cylinder == pytest.approx(exact["cylinder"], rel=AGREEMENT)
    assert sum(angles.values()) - cylinder == pytest.approx(exact["disk"], rel=BOUND)


@pytest.mark.parametrize(("exponent", "angle"), [(4.0, 1.400463e-4), (10.0, 9.32717e-4)])
def test_hub_fillet_on_a_strongly_thinning_disk(exponent, angle):
    """A fillet of 38 mm on a disk of 2 mm at its hub that thins with a high power is told to the last digit known."""
    thinning = {"disk_hub_thickness": 0.002, "disk_thickness_exponent": exponent, "hub_fillet_radius": 0.038}
    assert float(windups("cup", B3_160 | thinning)["hub_fillet"]) == pytest.approx(angle, rel=4e-7)


@pytest.mark.slow
@brief
@given(cup=extreme_cups(), data=st.data())
def test_arrays_of_extreme_cups_have_the_bits_of_scalars(cup, data):
    """Fillets by graded points beside such by few give each segment the very bits that scalars give."""
    cup |= {"hub_fillet_radius": 0.9 * cup["hub_fillet_radius"]}  # room for what the other dimensions lose
    pairs = data.draw(st.lists(st.booleans(), min_size=len(cup), max_size=len(cup)))
    assert_same_bits("cup", cup, pairs)


@pytest.mark.slow
@brief
@given(hat=hats())
def test_hats_by_quadrature(hat):
    """Any valid hat winds up as slow quadrature along its meridian says."""
    assert_agrees("hat", hat)


@pytest.mark.slow
@brief
@given(cylinder=cylinders())
def test_cylinders_by_quadrature(cylinder):
    """Any valid cylinder, with a rim or without, winds up as slow quadrature along its meridian says."""
    assert_agrees("cylinder", cylinder)


@pytest.mark.slow
@thorough
@given(cup=plain_cups(), data=st.data(), multiple=multiples(1.0, 20.0))
def test_large_hub_fillets_by_quadrature(cup, data, multiple):
    """A cup whose hub fillet is 1 to 20 times the disk's thickness or as wide as the disk agrees."""
    disk = cup.get("disk_thickness", cup["wall_thickness"])
    taper = data.draw(multiples(0.2, 5.0) | st.just(1.0))
    fillet = min(multiple * disk * min(taper, 1.0), disk_width(cup))
    assert_agrees("cup", cup | {"disk_hub_thickness": disk * taper, "hub_fillet_radius": fillet})


def corner(wall, hub, disk):
    """Return a short cup of mean radius 1 whose wall, hub radius and disk thickness over the wall are extreme."""
    return {
        "torque": 1.0,
        "shear_modulus": 1.0,
        "mean_radius": 1.0,
        "wall_thickness": wall,
        "cylinder_length": 0.2,
        "disk_inner_radius": hub,
        "disk_thickness": disk * wall,
    }


each_corner = for_each("cup", starmap(corner, product([0.003, 0.1], [0.1, 0.5, 0.95], [0.2, 1, 5])))


@each_corner
@for_each("taper", [0.2, 0.5, 2.0, 5.0])
def test_tapers_in_the_corners_of_the_range(cup, taper):
    """Cups in the corners of the valid range agree when their disk thins or thickens up to fivefold."""
    assert_agrees("cup", cup | {"disk_hub_thickness": taper * cup["disk_thickness"]})


@each_corner
@for_each("multiple", [0.01, 1.0, 3.0, 20.0])
def test_hub_fillets_in_the_corners_of_the_range(cup, multiple):
    """Cups in the corners of the valid range agree with hub fillets of 0.01 to 20 times the disk's thickness."""
    assert_agrees("cup", cup | {"hub_fillet_radius": min(multiple * cup["disk_thickness"], disk_width(cup))})


@for_each("multiple", [0.01, 1.0, 3.0, 20.0])
@for_each("wall", [0.003, 0.03, 0.1])
def test_junction_fillets_in_the_corners_of_the_range(wall, multiple):
    """Cups in the corners of the valid range agree with junction fillets of 0.01 to 20 walls, the wall all fillet."""
    fillet = min(multiple * wall, 1 - wall / 2)
    assert_agrees("cup", corner(wall, 0.95, 5.0) | {"junction_fillet_radius": fillet, "cylinder_length": fillet})


@pytest.mark.slow
@thorough
@given(cup=plain_cups(), multiple=multiples(1.0, 20.0))
def test_large_junction_fillets_by_quadrature(cup, multiple):
    """A short cup whose junction fillet is 1 to 20 walls agrees, up to a fillet as large as the bore."""
    cup = without(cup, "rim_length", "rim_thickness", "tooth_face_width")
    fillet = min(multiple * cup["wall_thickness"], mean_radius(cup) - cup["wall_thickness"] / 2)
    assert_agrees("cup", cup | {"junction_fillet_radius": fillet, "cylinder_length": 1.01 * fillet})


@pytest.mark.slow
@brief
@given(shape=shapes)
def test_doubled_torque_doubles(shape):
    """Twice the torque winds up twice as far, to the last bit."""
    kind, dimensions = shape
    assert windup(kind, dimensions | {"torque": 2 * dimensions["torque"]}) == 2 * windup(kind, dimensions)


@pytest.mark.slow
@brief
@given(shape=shapes, factor=st.floats(1.0001, 2.0))
def test_longer_winds_up_more(shape, factor):
    """A longer cylinder always winds up more."""
    kind, dimensions = shape
    assert windup(kind, dimensions | {"cylinder_length": factor * dimensions["cylinder_length"]}) > windup(
        kind, dimensions
    )


@pytest.mark.slow
@brief
@given(shape=shapes, factor=st.floats(1.0001, 2.0))
def test_thicker_wall_winds_up_less(shape, factor):
    """A thicker wall at the same mean radius always winds up less; the rim keeps the wall's bore and goes first."""
    kind, dimensions = shape
    dimensions = without(dimensions, "rim_length", "rim_thickness", "tooth_face_width", "bore_diameter") | {
        "mean_radius": mean_radius(dimensions)
    }
    thicker = dimensions | {"wall_thickness": factor * dimensions["wall_thickness"]}
    assert windup(kind, thicker) < windup(kind, dimensions)


@pytest.mark.slow
@brief
@given(cup=cups(), factor=st.floats(1.0001, 2.0), name=st.sampled_from(["disk_thickness", "disk_hub_thickness"]))
def test_thicker_disk_winds_up_less(cup, factor, name):
    """A disk that is thicker at its hub or at its rim always winds up less."""
    assert windup("cup", cup | {name: factor * cup.get(name, cup["wall_thickness"])}) < windup(
        "cup", cup | {name: cup.get(name, cup["wall_thickness"])}
    )


@pytest.mark.slow
@brief
@given(hat=hats(), flange=multiples(1e-9, 1e-2))
def test_narrow_hat_approaches_the_cylinder(hat, flange):
    """A hat whose bolt circle approaches its mean radius winds up as its cylinder, and by its flange more."""
    hat = without(hat, "disk_inner_radius")
    mean = mean_radius(hat)
    outer = mean * (1 + flange)
    narrow = windup("hat", hat | {"disk_outer_radius": outer})
    flange = (outer - mean) / mean
    angles = windups("cylinder", without(hat, "disk_outer_radius", "disk_thickness", "disk_calibration"))
    tube = sum(float(angle) for angle in angles.values())
    ring = flange * mean / (mean**3 * hat.get("disk_thickness", hat["wall_thickness"]))
    wall = hat["cylinder_length"] / (mean**3 * hat["wall_thickness"])
    scale = (
        hat.get("disk_calibration", 1.0)
        * slow_windup(
            "cylinder", without(hat, "rim_length", "rim_thickness", "tooth_face_width", "cylinder_calibration")
        )["total"]
        / wall
    )
    assert tube < narrow <= tube + scale * ring * (1 + 1e-6) + 1e-15 * tube
    assert narrow >= tube + scale * ring * (1 - 2 * flange) - 1e-15 * tube


@pytest.mark.slow
@brief
@given(shape=shapes, part=st.floats(0.01, 0.99))
def test_rim_as_thick_as_the_wall_changes_nothing(shape, part):
    """A rim as thick as the wall leaves the wind-up as it is."""
    kind, dimensions = shape
    plain = without(dimensions, "rim_length", "rim_thickness", "tooth_face_width")
    room = plain["cylinder_length"] - plain.get("junction_fillet_radius", 0.0)
    rim = {"rim_length": part * room, "rim_thickness": plain["wall_thickness"]}
    assert windup(kind, plain | rim) == pytest.approx(windup(kind, plain), rel=1e-12)


@pytest.mark.slow
@brief
@given(cup=cups(), name=st.sampled_from(["hub_fillet_radius", "junction_fillet_radius"]), small=multiples(1e-12, 1e-2))
def test_small_fillet_tends_to_none(cup, name, small):
    """A fillet that vanishes takes away less than the ring of its own width winds up, and in the end nothing."""
    cup = without(cup, name)
    disk = cup.get("disk_thickness", cup["wall_thickness"])
    at_hub = name == "hub_fillet_radius"
    radius = cup["disk_inner_radius"] if at_hub else 0.5 * mean_radius(cup)
    thickness = min(disk, cup.get("disk_hub_thickness", disk)) if at_hub else cup["wall_thickness"]
    fillet = small * min(thickness, disk_width(cup))
    modulus = cup.get("shear_modulus") or cup["youngs_modulus"] / (2 * (1 + cup["poisson_ratio"]))
    calibration = cup.get("disk_calibration" if at_hub else "cylinder_calibration", 1.0)
    ring = cup["torque"] / (2 * math.pi * modulus) * fillet / (radius**3 * thickness) * calibration
    sharp = windup("cup", cup)
    assert windup("cup", cup | {name: fillet}) == pytest.approx(sharp, rel=1e-7, abs=ring)
    assert windup("cup", cup | {name: 0.0}) == pytest.approx(sharp, rel=1e-7)


@pytest.mark.slow
@brief
@given(shape=shapes)
def test_segments_add_up(shape):
    """The backlash is twice the sum of the segments, each of which winds up forwards or not at all."""
    kind, dimensions = shape
    angles = [float(angle) for angle in windups(kind, dimensions).values()]
    assert all(angle >= 0 for angle in angles)
    assert float(backlash(kind, dimensions)) == 2 * sum(angles)


@pytest.mark.slow
@brief
@given(shape=shapes, data=st.data())
def test_arrays_have_the_bits_of_scalars(shape, data):
    """Arrays (n,) and (n, 1) with (1, m) give each segment the very bits that scalars give."""
    kind, dimensions = shape
    pairs = data.draw(st.lists(st.booleans(), min_size=len(dimensions), max_size=len(dimensions)))
    assert_same_bits(kind, dimensions, pairs)


@pytest.mark.slow
@thorough
@given(cup=power_law_cups())
def test_power_law_cups_by_quadrature(cup):
    """Any power-law cup winds up as slow quadrature says."""
    assert_agrees("cup", cup)


@pytest.mark.slow
@brief
@given(cup=power_law_cups(), factor=st.floats(1.2, 3.0))
def test_wall_has_no_part_in_a_power_law_disk(cup, factor):
    """The wall's thickness leaves the wind-up of a power-law disk as it is."""
    cup |= {"mean_radius": mean_radius(cup)}
    cup = without(cup, "bore_diameter", "rim_length", "rim_thickness", "tooth_face_width")
    thicker = windups("cup", cup | {"wall_thickness": factor * cup["wall_thickness"]})
    for segment, angle in windups("cup", cup).items():
        if segment not in CYLINDER_SEGMENTS:
            assert float(thicker[segment]) == float(angle)


@pytest.mark.slow
@brief
@given(cup=plain_cups(), thickness=multiples(0.2, 5.0))
def test_power_law_of_exponent_zero_is_an_even_disk(cup, thickness):
    """With n = 0 the disk has its hub's thickness everywhere."""
    thickness *= cup["wall_thickness"]
    cup = without(cup, "disk_thickness")
    powered = windup("cup", cup | {"disk_hub_thickness": thickness, "disk_thickness_exponent": 0.0})
    assert powered == pytest.approx(windup("cup", cup | {"disk_thickness": thickness}), rel=1e-12)


@pytest.mark.slow
@brief
@given(cup=power_law_cups(), data=st.data())
def test_power_law_arrays_have_the_bits_of_scalars(cup, data):
    """Arrays give each segment the very bits that scalars give."""
    pairs = data.draw(st.lists(st.booleans(), min_size=len(cup), max_size=len(cup)))
    assert_same_bits("cup", cup, pairs)


@pytest.mark.slow
@brief
@given(
    shape=st.tuples(st.just("cup"), cups() | power_law_cups()) | st.tuples(st.just("hat"), hats()), angle=cone_angles
)
def test_cones_by_quadrature(shape, angle):
    """Any conical disk or flange winds up as slow quadrature says."""
    kind, dimensions = shape
    sharp = without(dimensions, "hub_fillet_radius", "junction_fillet_radius")
    assert_agrees(kind, sharp | {"disk_cone_angle": angle})


@pytest.mark.slow
@brief
@given(shape=st.tuples(st.just("cup"), cups()) | st.tuples(st.just("hat"), hats()))
def test_right_angled_cone_is_flat(shape):
    """At a right angle to the axis the cone is the flat disk; at 30° twice as soft."""
    kind, dimensions = shape
    sharp = without(dimensions, "hub_fillet_radius", "junction_fillet_radius")
    flat = float(windups(kind, sharp)["disk_body"])
    upright, steep = (windups(kind, sharp | {"disk_cone_angle": angle}) for angle in (math.pi / 2, math.pi / 6))
    assert float(upright["disk_body"]) == pytest.approx(flat, rel=1e-14)
    assert float(steep["disk_body"]) == pytest.approx(2 * flat, rel=1e-14)


@pytest.mark.slow
@brief
@given(
    shape=st.tuples(st.just("cup"), cups() | power_law_cups()) | st.tuples(st.just("hat"), hats()),
    angle=cone_angles,
    data=st.data(),
)
def test_cone_arrays_have_the_bits_of_scalars(shape, angle, data):
    """Arrays give each segment the very bits that scalars give."""
    kind, dimensions = shape
    sharp = without(dimensions, "hub_fillet_radius", "junction_fillet_radius") | {"disk_cone_angle": angle}
    pairs = data.draw(st.lists(st.booleans(), min_size=len(sharp), max_size=len(sharp)))
    assert_same_bits(kind, sharp, pairs)
