"""Processes behind limits: the harmful side of Cpk, samples, measured shapes; one by one as for many at once."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest
from b3_160 import NOMINAL
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.analysis.backlash_models import BACKLASH_OF
from flexlash.schema.variant import Limits, MeasuredDimension, ToleranceRow, Variant
from flexlash.tolerance import Normal, TruncatedNormal
from flexlash.tolerance.dimension_limits import distribution_of, limits_of, shape_problems
from flexlash.tolerance.limit_arrays import beyond_doubt, limits_alike
from flexlash.tolerance.measured import Measured

thorough = settings(deadline=None, max_examples=60, derandomize=True)

CALIBRATIONS = {"cylinder_calibration": 1.0, "disk_calibration": 1.0}
CUP = NOMINAL | CALIBRATIONS
REFINED = CUP | {
    "disk_thickness": 0.002, "disk_outer_radius": 0.081, "disk_hub_thickness": 0.004, "hub_fillet_radius": 0.001,
    "junction_fillet_radius": 0.001, "rim_length": 0.03, "rim_thickness": 0.003,
}  # fmt: skip
BORED = {name: size for name, size in CUP.items() if name != "mean_radius"} | {"bore_diameter": 0.1584}
TUBE = {name: size for name, size in CUP.items() if "disk" not in name} | {"disk_calibration": 1.0}
WALLS = (1.603, 1.6035, 1.605, 1.6115, 1.604, 1.6025, 1.607, 1.6045)


def variant(dimensions=CUP, kind="cup", **changes):
    """Return a variant with some dimensions changed."""
    return Variant(
        row=2, name="V", flexspline_type=kind, material="20Cr2Ni4", tolerance_class="own",
        dimensions={**dimensions, **changes},
    )  # fmt: skip


def tolerance(dimension, half=2e-5, **rest):
    """Return a row of Tolerances within ± half in SI."""
    return ToleranceRow(row=3, tolerance_class="own", dimension=dimension, **{"lower": -half, "upper": half} | rest)


def measured(values=WALLS, dimension="wall_thickness", *, deviations=False):
    """Return a sample of values in mm."""
    return MeasuredDimension(
        sample="S", dimension=dimension, values=tuple(value / 1e3 for value in values),
        parts=tuple(range(len(values))), are_deviations=deviations,
    )  # fmt: skip


def only(one, row):
    """Return the limits that one row gives a variant."""
    limits, problems = limits_of(one, [row], BACKLASH_OF[one.flexspline_type])
    assert problems == ()
    return limits[row.dimension]


def finite_slope(one, name):
    """Return whether the backlash rises with a dimension, by a small step up and down."""
    model, size = BACKLASH_OF[one.flexspline_type], one.dimensions[name]
    less, more = (float(model({**one.dimensions, name: size * factor})) for factor in (1 - 1e-5, 1 + 1e-5))
    return more - less


CASES = [("cup", CUP), ("cup", REFINED), ("cup", BORED), ("cylinder", TUBE)]


@pytest.mark.parametrize(("kind", "dimensions"), CASES)
def test_cpk_puts_the_mean_on_the_side_that_raises_the_backlash(kind, dimensions):
    """Of every dimension the mean lies (Cp − Cpk)·3σ off the middle, to where the backlash is greater."""
    one, cp, cpk = variant(dimensions, kind), 1.6, 1.2
    told = set()
    for name in dimensions:
        row = tolerance(name, 0.01, relative=True, limits_sigma=3 * cp, harmful_shift=(cp - cpk) / (2 * cp))
        limits, slope = only(one, row), finite_slope(one, name)
        expected = (cp - cpk) * 3 * limits.standard_deviation
        assert abs(limits.mean_shift) == pytest.approx(expected, rel=1e-9), name
        if slope:
            assert np.sign(limits.mean_shift) == np.sign(slope), name
        room = min(limits.high - limits.mean, limits.mean - limits.low)
        assert room / (3 * limits.standard_deviation) == pytest.approx(cpk, rel=1e-9), name
        told.add((name, limits.mean_shift > 0))
    assert ("wall_thickness", False) in told
    assert ("torque", True) in told


def test_the_harmful_side_takes_a_model():
    """Which side is harmful cannot be told without one; other rows need none."""
    with pytest.raises(LookupError, match="which limit of wall_thickness is harmful"):
        limits_of(variant(), [tolerance("wall_thickness", harmful_shift=0.1)])
    assert limits_of(variant(), [tolerance("wall_thickness", mean_shift=1e-6)])[0]


def test_limits_that_no_part_has_do_not_stop_the_harmful_side():
    """Where a limit makes no part its problem is told, and nothing fails before."""
    row = tolerance("wall_thickness", 0.0016, harmful_shift=0.1)
    limits, _ = limits_of(variant(), [row], BACKLASH_OF["cup"])
    assert [one.kind for one in shape_problems(variant(), limits)[1]] == ["impossible"]


@pytest.mark.parametrize(("cp", "sigma"), [(1.1, 3.3), (1.0, 3.0), (4 / 3, 4.0), (1.67, 5.01), (0.7, 2.1)])
def test_a_centred_cp_is_limits_at_three_cp(cp, sigma):
    """Cp 1.1 in the middle is k = 3.3, to the bit."""
    row = tolerance("wall_thickness", limits_sigma=float(f"{3 * cp:.15g}"))
    assert only(variant(), row) == only(variant(), tolerance("wall_thickness", limits_sigma=sigma))


@pytest.mark.parametrize("grade", [None, "IT9"])
def test_a_sample_gives_mean_and_sd(grade):
    """Mean and standard deviation are the sample's, whatever the limits; these stay the drawing's."""
    row = tolerance("wall_thickness", sample=measured(), **({"grade": grade} if grade else {}))
    limits = only(variant(), row)
    values = np.array(WALLS) / 1e3
    assert limits.mean == pytest.approx(values.mean(), rel=1e-14)
    assert limits.standard_deviation == pytest.approx(values.std(ddof=1), rel=1e-12)
    assert (limits.low, limits.high) == pytest.approx(
        (0.0016 - 12.5e-6, 0.0016 + 12.5e-6) if grade else (0.00158, 0.00162)
    )
    assert limits.sample is row.sample
    assert distribution_of(limits) == Normal(limits.mean, limits.standard_deviation)


def test_deviations_go_with_the_nominal_value():
    """A sample of deviations has its mean above the entered value, one of values where it was measured."""
    deviations = measured([value - 1.6 for value in WALLS], deviations=True)
    for size in (0.0016, 0.0021):
        moved = only(variant(wall_thickness=size), tolerance("wall_thickness", sample=deviations))
        assert moved.mean == pytest.approx(size + np.mean(WALLS) / 1e3 - 0.0016, rel=1e-12)
        still = only(variant(wall_thickness=size), tolerance("wall_thickness", sample=measured()))
        assert still.mean == pytest.approx(np.mean(WALLS) / 1e3, rel=1e-12)


def test_a_sample_applies_where_its_dimension_does():
    """A bore that was measured has no part in a variant that is given by its mean radius, and the other way round."""
    bores = tolerance("bore_diameter", sample=measured([158.4, 158.41, 158.39, 158.4, 158.42], "bore_diameter"))
    radii = tolerance("mean_radius", sample=measured([80.0, 80.01, 79.99, 80.0, 80.02], "mean_radius"))
    for dimensions, name in ((CUP, "mean_radius"), (BORED, "bore_diameter")):
        limits, problems = limits_of(variant(dimensions), [bores, radii])
        assert (list(limits), problems) == ([name], ())
    assert limits["bore_diameter"].mean == pytest.approx(0.158404, rel=1e-12)


def test_a_measured_shape_has_the_mean_and_sd_of_the_limits():
    """The curve is the sample's at the limits' mean and sd, so that a mean moved and a sd scaled move and scale it."""
    row = tolerance("wall_thickness", sample=measured(), distribution="measured")
    limits = only(variant(), row)
    found, alone = distribution_of(limits), Measured(measured().values)
    probability = np.linspace(0.01, 0.99, 50)
    assert found.shape == alone.shape
    at = found.location + found.scale * found.standard(probability)
    assert at == pytest.approx(alone.location + alone.scale * alone.standard(probability), rel=1e-12)
    other = distribution_of(replace(limits, mean_shift=limits.mean_shift + 1e-5, sd=2 * limits.sd))
    moved = other.location + other.scale * other.standard(probability)
    assert moved - limits.mean - 1e-5 == pytest.approx(2 * (at - limits.mean), abs=1e-15)
    assert other.probability_below(other.standard(probability)) == pytest.approx(probability, rel=1e-9)
    assert (other.expectation, other.standard_deviation, other.breaks) == (other.location, other.scale, alone.breaks)


def test_a_truncated_normal_takes_a_sample_for_its_parent():
    """Mean and sd are the parent's, the cuts the drawing's limits."""
    limits = only(variant(), tolerance("wall_thickness", sample=measured(), distribution="truncated normal"))
    assert distribution_of(limits) == TruncatedNormal(limits.mean, limits.sd, limits.low, limits.high)


def test_a_measured_distribution_has_a_sample():
    """Without one there is no shape."""
    with pytest.raises(LookupError, match="without its sample"):
        distribution_of(Limits(low=1.0, high=2.0, distribution="measured", sd=0.1))


ROWS = st.fixed_dictionaries(
    {
        "dimension": st.sampled_from(
            ["wall_thickness", "disk_inner_radius", "youngs_modulus", "cylinder_length", "torque"]
        ),
        "half": st.floats(0.01, 0.6),
        "relative": st.booleans(),
        "distribution": st.sampled_from(["normal", "truncated normal", "measured"]),
        "process": st.sampled_from(["shift", "harmful", "values", "deviations"]),
        "amount": st.floats(-0.6, 0.6),
        "spread": st.floats(0.05, 1.0),
    }
)


def row_of(drawn):
    """Return a row of Tolerances with a drawn process."""
    name = drawn["dimension"]
    size = CUP[name]
    half = drawn["half"] if drawn["relative"] else drawn["half"] * size
    rest = {"relative": drawn["relative"], "distribution": drawn["distribution"]}
    if drawn["process"] in {"values", "deviations"} or drawn["distribution"] == "measured":
        is_deviation = drawn["process"] == "deviations"
        values = (np.array([-1.0, -0.4, 0.1, 0.3, 1.6]) * drawn["spread"] + drawn["amount"]) * drawn["half"] * size
        values = values + (0.0 if is_deviation else size)
        rest["sample"] = MeasuredDimension(
            sample="S",
            dimension=name,
            values=tuple(values.tolist()),
            parts=(1, 2, 3, 4, 5),
            are_deviations=is_deviation,
        )
    elif drawn["process"] == "harmful":
        rest |= {"harmful_shift": abs(drawn["amount"]), "limits_sigma": 3 / drawn["spread"]}
    else:
        rest |= {"mean_shift": drawn["amount"] * half, "sd": drawn["spread"] * half}
    return tolerance(name, half, **rest)


@pytest.mark.slow
@thorough
@given(ROWS)
def test_many_at_once_have_the_bits_of_each_alone(drawn):
    """Limits, mean and sd of arrays of variants are those that each variant has alone."""
    row, count = row_of(drawn), 7
    factors = np.linspace(0.8, 1.2, count)
    columns = {name: np.full(count, size) for name, size in CUP.items()}
    columns[row.dimension] = columns[row.dimension] * factors
    together = limits_alike(columns, [row], BACKLASH_OF["cup"])[row.dimension]
    for place in range(count):
        one = variant({name: float(values[place]) for name, values in columns.items()})
        alone = only(one, row)
        found = (together.low[place], together.high[place], together.mean[place], together.sd[place])
        assert found == (alone.low, alone.high, alone.mean, alone.standard_deviation)


@pytest.mark.slow
@thorough
@given(ROWS)
def test_what_is_beyond_doubt_has_no_problem(drawn):
    """Variants that the quick look leaves alone have no problem of shape; nearly all others have one."""
    row, count = row_of(drawn), 25
    columns = {name: np.full(count, size) for name, size in CUP.items()}
    columns[row.dimension] = columns[row.dimension] * np.linspace(0.05, 1.9, count)
    sure = beyond_doubt("cup", columns, limits_alike(columns, [row], BACKLASH_OF["cup"]))
    told = []
    for place in range(count):
        one = variant({name: float(values[place]) for name, values in columns.items()})
        told.append(bool(shape_problems(one, limits_of(one, [row], BACKLASH_OF["cup"])[0])[1]))
    assert not (sure & told).any()
    assert (sure | told).sum() >= count - 2


def test_a_measured_shape_that_reaches_no_part_is_impossible():
    """A sample whose curve goes below a thickness of 0 has no tail that could be cut: that is told as impossible."""
    row = tolerance("wall_thickness", 1.5e-3, sample=measured([0.05, 0.4, 1.6, 2.9, 3.0]), distribution="measured")
    limits, _ = limits_of(variant(), [row])
    (problem,) = shape_problems(variant(), limits)[1]
    assert (problem.kind, problem.detail) == ("impossible", "0 with what its sample shows")
    (problem,) = shape_problems(
        variant(), {"wall_thickness": replace(limits["wall_thickness"], distribution="normal")}
    )[1]
    assert problem.kind == "cut"


def test_a_measured_hub_that_meets_the_disks_edge_is_impossible():
    """Hub and outer radius that are measured close are judged by what their shapes reach, beside their limits."""
    one = variant(disk_inner_radius=0.0790, disk_outer_radius=0.080)
    near = tuple(79.0 + step for step in (-0.3, -0.1, 0.0, 0.1, 0.3))
    row = tolerance("disk_inner_radius", 1e-4, sample=measured(near, "disk_inner_radius"), distribution="measured")
    assert shape_problems(one, limits_of(one, [row])[0])[1] == ()
    far = replace(row, sample=measured([value + 0.6 for value in near], "disk_inner_radius"))
    (problem,) = shape_problems(one, limits_of(one, [far])[0])[1]
    assert problem.kind == "impossible"


def test_a_normal_is_cut_beside_a_measured_shape():
    """The tail of a normal is cut in the room that a measured neighbour leaves."""
    one = variant(disk_inner_radius=0.0790, disk_outer_radius=0.080)
    near = tuple(79.0 + step for step in (-0.3, -0.1, 0.0, 0.1, 0.3))
    hub = tolerance("disk_inner_radius", 1e-4, sample=measured(near, "disk_inner_radius"), distribution="measured")
    limits, _ = limits_of(one, [hub, tolerance("disk_outer_radius", 2e-4)])
    kept, problems = shape_problems(one, limits)
    assert [problem.kind for problem in problems] == ["cut"]
    edge, hub_reach = distribution_of(kept["disk_outer_radius"]), distribution_of(kept["disk_inner_radius"])
    least = edge.location + edge.scale * edge.standard_at(np.array([-8.3]))
    assert least[0] >= (hub_reach.location + hub_reach.scale * hub_reach.standard_at(np.array([8.3])))[0] - 1e-15


def test_lots_are_carried_also_where_nothing_scatters():
    """Limits say between what a dimension scatters, whatever its process."""
    for rest in ({}, {"sample": measured()}, {"lower": 1e-6, "upper": 1e-6}):
        assert only(variant(), tolerance("wall_thickness", scatters_between="lots", **rest)).scatters_between == "lots"


def test_samples_are_one_in_any_process():
    """A sample that went through another process is the same, and its hash is of numbers alone."""
    one = measured()
    assert hash(one) == hash((one.values, one.parts, one.are_deviations))
    again = pickle.loads(pickle.dumps(one))  # noqa: S301
    assert (again, hash(again)) == (one, hash(one))
    assert measured([1.6]).standard_deviation == measured([1.6] * 6).standard_deviation == 0
