"""The published B3-160 flexspline: steel 20Cr2Ni4, 800 N·m, wall and disk 1.6 mm, hub radius 40 mm.

Source: the B3-160 article on backlash from torsional deformation, each printed number recomputed with more
than thirty digits. The article's slips are listed at the end, each with a test that flexlash leaves it
behind. Expected numbers are typed in, or come from `two_term` below, a slow twin in exact fractions.
"""

import csv
import math
from fractions import Fraction
from pathlib import Path

import pytest

from flexlash.mechanics import windup
from flexlash.mechanics.flexspline import CYLINDER_SEGMENTS, DISK_SEGMENTS, backlash, windups
from flexlash.pipeline import run
from flexlash.schema.columns import VARIANTS

PRINTED_MODULUS = 8.10769e10
BASELINE = {
    "torque": 800.0,
    "cylinder_length": 0.160,
    "mean_radius": 0.080,
    "wall_thickness": 0.0016,
    "disk_inner_radius": 0.040,
    "youngs_modulus": 211e9,
    "poisson_ratio": 0.3,
}
SUBMITTED = {
    "variant": "B3-160",
    "material": "20Cr2Ni4",
    "torque_Nm": "800",
    "cylinder_length_mm": "160",
    "mean_radius_mm": "80",
    "wall_thickness_mm": "1.6",
    "disk_inner_radius_mm": "40",
}

# case, l mm, r_co mm, U_cyl 1e-4, U_disk 1e-4, 2U 1e-3, disk share with r_m = r_co
CASES_MEAN_RADIUS_FOLLOWS = [
    (1, 160, 80, 3.0642984, 2.2982238, 1.0725044, Fraction(3, 7)),
    (2, 100, 80, 1.9151865, 2.2982238, 0.8426821, Fraction(6, 11)),
    (3, 200, 80, 3.8303730, 2.2982238, 1.2257193, Fraction(3, 8)),
    (4, 160, 100, 1.5689208, 2.5740106, 0.8285863, Fraction(105, 169)),
    (5, 160, 60, 7.2635221, 1.7023880, 1.7931820, Fraction(15, 79)),
]
# case, r_co mm, 2U 1e-3, disk share with r_m left at 80 mm
CASES_MEAN_RADIUS_STAYS = [
    (4, 100, 1.1276618, 0.456522),
    (5, 60, 0.9533373, 0.357143),
]


def two_term(length_mm, mean_radius_mm, outer_radius_mm):
    """Return the integrals of cylinder and disk [1/m³] as exact fractions of the baseline's dimensions."""
    wall, inner = Fraction(16, 10_000), Fraction(40, 1000)
    length, mean, outer = (Fraction(size) / 1000 for size in (length_mm, mean_radius_mm, outer_radius_mm))
    return length / (mean**3 * wall), (1 / inner**2 - 1 / outer**2) / (2 * wall)


def in_radians(integral):
    """Return the angle [rad] of an integral at the baseline's torque, E and ν."""
    return 800 / (2 * math.pi * (211e9 / 2.6)) * float(integral)


def parts(dimensions):
    """Return cylinder and disk wind-up [rad] by flexlash."""
    angles = windups("cup", dimensions)
    return tuple(
        sum(float(angle) for segment, angle in angles.items() if segment in section)
        for section in (CYLINDER_SEGMENTS, DISK_SEGMENTS)
    )


def results(folder, *rows, **options):
    """Submit rows as CSV, headed by the keys of the Variants columns, and return the Results as dicts."""
    path = folder / "study.csv"
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, [column.key for column in VARIANTS])
        table.writeheader()
        table.writerows(rows)
    return run(path, output=None, samples=64, **options).results.to_dicts()


def printed(value, expected, digits):
    """Whether a value agrees with one printed to so many significant digits."""
    half = 0.5 * 10 ** (math.floor(math.log10(abs(expected))) - digits + 1)
    return abs(value - expected) <= half * (1 + 1e-9)


def test_shear_modulus_follows_from_the_elastic_constants():
    """The shear modulus of 20Cr2Ni4 is E/(2(1 + ν)) = 8.1153846154e10 Pa."""
    assert printed(float(windup.shear_modulus(211e9, 0.3)), 8.1153846154e10, 11)


def test_baseline_cylinder_windup():
    """The cylinder of the baseline winds up by 3.0642983711e-4 rad."""
    assert printed(parts(BASELINE)[0], 3.0642983711e-4, 11)


def test_baseline_disk_windup():
    """The disk of the baseline winds up by 2.2982237784e-4 rad."""
    assert printed(parts(BASELINE)[1], 2.2982237784e-4, 11)


def test_baseline_backlash():
    """The baseline's backlash from torsional deformation is 1.0725044299e-3 rad."""
    assert printed(float(backlash("cup", BASELINE)), 1.0725044299e-3, 11)


def test_baseline_disk_share_is_three_sevenths():
    """Exactly 3/7 of the baseline's wind-up is the disk's, the part that the classical formula leaves out."""
    cylinder, disk = parts(BASELINE)
    assert disk / (cylinder + disk) == pytest.approx(3 / 7, rel=1e-14)
    exact_cylinder, exact_disk = two_term(160, 80, 80)
    assert exact_disk / (exact_cylinder + exact_disk) == Fraction(3, 7)


@pytest.mark.parametrize(
    ("key", "expected", "digits"),
    [
        ("cylinder_windup_rad", 3.0642983711e-4, 11),
        ("disk_windup_rad", 2.2982237784e-4, 11),
        ("windup_rad", 1.0725044299e-3 / 2, 10),
        ("backlash_rad", 1.0725044299e-3, 11),
        ("backlash_arcmin", 3.6869986, 8),
        ("backlash_arcsec", 221.219918, 9),
        ("disk_share", 3 / 7, 14),
        ("cylinder_only_backlash_arcmin", 2 * 3.0642983711e-4 * 60 * 180 / math.pi, 10),
        ("stiffness_Nm_per_rad", 1.491835e6, 7),
        ("stiffness_Nm_per_arcmin", 433.957, 6),
        ("wall_shear_MPa", 12.434, 5),
        ("hub_shear_MPa", 49.736, 5),
        ("von_mises_MPa", 86.145, 5),
    ],
)
def test_baseline_submitted_as_csv(tmp_path, key, expected, digits):
    """The Results of the baseline submitted as CSV show the article's case to every digit given."""
    (row,) = results(tmp_path, SUBMITTED)
    assert row["status"] == "ok"
    assert printed(row[key], expected, digits)


def test_printed_modulus_gives_the_second_column(tmp_path):
    """With the printed G = 8.10769e10 Pa the wind-ups are 3.06721e-4, 2.30040e-4 and 2U 1.07352e-3 rad."""
    materials = tmp_path / "materials.csv"
    materials.write_text(f"material,shear_modulus_GPa\n20Cr2Ni4,{PRINTED_MODULUS / 1e9!r}\n", encoding="utf-8")
    (row,) = results(tmp_path, SUBMITTED, materials=materials)
    dimensions = {name: size for name, size in BASELINE.items() if name not in {"youngs_modulus", "poisson_ratio"}}
    cylinder, disk = parts(dimensions | {"shear_modulus": PRINTED_MODULUS})
    for first, second, third in (
        (cylinder, disk, 2 * (cylinder + disk)),
        (row["cylinder_windup_rad"], row["disk_windup_rad"], row["backlash_rad"]),
    ):
        assert printed(first, 3.06721e-4, 6)
        assert printed(second, 2.30040e-4, 6)
        assert printed(third, 1.07352e-3, 6)


def test_true_mean_radius(tmp_path):
    """At the true mean radius 80.8 mm the backlash is 1.0574992567e-3 rad or 218.124879″, share 0.4375."""
    dimensions = BASELINE | {"mean_radius": 0.0808}
    cylinder, disk = parts(dimensions)
    assert printed(float(backlash("cup", dimensions)), 1.0574992567e-3, 11)
    assert printed(disk / (cylinder + disk), 0.43750735, 8)
    (row,) = results(tmp_path, SUBMITTED | {"mean_radius_mm": "80.8"})
    assert printed(row["backlash_rad"], 1.0574992567e-3, 11)
    assert printed(row["backlash_arcsec"], 218.124879, 9)
    assert printed(row["disk_share"], 0.43750735, 8)


def test_bore_of_160_mm_means_a_mean_radius_of_80_8_mm(tmp_path):
    """A bore of 160 mm and a wall of 1.6 mm submitted together give the backlash of r_m = 80.8 mm."""
    from_bore, from_radius = results(
        tmp_path,
        SUBMITTED | {"variant": "bore", "mean_radius_mm": "", "bore_diameter_mm": "160"},
        SUBMITTED | {"variant": "radius", "mean_radius_mm": "80.8"},
    )
    assert from_bore["backlash_rad"] == pytest.approx(from_radius["backlash_rad"], rel=1e-14)
    assert printed(from_bore["backlash_rad"], 1.0574992567e-3, 11)


@pytest.mark.parametrize("case", CASES_MEAN_RADIUS_FOLLOWS)
def test_parametric_study_with_mean_radius_at_the_disk_rim(case):
    """Each case with r_m = r_co has the tabulated wind-ups and the tabulated fraction as disk share."""
    _, length, radius, cylinder, disk, total, share = case
    found = parts(BASELINE | {"cylinder_length": length / 1000, "mean_radius": radius / 1000})
    exact = two_term(length, radius, radius)
    assert found == pytest.approx([in_radians(one) for one in exact], rel=1e-13)
    assert printed(found[0] * 1e4, cylinder, 8)
    assert printed(found[1] * 1e4, disk, 8)
    assert printed(2 * sum(found) * 1e3, total, 8 if total > 1 else 7)
    assert exact[1] / sum(exact) == share
    assert found[1] / sum(found) == pytest.approx(float(share), rel=1e-13)


@pytest.mark.parametrize(("case", "radius", "total", "share"), CASES_MEAN_RADIUS_STAYS)
def test_parametric_study_with_mean_radius_left_at_80_mm(case, radius, total, share):
    """Cases 4 and 5 with r_m left at 80 mm have the tabulated backlash and disk share."""
    found = parts(BASELINE | {"disk_outer_radius": radius / 1000})
    exact = two_term(160, 80, radius)
    assert found == pytest.approx([in_radians(one) for one in exact], rel=1e-13), case
    assert printed(2 * sum(found) * 1e3, total, 8 if total > 1 else 7)
    assert printed(found[1] / sum(found), share, 6)


def test_parametric_study_submitted_as_csv(tmp_path):
    """The five cases in both readings, submitted in one CSV, come back in order with their numbers."""
    follows = [
        SUBMITTED | {"variant": f"{case}", "cylinder_length_mm": f"{length}", "mean_radius_mm": f"{radius}"}
        for case, length, radius, *_ in CASES_MEAN_RADIUS_FOLLOWS
    ]
    stays = [
        SUBMITTED | {"variant": f"{case} stays", "disk_outer_radius_mm": f"{radius}"}
        for case, radius, *_ in CASES_MEAN_RADIUS_STAYS
    ]
    rows = results(tmp_path, *follows, *stays)
    assert [row["variant"] for row in rows] == ["1", "2", "3", "4", "5", "4 stays", "5 stays"]
    for row, (*_, cylinder, disk, total, share) in zip(rows[:5], CASES_MEAN_RADIUS_FOLLOWS, strict=True):
        assert row["status"] != "error"
        assert printed(row["cylinder_windup_rad"] * 1e4, cylinder, 8)
        assert printed(row["disk_windup_rad"] * 1e4, disk, 8)
        assert printed(row["backlash_rad"] * 1e3, total, 8 if total > 1 else 7)
        assert row["disk_share"] == pytest.approx(float(share), rel=1e-13)
    for row, (_, _, total, share) in zip(rows[5:], CASES_MEAN_RADIUS_STAYS, strict=True):
        assert row["status"] == "warning"
        assert printed(row["backlash_rad"] * 1e3, total, 8 if total > 1 else 7)
        assert printed(row["disk_share"], share, 6)


@pytest.mark.parametrize(
    ("together", "expected"),
    [
        (("torque",), 1),
        (("cylinder_length",), Fraction(4, 7)),
        (("wall_thickness",), Fraction(-4, 7)),
        (("disk_thickness",), Fraction(-3, 7)),
        (("wall_thickness", "disk_thickness"), -1),
        (("disk_inner_radius",), Fraction(-8, 7)),
        (("mean_radius", "disk_outer_radius"), Fraction(-10, 7)),
        (("mean_radius",), Fraction(-12, 7)),
        (("disk_outer_radius",), Fraction(2, 7)),
        (("youngs_modulus",), -1),
        (("poisson_ratio",), Fraction(3, 13)),
    ],
)
def test_log_sensitivities(together, expected):
    """A relative change of a dimension changes the backlash by the exact fraction of it that theory gives."""
    full = BASELINE | {"disk_thickness": 0.0016, "disk_outer_radius": 0.080}
    step = 1e-4
    up, down = (
        math.log(backlash("cup", full | {name: full[name] * math.exp(sign * step) for name in together}))
        for sign in (1, -1)
    )
    assert (up - down) / (2 * step) == pytest.approx(float(expected), abs=1e-6)


@pytest.mark.parametrize(("blank", "expected"), [("disk_thickness", -1), ("disk_outer_radius", Fraction(-10, 7))])
def test_blank_disk_dimension_moves_with_the_cylinder(blank, expected):
    """A blank disk thickness follows the wall, a blank r_co the mean radius, with the shared sensitivity."""
    moved = {"disk_thickness": "wall_thickness", "disk_outer_radius": "mean_radius"}[blank]
    step = 1e-4
    up, down = (
        math.log(backlash("cup", BASELINE | {moved: BASELINE[moved] * math.exp(sign * step)})) for sign in (1, -1)
    )
    assert (up - down) / (2 * step) == pytest.approx(float(expected), abs=1e-6)


@pytest.mark.slow
def test_one_thickness_or_two_changes_the_spread(tmp_path):
    """Wall and disk as two dimensions have 25/49 of the variance that they have as one."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\n"
        "cut,wall_thickness,-0.001,0.001\ncut,disk_thickness,-0.001,0.001\n",
        encoding="utf-8",
    )
    one, two = results(
        tmp_path,
        SUBMITTED | {"variant": "one", "tolerance_class": "cut"},
        SUBMITTED | {"variant": "two", "tolerance_class": "cut", "disk_thickness_mm": "1.6"},
        tolerances=tolerances,
    )
    ratio = two["first_order_sd_arcmin"] / one["first_order_sd_arcmin"]
    assert ratio**2 == pytest.approx(25 / 49, rel=1e-6)


def test_fillets_and_rim_explain_the_finite_element_result(tmp_path):
    """With bore, 3.5 mm fillets and rims of 20 and 30 mm the wind-ups bracket the FEA's 4.93e-4 rad."""
    materials = tmp_path / "materials.csv"
    materials.write_text(f"material,shear_modulus_GPa\n20Cr2Ni4,{PRINTED_MODULUS / 1e9!r}\n", encoding="utf-8")
    refined = SUBMITTED | {
        "mean_radius_mm": "",
        "bore_diameter_mm": "160",
        "hub_fillet_radius_mm": "3.5",
        "junction_fillet_radius_mm": "3.5",
        "rim_thickness_mm": "3.2",
    }
    short, long = results(
        tmp_path,
        refined | {"variant": "short rim", "rim_length_mm": "20"},
        refined | {"variant": "long rim", "rim_length_mm": "30"},
        materials=materials,
    )
    assert short["windup_rad"] == pytest.approx(4.95703461e-4, rel=1e-6)
    assert long["windup_rad"] == pytest.approx(4.86129387e-4, rel=1e-6)
    assert long["windup_rad"] < 4.93e-4 < short["windup_rad"]


def test_two_term_formula_is_eight_per_cent_above_the_finite_element_result():
    """The unrefined formula stands 8.8 % above the FEA's total, and above its cylinder and its disk."""
    cylinder, disk = parts(BASELINE)
    assert cylinder > 2.78e-4
    assert disk > 2.15e-4
    assert printed((cylinder + disk) / 4.93e-4 - 1, 0.088, 2)


# Errata of the article: flexlash reproduces the physics, not the slips.


def test_erratum_printed_shear_modulus_is_not_reproduced():
    """G of E = 211 GPa and ν = 0.3 is not the printed 8.10769e10 Pa but 0.095 % more."""
    modulus = float(windup.shear_modulus(211e9, 0.3))
    assert not printed(modulus, PRINTED_MODULUS, 6)
    assert printed(modulus / PRINTED_MODULUS - 1, 0.00095, 2)


@pytest.mark.parametrize("modulus", [211e9 / 2.6, PRINTED_MODULUS])
def test_erratum_printed_cylinder_windup_is_not_reproduced(modulus):
    """The printed cylinder wind-up 3.058e-4 rad follows from neither shear modulus, nor 2U = 1.072e-3 rad."""
    cylinder, disk = parts(BASELINE | {"shear_modulus": modulus})
    assert not printed(cylinder, 3.058e-4, 4)
    assert not printed(2 * (cylinder + disk), 1.072e-3, 4)


@pytest.mark.parametrize("mean_radius", ["follows", "stays"])
@pytest.mark.parametrize(("radius", "wrong"), [(100, 1.473e-4), (60, 4.085e-4)])
def test_erratum_printed_disk_windups_of_cases_4_and_5_are_not_reproduced(mean_radius, radius, wrong):
    """The disk wind-ups printed for cases 4 and 5 scale 2.302e-4 by (80/r_co)², which is not the formula."""
    assert 2.302e-4 * (80 / radius) ** 2 == pytest.approx(wrong, rel=2e-3)
    moved = {"disk_outer_radius": radius / 1000}
    if mean_radius == "follows":
        moved["mean_radius"] = radius / 1000
    _, disk = parts(BASELINE | moved)
    assert abs(disk / wrong - 1) > 0.4


def test_erratum_disk_windup_rises_with_the_outer_radius():
    """A larger r_co raises the disk wind-up; the article's text says the opposite."""
    disks = [parts(BASELINE | {"disk_outer_radius": radius})[1] for radius in (0.060, 0.080, 0.100)]
    assert disks == sorted(disks)
    assert disks[0] < disks[1] < disks[2]


def test_erratum_cases_4_and_5_move_the_cylinder_too():
    """With r_m = r_co the cylinder wind-up of cases 4 and 5 is not the baseline's, which the article kept."""
    kept, _ = parts(BASELINE)
    for radius, expected in ((0.100, 1.5689208e-4), (0.060, 7.2635221e-4)):
        cylinder, _ = parts(BASELINE | {"mean_radius": radius})
        assert printed(cylinder, expected, 8)
        assert abs(cylinder / kept - 1) > 0.4


def test_erratum_simplified_ratio_needs_the_third_power():
    """Disk over cylinder is r_m³/(2l)·(1/r_ci² − 1/r_m²) = 3/4; the printed r_m² gives 12.5 times that."""
    cylinder, disk = parts(BASELINE)
    radius, length, inner = Fraction(80, 1000), Fraction(160, 1000), Fraction(40, 1000)
    bracket = (1 / inner**2 - 1 / radius**2) / (2 * length)
    assert disk / cylinder == pytest.approx(float(radius**3 * bracket), rel=1e-13)
    assert abs(disk / cylinder / float(radius**2 * bracket) - 1) > 0.9


def test_erratum_bore_radius_is_not_the_mean_radius():
    """Taking the bore radius 80 mm for the mean radius overstates the backlash; 80.8 mm gives 1.40 % less."""
    change = float(backlash("cup", BASELINE | {"mean_radius": 0.0808}) / backlash("cup", BASELINE)) - 1
    assert printed(change, -0.0140, 3)


@pytest.mark.slow
def test_calibration_reproduces_the_finite_elements():
    """The example with factors 0.907 and 0.936 gives the published wind-ups, whose uncertainty shows in the spread."""
    path = Path(__file__).resolve().parents[2] / "data" / "b3-160-calibrated.xlsx"
    outcome = run(path)
    row = outcome.results.row(0, named=True)
    assert row["cylinder_windup_rad"] == pytest.approx(2.78e-4, rel=1e-3)
    assert row["disk_windup_rad"] == pytest.approx(2.15e-4, rel=1e-3)
    assert row["backlash_rad"] == pytest.approx(9.86e-4, rel=1e-3)
    assert outcome.findings == ()
    (computed,) = outcome.computed.values()
    shares = computed.spread.shares
    # Three per cent at three sigma of 4/7 and 3/7 of the backlash, against two of Young's modulus.
    ratio = shares["cylinder_calibration"] / shares["youngs_modulus"]
    assert ratio == pytest.approx((3 * row["cylinder_windup_rad"] / (2 * row["windup_rad"])) ** 2, rel=0.02)
    assert shares["disk_calibration"] == pytest.approx(shares["cylinder_calibration"] * (2.15 / 2.78) ** 2, rel=0.02)
