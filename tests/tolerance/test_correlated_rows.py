"""Rows whose dimensions scatter together: in batches, with lots, to first order, and as curves."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from b3_160 import CUP, NOMINAL
from scipy.special import ndtr, ndtri
from toleranced import SUM, every_number, plan, statistics_of_row

from flexlash.tolerance import propagate
from flexlash.tolerance.dimension_limits import Limits, distributions
from flexlash.tolerance.distribution_curves import CURVE_SCORES, curve_of, curves_of
from flexlash.tolerance.row_batches import TolerancedRow, batch_statistics, batches_alike

WALL_AND_DISK = ("wall_thickness", "disk_thickness", 0.6)
WALL_AND_LENGTH = ("cylinder_length", "wall_thickness", -0.5)
LIMITS = {
    "wall_thickness": Limits(low=0.00155, high=0.00165, distribution="uniform"),
    "disk_thickness": Limits(low=0.00155, high=0.00165, distribution="uniform"),
    "cylinder_length": Limits(low=0.1598, high=0.1602),
    "youngs_modulus": Limits(low=206e9, high=216e9),
}


def _row(number=0, *ties, limits=LIMITS, **rest):
    """Return a row of the reference cup."""
    nominal = {**NOMINAL, "torque": 700.0 + number}
    return TolerancedRow(model=CUP, nominal=nominal, limits=limits, upper_limit=9.7e-4, correlation=ties, **rest)


ROWS = [
    *(_row(number, WALL_AND_DISK) for number in range(3)),
    *(_row(number) for number in range(2)),
    *(_row(number, WALL_AND_DISK, WALL_AND_LENGTH) for number in range(2)),
    _row(1, ("wall_thickness", "disk_thickness", 0.7)),
    _row(1, WALL_AND_DISK, limits={name: limit for name, limit in LIMITS.items() if name != "disk_thickness"}),
    _row(2, WALL_AND_DISK, between=frozenset({"youngs_modulus"})),
]


def _statistics(rows, sampling):
    """Return what is told of every row, computed by batches."""
    told = {}
    for batch in batches_alike(rows):
        told |= zip(batch, batch_statistics([rows[index] for index in batch], sampling), strict=True)
    return [every_number(told[index]) for index in range(len(rows))]


@pytest.mark.slow
@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_rows_with_ties_have_the_bits_that_they_have_alone(method):
    """Every row among others, in either order, keeps each bit of the statistics that it has alone."""
    sampling = plan(method, 256, 3, cross_check=method == "line")
    alone = [every_number(statistics_of_row(row, sampling)) for row in ROWS]
    assert _statistics(ROWS, sampling) == alone
    assert _statistics(ROWS[::-1], sampling) == alone[::-1]


def test_rows_with_other_ties_are_not_alike():
    """A batch holds rows with the same ties alone."""
    assert sorted(batches_alike(ROWS)) == [[0, 1, 2], [3, 4], [5, 6], [7], [8], [9]]


@pytest.mark.parametrize(
    "idle",
    [
        pytest.param({"disk_thickness": Limits(low=0.0016, high=0.0016)}, id="limits coincide"),
        pytest.param({}, id="no limits"),
    ],
)
def test_a_tie_to_what_does_not_scatter_changes_no_bit(idle):
    """Where a dimension of a pair is exact, the row's numbers are those of the row without the correlation."""
    limits = {name: limit for name, limit in LIMITS.items() if name != "disk_thickness"} | idle
    tied, free = _row(1, WALL_AND_DISK, limits=limits), _row(1, limits=limits)
    assert tied.ties == ()
    assert every_number(statistics_of_row(tied, plan(seed=1))) == every_number(statistics_of_row(free, plan(seed=1)))
    assert _row(1, ("wall_thickness", "disk_thickness", 0.0)).ties == ()


@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_a_row_is_what_propagate_says(method):
    """Mean, sd, percentiles, probability and shares agree with `propagate`, within four combined standard errors."""
    row = _row(0, WALL_AND_DISK, WALL_AND_LENGTH)
    told = statistics_of_row(row, plan(method, seed=5))
    ties = {(first, second): scores for first, second, scores in row.ties}
    exact = propagate(lambda **given: CUP(row.nominal | given), distributions(row.limits), correlation=ties, seed=8)
    assert told.texts["spread_method"] == method
    for name, level in (("p2_5", 0.025), ("p50", 0.5), ("p99_865", 0.99865)):
        error = math.hypot(told.numbers[f"{name}_standard_error"], float(exact.standard_error(level)))
        assert abs(told.numbers[name] - exact.quantile(level)) <= 4 * error
    error = math.hypot(told.numbers["sd_standard_error"], exact.sd_standard_error)
    assert abs(told.numbers["sd"] - exact.sd) <= 4 * error
    apart = statistics_of_row(replace(row, correlation=()), plan(method, seed=5))
    assert abs(told.numbers["sd"] - apart.numbers["sd"]) > 0.02 * apart.numbers["sd"]
    for name, share in exact.shares.items():
        assert abs(told.shares[name] - share) <= 4 * math.hypot(told.share_errors[name], 2e-3)


def test_plain_monte_carlo_beside_ties_draws_them_too():
    """The cross-check of a row whose ties move its sd by a fifth agrees."""
    row = _row(0, ("wall_thickness", "disk_thickness", 0.95))
    told = statistics_of_row(row, plan(seed=2, cross_check=True))
    apart = statistics_of_row(replace(row, correlation=()), plan(seed=2))
    assert told.texts["cross_check"] == "agrees"
    assert told.numbers["sd"] > 1.1 * apart.numbers["sd"]


@pytest.mark.parametrize("correlation", [-1.0, -0.4, 0.7, 1.0])
def test_the_first_order_sd_has_the_cross_terms(correlation):
    """Of a sum it is the sd itself: √(1 + 4 + 4 + 2 ρ · 1 · 2 − …), with uniform inputs the ρ of their values."""
    normal = replace(SUM, correlation=(("torque", "cylinder_length", correlation),))
    told = statistics_of_row(normal, plan()).numbers
    assert told["first_order_sd"] == pytest.approx(math.sqrt(9 + 4 * correlation), rel=1e-12)
    limits = {name: replace(limit, distribution="uniform") for name, limit in SUM.limits.items()}
    uniform = statistics_of_row(replace(normal, limits=limits), plan())
    values = 6 / math.pi * math.asin(correlation / 2)
    assert uniform.numbers["first_order_sd"] == pytest.approx(math.sqrt(3 * (9 + 4 * values)), rel=1e-9)
    error = uniform.numbers["sd_standard_error"]
    assert abs(uniform.numbers["first_order_sd"] - uniform.numbers["sd"]) <= 4 * error + 1e-9
    assert uniform.texts["first_order_valid"] in {"yes", "no"}


@pytest.mark.parametrize("method", ["line", "sobol"])
@pytest.mark.parametrize(
    ("tie", "between", "within_sd", "between_sd"),
    [
        (("torque", "cylinder_length", 0.5), {"torque", "cylinder_length"}, 2.0, math.sqrt(7)),
        (("cylinder_length", "wall_thickness", 0.5), {"torque"}, 2.0, 1.0),
        (("cylinder_length", "wall_thickness", -0.5), {"torque"}, math.sqrt(12), 1.0),
    ],
)
def test_lots_divide_what_ties_add(tie, between, within_sd, between_sd, method):
    """Of a sum the sds within and between lots, and the share of lots that fail, are those of the tied normals.

    10 + a + b − c with sds 1, 2 and 2: a lot fails where its mean is above the limit less z(1350 ppm) · within.
    """
    row = replace(SUM, correlation=(tie,), between=frozenset(between))
    told = statistics_of_row(row, plan(method, seed=4)).numbers
    fails = float(ndtr(-(row.upper_limit - 10 - within_sd * float(ndtri(1 - 1350e-6))) / between_sd))
    for name, exact in (("within_lot_sd", within_sd), ("between_lots_sd", between_sd), ("lots_failing", fails)):
        error = told[f"{name}_standard_error"]
        assert abs(told[name] - exact) <= 4 * error + 1e-9, name
        assert error < 0.02


def test_a_tie_of_a_lot_and_a_part_is_refused():
    """An input that is one value for a lot cannot follow one that differs from part to part."""
    crossed = replace(SUM, correlation=(("torque", "wall_thickness", 0.5),), between=frozenset({"torque"}))
    with pytest.raises(ValueError, match="correlation ties torque, which is one value for a lot, to wall_thickness"):
        statistics_of_row(crossed, plan())


def test_ties_that_contradict_are_refused():
    """A row whose correlations no scores can have is refused before anything is drawn."""
    ties = ("torque", "cylinder_length", 0.9), ("torque", "wall_thickness", 0.9)
    against = ("cylinder_length", "wall_thickness", -0.9)
    with pytest.raises(ValueError, match="contradict"):
        statistics_of_row(replace(SUM, correlation=(*ties, against)), plan())


@pytest.mark.parametrize("method", ["line", "sobol"])
def test_a_curve_is_that_of_the_tied_row(method):
    """Stored curves go through the percentiles of their rows, and have the bits that they have alone."""
    sampling = plan(method, seed=1)
    rows = ROWS[:3]
    statistics = batch_statistics(rows, sampling)
    curves = curves_of(rows, statistics, sampling)
    for row, told, curve in zip(rows, statistics, curves, strict=True):
        assert curve.outputs.tolist() == curve_of(row, told, sampling).outputs.tolist()
        for name, score in (("p0_135", -2.99998), ("p50", 0.0), ("p99_865", 2.99998)):
            at = float(np.interp(score, CURVE_SCORES, curve.outputs))
            assert at == pytest.approx(told.numbers[name], abs=2e-3 * told.numbers["sd"]), name
