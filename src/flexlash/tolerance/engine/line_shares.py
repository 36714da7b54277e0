"""Which input causes how much: Sobol' indices by quadrature over one input and a net over the others.

The inner variance, over one input, is exact for a polynomial of degree 4; the outer mean varies little, since
for a nearly additive model the effect of an input hardly depends on the others. So a few points do.
"""

from __future__ import annotations

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.engine.line_direction import Inputs, RowModel
from flexlash.tolerance.engine.line_tables import REACH

__all__ = ["gauss_rule", "variance_shares"]

_POINTS = 5
_SCORES = np.linspace(-REACH, REACH, 1661)
_MASS = np.exp(-_SCORES * _SCORES / 2) / np.exp(-_SCORES * _SCORES / 2).sum()
_RULES: dict[tuple[str | float, ...], tuple[Array, Array]] = {}
_MOST_RULES = 256


def gauss_rule(distribution: Distribution) -> tuple[Array, Array]:
    """Return the five nodes and weights of the Gauss rule for a distribution's standard shape, (5,) each.

    Equation: ∫ f(x) dF(x) = Σ wᵢ f(xᵢ)
    Arguments: a distribution, whose shape alone matters.
    Valid: exact for a polynomial of degree 9.
    Source: Stieltjes' recurrence on a fine grid of scores; Golub and Welsch 1969.

    >>> from flexlash.tolerance.distributions import Normal
    >>> nodes, weights = gauss_rule(Normal(0, 1))
    >>> round(float((weights * nodes**8).sum()), 6)
    105.0
    """
    rule = _RULES.get(distribution.shape)
    if rule is None:
        rule = _stieltjes(distribution.standard_at(_SCORES))
        if len(_RULES) < _MOST_RULES:
            _RULES[distribution.shape] = rule
    return rule


def _stieltjes(values: Array) -> tuple[Array, Array]:
    """Return the Gauss rule of a discrete measure by its three-term recurrence (Golub and Welsch 1969)."""
    before, now = np.zeros_like(values), np.ones_like(values)
    size_before, diagonal, beside = 1.0, [], []
    for order in range(_POINTS):
        size = float((_MASS * now * now).sum())
        centre = float((_MASS * values * now * now).sum()) / size
        diagonal.append(centre)
        if order:
            beside.append(size / size_before)
        before, now = now, (values - centre) * now - (beside[-1] if order else 0.0) * before
        size_before = size
    off = np.sqrt(beside)
    nodes, vectors = np.linalg.eigh(np.diag(diagonal) + np.diag(off, 1) + np.diag(off, -1))
    return nodes, vectors[0] ** 2


def variance_shares(model: RowModel, inputs: Inputs, net: Array, variance: Array) -> tuple[Array, Array]:
    """Return first-order and total Sobol' indices, (inputs, rows) each.

    Equation: Sᵢ = Var(E[y | xᵢ])/Var y, Sᵢᵀ = E[Var(y | all but xᵢ)]/Var y
    Arguments: model and inputs of rows alike; net of standard normal scores (inputs, points); variance of the output
        (rows,) in its squared unit.
    Valid: the inner variance is exact for a polynomial of degree 4; the outer mean is as good as the points.
    Source: Sobol' 1993; Homma and Saltelli 1996.
    """
    if len(inputs.names) == 1:
        alone = (variance > 0).astype(float)[None]
        return alone, alone
    points = net.shape[1]
    rows = np.repeat(np.arange(inputs.count), points)
    location, scale = inputs.location[:, rows], inputs.scale[:, rows]
    everywhere = np.tile(net, inputs.count)
    base = {
        name: (location[index] + scale[index] * inputs.shapes[index].standard_at(everywhere[index]))[None]
        for index, name in enumerate(inputs.names)
    }
    first, total = np.empty(inputs.location.shape), np.empty(inputs.location.shape)
    size = np.where(variance > 0, variance, 1.0)
    for index, name in enumerate(inputs.names):
        nodes, weights = gauss_rule(inputs.shapes[index])
        weight = weights[:, None]
        varied = location[index] + scale[index] * nodes[:, None]
        output = model(base | {name: varied}, rows)
        output = output - output[:1]
        mean = (weight * output).sum(axis=0)
        inner = (weight * (output - mean) ** 2).sum(axis=0).reshape(inputs.count, points)
        by_node = output.reshape(_POINTS, inputs.count, points).mean(axis=2)
        centre = (weight * by_node).sum(axis=0)
        first[index] = (weight * (by_node - centre) ** 2).sum(axis=0) / size
        total[index] = inner.mean(axis=1) / size
    return np.clip(first, 0, 1), np.clip(total, 0, 1)
