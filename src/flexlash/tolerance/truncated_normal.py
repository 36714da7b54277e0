"""The normal distribution cut at one end or both: sorted parts, or tails that no part can have."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import AroundMean, require_order, require_scale

__all__ = ["TruncatedNormal"]

_NARROW = 2.0
"""Width in standard deviations below which the closed form of the moments cancels."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)


@dataclass(frozen=True)
class TruncatedNormal(AroundMean):
    """Normal distribution of this mean and sd, cut at low and high; either may be infinite.

    Equation: with a, b = (low − mean)/sd, (high − mean)/sd, x = mean + sd · Φ⁻¹(Φ(a) + p (Φ(b) − Φ(a)))
    Arguments: mean, sd > 0 and low < high in the unit of the dimension.
    Valid: cuts that leave some of the normal's weight in double precision.
    Source: definition; its moments by the closed form, by 20 Gauss–Legendre nodes where a and b are near.

    >>> one_sided = TruncatedNormal(mean=0.0, sd=1.0, low=0.0, high=math.inf)
    >>> round(one_sided.expectation, 9) == round(math.sqrt(2 / math.pi), 9)
    True
    """

    mean: float
    sd: float
    low: float
    high: float
    breaks = ()

    def __post_init__(self) -> None:
        require_scale(self.mean, self.sd)
        require_order(self.low, self.high, finite=False)
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

    def probability_below(self, standard: Array) -> Array:
        """Return the distribution function of the cut standard normal, from the tail that keeps the digits."""
        first, last = self._cuts
        inside = np.clip(standard, first, last)
        below = ndtr(-first) - ndtr(-inside) if first > 0 else ndtr(inside) - ndtr(first)
        return np.asarray(below / self._mass)


def _narrow_moments(first: float, last: float) -> tuple[float, float]:
    """Return mean and variance of a standard normal cut to a narrow range, where the closed form cancels."""
    middle, half = (first + last) / 2, (last - first) / 2
    offset = half * _NODES
    weight = _WEIGHTS * np.exp(-middle * offset - offset * offset / 2)
    weight = weight / weight.sum()
    shift = float((weight * offset).sum())
    return middle + shift, float((weight * (offset - shift) ** 2).sum())
