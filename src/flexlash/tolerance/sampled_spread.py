"""The spread of an output from its values at points of the inputs: plain Monte Carlo, or scrambled Sobol' points.

replicate           one of the independent sets of points, whose scatter gives the standard errors
standard value      quantile of a distribution's shape at a point, before location and scale
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.special import ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.capability import clopper_pearson
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.sampled_shares import correlated_sampled_shares, sampled_shares
from flexlash.tolerance.sampling import REPLICATES, UnitPoints, standard_error, widening
from flexlash.tolerance.spread import Spread
from flexlash.tolerance.variance_shares import VarianceShares

__all__ = ["Model", "SampledSpread"]

Model = Callable[..., npt.ArrayLike]

_BLOCK = 8192
"""Points modelled together, so that the model's own arrays stay in the cache."""

_NORMAL_95 = float(ndtri(0.975))
"""Standard errors to both sides of a 95 % interval."""

_COUNTED = 1.5
"""Standard error of a count of points that is the same in each replicate."""

_SCATTER, _MOST_SCATTER = 2.0, 0.5
"""How much further apart than their density says some values may lie by chance: over the root of how many they are."""


class SampledSpread(Spread):
    """The spread of a model's output at points.

    `values` has the shape (replicates, points); quantiles are of type 7 (Excel's PERCENTILE.INC, numpy's default).
    Standard errors of Sobol' points come from the replicates, which are independent of one another; those of
    plain Monte Carlo from the theory of independent draws. Raises ValueError for a model that returns another shape or
    a number that is not finite. `factor` (inputs, inputs) makes the scores of correlated inputs.
    """

    def __init__(
        self,
        *,
        model: Model,
        inputs: Mapping[str, Distribution],
        points: UnitPoints,
        notes: tuple[str, ...] = (),
        factor: Array | None = None,
    ) -> None:
        self._model = model
        self._inputs = inputs
        self._points = points
        self.method = points.method
        self.notes = notes
        self._factor = factor
        self.values = _evaluate(model, points.standards(inputs, factor), inputs)
        self.size = self.values.size

    @cached_property
    def _selected(self) -> Array:
        """The values in one row, put in order only as far as quantiles were asked for."""
        return self.values.flatten()

    @property
    def _independent(self) -> bool:
        return self.method == "random"

    @property
    def _origin(self) -> float:
        return float(self.values[0, 0])

    @cached_property
    def _deviations(self) -> Array:
        """Values less the first one: a model that does not vary has a spread of exactly 0."""
        return self.values - self._origin

    @cached_property
    def mean(self) -> float:
        """Mean of the output."""
        return self._origin + float(self._deviations.mean())

    @cached_property
    def sd(self) -> float:
        """Standard deviation of the output."""
        return float(self._deviations.std())

    @cached_property
    def mean_standard_error(self) -> float:
        """Standard error of the mean."""
        if self._independent:
            return self.sd / math.sqrt(self.size)
        return float(standard_error(self._deviations.mean(axis=1)))

    @cached_property
    def sd_standard_error(self) -> float:
        """Standard error of the standard deviation."""
        if self._independent:
            return self.sd * math.sqrt(max(self._moment(4) - 1, 0.0) / (4 * self.size))
        if self.values.shape[1] == 1:
            return self.sd
        return float(standard_error(self._deviations.std(axis=1)))

    @cached_property
    def skewness(self) -> float:
        """Third central moment over the cube of the standard deviation."""
        return self._moment(3)

    @cached_property
    def skewness_standard_error(self) -> float:
        """Standard error of the skewness."""
        if self.sd == 0:
            return 0.0
        deviation = (self.values - self.mean) / self.sd
        # The skewness moves with mean and sd as well as with the third moment.
        squares = deviation * deviation
        return self._mean_error(squares * deviation - 3 * deviation - 1.5 * self.skewness * squares)

    @cached_property
    def kurtosis(self) -> float:
        """Fourth central moment over the fourth power of the standard deviation, less 3."""
        return self._moment(4) - 3 if self.sd > 0 else 0.0

    @cached_property
    def kurtosis_standard_error(self) -> float:
        """Standard error of the kurtosis."""
        if self.sd == 0:
            return 0.0
        deviation = (self.values - self.mean) / self.sd
        squares = deviation * deviation
        # The kurtosis moves with mean and sd as well as with the fourth moment.
        moves = squares * squares - 4 * self.skewness * deviation - 2 * self._moment(4) * squares
        return self._mean_error(moves)

    def _mean_error(self, values: Array) -> float:
        """Return the standard error of the mean of one number a point."""
        if self._independent:
            return float(values.std()) / math.sqrt(self.size)
        return float(standard_error(values.mean(axis=1)))

    def _moment(self, power: int) -> float:
        """Return a central moment in standard deviations; 0 where nothing varies."""
        if self.sd == 0:
            return 0.0
        deviation = (self.values - self.mean) / self.sd
        product = deviation * deviation
        for _ in range(power - 2):
            product *= deviation
        return float(product.mean())

    def _quantiles(self, probability: Array) -> Array:
        rank = probability * (self.size - 1)
        below = np.floor(rank).astype(int)
        above = np.minimum(below + 1, self.size - 1)
        self._selected.partition(np.unique(np.concatenate([below, above])))
        low, high = self._selected[below], self._selected[above]
        return np.asarray(low + (high - low) * (rank - below))

    def _quantile_errors(self, probability: Array) -> Array:
        """Return the standard errors of quantiles: that of the probability below over the density, more at a gap.

        Equation: e/f; where values at the probabilities p ± z e lie much further apart than f says, the greater of
            their distances over z, so that ± 1.96 of it holds both (Woodruff's interval)
        Arguments: p (n,), e the standard error of the share of values below the quantile, f the density around it.
        Valid: any output, also one with gaps or few values; some points in all beyond the quantile.
        Source: Woodruff 1952.
        """
        quantiles = self._quantiles(probability)
        error = np.maximum(self._share_errors(probability, quantiles), 0.5 / self.size)
        reach = np.maximum(0.5 * np.minimum(probability, 1 - probability), error)
        low, high = np.maximum(probability - reach, 0.0), np.minimum(probability + reach, 1.0)
        inside = error * (self._quantiles(high) - self._quantiles(low)) / (high - low)
        side = self._farther_side(probability, quantiles, _NORMAL_95 * error) / _NORMAL_95
        alike = np.array([np.count_nonzero(self._selected == quantile) > 1 for quantile in quantiles])
        by_chance = np.minimum(_SCATTER / np.sqrt(_NORMAL_95 * error * self.size), _MOST_SCATTER)
        inside = np.where(side > (1 + np.where(alike, 0.0, by_chance)) * inside, side, inside)
        # A quantile rarer than one point in all lies beyond the points, by a normal tail as far as this.
        rarer = np.clip(np.minimum(probability, 1 - probability), np.finfo(float).tiny, 0.5)
        beyond = np.maximum(ndtri(min(1 / self.size, 0.5)) - ndtri(rarer), 0.0)
        return np.asarray(inside + beyond * self.sd)

    def _share_errors(self, probability: Array, quantiles: Array) -> Array:
        """Return the standard errors of the shares of values below quantiles."""
        if self._independent:
            return np.asarray(np.sqrt(probability * (1 - probability) / self.size))
        # Where many values are alike the share jumps at the quantile, and is known less well on one side.
        shares = [
            [(self.values <= quantile).mean(axis=1), (self.values < quantile).mean(axis=1)] for quantile in quantiles
        ]
        both = standard_error(np.reshape(shares, (len(quantiles), 2, len(self.values))))
        return np.asarray(both.max(axis=1))

    def _farther_side(self, probability: Array, quantiles: Array, reach: Array) -> Array:
        """Return how far the values at these probabilities ∓ reach are from the quantiles, the farther of the two."""
        last = self.size - 1
        low = np.floor(np.maximum(probability - reach, 0.0) * last).astype(int)
        high = np.ceil(np.minimum(probability + reach, 1.0) * last).astype(int)
        self._selected.partition(np.unique(np.concatenate([low, high])))
        return np.asarray(np.maximum(quantiles - self._selected[low], self._selected[high] - quantiles))

    def _probabilities_above(self, value: Array) -> Array:
        return np.array([self._count_above(limit) for limit in value]) / self.size

    def _count_above(self, value: float) -> int:
        return int(np.count_nonzero(self._selected > value))

    def _interval(self, value: float, confidence: float) -> tuple[float, float]:
        """Return the interval of Clopper and Pearson of so many independent points as know the probability as well.

        Equation: n* = p(1 − p)/(e² + (1.5/n)²), at least n; p n* of them lie above the value
        Valid: e the standard error from the replicates, which may come out as nothing where each has the same count:
            so many alike leave 3 of all n points open, with 95 % confidence.
        Source: Clopper and Pearson 1934; effective sample sizes of survey statistics (Korn and Graubard 1998).
        """
        above = (self.values > value).mean(axis=1)
        share = float(above.mean())
        if self._independent or share in {0.0, 1.0}:
            return clopper_pearson(self._count_above(value), self.size, confidence)
        error = float(standard_error(above)) * max(widening(REPLICATES, confidence) / widening(REPLICATES), 1.0)
        effective = max(share * (1 - share) / (error**2 + (_COUNTED / self.size) ** 2), self.size)
        return clopper_pearson(share * effective, effective, confidence)

    @cached_property
    def variance_shares(self) -> VarianceShares:
        """First-order and total Sobol' indices with their standard errors."""

        def outputs(standard: Mapping[str, Array]) -> Array:
            return _evaluate(self._model, standard, self._inputs)

        if self._factor is not None:
            return correlated_sampled_shares(outputs, self._inputs, self._factor, self._points, self.values)
        return sampled_shares(outputs, self._inputs, self._points, self.values)


def _evaluate(model: Model, standard: Mapping[str, Array], inputs: Mapping[str, Distribution]) -> Array:
    """Return the model at standard values of shape (replicates, points), in blocks that fit the cache."""
    shape = next(iter(standard.values())).shape
    flat = {name: column.ravel() for name, column in standard.items()}
    output = np.empty(shape[0] * shape[1])
    for start in range(0, output.size, _BLOCK):
        block = slice(start, start + _BLOCK)
        arguments = {name: inputs[name].location + inputs[name].scale * column[block] for name, column in flat.items()}
        values = np.asarray(model(**arguments), dtype=float)
        if values.shape != output[block].shape:
            raise ValueError(f"the model returned shape {values.shape}, not that of its inputs")
        output[block] = values
    if not np.isfinite(output).all():
        raise ValueError("the model returned a number that is not finite within the range of its inputs")
    return output.reshape(shape)
