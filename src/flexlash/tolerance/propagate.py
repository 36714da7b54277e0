"""Any model, any independent inputs: their Monte Carlo spread with honest standard errors."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any, Literal, get_args, overload

import numpy as np
import numpy.typing as npt

from flexlash.arrays import Array
from flexlash.tolerance.capability import clopper_pearson
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.sampling import REPLICATES, UnitPoints

__all__ = ["Method", "Spread", "propagate"]

Model = Callable[..., npt.ArrayLike]
Method = Literal["line", "sobol", "random"]

_BLOCK = 8192


class Spread:
    """The spread of a model's output: what every statistic is read from.

    `values` has the shape (replicates, points). Standard errors come from the replicates, which are
    independent of one another; quantiles are of type 7 (Excel's PERCENTILE.INC, numpy's default).
    """

    def __init__(
        self,
        *,
        model: Model,
        inputs: Mapping[str, Distribution],
        points: UnitPoints,
        notes: tuple[str, ...] = (),
    ) -> None:
        self._model = model
        self._inputs = inputs
        self._points = points
        self.method = points.method
        self.notes = notes
        self.values = _evaluate(model, {name: points.standard(name, inputs[name]) for name in inputs}, inputs)
        self.size = self.values.size

    @cached_property
    def _ordered(self) -> Array:
        return np.sort(self.values, axis=None)

    @property
    def _origin(self) -> float:
        return float(self.values[0, 0])

    @property
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

    @property
    def mean_standard_error(self) -> float:
        """Standard error of the mean."""
        return _standard_error(self._deviations.mean(axis=1))

    @property
    def sd_standard_error(self) -> float:
        """Standard error of the standard deviation."""
        if self.values.shape[1] == 1:
            return self.sd
        return _standard_error(self._deviations.std(axis=1))

    @cached_property
    def skewness(self) -> float:
        """Third central moment over the cube of the standard deviation."""
        if self.sd == 0:
            return 0.0
        deviation = (self.values - self.mean) / self.sd
        return float((deviation * deviation * deviation).mean())

    @overload
    def quantile(self, probability: float) -> float: ...
    @overload
    def quantile(self, probability: npt.ArrayLike) -> Any: ...
    def quantile(self, probability: npt.ArrayLike) -> Any:
        """Return the values that this share of the output stays below; scalar in, scalar out."""
        wanted = np.asarray(probability, dtype=float)
        if not np.all((wanted >= 0) & (wanted <= 1)):
            raise ValueError("a probability must lie between 0 and 1")
        place = wanted * (self.size - 1)
        below = np.floor(place).astype(int)
        above = np.minimum(below + 1, self.size - 1)
        low, high = self._ordered[below], self._ordered[above]
        found = low + (high - low) * (place - below)
        return float(found) if found.ndim == 0 else found

    @overload
    def standard_error(self, probability: float) -> float: ...
    @overload
    def standard_error(self, probability: npt.ArrayLike) -> Any: ...
    def standard_error(self, probability: npt.ArrayLike) -> Any:
        """Return the standard errors of quantiles: the error of the share below, over the slope (Woodruff)."""
        wanted = np.asarray(probability, dtype=float)
        errors = [self._quantile_error(float(p)) for p in wanted.ravel()]
        return errors[0] if wanted.ndim == 0 else np.reshape(errors, wanted.shape)

    def _quantile_error(self, probability: float) -> float:
        """Return the standard error of one quantile."""
        below = (self.values <= self.quantile(probability)).mean(axis=1)
        of_share = max(_standard_error(below), 0.5 / self.size)
        reach = max(0.5 * min(probability, 1 - probability), of_share)
        low, high = max(probability - reach, 0.0), min(probability + reach, 1.0)
        slope = (self.quantile(high) - self.quantile(low)) / (high - low)
        return of_share * slope

    @overload
    def probability_above(self, value: float) -> float: ...
    @overload
    def probability_above(self, value: npt.ArrayLike) -> Any: ...
    def probability_above(self, value: npt.ArrayLike) -> Any:
        """Return the share of the output greater than a value; scalar in, scalar out."""
        wanted = np.asarray(value, dtype=float)
        share = 1 - np.searchsorted(self._ordered, wanted, side="right") / self.size
        return float(share) if wanted.ndim == 0 else share

    def probability_interval(self, value: float, confidence: float = 0.95) -> tuple[float, float]:
        """Return the Clopper–Pearson interval of the share above a value; wide for Sobol' points."""
        count = self.size - int(np.searchsorted(self._ordered, value, side="right"))
        return clopper_pearson(count, self.size, confidence)

    def histogram(self, bins: int = 40, cut: float = 0.0005) -> tuple[Array, Array]:
        """Return the edges (bins + 1,) between two tail quantiles and the share of the output in each bin."""
        edges = np.linspace(self.quantile(cut), self.quantile(1 - cut), bins + 1)
        places = np.searchsorted(self._ordered, edges, side="right")
        return edges, np.diff(places) / self.size

    @cached_property
    def shares(self) -> dict[str, float]:
        """First-order Sobol' index of each input: the share of variance it causes by itself.

        Both point sets are crossed one input at a time (Saltelli et al. 2010, equation b).
        """
        if len(self._inputs) == 1 or self.sd == 0:
            return dict.fromkeys(self._inputs, float(self.sd > 0))
        count = self._points.share_count
        first = {name: self._points.standard(name, self._inputs[name], "leading") for name in self._inputs}
        second = {name: self._points.standard(name, self._inputs[name], "second") for name in self._inputs}
        base = self.values[:, :count]
        other = _evaluate(self._model, second, self._inputs)
        middle = (base.mean() + other.mean()) / 2
        variance = float(((base - middle) ** 2).mean() + ((other - middle) ** 2).mean()) / 2
        shares = {}
        for name in self._inputs:
            crossed = _evaluate(self._model, first | {name: second[name]}, self._inputs)
            caused = float(((other - middle) * (crossed - base)).mean())
            shares[name] = min(max(caused / variance, 0.0), 1.0) if variance > 0 else 0.0
        return shares


def _standard_error(statistic: Array) -> float:
    """Return the standard error of the mean of a statistic over independent replicates."""
    return float(statistic.std(ddof=1) / np.sqrt(REPLICATES))


def _evaluate(model: Model, standard: Mapping[str, Array], inputs: Mapping[str, Distribution]) -> Array:
    """Return the model at standard values of shape (replicates, points), in blocks that fit the cache."""
    shape = next(iter(standard.values())).shape
    flat = {name: values.ravel() for name, values in standard.items()}
    output = np.empty(shape[0] * shape[1])
    for start in range(0, output.size, _BLOCK):
        block = slice(start, start + _BLOCK)
        arguments = {name: inputs[name].location + inputs[name].scale * values[block] for name, values in flat.items()}
        found = np.asarray(model(**arguments), dtype=float)
        if found.shape != output[block].shape:
            raise ValueError(f"the model returned shape {found.shape}, not that of its inputs")
        output[block] = found
    if not np.isfinite(output).all():
        raise ValueError("the model returned a number that is not finite within the range of its inputs")
    return output.reshape(shape)


def propagate(
    model: Model,
    inputs: Mapping[str, Distribution],
    *,
    method: Method = "line",
    samples: int | None = None,
    seed: int = 0,
    points: UnitPoints | None = None,
) -> Spread:
    """Return the spread of a model whose inputs vary independently.

    `model` takes the inputs as keyword arrays of one shape and returns an array of that shape. `samples`
    are the points in all, rounded up to replicates × a power of two. `points` are points drawn before, so
    that many models meet the same draws; they stand for method, samples and seed.

    Raises ValueError for an unknown method, no inputs, no samples, or a model that returns another shape or a number
    that is not finite.

    >>> from flexlash.tolerance import Normal, propagate
    >>> spread = propagate(lambda a, b: a + b, {"a": Normal(0, 3), "b": Normal(0, 4)}, method="sobol")
    >>> f"{spread.sd:.2f} {spread.shares['b']:.2f}"
    '5.00 0.64'
    """
    if method not in get_args(Method):
        raise ValueError(f"method {method!r} is not one of {', '.join(get_args(Method))}")
    if not inputs:
        raise ValueError("at least one input must vary")
    notes: tuple[str, ...] = ()
    if points is None:
        notes = (LINE_NOTE,) if method == "line" else ()
        points = UnitPoints(
            list(inputs), method="random" if method == "random" else "sobol", samples=samples, seed=seed
        )
    return Spread(model=model, inputs=inputs, points=points, notes=notes)


LINE_NOTE = "Line sampling is not in this version: scrambled Sobol' points were used instead."
