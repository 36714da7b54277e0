"""Models of `coverage_cases` whose truths are no plain sums or products, each with what gives its truth."""

from __future__ import annotations

import math

import numpy as np
from exact_laws import (
    SCORES,
    Law,
    Truth,
    grid_of_two,
    identity,
    inverse,
    lognormal_moments,
    mixture,
    sobol_scores,
    values_at,
)
from scipy.special import ndtr, ndtri, stdtr

from flexlash.tolerance import Normal, Student, Uniform

UNIFORM = Uniform(-1, 1)

CHAIN = {("x0", "x1"): 0.8, ("x1", "x2"): 0.5, ("x2", "x3"): -0.4}
SDS = (1.0, 2.0, 1.5, 0.5)


def normal_sum_truth():
    """Return the truth of a sum of correlated normals: it is normal."""
    covariance = np.diag(np.square(SDS))
    for (first, other), correlation in CHAIN.items():
        row, column = int(first[1]), int(other[1])
        covariance[row, column] = covariance[column, row] = correlation * SDS[row] * SDS[column]
    sd = math.sqrt(covariance.sum())
    return Truth(quantile=lambda share: sd * ndtri(share), mean=0.0, sd=sd, skewness=0.0, kurtosis=0.0)


def lognormal_truth(sigma, shares):
    """Return the truth of the exponential of a normal number of this sd, with its inputs' shares where it has some."""
    mean, sd, skewness, kurtosis = lognormal_moments(sigma)
    return Truth(
        quantile=lambda share: np.exp(sigma * ndtri(share)),
        mean=mean,
        sd=sd,
        skewness=skewness,
        kurtosis=kurtosis,
        **shares,
    )


def pair_truth():
    """Return the truth of two correlated uniforms and a normal."""
    first, other, weights = grid_of_two(-0.9, 0.05)
    return mixture(values_at(UNIFORM, first) + values_at(Uniform(-2, 2), other), weights, 0.3)


def sum_of_products(a, b, c, d):
    """Return a sum of two products, which is no product of functions and no sum of them."""
    return a * b + c * d


WIDE = {name: Uniform(0.2, 1.8) for name in "abcd"}


def products_truth():
    """Return the truth of ab + cd: two laws of logarithms, then the law of the sum."""
    log_product = Law.of_sum([np.log(values_at(WIDE[name])) for name in "ab"])
    values = np.exp(log_product.quantile(ndtr(SCORES)))
    law = Law.of_sum([values, values])
    mean, sd, skewness, kurtosis = law.moments(identity)
    square = 1.6**2 / 12
    first = dict.fromkeys(WIDE, square / (2 * ((1 + square) ** 2 - 1)))
    totals = dict.fromkeys(WIDE, first["a"] * (1 + square))
    return Truth(
        quantile=law.quantile,
        mean=mean,
        sd=sd,
        skewness=skewness,
        kurtosis=kurtosis,
        shares=first,
        total_shares=totals,
        error=1e-6,
    )


def saddle_truth():
    """Return the truth of the product of two standard normals."""
    nodes = np.linspace(-8.5, 8.5, 20_001)[1::2]
    weights = np.exp(-(nodes**2) / 2)
    weights /= weights.sum()
    names = ("x0", "x1")
    return Truth(
        quantile=inverse(lambda value: weights @ ndtr(value / abs(nodes)), -80, 80),
        mean=0.0,
        sd=1.0,
        skewness=0.0,
        kurtosis=6.0,
        shares=dict.fromkeys(names, 0.0),
        total_shares=dict.fromkeys(names, 1.0),
        error=1e-6,
    )


def rounded(x0, x1):
    """Return a sum as an instrument with steps of a tenth shows it."""
    return np.round(x0 + x1, 1)


def rounded_truth():
    """Return the truth of the sum of two standard normals in steps of a tenth."""
    steps = np.arange(-170, 171) / 10
    masses = np.diff(ndtr(np.append(steps - 0.05, 17.05) / math.sqrt(2)))
    below = np.cumsum(masses)
    mean = masses @ steps
    return Truth(
        quantile=lambda share: steps[np.searchsorted(below, share)],
        mean=mean,
        sd=math.sqrt(masses @ (steps - mean) ** 2),
        skewness=0.0,
        kurtosis=(masses @ steps**4) / (masses @ steps**2) ** 2 - 3,
    )


HEAVY = {"a": Student(0, 2, 5), "b": Student(0, 1, 5)}


def heavy_truth():
    """Return the truth of a sum of two Student's t of five degrees: the second is integrated exactly."""
    nodes = np.linspace(-8.5, 8.5, 20_001)
    weights = np.exp(-(nodes**2) / 2)
    weights /= weights.sum()
    first = values_at(HEAVY["a"], nodes)
    shares = {"a": 0.8, "b": 0.2}
    return Truth(
        quantile=inverse(lambda value: weights @ stdtr(5, value - first), -1000, 1000),
        mean=0.0,
        sd=5 / math.sqrt(3),
        skewness=0.0,
        kurtosis=6 * 17 / 25,
        shares=shares,
        total_shares=shares,
    )


def gauge_block(standard, comparator, random, systematic, *, alpha, theta, cycle, **drawn):
    """Return the deviation of a gauge block from 50 mm [nm], JCGM 101 9.5: 11 inputs, of which 4 draw 2 quantities."""
    alpha_difference = curved(1e-6, 1e-7, drawn["alpha_width"], drawn["alpha_at"])
    theta_difference = curved(0.05, 0.025, drawn["theta_width"], drawn["theta_at"])
    warm = theta + 0.5 * np.sin(math.pi / 2 * cycle)
    expansion = alpha_difference * warm + alpha * theta_difference
    return standard + comparator + random + systematic - standard * expansion - 50e6


def curved(half, inexact, width, place):
    """Return a number between ± half, whose ends are known to ± `inexact`, from two between −1 and 1."""
    return (half + inexact * width) * place


GAUGE_BLOCK = {
    "standard": Student(50_000_623, 25, 18),
    "comparator": Student(215, 6, 24),
    "random": Student(0, 4, 5),
    "systematic": Student(0, 7, 8),
    "alpha": Uniform(9.5e-6, 13.5e-6),
    "theta": Normal(-0.1, 0.2),
    **dict.fromkeys(("cycle", "alpha_width", "alpha_at", "theta_width", "theta_at"), UNIFORM),
}


def gauge_block_truth():
    """Return the truth of the gauge block: the standard is integrated exactly, the rest by 2²⁰ scrambled points."""
    names = [name for name in GAUGE_BLOCK if name != "standard"]
    scores = sobol_scores(len(names), 17, 8).reshape(-1, len(names))
    others = {name: values_at(GAUGE_BLOCK[name], column) for name, column in zip(names, scores.T, strict=True)}
    # The output is linear in the standard, by whose own scatter the expansion changes by 1e-5 nm.
    centre = gauge_block(standard=50_000_623.0, **others)

    def below(value):
        return float(stdtr(18, (value - centre) / 25).mean())

    variances = [25**2 * 18 / 16, 36 * 24 / 22, 16 * 5 / 3, 49 * 8 / 6]
    length = 50_000_623.0
    alpha_at = (1e-12 + 1e-14 / 3) / 3
    theta_at = (0.05**2 + 0.025**2 / 3) / 3
    variances.append(length**2 * alpha_at * (0.01 + 0.04 + 0.125))
    variances.append(length**2 * theta_at * (11.5e-6**2 + (2e-6) ** 2 / 3))
    variance = sum(variances)
    first = dict(
        zip(("standard", "comparator", "random", "systematic"), np.array(variances[:4]) / variance, strict=True)
    )
    first |= {"alpha_at": (1e-6 * 0.1 * length) ** 2 / 3 / variance}
    first |= {"theta_at": (0.05 * 11.5e-6 * length) ** 2 / 3 / variance}
    return Truth(quantile=inverse(below, 300, 1400), mean=838.0, sd=math.sqrt(variance), shares=first, error=1e-4)
