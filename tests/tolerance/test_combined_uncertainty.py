"""The interval that uncertain parameters leave of a probability and a percentile."""

from __future__ import annotations

import math

import numpy as np
import pytest
from grids import for_each
from scipy import stats

from flexlash.tolerance.combined_uncertainty import (
    OutputNumbers,
    Parameter,
    Product,
    _beyond_sum,
    percentile_interval,
    probability_interval,
    standard_scores,
)
from flexlash.tolerance.sample_uncertainty import SampleUncertainty


def numbers(mean, variance, limit):
    """Return the numbers of a normal output."""
    sd = math.sqrt(variance)
    return OutputNumbers(mean=mean, sd=sd, percentile=mean + 3 * sd, probability=stats.norm.sf((limit - mean) / sd))


def of_sum(sds, sizes, limit, rest=0.0):
    """Return a sum of normal inputs by samples and of a known rest, and its parameters."""
    whole = sum(sd**2 for sd in sds) + rest
    scores = standard_scores(2 * len(sds))
    parameters = []
    for place, (sd, size) in enumerate(zip(sds, sizes, strict=True)):
        sample = SampleUncertainty(size=size)
        ratios = sample.sd_ratios(scores[2 * place])
        off, (low, high) = sample.offset_end, [end**2 - 1 for end in sample.sd_ends]
        at = [numbers(move * sd, whole, limit) for move in (-off, off)]
        moves = ratios * scores[2 * place + 1] / math.sqrt(size)
        parameters.append(Parameter(moves=moves, low=-off, high=off, at_low=at[0], at_high=at[1], scatters=False))
        at = [numbers(0.0, whole + end * sd**2, limit) for end in (low, high)]
        moves = ratios**2 - 1
        parameters.append(Parameter(moves=moves, low=low, high=high, at_low=at[0], at_high=at[1], scatters=True))
    return numbers(0.0, whole, limit), parameters


def noncentral(size, score):
    """Return the exact interval of the score of a limit that is `score` sample sds above the mean of so many values."""
    root = math.sqrt(size)
    below, above = score - 3, score + 5
    ends = []
    for share in (0.025, 0.975):
        low, high = below, above
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (
                (middle, high) if stats.nct.cdf(root * score, size - 1, root * middle) > share else (low, middle)
            )
        ends.append(low)
    return sorted(ends)


@for_each("case", [(10, 2.0), (20, 1.0), (20, 3.0), (60, 3.0), (60, 4.2), (200, 3.5)])
def test_one_sample_has_the_exact_interval(case):
    """Of one normal sample the interval of a probability is that of the noncentral t distribution."""
    size, score = case
    low, high = probability_interval(*of_sum([1.0], [size], score))
    exact = noncentral(size, score)
    width = exact[1] - exact[0]
    assert stats.norm.isf([high, low]) == pytest.approx(exact, abs=0.01 * width)


@for_each("size", (10, 20, 60, 200))
def test_one_sample_has_the_exact_tolerance_limits(size):
    """Of one normal sample the interval of P99.865 ends at the exact one-sided tolerance limits."""
    root = math.sqrt(size)
    exact = stats.nct.ppf([0.025, 0.975], size - 1, root * 3.0) / root
    assert percentile_interval(*of_sum([1.0], [size], 3.0)) == pytest.approx(exact, abs=0.01 * (exact[1] - exact[0]))


@for_each("limit", (-1.0, 0.0, 4.0, 6.5))
def test_samples_beside_a_known_rest_combine_as_plain_draws_do(limit):
    """Two samples and a known part give the interval that a million plain fiducial draws give."""
    sds, sizes, rest = (1.0, 0.7), (20, 60), 0.8
    generator, mean, variance = np.random.default_rng(11), 0.0, rest
    for sd, size in zip(sds, sizes, strict=True):
        square = sd**2 * (size - 1) / generator.chisquare(size - 1, 1_000_000)
        mean = mean + np.sqrt(square / size) * generator.standard_normal(1_000_000)
        variance = variance + square
    scores = (limit - mean) / np.sqrt(variance)
    exact = np.quantile(scores, [0.025, 0.975])
    low, high = probability_interval(*of_sum(sds, sizes, limit, rest))
    assert stats.norm.isf([high, low]) == pytest.approx(exact, abs=0.015 * (exact[1] - exact[0]))
    exact = np.quantile(mean + 3 * np.sqrt(variance), [0.025, 0.975])
    found = percentile_interval(*of_sum(sds, sizes, limit, rest))
    assert found == pytest.approx(exact, abs=0.015 * (exact[1] - exact[0]))


def test_what_bends_keeps_its_ends():
    """A single parameter that shifts the output unevenly gives the numbers that were found at its ends."""
    middle, low, high = (numbers(shift, 1.0, 3.0) for shift in (0.0, -0.1, 0.4))
    scores = standard_scores(1)[0]
    parameter = Parameter(moves=scores, low=-1.96, high=1.96, at_low=low, at_high=high, scatters=False)
    assert probability_interval(middle, [parameter]) == pytest.approx((low.probability, high.probability), rel=5e-3)
    assert percentile_interval(middle, [parameter]) == pytest.approx((low.percentile, high.percentile), rel=1e-3)


def test_what_cannot_be_told_from_none_is_none():
    """Where the limit lies beyond all that parts reach, the lower end is 0 and the upper one what the ends reach."""
    never, rare = (
        OutputNumbers(mean=0.0, sd=sd, percentile=2 * sd, probability=over) for sd, over in ((1, 0.0), (2, 1e-3))
    )
    scores = standard_scores(1)[0]
    parameter = Parameter(moves=scores, low=-1.96, high=1.96, at_low=never, at_high=rare, scatters=True)
    low, high = probability_interval(never, [parameter])
    assert low == 0.0
    assert 0.0 < high < 2e-3


def test_sets_of_parameters_are_the_same_whenever_they_are_asked_for():
    """What one row gets does not depend on what was asked before."""
    first = standard_scores(4).copy()
    standard_scores.cache_clear()
    standard_scores(6)
    assert (standard_scores(4) == first).all()


@for_each("moves", [(0.4, -0.3, -0.2), (0.4, 0.3, 0.2), (-0.5, -0.5, 0.3), (0.0, 0.7, -0.9)])
def test_a_covariance_adds_what_its_factors_do_together(moves):
    """The variance of a sum with both sds and the correlation moved is that of each alone, and what a product adds."""
    sds, estimate = (2.0, 3.0), 0.5

    def variance(first, second, correlation):
        cross = 2 * sds[0] * sds[1] * math.sqrt((1 + first) * (1 + second)) * (estimate + correlation)
        return sds[0] ** 2 * (1 + first) + sds[1] ** 2 * (1 + second) + cross

    def parameter(place, low, high):
        at_low, at_high = (numbers(0.0, variance(*np.eye(3)[place] * end), 1.0) for end in (low, high))
        ends = {"low": low, "high": high, "at_low": at_low, "at_high": at_high}
        return Parameter(moves=np.array([moves[place]]), scatters=True, **ends)

    first, second = (parameter(place, -0.5, 0.8) for place in (0, 1))
    product = Product(first=first, second=second, correlation=parameter(2, -0.4, 0.3), estimate=estimate)
    whole = variance(0, 0, 0)
    alone = sum(variance(*np.eye(3)[place] * moves[place]) - whole for place in range(3))
    together = variance(*moves) - whole - alone
    assert _beyond_sum(numbers(0.0, whole, 1.0), product)[0] * whole == pytest.approx(together, abs=1e-12)
