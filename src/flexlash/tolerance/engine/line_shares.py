"""Which input causes how much: Sobol' indices by the surrogate where it is close to the model, else by quadrature.

Quadrature goes over one input, and mirrored points over the others. Rows whose errors are too great get four times as
many points, and again.

    effect      mean of the output at a node of one input, over the points of the others, less its own mean
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.correlated_line_shares import correlated_line_shares
from flexlash.tolerance.engine.line_direction import Indices, Inputs, RowModel
from flexlash.tolerance.engine.line_points import LINE_REPLICATES, mirrored_net, normal_density
from flexlash.tolerance.engine.line_surrogate import AdditiveSurrogate
from flexlash.tolerance.engine.surrogate_shares import missed_variance, surrogate_shares
from flexlash.tolerance.sampling import standard_error, stopping_margin

__all__ = ["line_shares"]

SHARE_PRECISION = 2e-3
"""Standard error wanted of every share."""

SURROGATE_POINTS = 16, 64
"""Points in all replicates that say where a model departs from its surrogate; the fewest are one and its mirror image
in each."""

QUADRATURE_POINTS = 64, 256, 1024
"""Points over the other inputs where that is not enough."""

_NODES = np.linspace(-6.0, 6.0, 25)[:, None]
"""Scores of one input; beyond them a heavy tail such as that of Student's t with 5 degrees has 1e-5 of its variance."""

_BLOCK = 1 << 16
"""Numbers of an array that leave room in the cache for a few others."""


def line_shares(
    model: RowModel,
    inputs: Inputs,
    variance: tuple[Array, Array],
    seed: int,
    surrogate: AdditiveSurrogate | None = None,
) -> Array:
    """Return first-order and total Sobol' indices of rows alike and their standard errors, (4, inputs, rows).

    Equation: Sᵢ = Var(E[y | xᵢ])/Var y, Sᵢᵀ = E[Var(y | all but xᵢ)]/Var y
    Arguments: model and inputs of rows alike; variance of the output and its standard error (rows,) in its squared
        unit; seed of the points; surrogates of the rows, if there are any.
    Valid: an output smooth in the scores, or the difference to half as many nodes tells its error; correlated inputs
        go to `correlated_line_shares`. Where the most points do not reach `SHARE_PRECISION`, the error is what it is,
        and too small for an output nearly all of whose variance comes from a few of them.
    Source: Sobol' 1993; Homma and Saltelli 1996.
    """
    if inputs.factor is not None:
        return correlated_line_shares(model, inputs, variance, seed)
    found = np.zeros((4, *inputs.location.shape))
    if len(inputs.names) == 1:
        found[:2] = variance[0] > 0
        return found
    pending = np.flatnonzero(variance[0] > 0)
    stages = [(surrogate, points) for points in SURROGATE_POINTS if surrogate is not None]
    for stood, points in [*stages, *((None, points) for points in QUADRATURE_POINTS)]:
        net = mirrored_net(seed, len(inputs.names), points)
        for block in _blocks(pending, points * (1 if stood else len(_NODES))):
            given = _of(model, block), inputs.take(block), net, variance[0][block]
            found[:, :, block] = surrogate_shares(stood.take(block), *given) if stood else _by_quadrature(*given)
        known = variance[1][pending] / variance[0][pending]
        found[2:, :, pending] = np.hypot(found[2:, :, pending], found[:2, :, pending] * known)
        pending = pending[found[2:, :, pending].max(axis=(0, 1)) > SHARE_PRECISION]
    # Points were found enough by errors some of which came out small by chance.
    excess = found[2:].max(axis=(0, 1)) / SHARE_PRECISION
    found[2:] *= stopping_margin(excess)
    return np.clip(found, 0, 1)


def _blocks(rows: Indices, size: int) -> Iterator[Indices]:
    """Yield rows in blocks that fit the cache, `size` numbers a row."""
    step = max(_BLOCK // size, 1)
    for start in range(0, len(rows), step):
        yield rows[start : start + step]


def _of(model: RowModel, rows: Indices) -> RowModel:
    """Return the model of some of the rows."""
    return lambda arguments, chosen: model(arguments, rows[chosen])


def _by_quadrature(model: RowModel, inputs: Inputs, net: Array, variance: Array) -> Array:
    """Return first-order and total indices and their standard errors by points (inputs, points): (4, inputs, rows)."""
    points = net.shape[1]
    rows = np.repeat(np.arange(inputs.count), points)
    base = {name: _values(inputs, index, net[index], rows) for index, name in enumerate(inputs.names)}
    found = np.empty((4, *inputs.location.shape))
    for index, name in enumerate(inputs.names):
        output = model(base | {name: _values(inputs, index, _NODES, rows)}, rows)
        sound = np.isfinite(output)
        output = np.where(sound, output - output[len(_NODES) // 2], 0.0)
        # A third of what twice the spacing changes is the error of a kink, and more than that of a smooth output.
        fine = _parts(output, inputs.count, 1)
        coarse = _parts(output, inputs.count, 2)
        standard = inputs.shapes[index].standard_at(_NODES[:, 0])
        missed = missed_variance(inputs.shapes[index], standard, _weights(1)[:, 0])
        found[:2, index] = fine[:2]
        found[2:, index] = fine[2:] + np.abs(fine[:2] - coarse[:2]) / 3 + missed * fine[:2]
        found[2:, index, ~sound.reshape(-1, inputs.count, points).all(axis=(0, 2))] = np.inf
    return found / variance


def _values(inputs: Inputs, index: int, scores: Array, rows: Indices) -> Array:
    """Return an input of rows (k, rows × points) at scores of all points, or (k, 1) of all rows."""
    standard = inputs.shapes[index].standard_at(scores)
    if standard.ndim == 1:
        standard = np.tile(standard, inputs.count)[None]
    return np.asarray(inputs.location[index, rows] + inputs.scale[index, rows] * standard)


@cache
def _weights(every: int) -> Array:
    """Return the weights (k, 1) of every so many nodes under the normal density, nearly exact for what is smooth."""
    density = normal_density(_NODES[::every])
    return np.asarray(density / density.sum())


def _parts(output: Array, rows: int, every: int) -> Array:
    """Return what one input causes of the variance, first-order and total, and standard errors of both: (4, rows).

    Equation: V = Σ_{r≠s} ⟨cᵣ, cₛ⟩/(n(n − 1)), Vᵀ = mean over points of Σ w (y − Σ w y)², ⟨c, d⟩ = Σ w c d
    Arguments: output (nodes, rows × points) at nodes of the input and points of the others; `every` so many of the
        nodes is used; c the effects of each of n replicates.
    Valid: products of different replicates leave out the variance of the means, by which V would be too great.
    Source: Hoeffding 1948 (U-statistics), whose standard error is the jackknife's (Efron and Stein 1981); trapezoidal
        rule in the score, nearly exact for what is smooth.
    """
    output, weight = output[::every], _weights(every)
    deviation = output - (weight * output).sum(axis=0)
    inner = (weight * deviation * deviation).sum(axis=0).reshape(rows, LINE_REPLICATES, -1).mean(axis=2)
    effect = deviation.reshape(len(output), rows, LINE_REPLICATES, -1).mean(axis=3)
    count = LINE_REPLICATES
    mean = effect.mean(axis=2, keepdims=True)
    own = (weight[:, :, None] * effect * effect).sum(axis=0)
    crossed = count * (weight[:, :, None] * effect * mean).sum(axis=0) - own
    products = crossed.sum(axis=1, keepdims=True)
    without = (products - 2 * crossed) / ((count - 1) * (count - 2))
    first = products[:, 0] / (count * (count - 1))
    # Pseudo-values of the jackknife have the spread of the replicates.
    pseudo = count * first[:, None] - (count - 1) * without
    return np.stack([first, inner.mean(axis=1), standard_error(pseudo), standard_error(inner)])
