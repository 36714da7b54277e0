"""How a dimension scatters: distributions, each a standard shape, a location and a scale.

    location, scale     value = location + scale × standard value
    standard value      quantile of the shape alone, so that variants whose tolerances differ only in size share one
                        array of standard values
    score               quantile of the standard normal with the same probability: Φ(score) = probability
    break               score at which the standard value has a kink

The normal cut at both ends is in `truncated_normal`; others have modules of their own: `lognormal`, `student`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from scipy.special import ndtr, ndtri

from flexlash.schema.argument_checks import number
from flexlash.schema.arrays import Array

__all__ = ["AroundMean", "Distribution", "Normal", "Triangular", "Uniform", "require_order", "require_scale"]


@runtime_checkable
class Distribution(Protocol):
    """What the sampler asks of a distribution."""

    @property
    def shape(self) -> tuple[str | float, ...]:
        """A key that is equal for distributions with the same standard values."""

    @property
    def location(self) -> float:
        """What is added to the scaled standard value."""

    @property
    def scale(self) -> float:
        """What the standard value is multiplied by."""

    @property
    def breaks(self) -> tuple[float, ...]:
        """The standard normal scores at which the standard value has a kink."""

    @property
    def expectation(self) -> float:
        """Mean of the distribution."""

    @property
    def standard_deviation(self) -> float:
        """Standard deviation of the distribution."""

    def standard(self, probability: Array) -> Array:
        """Return the standard values at these probabilities, in their shape."""

    def standard_at(self, score: Array) -> Array:
        """Return the standard values at the probabilities of standard normal scores, exact in both tails."""

    def probability_below(self, standard: Array) -> Array:
        """Return the distribution function at standard values; 0 and 1 beyond the ends."""


def require_order(low: float, high: float, *, finite: bool = True) -> None:
    """Raise TypeError or ValueError unless both are numbers and low is less than high."""
    number("low", low, finite=False)
    number("high", high, finite=False)
    if not low < high:
        raise ValueError(f"low = {low:g} must be less than high = {high:g}")
    number("low", low, finite=finite)
    number("high", high, finite=finite)


def require_scale(mean: float, sd: float) -> None:
    """Raise TypeError or ValueError unless the mean is a finite number and sd one greater than 0."""
    number("mean", mean)
    if not number("sd", sd) > 0:
        raise ValueError(f"sd = {sd:g} must be a finite number greater than 0")


class AroundMean:
    """What distributions around the mean of a normal share: it and its sd are location and scale."""

    mean: float
    sd: float

    @property
    def location(self) -> float:
        """The mean, before any cut."""
        return self.mean

    @property
    def scale(self) -> float:
        """The standard deviation, before any cut."""
        return self.sd

    @property
    def expectation(self) -> float:
        """The mean."""
        return self.mean

    @property
    def standard_deviation(self) -> float:
        """The standard deviation."""
        return self.sd


@dataclass(frozen=True)
class Normal(AroundMean):
    """Normal distribution, unbounded.

    Equation: x = mean + sd · Φ⁻¹(p)
    Arguments: mean and sd > 0 in the unit of the dimension.
    Valid: any finite mean and sd.
    Source: definition.

    >>> Normal(mean=80, sd=0.02).standard(np.array([0.5]))
    array([0.])
    """

    mean: float
    sd: float

    def __post_init__(self) -> None:
        require_scale(self.mean, self.sd)

    shape = ("normal",)
    breaks = ()

    def standard(self, probability: Array) -> Array:
        """Return standard normal quantiles."""
        return np.asarray(ndtri(probability))

    def standard_at(self, score: Array) -> Array:
        """Return the scores themselves."""
        return score

    def probability_below(self, standard: Array) -> Array:
        """Return the normal distribution function."""
        return np.asarray(ndtr(standard))


class _Interval:
    """What distributions between two finite ends share."""

    low: float
    high: float

    @property
    def location(self) -> float:
        """The lower limit."""
        return self.low

    @property
    def scale(self) -> float:
        """The width."""
        return self.high - self.low


@dataclass(frozen=True)
class Uniform(_Interval):
    """Every value between low and high equally likely.

    Equation: x = low + (high − low) p
    Arguments: low < high in the unit of the dimension.
    Valid: any finite ends.
    Source: definition.

    >>> Uniform(low=1.0, high=3.0).expectation
    2.0
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        require_order(self.low, self.high)

    shape = ("uniform",)
    breaks = ()

    @property
    def expectation(self) -> float:
        """The middle."""
        return (self.low + self.high) / 2

    @property
    def standard_deviation(self) -> float:
        """The width over √12."""
        return self.scale / math.sqrt(12)

    def standard(self, probability: Array) -> Array:
        """Return the probabilities themselves."""
        return probability

    def standard_at(self, score: Array) -> Array:
        """Return the probabilities of the scores."""
        return np.asarray(ndtr(score))

    def probability_below(self, standard: Array) -> Array:
        """Return the standard values themselves, between 0 and 1."""
        return np.clip(standard, 0.0, 1.0)


@dataclass(frozen=True)
class Triangular(_Interval):
    """Triangle between low and high with its peak at mode, by default in the middle.

    Equation: with f = (mode − low)/(high − low), the standard value is √(p f) for p < f, else 1 − √((1 − p)(1 − f))
    Arguments: low < high and low ≤ mode ≤ high in the unit of the dimension.
    Valid: any finite ends.
    Source: definition.

    >>> Triangular(low=0.0, high=4.0, mode=1.0).standard(np.array([0.25]))
    array([0.25])
    """

    low: float
    high: float
    mode: float | None = None

    def __post_init__(self) -> None:
        require_order(self.low, self.high)
        if self.mode is not None:
            number("mode", self.mode)
        if not self.low <= self._peak <= self.high:
            raise ValueError(f"mode = {self._peak:g} must lie between low = {self.low:g} and high = {self.high:g}")

    @property
    def _peak(self) -> float:
        return (self.low + self.high) / 2 if self.mode is None else self.mode

    @property
    def _fraction(self) -> float:
        return 0.5 if self.mode is None else (self.mode - self.low) / (self.high - self.low)

    @property
    def shape(self) -> tuple[str | float, ...]:
        """The position of the peak as a fraction of the width."""
        return ("triangular", self._fraction)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The score of the peak, unless it is at an end."""
        return (float(ndtri(self._fraction)),) if 0 < self._fraction < 1 else ()

    @property
    def expectation(self) -> float:
        """The mean of the three corners."""
        return (self.low + self.high + self._peak) / 3

    @property
    def standard_deviation(self) -> float:
        """√((w² + a² + b²)/36) with width w and the distances a, b of the peak from both ends."""
        low, high, peak = self.low, self.high, self._peak
        return math.sqrt(((high - low) ** 2 + (peak - low) ** 2 + (high - peak) ** 2) / 36)

    def standard(self, probability: Array) -> Array:
        """Return quantiles of the triangle on [0, 1]."""
        return self._quantiles(probability, 1 - probability)

    def standard_at(self, score: Array) -> Array:
        """Return quantiles of the triangle on [0, 1], counted from the nearer end."""
        return self._quantiles(ndtr(score), ndtr(-score))

    def probability_below(self, standard: Array) -> Array:
        """Return the areas of the triangle on [0, 1] below standard values."""
        fraction, inside = self._fraction, np.clip(standard, 0.0, 1.0)
        rising, falling = inside * inside / (fraction or 1.0), (1 - inside) ** 2 / ((1 - fraction) or 1.0)
        return np.where(inside < fraction, rising, 1 - falling)

    def _quantiles(self, below: Array, above: Array) -> Array:
        """Return quantiles of the triangle on [0, 1] from the probabilities below and above them."""
        fraction = self._fraction
        return np.where(below < fraction, np.sqrt(below * fraction), 1 - np.sqrt(above * (1 - fraction)))
