"""The whole flexspline: which segments it has, what it shares, and how its wind-up answers to its dimensions."""

import importlib
import inspect
import math
import pkgutil
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

import flexlash.mechanics
from flexlash.mechanics import flexspline
from flexlash.mechanics.nominal import nominal_numbers
from flexlash.variant import Variant

thorough = settings(deadline=None, max_examples=80, derandomize=True)

REFINEMENTS = (
    "disk_hub_thickness",
    "hub_fillet_radius",
    "junction_fillet_radius",
    "rim_length",
    "rim_thickness",
)
B3_160 = {
    "torque": 800.0,
    "cylinder_length": 0.16,
    "mean_radius": 0.08,
    "wall_thickness": 0.0016,
    "disk_inner_radius": 0.04,
    "youngs_modulus": 211e9,
    "poisson_ratio": 0.3,
}
REFINED = B3_160 | {
    "mean_radius": 0.0808,
    "disk_thickness": 0.0018,
    "disk_outer_radius": 0.081,
    "disk_hub_thickness": 0.003,
    "hub_fillet_radius": 0.0035,
    "junction_fillet_radius": 0.003,
    "rim_length": 0.02,
    "rim_thickness": 0.0032,
}
HAT = {name: size for name, size in B3_160.items() if name != "disk_inner_radius"} | {"disk_outer_radius": 0.12}
CYLINDER = {name: size for name, size in B3_160.items() if name != "disk_inner_radius"}
FROM_BORE = {name: size for name, size in REFINED.items() if name != "mean_radius"} | {"bore_diameter": 0.16}

SHAPES = {
    "cup": ("cup", B3_160),
    "refined cup": ("cup", REFINED),
    "cup from bore": ("cup", FROM_BORE),
    "hat": ("hat", HAT),
    "hat with own flange": ("hat", HAT | {"disk_thickness": 0.002, "disk_inner_radius": 0.0795}),
    "cylinder": ("cylinder", CYLINDER),
    "cylinder with rim": ("cylinder", CYLINDER | {"rim_length": 0.02, "rim_thickness": 0.0032}),
}
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


def without(dimensions, *names):
    """Return dimensions without some of them."""
    return {name: size for name, size in dimensions.items() if name not in names}


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
    """Return the public functions of all modules in mechanics by qualified name."""
    found = {}
    for module in pkgutil.iter_modules(flexlash.mechanics.__path__):
        loaded = importlib.import_module(f"flexlash.mechanics.{module.name}")
        for name in loaded.__all__:
            one = getattr(loaded, name)
            if inspect.isfunction(one):
                found[f"{module.name}.{name}"] = one
    return found


PUBLIC = public_functions()


def test_public_functions_are_found():
    """The mechanics offer functions in windup, flexspline and strength."""
    assert {name.partition(".")[0] for name in PUBLIC} >= {"windup", "flexspline", "strength"}
    assert len(PUBLIC) >= 16


@pytest.mark.parametrize("name", PUBLIC)
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
    assert all(angle > 0 for angle in angles.values())
    assert flexspline.backlash(kind, dimensions) == pytest.approx(2 * sum(map(float, angles.values())), rel=1e-14)


@thorough
@given(cup=cups(refined=False))
def test_without_refinements_it_is_the_two_term_formula(cup):
    """A cup without refinements has the two-term wind-up to 1e-12."""
    assert windup("cup", cup) == pytest.approx(two_term(cup), rel=1e-12)


@thorough
@given(cup=cups(refined=False), rim=st.floats(0.01, 0.99))
def test_neutral_refinements_change_nothing(cup, rim):
    """Even hub thickness, fillets of 0 and a rim as thick as the wall leave the two-term wind-up to 1e-12."""
    neutral = {
        "disk_hub_thickness": cup.get("disk_thickness", cup["wall_thickness"]),
        "hub_fillet_radius": 0.0,
        "junction_fillet_radius": 0.0,
        "rim_length": rim * cup["cylinder_length"],
        "rim_thickness": cup["wall_thickness"],
    }
    assert windup("cup", cup | neutral) == pytest.approx(two_term(cup), rel=1e-12)


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


@thorough
@given(cup=cups(), factor=st.floats(1.0, 1.5))
def test_longer_cylinder_never_winds_up_less(cup, factor):
    """A longer cylinder winds up more, whatever its refinements."""
    longer = cup | {"cylinder_length": cup["cylinder_length"] * factor}
    assert windup("cup", longer) >= windup("cup", cup)


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


@thorough
@given(cup=cups(), name=st.sampled_from(["disk_thickness", "disk_hub_thickness", "rim_thickness"]))
def test_other_thicker_walls_never_wind_up_more(cup, name):
    """A thicker disk, hub or rim never winds up more."""
    thickness = cup.get(name, cup["wall_thickness"])
    assert windup("cup", cup | {name: thickness * 1.2}) <= windup("cup", cup | {name: thickness})


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


def variant(row, kind="cup", dimensions=B3_160, **rest):
    """Return a variant of these dimensions."""
    return Variant(
        row=row,
        name=f"variant {row}",
        flexspline_type=kind,
        material="20Cr2Ni4",
        tolerance_class="standard",
        dimensions=dict(dimensions),
        **rest,
    )


def test_nominal_numbers_of_the_baseline():
    """The nominal numbers of B3-160 hold its wind-ups, stiffness, stresses and the cylinder alone."""
    (numbers,) = nominal_numbers([variant(2)], 0.04)
    assert numbers["cylinder_windup"] == pytest.approx(3.0642983711e-4, rel=5e-11)
    assert numbers["disk_windup"] == pytest.approx(2.2982237784e-4, rel=5e-11)
    assert numbers["windup"] == pytest.approx(1.0725044299e-3 / 2, rel=5e-11)
    assert numbers["backlash"] == pytest.approx(1.0725044299e-3, rel=5e-11)
    assert numbers["disk_share"] == pytest.approx(3 / 7, rel=1e-14)
    assert numbers["cylinder_only_backlash"] == pytest.approx(2 * 3.0642983711e-4, rel=5e-11)
    assert numbers["stiffness"] == pytest.approx(1.491835e6, rel=4e-7)
    assert numbers["wall_shear"] == pytest.approx(12.434e6, rel=5e-5)
    assert numbers["hub_shear"] == pytest.approx(49.736e6, rel=5e-5)
    assert numbers["von_mises"] == pytest.approx(86.145e6, rel=5e-5)
    assert "lost_motion" not in numbers


def test_cylinder_only_backlash_leaves_refinements_out():
    """The classical formula's backlash counts the plain wall alone, whatever rim and fillet the cup has."""
    plain, refined = nominal_numbers(
        [variant(2, dimensions=without(REFINED, *REFINEMENTS)), variant(3, dimensions=REFINED)], 0.04
    )
    assert refined["cylinder_only_backlash"] == plain["cylinder_only_backlash"]
    assert refined["cylinder_only_backlash"] == pytest.approx(2 * plain["cylinder_windup"], rel=1e-14)
    assert refined["cylinder_windup"] < plain["cylinder_windup"]


def test_cylinder_without_disk_has_no_hub_shear():
    """A pin, tooth or jaw connection has no disk wind-up, no disk share and no hub shear."""
    (numbers,) = nominal_numbers([variant(2, "cylinder", CYLINDER)], 0.04)
    assert numbers["disk_windup"] == numbers["disk_share"] == 0
    assert "hub_shear" not in numbers
    assert numbers["von_mises"] == pytest.approx(math.sqrt(3) * numbers["wall_shear"], rel=1e-15)
    assert numbers["backlash"] == pytest.approx(numbers["cylinder_only_backlash"], rel=1e-15)


def test_hub_shear_counts_taper_and_fillet():
    """The hub's shear stress falls with a thicker hub; in a hat it is the flange's at the mean radius."""
    even, tapered, hat = nominal_numbers(
        [variant(2), variant(3, dimensions=B3_160 | {"disk_hub_thickness": 0.0032}), variant(4, "hat", HAT)], 0.04
    )
    assert tapered["hub_shear"] == pytest.approx(even["hub_shear"] / 2, rel=1e-12)
    assert hat["hub_shear"] == pytest.approx(hat["wall_shear"], rel=1e-12)


@pytest.mark.parametrize("share", [0.04, 0.03])
def test_lost_motion_at_a_share_of_the_rated_torque(share):
    """Lost motion is 2U at a few per cent of the rated torque, and absent without a rated torque."""
    without_rated, with_rated = nominal_numbers([variant(2), variant(3, rated_torque=1600.0)], share)
    assert "lost_motion" not in without_rated
    assert with_rated["lost_motion"] == pytest.approx(1.0725044299e-3 * 2 * share, rel=5e-11)


def test_other_rows_do_not_matter():
    """A variant's nominal numbers are the same bits alone, among others and in any order."""
    rows = [variant(place, kind, dimensions) for place, (kind, dimensions) in enumerate(SHAPES.values())]
    rows += [variant(20, dimensions=REFINED | {"torque": 900.0}), variant(21, dimensions=B3_160 | {"torque": 700.0})]
    together = nominal_numbers(rows, 0.04)
    assert nominal_numbers(rows[::-1], 0.04) == together[::-1]
    assert [nominal_numbers([row], 0.04)[0] for row in rows] == together
    assert nominal_numbers([], 0.04) == []
