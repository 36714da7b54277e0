"""Processes and bases through a whole submission: the same bits however they are told, each fault at its cell."""

from __future__ import annotations

import pytest
from entry_books import CUP, entry_book
from measured_parts import scattered
from tolerance_sheets import based, row

from flexlash import run
from flexlash.pipeline import check

PART = {key: value for key, value in CUP.items() if key not in {"disk_thickness_mm", "tolerance_class"}}
WALL = {"dimension": "wall_thickness", "lower_deviation": -0.02, "upper_deviation": 0.02}
FULL = [
    row("full", half=0.0125),
    row("full", "youngs_modulus", half=2, deviation_unit="%"),
    row("full", "poisson_ratio", half=0.01, distribution="uniform"),
]
MEASUREMENTS = [
    *({"sample": "walls", "part": part, "wall_thickness_mm": wall} for part, wall in enumerate(scattered(60))),
    *(
        {"sample": "above", "part": part, "use_as": "deviation", "wall_thickness_mm": wall - 1.6}
        for part, wall in enumerate(scattered(60))
    ),
]


def book(path, classes, *more, variants=None, **sheets):
    """Write a workbook with a class for each row given by its name, and a variant for each class."""
    tolerances = [{"tolerance_class": name, **one} for name, one in classes.items()] + list(more)
    variants = variants or [
        {**PART, "variant": name, "tolerance_class": name, "backlash_limit_arcmin": 3.8} for name in classes
    ]
    return entry_book(path / "study.xlsx", variants=variants, tolerances=tolerances, **sheets)


def numbers(outcome):
    """Return all numbers of Results of each variant by its name."""
    rows = outcome.results.drop("status").iter_rows(named=True)
    return {row["variant"]: {key: value for key, value in row.items() if key != "variant"} for row in rows}


def told(outcome):
    """Return code and place of errors and warnings, but that dimensions are left exact."""
    return [(one.code, one.place) for one in outcome.findings if one.level != "info" and one.code != "W438"]


def test_cp_of_11_in_the_middle_is_33_sigma(tmp_path):
    """Every number of Results is the same to the bit."""
    found = numbers(run(book(tmp_path, {"cp": WALL | {"cp": 1.1}, "k": WALL | {"limits_sigma": 3.3}})))
    assert found["cp"] == found["k"]
    assert found["cp"]["sd_arcmin"] > 0


def test_a_class_based_on_another_has_its_numbers(tmp_path):
    """Class shop of the wall alone, based on full, gives full's numbers to the bit: 3.780′ and 118 ppm."""
    shop = {"dimension": "wall_thickness", "lower_deviation": -0.0125, "upper_deviation": 0.0125}
    variants = [
        {**PART, "variant": name, "tolerance_class": name, "backlash_limit_arcmin": 3.8} for name in ("shop", "full")
    ]
    found = numbers(run(book(tmp_path, {"shop": shop}, based("shop", "full"), *FULL, variants=variants)))
    full = found.pop("full")
    assert found == {"shop": full}
    assert full["p99_865_arcmin"] == pytest.approx(3.780, abs=5e-4)
    assert full["ppm_over_limit"] == pytest.approx(118, abs=3)


def test_a_class_based_on_standard_is_one_that_lists_it(tmp_path):
    """Rows taken over from the built-in class give the bits that the same rows give where they are listed."""
    listed = [
        row("listed", "mean_radius", grade="IT7", lower_deviation=None, upper_deviation=None),
        row("listed", "disk_inner_radius", grade="IT9", lower_deviation=None, upper_deviation=None),
        row("listed", "cylinder_length", grade="IT11", lower_deviation=None, upper_deviation=None),
        row("listed", "youngs_modulus", half=2, deviation_unit="%"),
        row("listed", "poisson_ratio", half=0.01, distribution="uniform"),
    ]
    path = book(tmp_path, {"listed": WALL, "based": WALL}, *listed, based("based", "standard"))
    outcome = run(path)
    found = numbers(outcome)
    assert found["listed"] == found["based"]
    assert [one.code for one in outcome.findings if one.level != "info"] == []


def test_the_process_of_the_issue(tmp_path):
    """Mean 1.607 and s 0.0041 mm, entered or from sixty measured parts, give 3.6709′ and the drawing's worst case."""
    classes = {
        "entered": WALL | {"mean_shift": 0.007, "standard_deviation": 0.0041},
        "walls": WALL | {"sample": "walls"},
        "above": WALL | {"sample": "above"},
        "graded": {"dimension": "wall_thickness", "grade": "IT9", "sample": "walls"},
        "drawing": WALL,
    }
    found = numbers(run(book(tmp_path, classes, measurements=MEASUREMENTS)))
    for name in ("entered", "walls", "above", "graded"):
        assert found[name]["mean_arcmin"] == pytest.approx(3.6709, abs=1e-4), name
        for key in ("mean_arcmin", "sd_arcmin", "p99_865_arcmin", "first_order_sd_arcmin"):
            assert found[name][key] == pytest.approx(found["entered"][key], rel=1e-11), (name, key)
    for key in ("worst_case_low_arcmin", "worst_case_high_arcmin"):
        for name in ("entered", "walls", "above"):
            assert found[name][key] == found["drawing"][key], (name, key)


def test_cpk_lies_on_the_side_that_raises_the_backlash(tmp_path):
    """Cp 1.5 and Cpk 1.1 are a thinner wall and a longer cylinder, each as the shift on that side gives it."""
    shift = (1.5 - 1.1) / 1.5 * 0.02
    length = WALL | {"dimension": "cylinder_length"}
    classes = {
        "wall": WALL | {"cp": 1.5, "cpk": 1.1},
        "thin": WALL | {"cp": 1.5, "mean_shift": -shift},
        "length": length | {"cp": 1.5, "cpk": 1.1},
        "long": length | {"cp": 1.5, "mean_shift": shift},
    }
    found = numbers(run(book(tmp_path, classes)))
    for one, other in (("wall", "thin"), ("length", "long")):
        for key in ("mean_arcmin", "sd_arcmin", "p2_5_arcmin", "p97_5_arcmin"):
            assert found[one][key] == pytest.approx(found[other][key], rel=1e-9), (one, key)
    assert found["wall"]["mean_arcmin"] > found["wall"]["backlash_arcmin"]


def test_a_measured_distribution_keeps_mean_and_sd(tmp_path):
    """The smooth curve through a sample gives its mean and standard deviation to first order, and ends sooner."""
    classes = {"measured": WALL | {"sample": "walls", "distribution": "measured"}, "walls": WALL | {"sample": "walls"}}
    found = numbers(run(book(tmp_path, classes, measurements=MEASUREMENTS)))
    for key in ("mean_arcmin", "sd_arcmin"):
        assert found["measured"][key] == pytest.approx(found["walls"][key], rel=2e-3)
    assert found["measured"]["p99_865_arcmin"] != found["walls"]["p99_865_arcmin"]


def test_a_graded_process_is_told_at_its_row_once(tmp_path):
    """Where the limits wait for a size the process is told on Tolerances, of the first variant; its rows wait."""
    graded = {"dimension": "wall_thickness", "grade": "IT9"}
    classes = {
        "far": graded | {"mean_shift": 7},
        "outside": graded | {"mean_shift": 0.014, "standard_deviation": 0.004},
    }
    variants = [
        {**PART, "variant": f"{name} {number}", "tolerance_class": name} for number in (1, 2) for name in classes
    ]
    variants.append({**PART, "variant": "thick", "tolerance_class": "outside", "wall_thickness_mm": 3.5})
    outcome = check(book(tmp_path, classes, variants=variants))
    assert told(outcome) == [("W418", "Variants!G6"), ("E339", "Tolerances!D2"), ("W442", "Tolerances!D3")]
    assert outcome.counts["computed"] == 3
    messages = [one.message for one in outcome.findings if one.code in {"E339", "W442"}]
    assert "for variant far 1" in messages[0]
    assert "Rows 2, 4 of Variants wait for class far." in messages[0]
    assert "for variant outside 1" in messages[1]
    assert outcome.results["status"].to_list() == ["error", "ok", "error", "ok", "warning"]


def test_a_cpk_beside_a_graded_shift_is_compared(tmp_path):
    """Where the limits are a grade's, Cpk and mean shift are compared at the size: 7 of 12.5 µm leave 0.44 of Cp."""
    graded = {"dimension": "wall_thickness", "grade": "IT9", "cp": 1.5, "mean_shift": -0.007}
    classes = {"apart": graded | {"cpk": 1.1}, "alike": graded | {"cpk": 0.66}}
    outcome = check(book(tmp_path, classes))
    assert told(outcome) == [("W443", "Tolerances!F2")]
    assert "for variant apart with this Mean shift Cpk is 0.66; the mean shift is used." in str(outcome.findings)


def test_some_variants_of_a_class_are_held(tmp_path):
    """Only the variants whose grade is too close for the process wait; the others of the class are computed."""
    classes = {
        "own": {"dimension": "cylinder_length", "grade": "IT5", "mean_shift": 0.052, "standard_deviation": 0.002}
    }
    variants = [
        {**PART, "variant": f"{length} mm", "tolerance_class": "own", "cylinder_length_mm": length}
        for length in (160, 320)
    ]
    outcome = check(book(tmp_path, classes, variants=variants))
    assert told(outcome) == [("E339", "Tolerances!D2"), ("W442", "Tolerances!D2")]
    assert outcome.counts["computed"] == 1
    (found,) = (one for one in outcome.findings if one.code == "E339")
    assert found.message.endswith("Row 2 of Variants waits for class own.")


def test_measured_values_that_are_far_from_a_size_are_told_there(tmp_path):
    """Values that were measured are compared with the dimension of each variant, which may be the one that is wrong.

    Within twice the width of the limits the parts may have been made wrong, and are computed.
    """
    variants = [
        {**PART, "variant": f"{wall} mm", "tolerance_class": "own", "wall_thickness_mm": wall}
        for wall in (1.6, 1.61, 2.6, 1.63, 1.72)
    ]
    path = book(tmp_path, {"own": WALL | {"sample": "walls"}}, variants=variants, measurements=MEASUREMENTS)
    outcome = check(path)
    places = {one.place: one.code for one in outcome.findings if one.code in {"E339", "W442"}}
    assert places == {"Variants!G4": "E339", "Variants!G5": "W442", "Variants!G6": "E339"}
    assert outcome.counts["computed"] == 3


def test_findings_of_a_process_do_not_depend_on_the_order(tmp_path):
    """Rows in another order have the same findings but for whom they name."""
    graded = {"dimension": "wall_thickness", "grade": "IT9", "mean_shift": 0.014, "standard_deviation": 0.004}
    variants = [{**PART, "variant": f"V{number}", "tolerance_class": "own"} for number in range(3)]
    for order in (variants, variants[::-1]):
        outcome = check(book(tmp_path, {"own": graded}, variants=order))
        assert told(outcome) == [("W442", "Tolerances!D2")]
