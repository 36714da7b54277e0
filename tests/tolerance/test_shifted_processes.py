"""Processes off the middle of their limits, or with a standard deviation of their own: what reads limits is right."""

import math
from dataclasses import replace

import numpy as np
import pytest
from b3_160 import CUP, NOMINAL
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from toleranced import SUM, every_number, plan, row, statistics_of_row

from flexlash.analysis.recommendations import _half
from flexlash.comparison.used_values import tolerance_value
from flexlash.report.page.one_variant import _used
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.units import ARCMIN
from flexlash.schema.variant import Limits, ToleranceRow, Variant
from flexlash.tolerance import Normal, TruncatedNormal
from flexlash.tolerance.dimension_limits import (
    distribution_of,
    distributions,
    limits_of,
    shape_problems,
)
from flexlash.tolerance.limit_arrays import beyond_doubt, limits_alike

thorough = settings(deadline=None, max_examples=100, derandomize=True)

CALIBRATIONS = {"cylinder_calibration": 1.0, "disk_calibration": 1.0}
WALL = Limits(low=0.00158, high=0.00162)
MEASURED_WALL = replace(WALL, mean_shift=7e-6, sd=4.1e-6)
"""A wall of 1.607 mm and s = 0.0041 mm, where the drawing says 1.6 ± 0.02 mm."""


def variant(**changes):
    """Return a cup B3-160 with some dimensions changed."""
    return Variant(
        row=2, name="B3-160", flexspline_type="cup", material="20Cr2Ni4", tolerance_class="own",
        dimensions=NOMINAL | CALIBRATIONS | changes,
    )  # fmt: skip


def tolerance(dimension, lower, upper, **rest):
    """Return a row of Tolerances in SI."""
    return ToleranceRow(row=3, tolerance_class="own", dimension=dimension, lower=lower, upper=upper, **rest)


def reach_of(distribution):
    """Return the least and greatest value that a distribution produces in double precision."""
    return tuple(distribution.location + distribution.scale * distribution.standard_at(np.array([-8.3, 8.3])))


def test_normal_lies_around_the_mean_of_the_process():
    """A normal has the middle plus the shift for its mean, and its own sd or that of the limits."""
    middle = (0.00158 + 0.00162) / 2
    assert distribution_of(MEASURED_WALL) == Normal(middle + 7e-6, 4.1e-6)
    assert distribution_of(replace(WALL, mean_shift=-7e-6)) == Normal(middle - 7e-6, WALL.standard_deviation)
    assert distribution_of(replace(WALL, sd=4.1e-6)) == Normal(middle, 4.1e-6)


def test_truncated_normal_is_cut_at_the_drawings_limits():
    """A shifted truncated normal has the parent's mean and sd, cut at the limits as they are drawn."""
    found = distribution_of(replace(MEASURED_WALL, distribution="truncated normal"))
    assert found == TruncatedNormal(WALL.middle + 7e-6, 4.1e-6, 0.00158, 0.00162)
    ends = stats.truncnorm(*((np.array([0.00158, 0.00162]) - 0.001607) / 4.1e-6), loc=0.001607, scale=4.1e-6)
    assert found.expectation == pytest.approx(ends.mean(), rel=1e-9)


@pytest.mark.parametrize("changes", [{"mean_shift": 1e-6}, {"sd": 1e-6}, {"mean_shift": -1e-6, "sd": 2e-6}])
@pytest.mark.parametrize("distribution", ["uniform", "triangular"])
def test_other_distributions_have_neither_shift_nor_sd(changes, distribution):
    """Uniform and triangular limits, and limits that coincide, refuse a shift and a sd; they take none of either."""
    assert Limits(low=1.0, high=2.0, distribution=distribution).mean == 1.5
    for limits in ({"low": 1.0, "high": 2.0, "distribution": distribution}, {"low": 1.0, "high": 1.0}):
        with pytest.raises(ValueError, match="mean_shift and sd are those of a normal distribution"):
            Limits(**limits, **changes)


def test_rows_carry_shift_and_sd_in_the_unit_of_their_deviations():
    """Shift and sd of a row are lengths beside lengths and parts of the nominal value beside parts."""
    rows = [
        tolerance("wall_thickness", -2e-5, 2e-5, mean_shift=7e-6, sd=4.1e-6),
        tolerance("youngs_modulus", -0.02, 0.02, relative=True, mean_shift=-0.005, sd=0.004),
        tolerance("cylinder_length", 0, 0, grade="IT9", mean_shift=1e-5),
    ]
    limits, problems = limits_of(variant(), rows)
    assert problems == ()
    assert (limits["wall_thickness"].mean_shift, limits["wall_thickness"].sd) == (7e-6, 4.1e-6)
    modulus = distribution_of(limits["youngs_modulus"])
    assert (modulus.mean, modulus.sd) == pytest.approx((211e9 * 0.995, 211e9 * 0.004), rel=1e-12)
    length = limits["cylinder_length"]
    assert (length.mean, length.sd) == (pytest.approx(0.16001, rel=1e-12), None)


def test_reach_follows_the_mean_and_the_sd():
    """A normal reaches 8.3 of its own sd from its own mean; a truncated one its limits."""
    assert MEASURED_WALL.reach == pytest.approx((0.001607 - 8.3 * 4.1e-6, 0.001607 + 8.3 * 4.1e-6), rel=1e-12)
    assert replace(MEASURED_WALL, distribution="truncated normal").reach == (0.00158, 0.00162)


@pytest.mark.parametrize(("shift", "cut"), [(-0.0001, True), (0.0, True), (0.0001, False)])
def test_cut_at_an_impossible_size_depends_on_the_shift(shift, cut):
    """A normal is cut where its mean less 8.3 sd would be no thickness, so that a shift away from 0 spares it."""
    one = variant()
    sd = 0.0016 / 8.25
    limits = limits_of(one, [tolerance("wall_thickness", -0.001, 0.001, mean_shift=shift, sd=sd)])[0]
    kept, problems = shape_problems(one, limits)
    assert [problem.kind for problem in problems] == ["cut"] * cut
    wall = distribution_of(kept["wall_thickness"])
    assert reach_of(wall)[0] >= 0
    assert wall.mean == pytest.approx(0.0016 + shift, rel=1e-12)
    assert wall.sd == sd


shifts = st.floats(-1.5, 1.5)


@pytest.mark.slow
@thorough
@given(shifts, shifts, st.floats(0.05, 1.2), st.floats(0.05, 1.2))
def test_shifted_tails_never_close_the_disk(inner_shift, outer_shift, inner_sd, outer_sd):
    """Whatever the shifts and sd, the far tails of hub and disk are cut so that they never meet, and no earlier."""
    one, half = variant(disk_inner_radius=0.0795, disk_outer_radius=0.080), 0.0002
    rows = [
        tolerance(name, -half, half, mean_shift=shift * half, sd=sd * half)
        for name, shift, sd in (
            ("disk_inner_radius", inner_shift, inner_sd),
            ("disk_outer_radius", outer_shift, outer_sd),
        )
    ]
    limits = limits_of(one, rows)[0]
    kept, problems = shape_problems(one, limits)
    inner, outer = (distributions(kept)[name] for name in ("disk_inner_radius", "disk_outer_radius"))
    assert reach_of(inner)[1] <= reach_of(outer)[0] * (1 + 1e-12)
    beyond = [
        max(limits["disk_inner_radius"].reach[1] - 0.0797, 0),
        max(0.0798 - limits["disk_outer_radius"].reach[0], 0),
    ]
    assert bool(problems) is (sum(beyond) >= 0.0001 * (1 - 1e-9) and sum(beyond) > 0)


@pytest.mark.slow
@thorough
@given(shifts, st.floats(0.01, 1.2), st.sampled_from(["normal", "truncated normal"]), st.booleans())
def test_what_is_beyond_doubt_has_no_problem(shift, sd, distribution, relative):
    """Variants that the quick look over arrays leaves alone have no problem of shape, whatever shift and sd."""
    sizes = np.linspace(0.0001, 0.003, 40)
    size = 0.4 if relative else 0.0004
    asked = tolerance(
        "wall_thickness",
        -size,
        size,
        mean_shift=shift * size,
        sd=sd * size,
        relative=relative,
        distribution=distribution,
    )
    columns = {name: np.full(40, value) for name, value in (NOMINAL | CALIBRATIONS).items()} | {"wall_thickness": sizes}
    sure = beyond_doubt("cup", columns, limits_alike(columns, [asked]))
    told = []
    for wall in sizes:
        one = variant(wall_thickness=float(wall))
        told.append(bool(shape_problems(one, limits_of(one, [asked])[0])[1]))
    assert not (sure & told).any()
    assert (sure | told).sum() >= 38


def shifted(shift, sd=None):
    """Return the row whose output is a sum, its torque shifted."""
    torque = replace(SUM.limits["torque"], mean_shift=shift, sd=sd)
    return replace(SUM, limits={**SUM.limits, "torque": torque})


def test_no_shift_changes_no_bit():
    """A shift of 0 leaves every bit of a row's numbers."""
    assert every_number(statistics_of_row(shifted(0.0), plan())) == every_number(statistics_of_row(SUM, plan()))


@pytest.mark.parametrize("shift", [2.0, -5.0])
def test_spread_moves_and_the_drawing_stays(shift):
    """A shift moves mean, percentiles and probability; worst case and first-order sd are those of the drawing."""
    still, moved = (statistics_of_row(one, plan()).numbers for one in (SUM, shifted(shift)))
    assert moved["mean"] == pytest.approx(10 + shift, rel=1e-9)
    assert moved["sd"] == pytest.approx(3, rel=1e-9)
    assert moved["p97_5"] == pytest.approx(10 + shift + 3 * stats.norm.ppf(0.975), rel=1e-9)
    assert moved["probability_over_limit"] == pytest.approx(stats.norm.sf(16 - shift, 10, 3), rel=1e-6)
    for name in ("worst_case_low", "worst_case_high", "first_order_sd"):
        assert moved[name] == still[name]


def test_own_sd_is_that_of_the_spread_and_of_first_order():
    """A sd of its own makes the spread and the first-order sd, and leaves the worst case."""
    still, moved = (statistics_of_row(one, plan()).numbers for one in (SUM, shifted(1.0, sd=0.5)))
    assert (moved["sd"], moved["first_order_sd"]) == pytest.approx((math.sqrt(0.25 + 8),) * 2, rel=1e-9)
    assert (moved["worst_case_low"], moved["worst_case_high"]) == (still["worst_case_low"], still["worst_case_high"])


@pytest.mark.parametrize("distribution", ["normal", "truncated normal"])
def test_first_order_is_enough_for_a_shifted_sum(distribution):
    """A linear model's first-order interval is right about the mean of the process, however far that is shifted."""
    torque = Limits(low=-9.0, high=9.0, mean_shift=8.0, sd=1.5, distribution=distribution)
    narrow = {name: limits for name, limits in SUM.limits.items() if name != "torque"}
    one = replace(SUM, limits={"torque": torque, **narrow})
    assert statistics_of_row(one, plan()).texts["first_order_valid"] == "yes"


def test_wall_of_a_measured_process():
    """1.607 mm and s = 0.0041 mm within 1.6 ± 0.02 mm: Cpk 1.06, mean backlash 3.6709′, worst case of the drawing."""
    assert (WALL.high - MEASURED_WALL.mean) / (3 * MEASURED_WALL.standard_deviation) == pytest.approx(1.06, abs=0.005)
    numbers = statistics_of_row(row(CUP, NOMINAL, {"wall_thickness": MEASURED_WALL}), plan()).numbers
    assert numbers["mean"] / ARCMIN == pytest.approx(3.6709, abs=1e-4)
    variation = 4.1e-6 / 0.001607
    inverse = (1 + variation**2 + 3 * variation**4) / 0.001607
    assert numbers["mean"] == pytest.approx(float(CUP(NOMINAL)) * 0.0016 * inverse, rel=1e-9)
    drawn = [float(CUP(NOMINAL | {"wall_thickness": wall})) for wall in (0.00162, 0.00158)]
    assert [numbers["worst_case_low"], numbers["worst_case_high"]] == pytest.approx(drawn, rel=1e-12)


def test_capability_of_11_is_limits_at_33_sigma():
    """Cp 1.1, centred, is a process whose limits lie at k = 3.3: the same distribution."""
    cp = distribution_of(replace(WALL, sd=(WALL.high - WALL.low) / (6 * 1.1)))
    sigma = distribution_of(replace(WALL, sigma=3.3))
    assert (cp.mean, cp.sd) == pytest.approx((sigma.mean, sigma.sd), rel=1e-15)


def test_half_the_tolerance_keeps_the_capability():
    """Limits half as far apart have a process of the same Cp and Cpk between them."""
    half = _half(MEASURED_WALL)
    assert (half.low, half.high) == pytest.approx((0.00159, 0.00161), rel=1e-12)
    for limits in (MEASURED_WALL, half):
        room = limits.high - limits.mean
        assert room / limits.standard_deviation == pytest.approx(0.013e-3 / 4.1e-6, rel=1e-9)
    assert _half(WALL).standard_deviation == pytest.approx(WALL.standard_deviation / 2, rel=1e-12)


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        (WALL, "normal, limits at ± 3 sigma"),
        (MEASURED_WALL, "normal, mean 1.607"),
        (replace(WALL, mean_shift=-7e-6), "normal, limits at ± 3 sigma, mean 1.593"),
    ],
)
def test_the_page_tells_the_mean_of_a_shifted_process(limits, words):
    """The limits used of a variant tell the mean where it is not in the middle, and k only where it makes the sd."""
    used = _used(DIMENSIONS["wall_thickness"], 0.0016, limits)
    assert used["distribution"] == words
    assert (used["lower"], used["upper"]) == ("1.58", "1.62")
    assert float(used["sd"]) == pytest.approx(limits.standard_deviation * 1e3, rel=2e-3)


def test_comparison_sees_shift_and_sd():
    """Two rows of Tolerances that differ in shift or sd differ, and say by what."""
    plain = tolerance("wall_thickness", -2e-5, 2e-5)
    rows = [replace(plain, mean_shift=-7e-6), replace(plain, sd=4.1e-6), replace(plain, mean_shift=7e-6, sd=4.1e-6)]
    values = [tolerance_value(one) for one in (plain, *rows)]
    assert len({one.value for one in values}) == 4
    assert [one.shown for one in values] == [
        "± 0.02 mm",
        "± 0.02 mm, mean shifted by −0.007 mm",
        "± 0.02 mm, sd 0.0041 mm",
        "± 0.02 mm, sd 0.0041 mm, mean shifted by +0.007 mm",
    ]
    elastic = {"relative": True, "mean_shift": 0.005, "scatters_between": "lots"}
    share = tolerance_value(tolerance("youngs_modulus", -0.02, 0.02, **elastic))
    assert share.shown == "± 2 %, mean shifted by +0.5 %"
