"""One variant's tolerance spread: which statistics it holds and how they hang together, by every method."""

import math
from decimal import Decimal
from functools import partial

import numpy as np
import pytest
from b3_160 import CUP, NOMINAL
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import ndtr
from toleranced import plan, row, statistics_of_row

from flexlash.mechanics import flexspline
from flexlash.schema.units import ARCMIN
from flexlash.tolerance.dimension_limits import Limits, distribution_of
from flexlash.tolerance.distribution_curves import CURVE_SCORES, curve_of
from flexlash.tolerance.row_batches import batch_statistics
from flexlash.tolerance.sensitivity import first_order_valid
from flexlash.tolerance.spread_statistics import PERCENTILES

thorough = settings(deadline=None, max_examples=30, derandomize=True)

METHODS = ("line", "sobol", "random")
each_method = pytest.mark.parametrize("method", METHODS)

LIMITS = {
    "cylinder_length": Limits(low=0.1598, high=0.1602, distribution="uniform"),
    "wall_thickness": Limits(low=0.00155, high=0.00165),
    "youngs_modulus": Limits(low=207e9, high=215e9),
}
EXACT = float(CUP(NOMINAL))
ERRORS = [f"{name}_standard_error" for name in (*PERCENTILES, "mean", "sd", "skewness", "kurtosis")]


def spread(limits=LIMITS, *, nominal=NOMINAL, limit=None, method="line", samples=None, seed=0, coverage=0.95):
    """Return the statistics of the cup over its limits."""
    return statistics_of_row(row(CUP, nominal, limits, limit), plan(method, samples, seed, coverage=coverage))


@pytest.mark.slow
@each_method
def test_percentiles_rise_between_the_worst_cases(method):
    """The percentiles rise from P0.135 to P99.865, and mean and median lie close together in their middle."""
    found = spread(method=method).numbers
    names = ("p0_135", "p1", "p2_5", "p5", "p25", "p50", "p75", "p95", "p97_5", "p99", "p99_865")
    order = [found[key] for key in names]
    assert set(names) == set(PERCENTILES)
    assert order == sorted(order)
    assert len(set(order)) == len(order)
    assert abs(found["mean"] - found["p50"]) < 0.1 * found["sd"]
    assert found["worst_case_low"] < found["p0_135"]
    assert found["p99_865"] < found["worst_case_high"]


@each_method
def test_sd_is_close_to_first_order(method):
    """For small tolerances the standard deviation is the first-order one within 1 %."""
    found = spread(method=method).numbers
    assert found["sd"] == pytest.approx(found["first_order_sd"], rel=0.01)
    assert found["mean"] == pytest.approx(EXACT, rel=1e-3)


@pytest.mark.parametrize("method", ["sobol", "random"])
def test_lines_agree_with_points(method):
    """Lines and points give the same statistics within four combined standard errors, lines the smaller ones."""
    lines, points = spread().numbers, spread(method=method, seed=1).numbers
    for error in ERRORS:
        name = error.removesuffix("_standard_error")
        assert abs(lines[name] - points[name]) <= 4 * math.hypot(lines[error], points[error])
    assert lines["p99_865_standard_error"] < points["p99_865_standard_error"]


@pytest.mark.slow
@each_method
@pytest.mark.parametrize("coverage", [0.5, 0.9, 0.95, 0.9973])
def test_coverage_interval_is_symmetric_in_probability(method, coverage):
    """The coverage interval leaves the same share of units below and above."""
    found = spread(coverage=coverage, method=method)
    ends = [found.numbers["coverage_low"], found.numbers["coverage_high"]]
    curve = curve_of(row(CUP, NOMINAL, LIMITS), found, plan(method))
    order = ndtr(np.interp(ends, curve.outputs, CURVE_SCORES))
    assert order == pytest.approx([(1 - coverage) / 2, (1 + coverage) / 2], abs=0.003)
    if coverage == 0.95:
        assert ends == [found.numbers["p2_5"], found.numbers["p97_5"]]


@pytest.mark.slow
@each_method
def test_standard_errors_are_small_and_ordered(method):
    """Every standard error is positive and below a tenth of the sd, that of P0.135 greater than that of P50."""
    found = spread(method=method).numbers
    for error in ERRORS:
        size = 1 if error.startswith(("skewness", "kurtosis")) else found["sd"]
        assert 0 < found[error] < 0.1 * size
    if method != "line":
        assert found["p99_865_standard_error"] > found["p97_5_standard_error"] > found["p50_standard_error"]


def test_lines_are_drawn_until_the_percentiles_are_known():
    """Without a number, lines are added until the percentiles that decide have standard errors of 0.001 sd."""
    found = spread().numbers
    assert found["spread_points"] % 8 == 0
    for name in ("p0_135", "p2_5", "p50", "p97_5", "p99_865"):
        assert found[f"{name}_standard_error"] <= 1.05e-3 * found["sd"]


@pytest.mark.parametrize(
    ("method", "samples", "points"),
    [("line", 100, 128), ("line", 1, 8), ("sobol", 100, 128), ("sobol", None, 2**15), ("random", None, 2**17)],
)
def test_points_are_as_many_as_asked_for(method, samples, points):
    """A number of lines or points is rounded up to replicates times a power of two; points have their default."""
    found = spread(method=method, samples=samples)
    assert found.numbers["spread_points"] == points
    assert found.texts["spread_method"] == method
    assert found.texts["spread_note"] is None


def test_worst_case_takes_every_limit():
    """The worst case has every dimension at the limit that hurts, normals at their limits and not beyond."""
    found = spread().numbers
    high = {"cylinder_length": 0.1602, "wall_thickness": 0.00155, "youngs_modulus": 207e9}
    low = {"cylinder_length": 0.1598, "wall_thickness": 0.00165, "youngs_modulus": 215e9}
    assert found["worst_case_high"] == pytest.approx(float(CUP(NOMINAL | high)), rel=1e-14)
    assert found["worst_case_low"] == pytest.approx(float(CUP(NOMINAL | low)), rel=1e-14)


def test_swings_hold_each_dimension_at_its_limits():
    """Each dimension's swing is the backlash at its two limits with the others in the middle of theirs."""
    found = spread()
    assert list(found.swings) == list(LIMITS)
    for name, (at_low, at_high) in found.swings.items():
        assert at_low == pytest.approx(float(CUP(NOMINAL | {name: LIMITS[name].low})), rel=1e-12)
        assert at_high == pytest.approx(float(CUP(NOMINAL | {name: LIMITS[name].high})), rel=1e-12)


@each_method
def test_shares_name_the_dimensions_that_scatter(method):
    """The shares name just the dimensions that scatter, leave next to no interaction and are close to the totals."""
    found = spread(method=method)
    assert list(found.shares) == list(found.total_shares) == list(LIMITS)
    assert sum(found.shares.values()) == pytest.approx(1, abs=0.1 if method == "random" else 0.03)
    assert max(found.shares, key=found.shares.get) == "wall_thickness"
    assert found.total_shares == pytest.approx(found.shares, abs=0.1 if method == "random" else 0.03)


def test_shares_are_those_of_the_first_order_budget():
    """For small tolerances the share of a dimension is its part of the first-order variance, within 0.002."""
    found = spread()
    parts = {}
    for name, limits in LIMITS.items():
        step = distribution_of(limits).standard_deviation * 1e-3
        high, low = (float(CUP(NOMINAL | {name: NOMINAL[name] + sign * step})) for sign in (1, -1))
        parts[name] = ((high - low) / 2e-3) ** 2
    budget = {name: part / sum(parts.values()) for name, part in parts.items()}
    assert found.shares == pytest.approx(budget, abs=2e-3)
    assert found.total_shares == pytest.approx(budget, abs=2e-3)


def test_without_a_limit_there_is_no_probability():
    """Without a backlash limit there is neither probability nor index."""
    assert not {key for key in spread().numbers if key.startswith(("probability", "ppk"))}


@each_method
def test_probability_over_a_limit(method):
    """A limit at the 95th percentile is exceeded by 5 % of the units, with an interval around that."""
    limit = spread(method=method).numbers["p95"]
    found = spread(limit=limit, method=method).numbers
    assert found["probability_over_limit"] == pytest.approx(0.05, abs=1e-4)
    assert found["probability_over_limit_low"] < 0.05 < found["probability_over_limit_high"]
    assert found["ppk"] == pytest.approx((limit - found["p50"]) / (found["p99_865"] - found["p50"]), rel=1e-14)
    assert found["ppk_normal"] == pytest.approx((limit - found["mean"]) / (3 * found["sd"]), rel=1e-14)


@pytest.mark.parametrize("method", ["sobol", "random"])
def test_limit_beyond_every_point_is_not_certain(method):
    """A limit that no sampled unit exceeds has probability 0 and an interval that says how sure that is."""
    found = spread(limit=EXACT * 2, method=method).numbers
    assert found["probability_over_limit"] == found["probability_over_limit_low"] == 0
    assert found["probability_over_limit_high"] == pytest.approx(1 - 0.025 ** (1 / found["spread_points"]), rel=1e-9)
    assert found["ppk"] > 10


@pytest.mark.parametrize("sigmas", [4.0, 5.0, 6.0, -5.0])
def test_lines_tell_a_rare_share(sigmas):
    """With one normal modulus alone, lines tell the share over a limit 4 to 6 sd away to 1e-6 of itself."""
    limits = {"youngs_modulus": LIMITS["youngs_modulus"]}
    modulus = 211e9 - sigmas * 8e9 / 6
    found = spread(limits, limit=float(CUP(NOMINAL | {"youngs_modulus": modulus}))).numbers
    exact = 0.5 * math.erfc(sigmas / math.sqrt(2))
    assert found["probability_over_limit"] == pytest.approx(exact, rel=1e-6)
    ends = found["probability_over_limit_low"], found["probability_over_limit_high"]
    assert ends[0] * (1 - 1e-9) <= exact <= ends[1] * (1 + 1e-9)


def test_lines_beyond_the_least_share_say_at_most():
    """A limit that lines tell from no share at all has probability below 1e-15, its interval beginning at 0."""
    found = spread(limit=EXACT * 2).numbers
    assert 0 <= found["probability_over_limit"] <= 1e-15
    assert found["probability_over_limit_low"] == 0 < found["probability_over_limit_high"] < 1e-13


@pytest.mark.slow
@each_method
def test_limit_below_every_unit(method):
    """A limit that every unit exceeds has probability 1 and negative indices."""
    found = spread(limit=EXACT / 2, method=method).numbers
    assert found["probability_over_limit"] == pytest.approx(1, abs=1e-15)
    assert found["probability_over_limit_low"] < found["probability_over_limit_high"] == 1
    assert found["ppk"] < 0
    assert found["ppk_normal"] < 0


@each_method
def test_without_tolerances_everything_is_exact(method):
    """A variant none of whose dimensions scatters has its backlash everywhere and no spread."""
    found = spread({}, method=method)
    for key in (*PERCENTILES, "mean", "coverage_low", "coverage_high", "worst_case_low", "worst_case_high"):
        assert found.numbers[key] == EXACT
    for key in ("sd", "skewness", "kurtosis", "first_order_sd", *ERRORS):
        assert found.numbers[key] == 0
    assert found.texts["first_order_valid"] == "yes"
    assert found.shares == found.total_shares == found.swings == {}
    assert "probability_over_limit" not in found.numbers


@pytest.mark.parametrize(("limit", "over"), [(1.0726e-3, 0.0), (1.0725e-3, 1.0), (EXACT, 0.0)])
def test_exact_variant_against_a_limit(limit, over):
    """An exact variant is over its limit or it is not; one that just meets it is not, and has no index."""
    found = spread({}, limit=limit).numbers
    assert found["probability_over_limit"] == found["probability_over_limit_low"] == over
    assert found["probability_over_limit_high"] == over
    assert found.get("ppk") is found.get("ppk_normal") is None


@pytest.mark.slow
@each_method
def test_exact_and_scattering_variants_have_the_same_statistics(method):
    """Whether or not anything scatters the same statistics are reported, indices and number of points apart."""
    for limit in (None, 1.1e-3):
        exact, scattering = (spread(limits, limit=limit, method=method).numbers for limits in ({}, LIMITS))
        assert set(scattering) - set(exact) <= {
            "ppk",
            "ppk_normal",
            "spread_points",
            "main_contributor_share_standard_error",
        }
        assert set(exact) <= set(scattering)


@pytest.mark.slow
@each_method
def test_shift_without_scatter_moves_everything(method):
    """Limits that coincide off the entered value move all statistics there, also the worst case."""
    shift = {"wall_thickness": Limits(low=0.0017, high=0.0017)}
    alone = spread(shift, method=method).numbers
    assert alone["mean"] == float(CUP(NOMINAL | {"wall_thickness": 0.0017}))
    assert alone["sd"] == 0
    together = spread(LIMITS | shift, method=method).numbers
    moved = spread({name: one for name, one in LIMITS.items() if name != "wall_thickness"},
                   nominal=NOMINAL | {"wall_thickness": 0.0017}, method=method).numbers  # fmt: skip
    assert together == moved


@each_method
def test_spread_is_centred_on_mid_limits(method):
    """Lopsided deviations put the spread around mid-limits, not around the entered value."""
    lopsided = {"wall_thickness": Limits(low=0.0016, high=0.0017)}
    found = spread(lopsided, method=method).numbers
    middle = float(CUP(NOMINAL | {"wall_thickness": 0.00165}))
    assert abs(found["p50"] - middle) <= 4 * found["p50_standard_error"]
    assert found["mean"] < EXACT


@pytest.mark.parametrize("method", ["sobol", "random"])
def test_points_belong_to_names(method):
    """A dimension has the same points whichever other dimensions scatter."""
    alone = {"wall_thickness": LIMITS["wall_thickness"]}
    dead = {"disk_thickness": Limits(low=0.0015, high=0.0017)}
    tube = partial(flexspline.backlash, "cylinder")
    nominal = NOMINAL | {"disk_thickness": 0.0016}
    sampling = plan(method, 2**13)
    first, second = (
        statistics_of_row(row(tube, nominal, limits), sampling).numbers for limits in (alone, dead | alone)
    )
    for key in ("mean", "sd", "p50", "p99_865", "p97_5_standard_error"):
        assert first[key] == second[key]


@each_method
def test_seed_moves_the_statistics_by_their_standard_errors(method):
    """Another seed moves mean and P97.5 by no more than a few standard errors, the worst case not at all."""
    limits = LIMITS | {"disk_inner_radius": Limits(low=0.0395, high=0.0405, distribution="uniform")}
    first, second = (spread(limits, method=method, samples=2**10, seed=seed).numbers for seed in (0, 1))
    for name in ("mean", "p97_5"):
        errors = (first[f"{name}_standard_error"], second[f"{name}_standard_error"])
        assert abs(first[name] - second[name]) <= 5 * math.hypot(*errors)
        assert first[name] != second[name]
    assert first["worst_case_high"] == second["worst_case_high"]
    assert first["first_order_sd"] == second["first_order_sd"]


def test_the_same_seed_gives_the_same_bits():
    """Drawn again from the same seed, every statistic has the same bits."""
    for method in METHODS:
        first, second = (spread(method=method, samples=2**10, limit=1.09e-3) for _ in range(2))
        assert first.numbers == second.numbers


@pytest.mark.slow
@thorough
@given(factor=st.floats(1.0, 5.0), name=st.sampled_from(list(LIMITS)), method=st.sampled_from(METHODS))
def test_wider_tolerance_never_narrows_the_spread(factor, name, method):
    """Wider limits on one dimension never narrow sd, coverage, first-order sd or worst case."""
    narrow = LIMITS[name]
    half = (narrow.high - narrow.low) / 2 * factor
    wide = Limits(low=narrow.middle - half, high=narrow.middle + half, distribution=narrow.distribution)
    before, after = (spread(limits, method=method, samples=512).numbers for limits in (LIMITS, LIMITS | {name: wide}))
    allowed = 1 - (1e-3 if method == "line" else 0.01)
    assert after["sd"] >= before["sd"] * allowed
    width = after["coverage_high"] - after["coverage_low"]
    assert width >= (before["coverage_high"] - before["coverage_low"]) * (1 - 2 * (1 - allowed))
    assert after["first_order_sd"] >= before["first_order_sd"] * (1 - 1e-6)
    assert after["worst_case_low"] <= before["worst_case_low"] * (1 + 1e-12)
    assert after["worst_case_high"] >= before["worst_case_high"] * (1 - 1e-12)


def test_first_order_is_told_where_it_is_enough():
    """First order is enough for narrow normal tolerances and not where one wide rectangular dimension rules."""
    narrow = {"youngs_modulus": Limits(low=210.9e9, high=211.1e9)}
    ruled = {"wall_thickness": Limits(low=0.0012, high=0.0020, distribution="uniform")}
    assert spread(narrow).texts["first_order_valid"] == "yes"
    assert spread(ruled).texts["first_order_valid"] == "no"


def _valid_as_printed(one, centre):
    """Return the verdict of clause 8 worked out by hand, in decimal, from a row's figures in arcmin."""
    row = {key: Decimal(one.numbers[key] / ARCMIN) for key in ("first_order_sd", "coverage_low", "coverage_high")}
    step = Decimal(10) ** (int(f"{row['first_order_sd']:.1e}".split("e")[1]) - 1)
    reach = Decimal("1.959963984540054") * row["first_order_sd"]
    middle = Decimal(centre / ARCMIN)
    off = max(abs(middle - reach - row["coverage_low"]), abs(middle + reach - row["coverage_high"]))
    return "yes" if off <= step / 2 else "no"


def test_first_order_verdicts_follow_from_the_figures_in_arcmin():
    """Over many sizes of tolerance, every verdict is that of the printed figures, and in radians some would differ."""
    rows = []
    for size in np.geomspace(0.002, 0.1, 200):
        wall = NOMINAL["wall_thickness"]
        limits = {"wall_thickness": Limits(low=wall * (1 - size), high=wall * (1 + size))}
        rows.append(row(CUP, NOMINAL, limits))
    found = batch_statistics(rows, plan("line", 64))
    verdicts = [one.texts["first_order_valid"] for one in found]
    assert verdicts == [_valid_as_printed(one, EXACT) for one in found]
    assert set(verdicts) == {"yes", "no"}
    numbers = [[one.numbers[key] for one in found] for key in ("first_order_sd", "coverage_low", "coverage_high")]
    uncertainty, low, high = map(np.array, numbers)
    in_radians = first_order_valid(EXACT, uncertainty, (low, high), 0.95)
    assert (in_radians != (np.array(verdicts) == "yes")).any()
