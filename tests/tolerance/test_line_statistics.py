"""Statistics of rows alike by lines and of one row by points: right, and to the last bit the row's own."""

from __future__ import annotations

import math
from functools import cache, partial
from itertools import chain

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import ndtr, ndtri
from toleranced import SUM, SUM_LIMITS, SUM_NAMES, every_number, plan, row, statistics_of_row, total

from flexlash.mechanics import flexspline
from flexlash.tolerance import propagate
from flexlash.tolerance.dimension_limits import Limits, distributions
from flexlash.tolerance.engine.line_precision import FEWEST_ROW_LINES, MOST_LINES
from flexlash.tolerance.row_batches import batch_statistics
from flexlash.tolerance.spread_statistics import PERCENTILES, statistics_of

thorough = settings(deadline=None, max_examples=25, derandomize=True)

LINES = plan()
cup = partial(flexspline.backlash, "cup")
CUP = {
    "torque": 800.0,
    "cylinder_length": 0.160,
    "bore_diameter": 0.160,
    "wall_thickness": 0.0016,
    "disk_inner_radius": 0.040,
    "youngs_modulus": 211e9,
    "poisson_ratio": 0.3,
}
DETAILED = CUP | {
    "disk_thickness": 0.002,
    "disk_hub_thickness": 0.003,
    "hub_fillet_radius": 0.003,
    "junction_fillet_radius": 0.002,
    "rim_length": 0.020,
    "rim_thickness": 0.003,
    "cylinder_calibration": 1.0,
    "disk_calibration": 1.0,
}
BENT = {"poisson_ratio": "uniform", "wall_thickness": "uniform", "rim_length": "triangular"}
LENGTHS = {name for name in DETAILED if name.endswith(("length", "diameter", "thickness", "radius"))}


def rows_alike(nominal, count, seed=0):
    """Return rows alike in what scatters, unlike in size, tolerances and limits; every third has no limit."""
    generator = np.random.default_rng(seed)
    rows = []
    for number in range(count):
        size = generator.uniform(0.5, 2.0)
        scaled = {name: value * (size if name in LENGTHS else 1) for name, value in nominal.items()}
        scaled["torque"] *= size**3
        limits = {}
        for name, value in scaled.items():
            half = value * generator.choice([0.001, 0.02, 0.06])
            limits[name] = Limits(low=value - half, high=value + 1.1 * half, distribution=BENT.get(name, "normal"))
        limit = float(cup(scaled)) * (1 + 0.03 * generator.normal())
        rows.append(row(cup, scaled, limits, limit if number % 3 else None))
    return rows


ROWS = {"seven": rows_alike(CUP, 20), "fifteen": rows_alike(DETAILED, 8, seed=1)}
PLANS = {
    "lines as needed": LINES,
    "64 lines": plan("line", 64, 1),
    "512 lines": plan("line", 512, 2, coverage=0.9),
    "sobol": plan("sobol", 512, 3),
    "random": plan("random", 512, 4),
}


@cache
def together(rows, sampling):
    """Return the statistics of rows alike that are spread together."""
    return batch_statistics(ROWS[rows], PLANS[sampling])


def told(statistics):
    """Return everything that is told of rows."""
    return [every_number(each) for each in statistics]


@pytest.mark.parametrize("sampling", PLANS)
@pytest.mark.parametrize("rows", ROWS)
def test_any_batch_and_any_order_give_the_same_bits(rows, sampling):
    """Every number of a row alone, and in another order in batches of 2 or 7, is to the last bit that beside others."""
    alike, every = ROWS[rows], told(together(rows, sampling))
    for size in (1, 2, 7):
        order = np.random.default_rng(size).permutation(len(alike))
        batches = (order[start : start + size] for start in range(0, len(alike), size))
        found = [batch_statistics([alike[index] for index in batch], PLANS[sampling]) for batch in batches]
        assert told(chain.from_iterable(found)) == [every[index] for index in order], size


@pytest.mark.slow
def test_the_block_of_the_cache_changes_no_bit(monkeypatch):
    """However many rows the cache takes at once, every bit stays."""
    every = told(together("seven", "lines as needed"))
    for block in (1, 10_000, 1 << 22):
        monkeypatch.setattr("flexlash.tolerance.engine.line_statistics._BLOCK", block)
        assert told(batch_statistics(ROWS["seven"], LINES)) == every, block


@pytest.mark.slow
def test_the_rows_differ_in_how_many_lines_they_take():
    """The rows above take from few to many lines, so that the claims on bits cover rows drawn again."""
    for rows in ROWS:
        numbers = {each.numbers["spread_points"] for each in together(rows, "lines as needed")}
        assert len(numbers) >= 4
        assert all(math.log2(number).is_integer() and FEWEST_ROW_LINES <= number <= MOST_LINES for number in numbers)


@pytest.mark.slow
def test_every_row_has_the_precision_that_was_wanted():
    """Each row's percentiles are known to 0.001 sd and its share over the limit to 5 %, or a note says what is."""
    every = [statistics for rows in ROWS for statistics in together(rows, "lines as needed")]
    for toleranced, one in zip(chain.from_iterable(ROWS.values()), every, strict=True):
        found = one.numbers
        reached = max(found[f"{name}_standard_error"] for name in ("p0_135", "p2_5", "p50", "p97_5", "p99_865"))
        if reached > 1.1e-3 * found["sd"]:
            assert found["spread_points"] == MOST_LINES
            said = float(one.texts["spread_note"].split()[3])
            assert said == pytest.approx(reached / found["sd"], rel=0.1)
        elif reached < 1e-3 * found["sd"]:
            assert one.texts["spread_note"] is None
        if toleranced.upper_limit is not None and 1e-9 < found["probability_over_limit"] < 1 - 1e-9:
            rarer = min(found["probability_over_limit"], 1 - found["probability_over_limit"])
            width = found["probability_over_limit_high"] - found["probability_over_limit_low"]
            assert width / 3.92 <= 0.06 * rarer or found["spread_points"] == MOST_LINES


@pytest.mark.slow
def test_lines_of_many_rows_agree_with_plain_monte_carlo():
    """Each of many rows agrees with plain Monte Carlo in every statistic within 4.5 combined standard errors."""
    plain = batch_statistics(ROWS["seven"], plan("random", 2**16, 7))
    for toleranced, line, other in zip(ROWS["seven"], together("seven", "lines as needed"), plain, strict=True):
        for name in (*PERCENTILES, "mean", "sd", "skewness", "kurtosis"):
            error = math.hypot(line.numbers[f"{name}_standard_error"], other.numbers[f"{name}_standard_error"])
            # One in 50 runs of 300 comparisons has one beyond four.
            assert abs(line.numbers[name] - other.numbers[name]) <= 4.5 * error
        if toleranced.upper_limit is not None:
            share = line.numbers["probability_over_limit"]
            error = max(math.sqrt(share * (1 - share) / 2**16), 0.5 / 2**16)
            assert abs(share - other.numbers["probability_over_limit"]) <= 4.5 * error


@pytest.fixture(scope="module", params=["line", "sobol", "random"])
def of_a_sum(request):
    """Return the spread of a sum of normals and its method."""
    return statistics_of_row(SUM, plan(request.param)), request.param


@pytest.mark.slow
def test_statistics_of_a_normal_output(of_a_sum):
    """A sum of normals has the percentiles, mean, sd and skewness of a normal within four standard errors."""
    found = of_a_sum[0].numbers
    exact = {name: 10.0 + 3.0 * float(ndtri(share)) for name, share in PERCENTILES.items()}
    for name, value in (exact | {"mean": 10.0, "sd": 3.0, "skewness": 0.0, "kurtosis": 0.0}).items():
        assert abs(found[name] - value) <= 4 * found[f"{name}_standard_error"]
    assert found["first_order_sd"] == pytest.approx(3.0, rel=1e-9)
    assert found["worst_case_high"] == pytest.approx(25.0, rel=1e-12)


def test_lines_are_exact_for_a_normal_output(of_a_sum):
    """By lines every statistic of a sum of normals is right to 1e-8, since no line differs from another."""
    found, method = of_a_sum
    exact = {name: 10.0 + 3.0 * float(ndtri(share)) for name, share in PERCENTILES.items()}
    exact |= {"mean": 10.0, "sd": 3.0, "ppk": 6.0 / (-3.0 * float(ndtri(0.00135))), "ppk_normal": 2.0 / 3.0}
    exact |= {"probability_over_limit": float(ndtr(-2.0))}
    close = {name: found.numbers[name] == pytest.approx(value, rel=1e-8) for name, value in exact.items()}
    assert all(close.values()) == (method == "line")


def test_shares_of_a_sum(of_a_sum):
    """The shares of a sum are the parts of its variance, first-order and total alike."""
    found, method = of_a_sum
    allowed = {"line": 1e-8, "sobol": 0.02, "random": 0.1}[method]
    exact = dict(zip(SUM_NAMES, (1 / 9, 4 / 9, 4 / 9), strict=True))
    assert found.shares == pytest.approx(exact, abs=allowed)
    assert found.total_shares == pytest.approx(exact, abs=allowed)


def hinged(dimensions):
    """Return a sum in which a torque below the threshold makes the output turn back."""
    torque, length = dimensions["torque"], dimensions["cylinder_length"]
    turned = np.where(dimensions["mean_radius"] > 0, (torque - 1.0) ** 2, torque)
    return turned + length


def faulty_among_sound(model, faulty, count=9):
    """Return rows alike of which those named by `faulty` meet the model's fault."""
    limits = {name: Limits(low=-3.0, high=3.0) for name in ("torque", "cylinder_length")}
    return [
        row(
            model, {"torque": 0.0, "cylinder_length": 0.0, "mean_radius": 1.0 if index in faulty else -1.0}, limits, 2.0
        )
        for index in range(count)
    ]


def broken(dimensions):
    """Return a sum that is no number for a large torque."""
    torque = dimensions["torque"]
    failed = (dimensions["mean_radius"] > 0) & (torque > 6.0)
    return np.where(failed, np.nan, torque + dimensions["cylinder_length"])


def stepped(dimensions):
    """Return a sum in steps of 0.2."""
    sum_ = dimensions["torque"] + dimensions["cylinder_length"]
    return np.where(dimensions["mean_radius"] > 0, np.floor(sum_ * 5) / 5, sum_)


def level(dimensions):
    """Return a number that nothing changes."""
    return np.where(dimensions["mean_radius"] > 0, 1.0, dimensions["torque"] + dimensions["cylinder_length"])


FAULTY = {
    hinged: "the output does not rise everywhere along its gradient at the median",
    broken: "the model is not finite within 8 standard deviations",
    stepped: "the output rises in steps",
    level: "the output has no gradient at the median",
}


@pytest.mark.slow
@pytest.mark.parametrize("faulty", [{0}, {4}, {8}, {1, 2, 7}, set(range(9))], ids=str)
@pytest.mark.parametrize("model", FAULTY, ids=lambda model: model.__name__)
def test_a_faulty_row_falls_back_to_sobol_alone(model, faulty):
    """A row that lines do not serve gets Sobol' points and a note; the sound rows around it keep their lines' bits."""
    rows = faulty_among_sound(model, faulty)
    found = batch_statistics(rows, LINES)
    sound = every_number(statistics_of_row(*faulty_among_sound(model, set(), 1), LINES))
    assert sound[1]["spread_method"] == "line"
    for index, one in enumerate(found):
        if index in faulty:
            assert one.texts["spread_method"] == "sobol"
            assert one.texts["spread_note"] == f"Sobol' points instead of lines: {FAULTY[model]}"
            assert one.numbers["spread_points"] == 2**15
            points = statistics_of_row(rows[index], plan("sobol"))
            assert every_number(one)[0] == every_number(points)[0]
            assert every_number(one)[2:] == every_number(points)[2:]
        else:
            assert every_number(one) == sound


def test_the_fallback_takes_as_many_points_as_were_asked_for_lines():
    """A row that falls back with a number of lines given is answered by the default number of Sobol' points."""
    found = statistics_of_row(*faulty_among_sound(hinged, {0}, 1), plan("line", 64))
    assert found.texts["spread_method"] == "sobol"
    assert found.numbers["spread_points"] == 2**15


@pytest.mark.slow
def test_many_lines_that_do_not_suffice_are_told():
    """Where the greatest number of lines does not give the precision wanted, the note says which was reached."""
    limits = {name: Limits(low=-3.0, high=3.0) for name in list(DETAILED)[:12]}
    names = list(limits)

    def strongly_curved(dimensions):
        return sum(np.exp(1.2 * dimensions[name]) for name in names)

    curved = row(strongly_curved, dict.fromkeys(names, 0.0), limits)
    found = statistics_of_row(curved, LINES)
    assert found.texts["spread_method"] == "line"
    assert found.numbers["spread_points"] == MOST_LINES
    assert found.texts["spread_note"].endswith(" standard deviations, 0.001 was wanted")
    few = statistics_of_row(curved, plan("line", 64))
    assert few.texts["spread_note"] is None


@pytest.mark.slow
@thorough
@given(limit=st.floats(-6, 6), seed=st.integers(0, 5))
def test_an_interval_holds_its_share(limit, seed):
    """The interval of a share over any limit holds that share, below 1 and above 0 at its ends."""
    limits = {name: Limits(low=-3.0, high=3.0, distribution="uniform") for name in SUM_NAMES}
    uniform = row(total, dict.fromkeys(SUM_NAMES, 0.0), limits, 10.0 + limit)
    found = statistics_of_row(uniform, plan("line", 64, seed))
    share = found.numbers["probability_over_limit"]
    assert 0 <= found.numbers["probability_over_limit_low"] <= share
    assert share <= found.numbers["probability_over_limit_high"] <= 1


def test_statistics_of_points_are_those_of_their_spread():
    """What is told of one row by points is what the engine alone tells of the same points."""
    found = statistics_of_row(SUM, plan("random", 4096, 5))
    spread = propagate(lambda **varied: total(varied), distributions(SUM_LIMITS), method="random", samples=4096, seed=5)
    own = statistics_of(spread, 16.0, coverage=0.95)
    assert set(own.numbers) <= set(found.numbers)
    for name, share in PERCENTILES.items():
        assert own.numbers[name] == spread.quantile(share)
        assert own.numbers[f"{name}_standard_error"] == spread.standard_error(share)
    for name in ("mean", "sd", "skewness", "kurtosis"):
        assert own.numbers[name] == getattr(spread, name)
        assert own.numbers[f"{name}_standard_error"] == getattr(spread, f"{name}_standard_error")
    assert own.numbers["probability_over_limit"] == spread.probability_above(16.0)
    assert own.shares == spread.shares
    assert own.total_shares == spread.total_shares
    assert own.texts == {"spread_method": "random", "spread_note": None}
    assert statistics_of(spread, None, coverage=0.95, note="why").texts["spread_note"] == "why"
