"""How rows are sampled: the plan, and points in the unit cube that are the same for every row.

A coordinate belongs to a *name*, not to a position in a list, so that two rows with different dimensions meet the same
wall thickness in the same draw. Points come in independent replicates, whose scatter gives the standard errors.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Literal

import numpy as np
from scipy.special import ndtri, stdtrit

from flexlash.schema.arrays import Array
from flexlash.tolerance.correlation import correlated_scores
from flexlash.tolerance.digital_nets import scrambled_net
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.spread import Method

__all__ = [
    "DEFAULT_SAMPLES",
    "REPLICATES",
    "PointMethod",
    "SamplingPlan",
    "UnitPoints",
    "standard_error",
    "stopping_margin",
    "widening",
]

REPLICATES = 16
"""Independent replicates behind every standard error: 15 degrees of freedom."""

DEFAULT_SAMPLES = {"sobol": 2**15, "random": 2**17}
"""Points per row when none are asked for."""

PointMethod = Literal["sobol", "random"]
PointSet = Literal["all", "leading", "second"]

_SHARE_POINTS = 2048
"""Most points in each replicate behind shares of variance."""

_STOPPED = 0.3
"""Part by which errors are widened that stopped just at what was wanted."""

_CACHED_SHAPES = 256
"""Point sets kept for the shapes of inputs that rows share."""


@dataclass(frozen=True, kw_only=True)
class SamplingPlan:
    """How the spread of rows is sampled; two equal plans give every row the same numbers.

    `inputs` names all that may vary in any row, `later_inputs` those that were added since: their points are drawn
    after the others', which keep theirs; `samples` counts the lines or points in all, None for as many as the method
    needs. `coverage` is the probability of the coverage interval, `acceptable` the share of parts over the limit
    from which a lot fails, `bounds` the shares at which a verdict changes. `cross_check` puts plain Monte Carlo beside
    the method. Without `shares` nobody asks which input causes how much, which takes about as long as all else where
    inputs are correlated.
    """

    method: Method
    inputs: tuple[str, ...]
    later_inputs: tuple[str, ...] = ()
    samples: int | None = None
    seed: int = 0
    coverage: float = 0.95
    acceptable: float = 1350e-6
    bounds: tuple[float, ...] = ()
    cross_check: bool = False
    shares: bool = True

    def points(self, method: PointMethod) -> UnitPoints:
        """Return the points of a method, drawn once a process; another method than the plan's takes its default."""
        samples = self.samples if method == self.method else None
        return _drawn(self.inputs, self.later_inputs, method=method, samples=samples, seed=self.seed)


@lru_cache(maxsize=3)
def _drawn(
    names: tuple[str, ...], later: tuple[str, ...], *, method: PointMethod, samples: int | None, seed: int
) -> UnitPoints:
    """Return points; those of one plan's two methods are kept, and of the whole drive's."""
    return UnitPoints(names, method=method, samples=samples, seed=seed, later=later)


def standard_error(replicates: Array) -> Array:
    """Return the standard errors of means over independent replicates.

    Equation: t₀.₉₇₅(n − 1)/z₀.₉₇₅ · √(Σ (xᵢ − x̄)²/((n − 1) n)): widened, so that ± 1.96 of them is Student's interval
    Arguments: replicates (..., n), in the unit of the result (...).
    Valid: at least two replicates, each a mean close to normal.
    Source: Student's t for the mean of few replicates.

    >>> round(float(standard_error(np.array([1.0, 3.0])) * 1.959963985 / 12.70620474), 9)
    1.0
    """
    count = replicates.shape[-1]
    deviation = replicates - np.add.reduce(replicates, axis=-1, keepdims=True) / count
    squares = np.add.reduce(deviation * deviation, axis=-1)
    return np.asarray(np.sqrt(squares / ((count - 1) * count)) * widening(count))


def stopping_margin(excess: Array) -> Array:
    """Return by how much standard errors are widened that were found small enough to stop.

    Equation: 1 + 0.3 min(e, 1)², e the error over the wanted one
    Arguments: `excess` e, of any shape; above 1 where nothing more can be done.
    Valid: errors of 8 to 16 replicates: who stops at the first error that is small enough stops at one that is small
        by chance, the more so the nearer it is to what was wanted.
    Source: coverage of the ± 1.96 errors over many seeds.

    >>> stopping_margin(np.array([0.0, 0.5, 1.0, 7.0])).tolist()
    [1.0, 1.075, 1.3, 1.3]
    """
    return np.asarray(1 + _STOPPED * np.minimum(excess, 1) ** 2)


@cache
def widening(count: int, confidence: float = 0.95) -> float:
    """Return how much wider than the normal one Student's interval of the mean of so many replicates is.

    >>> round(widening(16), 4), round(widening(16, 0.99), 4)
    (1.0875, 1.144)
    """
    upper = (1 + confidence) / 2
    return float(stdtrit(count - 1, upper) / ndtri(upper))


class UnitPoints:
    """Points in the unit cube, one coordinate per name, as arrays of shape (replicates, points).

    `all` of them make the spread. The shares of variance cross their leading part, `leading`, with a second
    independent set of the same length, `second`. `later` names have points drawn after those of the others. Raises
    ValueError for less than one sample.
    """

    def __init__(
        self,
        names: Sequence[str],
        *,
        method: PointMethod,
        samples: int | None,
        seed: int,
        later: Sequence[str] = (),
    ) -> None:
        total = DEFAULT_SAMPLES[method] if samples is None else samples
        if total < 1:
            raise ValueError(f"samples = {total} must be at least 1")
        self.method = method
        self.count = 1 << max(0, -(-total // REPLICATES) - 1).bit_length()
        self.share_count = min(self.count, _SHARE_POINTS)
        draw = _sobol if method == "sobol" else _random
        points = draw(2 * len(names), self.count, np.random.default_rng(seed), 2 * len(later))
        every = [*names, *names, *later, *later]
        first = {name: points[every.index(name)] for name in (*names, *later)}
        last = {name: points[len(every) - 1 - every[::-1].index(name)] for name in first}
        leading = slice(self.share_count)
        self._sets: dict[PointSet, dict[str, Array]] = {
            "all": first,
            "leading": {name: np.ascontiguousarray(values[:, leading]) for name, values in first.items()},
            "second": {name: np.ascontiguousarray(values[:, leading]) for name, values in last.items()},
        }
        self._standard: dict[tuple[PointSet, str, tuple[str | float, ...]], Array] = {}

    @property
    def size(self) -> int:
        """Points in all replicates together."""
        return REPLICATES * self.count

    def standards(
        self, inputs: Mapping[str, Distribution], factor: Array | None = None, points: PointSet = "all"
    ) -> dict[str, Array]:
        """Return the standard values of inputs, (replicates, points) each.

        `factor` (inputs, inputs) makes the scores of correlated inputs; others have the values that they have alone.
        """
        if factor is None:
            return {name: self.standard(name, distribution, points) for name, distribution in inputs.items()}
        own = (factor == np.eye(len(factor))).all(axis=1)
        scores = self.scores(list(inputs), factor, points)
        return {
            name: self.standard(name, inputs[name], points) if alone else inputs[name].standard_at(score)
            for name, alone, score in zip(inputs, own, scores, strict=True)
        }

    def scores(self, names: Sequence[str], factor: Array, points: PointSet) -> Array:
        """Return correlated scores (inputs, replicates, points)."""
        return np.stack(correlated_scores(factor, [ndtri(self._sets[points][name]) for name in names]))

    def standard(self, name: str, distribution: Distribution, points: PointSet = "all") -> Array:
        """Return the standard values of a distribution at a name's points, (replicates, points)."""
        key = (points, name, distribution.shape)
        values = self._standard.get(key)
        if values is None:
            values = distribution.standard(self._sets[points][name])
            if len(self._standard) < _CACHED_SHAPES:
                self._standard[key] = values
        return values


def _sobol(width: int, count: int, generator: np.random.Generator, later: int) -> Array:
    """Return scrambled Sobol' points (width + later, replicates, count)."""
    return scrambled_net(width, REPLICATES, count, generator, later=later)


def _random(width: int, count: int, generator: np.random.Generator, later: int) -> Array:
    """Return independent uniform points (width + later, replicates, count), none of them on a face of the cube."""
    return np.clip(generator.random((width + later, REPLICATES, count)), 2.0**-53, 1 - 2.0**-53)
