"""Plain Monte Carlo beside another method: right numbers agree, wrong ones do not."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from b3_160 import CUP, NOMINAL
from scipy import optimize, stats
from toleranced import plan, row, statistics_of_row

from flexlash.mechanics import flexspline
from flexlash.tolerance.cross_check import AGREEMENT, cross_checked, deviation
from flexlash.tolerance.dimension_limits import Limits, distribution_of
from flexlash.tolerance.distributions import Normal
from flexlash.tolerance.sampled_spread import SampledSpread
from flexlash.tolerance.sampling import UnitPoints
from flexlash.tolerance.spread_statistics import PERCENTILES

LIMITS = {
    "wall_thickness": Limits(low=0.00155, high=0.00165, distribution="uniform"),
    "youngs_modulus": Limits(low=207e9, high=215e9),
}
ENDS = ("", "_low", "_high")
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
    shares = {f"probability_over_limit{end}": found.numbers[f"probability_over_limit{end}"] for end in ENDS}
    moved = replace(found, numbers=found.numbers | {name: factor * share for name, share in shares.items()})
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
@pytest.mark.parametrize(("method", "replicates"), [("line", 8), ("sobol", 16)])
def test_the_deviation_is_the_greatest_of_all(method, replicates):
    """The deviation is the greatest of all differences, each judged by both its errors and the method's replicates."""
    found = spread(method=method).numbers
    expected = max(
        deviation(
            found[name] - found[f"random_{name}"],
            found[f"random_{name}_standard_error"],
            found[f"{name}_standard_error"],
            replicates,
        )
        for name in COMPARED
    )
    assert found["cross_check_deviation"] == expected
    assert 0 < expected < AGREEMENT


def odds(beyond, ratio, replicates):
    """Return the odds that a right statistic deviates by more, where replicates scatter `ratio` times as plain draws.

    The mean over what replicates may scatter by (a chi square of one less) of the normal odds of the difference.
    """
    logit = np.linspace(-36, 36, 1801)
    part = 1 / (1 + np.exp(-logit))
    scatter = ratio * np.sqrt(stats.chi2(replicates - 1).ppf(part) / (replicates - 1))
    widening = stats.t(replicates - 1).ppf(0.975) / stats.norm.ppf(0.975)
    whole, total = math.hypot(1.0, ratio), 0.0
    for one, weight in zip(scatter, part * (1 - part) * (logit[1] - logit[0]), strict=True):
        root = optimize.brentq(
            lambda size, one=one: deviation(size * whole, 1.0, one * widening, replicates) - beyond, 0.0, 80.0
        )
        total += weight * 2 * stats.norm.sf(root)
    return total


@pytest.mark.slow
@pytest.mark.parametrize("replicates", [8, 16])
def test_right_statistics_differ_by_chance_in_fewer_than_one_row_in_10_000(replicates):
    """Whichever side's error is the greater, 14 right statistics deviate by more than agrees once in 10,000 rows."""
    statistics = len(COMPARED) + 1
    assert statistics == 14
    for ratio in (1e-3, 0.3, 1.0, 2.0, 4.0, 10.0, 1e3):
        assert odds(AGREEMENT, ratio, replicates) <= 1e-4 / statistics


def test_few_replicates_are_told_for_what_they_are():
    """4 errors of 8 replicates are passed by chance once in 524: a deviation of 3.1. 4 errors of theory are 4."""
    assert 1 / (2 * stats.t(7).sf(4 * stats.t(7).ppf(0.975) / stats.norm.ppf(0.975))) == pytest.approx(524, abs=0.5)
    assert deviation(4.0, 0.0, 1.0, 8) == pytest.approx(-stats.norm.ppf(1 / 1048), abs=1e-3)
    assert deviation(-4.0, 1.0, 0.0, 8) == pytest.approx(4.0, rel=1e-9)
    assert deviation(4.0, 1.0, 1e-9, 8) == pytest.approx(4.0, rel=1e-9)
    assert deviation(0.0, 0.0, 0.0, 8) == 0.0
    assert 37 < deviation(1.0, 0.0, 0.0, 8) < 38


@pytest.mark.parametrize("expected", [0.03, 0.5, 3.0, 40.0, 3000.0])
def test_counts_deviate_as_their_odds_say(expected):
    """Of right counts of draws over the limit as many deviate by more than 2 or 3 as of a normal, or fewer."""
    size = 4096
    share = expected / size
    found = statistics_of_row(row(lambda d: d["a"], {"a": 0.0}, {"a": Limits(low=-3.0, high=3.0)}, 0.0), plan())
    numbers = found.numbers | {f"probability_over_limit{end}": share for end in ENDS}
    drawn = SampledSpread(
        model=lambda a: a,
        inputs={"a": Normal(mean=0.0, sd=1.0)},
        points=UnitPoints(["a"], method="random", samples=size, seed=0),
    )
    numbers |= {name: getattr(drawn, name) for name in ("mean", "sd")}
    numbers |= dict(zip(PERCENTILES, drawn.quantile(list(PERCENTILES.values())).tolist(), strict=True))
    exact = replace(found, numbers=numbers)
    order = np.sort(drawn.values, axis=None)[::-1]
    beyond = {2.0: 0.0, 3.0: 0.0}
    far = 6 * math.sqrt(expected)
    reach = range(max(0, int(expected - far)), int(expected + far) + 4, 1 if expected < 1000 else 4)
    for count in reach:
        limit = float(order[count - 1 : count + 1].mean()) if count else float(order[0]) + 1
        told = cross_checked(exact, drawn, limit).numbers["cross_check_deviation"]
        for level in beyond:
            beyond[level] += reach.step * float(stats.binom(size, share).pmf(count)) * (told > level)
    for level, odds_beyond in beyond.items():
        assert odds_beyond <= 2 * stats.norm.sf(level)


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


@pytest.mark.parametrize(("share", "agrees"), [(1e-9, True), (1e-5, True), (2e-3, True), (6e-3, False)])
def test_a_share_too_rare_for_plain_draws_agrees_with_none_seen(share, agrees):
    """None of 4096 draws over the limit agrees with a share that would show less than a few, not with a greater."""
    limit = 10.0
    points = UnitPoints(["a"], method="random", samples=4096, seed=0)
    drawn = SampledSpread(model=lambda a: a, inputs={"a": Normal(mean=0.0, sd=1.0)}, points=points)
    assert drawn.probability_above(limit) == 0
    found = statistics_of_row(row(lambda d: d["a"], {"a": 0.0}, {"a": Limits(low=-3.0, high=3.0)}, limit), plan())
    moved = replace(found, numbers=found.numbers | {f"probability_over_limit{end}": share for end in ENDS})
    told = cross_checked(moved, drawn, limit).numbers["cross_check_deviation"]
    same = cross_checked(found, drawn, limit).numbers["cross_check_deviation"]
    # The odds of none among so many.
    assert told == pytest.approx(max(same, -stats.norm.ppf((1 - share) ** 4096)), rel=1e-3)
    assert (told <= AGREEMENT) == agrees


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
