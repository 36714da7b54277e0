"""The interval of a counted share and the performance index against an upper limit."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from flexlash.tolerance.capability import clopper_pearson, ppk_normal, ppk_upper

thorough = settings(deadline=None, max_examples=80, derandomize=True)


def test_none_of_ten_thousand():
    """0 of 10 000 over the limit is not 0 ppm but at most 368.8 ppm at 95 %, two-sided."""
    low, high = clopper_pearson(0, 10_000)
    assert low == 0
    assert high * 1e6 == pytest.approx(368.8, abs=0.05)
    assert high == pytest.approx(1 - 0.025 ** (1 / 10_000), rel=1e-9)


def test_all_of_ten_thousand():
    """10 000 of 10 000 over the limit is at least the mirrored share."""
    low, high = clopper_pearson(10_000, 10_000)
    assert high == 1
    assert low == pytest.approx(0.025 ** (1 / 10_000), rel=1e-9)


@pytest.mark.slow
@thorough
@given(total=st.integers(1, 100_000), part=st.floats(0, 1), confidence=st.sampled_from([0.8, 0.95, 0.99]))
def test_interval_is_the_exact_binomial_one(total, part, confidence):
    """The interval of a share is scipy's exact binomial interval and holds the share itself."""
    count = round(part * total)
    low, high = clopper_pearson(count, total, confidence)
    exact = stats.binomtest(count, total).proportion_ci(confidence, "exact")
    assert (low, high) == pytest.approx((exact.low, exact.high), rel=1e-6, abs=1e-12)
    assert 0 <= low <= count / total <= high <= 1


def test_more_confidence_is_wider():
    """A surer interval is wider, one of more units narrower."""
    low, high = clopper_pearson(5, 1000, 0.95)
    surer, more = clopper_pearson(5, 1000, 0.99), clopper_pearson(50, 10_000, 0.95)
    assert surer[0] < low < more[0] < 0.005 < more[1] < high < surer[1]


@pytest.mark.parametrize(
    ("index", "expected"),
    [
        (ppk_upper, {(3.0, 1.0, 2.0): 2.0, (2.0, 1.0, 2.0): 1.0, (1.0, 1.0, 2.0): 0.0, (0.5, 1.0, 2.0): -0.5}),
        (ppk_normal, {(4.0, 1.0, 0.5): 2.0, (2.5, 1.0, 0.5): 1.0, (1.0, 1.0, 0.5): 0.0, (0.25, 1.0, 0.25): -1.0}),
    ],
)
def test_ppk_compares_the_limit_with_the_upper_tail(index, expected):
    """Ppk is the limit's distance from the middle over that of P99.865, or over 3 sd; negative for a limit below."""
    assert {arguments: index(*arguments) for arguments in expected} == expected


@thorough
@given(mean=st.floats(-10, 10), sd=st.floats(0.01, 10), limit=st.floats(-50, 50))
def test_ppk_of_a_normal_is_the_classical_index(mean, sd, limit):
    """For a normal output both indices are (limit − mean)/3s."""
    upper = mean + float(stats.norm.ppf(0.99865)) * sd
    for index in (ppk_upper(limit, mean, upper), ppk_normal(limit, mean, sd)):
        assert index == pytest.approx((limit - mean) / (3 * sd), rel=1e-4, abs=1e-9)


@pytest.mark.parametrize("upper", [1.0, 0.5, math.inf, math.nan])
def test_ppk_needs_scatter(upper):
    """Nothing that scatters, or a percentile that is no number, has no index."""
    assert ppk_upper(3.0, 1.0, upper) is None


def test_normal_theory_flatters_a_skewed_output():
    """For an exponential output, whose upper tail is long, normal theory gives 2 instead of 1.07."""
    median, upper = math.log(2), -math.log(0.00135)
    assert ppk_normal(7.0, 1.0, 1.0) == 2.0
    assert ppk_upper(7.0, median, upper) == pytest.approx(1.0663, abs=5e-5)


@pytest.mark.parametrize("sd", [0.0, -1.0, math.inf, math.nan])
def test_ppk_by_normal_theory_needs_scatter(sd):
    """Nothing that scatters, or an sd that is no number, has no index."""
    assert ppk_normal(3.0, 1.0, sd) is None
