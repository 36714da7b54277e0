"""Tolerance rows → limits → distributions: deviations, grades, cut tails and impossible shapes."""

import math

import numpy as np
import pytest
from b3_160 import NOMINAL
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.mechanics.flexspline import backlash, radius_of
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import ToleranceRow, Variant
from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform, propagate
from flexlash.tolerance.dimension_limits import Limits, distribution_of, distributions, limits_of, shape_problems
from flexlash.validation.materials_and_classes import standard_class

thorough = settings(deadline=None, max_examples=60, derandomize=True)

CUP = NOMINAL | {"cylinder_calibration": 1.0, "disk_calibration": 1.0}


def variant(kind="cup", **changes):
    """Return a B3-160 variant with some dimensions changed, None taking one out."""
    dimensions = {name: size for name, size in (CUP | changes).items() if size is not None}
    return Variant(
        row=2, name="B3-160", flexspline_type=kind, material="20Cr2Ni4", tolerance_class="own", dimensions=dimensions
    )


def from_bore(bore, wall, kind="cup", **changes):
    """Return a variant whose mean radius follows from bore and wall."""
    return variant(kind, mean_radius=None, bore_diameter=bore, wall_thickness=wall, **changes)


def row(dimension, lower=0.0, upper=0.0, **rest):
    """Return a tolerance row in SI."""
    return ToleranceRow(row=3, tolerance_class="own", dimension=dimension, lower=lower, upper=upper, **rest)


def limits_for(one, *rows):
    """Return limits of a variant whose rows have no fault."""
    limits, problems = limits_of(one, rows)
    assert problems == ()
    return limits


def kinds(problems):
    """Return kind and dimension of each problem."""
    return [(problem.kind, problem.dimension) for problem in problems]


def reach_of(distribution):
    """Return the least and greatest value that a distribution produces in double precision."""
    ends = distribution.standard(np.array([2.0**-53, 1 - 2.0**-53]))
    return tuple(distribution.location + distribution.scale * ends)


def test_deviations_are_signed_differences_from_the_entered_value():
    """Limits lie at the entered value plus the signed deviations; their middle may be off the entered value."""
    limits = limits_for(variant(), row("wall_thickness", -0.0001, 0.00005))
    assert limits["wall_thickness"].low == pytest.approx(0.0015, rel=1e-12)
    assert limits["wall_thickness"].high == pytest.approx(0.00165, rel=1e-12)
    assert limits["wall_thickness"].middle == pytest.approx(0.001575, rel=1e-12)


def test_percent_is_of_the_entered_value():
    """Relative deviations are shares of the entered value."""
    limits = limits_for(variant(), row("youngs_modulus", -0.02, 0.01, relative=True))
    assert limits["youngs_modulus"].low == pytest.approx(211e9 * 0.98, rel=1e-12)
    assert limits["youngs_modulus"].high == pytest.approx(211e9 * 1.01, rel=1e-12)


def test_limits_stand_in_the_order_of_the_dimensions():
    """Limits come in the order of the columns, whatever the order of the rows."""
    rows = [row(name, -0.001, 0.001, relative=True) for name in ("poisson_ratio", "wall_thickness", "torque")]
    assert list(limits_for(variant(), *rows)) == ["torque", "wall_thickness", "poisson_ratio"]
    assert list(limits_for(variant(), *rows[::-1])) == ["torque", "wall_thickness", "poisson_ratio"]


@pytest.mark.parametrize(
    ("dimension", "size"),
    [("mean_radius", 0.080), ("disk_inner_radius", 0.040), ("disk_outer_radius", 0.0801)],
)
def test_grade_on_a_radius_is_that_of_the_diameter_halved(dimension, size):
    """A grade on a radius is looked up at the diameter and halved."""
    one = variant(**{dimension: size})
    widths = {0.160: 40e-6, 0.080: 30e-6, 0.1602: 40e-6}
    limits = limits_for(one, row(dimension, grade="IT7"))
    assert limits[dimension].low == pytest.approx(size - widths[2 * size] / 4, rel=1e-12)
    assert limits[dimension].high == pytest.approx(size + widths[2 * size] / 4, rel=1e-12)


def test_one_sided_grade_on_a_radius():
    """h7 on a mean radius of 80 mm is half of the 40 µm of a diameter of 160 mm, taken downwards."""
    limits = limits_for(variant(), row("mean_radius", grade="h7"))
    assert limits["mean_radius"].high == 0.080
    assert limits["mean_radius"].high - limits["mean_radius"].low == pytest.approx(20e-6, rel=1e-9)


def test_general_tolerance_on_a_radius():
    """2768-m on a radius of 80 mm is half of the ± 0.5 mm of a diameter of 160 mm."""
    limits = limits_for(variant(), row("mean_radius", grade="2768-m"))
    assert limits["mean_radius"].high - 0.080 == pytest.approx(0.00025, rel=1e-9)


@pytest.mark.parametrize(
    ("dimension", "grade", "low", "high"),
    [
        ("bore_diameter", "H7", 0.160, 0.16004),
        ("wall_thickness", "IT9", 0.0015875, 0.0016125),
        ("cylinder_length", "IT11", 0.159875, 0.160125),
        ("cylinder_length", "2768-m", 0.1595, 0.1605),
    ],
)
def test_grade_on_a_diameter_or_length(dimension, grade, low, high):
    """A grade on a diameter, length or thickness is looked up at its own size."""
    limits = limits_for(from_bore(0.160, 0.0016), row(dimension, grade=grade))
    assert (limits[dimension].low, limits[dimension].high) == pytest.approx((low, high), rel=1e-12)


@pytest.mark.parametrize(
    ("dimension", "size", "grade"),
    [("mean_radius", 0.2501, "IT7"), ("cylinder_length", 0.501, "h9"), ("wall_thickness", 0.0004, "2768-m")],
)
def test_grade_without_an_entry_is_a_problem(dimension, size, grade):
    """A grade that the tables do not hold at that size is a problem that names dimension, grade and row."""
    asked = row(dimension, grade=grade)
    limits, (problem,) = limits_of(variant(**{dimension: size}), [asked])
    assert limits == {}
    assert (problem.kind, problem.dimension, problem.detail) == ("untabulated", dimension, grade)
    assert problem.row is asked


def test_shift_without_scatter():
    """Equal deviations shift the middle and scatter nothing; both 0 leave the dimension exact."""
    limits = limits_for(
        variant(), row("wall_thickness", 0.0001, 0.0001), row("cylinder_length", 0.0, 0.0), row("torque", -5.0, -5.0)
    )
    assert set(limits) == {"wall_thickness", "torque"}
    assert limits["wall_thickness"].low == limits["wall_thickness"].high == limits["wall_thickness"].middle
    assert limits["wall_thickness"].middle == pytest.approx(0.0017, rel=1e-12)
    assert limits["torque"].middle == 795.0
    assert distributions(limits) == {}


@pytest.mark.parametrize(
    ("one", "dimension"),
    [
        (from_bore(0.160, 0.0016), "mean_radius"),
        (variant(), "bore_diameter"),
        (variant(), "disk_thickness"),
        (variant(), "disk_outer_radius"),
        (variant(), "disk_hub_thickness"),
        (variant(), "rim_length"),
        (variant(), "rim_thickness"),
        (variant(), "hub_fillet_radius"),
        (variant(), "junction_fillet_radius"),
        (variant(), "shear_modulus"),
        (variant("cylinder", disk_inner_radius=None), "disk_inner_radius"),
        (variant(youngs_modulus=None, poisson_ratio=None, shear_modulus=8e10), "youngs_modulus"),
        (variant(youngs_modulus=None, poisson_ratio=None, shear_modulus=8e10), "poisson_ratio"),
    ],
)
def test_rows_that_do_not_apply_are_silent(one, dimension):
    """A row for a dimension that a variant lacks, or takes from another, sets no limits and is no problem."""
    assert limits_of(one, [row(dimension, -0.001, 0.001), row(dimension, grade="IT7")]) == ({}, ())


@pytest.mark.parametrize("dimension", ["cylinder_calibration", "disk_calibration", "torque"])
def test_calibrations_and_torque_may_have_tolerances(dimension):
    """Calibrations and torque scatter like any dimension."""
    limits = limits_for(variant(), row(dimension, -0.05, 0.05, relative=True))
    assert limits[dimension].standard_deviation == pytest.approx(CUP[dimension] * 0.05 / 3, rel=1e-12)


def test_standard_class_applies_to_every_refinement():
    """The class standard sets limits on every dimension of a refined cup but torque and calibrations."""
    one = from_bore(
        0.160,
        0.0016,
        disk_thickness=0.0018,
        disk_outer_radius=0.081,
        disk_hub_thickness=0.003,
        hub_fillet_radius=0.0035,
        junction_fillet_radius=0.0035,
        rim_length=0.02,
        rim_thickness=0.0032,
    )
    limits = limits_for(one, *standard_class())
    exact = {"torque", "cylinder_calibration", "disk_calibration"}
    assert set(limits) == set(one.dimensions) - exact
    kept, problems = shape_problems(one, limits)
    assert kept == limits
    assert problems == ()
    assert limits["hub_fillet_radius"].high == pytest.approx(0.00385, rel=1e-12)
    assert limits["youngs_modulus"].standard_deviation == pytest.approx(211e9 * 0.02 / 3, rel=1e-12)
    assert distribution_of(limits["poisson_ratio"]) == Uniform(
        limits["poisson_ratio"].low, limits["poisson_ratio"].high
    )


@pytest.mark.parametrize("sigma", [3.0, 2.0, 4.5])
def test_normal_limits_are_k_standard_deviations_from_the_middle(sigma):
    """A normal is centred on mid-limits with σ = (upper − lower)/(2k), unbounded."""
    distribution = distribution_of(Limits(low=1.0, high=4.0, sigma=sigma))
    assert distribution == Normal(mean=2.5, sd=1.5 / sigma)


def test_truncated_normal_is_cut_at_the_limits():
    """A truncated normal has the same σ, cut at the limits."""
    distribution = distribution_of(Limits(low=1.0, high=4.0, distribution="truncated normal", sigma=2.0))
    assert distribution == TruncatedNormal(mean=2.5, sd=0.75, low=1.0, high=4.0)


def test_uniform_and_triangular_lie_between_the_limits():
    """Uniform and symmetric triangular distributions end at the limits, whatever k."""
    assert distribution_of(Limits(low=1.0, high=4.0, distribution="uniform", sigma=7)) == Uniform(low=1.0, high=4.0)
    triangle = distribution_of(Limits(low=1.0, high=4.0, distribution="triangular"))
    assert triangle == Triangular(low=1.0, high=4.0)
    assert triangle.expectation == 2.5


def test_rows_carry_distribution_and_sigma():
    """A row's distribution and limits at ± sigma reach its limits."""
    limits = limits_for(
        variant(),
        row("wall_thickness", -0.0001, 0.0001, distribution="uniform"),
        row("cylinder_length", -0.001, 0.001, limits_sigma=2.0),
    )
    scatter = distributions(limits)
    assert scatter["wall_thickness"] == Uniform(limits["wall_thickness"].low, limits["wall_thickness"].high)
    assert scatter["cylinder_length"].standard_deviation == pytest.approx(0.0005, rel=1e-9)


@pytest.mark.parametrize(
    ("distribution", "reach"),
    [
        ("normal", (2.5 - 8.3 * 0.5, 2.5 + 8.3 * 0.5)),
        ("truncated normal", (1.0, 4.0)),
        ("uniform", (1.0, 4.0)),
        ("triangular", (1.0, 4.0)),
    ],
)
def test_reach_of_limits(distribution, reach):
    """An unbounded normal reaches 8.3σ from its middle, every other distribution its limits."""
    assert Limits(low=1.0, high=4.0, distribution=distribution).reach == pytest.approx(reach, rel=1e-12)


def test_sound_limits_pass():
    """Limits far from any impossible shape come back as they are without a problem."""
    one = variant()
    limits = limits_for(one, *standard_class())
    assert shape_problems(one, limits) == (limits, ())
    assert shape_problems(one, {}) == ({}, ())


@pytest.mark.parametrize(
    ("dimension", "lower", "upper", "detail"),
    [
        ("wall_thickness", -0.0016, 0.001, "0"),
        ("wall_thickness", -0.0017, 0.001, "0"),
        ("cylinder_length", -0.2, 0.2, "0"),
        ("torque", -800.0, 0.0, "0"),
        ("disk_calibration", -1.0, 0.0, "0"),
        ("youngs_modulus", -300e9, 0.0, "0"),
        ("poisson_ratio", 0.0, 0.201, "0.5"),
        ("disk_cone_angle", -math.radians(60), 0.0, "0"),
        ("disk_cone_angle", -math.radians(61), math.radians(1), "0"),
        ("disk_cone_angle", 0.0, math.radians(121), "180°"),
    ],
)
@pytest.mark.parametrize("distribution", ["normal", "uniform"])
def test_limits_beyond_the_possible_are_impossible(dimension, lower, upper, detail, distribution):
    """Limits that reach no thickness, a cone along the axis, or more than ν = 0.5 are impossible in any way."""
    one = variant(disk_cone_angle=math.radians(60))
    limits = limits_for(one, row(dimension, lower, upper, distribution=distribution))
    kept, (problem,) = shape_problems(one, limits)
    assert (problem.kind, problem.dimension, problem.detail) == ("impossible", dimension, detail)
    assert kept == limits


@pytest.mark.parametrize("distribution", ["normal", "uniform", "triangular", "truncated normal"])
@pytest.mark.parametrize(
    ("size", "lower", "upper"), [(0.0, -0.5, 0.5), (2.0, -3.0, 1.0), (2.0, 0.0, 100.0), (0.1, -0.1, -0.1)]
)
def test_thickness_exponents_have_no_bound(size, lower, upper, distribution):
    """A disk may thin with any power of the radius, negative ones too, so that no tail is cut either."""
    one = variant(disk_hub_thickness=0.004, disk_thickness_exponent=size)
    limits = limits_for(one, row("disk_thickness_exponent", lower, upper, distribution=distribution))
    assert limits["disk_thickness_exponent"].cut is None
    assert shape_problems(one, limits) == (limits, ())


@pytest.mark.parametrize("degrees", [30, 89, 90])
def test_cone_angles_scatter_about_flat_too(degrees):
    """A cone or a flat disk scatters by some degrees to either side, beyond 90° as well, uncut."""
    one = variant(disk_cone_angle=math.radians(degrees))
    half = math.radians(2)
    limits = limits_for(one, row("disk_cone_angle", -half, half))
    assert limits["disk_cone_angle"].high == pytest.approx(math.radians(degrees + 2), rel=1e-12)
    assert shape_problems(one, limits) == (limits, ())


def test_exponent_and_cone_angle_of_other_disks_are_silent():
    """Rows for exponent and cone angle set no limits on a variant without them."""
    rows = [row("disk_thickness_exponent", -0.1, 0.1), row("disk_cone_angle", -0.01, 0.01)]
    assert limits_of(variant(), rows) == ({}, ())


def test_every_impossible_dimension_is_named():
    """All impossible dimensions are named, not just the first."""
    one = variant()
    limits = limits_for(one, row("wall_thickness", -0.002, 0.0), row("cylinder_length", -0.2, 0.0))
    _, problems = shape_problems(one, limits)
    assert kinds(problems) == [("impossible", "cylinder_length"), ("impossible", "wall_thickness")]


def test_shift_to_an_impossible_size_is_impossible():
    """A shift without scatter that takes all of a thickness is impossible."""
    one = variant()
    _, problems = shape_problems(one, limits_for(one, row("wall_thickness", -0.0016, -0.0016)))
    assert kinds(problems) == [("impossible", "wall_thickness")]


def test_poisson_ratio_of_just_a_half_is_possible():
    """Limits that reach ν = 0.5 and no further are possible."""
    one = variant()
    limits = limits_for(one, row("poisson_ratio", -0.2, 0.2, distribution="uniform"))
    assert shape_problems(one, limits) == (limits, ())


@pytest.mark.parametrize(
    ("dimension", "half", "bounds"),
    [
        ("wall_thickness", 0.0008, (0.0, math.inf)),
        ("cylinder_length", 0.1, (0.0, math.inf)),
        ("cylinder_calibration", 0.9, (0.0, math.inf)),
        ("poisson_ratio", 0.1, (-1.0, 0.5)),
        ("disk_cone_angle", math.radians(34), (0.0, math.pi)),
    ],
)
def test_far_tails_of_a_normal_are_cut(dimension, half, bounds):
    """A normal whose 8.3σ would reach an impossible size is cut there, and just there, with a problem told."""
    one = variant(disk_cone_angle=math.pi / 2)
    limits = limits_for(one, row(dimension, -half, half))
    kept, (problem,) = shape_problems(one, limits)
    assert (problem.kind, problem.dimension) == ("cut", dimension)
    low, high = reach_of(distribution_of(kept[dimension]))
    assert bounds[0] <= low
    assert high <= bounds[1]
    assert (kept[dimension].low, kept[dimension].high) == (limits[dimension].low, limits[dimension].high)
    assert distribution_of(kept[dimension]).expectation == pytest.approx(one.dimensions[dimension], rel=1e-3)


@pytest.mark.parametrize("distribution", ["uniform", "triangular", "truncated normal"])
def test_bounded_distributions_are_never_cut(distribution):
    """A distribution that ends at its limits has no tails to cut."""
    one = variant()
    limits = limits_for(one, row("wall_thickness", -0.0015, 0.0015, distribution=distribution))
    assert shape_problems(one, limits) == (limits, ())


@pytest.mark.parametrize("sigma", [8.2, 8.4])
def test_tails_are_cut_from_8_3_sigma_on(sigma):
    """A thickness that lies 8.2σ from zero is cut, one 8.4σ from zero is not."""
    one = variant()
    half = 0.0016 * 3 / sigma
    _, problems = shape_problems(one, limits_for(one, row("wall_thickness", -half, half)))
    assert bool(problems) is (sigma < 8.3)


GAPS = {
    "cup, hub below the mean radius": (variant(disk_inner_radius=0.0795), "disk_inner_radius", "mean_radius"),
    "cup with its own r_co": (
        variant(disk_inner_radius=0.0795, disk_outer_radius=0.080),
        "disk_inner_radius",
        "disk_outer_radius",
    ),
    "hat, flange above the mean radius": (
        variant("hat", disk_inner_radius=None, disk_outer_radius=0.0805),
        "mean_radius",
        "disk_outer_radius",
    ),
    "hat with its own r_ci": (
        variant("hat", disk_inner_radius=0.080, disk_outer_radius=0.0805),
        "disk_inner_radius",
        "disk_outer_radius",
    ),
}
each_gap = pytest.mark.parametrize(("one", "inner", "outer"), GAPS.values(), ids=list(GAPS))


@each_gap
def test_limits_where_the_hub_outgrows_the_disk_are_impossible(one, inner, outer):
    """Limits at which the inner radius reaches the outer one are impossible."""
    rows = [row(name, -0.00025, 0.00025, distribution="uniform") for name in (inner, outer)]
    kept, problems = shape_problems(one, limits_for(one, *rows))
    assert kinds(problems) == [("impossible", inner)]
    assert problems[0].detail == "the other radius of the disk"
    assert set(kept) == {inner, outer}


@each_gap
def test_limits_that_leave_a_disk_are_possible(one, inner, outer):
    """Bounded limits that leave some disk are possible and nothing is cut."""
    rows = [row(name, -0.0002, 0.0002, distribution="uniform") for name in (inner, outer)]
    limits = limits_for(one, *rows)
    assert shape_problems(one, limits) == (limits, ())


@each_gap
def test_tails_that_would_close_the_disk_are_cut(one, inner, outer):
    """Normal tails that would let the hub outgrow the disk are cut between the facing limits, on both sides."""
    limits = limits_for(one, row(inner, -0.0002, 0.0002), row(outer, -0.0002, 0.0002))
    kept, problems = shape_problems(one, limits)
    assert kinds(problems) == [("cut", inner), ("cut", outer)]
    scatter = distributions(kept)
    assert reach_of(scatter[inner])[1] <= reach_of(scatter[outer])[0]
    for name in (inner, outer):
        uncut = limits[name]
        assert scatter[name].expectation == pytest.approx(uncut.middle, abs=0.05 * uncut.standard_deviation)


@each_gap
def test_one_tail_alone_is_cut_at_the_other_limit(one, inner, outer):
    """A normal that faces a bounded or exact radius is cut alone; the other side stays as it is."""
    for normal, other, side in ((inner, outer, 1), (outer, inner, 0)):
        limits = limits_for(one, row(normal, -0.0002, 0.0002), row(other, -0.0002, 0.0002, distribution="uniform"))
        kept, problems = shape_problems(one, limits)
        assert kinds(problems) == [("cut", normal)]
        assert kept[other] == limits[other]
        facing = limits[other].low if side else limits[other].high
        end = reach_of(distributions(kept)[normal])[side]
        assert end <= facing if side else end >= facing
        exact, problems = shape_problems(one, limits_for(one, row(normal, -0.0002, 0.0002)))
        assert kinds(problems) == [("cut", normal)]
        assert set(exact) == {normal}


@each_gap
def test_limits_beyond_8_3_sigma_have_no_tail_to_cut(one, inner, outer):
    """Normals whose limits lie 10σ away never leave them, so that nothing is cut between facing limits."""
    rows = [row(name, -0.0002, 0.0002, limits_sigma=10.0) for name in (inner, outer)]
    limits = limits_for(one, *rows)
    assert shape_problems(one, limits) == (limits, ())


@each_gap
def test_tail_that_meets_limits_beyond_8_3_sigma_is_cut_alone(one, inner, outer):
    """A normal whose tail faces one with limits at 10σ is cut at that one's limit, and it alone."""
    limits = limits_for(one, row(inner, -0.0002, 0.0002), row(outer, -0.0002, 0.0002, limits_sigma=10.0))
    kept, problems = shape_problems(one, limits)
    assert kinds(problems) == [("cut", inner)]
    assert kept[outer] == limits[outer]
    assert reach_of(distributions(kept)[inner])[1] <= limits[outer].low * (1 + 1e-12)


@pytest.mark.parametrize("kind", ["cup", "hat", "cylinder"])
def test_wall_that_fills_the_bore_at_its_limit_is_impossible(kind):
    """A wall whose upper limit is twice the mean radius leaves no bore; a thinner one does, its normal tail is cut."""
    shape = {"cup": {"disk_inner_radius": 0.0001}, "hat": {"disk_inner_radius": None, "disk_outer_radius": 0.2}}
    one = variant(kind, **shape.get(kind, {"disk_inner_radius": None}), wall_thickness=0.155)
    _, problems = shape_problems(one, limits_for(one, row("wall_thickness", -0.005, 0.005, distribution="uniform")))
    assert ("impossible", "wall_thickness") in kinds(problems)
    assert "the axis: no bore is left" in {problem.detail for problem in problems}
    limits = limits_for(one, row("wall_thickness", -0.004, 0.004, distribution="uniform"))
    assert shape_problems(one, limits) == (limits, ())
    kept, problems = shape_problems(one, limits_for(one, row("wall_thickness", -0.003, 0.003)))
    assert kinds(problems) == [("cut", "wall_thickness")]
    assert reach_of(distributions(kept)["wall_thickness"])[1] <= 0.160


def test_a_bore_that_is_entered_never_closes():
    """With a bore the mean radius follows from it, so that no wall fills it."""
    one = from_bore(0.002, 0.150, "cylinder", disk_inner_radius=None)
    limits = limits_for(one, row("wall_thickness", -0.05, 0.05, distribution="uniform"))
    assert shape_problems(one, limits) == (limits, ())


def test_junction_fillet_that_passes_the_axis_at_its_limit_is_impossible():
    """A junction fillet may be as wide as the bore's radius at its limit, no wider; its normal tail is cut there."""
    one = variant(junction_fillet_radius=0.0782, cylinder_length=0.3)
    limits = limits_for(one, row("junction_fillet_radius", -0.001, 0.001, distribution="uniform"))
    assert shape_problems(one, limits) == (limits, ())
    _, problems = shape_problems(one, limits_for(one, row("junction_fillet_radius", 0.0, 0.0011)))
    assert kinds(problems) == [("impossible", "junction_fillet_radius")]
    kept, problems = shape_problems(one, limits_for(one, row("junction_fillet_radius", -0.0009, 0.0009)))
    assert kinds(problems) == [("cut", "junction_fillet_radius")]
    assert reach_of(distributions(kept)["junction_fillet_radius"])[1] <= 0.0792 * (1 + 1e-12)


def test_cylinder_has_no_disk_to_close():
    """A flexspline without disk has no gap that tolerances could close."""
    one = variant("cylinder", disk_inner_radius=None)
    limits = limits_for(one, row("mean_radius", -0.02, 0.02))
    assert shape_problems(one, limits) == (limits, ())


def test_tail_towards_zero_and_towards_the_disk_are_both_cut():
    """A hub radius whose tails reach zero on one side and the disk on the other is cut on both."""
    one = variant(disk_inner_radius=0.040)
    kept, problems = shape_problems(one, limits_for(one, row("disk_inner_radius", -0.035, 0.035)))
    assert kinds(problems) == [("cut", "disk_inner_radius")]
    low, high = reach_of(distributions(kept)["disk_inner_radius"])
    assert low >= 0
    assert high <= 0.080


BORES = {
    "cup": (from_bore(0.081, 0.0016, disk_inner_radius=0.040), "disk_inner_radius", "bore_diameter"),
    "hat": (
        from_bore(0.081, 0.0016, "hat", disk_inner_radius=None, disk_outer_radius=0.0426),
        "bore_diameter",
        "disk_outer_radius",
    ),
}
each_bore = pytest.mark.parametrize(("one", "inner", "outer"), BORES.values(), ids=list(BORES))


def radii(one, scatter):
    """Return inner and outer disk radius [m] of 2^15 parts."""
    sizes = one.dimensions

    def side(name):
        def model(**varying):
            every = {**sizes, **varying}
            shape = np.shape(next(iter(varying.values())))
            return np.broadcast_to(every[name] if name in every else radius_of(every), shape)

        return propagate(model, scatter, method="random", samples=2**15, seed=0).values

    return side("disk_inner_radius"), side("disk_outer_radius")


@each_bore
def test_impossible_limits_of_bore_and_hub(one, inner, outer):
    """With a bore the mean radius that faces the hub or flange is half of bore and wall."""
    sound, problems = shape_problems(
        one, limits_for(one, *(row(name, -0.0001, 0.0001, distribution="uniform") for name in (inner, outer)))
    )
    assert problems == ()
    assert set(sound) == {inner, outer}
    wide = [row(name, -0.001, 0.001, distribution="uniform") for name in (inner, outer)]
    _, problems = shape_problems(one, limits_for(one, *wide))
    assert kinds(problems) == [("impossible", inner)]


def test_wall_limits_count_towards_the_gap():
    """A thin wall's lower limit brings the mean radius down to the hub, which is impossible."""
    one = from_bore(0.0786, 0.0016, disk_inner_radius=0.040)
    sound = limits_for(one, row("wall_thickness", -0.0001, 0.0001, distribution="uniform"))
    assert shape_problems(one, sound) == (sound, ())
    _, problems = shape_problems(one, limits_for(one, row("wall_thickness", -0.0002, 0.0002, distribution="uniform")))
    assert kinds(problems) == [("impossible", "disk_inner_radius")]


@each_bore
def test_cut_of_a_bore_leaves_its_middle_alone(one, inner, outer):
    """Cutting the far tails of bore and hub or flange moves neither mean by more than a hundredth of its sd."""
    limits = limits_for(one, row(inner, -0.0005, 0.0005), row(outer, -0.0005, 0.0005))
    kept, problems = shape_problems(one, limits)
    assert ("cut", "bore_diameter") in kinds(problems)
    for name, distribution in distributions(kept).items():
        deviation = distribution.expectation - limits[name].middle
        assert abs(deviation) <= 0.01 * limits[name].standard_deviation
        assert distribution.standard_deviation == pytest.approx(limits[name].standard_deviation, rel=0.01)


@each_bore
def test_cut_bore_never_meets_the_hub(one, inner, outer):
    """After the cut no bore, even at the end of its tail, makes the disk's inner radius reach the outer one."""
    limits = limits_for(one, row(inner, -0.0005, 0.0005), row(outer, -0.0005, 0.0005))
    kept, _ = shape_problems(one, limits)
    ends = {name: reach_of(distribution) for name, distribution in distributions(kept).items()}
    wall = one.dimensions["wall_thickness"]
    if inner == "bore_diameter":
        assert (ends[inner][1] + wall) / 2 <= ends[outer][0] * (1 + 1e-12)
    else:
        assert ends[inner][1] <= (ends[outer][0] + wall) / 2 * (1 + 1e-12)


def test_bore_wall_and_hub_share_the_gap():
    """With normal bore, wall and hub all three tails are cut so that not even their far ends meet together."""
    one = from_bore(0.081, 0.0016, disk_inner_radius=0.040)
    limits = limits_for(
        one,
        row("bore_diameter", -0.0005, 0.0005),
        row("wall_thickness", -0.0004, 0.0004),
        row("disk_inner_radius", -0.0003, 0.0003),
    )
    kept, problems = shape_problems(one, limits)
    told = {problem.dimension for problem in problems if problem.detail != "0"}
    assert told == {"bore_diameter", "wall_thickness", "disk_inner_radius"}
    scatter = distributions(kept)
    ends = {name: reach_of(distribution) for name, distribution in scatter.items()}
    thinnest = (ends["bore_diameter"][0] + ends["wall_thickness"][0]) / 2
    assert ends["disk_inner_radius"][1] <= thinnest * (1 + 1e-12)
    assert ends["wall_thickness"][0] >= 0
    inner, outer = radii(one, scatter)
    assert (inner < outer).all()


def test_wall_tail_that_would_close_the_disk_is_cut():
    """A wall whose 8.3σ would bring the mean radius of a bore down to the hub is cut, with a problem told."""
    one = from_bore(0.0788, 0.0016, disk_inner_radius=0.040)
    limits = limits_for(one, row("wall_thickness", -0.0003, 0.0003))
    kept, problems = shape_problems(one, limits)
    assert [problem.kind for problem in problems] == ["cut"]
    inner, outer = radii(one, distributions(kept))
    assert (inner < outer).all()
    thinnest = reach_of(distributions(kept)["wall_thickness"])[0]
    assert (0.0788 + thinnest) / 2 >= 0.040 * (1 - 1e-12)


@pytest.mark.parametrize(
    ("changes", "rows"),
    [
        ({"rim_length": 0.1595, "rim_thickness": 0.0032}, [("rim_length", 0.001)]),
        (
            {"rim_length": 0.1565, "rim_thickness": 0.0032, "junction_fillet_radius": 0.0035},
            [("cylinder_length", 0.001)],
        ),
        ({"hub_fillet_radius": 0.040}, [("hub_fillet_radius", 0.001)]),
    ],
    ids=["rim longer than the cylinder", "rim and fillet longer than the cylinder", "fillet wider than the disk"],
)
def test_refinements_that_overlap_at_a_limit_are_computed_without_a_break(changes, rows):
    """Where only a limit lets refinements overlap, that is told, and the backlash goes on smoothly beyond."""
    one = variant(**changes)
    limits = limits_for(one, *(row(name, -half, half, distribution="uniform") for name, half in rows))
    kept, problems = shape_problems(one, limits)
    assert kept == limits
    assert [problem.kind for problem in problems] == ["overlap"]
    ((name, limit),) = limits.items()
    low, middle, high = (
        float(backlash("cup", one.dimensions | {name: at})) for at in (limit.low, limit.middle, limit.high)
    )
    assert min(low, high) < middle < max(low, high)
    assert abs(low + high - 2 * middle) < 0.05 * abs(high - low)


@pytest.mark.slow
@thorough
@given(
    name=st.sampled_from(["cylinder_length", "wall_thickness", "mean_radius", "disk_inner_radius", "poisson_ratio"]),
    share=st.floats(0.001, 0.05),
    factor=st.floats(1.0, 4.0),
    distribution=st.sampled_from(["normal", "truncated normal", "uniform", "triangular"]),
)
def test_wider_tolerance_never_narrows_the_spread(name, share, factor, distribution):
    """A wider tolerance on one dimension never narrows the spread of the backlash."""
    one = variant()
    sds = []
    for half in (share * CUP[name], share * factor * CUP[name]):
        limits = limits_for(one, row(name, -half, half, distribution=distribution))
        kept, problems = shape_problems(one, limits)
        assert all(problem.kind == "cut" for problem in problems)

        def model(**varying):
            return backlash("cup", CUP | varying)

        spread = propagate(model, distributions(kept), method="sobol", samples=1024, seed=0)
        sds.append((spread.sd, spread.quantile(0.975) - spread.quantile(0.025)))
    assert sds[1][0] >= sds[0][0] * (1 - 1e-9)
    assert sds[1][1] >= sds[0][1] * (1 - 1e-9)


@thorough
@given(low=st.floats(-10, 10), width=st.floats(1e-6, 10), sigma=st.floats(0.5, 10))
def test_limits_are_centred(low, width, sigma):
    """Whatever scatters between limits is centred on their middle."""
    for distribution in ("normal", "truncated normal", "uniform", "triangular"):
        limits = Limits(low=low, high=low + width, distribution=distribution, sigma=sigma)
        assert distribution_of(limits).expectation == pytest.approx(low + width / 2, abs=1e-9 * (width + 1))


def test_every_dimension_may_have_a_row():
    """Rows of every dimension are sorted without a fault, those of B3-160 apply."""
    rows = [row(name, -1e-3, 1e-3, relative=True) for name in reversed(DIMENSIONS)]
    assert list(limits_for(variant(), *rows)) == [name for name in DIMENSIONS if name in CUP]
