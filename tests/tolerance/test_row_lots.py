"""Lots and parts of rows alike: right, told beside each row's spread, and to the last bit the row's own."""

import math
from dataclasses import replace
from itertools import chain

import numpy as np
import pytest
from b3_160 import CUP, NOMINAL
from scipy import stats
from toleranced import SUM, every_number, plan, row, statistics_of_row

from flexlash.schema.units import ARCMIN
from flexlash.tolerance import propagate
from flexlash.tolerance.dimension_limits import Limits, distributions
from flexlash.tolerance.engine.line_direction import Inputs
from flexlash.tolerance.engine.line_lots import LineNumbers, SeparableLots
from flexlash.tolerance.engine.lot_inputs import PRODUCT, LotsAndParts
from flexlash.tolerance.row_batches import RowBatch, batch_statistics, batches_alike

LOTS = frozenset({"youngs_modulus", "poisson_ratio", "shear_modulus", "cylinder_calibration", "disk_calibration"})

NAMES = ("within_lot_sd", "between_lots_sd", "lots_failing")


def around(value, half, distribution="normal"):
    """Return limits to both sides of a value."""
    return Limits(low=value - half, high=value + half, distribution=distribution)


GRINDING = {
    **{name: around(NOMINAL[name], 2.5e-6) for name in ("mean_radius", "wall_thickness", "disk_inner_radius")},
    "cylinder_length": around(0.16, 50e-6),
    "youngs_modulus": around(211e9, 0.02 * 211e9),
    "poisson_ratio": around(0.3, 0.01, "uniform"),
}
CALIBRATED = GRINDING | {"cylinder_calibration": around(1, 0.02), "disk_calibration": around(1, 0.03, "uniform")}

STUDY = replace(row(CUP, NOMINAL, GRINDING, 3.8 * ARCMIN), between=LOTS)


def rows_alike(limits, count, seed=0):
    """Return rows alike that differ in size, tolerances and limits; every fourth has no limit."""
    generator = np.random.default_rng(seed)
    rows = []
    for number in range(count):
        nominal = NOMINAL | {"torque": 800.0 * generator.uniform(0.8, 1.2)}
        nominal |= {name: 1.0 for name in limits if name.endswith("calibration")}
        wider = {
            name: around(nominal[name], one.half * generator.uniform(0.5, 8), one.distribution)
            for name, one in ((name, _Half(limit)) for name, limit in limits.items())
        }
        upper = float(CUP(nominal)) * generator.uniform(1.0, 1.04)
        rows.append(replace(row(CUP, nominal, wider, upper if number % 4 else None), between=LOTS))
    return rows


class _Half:
    def __init__(self, limits):
        self.half, self.distribution = (limits.high - limits.low) / 2, limits.distribution


def test_the_study_has_lots_that_fail_and_parts_that_hardly_scatter():
    """Case 1 of the study, ground: 0.0019357′ within a lot, 0.029539′ between lots, 115 lots in a million fail."""
    numbers = statistics_of_row(STUDY, plan()).numbers
    unsure = 5e-8 + 3 * numbers["within_lot_sd_standard_error"] / ARCMIN
    assert numbers["within_lot_sd"] / ARCMIN == pytest.approx(0.0019357, abs=unsure)
    assert unsure < 1e-3 * 0.0019357
    assert numbers["between_lots_sd"] / ARCMIN == pytest.approx(0.029539, abs=1.5e-6)
    assert numbers["lots_failing"] == pytest.approx(1.150e-4, abs=2e-7)
    for name, most in zip(NAMES, (1e-3, 1e-3, 0.05), strict=True):
        assert 0 < numbers[f"{name}_standard_error"] <= most * max(numbers[name], numbers["sd"] * (most < 0.01))


@pytest.mark.parametrize("between", [None, LOTS])
def test_lots_are_told_where_it_is_said_what_they_share(between):
    """Without names between lots nothing is told of them; with them every other number keeps its bits."""
    with_lots = statistics_of_row(replace(STUDY, between=between), plan())
    without = statistics_of_row(replace(STUDY, between=None), plan())
    told = {name for name in with_lots.numbers if "lot" in name}
    assert told == (set() if between is None else {*NAMES, *(f"{name}_standard_error" for name in NAMES)})
    kept = {name: value for name, value in with_lots.numbers.items() if name not in told}
    assert every_number(replace(with_lots, numbers=kept)) == every_number(without)


@pytest.mark.slow
@pytest.mark.parametrize("limits", [GRINDING, CALIBRATED], ids=["grinding", "calibrated"])
def test_any_batch_and_any_order_give_the_same_bits(limits):
    """Every number of a row alone, and in another order in batches of 2 or 5, is to the last bit that beside others."""
    rows = rows_alike(limits, 9)
    every = [every_number(each) for each in batch_statistics(rows, plan())]
    for size in (1, 2, 5):
        order = np.random.default_rng(size).permutation(len(rows))
        batches = (order[start : start + size] for start in range(0, len(rows), size))
        found = chain.from_iterable(batch_statistics([rows[index] for index in batch], plan()) for batch in batches)
        assert [every_number(each) for each in found] == [every[index] for index in order], size


@pytest.mark.slow
@pytest.mark.parametrize("limits", [GRINDING, CALIBRATED], ids=["grinding", "calibrated"])
def test_rows_agree_with_one_model_alone(limits):
    """What rows alike are told is within five combined errors what `propagate` says of each, by lines and by points."""
    for toleranced in rows_alike(limits, 5, seed=1):
        numbers = statistics_of_row(toleranced, plan(seed=7)).numbers
        fixed = {name: value for name, value in toleranced.nominal.items() if name not in toleranced.limits}

        def model(fixed=fixed, **varied):
            return CUP({**fixed, **varied})

        inputs = distributions(toleranced.limits)
        for method in ("line", "sobol"):
            spread = propagate(model, inputs, method=method, between=LOTS & set(inputs), seed=1)
            for name in NAMES[:2]:
                error = math.hypot(numbers[f"{name}_standard_error"], getattr(spread, f"{name}_standard_error"))
                assert abs(numbers[name] - getattr(spread, name)) <= 5 * error
            if toleranced.upper_limit is not None:
                found = spread.lots_failing(toleranced.upper_limit, 1350)
                error = spread.lots_failing_standard_error(toleranced.upper_limit, 1350)
                assert abs(numbers["lots_failing"] - found) <= 5 * math.hypot(
                    numbers["lots_failing_standard_error"], error
                )


def test_lines_tell_limits_however_far_out():
    """From limits that all lots miss to those that none does, no lot is lost and fewer and fewer fail."""
    batch = RowBatch([STUDY] * 41)
    split = LotsAndParts(batch.outputs_of, Inputs.of(batch.inputs), LOTS)
    with np.errstate(all="ignore"):
        lots = SeparableLots(split, PRODUCT, 0, LineNumbers(64, 32))
        failing = lots.failing(np.linspace(3.4, 4.2, 41) * ARCMIN, 1350e-6)
    assert not failing.faults.any()
    assert (np.diff(failing.share) <= 0).all()
    assert (failing.share[0], failing.share[-1]) == (1.0, 0.0)


@pytest.mark.slow
def test_rows_have_the_precision_that_was_wanted():
    """Sds are known to a thousandth of the whole sd, shares of failing lots to 5 %, calibrations or none."""
    for statistics in batch_statistics(rows_alike(GRINDING, 12, seed=2), plan()):
        numbers = statistics.numbers
        for name in NAMES[:2]:
            assert numbers[f"{name}_standard_error"] <= 1.1e-3 * numbers["sd"]
        if 1e-9 < numbers.get("lots_failing", 0.0) < 1 - 1e-9:
            rarer = min(numbers["lots_failing"], 1 - numbers["lots_failing"])
            assert numbers["lots_failing_standard_error"] <= 0.05 * rarer


@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_a_modulus_that_scatters_alone_leaves_nothing_within_a_lot(method):
    """With the modulus alone the sd within a lot is 0 and as many lots fail as parts are over the limit."""
    alone = {"youngs_modulus": GRINDING["youngs_modulus"]}
    numbers = statistics_of_row(replace(STUDY, limits=alone), plan(method)).numbers
    assert (numbers["within_lot_sd"], numbers["between_lots_sd"]) == (0.0, numbers["sd"])
    assert numbers["lots_failing"] == numbers["probability_over_limit"]


@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_without_scatter_of_lots_all_fail_or_none(method):
    """With exact material the sd between lots is 0 and every lot fails, or none."""
    exact = {name: limits for name, limits in GRINDING.items() if name not in LOTS}
    for upper, fails in ((3.8 * ARCMIN, 0.0), (3.6 * ARCMIN, 1.0)):
        numbers = statistics_of_row(replace(STUDY, limits=exact, upper_limit=upper), plan(method)).numbers
        assert (numbers["within_lot_sd"], numbers["between_lots_sd"]) == (numbers["sd"], 0.0)
        assert (numbers["lots_failing"], numbers["lots_failing_standard_error"]) == (fails, pytest.approx(0, abs=1e-9))


def test_a_row_without_any_scatter_has_lots_alike():
    """Nothing scatters: no sd within or between lots, and the one value fails or does not."""
    for upper, fails in ((3.8 * ARCMIN, 0.0), (3.6 * ARCMIN, 1.0), (None, None)):
        numbers = statistics_of_row(replace(STUDY, limits={}, upper_limit=upper), plan()).numbers
        assert (numbers["within_lot_sd"], numbers["between_lots_sd"]) == (0.0, 0.0)
        assert numbers.get("lots_failing") == fails


def test_rows_that_differ_in_what_lots_share_are_not_alike():
    """Rows are spread together only if they share the same names between lots; each is told its own."""
    rows = [replace(STUDY, between=between) for between in (LOTS, frozenset({"wall_thickness"}), None, LOTS)]
    assert sorted(map(sorted, batches_alike(rows))) == [[0, 3], [1], [2]]


@pytest.mark.parametrize("acceptable", [1e-5, 1350e-6, 0.2])
def test_the_acceptable_share_is_that_of_the_plan(acceptable):
    """The share of lots that fail is that with more than the plan's acceptable share over the limit."""
    summed = replace(SUM, between=frozenset({"torque", "wall_thickness"}))
    numbers = statistics_of_row(summed, plan(acceptable=acceptable)).numbers
    exact = stats.norm.sf((6 - 2 * stats.norm.isf(acceptable)) / math.sqrt(5))
    assert numbers["lots_failing"] == pytest.approx(exact, rel=1e-5)
    assert numbers["within_lot_sd"] == pytest.approx(2, rel=1e-6)


@pytest.mark.slow
def test_rows_that_lines_do_not_serve_are_told_by_points():
    """Where lines do not serve the row its lots are points; they hold the exact numbers within four errors."""

    def wave(dimensions):
        return np.sin(dimensions["torque"]) + dimensions["wall_thickness"]

    limits = {"torque": Limits(low=-3, high=3, distribution="uniform"), "wall_thickness": Limits(low=-0.3, high=0.3)}
    waving = replace(row(wave, dict.fromkeys(limits, 0.0), limits, 0.8), between=frozenset({"torque"}))
    statistics = statistics_of_row(waving, plan())
    assert statistics.texts["spread_method"] == "sobol"
    numbers = statistics.numbers
    exact = {
        "within_lot_sd": 0.1,
        "between_lots_sd": math.sqrt(0.5 - math.sin(6) / 12),
        "lots_failing": (math.pi - 2 * math.asin(0.8 - 0.1 * stats.norm.isf(1350e-6))) / 6,
    }
    for name, value in exact.items():
        assert abs(numbers[name] - value) <= 4 * numbers[f"{name}_standard_error"]


@pytest.mark.parametrize("between", [frozenset(), frozenset({"wall_thickness"}), LOTS])
def test_an_output_without_a_variance_has_lots_that_fail_alone(between):
    """A wall whose tail ends at 0, where the backlash has no end, tells no sd within or between; the rest is told."""
    wall = Limits(low=1e-4, high=3.1e-3, sigma=0.6, mean_shift=-1.5e-3, cut=(0.0, math.inf))
    young = {"youngs_modulus": GRINDING["youngs_modulus"]} if between == LOTS else {}
    one = replace(row(CUP, NOMINAL, {"wall_thickness": wall} | young, 3.8 * ARCMIN), between=between)
    numbers = statistics_of_row(one, plan()).numbers
    assert 0 < numbers["probability_over_limit"] < 1
    assert 0 <= numbers["lots_failing"] <= 1
    if "sd" not in numbers:
        assert "within_lot_sd" not in numbers
