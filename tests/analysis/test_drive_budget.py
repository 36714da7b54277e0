"""The whole drive's backlash: the worked example, Monte Carlo against draws and convolution, what does not move."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from b3_160 import CUP, NOMINAL
from toleranced import every_number, plan, row, statistics_of_row

from flexlash.analysis.drive_budget import DriveBudget, drive_shares
from flexlash.analysis.drive_sources import output_plays
from flexlash.schema.decision_rows import OtherSource
from flexlash.schema.units import ARCMIN
from flexlash.schema.variant import Limits
from flexlash.tolerance.spread_statistics import SpreadStatistics

TOOTH = OtherSource(row=2, name="tooth clearance", enter_as="mm at radius", radius=0.08, upper=0.02e-3)
BEARING = OtherSource(
    row=3, name="bearing", enter_as="mm radial play", radius=0.08, pressure_angle=math.radians(20), upper=0.005e-3
)
COUPLING = OtherSource(row=4, name="coupling", upper=20 * ARCMIN, side="input", ratio=100.0)
EXAMPLE = (TOOTH, BEARING, COUPLING)


def _budget(*sources, shift=0.3):
    return DriveBudget(plays=output_plays(sources), shift=shift)


def _system(budget, toleranced, sampling, limit=None):
    """Return what is told of the whole drive of one row."""
    (found,) = budget.with_budget([budget.row(toleranced, limit)], [statistics_of_row(toleranced, sampling)], sampling)
    return found.numbers


def test_the_worked_example():
    """Case 3 of the study with tooth clearance, bearing and coupling has the four values of the example to 1e-3′."""
    windup = SpreadStatistics(numbers={"mean": 4.2137 * ARCMIN, "sd": 0.1015 / 3 * ARCMIN})
    budget, limits = _budget(*EXAMPLE), {"torque": Limits(low=-0.1, high=0.1)}
    drive = budget.row(row(lambda of: of["torque"], {"torque": 0.0}, limits), None)
    (found,) = budget.with_budget([drive], [windup], plan())
    printed = {"mean": 4.822, "rss_high": 5.281, "bender_high": 5.511, "worst_case_high": 5.531}
    assert {name: found.numbers[f"system_{name}"] / ARCMIN for name in printed} == pytest.approx(printed, abs=1e-3)


def test_plays_at_the_output():
    """Ends of each source are those worked out by hand: j/r, 2 d tan α/r, an input angle over the ratio."""
    ends = [(play.low, play.high) for play in output_plays(EXAMPLE)]
    by_hand = [2.5e-4, 2 * 5e-6 * 0.36397023426620234 / 0.08, 0.2 * ARCMIN]
    assert ends == [(0.0, pytest.approx(high, rel=1e-12)) for high in by_hand]


def test_a_systematic_value_adds_and_a_random_one_does_not():
    """A systematic source lies about its value, a random one about the middle of its deviations alone."""
    given = {"value": 3 * ARCMIN, "lower": -1 * ARCMIN, "upper": 2 * ARCMIN}
    systematic, random = output_plays(
        [OtherSource(row=2, name="a", **given), OtherSource(row=3, name="b", **given, kind="random")]
    )
    assert (systematic.mean / ARCMIN, random.mean / ARCMIN) == pytest.approx((3.5, 0.5))
    assert systematic.tolerance == pytest.approx(random.tolerance) == pytest.approx(1.5 * ARCMIN)


def test_an_exact_source_moves_all_by_its_value():
    """A source without deviations adds its value to every number and moves no share."""
    toleranced = row(lambda of: 1e-3 * of["torque"], {"torque": 1.0}, {"torque": Limits(low=0.9, high=1.1)})
    without, with_it = (
        _system(_budget(TOOTH, *more), toleranced, plan(), 1.2e-3 + add)
        for more, add in (((), 0.0), ((OtherSource(row=5, name="exact", value=5e-4),), 5e-4))
    )
    assert with_it["system_mean"] == pytest.approx(without["system_mean"] + 5e-4, rel=1e-12)
    for name in ("rss_high", "bender_high", "mean_shift_high", "worst_case_high", "p99_865"):
        assert with_it[f"system_{name}"] == pytest.approx(without[f"system_{name}"] + 5e-4, rel=1e-9)
    over = "system_probability_over_limit"
    assert with_it[over] == pytest.approx(without[over], rel=1e-6)


def test_nothing_scatters():
    """Without any scatter every rule gives the sum, and a limit is met or not."""
    toleranced = row(lambda of: 1e-3 * of["torque"], {"torque": 1.0}, {})
    exact = OtherSource(row=2, name="exact", value=5e-4)
    found = _system(_budget(exact), toleranced, plan(), 1.4e-3)
    told = [value for name, value in found.items() if name.startswith("system_") and name.endswith(("high", "865"))]
    assert told == [pytest.approx(1.5e-3)] * 5
    assert found["system_probability_over_limit"] == 1.0
    assert found["system_p99_865_standard_error"] == found["system_probability_over_limit_standard_error"] == 0.0


def test_without_a_limit_no_probability():
    """A variant without a limit of its drive has no share over it."""
    toleranced = row(lambda of: 1e-3 * of["torque"], {"torque": 1.0}, {"torque": Limits(low=0.9, high=1.1)})
    assert "system_probability_over_limit" not in _system(_budget(TOOTH), toleranced, plan())


@pytest.mark.slow
@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_monte_carlo_by_exact_convolution(method):
    """A normal wind-up and a uniform play: the quantile and the share over a limit are those of the convolution.

    F(y) = 1/(b − a) ∫ₐᵇ Φ((y − μ − u)/σ) du, solved by bisection.
    """
    toleranced = row(lambda of: 1e-3 * of["torque"], {"torque": 1.0}, {"torque": Limits(low=0.9, high=1.1)})
    play = OtherSource(row=2, name="play", upper=2e-4, distribution="uniform")
    nodes, weights = np.polynomial.legendre.leggauss(400)

    def over(y):
        scores = (1e-3 + 1e-4 + 1e-4 * nodes - y) / (0.1e-3 / 3)
        return 0.5 * (weights * [math.erfc(-score / math.sqrt(2)) / 2 for score in scores]).sum()

    low, high = 1e-3, 1.5e-3
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if over(middle) > 0.00135 else (low, middle)
    sampling = plan(method)
    found = _system(_budget(play), toleranced, sampling, 1.22e-3)
    error = found["system_p99_865_standard_error"]
    assert abs(found["system_p99_865"] - low) < 4 * error + 1e-9 * low
    assert error < 2e-3 * (0.1e-3 / 3) or method != "line"
    share_error = found["system_probability_over_limit_standard_error"]
    assert abs(found["system_probability_over_limit"] - over(1.22e-3)) < 4 * share_error + 1e-9


@pytest.mark.slow
def test_monte_carlo_by_plain_draws():
    """The study's cup with a uniform, a triangular and a normal play agrees with four million plain draws of its own.

    The draws know the closed form of the article alone, none of the program's mechanics or sampling.
    """
    sources = (
        replace(TOOTH, distribution="uniform"),
        replace(BEARING, distribution="triangular"),
        replace(COUPLING, limits_sigma=2.0),
    )
    limits = {
        "cylinder_length": Limits(low=0.1598, high=0.1602),
        "wall_thickness": Limits(low=0.00155, high=0.00165, distribution="uniform"),
        "youngs_modulus": Limits(low=204e9, high=218e9),
    }
    toleranced, limit = row(CUP, NOMINAL, limits), 4.75 * ARCMIN
    found = _system(_budget(*sources), toleranced, plan(), limit)
    generator, count = np.random.default_rng(11), 4_000_000
    wall, length = generator.uniform(0.00155, 0.00165, count), generator.normal(0.16, 0.0002 / 3, count)
    shear = generator.normal(211e9, 7e9 / 3, count) / 2.6
    total = 2 * 800 / shear * (length / (2 * np.pi * 0.08**3 * wall) + (1 / 0.04**2 - 1 / 0.08**2) / (4 * np.pi * wall))
    total += generator.uniform(0, 0.02e-3, count) / 0.08
    total += 2 * math.tan(math.radians(20)) * generator.triangular(0, 0.0025e-3, 0.005e-3, count) / 0.08
    total += generator.normal(10, 5, count) * ARCMIN / 100
    plain = np.quantile(total, 0.99865)
    density = ((total > plain - 1e-6) & (total < plain + 1e-6)).mean() / 2e-6
    error = math.hypot(math.sqrt(0.00135 / count) / density, found["system_p99_865_standard_error"])
    assert abs(found["system_p99_865"] - plain) < 4 * error
    share = (total > limit).mean()
    assert abs(found["system_probability_over_limit"] - share) < 4 * math.sqrt(share / count)
    assert found["system_mean"] == pytest.approx(total.mean(), abs=5 * total.std() / math.sqrt(count))


@pytest.mark.slow
@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_the_windup_keeps_its_numbers(method):
    """Every number of the wind-up has the bits that it has without other sources, and drives together those alone."""
    sampling, budget = plan(method, 512), _budget(*EXAMPLE)
    rows = [row(CUP, {**NOMINAL, "torque": torque}, CUP_LIMITS) for torque in (700.0, 800.0)]
    windups = [statistics_of_row(one, sampling) for one in rows]
    together = budget.with_budget([budget.row(one, 5 * ARCMIN) for one in rows], windups, sampling)
    for one, windup, found in zip(rows, windups, together, strict=True):
        kept = {name: value for name, value in found.numbers.items() if not name.startswith("system_")}
        assert every_number(replace(found, numbers=kept)) == every_number(windup)
        assert _system(budget, one, sampling, 5 * ARCMIN) == found.numbers


CUP_LIMITS = {
    "cylinder_length": Limits(low=0.1598, high=0.1602),
    "wall_thickness": Limits(low=0.00155, high=0.00165),
}


def test_shares_are_those_by_hand():
    """Of 4.214′ and 0.1015′/3 of wind-up the example's sources have the shares worked out by hand, 100 % in all."""
    shares = drive_shares(_budget(*EXAMPLE), 4.2137 * ARCMIN, 0.1015 / 3 * ARCMIN)
    means, tolerances = np.array([4.2137, 0.42972, 0.07821, 0.1]), np.array([0.1015, 0.42972, 0.07821, 0.1])
    assert [one.name for one in shares] == ["wind-up", "tooth clearance", "bearing", "coupling"]
    assert [one.of_mean for one in shares] == pytest.approx(means / means.sum(), abs=1e-4)
    assert [one.of_worst_case for one in shares] == pytest.approx(tolerances / tolerances.sum(), abs=1e-4)
    assert [one.of_variance for one in shares] == pytest.approx(tolerances**2 / (tolerances**2).sum(), abs=1e-4)
    assert [round(100 * one.of_mean) for one in shares] == [87, 9, 2, 2]
