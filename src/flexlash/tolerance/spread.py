"""The spread of an output: its whole distribution, of which any statistic can be asked.

    spread              the distribution of a model's output that follows from the distributions of its inputs
    statistic           one number of it: mean, sd, skewness, kurtosis, a quantile, a probability above a value
    share               of variance: the Sobol' index of an input, first-order or total
    standard error      how well a statistic is known; ± 1.96 of them are its 95 % interval
    lot                 parts that share the values of some inputs: `lots`

By lines it is a `LineSpread`, by points a `SampledSpread`; `SpreadStatistics` are what a report keeps of it.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Literal, overload

import numpy as np
import numpy.typing as npt

from flexlash.schema.argument_checks import number, numbers, whole_number
from flexlash.schema.arrays import Array
from flexlash.tolerance.lots import AllParts, Lots
from flexlash.tolerance.variance_shares import VarianceShares

__all__ = ["Method", "Spread"]

Method = Literal["line", "sobol", "random"]

_MILLION = 1e6

_ONE_ERROR = 0.6826894921370859
"""Confidence of an interval that reaches one standard error to both sides of a normal estimate."""


class Spread(ABC):
    """The spread of a model's output.

    `method` is the one that answered, `notes` say why another was not taken, `size` counts the lines or points.
    A number ± 1.96 of its standard errors is its 95 % interval: errors that come from independent replicates are
    widened for their small number, as Student's t asks. `lots` says how lots and parts divide the spread; without
    more ado every part draws all inputs.
    """

    method: Method
    notes: tuple[str, ...]
    size: int
    lots: Lots = AllParts()

    @property
    @abstractmethod
    def mean(self) -> float:
        """Mean of the output."""

    @property
    @abstractmethod
    def mean_standard_error(self) -> float:
        """Standard error of the mean."""

    @property
    @abstractmethod
    def sd(self) -> float:
        """Standard deviation of the output."""

    @property
    @abstractmethod
    def sd_standard_error(self) -> float:
        """Standard error of the standard deviation."""

    @property
    @abstractmethod
    def skewness(self) -> float:
        """Third central moment over the cube of the standard deviation."""

    @property
    @abstractmethod
    def skewness_standard_error(self) -> float:
        """Standard error of the skewness."""

    @property
    @abstractmethod
    def kurtosis(self) -> float:
        """Fourth central moment over the fourth power of the standard deviation, less 3: 0 for a normal."""

    @property
    @abstractmethod
    def kurtosis_standard_error(self) -> float:
        """Standard error of the kurtosis."""

    @property
    def shares(self) -> dict[str, float]:
        """First-order Sobol' index of each input: the share of variance it causes by itself.

        Correlated inputs share out the index of their cluster, by Shapley's value (`correlated_shares`).
        """
        return self.variance_shares.first

    @property
    def shares_standard_error(self) -> dict[str, float]:
        """Standard errors of `shares`."""
        return self.variance_shares.first_error

    @property
    def total_shares(self) -> dict[str, float]:
        """Total Sobol' index of each input: the share of variance it has any part in; as `shares` where correlated."""
        return self.variance_shares.total

    @property
    def total_shares_standard_error(self) -> dict[str, float]:
        """Standard errors of `total_shares`."""
        return self.variance_shares.total_error

    @property
    @abstractmethod
    def variance_shares(self) -> VarianceShares:
        """First-order and total Sobol' indices with their standard errors."""

    def divide(self, lots: Lots, notes: tuple[str, ...] = ()) -> None:
        """Take over how lots and parts divide the spread, and what is to be said of that."""
        self.lots = lots
        self.notes += notes

    @property
    def within_lot_sd(self) -> float:
        """Standard deviation of the parts within a lot: the root of the mean variance over lots."""
        return self.lots.division.within * self.sd

    @property
    def within_lot_sd_standard_error(self) -> float:
        """Standard error of the standard deviation within a lot."""
        division = self.lots.division
        return math.hypot(division.within * self.sd_standard_error, division.within_error * self.sd)

    @property
    def between_lots_sd(self) -> float:
        """Standard deviation of the lots' means."""
        return self.lots.division.between * self.sd

    @property
    def between_lots_sd_standard_error(self) -> float:
        """Standard error of the standard deviation of the lots' means."""
        division = self.lots.division
        return math.hypot(division.between * self.sd_standard_error, division.between_error * self.sd)

    def lots_failing(self, limit: float, ppm: float) -> float:
        """Return the share of lots in which more than so many parts in a million are greater than a limit.

        Raises TypeError or ValueError for a limit that is no number, or ppm that are none between 0 and a million.
        """
        return self._failing(limit, ppm)[0]

    def lots_failing_standard_error(self, limit: float, ppm: float) -> float:
        """Return the standard error of the share of lots that fail."""
        return self._failing(limit, ppm)[1]

    def _failing(self, limit: float, ppm: float) -> tuple[float, float]:
        number("limit", limit)
        acceptable = float(numbers("ppm", number("ppm", ppm), least=0, most=_MILLION)) / _MILLION
        return self.lots.failing(float(limit), acceptable, self._over)

    def _over(self, limit: float) -> tuple[float, float]:
        """Return the probability above a limit, and its standard error."""
        low, high = self._interval(limit, _ONE_ERROR)
        return self.probability_above(limit), (high - low) / 2

    @overload
    def quantile(self, probability: float) -> float: ...
    @overload
    def quantile(self, probability: npt.ArrayLike) -> Any: ...
    def quantile(self, probability: npt.ArrayLike) -> Any:
        """Return the values that the output stays below with these probabilities; scalar in, scalar out.

        Raises TypeError or ValueError for a probability that is no number between 0 and 1.
        """
        return _shaped(self._quantiles, numbers("probability", probability, least=0, most=1))

    @overload
    def standard_error(self, probability: float) -> float: ...
    @overload
    def standard_error(self, probability: npt.ArrayLike) -> Any: ...
    def standard_error(self, probability: npt.ArrayLike) -> Any:
        """Return the standard errors of the quantiles at these probabilities; scalar in, scalar out."""
        return _shaped(self._quantile_errors, numbers("probability", probability, least=0, most=1))

    @overload
    def probability_above(self, value: float) -> float: ...
    @overload
    def probability_above(self, value: npt.ArrayLike) -> Any: ...
    def probability_above(self, value: npt.ArrayLike) -> Any:
        """Return the probability that the output is greater than a value; scalar in, scalar out."""
        return _shaped(self._probabilities_above, numbers("value", value))

    def probability_interval(self, value: float, confidence: float = 0.95) -> tuple[float, float]:
        """Return the ends of an interval that holds the probability above a value with this confidence."""
        level = number("confidence", confidence)
        if not 0 < level < 1:
            raise ValueError(f"confidence = {confidence!r}: a number between 0 and 1 is required")
        return self._interval(number("value", value, finite=False), level)

    def histogram(self, bins: int = 40, cut: float = 0.0005) -> tuple[Array, Array]:
        """Return the edges (bins + 1,) between the quantiles at cut and 1 − cut, and the probability of each bin."""
        whole_number("bins", bins, least=1)
        edges = np.linspace(self.quantile(cut), self.quantile(1 - cut), bins + 1)
        return edges, -np.diff(self._probabilities_above(edges))

    @abstractmethod
    def _interval(self, value: float, confidence: float) -> tuple[float, float]: ...

    @abstractmethod
    def _quantiles(self, probability: Array) -> Array: ...

    @abstractmethod
    def _quantile_errors(self, probability: Array) -> Array: ...

    @abstractmethod
    def _probabilities_above(self, value: Array) -> Array: ...


def _shaped(function: Callable[[Array], Array], arguments: Array) -> Any:
    """Return a function of a row of numbers at an array of any shape, in that shape; a float for a scalar."""
    if not arguments.size:
        return np.empty(arguments.shape)
    values = function(arguments.ravel())
    return float(values[0]) if arguments.ndim == 0 else values.reshape(arguments.shape)
