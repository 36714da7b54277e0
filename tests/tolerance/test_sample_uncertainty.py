"""What a number of measured values leaves open of a process."""

from __future__ import annotations

import statistics

import numpy as np
import pytest
from grids import for_each
from scipy import stats

from flexlash.tolerance.sample_uncertainty import SampleUncertainty

BONETT = [15.83, 16.01, 16.24, 16.42, 15.33, 15.44, 16.88, 16.31]
"""Values of the example in Bonett 2006, whose standard deviation he gives as 0.5168, between 0.3263 and 1.0841."""


def test_bonetts_example_comes_out():
    """The interval of the standard deviation of values that need not be normal is the published one."""
    sd = statistics.stdev(BONETT)
    low, high = SampleUncertainty.of_values(BONETT).sd_ends
    assert [round(number, 4) for number in (sd, sd * low, sd * high)] == [0.5168, 0.3263, 1.0841]


@for_each("size", (5, 10, 60, 1000, 20_000))
def test_normal_ends_are_those_of_student_and_chi_square(size):
    """Mean and standard deviation of a normal process have the intervals of the textbook."""
    found = SampleUncertainty(size=size)
    assert found.offset_end == pytest.approx(stats.t.ppf(0.975, size - 1) / size**0.5, rel=1e-9)
    squares = (size - 1) / stats.chi2.ppf([0.975, 0.025], size - 1)
    assert np.square(found.sd_ends) == pytest.approx(squares, rel=1e-9)


@for_each("size", (5, 10, 60, 1000))
def test_ratios_have_the_distribution_of_the_estimate(size):
    """At any score the ratio is the chi-square quantile of that score, whatever table it was taken from."""
    scores = np.array([-3.9, -1.9599, -0.0037, 0.5, 2.41, 3.8])
    exact = np.sqrt((size - 1) / stats.chi2.isf(stats.norm.cdf(scores), size - 1))
    assert SampleUncertainty(size=size).sd_ratios(scores) == pytest.approx(exact, rel=1e-4)


@pytest.mark.slow
@for_each("skewed", (False, True))
def test_bonetts_interval_holds_the_standard_deviation(skewed):
    """Of uniform and of skewed values the interval holds the true standard deviation about as often as it says."""
    generator, inside = np.random.default_rng(5), 0
    for _ in range(2000):
        values = generator.gamma(4.0, size=60) / 2 if skewed else generator.random(60) * 12**0.5
        low, high = (values.std(ddof=1) * end for end in SampleUncertainty.of_values(values.tolist()).sd_ends)
        inside += low <= 1.0 <= high
    assert 0.92 <= inside / 2000 <= 0.98


def test_skewed_values_tie_mean_and_standard_deviation():
    """Where large values scatter more, a sample whose mean is too great has too great a standard deviation, too."""
    values = np.random.default_rng(3).gamma(4.0, size=5000)
    skewness, kurtosis = 1.0, 4.5
    assert SampleUncertainty.of_values(values.tolist()).tie == pytest.approx(skewness / (kurtosis - 1) ** 0.5, abs=0.05)
    assert SampleUncertainty.of_values((-values).tolist()).tie < -0.4


def test_four_values_have_no_shape():
    """Fewer than five values are refused by name."""
    with pytest.raises(ValueError, match="values are 4: at least 5"):
        SampleUncertainty.of_values([1.0, 2.0, 3.0, 4.0])
