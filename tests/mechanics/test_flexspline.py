"""The whole flexspline: which segments it has, what it shares, and how its wind-up answers to its dimensions."""

import importlib
import inspect
import math
import pkgutil
import re

import numpy as np
import pytest
from flexsplines import B3_160, CONE, FROM_BORE, HAT, POWER_LAW, REFINED, REFINEMENTS, SHAPES, without
from grids import for_each
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

import flexlash.mechanics
from flexlash.mechanics import flexspline

thorough = settings(deadline=None, max_examples=80, derandomize=True)


each_shape = pytest.mark.parametrize(("kind", "dimensions"), SHAPES.values(), ids=list(SHAPES))


@st.composite
def cups(draw, *, refined=True):
    """Draw a plausible cup: dimensions in SI, with refinements that fit."""
    mean = draw(st.floats(0.012, 0.12))
    wall = mean * draw(st.floats(0.01, 0.15))
    length = mean * draw(st.floats(0.5, 3.0))
    inner = mean * draw(st.floats(0.25, 0.8))
    cup = {
        "torque": draw(st.floats(1.0, 5000.0)),
        "cylinder_length": length,
        "mean_radius": mean,
        "wall_thickness": wall,
        "disk_inner_radius": inner,
        "youngs_modulus": draw(st.floats(1e11, 2.2e11)),
        "poisson_ratio": draw(st.floats(0.2, 0.4)),
    }
    if draw(st.booleans()):
        cup["disk_thickness"] = wall * draw(st.floats(0.5, 3.0))
    if refined:
        cup |= {
            "disk_hub_thickness": wall * draw(st.floats(0.5, 3.0)),
            "hub_fillet_radius": (mean - inner) * draw(st.floats(0.01, 0.99)),
            "junction_fillet_radius": min(length / 2, mean / 3) * draw(st.floats(0.01, 1.0)),
            "rim_length": length * draw(st.floats(0.01, 0.5)),
            "rim_thickness": wall * draw(st.floats(1.0, 3.0)),
        }
    return cup


def windup(kind, dimensions):
    """Return the wind-up of the whole flexspline [rad]."""
    return float(flexspline.backlash(kind, dimensions)) / 2


def two_term(dimensions):
    """Return the wind-up of cylinder and annulus [rad] as the article writes it."""
    modulus = dimensions["youngs_modulus"] / (2 * (1 + dimensions["poisson_ratio"]))
    mean, wall = dimensions["mean_radius"], dimensions["wall_thickness"]
    disk = dimensions.get("disk_thickness", wall)
    cylinder = dimensions["torque"] * dimensions["cylinder_length"] / (modulus * 2 * math.pi * mean**3 * wall)
    annulus = 1 / dimensions["disk_inner_radius"] ** 2 - 1 / mean**2
    return cylinder + dimensions["torque"] / (4 * math.pi * disk * modulus) * annulus


def drawn_arc(fillet, distance):
    """Return what a fillet adds to the thickness at a distance from where it starts."""
    return fillet - math.sqrt(max(fillet**2 - (fillet - distance) ** 2, 0.0)) if distance < fillet else 0.0


def meridian(cup):
    """Return the wind-up of a cup with all refinements [rad] by quadrature along its meridian."""
    modulus = cup["youngs_modulus"] / (2 * (1 + cup["poisson_ratio"]))
    mean, wall, length = cup["mean_radius"], cup["wall_thickness"], cup["cylinder_length"]
    inner, outer = cup["disk_inner_radius"], cup.get("disk_outer_radius", mean)
    disk, hub = cup.get("disk_thickness", wall), cup["disk_hub_thickness"]

    def in_disk(radius):
        even = hub + (disk - hub) * (radius - inner) / (outer - inner)
        return 1 / (radius**3 * (even + drawn_arc(cup["hub_fillet_radius"], radius - inner)))

    def in_wall(along):
        added = drawn_arc(cup["junction_fillet_radius"], along)
        return 1 / ((mean - added / 2) ** 3 * (wall + added))

    def in_rim(_):
        return 1 / ((mean - wall / 2 + cup["rim_thickness"] / 2) ** 3 * cup["rim_thickness"])

    fillet_end, rim_start = cup["junction_fillet_radius"], length - cup["rim_length"]
    hub_end = min(inner + cup["hub_fillet_radius"], outer)
    pieces = (
        (in_disk, inner, hub_end),
        (in_disk, hub_end, outer),
        (in_wall, 0, fillet_end),
        (in_wall, fillet_end, rim_start),
        (in_rim, rim_start, length),
    )
    total = sum(quad(one, start, end, epsabs=0, epsrel=1e-11, limit=500)[0] for one, start, end in pieces)
    return cup["torque"] / (2 * math.pi * modulus) * total


def public_functions():
    """Return the public functions of all modules in mechanics by qualified name; elementary ones have no physics."""
    found = {}
    for module in pkgutil.iter_modules(flexlash.mechanics.__path__):
        if module.ispkg or module.name == "elementary":
            continue
        loaded = importlib.import_module(f"flexlash.mechanics.{module.name}")
        for name in loaded.__all__:
            one = getattr(loaded, name)
            if inspect.isfunction(one):
                found[f"{module.name}.{name}"] = one
    return found


PUBLIC = public_functions()


def test_public_functions_are_found():
    """The mechanics offer functions in windup, flexspline, strength and stiffness."""
    assert {name.partition(".")[0] for name in PUBLIC} >= {"windup", "flexspline", "strength", "stiffness"}
    assert len(PUBLIC) >= 25


@for_each("name", PUBLIC)
def test_docstring_has_five_parts(name):
    """A mechanics function states its unit, equation, arguments, validity and source, and runs an example."""
    text = inspect.getdoc(PUBLIC[name]) or ""
    assert re.search(r"\[[^\]]+\]", text.partition("\n")[0]), "the first line names the unit in [brackets]"
    places = [text.find(f"\n{part}: ") for part in ("Equation", "Arguments", "Valid", "Source")]
    assert min(places) > 0, "a part is missing"
    assert places == sorted(places), "the parts stand in order"
    assert re.search(r"^>>> .+\n(?:\.\.\. .*\n|>>> .*\n)*[^>\s]", text, re.MULTILINE), "an example with its answer"


@pytest.mark.parametrize(
    ("shape", "segments"),
    [
        ("cup", ["wall", "disk_body"]),
        ("refined cup", ["rim", "wall", "junction_fillet", "disk_body", "hub_fillet"]),
        ("power-law cup", ["rim", "wall", "junction_fillet", "disk_body", "hub_fillet"]),
        ("conical cup", ["wall", "disk_body"]),
        ("conical hat", ["wall", "disk_body"]),
        ("hat", ["wall", "disk_body"]),
        ("cylinder", ["wall"]),
        ("cylinder with rim", ["rim", "wall"]),
    ],
)
def test_segments_of_each_type(shape, segments):
    """A flexspline has just the segments of its type and refinements, from the open end to the hub."""
    assert list(flexspline.windups(*SHAPES[shape])) == segments


@each_shape
def test_arrays_equal_scalars_bit_for_bit(kind, dimensions):
    """A call with (variants,) or (variants, draws) equals scalar calls bit for bit, segment by segment."""
    generator = np.random.default_rng(5)
    table = {name: size * (1 + 0.01 * generator.random((3, 4))) for name, size in dimensions.items()}
    together = flexspline.windups(kind, table)
    total = flexspline.backlash(kind, table)
    assert total.shape == (3, 4)
    for place in np.ndindex(3, 4):
        own = {name: float(column[place]) for name, column in table.items()}
        assert {name: float(angle) for name, angle in flexspline.windups(kind, own).items()} == {
            name: float(angle[place]) for name, angle in together.items()
        }
        assert float(flexspline.backlash(kind, own)) == total[place]
    first = {name: column[:, 0] for name, column in table.items()}
    assert np.array_equal(flexspline.backlash(kind, first), total[:, 0])


@each_shape
def test_exact_dimensions_meet_draws(kind, dimensions):
    """One dimension drawn and the others exact give the same bits as all of them given as arrays."""
    for name in dimensions:
        drawn = dimensions[name] * np.linspace(0.99, 1.01, 5)
        mixed = flexspline.backlash(kind, dimensions | {name: drawn})
        full = {other: np.full(5, size) for other, size in dimensions.items()} | {name: drawn}
        assert np.array_equal(mixed, flexspline.backlash(kind, full))


@each_shape
def test_backlash_is_twice_all_windups(kind, dimensions):
    """The backlash is twice the sum of the segments' wind-ups."""
    angles = flexspline.windups(kind, dimensions)
    assert all(angle >= 0 for angle in angles.values())
    assert flexspline.backlash(kind, dimensions) == pytest.approx(2 * sum(map(float, angles.values())), rel=1e-14)


@pytest.mark.slow
@thorough
@given(cup=cups(refined=False))
def test_without_refinements_it_is_the_two_term_formula(cup):
    """A cup without refinements has the two-term wind-up to 1e-12."""
    assert windup("cup", cup) == pytest.approx(two_term(cup), rel=1e-12)


@pytest.mark.slow
@thorough
@given(cup=cups(refined=False), rim=st.floats(0.01, 0.99))
def test_neutral_refinements_change_nothing(cup, rim):
    """Even hub, fillets of 0, a cone of 90° and a rim as thick as the wall leave the two-term wind-up to 1e-12."""
    neutral = {
        "disk_cone_angle": math.pi / 2,
        "disk_hub_thickness": cup.get("disk_thickness", cup["wall_thickness"]),
        "hub_fillet_radius": 0.0,
        "junction_fillet_radius": 0.0,
        "rim_length": rim * cup["cylinder_length"],
        "rim_thickness": cup["wall_thickness"],
    }
    assert windup("cup", cup | neutral) == pytest.approx(two_term(cup), rel=1e-12)


@thorough
@given(cup=cups(refined=False))
def test_exponent_of_zero_is_an_even_disk(cup):
    """A disk that thins with the power 0 has the two-term wind-up of its thickness at the hub to 1e-12."""
    even = {"disk_hub_thickness": cup.pop("disk_thickness", cup["wall_thickness"]), "disk_thickness_exponent": 0.0}
    assert windup("cup", cup | even) == pytest.approx(
        two_term(cup | {"disk_thickness": even["disk_hub_thickness"]}), rel=1e-12
    )


@thorough
@given(cup=cups(refined=False), exponent=st.floats(0.0, 10.0), factor=st.floats(1.0, 3.0))
def test_disk_that_thins_faster_never_winds_up_less(cup, exponent, factor):
    """From the same thickness at the hub a higher power leaves less material and winds up more."""
    cup = without(cup, "disk_thickness") | {"disk_hub_thickness": 2 * cup["wall_thickness"]}
    slower, faster = (cup | {"disk_thickness_exponent": exponent * times} for times in (1.0, factor))
    assert windup("cup", slower) <= windup("cup", faster) * (1 + 1e-14)


@thorough
@given(cup=cups(refined=False), angle=st.floats(0.5, math.pi / 2), factor=st.floats(0.5, 1.0))
def test_steeper_cone_never_winds_up_less(cup, angle, factor):
    """A disk at a smaller angle to the axis is longer and winds up more; its cylinder is the same."""
    wide, steep = (cup | {"disk_cone_angle": angle * times} for times in (1.0, factor))
    assert windup("cup", wide) <= windup("cup", steep) * (1 + 1e-14)
    assert flexspline.windups("cup", wide)["wall"] == flexspline.windups("cup", cup)["wall"]


@pytest.mark.parametrize(
    ("kind", "dimensions"), [("cup", CONE), ("hat", HAT | {"disk_cone_angle": math.radians(60)})], ids=["cup", "hat"]
)
def test_cone_divides_the_disk_by_its_sine(kind, dimensions):
    """A cone at 60° to the axis winds up as the flat disk or flange over sin 60°."""
    flat = flexspline.windups(kind, without(dimensions, "disk_cone_angle"))
    cone = flexspline.windups(kind, dimensions)
    assert cone["disk_body"] == pytest.approx(float(flat["disk_body"]) / math.sin(math.radians(60)), rel=1e-15)


def test_power_law_disk_starts_behind_its_hub_fillet():
    """A power-law disk with a hub fillet winds up as quadrature over ring and body says."""
    found = flexspline.windups("cup", POWER_LAW)
    inner, fillet = POWER_LAW["disk_inner_radius"], POWER_LAW["hub_fillet_radius"]

    def integrand(radius):
        even = POWER_LAW["disk_hub_thickness"] * (inner / radius) ** POWER_LAW["disk_thickness_exponent"]
        return 1 / (radius**3 * (even + drawn_arc(fillet, radius - inner)))

    scale = 800 / (2 * math.pi * 211e9 / 2.6)
    for segment, start, end in (
        ("hub_fillet", inner, inner + fillet),
        ("disk_body", inner + fillet, POWER_LAW["disk_outer_radius"]),
    ):
        exact = quad(integrand, start, end, epsabs=0, epsrel=1e-11, limit=500)[0]
        assert found[segment] == pytest.approx(scale * exact, rel=1e-9)


DISKS = {
    "as the wall": (B3_160, [0.0016, 0.0016, 0.0016]),
    "even": (B3_160 | {"disk_thickness": 0.002}, [0.002, 0.002, 0.002]),
    "taper to the wall": (B3_160 | {"disk_hub_thickness": 0.004}, [0.004, 0.0028, 0.0016]),
    "taper": (B3_160 | {"disk_hub_thickness": 0.004, "disk_thickness": 0.002}, [0.004, 0.003, 0.002]),
    "taper to its own radius": (
        B3_160 | {"disk_hub_thickness": 0.004, "disk_outer_radius": 0.08, "mean_radius": 0.0801},
        [0.004, 0.0028, 0.0016],
    ),
    "constant shear": (
        B3_160 | {"disk_hub_thickness": 0.004, "disk_thickness_exponent": 2.0},
        [0.004, 0.004 * 4 / 9, 0.001],
    ),
    "power of 0": (B3_160 | {"disk_hub_thickness": 0.004, "disk_thickness_exponent": 0.0}, [0.004, 0.004, 0.004]),
    "cone": (B3_160 | {"disk_cone_angle": 1.0}, [0.0016, 0.0016, 0.0016]),
    "fillet left out": (B3_160 | {"hub_fillet_radius": 0.0035}, [0.0016, 0.0016, 0.0016]),
}


@pytest.mark.parametrize(("dimensions", "expected"), DISKS.values(), ids=list(DISKS))
def test_disk_thickness(dimensions, expected):
    """The disk is even, a straight taper or a power of the radius at 40, 60 and 80 mm, normal to it, without fillet."""
    found = [float(flexspline.disk_thickness(dimensions, radius)) for radius in (0.04, 0.06, 0.08)]
    assert found == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("name", DISKS)
def test_disk_thickness_of_arrays_equals_scalars_bit_for_bit(name):
    """Thicknesses at radii of shape (stations, variants) equal scalar calls bit for bit."""
    generator = np.random.default_rng(6)
    table = {key: size * (1 + 0.01 * generator.random(7)) for key, size in DISKS[name][0].items()}
    radii = np.linspace(0.041, 0.079, 5)[:, None] * (1 + 0.01 * generator.random(7))
    together = np.broadcast_to(flexspline.disk_thickness(table, radii), radii.shape)
    for station, place in np.ndindex(radii.shape):
        own = {key: float(column[place]) for key, column in table.items()}
        assert float(flexspline.disk_thickness(own, float(radii[station, place]))) == together[station, place]


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        ("cup", (0.04, 0.08)),
        ("refined cup", (0.04, 0.081)),
        ("cup from bore", (0.04, 0.081)),
        ("hat", (0.08, 0.12)),
        ("hat with own flange", (0.0795, 0.12)),
    ],
)
def test_disk_radii(shape, expected):
    """A blank inner or outer radius of the disk is the mean radius."""
    assert tuple(map(float, flexspline.disk_radii(SHAPES[shape][1]))) == expected


def test_disk_radius_from_the_bore():
    """The blank outer radius of a cup's disk follows bore and wall."""
    dimensions = without(FROM_BORE, "disk_outer_radius")
    assert flexspline.disk_radii(dimensions) == (0.04, flexspline.radius_of(dimensions))


@pytest.mark.slow
@thorough
@given(cup=cups(), thickness=st.floats(0.1, 0.5))
def test_all_refinements_together_by_quadrature(cup, thickness):
    """A cup with every refinement winds up as quadrature along its whole meridian says, to 1e-6."""
    cup["hub_fillet_radius"] = min(cup["hub_fillet_radius"], 10 * cup["disk_hub_thickness"] * thickness)
    cup["junction_fillet_radius"] = min(cup["junction_fillet_radius"], 10 * cup["wall_thickness"] * thickness)
    assert windup("cup", cup) == pytest.approx(meridian(cup), rel=1e-6)


@pytest.mark.parametrize("hub_thickness", [{}, {"disk_hub_thickness": 0.003}, {"disk_hub_thickness": 0.0016}])
def test_hub_fillet_across_the_whole_disk(hub_thickness):
    """A hub fillet just as wide as the disk, the widest allowed, leaves no disk body and a finite wind-up."""
    cup = B3_160 | hub_thickness
    almost, whole = (cup | {"hub_fillet_radius": 0.04 * part} for part in (1 - 1e-9, 1.0))
    assert windup("cup", whole) == pytest.approx(windup("cup", almost), rel=1e-8)
    arrays = {name: np.full(2, size) for name, size in whole.items()}
    assert flexspline.backlash("cup", arrays) == pytest.approx(2 * windup("cup", almost), rel=1e-8)


@pytest.mark.slow
@thorough
@given(cup=cups(), factor=st.floats(1.0, 1.5))
def test_longer_cylinder_never_winds_up_less(cup, factor):
    """A longer cylinder winds up more, whatever its refinements."""
    longer = cup | {"cylinder_length": cup["cylinder_length"] * factor}
    assert windup("cup", longer) >= windup("cup", cup)


@pytest.mark.slow
@thorough
@given(cup=cups(), factor=st.floats(1.0, 1.5))
def test_thicker_wall_never_winds_up_more(cup, factor):
    """A thicker wall at the same mean radius never winds up more; the rim keeps its own bore and goes first."""
    cup = without(cup, "rim_length", "rim_thickness")
    thicker = cup | {"wall_thickness": cup["wall_thickness"] * factor}
    assert windup("cup", thicker) <= windup("cup", cup)


@thorough
@given(cup=cups(), factor=st.floats(1.0, 1.5))
def test_thicker_wall_over_the_same_bore_never_winds_up_more(cup, factor):
    """A thicker wall over the same bore never winds up more, though the disk then reaches further out."""
    cup = without(cup, "mean_radius", "disk_hub_thickness", "hub_fillet_radius") | {
        "bore_diameter": 2 * cup["mean_radius"] - cup["wall_thickness"],
        "rim_thickness": 1.5 * cup["rim_thickness"],
        "junction_fillet_radius": 0.2 * cup["junction_fillet_radius"],
    }
    thicker = cup | {"wall_thickness": cup["wall_thickness"] * factor}
    assert windup("cup", thicker) <= windup("cup", cup)


@pytest.mark.slow
@thorough
@given(cup=cups(), name=st.sampled_from(["disk_thickness", "disk_hub_thickness", "rim_thickness"]))
def test_other_thicker_walls_never_wind_up_more(cup, name):
    """A thicker disk, hub or rim never winds up more."""
    thickness = cup.get(name, cup["wall_thickness"])
    assert windup("cup", cup | {name: thickness * 1.2}) <= windup("cup", cup | {name: thickness})


@pytest.mark.slow
@thorough
@given(cup=cups(), names=st.sampled_from([REFINEMENTS[1:2], REFINEMENTS[2:3], REFINEMENTS[3:5], REFINEMENTS[1:5]]))
def test_fillets_and_rim_never_add_windup(cup, names):
    """Hub fillet, junction fillet and rim, alone or together, never wind the cup up more than without them."""
    assert windup("cup", cup) <= windup("cup", without(cup, *names)) * (1 + 1e-9)


@thorough
@given(cup=cups())
def test_larger_hub_never_winds_up_more(cup):
    """A larger hub radius leaves less disk and never winds up more."""
    cup = without(cup, "hub_fillet_radius", "disk_hub_thickness")
    larger = cup | {"disk_inner_radius": (cup["disk_inner_radius"] + cup["mean_radius"]) / 2}
    assert windup("cup", larger) <= windup("cup", cup)


@thorough
@given(cup=cups())
def test_disk_adds_to_the_cylinder(cup):
    """A cup winds up more than its cylinder alone, which the classical formula stops at."""
    assert windup("cup", cup) > windup("cylinder", cup)


@pytest.mark.slow
@thorough
@given(cup=cups())
def test_blank_disk_thickness_is_the_wall_thickness(cup):
    """A blank disk thickness gives the same bits as one equal to the wall, and follows the wall's draws."""
    cup = without(cup, "disk_thickness")
    walls = cup["wall_thickness"] * np.linspace(0.9, 1.1, 5)
    blank = flexspline.backlash("cup", cup | {"wall_thickness": walls})
    given_too = flexspline.backlash("cup", cup | {"wall_thickness": walls, "disk_thickness": walls})
    assert np.array_equal(blank, given_too)
    fixed = flexspline.backlash("cup", cup | {"wall_thickness": walls, "disk_thickness": cup["wall_thickness"]})
    assert np.ptp(blank) > np.ptp(fixed)


@pytest.mark.parametrize(
    ("shape", "blank"),
    [("cup", "disk_outer_radius"), ("cup from bore", "disk_outer_radius"), ("hat", "disk_inner_radius")],
)
def test_blank_disk_radius_is_the_mean_radius(shape, blank):
    """A blank disk radius gives the same bits as one equal to the mean radius, also to one from bore and wall."""
    kind, dimensions = SHAPES[shape]
    dimensions = without(dimensions, blank)
    walls = 0.0016 * np.linspace(0.9, 1.1, 5)
    drawn = dimensions | {"wall_thickness": walls}
    if "bore_diameter" not in dimensions:
        drawn |= {"mean_radius": 0.08 * np.linspace(0.99, 1.01, 5)}
    entered = drawn | {blank: flexspline.radius_of(drawn)}
    assert np.array_equal(flexspline.backlash(kind, drawn), flexspline.backlash(kind, entered))


def test_bore_and_wall_set_the_mean_radius():
    """A bore of 160 mm and a wall of 1.6 mm are a mean radius of 80.8 mm; one that is entered stands."""
    assert flexspline.radius_of({"bore_diameter": 0.16, "wall_thickness": 0.0016}) == pytest.approx(0.0808, rel=1e-15)
    assert flexspline.radius_of(B3_160) == 0.08


def test_entered_shear_modulus_replaces_the_elastic_constants():
    """An entered shear modulus is used instead of E and ν."""
    assert flexspline.modulus_of(B3_160 | {"shear_modulus": 8e10}) == 8e10
    assert flexspline.modulus_of(B3_160) == pytest.approx(211e9 / 2.6, rel=1e-15)


def test_hat_flange_reaches_outwards():
    """A hat's flange winds up as the annulus from its mean radius to the bolt circle."""
    disk = flexspline.windups("hat", HAT)["disk_body"]
    annulus = (1 / 0.08**2 - 1 / 0.12**2) / (2 * 0.0016)
    assert disk == pytest.approx(800 / (2 * math.pi * 211e9 / 2.6) * annulus, rel=1e-13)


def test_calibrations_scale_cylinder_and_disk_apart():
    """The cylinder's calibration scales rim, wall and junction fillet, the disk's its body and hub fillet."""
    plain = flexspline.windups("cup", REFINED)
    calibrated = flexspline.windups("cup", REFINED | {"cylinder_calibration": 0.907, "disk_calibration": 0.936})
    for segment, angle in plain.items():
        factor = 0.907 if segment in flexspline.CYLINDER_SEGMENTS else 0.936
        assert calibrated[segment] == pytest.approx(float(angle) * factor, rel=1e-15)
