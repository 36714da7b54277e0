"""Plain Monte Carlo beside another method: right numbers agree, wrong ones do not."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import pytest
from b3_160 import CUP, NOMINAL
from toleranced import plan, row, statistics_of_row

from flexlash.mechanics import flexspline
from flexlash.tolerance.cross_check import AGREEMENT, cross_checked
from flexlash.tolerance.dimension_limits import Limits, distribution_of
from flexlash.tolerance.distributions import Normal
from flexlash.tolerance.sampled_spread import SampledSpread
from flexlash.tolerance.sampling import UnitPoints
from flexlash.tolerance.spread_statistics import PERCENTILES

LIMITS = {
    "wall_thickness": Limits(low=0.00155, high=0.00165, distribution="uniform"),
    "youngs_modulus": Limits(low=207e9, high=215e9),
}
COMPARED = (*PERCENTILES, "mean", "sd")


def spread(limit=None, *, limits=LIMITS, method="line", samples=None, seed=0, cross_check=True):
    """Return the cross-checked statistics of the cup."""
    return statistics_of_row(row(CUP, NOMINAL, limits, limit), plan(method, samples, seed, cross_check=cross_check))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("method", ["line", "sobol"])
def test_lines_and_points_agree_with_plain_draws(method, seed):
    """Lines and Sobol' points agree with plain Monte Carlo in mean, sd, percentiles and share over the limit."""
    found = spread(1.09e-3, method=method, seed=seed)
    assert found.texts["cross_check"] == "agrees"
    assert found.numbers["cross_check_deviation"] <= AGREEMENT


@pytest.mark.slow
@pytest.mark.parametrize("name", COMPARED)
def test_a_wrong_statistic_is_found(name):
    """A statistic moved by ten of its standard errors by plain draws no longer agrees, whichever it is."""
    found = spread()
    wrong = found.numbers[f"random_{name}"] + 10 * found.numbers[f"random_{name}_standard_error"]
    moved = replace(found, numbers=found.numbers | {name: wrong})
    checked = cross_checked(moved, plain(), None)
    assert checked.texts["cross_check"] == "differs"
    assert checked.numbers["cross_check_deviation"] > AGREEMENT


def plain(size=2**17):
    """Return the plain Monte Carlo that cross-checks the cup, drawn for the two dimensions alone."""
    points = UnitPoints(list(LIMITS), method="random", samples=size, seed=9)
    inputs = {name: distribution_of(one) for name, one in LIMITS.items()}
    return SampledSpread(model=lambda **varied: CUP(NOMINAL | varied), inputs=inputs, points=points)


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_a_wrong_share_over_the_limit_is_found(factor):
    """A share over the limit half or twice as great as it is no longer agrees."""
    found = spread(1.11e-3)
    assert cross_checked(found, plain(), 1.11e-3).texts["cross_check"] == "agrees"
    share = found.numbers["probability_over_limit"] * factor
    moved = replace(found, numbers=found.numbers | {"probability_over_limit": share})
    assert cross_checked(moved, plain(), 1.11e-3).texts["cross_check"] == "differs"


def test_own_numbers_stay_and_plain_ones_stand_beside():
    """The spread keeps its own numbers; those of plain draws stand beside them with their standard errors."""
    alone, checked = spread(1.09e-3, cross_check=False), spread(1.09e-3)
    assert {name: checked.numbers[name] for name in alone.numbers} == alone.numbers
    assert checked.texts == alone.texts | {"cross_check": "agrees"}
    assert checked.shares == alone.shares
    beside = {f"random_{name}" for name in COMPARED} | {f"random_{name}_standard_error" for name in COMPARED}
    beside |= {"random_probability_over_limit", "random_points", "cross_check_deviation"}
    assert set(checked.numbers) - set(alone.numbers) == beside
    assert checked.numbers["random_points"] == 2**17


def test_plain_numbers_are_those_of_the_method_random():
    """What stands beside the spread is, bit for bit, what the method random gives."""
    checked, drawn = (spread(1.09e-3, method=method).numbers for method in ("line", "random"))
    for name in COMPARED:
        for end in (name, f"{name}_standard_error"):
            assert checked[f"random_{end}"] == drawn[end]
    assert checked["random_probability_over_limit"] == drawn["probability_over_limit"]


@pytest.mark.slow
def test_the_deviation_is_the_greatest_in_combined_standard_errors():
    """The deviation is the greatest of all differences, each over the root of both squared standard errors."""
    found = spread().numbers
    errors = {
        name: math.hypot(found[f"{name}_standard_error"], found[f"random_{name}_standard_error"]) for name in COMPARED
    }
    expected = max(abs(found[name] - found[f"random_{name}"]) / errors[name] for name in COMPARED)
    assert found["cross_check_deviation"] == pytest.approx(expected, rel=1e-14)
    assert 0 < expected < AGREEMENT


def test_plain_monte_carlo_is_not_checked_against_itself():
    """The method random has nothing to be checked against and says nothing of agreement."""
    found = spread(method="random", samples=1024)
    assert "cross_check" not in found.texts
    assert not {name for name in found.numbers if name.startswith(("random_", "cross_check"))}


def test_a_row_that_points_answered_is_checked_too():
    """A row that lines do not serve is answered by Sobol' points and checked all the same."""
    bowl_limits = {name: Limits(low=-3.0, high=3.0) for name in ("torque", "cylinder_length")}
    nominal = dict.fromkeys(bowl_limits, 0.0)

    def bowl(dimensions):
        return dimensions["torque"] ** 2 + dimensions["cylinder_length"] ** 2

    found = statistics_of_row(row(bowl, nominal, bowl_limits, 5.0), plan(cross_check=True))
    assert found.texts["spread_method"] == "sobol"
    assert found.texts["cross_check"] == "agrees"


@pytest.mark.parametrize(("share", "agrees"), [(1e-9, True), (1e-5, True), (2e-3, False)])
def test_a_share_too_rare_for_plain_draws_agrees_with_none_seen(share, agrees):
    """None of 4096 draws over the limit agrees with a share that would show less than a few, not with a greater."""
    limit = 10.0
    points = UnitPoints(["a"], method="random", samples=4096, seed=0)
    drawn = SampledSpread(model=lambda a: a, inputs={"a": Normal(mean=0.0, sd=1.0)}, points=points)
    assert drawn.probability_above(limit) == 0
    found = statistics_of_row(row(lambda d: d["a"], {"a": 0.0}, {"a": Limits(low=-3.0, high=3.0)}, limit), plan())
    moved = replace(found, numbers=found.numbers | {"probability_over_limit": share})
    deviation = cross_checked(moved, drawn, limit).numbers["cross_check_deviation"]
    same = cross_checked(found, drawn, limit).numbers["cross_check_deviation"]
    error = max(math.sqrt(share * (1 - share) / 4096), 0.5 / 4096)
    assert deviation == pytest.approx(max(same, share / error), rel=1e-12)
    assert (share / error < 1) == agrees


def test_a_row_without_tolerances_is_not_checked():
    """A row none of whose dimensions scatters is exact and has nothing to check."""
    found = spread(limits={})
    assert found.numbers["sd"] == 0
    assert "cross_check" not in found.texts


WITHOUT_EFFECT = {
    "of a disk that is not there": ("cylinder", "disk_calibration", 0.9, 1.1),
    "far below rounding": ("cup", "hub_fillet_radius", 0.9e-12, 1.1e-12),
}


@pytest.mark.parametrize("method", ["line", "sobol"])
@pytest.mark.parametrize("case", WITHOUT_EFFECT)
def test_a_tolerance_without_effect_agrees(case, method):
    """A dimension that scatters without any effect gives both methods the same number, which agrees."""
    kind, name, low, high = WITHOUT_EFFECT[case]
    nominal = NOMINAL | {name: (low + high) / 2}
    toleranced = row(partial(flexspline.backlash, kind), nominal, {name: Limits(low=low, high=high)}, 1e-3)
    found = statistics_of_row(toleranced, plan(method, cross_check=True))
    # A hub fillet far below rounding still shakes the last bit.
    assert 0 <= found.numbers["sd"] <= 1e-15 * found.numbers["mean"]
    assert 0 <= found.numbers["random_sd"] <= 1e-15 * found.numbers["mean"]
    assert found.numbers["cross_check_deviation"] <= AGREEMENT
    assert found.texts["cross_check"] == "agrees"
