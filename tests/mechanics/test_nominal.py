"""The nominal numbers of variants: wind-ups, stresses by section, and what material, load and catalogue add."""

import math

import numpy as np
import pytest
from flexsplines import B3_160, CYLINDER, HAT, REFINED, REFINEMENTS, SHAPES, without

from flexlash.mechanics import flexspline, strength, windup
from flexlash.mechanics.nominal import nominal_numbers
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import Variant
from flexlash.schema.variant_arrays import VariantArrays

STEEL = {"youngs_modulus": 211e9, "poisson_ratio": 0.3}


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


def _numbers(variants, share):
    """Return those nominal numbers that each variant has, by name."""
    beside = ("rated_torque", "load_inertia", "radial_deflection", "yield_strength", "youngs_modulus", "poisson_ratio")
    arrays = VariantArrays(
        flexspline_types=[one.flexspline_type for one in variants],
        dimensions={name: _column(one.dimensions.get(name) for one in variants) for name in DIMENSIONS},
        numbers={name: _column(getattr(one, name) for one in variants) for name in beside},
    )
    found = nominal_numbers(arrays, share).iter_rows(named=True)
    return [{key: value for key, value in one.items() if value is not None} for one in found]


def _column(values):
    """Return numbers as an array, NaN for None."""
    return np.array(list(values), dtype=float)


def test_nominal_numbers_of_the_baseline():
    """The nominal numbers of B3-160 hold its wind-ups, stiffness, stresses and the cylinder alone."""
    (numbers,) = _numbers([variant(2)], 0.04)
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
    plain, refined = _numbers(
        [variant(2, dimensions=without(REFINED, *REFINEMENTS)), variant(3, dimensions=REFINED)], 0.04
    )
    assert refined["cylinder_only_backlash"] == plain["cylinder_only_backlash"]
    assert refined["cylinder_only_backlash"] == pytest.approx(2 * plain["cylinder_windup"], rel=1e-14)
    assert refined["cylinder_windup"] < plain["cylinder_windup"]


def test_cylinder_without_disk_has_no_hub_shear():
    """A pin, tooth or jaw connection has no disk wind-up, no disk share and no hub shear."""
    (numbers,) = _numbers([variant(2, "cylinder", CYLINDER)], 0.04)
    assert numbers["disk_windup"] == numbers["disk_share"] == 0
    assert "hub_shear" not in numbers
    assert numbers["von_mises"] == pytest.approx(math.sqrt(3) * numbers["wall_shear"], rel=1e-15)
    assert numbers["backlash"] == pytest.approx(numbers["cylinder_only_backlash"], rel=1e-15)


def test_hub_shear_counts_taper_and_fillet():
    """The hub's shear stress falls with a thicker hub; in a hat it is the flange's at the mean radius."""
    even, tapered, hat = _numbers(
        [variant(2), variant(3, dimensions=B3_160 | {"disk_hub_thickness": 0.0032}), variant(4, "hat", HAT)], 0.04
    )
    assert tapered["hub_shear"] == pytest.approx(even["hub_shear"] / 2, rel=1e-12)
    assert hat["hub_shear"] == pytest.approx(hat["wall_shear"], rel=1e-12)


@pytest.mark.parametrize("share", [0.04, 0.03])
def test_lost_motion_at_a_share_of_the_rated_torque(share):
    """Lost motion is 2U at a few per cent of the rated torque, and absent without a rated torque."""
    without_rated, with_rated = _numbers([variant(2), variant(3, rated_torque=1600.0)], share)
    assert "lost_motion" not in without_rated
    assert "drive_lost_motion" not in without_rated
    assert with_rated["drive_lost_motion"] == pytest.approx(2 * share * 1600 / 440_000, rel=1e-12)
    assert with_rated["lost_motion"] == pytest.approx(1.0725044299e-3 * 2 * share, rel=5e-11)


def test_other_rows_do_not_matter():
    """A variant's nominal numbers are the same bits alone, among others and in any order."""
    rows = [variant(place, kind, dimensions) for place, (kind, dimensions) in enumerate(SHAPES.values())]
    rows += [variant(20, dimensions=REFINED | {"torque": 900.0}), variant(21, dimensions=B3_160 | {"torque": 700.0})]
    together = _numbers(rows, 0.04)
    assert _numbers(rows[::-1], 0.04) == together[::-1]
    assert [_numbers([row], 0.04)[0] for row in rows] == together
    assert _numbers([], 0.04) == []


def numbers_of(kind="cup", dimensions=B3_160, **rest):
    """Return the nominal numbers of one variant of these dimensions."""
    (numbers,) = _numbers([variant(2, kind, dimensions, **rest)], 0.04)
    return numbers


@pytest.mark.parametrize("shape", SHAPES)
def test_two_term_backlash_is_the_published_formula(shape):
    """The two-term backlash is that of plain wall and even disk, whatever refinements and calibrations there are."""
    kind, dimensions = SHAPES[shape]
    numbers = numbers_of(kind, dimensions | {"cylinder_calibration": 0.9, "disk_calibration": 1.2})
    mean, wall = float(flexspline.radius_of(dimensions)), dimensions["wall_thickness"]
    integral = dimensions["cylinder_length"] / (mean**3 * wall)
    if kind != "cylinder":
        inner, outer = (dimensions.get(f"disk_{end}_radius", mean) for end in ("inner", "outer"))
        thickness = dimensions.get("disk_thickness", wall)
        if "disk_thickness_exponent" in dimensions:
            power = (inner / outer) ** dimensions["disk_thickness_exponent"]
            thickness = dimensions["disk_hub_thickness"] * power
        integral += (1 / inner**2 - 1 / outer**2) / (2 * thickness)
    assert numbers["two_term_backlash"] == pytest.approx(800 / (math.pi * 211e9 / 2.6) * integral, rel=1e-13)


def test_two_term_backlash_of_a_plain_cup_is_its_backlash():
    """Without refinements nothing is left out of the two-term backlash."""
    numbers = numbers_of()
    assert numbers["two_term_backlash"] == pytest.approx(numbers["backlash"], rel=1e-15)
    refined = numbers_of(dimensions=REFINED)
    assert refined["two_term_backlash"] > refined["backlash"]
    assert numbers_of("cylinder", CYLINDER)["two_term_backlash"] == numbers["cylinder_only_backlash"]


@pytest.mark.parametrize(
    ("kind", "changes", "section"),
    [
        ("cup", {}, "disk"),
        ("cup", {"disk_thickness": 0.0016 * 4 * 0.999}, "disk"),
        ("cup", {"disk_thickness": 0.0016 * 4 * 1.001}, "wall"),
        ("cup", {"rim_length": 0.02, "rim_thickness": 0.0032}, "disk"),
        ("cup", {"disk_hub_thickness": 0.008, "disk_thickness": 0.001}, "disk"),
        ("hat", {"disk_thickness": 0.002}, "wall"),
        ("hat", {"disk_thickness": 0.0015}, "disk"),
        ("cylinder", {}, "wall"),
        ("cylinder", {"rim_length": 0.02, "rim_thickness": 0.0032}, "wall"),
        ("cylinder", {"rim_length": 0.02, "rim_thickness": 0.0015}, "tooth rim"),
        ("cup", {"disk_thickness": 0.008, "rim_length": 0.02, "rim_thickness": 0.0015}, "tooth rim"),
    ],
)
def test_governing_section(kind, changes, section):
    """Wall, tooth rim or disk governs, whichever has the greatest stress, which is the von Mises stress told."""
    numbers = numbers_of(kind, {"cup": B3_160, "hat": HAT, "cylinder": CYLINDER}[kind] | changes)
    assert numbers["governing_section"] == section
    key = {"wall": "wall", "tooth rim": "rim", "disk": "hub"}[section]
    stresses = {one: numbers[f"{one}_von_mises"] for one in ("wall", "rim", "hub") if f"{one}_von_mises" in numbers}
    assert numbers["von_mises"] == max(stresses.values()) == stresses[key]


def test_von_mises_of_each_section():
    """Each section that a variant has its shear stress, √3 times it as von Mises stress, and the disk its radius."""
    numbers = numbers_of(dimensions=REFINED)
    for section in ("wall", "rim", "hub"):
        expected = math.sqrt(3) * numbers[f"{section}_shear"]
        assert numbers[f"{section}_von_mises"] == pytest.approx(expected, rel=1e-15)
    # The rim of 3.2 mm has the bore of the wall of 1.6 mm, so its middle lies 0.8 mm further out.
    assert numbers["rim_shear"] == pytest.approx(800 / (2 * math.pi * 0.0816**2 * 0.0032), rel=1e-14)
    assert numbers["wall_shear"] == pytest.approx(800 / (2 * math.pi * 0.0808**2 * 0.0016), rel=1e-14)
    assert 0.04 < numbers["hub_shear_radius"] <= 0.081
    assert numbers_of()["hub_shear_radius"] == 0.04
    assert not {"rim_shear", "rim_von_mises"} & set(numbers_of())
    assert not {"hub_shear", "hub_von_mises", "hub_shear_radius"} & set(numbers_of("cylinder", CYLINDER))


def test_hub_shear_of_a_constant_shear_disk():
    """A disk that thins as 1/r² from 4 mm has the hub shear of 4 mm at 40 mm."""
    numbers = numbers_of(dimensions=B3_160 | {"disk_hub_thickness": 0.004, "disk_thickness_exponent": 2.0})
    assert numbers["hub_shear"] == pytest.approx(800 / (2 * math.pi * 0.04**2 * 0.004), rel=1e-13)


def test_a_cone_is_stressed_as_its_flat_disk():
    """The ring of a cone has the thickness normal to it, so its shear stress is that of the flat disk."""
    flat, cone = numbers_of(), numbers_of(dimensions=B3_160 | {"disk_cone_angle": math.radians(45)})
    assert {key: cone[key] for key in flat if "shear" in key} == {key: flat[key] for key in flat if "shear" in key}
    assert cone["disk_windup"] == pytest.approx(flat["disk_windup"] * math.sqrt(2), rel=1e-14)


def test_elastic_limit_torque_only_with_a_yield_strength():
    """B3-160 of 1080 MPa yields from 10030 N·m on; without a yield strength nothing is said."""
    assert "elastic_limit_torque" not in numbers_of()
    numbers = numbers_of(yield_strength=1080e6)
    assert numbers["elastic_limit_torque"] == pytest.approx(10_030, abs=0.5)
    assert numbers["elastic_limit_torque"] == pytest.approx(800 * 1080e6 / numbers["von_mises"], rel=1e-14)


@pytest.mark.parametrize("constants", [{}, {"youngs_modulus": 211e9}, {"poisson_ratio": 0.3}])
def test_buckling_asks_for_young_and_poisson(constants):
    """Without both E and ν of the material nothing is said about buckling."""
    assert not {"buckling_shear", "buckling_range"} & set(numbers_of(**constants))


@pytest.mark.parametrize("kind", ["cup", "hat", "cylinder"])
def test_buckling_of_the_published_case(kind):
    """B3-160 buckles at 561.6 MPa, as a hat and as a cylinder too."""
    numbers = numbers_of(kind, {"cup": B3_160, "hat": HAT, "cylinder": CYLINDER}[kind], **STEEL)
    assert numbers["buckling_shear"] / 1e6 == pytest.approx(561.6, abs=0.05)
    assert numbers["buckling_range"] == "yes"


def test_buckling_takes_young_and_poisson_where_the_shear_modulus_is_given():
    """A shear modulus replaces E and ν in the wind-up, while buckling keeps those of the material."""
    given_modulus = without(B3_160, "youngs_modulus", "poisson_ratio") | {"shear_modulus": 60e9}
    numbers = numbers_of(dimensions=given_modulus, youngs_modulus=422e9, poisson_ratio=0.3)
    assert numbers["buckling_shear"] / 1e6 == pytest.approx(2 * 561.6, abs=0.1)
    assert numbers["windup"] == pytest.approx(numbers_of()["windup"] * 211 / 2.6 / 60, rel=1e-14)
    assert "buckling_shear" not in numbers_of(dimensions=given_modulus)


@pytest.mark.parametrize(("length", "word"), [(0.05, "shorter"), (0.16, "yes"), (3.6, "yes"), (3.7, "longer")])
def test_buckling_range_in_words(length, word):
    """A cylinder that is too short for the buckling formula, or too long, is told."""
    assert numbers_of(dimensions=B3_160 | {"cylinder_length": length}, **STEEL)["buckling_range"] == word


def test_buckling_follows_the_bore():
    """The mean radius that buckles is that of bore and wall."""
    dimensions = without(B3_160, "mean_radius") | {"bore_diameter": 0.16}
    expected = strength.buckling_shear(211e9, 0.0808, 0.0016, 0.16)
    assert numbers_of(dimensions=dimensions, **STEEL)["buckling_shear"] == pytest.approx(float(expected), rel=1e-14)


def test_vibration_only_with_an_inertia():
    """A load of 1 kg·m² on B3-160 swings at 194.39 Hz, met at 5832 rpm; without an inertia nothing is said."""
    assert not {"natural_frequency", "resonance_speed"} & set(numbers_of())
    numbers = numbers_of(load_inertia=1.0)
    assert numbers["natural_frequency"] == pytest.approx(194.39, abs=0.005)
    assert numbers["resonance_speed"] * 30 / math.pi == pytest.approx(5832, abs=0.5)
    assert numbers["resonance_speed"] == pytest.approx(math.pi * numbers["natural_frequency"], rel=1e-15)
    assert numbers_of(load_inertia=4.0)["natural_frequency"] == numbers["natural_frequency"] / 2


BENDING = {"bending_stress", "rim_bending_stress", "alternating_stress", "combined_stress"}


def test_bending_only_with_a_deflection_and_elastic_constants():
    """A wall of 1.6 mm at 80 mm that is pressed out by 0.5 mm is bent to 43 MPa; without w₀, E or ν nothing is said."""
    assert not BENDING & set(numbers_of(**STEEL))
    assert not BENDING & set(numbers_of(radial_deflection=5e-4))
    numbers = numbers_of(radial_deflection=5e-4, **STEEL)
    bent = 1.5 * 211e9 * 0.0016 * 5e-4 / (0.08**2 * 0.91)
    assert numbers["bending_stress"] == pytest.approx(bent, rel=1e-14)
    assert numbers["alternating_stress"] == pytest.approx(bent * math.sqrt(0.79), rel=1e-14)
    whole = math.hypot(numbers["alternating_stress"], numbers["wall_von_mises"])
    assert numbers["combined_stress"] == pytest.approx(whole, rel=1e-14)
    assert "rim_bending_stress" not in numbers


def test_bending_of_a_rim_beside_its_wall():
    """A rim twice as thick is bent nearly twice as much, and carries less torsion: each is combined with its own."""
    numbers = numbers_of(dimensions=REFINED, radial_deflection=5e-4, **STEEL)
    bent = numbers["bending_stress"], numbers["rim_bending_stress"]
    assert bent[1] == pytest.approx(bent[0] * 2 * (0.0808 / 0.0816) ** 2, rel=1e-12)
    alternating = [stress * math.sqrt(0.79) for stress in bent]
    assert numbers["alternating_stress"] == pytest.approx(max(alternating), rel=1e-14)
    torsion = numbers["wall_von_mises"], numbers["rim_von_mises"]
    whole = max(map(math.hypot, alternating, torsion))
    assert numbers["combined_stress"] == pytest.approx(whole, rel=1e-14)
    twisted = numbers_of(dimensions=REFINED | {"torque": 1e5}, radial_deflection=5e-4, **STEEL)
    wall = math.hypot(alternating[0], twisted["wall_von_mises"])
    assert twisted["combined_stress"] == pytest.approx(wall, rel=1e-14)


def test_tooth_face_in_the_nominal_numbers():
    """A tooth face takes off the wind-up and is told as a segment; two-term and cylinder-only formula know none."""
    plain, faced = numbers_of(), numbers_of(dimensions=B3_160 | {"tooth_face_width": 0.03})
    assert "tooth_band_windup" not in plain
    third = plain["wall_windup"] * 0.03 / 0.16 / 3
    assert faced["tooth_band_windup"] == pytest.approx(third, rel=1e-12)
    assert faced["cylinder_windup"] == pytest.approx(plain["cylinder_windup"] - 2 * third, rel=1e-12)
    for name in ("two_term_backlash", "cylinder_only_backlash", "disk_windup", "von_mises"):
        assert faced[name] == plain[name]


@pytest.mark.parametrize(
    ("kind", "dimensions", "expected"),
    [
        ("cup", B3_160, (65.0, 780_000.0)),
        ("hat", HAT, (65.0, 780_000.0)),
        ("cup", without(B3_160, "mean_radius") | {"bore_diameter": 0.045}, (17.0, 6700.0)),
        ("cup", B3_160 | {"mean_radius": 0.2}, None),
        ("cylinder", CYLINDER, None),
    ],
)
def test_catalogue(kind, dimensions, expected):
    """Cups and hats have a nearest catalogue size and its stiffness, if listed; a cylinder alone is no drive."""
    numbers = numbers_of(kind, dimensions)
    found = (numbers["catalogue_size"], numbers["catalogue_stiffness"]) if "catalogue_size" in numbers else None
    assert found == expected
    assert ("catalogue_stiffness" in numbers) == (expected is not None)


def test_wall_ratio():
    """The wall ratio is the wall over the mean radius, also over that of a bore."""
    assert numbers_of()["wall_ratio"] == pytest.approx(0.02, rel=1e-15)
    bore = without(B3_160, "mean_radius") | {"bore_diameter": 0.1584}
    assert numbers_of(dimensions=bore)["wall_ratio"] == pytest.approx(0.02, rel=1e-15)


def test_cylinder_only_and_plain_wall_agree_with_the_segment():
    """The cylinder alone is twice the wind-up of its plain wall."""
    integral = windup.wall_integral(0.16, 0.08, 0.0016)
    exact = 2 * float(windup.segment_windup(800.0, 211e9 / 2.6, integral))
    assert numbers_of()["cylinder_only_backlash"] == pytest.approx(exact, rel=1e-15)


@pytest.mark.parametrize(
    ("name", "size"), [("wall_thickness", 1e-320), ("shear_modulus", 1e-320), ("torque", 1e-320), ("torque", 1e308)]
)
def test_absurd_dimensions_give_numbers_all_the_same(name, size):
    """Dimensions that no part has give infinite numbers or NaN, and neither an exception nor a warning."""
    absurd = B3_160 | {name: size}
    numbers = numbers_of(dimensions=absurd, rated_torque=1600.0, load_inertia=1.0, yield_strength=1080e6, **STEEL)
    assert all(isinstance(value, float | str) for value in numbers.values())
    assert {"lost_motion", "natural_frequency", "elastic_limit_torque", "buckling_shear"} <= set(numbers)


def test_material_load_and_requirements_do_not_mix_between_rows():
    """Rows of one shape that differ in what stands beside their dimensions keep it apart, in any order."""
    rows = [
        variant(2, **STEEL),
        variant(3, rated_torque=1600.0),
        variant(4, load_inertia=2.0, yield_strength=900e6),
        variant(5, **STEEL | {"youngs_modulus": 100e9}, load_inertia=1.0),
        variant(6, **STEEL, radial_deflection=5e-4),
    ]
    together = _numbers(rows, 0.04)
    assert [_numbers([row], 0.04)[0] for row in rows] == together
    assert _numbers(rows[::-1], 0.04) == together[::-1]
    assert len({frozenset(numbers) for numbers in together}) == 5
