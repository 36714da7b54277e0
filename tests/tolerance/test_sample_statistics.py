"""What measured parts tell of a process: textbook intervals, capability, normality, correlation."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy import stats

from flexlash.schema.variant import MeasuredDimension
from flexlash.tolerance.sample_statistics import (
    SampleStatistics,
    _normality_p,
    capability,
    measured_correlation,
    normality,
    sample_statistics,
)

WEIGHTS = [148, 154, 158, 160, 161, 162, 166, 170, 182, 195, 236]
"""Weights of eleven men, of which Stephens (1986, page 98) gives A² = 0.947."""


def _exact(count, mean, sd):
    """Return values with these statistics, otherwise normal scores."""
    scores = stats.norm.ppf((np.arange(1, count + 1) - 0.375) / (count + 0.25))
    return mean + sd * (scores - scores.mean()) / scores.std(ddof=1)


def _dimension(name, values, parts=None, sample="wall"):
    parts = range(2, len(values) + 2) if parts is None else parts
    return MeasuredDimension(sample=sample, dimension=name, values=tuple(values), parts=tuple(parts))


def test_the_issues_wall():
    """Sixty walls with the mean 1.607 and s 0.0041 within 1.58 and 1.62 have Cpk 1.06, surely from 0.85 to 1.27."""
    found = capability(sample_statistics(_exact(60, 1.607, 0.0041)), 1.58, 1.62)
    assert (f"{found.cpk:.2f}", f"{found.cpk_low:.2f}", f"{found.cpk_high:.2f}") == ("1.06", "0.85", "1.27")
    assert found.cp == pytest.approx(0.04 / (6 * 0.0041), rel=1e-9)


@pytest.mark.parametrize("count", [2, 5, 20, 60, 10_000])
def test_intervals_are_those_of_t_and_chi_square(count):
    """The intervals of mean and sd are scipy's."""
    found = sample_statistics(_exact(count, 1.607, 0.0041))
    assert (found.mean, found.sd) == (pytest.approx(1.607, rel=1e-12), pytest.approx(0.0041, rel=1e-9))
    low, high = stats.t.interval(0.95, count - 1, 1.607, 0.0041 / math.sqrt(count))
    assert (found.mean_low, found.mean_high) == (pytest.approx(low, rel=1e-9), pytest.approx(high, rel=1e-9))
    low, high = 0.0041 * np.sqrt((count - 1) / stats.chi2.ppf([0.975, 0.025], count - 1))
    assert (found.sd_low, found.sd_high) == (pytest.approx(low, rel=1e-9), pytest.approx(high, rel=1e-9))


def test_published_intervals():
    """Montgomery's examples of 20 parts: Cp 2.29 is 1.57 to 3.01, Cpk 1.33 is 0.88 to 1.78."""
    found = capability(sample_statistics(_exact(20, 50.0, 1.75)), 38.0, 62.0)
    assert (found.cp, found.cp_low, found.cp_high) == pytest.approx((2.29, 1.57, 3.01), abs=0.006)
    found = capability(sample_statistics(_exact(20, 0.0, 1.0)), -9.0, 3 * 1.33)
    assert (f"{found.cpk:.2f}", f"{found.cpk_low:.2f}", f"{found.cpk_high:.2f}") == ("1.33", "0.88", "1.78")


def test_order_changes_no_bit():
    """The parts may stand in any order."""
    values = _exact(61, 1.607, 0.0041)
    shuffled = np.random.default_rng(3).permutation(values)
    assert sample_statistics(shuffled) == sample_statistics(values)


def test_equal_values_scatter_not():
    """Values that are all equal have no spread, no test and no capability."""
    found = sample_statistics([0.1] * 7)
    assert (found.mean, found.sd, found.sd_high, found.normality) == (0.1, 0, 0, None)
    assert capability(found, 0.0, 0.2) is None


@pytest.mark.parametrize("values", [[], [1.0], [[1.0, 2.0]], [1.0, math.inf], [1.0, math.nan]])
def test_what_is_no_sample(values):
    """Fewer than two values, a table and endless values are refused."""
    with pytest.raises(ValueError, match="values"):
        sample_statistics(values)


def test_capability_needs_limits_in_order():
    """Limits that do not leave a width are refused."""
    with pytest.raises(ValueError, match="low"):
        capability(sample_statistics([1.0, 2.0]), 1.0, 1.0)


@pytest.mark.slow
@pytest.mark.parametrize(("count", "true", "off"), [(20, 1.06, 3.2), (60, 1.06, 3.2), (60, 1.33, 1.0), (200, 0.2, 2.0)])
def test_the_interval_of_cpk_holds_it(count, true, off):
    """Of 4,000 samples of a known process some 95 of 100 intervals hold its Cpk."""
    half = 3 * true + off
    values = np.random.default_rng(count).standard_normal((4000, count)) + off
    held = 0
    for mean, sd in zip(values.mean(axis=1), values.std(axis=1, ddof=1), strict=True):
        of = SampleStatistics(
            count=count, mean=mean, mean_low=0, mean_high=0, sd=sd, sd_low=sd, sd_high=sd, normality=None
        )
        found = capability(of, -half, half)
        held += found.cpk_low <= true <= found.cpk_high
    assert held / 4000 == pytest.approx(0.95, abs=0.012)


def test_the_statistic_is_the_published_one():
    """Anderson and Darling's A² of the eleven weights is Stephens's 0.947, whose p is 0.0105."""
    published = 0.947 * (1 + 0.75 / 11 + 2.25 / 121)
    assert normality(WEIGHTS) == pytest.approx(_normality_p(published), rel=3e-3)
    assert normality(WEIGHTS) == pytest.approx(0.0105, abs=5e-5)


@pytest.mark.parametrize(
    ("critical", "level"),
    [(0.341, 0.50), (0.470, 0.25), (0.561, 0.15), (0.631, 0.10), (0.752, 0.05), (0.873, 0.025), (1.035, 0.01)],
)
def test_published_levels(critical, level):
    """The p-values at the critical values of D'Agostino and Stephens's table 4.7 are its levels."""
    assert _normality_p(critical) == pytest.approx(level, rel=0.025)


def test_the_p_value_falls():
    """The four formulas meet: the p-value falls with the statistic, from 1 to nearly 0."""
    found = [_normality_p(statistic) for statistic in np.linspace(0.12, 13.0, 4000)]
    assert all(later < earlier + 2e-3 for earlier, later in pairwise(found))
    assert found[0] > 0.98
    assert 0 < found[-1] < 1e-26
    assert _normality_p(500.0) == found[-1]


@pytest.mark.slow
@pytest.mark.parametrize("count", [5, 20, 60])
def test_normal_processes_fail_at_their_level(count):
    """Of 2,000 samples of a normal process five in a hundred have p below 0.05."""
    values = np.random.default_rng(count).standard_normal((2000, count))
    assert np.mean([normality(row) < 0.05 for row in values]) == pytest.approx(0.05, abs=0.016)


def test_far_values_leave_no_trouble():
    """One value far beyond the others has a p-value of nearly 0, without a warning of NumPy."""
    assert normality([*_exact(9999, 0.0, 1e-9), 1e6]) < 1e-20


def test_pearson_of_values():
    """Correlation and Fisher's interval are scipy's."""
    draws = np.random.default_rng(5).multivariate_normal([1, 2], [[1, 0.6], [0.6, 1]], 60).T
    found = measured_correlation(_dimension("wall", draws[0]), _dimension("disk", draws[1]), by_scores=False)
    reference = stats.pearsonr(*draws)
    interval = reference.confidence_interval(0.95)
    assert found.count == 60
    assert found.correlation == pytest.approx(reference.statistic, rel=1e-12)
    assert (found.low, found.high) == (pytest.approx(interval.low, rel=1e-9), pytest.approx(interval.high, rel=1e-9))


def test_scores_follow_ranks_alone():
    """The correlation of scores does not change when a dimension is bent, that of values does."""
    draws = np.random.default_rng(6).multivariate_normal([0, 0], [[1, 0.6], [0.6, 1]], 60).T
    straight, bent = _dimension("wall", draws[0]), _dimension("wall", np.exp(2 * draws[0]))
    disk = _dimension("disk", draws[1])
    scores = [measured_correlation(wall, disk, by_scores=True).correlation for wall in (straight, bent)]
    values = [measured_correlation(wall, disk, by_scores=False).correlation for wall in (straight, bent)]
    assert scores[0] == scores[1] == pytest.approx(0.6, abs=0.15)
    assert abs(values[0] - values[1]) > 0.1


def test_equal_values_share_their_rank():
    """Values that a gauge rounds alike have the same score, whatever their order."""
    wall, disk = [1.0, 1.0, 2.0, 2.0, 3.0, 3.0], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    swapped = [2.0, 1.0, 4.0, 3.0, 6.0, 5.0]
    found = [
        measured_correlation(_dimension("wall", wall), _dimension("disk", other), by_scores=True).correlation
        for other in (disk, swapped)
    ]
    assert found[0] == pytest.approx(found[1], rel=1e-12)
    ranks = stats.rankdata(wall)
    scores = [stats.norm.ppf((rank - 0.375) / 6.25) for rank in (ranks, stats.rankdata(disk))]
    assert found[0] == pytest.approx(stats.pearsonr(*scores).statistic, rel=1e-12)


def test_parts_measured_together():
    """Parts of which only one dimension was measured take no part, in whatever order the dimensions hold theirs."""
    wall = _dimension("wall", [9.0, 1.0, 2.0, 3.0, 4.0, 5.0], [2, 3, 4, 5, 6, 7])
    disk = _dimension("disk", [50.0, 40.0, 30.0, 20.0, 10.0, -7.0], [7, 6, 5, 4, 3, 8])
    found = measured_correlation(wall, disk, by_scores=False)
    assert found.count == 5
    assert (found.correlation, found.low, found.high) == (pytest.approx(1, rel=1e-12),) * 3


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (_dimension("wall", [1.0, 2.0, 3.0, 4.0]), _dimension("disk", [1.0, 2.0, 3.0, 5.0])),
        (_dimension("wall", [1.0] * 6), _dimension("disk", range(6))),
        (_dimension("wall", range(6)), _dimension("disk", range(6), sample="other")),
        (_dimension("wall", range(6)), _dimension("disk", range(6), range(100, 106))),
    ],
)
def test_where_no_correlation_can_be_told(first, second):
    """Fewer than five common parts, equal values and parts of other samples give none."""
    assert measured_correlation(first, second, by_scores=False) is None


@pytest.mark.parametrize("end", [0.2, 0.34, 0.6])
def test_the_formulas_of_the_p_value_join(end):
    """Where one formula of the p-value ends and the next begins, both say nearly the same."""
    below, above = (_normality_p(end + step) for step in (-1e-9, 1e-9))
    assert below == pytest.approx(above, rel=0.025)
