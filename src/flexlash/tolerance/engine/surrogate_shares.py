"""Shares of variance from an additive surrogate: its own are exact, points only say where the model departs.

departure           centred term of one input: e^{sᵢ}/E e^{sᵢ} − 1 of the logarithm, sᵢ − E sᵢ of the output itself
residual            model less surrogate
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from scipy.special import expm1

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.engine.line_direction import Indices, Inputs, RowModel
from flexlash.tolerance.engine.line_points import LINE_REPLICATES, normal_density
from flexlash.tolerance.engine.line_surrogate import AdditiveSurrogate
from flexlash.tolerance.engine.term_rules import polynomial
from flexlash.tolerance.sampling import standard_error

__all__ = ["missed_variance", "surrogate_shares"]

_SCORES = np.linspace(-8.3, 8.3, 1661)
_MASS = normal_density(_SCORES) / normal_density(_SCORES).sum()
"""A fine rule in the score, by which variances of variables are taken."""

_VARIANCES: dict[tuple[str | float, ...], float] = {}
_MOST_VARIANCES = 256
"""Variances that are kept by shape for the next rows."""

Departures: TypeAlias = tuple[Array, Array, Array]
"""Departures at points (inputs, rows, points), their variances (inputs, rows), the mean of the surrogate (rows,)."""


def surrogate_shares(
    surrogate: AdditiveSurrogate, model: RowModel, inputs: Inputs, net: Array, variance: Array
) -> Array:
    """Return first-order and total Sobol' indices and their standard errors, (4, inputs, rows).

    One evaluation a point serves all inputs. What the residual causes by itself is positive, at most its variance, and
    counted as an error; errors are infinite where there is no surrogate or the model is not finite.

    Equation: with ŷ = M Π(1 + cᵢ), vᵢ = Var cᵢ and r = y − ŷ: Var y · Sᵢ ≈ M² vᵢ + 2 E[M cᵢ r],
        Var y · Sᵢᵀ ≈ M² Π(1 + vⱼ) vᵢ/(1 + vᵢ) + 2 E[ŷ cᵢ/(1 + cᵢ) r]; with ŷ = M + Σ cᵢ both are vᵢ + 2 E[cᵢ r]
    Arguments: surrogates, model and inputs of rows alike; net of mirrored scores (inputs, points); variance of the
        output (rows,) in its squared unit.
    Valid: independent inputs; sharp where the variance of the residual is little beside that of the output.
    Source: Var E[ŷ + r | xᵢ] and E Var(ŷ + r | all but xᵢ) expanded; indices of a product by Sobol' 1993.
    """
    points = net.shape[1]
    rows = np.repeat(np.arange(inputs.count), points)
    departures, caused, mean = _departures(inputs, surrogate, net)
    logarithmic = surrogate.logarithmic
    # One after the other, since a reduction may take another order for a row that is alone.
    product, sum_of = np.cumprod(1 + departures, axis=0)[-1], np.cumsum(departures, axis=0)[-1]
    stood = np.where(logarithmic[:, None], mean[:, None] * product, mean[:, None] + sum_of)
    residual = _outputs(model, inputs, net, rows).reshape(inputs.count, points) - stood
    rest = (residual * residual).mean(axis=1) - residual.mean(axis=1) ** 2
    unit = np.where(logarithmic, mean, 1.0)
    whole = np.where(logarithmic, np.cumprod(1 + caused, axis=0)[-1], 1.0)
    found = np.empty((4, *inputs.location.shape))
    for index, (departure, own) in enumerate(zip(departures, caused, strict=True)):
        within = np.where(logarithmic[:, None], product / (1 + departure), 1.0) * departure
        of_others = whole / np.where(logarithmic, 1 + own, 1.0)
        for place, (control, exact) in enumerate(((departure, own), (within, own * of_others))):
            means = (control * residual).reshape(inputs.count, LINE_REPLICATES, -1).mean(axis=2)
            found[place, index] = (unit * unit * exact + 2 * unit * means.mean(axis=1)) / variance
            found[place + 2, index] = (2 * unit * standard_error(means) + rest) / variance
    for index, (rule, shape) in enumerate(zip(surrogate.rules, inputs.shapes, strict=True)):
        found[2:, index] += missed_variance(shape, rule.half * rule.variables, rule.weights) * found[:2, index]
    found[2:, :, ~(surrogate.fitted & np.isfinite(found).all(axis=(0, 1)))] = np.inf
    return found


def missed_variance(shape: Distribution, standard: Array, weights: Array) -> float:
    """Return by which part of the variance of a distribution a rule is off, such as for a tail that it does not reach.

    Arguments: a distribution, whose shape alone matters, so that rows alike have the same bits in any company; standard
        values and weights (nodes,), but for a constant.

    >>> from flexlash.tolerance.distributions import Normal
    >>> round(missed_variance(Normal(0, 3), np.array([-1.0, 1.0]), np.array([0.4, 0.4])), 9)
    0.2
    """
    exact = _VARIANCES.get(shape.shape)
    if exact is None:
        exact = _variance(shape.standard_at(_SCORES), _MASS)
        if len(_VARIANCES) < _MOST_VARIANCES:
            _VARIANCES[shape.shape] = exact
    return abs(_variance(standard, weights) / exact - 1)


def _variance(values: Array, weights: Array) -> float:
    """Return the variance of values (nodes,) by their weights."""
    off = values - (weights * values).sum()
    return float((weights * off * off).sum())


def _departures(inputs: Inputs, surrogate: AdditiveSurrogate, net: Array) -> Departures:
    """Return the departures at points of a net, their variances, and the mean of the surrogate."""
    departures, caused = np.empty((len(net), inputs.count, net.shape[1])), np.empty(inputs.location.shape)
    mean, logarithmic = surrogate.centre.copy(), surrogate.logarithmic[:, None]
    for index, rule in enumerate(surrogate.rules):
        coefficients = surrogate.coefficients[:, index, :, None]
        variable = rule.variable(inputs.shapes[index].standard_at(net[index]))
        # Sums along rows that lie in memory one after the other are the same for a row alone and in company.
        every, here = (np.ascontiguousarray(polynomial(coefficients, at)) for at in (rule.variables, variable))
        # NumPy's exp may round otherwise at another place of an array; SciPy's functions do not.
        every, here = (np.where(logarithmic, expm1(np.where(logarithmic, one, 0.0)), one) for one in (every, here))
        middle = np.add.reduce(rule.weights * every, axis=1)[:, None]
        unit = np.where(logarithmic, 1 + middle, 1.0)
        every, departures[index] = ((one - middle) / unit for one in (every, here))
        caused[index] = np.add.reduce(rule.weights * every * every, axis=1)
        mean = np.where(surrogate.logarithmic, mean * unit[:, 0], mean + middle[:, 0])
    return departures, caused, mean


def _outputs(model: RowModel, inputs: Inputs, net: Array, rows: Indices) -> Array:
    """Return the outputs (rows × points,) at points of a net (inputs, points)."""
    arguments = {}
    for index, (name, shape) in enumerate(zip(inputs.names, inputs.shapes, strict=True)):
        standard = np.tile(shape.standard_at(net[index]), inputs.count)
        arguments[name] = (inputs.location[index, rows] + inputs.scale[index, rows] * standard)[None]
    return np.asarray(model(arguments, rows)[0])
