"""What measured parts tell of a process: mean and standard deviation with their intervals, capability, correlation.

sample          values of one dimension of n parts
interval        holds the true figure of the process in 95 of 100 samples
capability      Cp, how often six standard deviations fit between the limits; Cpk, three of them to the nearer limit
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import log_ndtr, ndtri, stdtrit

from flexlash.schema.argument_checks import number, numbers
from flexlash.schema.arrays import Array
from flexlash.schema.variant import FEWEST_PARTS, MeasuredDimension
from flexlash.tolerance.sample_uncertainty import CONFIDENCE, UPPER_SCORE, SampleUncertainty

__all__ = [
    "FEWEST_FOR_SD",
    "Capability",
    "MeasuredCorrelation",
    "SampleStatistics",
    "capability",
    "measured_correlation",
    "normality",
    "sample_statistics",
]

FEWEST_FOR_SD = 2
"""Fewest values that have a standard deviation."""

_FEWEST_FOR_NORMALITY = 5

_FARTHEST = 13.0
"""Statistic up to which the last formula of the p-value was made; it is below 1e-30 there."""

_NORMALITY_P = (
    (0.2, (-13.436, 101.14, -223.73), False),
    (0.34, (-8.318, 42.796, -59.938), False),
    (0.6, (0.9177, -4.279, -1.38), True),
    (math.inf, (1.2937, -5.709, 0.0186), True),
)
"""Where each formula ends, its coefficients, and whether it gives p itself or what p leaves to 1."""


@dataclass(frozen=True, kw_only=True)
class SampleStatistics:
    """Number, mean and standard deviation (n − 1) of measured values with 95 % intervals, in the unit of the values.

    `normality` is the p-value of Anderson and Darling's test: how often a normal process gives values that fit a normal
    distribution no better; None of fewer than five values, or of values that are all equal.
    """

    count: int
    mean: float
    mean_low: float
    mean_high: float
    sd: float
    sd_low: float
    sd_high: float
    normality: float | None


@dataclass(frozen=True, kw_only=True)
class Capability:
    """Cp and Cpk of a process within limits, each with its 95 % interval."""

    cp: float
    cp_low: float
    cp_high: float
    cpk: float
    cpk_low: float
    cpk_high: float


@dataclass(frozen=True, kw_only=True)
class MeasuredCorrelation:
    """Correlation of two dimensions over the parts of which both were measured, with its 95 % interval."""

    count: int
    correlation: float
    low: float
    high: float


def sample_statistics(values: npt.ArrayLike) -> SampleStatistics:
    """Return what a sample tells of the process that made it.

    Equation: x̄ ± t₀.₉₇₅ s/√n; s √((n − 1)/χ²) with χ² at 0.975 and 0.025, both with n − 1 degrees of freedom
    Arguments: at least two finite values of independent parts, in any unit and order.
    Valid: the intervals of a normal process; that of the mean of nearly any other, too, from some thirty values on.
    Source: ISO 16269-4; DIN ISO 22514-2; Montgomery, Introduction to Statistical Quality Control, chapter 4.

    >>> bolt = sample_statistics([9.98, 10.02, 10.00, 10.01, 9.99])
    >>> f"{bolt.mean:.3f} ± {bolt.mean_high - bolt.mean:.4f}, s {bolt.sd:.4f} from {bolt.sd_low:.4f}"
    '10.000 ± 0.0196, s 0.0158 from 0.0095'
    """
    measured = _measured(values)
    count = len(measured)
    mean, sd = _mean_and_sd(measured)
    beyond = float(stdtrit(count - 1, (1 + CONFIDENCE) / 2)) * sd / math.sqrt(count)
    low, high = SampleUncertainty(size=count).sd_ends
    return SampleStatistics(
        count=count,
        mean=mean,
        mean_low=mean - beyond,
        mean_high=mean + beyond,
        sd=sd,
        sd_low=sd * low,
        sd_high=sd * high,
        normality=normality(measured),
    )


def capability(statistics: SampleStatistics, low: float, high: float) -> Capability | None:
    """Return the capability of a sampled process within limits; None where its values do not differ.

    Equation: Cp = (high − low)/(6 s), its interval by that of s; Cpk = min(high − x̄, x̄ − low)/(3 s)
        ± z₀.₉₇₅ √(1/(9 n) + Cpk²/(2 (n − 1)))
    Arguments: limits with low < high in the unit of the values.
    Valid: a normal process. Of samples of 5 to 200 values 94 to 96 of 100 intervals hold the true Cpk.
    Source: Bissell 1990, How reliable is your capability index?; Kushler and Hurley 1992.

    >>> wall = sample_statistics(1.607 + 0.0041 * (59 / 60) ** 0.5 * np.repeat([-1, 1], 30))
    >>> found = capability(wall, 1.58, 1.62)
    >>> f"{found.cpk:.2f} (95 %: {found.cpk_low:.2f} to {found.cpk_high:.2f})"
    '1.06 (95 %: 0.85 to 1.27)'
    """
    low, high = number("low", low), number("high", high)
    if not low < high:
        raise ValueError(f"low = {low:g}: a limit below high = {high:g} is required")
    if statistics.sd == 0:
        return None
    count, sd = statistics.count, statistics.sd
    cp = (high - low) / (6 * sd)
    cpk = min(high - statistics.mean, statistics.mean - low) / (3 * sd)
    beyond = UPPER_SCORE * math.sqrt(1 / (9 * count) + cpk**2 / (2 * (count - 1)))
    return Capability(
        cp=cp,
        cp_low=(high - low) / (6 * statistics.sd_high),
        cp_high=(high - low) / (6 * statistics.sd_low),
        cpk=cpk,
        cpk_low=cpk - beyond,
        cpk_high=cpk + beyond,
    )


def normality(values: npt.ArrayLike) -> float | None:
    """Return the p-value of Anderson and Darling's test of a normal process whose mean and sd are not known.

    Equation: A² = −n − Σ (2i − 1)/n (ln Φ(zᵢ) + ln Φ(−zₙ₊₁₋ᵢ)) over the values in order, z = (x − x̄)/s;
        p of A² (1 + 0.75/n + 2.25/n²) by its four formulas
    Arguments: finite values of independent parts in any unit; None is returned of fewer than five, or of equal ones.
    Valid: p from 1e-30 to 1. Values that a gauge rounds to a few steps fail it although the process is normal.
    Source: D'Agostino and Stephens 1986, Goodness-of-Fit Techniques, table 4.9.

    >>> f"{normality([148, 154, 158, 160, 161, 162, 166, 170, 182, 195, 236]):.4f}"
    '0.0105'
    """
    measured = np.sort(_measured(values))
    mean, sd = _mean_and_sd(measured)
    count = len(measured)
    if count < _FEWEST_FOR_NORMALITY or sd == 0:
        return None
    score = (measured - mean) / sd
    odd = 2 * np.arange(1, count + 1) - 1
    squared = -count - math.fsum((odd * (log_ndtr(score) + log_ndtr(-score[::-1]))).tolist()) / count
    return _normality_p(squared * (1 + 0.75 / count + 2.25 / count**2))


def _normality_p(statistic: float) -> float:
    """Return the share of normal samples with a greater statistic, which was adjusted to their number."""
    adjusted = min(max(statistic, 0.0), _FARTHEST)
    _, (constant, once, twice), is_p = next(formula for formula in _NORMALITY_P if adjusted < formula[0])
    power = math.exp(constant + once * adjusted + twice * adjusted**2)
    return power if is_p else 1 - power


def measured_correlation(
    first: MeasuredDimension, second: MeasuredDimension, *, by_scores: bool
) -> MeasuredCorrelation | None:
    """Return how two dimensions of the parts of one sample scatter together; None where that cannot be told.

    Equation: Pearson's r of the values, or of the normal scores Φ⁻¹((rank − 3/8)/(n + 1/4)); tanh(artanh r
        ± z₀.₉₇₅/√(n − 3))
    Arguments: two dimensions of the same sample; `by_scores` where either is not taken as normal, so that its values
        are no normal scores. Equal values have the mean of their ranks.
    Valid: at least five parts with both dimensions, whose values differ. r of few parts is uncertain: of 20 independent
        ones it lies beyond ± 0.44 once in twenty.
    Source: Fisher 1921; for scores Fisher and Yates 1938 with Blom's positions.

    >>> wall = MeasuredDimension(sample="a", dimension="wall", values=(1.0, 2.0, 3.0, 4.0, 5.0), parts=(2, 3, 4, 5, 6))
    >>> disk = MeasuredDimension(sample="a", dimension="disk", values=(1.1, 2.3, 2.9, 4.2, 4.8), parts=(2, 3, 4, 5, 6))
    >>> f"{measured_correlation(wall, disk, by_scores=False).correlation:.4f}"
    '0.9930'
    """
    ours, theirs = (dict(zip(measured.parts, measured.values, strict=True)) for measured in (first, second))
    both = sorted(ours.keys() & theirs.keys())
    if first.sample != second.sample or len(both) < FEWEST_PARTS:
        return None
    pair = [np.array([of[part] for part in both]) for of in (ours, theirs)]
    if any(values.min() == values.max() for values in pair):
        return None
    count = len(both)
    correlation = _pearson(*(_normal_scores(values) if by_scores else values for values in pair))
    if abs(correlation) == 1:
        return MeasuredCorrelation(count=count, correlation=correlation, low=correlation, high=correlation)
    centre, beyond = math.atanh(correlation), UPPER_SCORE / math.sqrt(count - 3)
    return MeasuredCorrelation(
        count=count, correlation=correlation, low=math.tanh(centre - beyond), high=math.tanh(centre + beyond)
    )


def _measured(values: npt.ArrayLike) -> Array:
    """Return at least two finite values in a row."""
    measured = numbers("values", values)
    if measured.ndim != 1 or len(measured) < FEWEST_FOR_SD:
        raise ValueError(f"values have the shape {measured.shape}: at least {FEWEST_FOR_SD} in a row are required")
    if not np.isfinite(measured).all():
        raise ValueError("values must be finite")
    return measured


def _mean_and_sd(values: Array) -> tuple[float, float]:
    """Return mean and sd (n − 1), which do not depend on the order of the values to the bit."""
    if values.min() == values.max():
        return float(values[0]), 0.0
    mean = math.fsum(values.tolist()) / len(values)
    beyond = values - mean
    # Over the greatest of them, so that no square of a tiny or a huge one is lost.
    greatest = float(np.max(np.abs(beyond)))
    squares = math.fsum(((beyond / greatest) ** 2).tolist())
    return mean, greatest * math.sqrt(squares / (len(values) - 1))


def _normal_scores(values: Array) -> Array:
    """Return the normal score expected of each value's rank; equal values share the mean of their ranks."""
    _, place, times = np.unique(values, return_inverse=True, return_counts=True)
    last = np.cumsum(times)
    rank = (last - (times - 1) / 2)[place]
    return np.asarray(ndtri((rank - 3 / 8) / (len(values) + 1 / 4)))


def _pearson(first: Array, second: Array) -> float:
    """Return Pearson's correlation of values that differ; what rounding adds beyond ± 1 is cut off."""
    (mean, sd), (other_mean, other_sd) = _mean_and_sd(first), _mean_and_sd(second)
    product = math.fsum(((first - mean) / sd * ((second - other_mean) / other_sd)).tolist())
    return min(1.0, max(-1.0, product / (len(first) - 1)))
