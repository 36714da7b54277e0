"""Which input causes how much, at points, where inputs are correlated."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.correlated_shares import caused_variance
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.sampled_shares import FEWEST_POINTS, MISSING, MORE, SHARE_PRECISION, STOPPED, Evaluate
from flexlash.tolerance.sampling import UnitPoints, standard_error
from flexlash.tolerance.variance_shares import VarianceShares

__all__ = ["correlated_sampled_shares"]


def correlated_sampled_shares(
    evaluate: Evaluate, inputs: Mapping[str, Distribution], factor: Array, points: UnitPoints, values: Array
) -> VarianceShares:
    """Return first-order and total shares of a model of correlated inputs at points.

    Equation: those of `correlated_shares` over Var y
    Arguments: `evaluate` the model at standard values; distributions by name; the `factor` (inputs, inputs) of their
        scores; `values` (replicates, points) of the output at all points.
    Valid: any model; as many points as the errors take, at most `points.share_count` in each replicate.
    Source: as `correlated_shares`.
    """
    squares = (values - values.mean()) ** 2
    variance = squares.mean()
    if variance == 0:
        return VarianceShares.of(inputs, np.zeros((4, len(inputs))))
    by_replicate = squares.mean(axis=1) / variance
    sets = [points.scores(list(inputs), factor, which) for which in ("leading", "second")]
    count = min(FEWEST_POINTS, points.share_count)

    def model(scores: Array) -> Array:
        standard = {name: inputs[name].standard_at(score) for name, score in zip(inputs, scores, strict=True)}
        return evaluate(standard)[None]

    while True:
        first, second = (scores[:, :, :count] for scores in sets)
        parts = caused_variance(model, factor @ factor.T, first, second)[:, :, 0] / variance
        shares = parts.mean(axis=2)
        # A share moves with the variance as well as with its part of it.
        errors = standard_error(parts - shares[:, :, None] * by_replicate)
        missing = max(1 - shares[1].sum() - MISSING * errors[1].sum(), 0.0)
        excess = errors.max() / SHARE_PRECISION
        errors = errors * (1 + STOPPED * min(excess, 1) ** 2) + missing
        if (missing == 0 and excess <= 1) or count == points.share_count:
            return VarianceShares.of(inputs, np.clip(np.concatenate([shares, errors]), 0, 1))
        count = min(MORE * count, points.share_count)
