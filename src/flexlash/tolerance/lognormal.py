"""The lognormal distribution: what is a product of many small influences, or cannot fall below an end."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import exp2, ndtr, ndtri, xlogy

from flexlash.schema.argument_checks import number
from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import require_scale

__all__ = ["Lognormal"]

_WIDEST = 1e6
"""Greatest standard deviation over the distance of the mean from the low end; beyond it tails overflow."""


@dataclass(frozen=True)
class Lognormal:
    """Distribution whose logarithm of the distance from `low` is normal; mean and sd are those of the values.

    Equation: x = low + m/√(1 + c²) · exp(σ Φ⁻¹(p)) with m = mean − low, c = sd/m and σ² = ln(1 + c²)
    Arguments: mean, sd > 0 and low < mean in the unit of the dimension.
    Valid: c up to 10⁶. The median is low + m/√(1 + c²), the geometric standard deviation about it exp(σ).
    Source: definition; Johnson, Kotz and Balakrishnan 1994, chapter 14.

    >>> skewed = Lognormal(mean=2.0, sd=1.0)
    >>> round(float(skewed.location + skewed.scale * skewed.standard(np.array(0.5))) ** 2, 12)
    3.2
    """

    mean: float
    sd: float
    low: float = 0.0

    def __post_init__(self) -> None:
        require_scale(self.mean, self.sd)
        number("low", self.low)
        if not self.low < self.mean:
            raise ValueError(f"low = {self.low:g} must be less than mean = {self.mean:g}")
        if not self._coefficient <= _WIDEST:
            raise ValueError(f"sd = {self.sd:g} must be at most {_WIDEST:g} times mean less low")

    @property
    def _coefficient(self) -> float:
        """Standard deviation over the distance of the mean from the low end."""
        return self.sd / (self.mean - self.low)

    @property
    def _sigma(self) -> float:
        """Standard deviation of the logarithm."""
        return math.sqrt(math.log1p(self._coefficient**2))

    @property
    def shape(self) -> tuple[str | float, ...]:
        """The standard deviation of the logarithm."""
        return ("lognormal", self._sigma)

    @property
    def location(self) -> float:
        """The low end."""
        return self.low

    @property
    def scale(self) -> float:
        """The distance of the median from the low end."""
        return (self.mean - self.low) / math.hypot(1, self._coefficient)

    breaks = ()

    @property
    def expectation(self) -> float:
        """The mean."""
        return self.mean

    @property
    def standard_deviation(self) -> float:
        """The standard deviation."""
        return self.sd

    def standard(self, probability: Array) -> Array:
        """Return quantiles of the lognormal with the median 1."""
        return self.standard_at(ndtri(probability))

    def standard_at(self, score: Array) -> Array:
        """Return the exponentials of the scores, each times the standard deviation of the logarithm."""
        # NumPy's exp may round otherwise at another place of an array; SciPy's functions do not.
        return np.asarray(exp2(self._sigma / math.log(2) * score))

    def probability_below(self, standard: Array) -> Array:
        """Return the probabilities of lesser standard values."""
        return np.asarray(ndtr(xlogy(1 / self._sigma, np.maximum(standard, 0.0))))
