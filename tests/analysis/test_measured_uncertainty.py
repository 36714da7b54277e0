"""What measured parts leave open of the spread of rows."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from grids import for_each
from scipy import stats
from toleranced import every_number, plan, row

from flexlash.analysis.measured_uncertainty import with_measured_uncertainty
from flexlash.analysis.tolerance_spread import row_statistics
from flexlash.mechanics.flexspline import backlash
from flexlash.schema.variant import Limits, MeasuredDimension
from flexlash.tolerance.row_batches import batch_statistics

KEYS = [f"{key}_sample_{end}" for key in ("probability_over_limit", "p99_865") for end in ("low", "high")]
CUP = partial(backlash, "cup")
SIZES = {
    "torque": 800.0,
    "cylinder_length": 0.16,
    "mean_radius": 0.08,
    "wall_thickness": 1.6e-3,
    "youngs_modulus": 209e9,
    "poisson_ratio": 0.29,
    "disk_inner_radius": 0.037,
    "disk_outer_radius": 0.08,
    "disk_thickness": 1.6e-3,
    "cylinder_calibration": 1.0,
    "disk_calibration": 1.0,
}


def sampled(name, low, high, count):
    """Return limits of a dimension of which so many parts were measured, with an eighth of the limits as their sd."""
    sd = (high - low) / 8
    values = np.random.default_rng(count).standard_normal(count)
    values = (low + high) / 2 + sd * (values - values.mean()) / values.std(ddof=1)
    sample = MeasuredDimension(sample="s", dimension=name, values=tuple(values), parts=tuple(range(count)))
    return Limits(low=low, high=high, sd=sd, sample=sample)


def cup(count=60, limit=1.01, **others):
    """Return a cup of which the wall, and others if so given, were measured."""
    limits = {
        "cylinder_length": Limits(low=0.1599, high=0.1601),
        "wall_thickness": sampled("wall_thickness", 1.58e-3, 1.62e-3, count),
        "youngs_modulus": Limits(low=209e9 * 0.995, high=209e9 * 1.005),
    }
    ordered = {name: (limits | others)[name] for name in SIZES if name in limits | others}
    return row(CUP, SIZES, ordered, float(CUP(SIZES)) * limit)


def told(*rows, sampling=None, jobs=1):
    """Return what the spread stage tells of rows."""
    found = dict(row_statistics(rows, sampling or plan(), jobs))
    return [found[index] for index in range(len(rows))]


def interval(statistics):
    """Return the ends of both intervals."""
    return [statistics.numbers[key] for key in KEYS]


def test_rows_without_samples_keep_every_bit():
    """What was not measured is told nothing, and nothing of it changes, beside measured rows or not."""
    limits = {name: replace(limit, sample=None) for name, limit in cup().limits.items()}
    plain = replace(cup(), limits=limits)
    (alone,) = batch_statistics([plain], plan())
    _, beside = told(cup(), plain)
    assert every_number(beside) == every_number(alone)
    assert not {*KEYS} & {*beside.numbers}


def test_a_measured_row_keeps_what_the_calculation_says():
    """The sample adds its interval to the row and changes no other number."""
    (alone,) = batch_statistics([cup()], plan())
    (found,) = told(cup())
    assert {key: value for key, value in found.numbers.items() if key not in KEYS} == alone.numbers
    low, high, least, most = interval(found)
    assert 0 < low < found.numbers["probability_over_limit"] < high < 1
    assert least < found.numbers["p99_865"] < most


def test_the_bits_do_not_depend_on_other_rows():
    """A row has the same interval alone, beside rows like it and unlike it, in any order."""
    rows = [
        cup(),
        cup(20),
        cup(60, 1.02),
        cup(disk_thickness=sampled("disk_thickness", 1.58e-3, 1.62e-3, 30)),
        cup(200),
    ]
    together, backwards = told(*rows), told(*rows[::-1])[::-1]
    for one, first, second in zip(rows, together, backwards, strict=True):
        assert interval(told(one)[0]) == interval(first) == interval(second)


def test_a_shape_that_was_measured_leaves_more_open_than_a_normal_one():
    """Where the values' own shape is taken, its tails are uncertain, too, and no bit depends on neighbours."""
    wall = cup().limits["wall_thickness"]
    one = cup(wall_thickness=replace(wall, distribution="measured"))
    shaped, normal = told(one, cup())
    low, high, least, most = interval(shaped)
    assert 1.2 * (interval(normal)[3] - interval(normal)[2]) < most - least
    assert low < interval(normal)[0] < interval(normal)[1] < high
    assert interval(told(one)[0]) == interval(shaped)


def test_more_parts_leave_less():
    """The interval shrinks as the root of the number of parts does."""
    widths = [np.log(high / low) for low, high, *_ in map(interval, told(cup(25), cup(100), cup(400)))]
    assert widths[0] / widths[1] == pytest.approx(2, rel=0.2)
    assert widths[1] / widths[2] == pytest.approx(2, rel=0.1)


def test_a_second_sample_widens_it():
    """What a second measured dimension leaves open comes on top."""
    both = cup(disk_thickness=sampled("disk_thickness", 1.58e-3, 1.62e-3, 60))
    known = cup(disk_thickness=replace(both.limits["disk_thickness"], sample=None))
    (first, second) = told(known, both)
    assert first.numbers["probability_over_limit"] == second.numbers["probability_over_limit"]
    widths = [np.log(high / low) for low, high, *_ in map(interval, (first, second))]
    assert 1.05 * widths[0] < widths[1] < 1.5 * widths[0]


@for_each("method", ("sobol", "random"))
def test_points_leave_the_interval_to_lines(method):
    """By points, which would count no unit over a far limit, the interval is that of lines."""
    one = cup(limit=1.03)
    by_lines, by_points = told(one)[0], told(one, sampling=plan(method, samples=512))[0]
    assert by_points.texts["spread_method"] == method
    assert interval(by_points) == interval(by_lines)


def test_without_a_limit_only_the_percentile_is_told():
    """A row without a limit has an interval of its percentile."""
    one = replace(cup(), upper_limit=None)
    (found,) = told(one)
    assert [key for key in KEYS if key in found.numbers] == KEYS[2:]


def test_limits_that_coincide_do_not_scatter():
    """A sample of a dimension whose limits coincide moves nothing, since it does not scatter."""
    fixed = replace(cup(), limits={"wall_thickness": Limits(low=1.6e-3, high=1.6e-3)})
    sample = cup().limits["wall_thickness"].sample
    measured = replace(fixed, limits={"wall_thickness": replace(fixed.limits["wall_thickness"], sample=sample)})
    statistics = batch_statistics([measured], plan())
    assert with_measured_uncertainty([measured], statistics, plan()) == statistics


def test_a_dimension_that_does_nothing_leaves_nothing_open():
    """Where the measured dimension has no part in the output, no interval is told rather than a wrong one."""

    def constant(dimensions):
        return 0.0 * dimensions["torque"]

    one = row(constant, {"torque": 0.0}, {"torque": sampled("torque", -4.0, 4.0, 60)}, 1.0)
    assert not {*KEYS} & {*told(one)[0].numbers}


def root(dimensions):
    """Return what only sizes from 0.65 on have."""
    return np.sqrt(dimensions["torque"] - 0.65)


def test_ends_that_reach_what_cannot_be_tell_nothing():
    """Where an end reaches impossible shapes nothing is told, and rows beside it keep their bits."""
    near, far = (
        row(root, {"torque": 1.0}, {"torque": replace(sampled("torque", *ends, 5), distribution="measured")}, 1.2)
        for ends in ((0.96, 1.04), (0.72, 1.28))
    )
    alone = interval(told(near)[0])
    first, second = told(near, far)
    assert interval(first) == alone
    assert not {*KEYS} & {*second.numbers}


def test_a_wide_process_of_few_parts_keeps_to_where_it_ended():
    """The upper end of a scatter that would reach impossible sizes is cut where the process as measured ends."""
    wide = sampled("torque", 0.6, 1.4, 5)
    one = row(lambda d: np.sqrt(d["torque"]), {"torque": 1.0}, {"torque": wide}, 1.2)
    low, high, least, most = interval(told(one)[0])
    assert 0 <= low < high < 0.5
    assert least < most < (1 + 8.3 * 0.1) ** 0.5


def test_lots_do_not_change_it():
    """What lots share is no matter of how many parts were measured."""
    one = cup()
    assert interval(told(replace(one, between=frozenset({"youngs_modulus"})))[0]) == interval(told(one)[0])


def together(correlation, count, limit=1.0):
    """Return a sum of two dimensions measured on the same parts, with exactly this correlation."""
    first, second = np.random.default_rng(7).standard_normal((2, count))
    first = (first - first.mean()) / first.std(ddof=1)
    second -= second.mean() + first * (first @ second) / (first @ first)
    second = correlation * first + (1 - correlation**2) ** 0.5 * second / second.std(ddof=1)
    limits = {}
    for name, values, sd in (("cylinder_length", first, 1.0), ("wall_thickness", second, 2.0)):
        sample = MeasuredDimension(sample="s", dimension=name, values=tuple(sd * values), parts=tuple(range(count)))
        limits[name] = Limits(low=-4.0 * sd, high=4.0 * sd, sd=sd, sample=sample)
    sd = (1.0 + 4.0 + 4.0 * correlation) ** 0.5
    one = row(lambda d: 10.0 + d["cylinder_length"] + d["wall_thickness"], dict.fromkeys(limits, 0.0), limits, 10.0)
    tied = (("cylinder_length", "wall_thickness", correlation),)
    return replace(one, upper_limit=10.0 + limit * sd, correlation=tied), sd


@for_each("case", [(0.5, 40, 3.0), (-0.6, 40, 2.0), (0.9, 15, 3.0), (0.3, 200, 4.0)])
def test_two_dimensions_of_the_same_parts_are_one_sample_of_their_sum(case):
    """Where the output is the sum of two dimensions measured together, the intervals are those of a sample of sums."""
    correlation, count, score = case
    one, sd = together(correlation, count, score)
    low, high, least, most = interval(told(one)[0])
    root = count**0.5
    exact = stats.nct.ppf([0.025, 0.975], count - 1, root * 3.0) / root
    assert [(end - 10.0) / sd for end in (least, most)] == pytest.approx(exact, abs=0.05 * (exact[1] - exact[0]))
    for end, share in ((high, 0.975), (low, 0.025)):
        assert stats.nct.cdf(root * score, count - 1, root * stats.norm.isf(end)) == pytest.approx(share, abs=0.008)


def test_an_entered_correlation_is_taken_as_known():
    """A correlation that was entered instead of the measured one leaves nothing open itself."""
    one, _ = together(0.5, 40, 3.0)
    entered = replace(one, correlation=(("cylinder_length", "wall_thickness", 0.51),))
    measured, known = interval(told(one)[0]), interval(told(entered)[0])
    assert known[3] - known[2] < 0.97 * (measured[3] - measured[2])


def test_correlations_keep_to_what_the_others_allow():
    """The end of a measured correlation's interval that contradicts another one is drawn back to where it does not."""
    one, _ = together(0.95, 15, 3.0)
    third = Limits(low=-4.0, high=4.0, sd=1.0)
    limits = {"torque": third, **one.limits}
    ties = (*one.correlation, ("torque", "cylinder_length", 0.8), ("torque", "wall_thickness", 0.94))
    tied = replace(one, limits=limits, nominal=dict.fromkeys(limits, 0.0), correlation=ties)
    assert 0 < interval(told(tied)[0])[0] < told(tied)[0].numbers["probability_over_limit"]
