"""How a dimension scatters: four distributions, each a standard shape, a location and a scale.

`standard` maps probabilities to the shape without location and scale, so that variants whose tolerances
differ only in size share one array of standard values.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from scipy.special import ndtr, ndtri

from flexlash.schema.argument_checks import number
from flexlash.schema.arrays import Array

__all__ = ["Distribution", "Normal", "Triangular", "TruncatedNormal", "Uniform"]


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
        """Return the standard values at these probabilities."""

    def standard_at(self, score: Array) -> Array:
        """Return the standard values at the probabilities of standard normal scores, exact in both tails."""


def _require_order(low: float, high: float) -> None:
    number("low", low, finite=False)
    number("high", high, finite=False)
    if not low < high:
        raise ValueError(f"low = {low:g} must be less than high = {high:g}")


def _require_finite(low: float, high: float) -> None:
    number("low", low)
    number("high", high)


def _require_normal(mean: float, sd: float) -> None:
    number("mean", mean)
    if not number("sd", sd) > 0:
        raise ValueError(f"sd = {sd:g} must be a finite number greater than 0")


_NARROW = 2.0
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)


def _narrow_moments(first: float, last: float) -> tuple[float, float]:
    """Return mean and variance of a standard normal cut to a narrow range, where the closed form cancels."""
    middle, half = (first + last) / 2, (last - first) / 2
    offset = half * _NODES
    weight = _WEIGHTS * np.exp(-middle * offset - offset * offset / 2)
    weight = weight / weight.sum()
    shift = float((weight * offset).sum())
    return middle + shift, float((weight * (offset - shift) ** 2).sum())


@dataclass(frozen=True)
class Normal:
    """Normal distribution, unbounded.

    >>> Normal(mean=80, sd=0.02).standard(np.array([0.5]))
    array([0.])
    """

    mean: float
    sd: float

    def __post_init__(self) -> None:
        _require_normal(self.mean, self.sd)

    shape = ("normal",)
    breaks = ()

    @property
    def location(self) -> float:
        """The mean."""
        return self.mean

    @property
    def scale(self) -> float:
        """The standard deviation."""
        return self.sd

    @property
    def expectation(self) -> float:
        """The mean."""
        return self.mean

    @property
    def standard_deviation(self) -> float:
        """The standard deviation."""
        return self.sd

    def standard(self, probability: Array) -> Array:
        """Return standard normal quantiles."""
        return np.asarray(ndtri(probability))

    def standard_at(self, score: Array) -> Array:
        """Return the scores themselves."""
        return score


@dataclass(frozen=True)
class TruncatedNormal:
    """Normal distribution of this mean and sd, cut at low and high; either may be infinite."""

    mean: float
    sd: float
    low: float
    high: float
    breaks = ()

    def __post_init__(self) -> None:
        _require_normal(self.mean, self.sd)
        _require_order(self.low, self.high)
        if not self._mass > 0:
            raise ValueError("low and high leave no part of the normal distribution")

    @property
    def _cuts(self) -> tuple[float, float]:
        return (self.low - self.mean) / self.sd, (self.high - self.mean) / self.sd

    @property
    def _mass(self) -> float:
        first, last = self._cuts
        return float(ndtr(-first) - ndtr(-last) if first > 0 else ndtr(last) - ndtr(first))

    @property
    def _moments(self) -> tuple[float, float]:
        """Mean and variance of the standard shape."""
        first, last = self._cuts
        if last - first < _NARROW:
            return _narrow_moments(first, last)
        density = [math.exp(-cut * cut / 2) / math.sqrt(2 * math.pi) for cut in (first, last)]
        weighted = [cut * d if math.isfinite(cut) else 0.0 for cut, d in zip((first, last), density, strict=True)]
        mean = (density[0] - density[1]) / self._mass
        return mean, 1 + (weighted[0] - weighted[1]) / self._mass - mean * mean

    @property
    def shape(self) -> tuple[str | float, ...]:
        """The cuts in units of sd."""
        return ("truncated normal", *self._cuts)

    @property
    def location(self) -> float:
        """The mean before cutting."""
        return self.mean

    @property
    def scale(self) -> float:
        """The standard deviation before cutting."""
        return self.sd

    @property
    def expectation(self) -> float:
        """The mean after cutting."""
        return self.mean + self.sd * self._moments[0]

    @property
    def standard_deviation(self) -> float:
        """The standard deviation after cutting."""
        return self.sd * math.sqrt(self._moments[1])

    def standard(self, probability: Array) -> Array:
        """Return quantiles of the cut standard normal, from the tail that keeps the digits."""
        first, last = self._cuts
        if first > 0:
            inside = -ndtri(ndtr(-first) - probability * self._mass)
        else:
            inside = ndtri(ndtr(first) + probability * self._mass)
        return np.clip(inside, first, last)

    def standard_at(self, score: Array) -> Array:
        """Return quantiles of the cut standard normal, counted from the nearer end."""
        first, last = self._cuts
        mass = self._mass
        from_below = ndtri(ndtr(first) + ndtr(score) * mass)
        from_above = -ndtri(ndtr(-last) + ndtr(-score) * mass)
        return np.clip(np.where(from_below < 0, from_below, from_above), first, last)


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
    """Every value between low and high equally likely."""

    low: float
    high: float

    def __post_init__(self) -> None:
        _require_order(self.low, self.high)
        _require_finite(self.low, self.high)

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


@dataclass(frozen=True)
class Triangular(_Interval):
    """Triangle between low and high with its peak at mode, by default in the middle."""

    low: float
    high: float
    mode: float | None = None

    def __post_init__(self) -> None:
        _require_order(self.low, self.high)
        _require_finite(self.low, self.high)
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
        """The place of the peak as a fraction of the width."""
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
        fraction = self._fraction
        rising = np.sqrt(probability * fraction)
        falling = 1 - np.sqrt((1 - probability) * (1 - fraction))
        return np.where(probability < fraction, rising, falling)

    def standard_at(self, score: Array) -> Array:
        """Return quantiles of the triangle on [0, 1], counted from the nearer end."""
        fraction = self._fraction
        below = ndtr(score)
        rising = np.sqrt(below * fraction)
        falling = 1 - np.sqrt(ndtr(-score) * (1 - fraction))
        return np.where(below < fraction, rising, falling)
