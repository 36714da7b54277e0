"""Points of a sweep are submissions of their own; where they cross the limit is exact."""

from __future__ import annotations

import math

import polars as pl
import pytest
import regenerate
from scipy.optimize import brentq
from swept import point_rows, sweep_row, swept

from flexlash.decisions.allowed_spans import allowed_spans
from flexlash.decisions.sweep import sweep_levels, sweep_table
from flexlash.feedback.template.template_workbook import Filling, study, template_bytes
from flexlash.pipeline import check, run
from flexlash.schema.result_columns import RESULTS

THIRD = "B3-160 case 3"
LENGTHS = ("cylinder_length_mm", (100, 200, 20))
WORDS = {"variant", "notes", "findings"}


def _written(folder, filling, name="submission.xlsx"):
    path = folder / name
    path.write_bytes(template_bytes(filling))
    return path


@pytest.fixture(scope="module")
def outcome(tmp_path_factory):
    """Return the published study, checked, which no test may change."""
    return check(_written(tmp_path_factory.mktemp("study"), study()))


@pytest.fixture(scope="module")
def third(outcome):
    """Return the study of case 3's length that decisions.md prints."""
    (found,) = swept(outcome, sweep_row(THIRD, LENGTHS))
    return found


def test_the_published_lengths(third):
    """From 100 to 200 mm the cup of case 3 has 2U = T l/(π G r³ Δ) + T/(2π Δ G)(1/r_ci² − 1/r²)."""
    assert [round(value, 3) for value in third.results["backlash_arcmin"]] == [2.897, 3.160, 3.424, 3.687, 3.950, 4.214]


def test_the_published_crossings(third):
    """It crosses 3.8 arcmin at 168.6 mm with the nominal backlash, at 164.1 mm with P97.5, at 161.9 mm with P99.865."""
    found = {one.percent: (round(one.value, 1), one.falls) for one in third.crossings}
    assert found == {None: (168.6, False), 97.5: (164.1, False), 99.865: (161.9, False)}


@pytest.mark.slow
def test_a_crossing_is_on_the_limit_when_it_is_submitted(third, tmp_path):
    """A variant with the length of a crossing has the limit as its nominal backlash, P97.5 or P99.865."""
    base = next(row for row in study().variants if row["variant"] == THIRD)
    rows = [{**base, "variant": f"{one.percent}", "cylinder_length_mm": one.value} for one in third.crossings]
    again = run(_written(tmp_path, Filling(variants=rows, tolerances=study().tolerances)), jobs=1).results
    levels = [again[key][number] for number, key in enumerate(("backlash_arcmin", "p97_5_arcmin", "p99_865_arcmin"))]
    assert levels == pytest.approx([3.8] * 3, rel=2e-7)


CASES = {
    "length": (THIRD, [LENGTHS]),
    "wall that its disk follows": (THIRD, [("wall_thickness_mm", (1.2, 2.2, 0.25))]),
    "disk that becomes a dimension of its own": (THIRD, [("disk_thickness_mm", (1.2, 2.4, 0.3))]),
    "bore": ("B3-160 bore", [("bore_diameter_mm", (150, 170, 5))]),
    "hub fillet of a cup that has one, and length": (
        "B3-160 detail",
        [("hub_fillet_radius_mm", (0, 6, 2)), ("cylinder_length_mm", (120, 180, 30))],
    ),
    "flange": ("B3-160 hat", [("disk_outer_radius_mm", (90, 110, 10))]),
    "torque of a cylinder": ("B3-160 cylinder", [("torque_Nm", [400.0, 800.0])]),
    "impossible hubs among possible ones": (THIRD, [("disk_inner_radius_mm", (-20, 100, 20))]),
}


@pytest.mark.slow
def test_a_point_is_a_submission_with_its_value_bit_for_bit(outcome, tmp_path):
    """Every number of every point is that of a submission in which the cell holds the value, to the last bit."""
    rows_of = {row["variant"]: row for row in study().variants}
    for name, (variant, dimensions) in CASES.items():
        (found,) = swept(outcome, sweep_row(variant, *dimensions))
        rows = point_rows(found, rows_of[variant])
        filling = Filling(variants=rows, tolerances=study().tolerances)
        again = run(_written(tmp_path, filling, f"{variant}.xlsx"), jobs=1).results
        assert again.height == found.results.height > 1
        for key in again.columns:
            if key not in WORDS:
                assert found.results[key].to_list() == again[key].to_list(), (name, key)
        assert found.results["status"].n_unique() > 1 or "impossible" not in name


@pytest.mark.slow
@pytest.mark.parametrize("method", ["line", "random"])
def test_points_of_measured_parts_are_submissions_too(tmp_path, method):
    """So it is with measured and correlated dimensions, and with plain draws."""
    filling = regenerate.measured_parts()
    outcome = check(_written(tmp_path, filling), method=method)
    base = filling.variants[-1]
    (found,) = swept(outcome, sweep_row(base["variant"], ("cylinder_length_mm", (150, 170, 10))))
    rows = point_rows(found, base)
    again = run(
        _written(
            tmp_path,
            Filling(
                variants=rows,
                tolerances=filling.tolerances,
                measurements=filling.measurements,
                correlations=filling.correlations,
                settings=filling.settings,
            ),
            "again.xlsx",
        ),
        jobs=1,
        method=method,
    ).results
    for key in again.columns:
        if key not in WORDS:
            assert found.results[key].to_list() == again[key].to_list(), key


def test_an_impossible_point_is_a_row_with_its_finding(outcome):
    """A hub outside the disk has empty numbers and says why; the points beside it are computed."""
    (found,) = swept(outcome, sweep_row(THIRD, ("disk_inner_radius_mm", (60, 100, 10))))
    numbers = [column.key for column in RESULTS if column.is_number and column.key != "backlash_limit_arcmin"]
    rows = {row["disk_inner_radius_mm"]: row for row in found.results.iter_rows(named=True)}
    assert [rows[value]["status"] for value in (70.0, 80.0, 90.0)] == ["warning", "error", "error"]
    assert all(rows[90.0][key] is None for key in numbers)
    assert rows[90.0]["findings"].startswith("E303 Disk inner radius r_ci = 90 mm: less than the disk's outer radius")
    shear = 211e9 / 2.6
    cylinder = 800 * 0.2 / (2 * math.pi * shear * 0.08**3 * 0.0016)
    disk = 800 / (4 * math.pi * shear * 0.0016) * (1 / 0.07**2 - 1 / 0.08**2)
    assert rows[70.0]["backlash_rad"] == pytest.approx(2 * (cylinder + disk), rel=1e-12)


@pytest.mark.slow
def test_two_dimensions_have_every_pair_and_a_crossing_each(outcome):
    """Each value of the one meets each of the other; along the first, each value of the second has its crossings."""
    sweep = sweep_row(THIRD, ("disk_inner_radius_mm", (40, 60, 10)), ("wall_thickness_mm", (1.4, 1.8, 0.2)))
    (found,) = swept(outcome, sweep)
    assert found.results.select(found.keys).rows() == [(r, t) for r in (40, 50, 60) for t in (1.4, 1.6, 1.8)]
    target = {one.second: round(one.value, 2) for one in found.crossings if one.percent == 99.865}
    assert target == {1.4: 54.36, 1.6: 45.84, 1.8: 40.37}
    assert all(one.falls for one in found.crossings)


@pytest.mark.slow
def test_no_crossing_and_no_limit(outcome, tmp_path):
    """Where the limit is never crossed, or is not given, there is no crossing."""
    (within,) = swept(outcome, sweep_row(THIRD, ("cylinder_length_mm", (100, 140, 20))))
    (over,) = swept(outcome, sweep_row(THIRD, ("cylinder_length_mm", (180, 220, 20))))
    assert not within.crossings
    assert not over.crossings
    base = {key: value for key, value in study().variants[2].items() if key != "backlash_limit_arcmin"}
    free = check(_written(tmp_path, Filling(variants=[base], tolerances=study().tolerances)))
    (none,) = swept(free, sweep_row(THIRD, LENGTHS))
    assert none.limit is None
    assert not none.crossings


def test_a_limit_that_is_crossed_between_two_points_and_again(tmp_path):
    """A short cup winds up least at r = 3 l t/Δ: between points that all miss the limit some radii meet it.

    2U = T l/(π G r³ Δ) + T/(2π Δ G)(1/r_ci² − 1/r²) by itself says where; within 99.865 % of units, so does a run.
    """
    cup = {
        "variant": "short", "flexspline_type": "cup", "material": "20Cr2Ni4", "torque_Nm": 300.0,
        "cylinder_length_mm": 20.0, "mean_radius_mm": 70.0, "wall_thickness_mm": 1.0, "disk_inner_radius_mm": 30.0,
        "tolerance_class": "exact", "backlash_limit_arcmin": 2.065,
    }  # fmt: skip
    wall = {"tolerance_class": "exact", "dimension": "wall_thickness", "lower_deviation": -0.002}
    tolerances = [{**wall, "upper_deviation": 0.002, "deviation_unit": "mm"}]
    outcome = check(_written(tmp_path, Filling(variants=[cup], tolerances=tolerances)))
    rising, falling, both = swept(
        outcome,
        sweep_row("short", ("mean_radius_mm", (40, 100, 30))),
        sweep_row("short", ("mean_radius_mm", (100, 40, 30))),
        sweep_row("short", ("mean_radius_mm", (40, 100, 30)), ("wall_thickness_mm", (1.0, 1.01, 0.01))),
    )

    def backlash(radius):
        shear, wall = 211e9 / 2.6, 1e-3
        cylinder = 300 * 0.02 / (math.pi * shear * radius**3 * wall)
        return (cylinder + 300 / (2 * math.pi * shear * wall) * (1 / 0.03**2 - 1 / radius**2)) / (math.pi / 10800)

    expected = [1e3 * brentq(lambda radius: backlash(radius) - 2.065, *ends) for ends in ((0.04, 0.06), (0.06, 0.1))]
    nominal = [(one.value, one.falls) for one in rising.crossings if one.percent is None]
    assert [value for value, _ in nominal] == pytest.approx(expected, rel=1e-6)
    assert [falls for _, falls in nominal] == [True, False]
    assert [one.value for one in falling.crossings if one.percent is None] == pytest.approx(expected[::-1], rel=1e-6)
    assert [one.percent for one in rising.crossings] == [None, None, 97.5, 97.5, 99.865, 99.865]
    assert len([one for one in both.crossings if one.second == 1.01]) == len(rising.crossings)
    (span,) = allowed_spans(rising, 99.865)
    assert (span.low_crosses, span.high_crosses) == (True, True)
    rows = [{**cup, "variant": f"{value}", "mean_radius_mm": value} for value in (span.low, span.high)]
    again = run(_written(tmp_path, Filling(variants=rows, tolerances=tolerances), "again.xlsx"), jobs=1).results
    assert again["p99_865_arcmin"].to_list() == pytest.approx([2.065] * 2, rel=2e-7)


@pytest.mark.slow
def test_another_target_has_its_own_crossing(tmp_path):
    """A target whose percentile no column holds is found by the share over the limit: at it, just so many are over."""
    filling = Filling(variants=[study().variants[2]], tolerances=study().tolerances, settings={"target_percent": 99.9})
    outcome = check(_written(tmp_path, filling))
    assert sweep_levels(outcome.settings.target_percent) == [None, 97.5, 99.865, 99.9]
    (found,) = swept(outcome, sweep_row(THIRD, LENGTHS))
    (target,) = (one.value for one in found.crossings if one.percent == 99.9)
    rows = [{**study().variants[2], "cylinder_length_mm": target}]
    again = run(_written(tmp_path, Filling(variants=rows, tolerances=study().tolerances), "again.xlsx"), jobs=1)
    assert again.results["probability_over_limit"][0] == pytest.approx(0.001, rel=1e-5)


@pytest.mark.slow
def test_a_blank_variant_is_every_one_that_can_have_the_dimension(outcome):
    """A bore is swept in the variants that are entered by their bore; the others would have two radii."""
    found = swept(outcome, sweep_row(None, ("bore_diameter_mm", (158, 162, 2))))
    assert [one.variant for one in found] == ["B3-160 bore", "B3-160 detail"]


@pytest.mark.slow
def test_the_table_holds_every_swept_key(outcome):
    """Studies of several dimensions make one table: a key is blank in the points that do not sweep it."""
    found = swept(outcome, sweep_row(THIRD, LENGTHS), sweep_row(THIRD, ("wall_thickness_mm", (1.6, 1.8, 0.1))))
    table = sweep_table(found)
    keys = ["variant", "cylinder_length_mm", "wall_thickness_mm"]
    assert table.columns == [*keys, *(column.key for column in RESULTS if column.key != "variant")]
    assert table["wall_thickness_mm"].to_list() == [None] * 6 + [1.6, 1.7, 1.8]
    assert table["variant"].unique().to_list() == [THIRD]


@pytest.mark.slow
def test_nothing_depends_on_the_studies_beside(outcome, third):
    """Points and crossings of a study are the same bits alone and among others."""
    among = swept(
        outcome,
        sweep_row(None, ("torque_Nm", [300.0, 900.0])),
        sweep_row(THIRD, LENGTHS),
        sweep_row("B3-160 hat", ("cylinder_length_mm", (100, 200, 50))),
    )
    (same,) = (one for one in among if one.keys == third.keys and one.variant == THIRD)
    assert same.results.equals(third.results, null_equal=True)
    assert same.crossings == third.crossings


def test_a_submission_without_sweeps_has_no_study(outcome):
    """Nothing is swept unasked."""
    assert swept(outcome) == []
    assert sweep_table([]).select(pl.len()).item() == 0
