"""Which input causes how much, for rows alike by lines, where inputs are correlated."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np
from scipy.special import ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.correlated_shares import ScoreModel, caused_variance
from flexlash.tolerance.digital_nets import scrambled_net
from flexlash.tolerance.engine.line_direction import Indices, Inputs, RowModel
from flexlash.tolerance.engine.line_points import LINE_REPLICATES
from flexlash.tolerance.sampling import standard_error, stopping_margin

__all__ = ["correlated_line_shares"]

SHARE_PRECISION = 2e-3
"""Standard error wanted of every share."""

FEWEST_POINTS, MOST_POINTS = 256, 1 << 13
"""Points in all replicates of either set."""

_MORE = 4
"""How many times more points a row gets whose errors are too great."""

_BLOCK = 1 << 16
"""Numbers of an array that leave room in the cache for a few others."""


def correlated_line_shares(model: RowModel, inputs: Inputs, variance: tuple[Array, Array], seed: int) -> Array:
    """Return first-order and total shares of correlated inputs and their standard errors, (4, inputs, rows).

    Equation: those of `correlated_shares` over Var y
    Arguments: model and correlated inputs of rows alike; variance of the output and its standard error (rows,) in its
        squared unit; seed of the points.
    Valid: any model; where `MOST_POINTS` do not reach `SHARE_PRECISION`, the error is what it is.
    Source: as `correlated_shares`.
    """
    found = np.zeros((4, *inputs.location.shape))
    pending, points = np.flatnonzero(variance[0] > 0), FEWEST_POINTS
    while len(pending):
        for block in _blocks(pending, points):
            found[:, :, block] = _estimate(model, inputs.take(block), block, points, seed)
        size = variance[0][pending]
        found[:, :, pending] /= size
        found[2:, :, pending] = np.hypot(found[2:, :, pending], found[:2, :, pending] * variance[1][pending] / size)
        excess = found[2:, :, pending].max(axis=(0, 1)) / SHARE_PRECISION
        found[2:, :, pending] *= stopping_margin(excess)
        pending = pending[excess > 1] if points < MOST_POINTS else pending[:0]
        points *= _MORE
    return np.clip(found, 0, 1)


def _blocks(rows: Indices, size: int) -> Iterator[Indices]:
    """Yield rows in blocks that fit the cache, `size` numbers a row."""
    step = max(_BLOCK // size, 1)
    for start in range(0, len(rows), step):
        yield rows[start : start + step]


def _estimate(model: RowModel, inputs: Inputs, rows: Indices, points: int, seed: int) -> Array:
    """Return what the inputs of these rows cause of the variance, and standard errors, (4, inputs, rows)."""
    first, second = (inputs.correlated(scores) for scores in _independent(seed, len(inputs.names), points))
    correlations = inputs.factor @ inputs.factor.T if inputs.factor is not None else np.eye(len(inputs.names))
    parts = caused_variance(_score_model(model, inputs, rows), correlations, first, second)
    return np.concatenate([np.add.reduce(parts, axis=3) / LINE_REPLICATES, standard_error(parts)])


@lru_cache(maxsize=16)
def _independent(seed: int, width: int, points: int) -> tuple[Array, Array]:
    """Return two sets of independent scores (width, replicates, points)."""
    generator = np.random.default_rng([seed, points, width])
    scores = ndtri(scrambled_net(2 * width, LINE_REPLICATES, points // LINE_REPLICATES, generator))
    return scores[:width], scores[width:]


def _score_model(model: RowModel, inputs: Inputs, rows: Indices) -> ScoreModel:
    """Return the model of rows alike at the same scores in each."""

    def outputs(scores: Array) -> Array:
        shape = inputs.count, *scores.shape[1:]
        row = np.repeat(np.arange(inputs.count), scores[0].size)
        arguments = {
            name: inputs.location[index, row] + inputs.scale[index, row] * np.tile(standard.ravel(), inputs.count)
            for index, name in enumerate(inputs.names)
            for standard in [inputs.shapes[index].standard_at(scores[index])]
        }
        flat = {name: values[None] for name, values in arguments.items()}
        return np.asarray(model(flat, rows[row])).reshape(shape)

    return outputs
