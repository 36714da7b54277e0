"""Several uncertain parameters of one output: the interval that all of them together leave of a number.

parameter       what is not quite known: a mean, a standard deviation, a correlation of inputs
move            a parameter less its estimate, in a measure of its own
ends            the numbers of the output with one parameter at an end of its interval, the others as estimated
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.digital_nets import scrambled_net
from flexlash.tolerance.sample_uncertainty import CONFIDENCE

__all__ = ["OutputNumbers", "Parameter", "Product", "percentile_interval", "probability_interval", "standard_scores"]

_DRAWS = 1 << 13
"""Sets of parameters: the ends of an interval are then known to a hundredth of its width."""

_FARTHEST = 7.5
"""Greatest normal score; a probability beyond it counts as 0 or 1."""

_LEAST_SQUARE = 1e-6
"""Least square of the output's standard deviation over that with all parameters as estimated."""


@dataclass(frozen=True, kw_only=True)
class OutputNumbers:
    """Numbers of an output, in its unit: its mean, its standard deviation, a percentile, and what exceeds its limit."""

    mean: float
    sd: float
    percentile: float
    probability: float | None = None

    @property
    def is_known(self) -> bool:
        """Whether all of them are numbers: impossible shapes have none."""
        return all(map(math.isfinite, (self.mean, self.sd, self.percentile, self.probability or 0.0)))

    @property
    def score(self) -> float:
        """Normal score of what stays below the limit, within what counts as neither none nor all."""
        return min(max(-float(ndtri(self.probability or 0.0)), -_FARTHEST), _FARTHEST)


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One parameter: `moves` of it in as many sets as the others, `low` < 0 < `high` its ends, the output at each.

    What `scatters` is a standard deviation's square or a correlation, in which the variance of a sum is linear; what
    does not shifts the output.
    """

    moves: Array
    low: float
    high: float
    at_low: OutputNumbers
    at_high: OutputNumbers
    scatters: bool

    def between(self, low: float, high: float) -> Array:
        """Return what moves make, by straight lines from none through what the ends make."""
        return np.where(self.moves < 0, self.moves * (low / self.low), self.moves * (high / self.high))


@dataclass(frozen=True, kw_only=True)
class Product:
    """Two inputs whose covariance has a part in the output: their standard deviations and their correlation.

    All three are among the parameters; `correlation` is the one of which `estimate` is the value as estimated.
    """

    first: Parameter
    second: Parameter
    correlation: Parameter
    estimate: float


@lru_cache(maxsize=32)
def standard_scores(count: int) -> Array:
    """Return evenly spread standard normal scores, (count, sets); the same whenever they are asked for."""
    scores = ndtri(scrambled_net(count, 1, _DRAWS, np.random.default_rng(0))[:, 0])
    scores.setflags(write=False)
    return np.asarray(scores)


def probability_interval(
    output: OutputNumbers, parameters: Sequence[Parameter], products: Sequence[Product] = ()
) -> tuple[float, float]:
    """Return the ends of the interval of the probability above a limit that parameters leave.

    Equation: z = (z₀ + Σ δᵢ) T + Σ εⱼ over many sets of parameters, T = 1/√(1 + Σ rⱼ); δᵢ the change of the score z by
        a shift alone, rⱼ that of the variance by a scatter alone or by a covariance, εⱼ what that changes z beside T.
        Ends: P = Φ(−z) at the 2.5 % and 97.5 % quantiles of z.
    Arguments: the output with parameters as estimated, and with each at its ends; products of them, none for inputs
        that are independent or whose correlation is known.
    Valid: exact (noncentral t) for one sample of a normal process and an output that is linear in it; with several, and
        beside what is known, the sum of normals is the model of how they act together. A probability that cannot be
        told from 0 or 1 is 0 or 1.
    Source: Weerahandi 1993 (generalised confidence intervals); Hannig 2009 (fiducial inference).
    """
    score = output.score
    shift = np.zeros(_DRAWS)
    for one in _shifts(parameters):
        shift += one.between(one.at_low.score - score, one.at_high.score - score)
    scale, bent = _scale(output, parameters, products), np.zeros(_DRAWS)
    for one in _scatters(parameters):
        low, high = (end.score - score / math.sqrt(_square(output, end)) for end in (one.at_low, one.at_high))
        bent += one.between(low, high)
    ends = _ends(np.asarray((score + shift) / scale + bent))
    low, high = (_probability(end) for end in reversed(ends))
    return low, high


def percentile_interval(
    output: OutputNumbers, parameters: Sequence[Parameter], products: Sequence[Product] = ()
) -> tuple[float, float]:
    """Return the ends of the interval of a percentile that parameters leave, in the unit of the output.

    Equation: q = q₀ + Σ δᵢ + (q₀ − m₀)(√(1 + Σ rⱼ) − 1) + Σ εⱼ, as for a probability; m₀ the mean
    Arguments: as for a probability.
    Valid: as for a probability.
    Source: as for a probability.
    """
    found, reach = output.percentile, output.percentile - output.mean
    total = reach * (_scale(output, parameters, products) - 1)
    for one in _shifts(parameters):
        total += one.between(one.at_low.percentile - found, one.at_high.percentile - found)
    for one in _scatters(parameters):
        low, high = (
            end.percentile - found - reach * (math.sqrt(_square(output, end)) - 1) for end in (one.at_low, one.at_high)
        )
        total += one.between(low, high)
    low, high = _ends(found + total)
    return low, high


def _shifts(parameters: Sequence[Parameter]) -> list[Parameter]:
    return [one for one in parameters if not one.scatters]


def _scatters(parameters: Sequence[Parameter]) -> list[Parameter]:
    return [one for one in parameters if one.scatters]


def _square(output: OutputNumbers, end: OutputNumbers) -> float:
    """Return the variance of the output over that with all parameters as estimated."""
    return max((end.sd / output.sd) ** 2, _LEAST_SQUARE)


def _scale(output: OutputNumbers, parameters: Sequence[Parameter], products: Sequence[Product]) -> Array:
    """Return the output's standard deviation over that with all parameters as estimated, for each set."""
    square = np.ones(_DRAWS)
    for one in _scatters(parameters):
        square += one.between(_square(output, one.at_low) - 1, _square(output, one.at_high) - 1)
    for product in products:
        square += _beyond_sum(output, product)
    return np.sqrt(np.maximum(square, _LEAST_SQUARE))


def _beyond_sum(output: OutputNumbers, product: Product) -> Array:
    """Return what a covariance does to the variance beside the sum of what its three factors do one at a time.

    Equation: c (k₁ k₂ t − (k₁ − 1) − (k₂ − 1) − (t − 1) − 1), kᵢ the standard deviations over those estimated, t the
        correlation likewise, c the covariance's part of the variance
    """
    one, correlation = product.estimate, product.correlation
    rise = _square(output, correlation.at_high) - _square(output, correlation.at_low)
    part = rise / (correlation.high - correlation.low) * one
    first, second = (np.sqrt(np.maximum(1 + sd.moves, 0.0)) for sd in (product.first, product.second))
    turned = 1 + correlation.moves / one
    return np.asarray(part * (first * second * turned - first - second - turned + 2))


def _ends(values: Array) -> tuple[float, float]:
    """Return the quantiles that leave out as much at either end as the confidence says."""
    tail = (1 - CONFIDENCE) / 2
    low, high = np.quantile(values, [tail, 1 - tail]).tolist()
    return low, high


def _probability(score: float) -> float:
    """Return the probability above a score, 0 or 1 where that is too far to tell."""
    return float(score < 0) if abs(score) >= _FARTHEST else float(ndtr(-score))
