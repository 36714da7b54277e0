"""A distribution's shape about another mean and with another standard deviation."""

from __future__ import annotations

from dataclasses import dataclass

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import AroundMean, Distribution, require_scale

__all__ = ["Placed"]


@dataclass(frozen=True)
class Placed(AroundMean):
    """Distribution with the shape of another one, and this mean and sd.

    Equation: x = mean + sd · q(p), q the standard values of the other
    Arguments: another distribution whose location and scale are its mean and sd, such as a measured one; mean and
        sd > 0 in the unit of the dimension.
    Valid: any finite mean and sd.
    Source: definition.

    >>> from flexlash.tolerance.measured import Measured
    >>> placed = Placed(Measured([1.61, 1.60, 1.62, 1.60, 1.59, 1.63]), mean=3.2, sd=0.01)
    >>> placed.expectation, placed.standard_deviation
    (3.2, 0.01)
    """

    of: Distribution
    mean: float
    sd: float

    def __post_init__(self) -> None:
        require_scale(self.mean, self.sd)

    @property
    def shape(self) -> tuple[str | float, ...]:
        """That of the other distribution."""
        return self.of.shape

    @property
    def breaks(self) -> tuple[float, ...]:
        """Those of the other distribution."""
        return self.of.breaks

    def standard(self, probability: Array) -> Array:
        """Return quantiles of the shape."""
        return self.of.standard(probability)

    def standard_at(self, score: Array) -> Array:
        """Return quantiles of the shape at the probabilities of scores."""
        return self.of.standard_at(score)

    def probability_below(self, standard: Array) -> Array:
        """Return the distribution function of the shape."""
        return self.of.probability_below(standard)
