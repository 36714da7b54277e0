"""One variant's tolerance spread: which statistics it holds and how they hang together."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.columns import DIMENSIONS
from flexlash.mechanics import flexspline
from flexlash.tolerance.limits import Limits
from flexlash.tolerance.sampling import UnitPoints
from flexlash.tolerance.variation import CURVE_PROBABILITIES, variation_of

thorough = settings(deadline=None, max_examples=30, derandomize=True)

NOMINAL = {
    "torque": 800.0,
    "cylinder_length": 0.160,
    "mean_radius": 0.080,
    "wall_thickness": 0.0016,
    "disk_inner_radius": 0.040,
    "youngs_modulus": 211e9,
    "poisson_ratio": 0.3,
}
LIMITS = {
    "cylinder_length": Limits(low=0.1598, high=0.1602, distribution="uniform"),
    "wall_thickness": Limits(low=0.00155, high=0.00165),
    "youngs_modulus": Limits(low=207e9, high=215e9),
}
EXACT = flexspline.backlash("cup", NOMINAL)
POINTS = UnitPoints(list(DIMENSIONS), method="sobol", samples=2**13, seed=0)


def cup(dimensions):
    """Return the backlash of a cup [rad]."""
    return flexspline.backlash("cup", dimensions)


def spread(limits=LIMITS, *, nominal=NOMINAL, points=POINTS, limit=None, coverage=0.95):
    """Return the variation of the cup over its limits."""
    return variation_of(cup, nominal, limits, points, limit=limit, coverage=coverage)


def test_percentiles_rise_between_the_worst_cases():
    """The percentiles rise from P0.135 to P99.865, and mean and median lie close together in their middle."""
    found = spread().statistics
    order = [found[key] for key in ("p0_135", "p2_5", "p5", "p50", "p95", "p97_5", "p99_865")]
    assert order == sorted(order)
    assert len(set(order)) == len(order)
    assert abs(found["mean"] - found["p50"]) < 0.1 * found["sd"]
    assert found["worst_case_low"] < found["p0_135"]
    assert found["p99_865"] < found["worst_case_high"]


def test_sd_is_close_to_first_order():
    """For small tolerances the sampled standard deviation is the first-order one within 1 %."""
    found = spread().statistics
    assert found["sd"] == pytest.approx(found["first_order_sd"], rel=0.01)
    assert found["mean"] == pytest.approx(float(EXACT), rel=1e-3)


@pytest.mark.parametrize("coverage", [0.5, 0.9, 0.95, 0.9973])
def test_coverage_interval_is_symmetric_in_probability(coverage):
    """The coverage interval leaves the same share of units below and above."""
    found = spread(coverage=coverage).statistics
    curve = spread()
    order = np.interp([found["coverage_low"], found["coverage_high"]], curve.curve, CURVE_PROBABILITIES)
    assert order == pytest.approx([(1 - coverage) / 2, (1 + coverage) / 2], abs=0.003)
    if coverage == 0.95:
        assert (found["coverage_low"], found["coverage_high"]) == (found["p2_5"], found["p97_5"])


def test_standard_errors_are_small_and_ordered():
    """Every standard error is positive and below the sd, that of P99.865 greater than that of P97.5."""
    found = spread().statistics
    for name in ("mean", "sd", "p97_5", "p99_865"):
        assert 0 < found[f"{name}_standard_error"] < 0.1 * found["sd"]
    assert found["p99_865_standard_error"] > found["p97_5_standard_error"]


def test_worst_case_takes_every_limit():
    """The worst case has every dimension at the limit that hurts, normals at their limits and not beyond."""
    found = spread().statistics
    high = {"cylinder_length": 0.1602, "wall_thickness": 0.00155, "youngs_modulus": 207e9}
    low = {"cylinder_length": 0.1598, "wall_thickness": 0.00165, "youngs_modulus": 215e9}
    assert found["worst_case_high"] == pytest.approx(float(cup(NOMINAL | high)), rel=1e-14)
    assert found["worst_case_low"] == pytest.approx(float(cup(NOMINAL | low)), rel=1e-14)


def test_swings_hold_each_dimension_at_its_limits():
    """Each dimension's swing is the backlash at its two limits with the others in the middle of theirs."""
    found = spread()
    assert list(found.swings) == list(LIMITS)
    for name, (at_low, at_high) in found.swings.items():
        assert at_low == pytest.approx(float(cup(NOMINAL | {name: LIMITS[name].low})), rel=1e-12)
        assert at_high == pytest.approx(float(cup(NOMINAL | {name: LIMITS[name].high})), rel=1e-12)


def test_shares_name_the_dimensions_that_scatter():
    """The shares name just the dimensions that scatter and leave next to no interaction."""
    found = spread()
    assert set(found.shares) == set(LIMITS)
    assert sum(found.shares.values()) == pytest.approx(1, abs=0.03)
    assert max(found.shares, key=found.shares.get) == "wall_thickness"


def test_curve_and_histogram():
    """The curve rises over its probabilities; the histogram's heights are shares of all units."""
    found = spread()
    assert found.curve.shape == (len(CURVE_PROBABILITIES),)
    assert (np.diff(found.curve) > 0).all()
    assert list(CURVE_PROBABILITIES) == sorted(CURVE_PROBABILITIES)
    place = CURVE_PROBABILITIES.index(0.975)
    assert found.curve[place] == found.statistics["p97_5"]
    assert found.edges.shape == (41,)
    assert found.heights.shape == (40,)
    assert found.heights.sum() == pytest.approx(0.999, abs=3e-4)


def test_without_a_limit_there_is_no_probability():
    """Without a backlash limit there is neither probability nor index."""
    assert not {key for key in spread().statistics if key.startswith("probability") or key == "ppk"}


def test_probability_over_a_limit():
    """A limit at the 95th percentile is exceeded by 5 % of the units, with an interval around that."""
    limit = spread().statistics["p95"]
    found = spread(limit=limit).statistics
    assert found["probability_over_limit"] == pytest.approx(0.05, abs=2e-4)
    assert found["probability_over_limit_low"] < 0.05 < found["probability_over_limit_high"]
    assert found["ppk"] == pytest.approx((limit - found["p50"]) / (found["p99_865"] - found["p50"]), rel=1e-14)


def test_limit_beyond_every_unit_is_not_certain():
    """A limit that no sampled unit exceeds has probability 0 and an interval that says how sure that is."""
    found = spread(limit=float(EXACT) * 2).statistics
    assert found["probability_over_limit"] == found["probability_over_limit_low"] == 0
    assert found["probability_over_limit_high"] == pytest.approx(1 - 0.025 ** (1 / POINTS.size), rel=1e-9)
    assert found["ppk"] > 10


def test_limit_below_every_unit():
    """A limit that every unit exceeds has probability 1 and a negative index."""
    found = spread(limit=float(EXACT) / 2).statistics
    assert found["probability_over_limit"] == found["probability_over_limit_high"] == 1
    assert found["ppk"] < 0


def test_without_tolerances_everything_is_exact():
    """A variant none of whose dimensions scatters has its backlash everywhere and no spread."""
    found = spread({})
    for key in ("mean", "p0_135", "p2_5", "p5", "p50", "p95", "p97_5", "p99_865", "coverage_low", "coverage_high"):
        assert found.statistics[key] == EXACT
    assert found.statistics["worst_case_low"] == found.statistics["worst_case_high"] == EXACT
    for key in ("sd", "first_order_sd", "mean_standard_error", "sd_standard_error"):
        assert found.statistics[key] == 0
    assert found.statistics["p97_5_standard_error"] == found.statistics["p99_865_standard_error"] == 0
    assert found.shares == found.swings == {}
    assert found.curve is found.edges is found.heights is None
    assert "probability_over_limit" not in found.statistics


@pytest.mark.parametrize(("limit", "over"), [(1.0726e-3, 0.0), (1.0725e-3, 1.0), (float(EXACT), 0.0)])
def test_exact_variant_against_a_limit(limit, over):
    """An exact variant is over its limit or it is not; one that just meets it is not, and has no index."""
    found = spread({}, limit=limit).statistics
    assert found["probability_over_limit"] == found["probability_over_limit_low"] == over
    assert found["probability_over_limit_high"] == over
    assert found.get("ppk") is None


def test_exact_and_scattering_variants_have_the_same_statistics():
    """Whether or not anything scatters the same statistics are reported, the index apart."""
    for limit in (None, 1.1e-3):
        exact, scattering = spread({}, limit=limit).statistics, spread(limit=limit).statistics
        assert set(scattering) - set(exact) <= {"ppk"}
        assert set(exact) <= set(scattering)


def test_shift_without_scatter_moves_everything():
    """Limits that coincide off the entered value move all statistics there, also the worst case."""
    shift = {"wall_thickness": Limits(low=0.0017, high=0.0017)}
    alone = spread(shift).statistics
    assert alone["mean"] == float(cup(NOMINAL | {"wall_thickness": 0.0017}))
    assert alone["sd"] == 0
    together = spread(LIMITS | shift).statistics
    moved = spread({name: one for name, one in LIMITS.items() if name != "wall_thickness"},
                   nominal=NOMINAL | {"wall_thickness": 0.0017}).statistics  # fmt: skip
    assert together == moved


def test_spread_is_centred_on_mid_limits():
    """Lopsided deviations put the spread around mid-limits, not around the entered value."""
    lopsided = {"wall_thickness": Limits(low=0.0016, high=0.0017)}
    found = spread(lopsided).statistics
    middle = float(cup(NOMINAL | {"wall_thickness": 0.00165}))
    assert found["p50"] == pytest.approx(middle, rel=1e-5)
    assert found["mean"] < float(EXACT)


def test_draws_belong_to_names():
    """A dimension has the same draws whichever other dimensions scatter and whichever the points hold."""
    alone = {"wall_thickness": LIMITS["wall_thickness"]}
    dead = {"disk_thickness": Limits(low=0.0015, high=0.0017)}

    def without_disk(dimensions):
        return flexspline.backlash("cylinder", dimensions)

    first = variation_of(without_disk, NOMINAL, alone, POINTS, limit=None, coverage=0.95).statistics
    second = variation_of(without_disk, NOMINAL, dead | alone, POINTS, limit=None, coverage=0.95).statistics
    for key in ("mean", "sd", "p50", "p99_865", "p97_5_standard_error"):
        assert first[key] == second[key]


def test_seed_moves_the_statistics_by_their_standard_errors():
    """Another seed moves mean and P97.5 by no more than a few standard errors, the worst case not at all."""
    other = UnitPoints(list(DIMENSIONS), method="random", samples=2**13, seed=1)
    first, second = spread().statistics, spread(points=other).statistics
    for name in ("mean", "p97_5"):
        errors = (first[f"{name}_standard_error"], second[f"{name}_standard_error"])
        assert abs(first[name] - second[name]) <= 5 * math.hypot(*errors)
        assert first[name] != second[name]
    assert first["worst_case_high"] == second["worst_case_high"]
    assert first["first_order_sd"] == second["first_order_sd"]


@thorough
@given(factor=st.floats(1.0, 5.0), name=st.sampled_from(list(LIMITS)))
def test_wider_tolerance_never_narrows_the_spread(factor, name):
    """Wider limits on one dimension never narrow sd, first-order sd or worst case."""
    narrow = LIMITS[name]
    half = (narrow.high - narrow.low) / 2 * factor
    wide = Limits(low=narrow.middle - half, high=narrow.middle + half, distribution=narrow.distribution)
    points = UnitPoints(list(DIMENSIONS), method="sobol", samples=512, seed=0)
    before, after = (spread(limits, points=points).statistics for limits in (LIMITS, LIMITS | {name: wide}))
    assert after["sd"] >= before["sd"] * 0.995
    assert after["first_order_sd"] >= before["first_order_sd"] * (1 - 1e-6)
    assert after["worst_case_low"] <= before["worst_case_low"] * (1 + 1e-12)
    assert after["worst_case_high"] >= before["worst_case_high"] * (1 - 1e-12)
