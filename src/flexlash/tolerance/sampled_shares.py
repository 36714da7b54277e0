"""Which input causes how much, at points: two point sets, each crossed with the other one input at a time.

move        change of the output where one input goes from its value in the first set to that in the second, the
            others staying as they are in the one set, or in the other
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.correlated_shares import caused_variance
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.sampling import UnitPoints, standard_error, stopping_margin
from flexlash.tolerance.variance_shares import VarianceShares

__all__ = ["Evaluate", "correlated_sampled_shares", "sampled_shares"]

_SHARE_PRECISION = 5e-3
"""Standard error wanted of every share."""

_FEWEST_POINTS = 256
"""Points of each set in each replicate to begin with."""

_MORE = 4
"""How many times more points are crossed where errors are too great."""

_MISSING = 4.0
"""By how many standard errors total indices may fall short of 1 together, which exact ones never do."""

Evaluate = Callable[[Mapping[str, Array]], Array]
"""The outputs (replicates, points) at standard values of the inputs by name."""


def sampled_shares(
    evaluate: Evaluate, inputs: Mapping[str, Distribution], points: UnitPoints, values: Array
) -> VarianceShares:
    """Return first-order and total Sobol' indices of a model at points.

    Equation: Sᵢ = E[dᵢ d′ᵢ]/(2 Var y), Sᵢᵀ = E[dᵢ² + d′ᵢ²]/(4 Var y), with the moves dᵢ in one set and d′ᵢ in the other
    Arguments: `evaluate` the model at standard values; distributions of independent inputs by name; `values`
        (replicates, points) of the output at all points.
    Valid: any model; 2 k + 1 evaluations for k inputs at each of as many points as the errors take, at most
        `points.share_count` in each replicate. Errors hold where replicates are close to normal.
    Source: Owen 2013 (better estimation of small Sobol' sensitivity indices); Jansen 1999.
    """
    deviation = values - values[0, 0]
    deviation -= deviation.mean()
    if len(inputs) == 1 or not deviation.any():
        known = np.zeros((4, len(inputs)))
        known[:2] = deviation.any()
        return VarianceShares.of(inputs, known)
    by_replicate = _variances(inputs, points, deviation)
    variance = by_replicate.mean()
    by_replicate /= variance

    def parts(count: int) -> Array:
        return np.asarray(_parts(evaluate, inputs, points, values[:, :count]) / variance)

    return VarianceShares.of(inputs, _as_precise_as_wanted(parts, by_replicate, points.share_count))


def correlated_sampled_shares(
    evaluate: Evaluate, inputs: Mapping[str, Distribution], factor: Array, points: UnitPoints, values: Array
) -> VarianceShares:
    """Return first-order and total shares of a model of correlated inputs at points.

    Equation: those of `correlated_shares` over Var y
    Arguments: as for `sampled_shares`, with the `factor` (inputs, inputs) of the inputs' scores.
    Valid: any model; as many points as the errors take, at most `points.share_count` in each replicate.
    Source: as `correlated_shares`.
    """
    squares = (values - values.mean()) ** 2
    variance = squares.mean()
    if variance == 0:
        return VarianceShares.of(inputs, np.zeros((4, len(inputs))))
    sets = [points.scores(list(inputs), factor, which) for which in ("leading", "second")]

    def model(scores: Array) -> Array:
        standard = {name: inputs[name].standard_at(score) for name, score in zip(inputs, scores, strict=True)}
        return evaluate(standard)[None]

    def parts(count: int) -> Array:
        first, second = (scores[:, :, :count] for scores in sets)
        return np.asarray(caused_variance(model, factor @ factor.T, first, second)[:, :, 0] / variance)

    by_replicate = squares.mean(axis=1) / variance
    return VarianceShares.of(inputs, _as_precise_as_wanted(parts, by_replicate, points.share_count))


def _as_precise_as_wanted(parts: Callable[[int], Array], by_replicate: Array, most: int) -> Array:
    """Return first-order shares, total shares and their standard errors, (4, inputs), by as many points as they take.

    Arguments: what each input causes in each replicate (2, inputs, replicates) by a number of points, over the
        variance; the variance of each replicate (replicates,) over that of all; the most points in a replicate.
    """
    count = min(_FEWEST_POINTS, most)
    while True:
        caused = parts(count)
        shares = caused.mean(axis=2)
        # A share moves with the variance as well as with its part of it.
        errors = standard_error(caused - shares[:, :, None] * by_replicate)
        missing = max(1 - shares[1].sum() - _MISSING * errors[1].sum(), 0.0)
        excess = errors.max() / _SHARE_PRECISION
        if (missing == 0 and excess <= 1) or count == most:
            errors = errors * stopping_margin(excess) + missing
            return np.asarray(np.clip(np.concatenate([shares, errors]), 0, 1))
        count = min(_MORE * count, most)


def _variances(inputs: Mapping[str, Distribution], points: UnitPoints, deviation: Array) -> Array:
    """Return the variance of the output in each replicate (replicates,), freed of what is known of its linear part.

    Equation: l = Σ bᵢ (xᵢ − E xᵢ) with slopes by least squares, whose variance Σ bᵢ² Var xᵢ is known
    Arguments: distributions of independent inputs; `deviation` (replicates, points) of the output from its mean.
    Valid: any model; of a linear one nothing is left to chance.
    Source: as `_controlled`.
    """
    # Fourth powers of a great output would overflow.
    size = np.abs(deviation).max()
    deviation = deviation / size
    middles = [(one.expectation - one.location) / one.scale for one in inputs.values()]
    off = [points.standard(*one) - middle for one, middle in zip(inputs.items(), middles, strict=True)]
    slopes = _slopes(off, deviation)
    # The mean of the output errs by what the means of the inputs err.
    deviation += sum(slope * values.mean() for slope, values in zip(slopes, off, strict=True)) - deviation.mean()
    linear, known = np.zeros(deviation.shape), 0.0
    for slope, values, distribution in zip(slopes, off, inputs.values(), strict=True):
        linear += slope * values
        known += slope * slope * _variance(distribution)
    squares = deviation * deviation
    controlled = _controlled(squares, linear * linear, known)
    return np.asarray(size * size * (controlled if controlled.mean() > 0 else squares.mean(axis=1)))


def _slopes(off: list[Array], deviation: Array) -> list[float]:
    """Return the slopes of the output by least squares in its leading points, (inputs,).

    Products of means instead would err by as many parts of all points as there are inputs.
    """
    leading = [values[:, :_FEWEST_POINTS] for values in (*off, deviation)]
    leading = [values - values.mean() for values in leading]
    products = np.array([[(one * other).mean() for other in leading] for one in leading[:-1]])
    slopes, *_ = np.linalg.lstsq(products[:, :-1], products[:, -1], rcond=None)
    return [float(slope) for slope in slopes]


def _variance(distribution: Distribution) -> float:
    """Return the variance of a distribution in its own scale."""
    return (distribution.standard_deviation / distribution.scale) ** 2


def _parts(evaluate: Evaluate, inputs: Mapping[str, Distribution], points: UnitPoints, base: Array) -> Array:
    """Return what each input causes of the variance, first-order and total: (2, inputs, replicates).

    Arguments: as for `sampled_shares`; `base` (replicates, points) the outputs at the first set.
    """
    first, second = (
        {name: points.standard(name, inputs[name], which)[:, : base.shape[1]] for name in inputs}
        for which in ("leading", "second")
    )
    other = evaluate(second)
    parts = np.empty((2, len(inputs), len(base)))
    for index, (name, distribution) in enumerate(inputs.items()):
        move = evaluate(first | {name: second[name]}) - base
        again = other - evaluate(second | {name: first[name]})
        squares = (second[name] - first[name]) ** 2 / 2
        exact = _variance(distribution)
        parts[0, index] = _controlled(move * again / 2, squares, exact)
        parts[1, index] = _controlled((move * move + again * again) / 4, squares, exact)
    return parts


def _controlled(parts: Array, squares: Array, exact: float) -> Array:
    """Return the means in each replicate (replicates,) of parts of a variance, freed of what is known of squares.

    Equation: mean of p − β (q − E q), β by regression of p on q
    Arguments: parts p and squares q (replicates, points); the expectation of q.
    Valid: any model; what goes with q is not left to chance.
    Source: control variates with a known expectation (Owen 2013, Monte Carlo theory, methods and examples, 8.9).
    """
    off = squares - squares.mean()
    spread = (off * off).mean()
    slope = (off * parts).mean() / spread if spread > 0 else 0.0
    return np.asarray((parts - slope * (squares - exact)).mean(axis=1))
