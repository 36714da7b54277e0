"""How much of the variance lies between lots and how much within them, for any model: lots crossed with parts.

Each replicate has its own lots and two independent sets of parts; every lot meets all parts of both sets. Lots and
parts stand at evenly spaced, randomly shifted positions on lines along which the output changes fastest, so that what
is nearly linear is integrated nearly exactly.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.digital_nets import scrambled_net
from flexlash.tolerance.engine.line_direction import Inputs, LineDirection, RowModel, direction_of, scores_across
from flexlash.tolerance.engine.line_points import LINE_REPLICATES, normal_density
from flexlash.tolerance.engine.lot_inputs import LotsAndParts
from flexlash.tolerance.sampling import standard_error

__all__ = ["PointSet", "VarianceSplit", "crossed_variance", "split_of", "variance_split"]

_POSITIONS = np.arange(-6.0, 7.0)
"""Positions along a line, shifted by up to half of their distance to both sides."""

_FEWEST_SPACED, _SPACED = 8, 5.5
"""Fewest points of an evenly spaced coordinate across lines, and how far it reaches to both sides."""

_SPACING = 1e-6
"""Part of a standard deviation that the spacing of the positions leaves, which no replicate shows."""

_CHEAPER = 16
"""How many times more lines lots alone and parts alone take than lots that are crossed with parts."""

_TINY = np.finfo(float).tiny
_BLOCK = 1 << 19
"""Outputs of lots crossed with parts that are looked at together."""


@dataclass(frozen=True, kw_only=True)
class VarianceSplit:
    """Standard deviations within lots and between them, and their standard errors, as parts of the whole; (rows,)."""

    within: Array
    between: Array
    within_error: Array
    between_error: Array


@dataclass(frozen=True, kw_only=True)
class PointSet:
    """Inputs by name at points, (rows, replicates, points) each, and weights that sum to 1, (replicates, points)."""

    values: Mapping[str, Array]
    weights: Array


def split_of(within: Array, between: Array, within_error: Array, between_error: Array) -> VarianceSplit:
    """Return the parts that two variances with their standard errors have in their sum, (rows,) each.

    Equation: √(W/(W + B)) and √(B/(W + B)); the error of a part S is hypot(B eW, W eB)/(W + B)², that of its root the
        lesser of e/(2 √S) and √e
    Arguments: W, B and their standard errors in the squared unit of the output.
    Valid: any; where both are 0 nothing varies, and both parts are 0.
    Source: the delta rule.
    """
    within, between = np.maximum(within, 0.0), np.maximum(between, 0.0)
    whole = within + between
    varies = np.where(whole > 0, whole, 1.0)
    error = np.hypot(between * within_error, within * between_error) / varies**2
    parts = np.sqrt(within / varies), np.sqrt(between / varies)
    errors = (_SPACING * part + np.minimum(error / np.maximum(2 * part, _TINY), np.sqrt(error)) for part in parts)
    return VarianceSplit(
        within=parts[0], between=parts[1], **dict(zip(("within_error", "between_error"), errors, strict=True))
    )


def variance_split(split: LotsAndParts, seed: int, lines: int) -> VarianceSplit:
    """Return how the variance of each row is split, by as many lines over the lot inputs as over the part inputs.

    Equation: with m(l), m'(l) the means over two independent sets of parts and s, s' those of the squares,
        between² = E[(m − m̄)(m' − m̄)], within² = E[(s + s')/2 − m m']; what these find of a near product or sum
        g(l) h(p) is replaced by its own variances, over many more lines of lots alone and of parts alone
    Arguments: rows alike with lot and part inputs; lines a multiple of LINE_REPLICATES.
    Valid: any model with a variance; the positions are shifted at random, so that steps show in the errors.
    Source: Sobol' 1993, the closed index of a group of inputs; products of independent means have no bias; a control
        variate whose expectation is known takes away what it has in common.
    """
    groups = (split.lots, split.lots_alone), (split.parts, split.parts_alone)
    lot_lines, part_lines = ((group, _along(alone, group), seed) for group, alone in groups)
    few = [_on_lines(*lot_lines, lines, 0), *(_on_lines(*part_lines, lines, stream) for stream in (1, 2))]
    many = [_on_lines(*kind, _CHEAPER * lines, stream) for kind, stream in ((lot_lines, 3), (part_lines, 4))]
    near = _Near(split, few, many)
    crossed = _crossed(split, few[0], few[1:], near)
    known = near.variances()
    estimates = [one.mean(axis=1) + other.mean(axis=1) for one, other in zip(known, crossed, strict=True)]
    errors = (np.hypot(standard_error(one), standard_error(other)) for one, other in zip(known, crossed, strict=True))
    return split_of(*estimates, *errors)


def crossed_variance(split: LotsAndParts, lots: PointSet, parts: Sequence[PointSet]) -> VarianceSplit:
    """Return how the variance of each row is split, by lots that are crossed with two sets of parts.

    Equation: that of `variance_split`
    Arguments: rows alike; sets of lots and of parts, independent of each other, of as many replicates.
    Valid: any model with a variance.
    Source: that of `variance_split`.
    """
    within, between = _crossed(split, lots, parts, None)
    return split_of(within.mean(axis=1), between.mean(axis=1), standard_error(within), standard_error(between))


class _Near:
    """What the output is near to: the product of what lots and parts do alone, or the sum where a factor changes sign.

    Equation: Y ≈ g(l) h(p)/Y₀, or g(l) + h(p) − Y₀, with g, h the outputs of lots and of parts alone, Y₀ at the medians
    """

    def __init__(self, split: LotsAndParts, few: Sequence[PointSet], many: Sequence[PointSet]) -> None:
        self._centre = split.at_medians()
        self._few = [_alone(split, points) for points in few]
        self._many = [_alone(split, points) for points in many]
        self._weights = [points.weights for points in many]
        outputs = np.concatenate([each.reshape(split.rows, -1) for each in (*self._few, *self._many)], axis=1)
        self._product = np.asarray((outputs * self._centre[:, None] > 0).all(axis=1))

    def crossed(self, rows: slice) -> Array:
        """Return how far near outputs of some rows lie off the medians', (rows, replicates, sets, lots, parts)."""
        lots, *parts = (outputs[rows] for outputs in self._few)
        lot, part = lots[:, :, None, :, None], np.stack(parts, axis=2)[:, :, :, None, :]
        centre, product = (each[rows, None, None, None, None] for each in (self._centre, self._product))
        return np.where(product, lot * (part / np.where(product, centre, 1.0)), lot + (part - centre)) - centre

    def variances(self) -> tuple[Array, Array]:
        """Return the near output's variances within and between lots by each replicate, (rows, replicates) each."""
        moments = []
        for outputs, weights in zip(self._many, self._weights, strict=True):
            mean = (outputs * weights).sum(axis=-1).mean(axis=1)[:, None]
            deviation = outputs - mean[:, :, None]
            moments.append((mean, (deviation * deviation * weights).sum(axis=-1)))
        (lot_mean, between), (part_mean, within) = moments
        product = self._product[:, None]
        size = np.where(product, self._centre[:, None], 1.0) ** 2
        return (
            np.where(product, within * (lot_mean**2 + between) / size, within),
            np.where(product, between * part_mean**2 / size, between),
        )


def _across(width: int, count: int, generator: np.random.Generator) -> tuple[Array, Array]:
    """Return scores across lines (width, replicates, count) and the weights of the lines (replicates, count).

    A coordinate that is alone is spaced evenly, so far out that nothing is left, and shifted at random.
    """
    if width == 1 and count >= _FEWEST_SPACED:
        shifted = (np.arange(count) + generator.random((1, LINE_REPLICATES, 1))) / count
        scores = (2 * shifted - 1) * _SPACED
        weights = normal_density(scores[0])
        return scores, weights / weights.sum(axis=1, keepdims=True)
    points = scrambled_net(width, LINE_REPLICATES, count, generator)
    return np.asarray(ndtri(points)), np.full((LINE_REPLICATES, count), 1 / count)


def _alone(split: LotsAndParts, points: PointSet) -> Array:
    """Return the outputs (rows, replicates, points) of lots or of parts alone."""
    alone = split.lots_alone if set(points.values) == set(split.lots.names) else split.parts_alone
    shape = next(iter(points.values.values())).shape
    columns = {name: values.reshape(split.rows, -1).T for name, values in points.values.items()}
    return np.ascontiguousarray(alone(columns, np.arange(split.rows)).T).reshape(shape)


def _crossed(split: LotsAndParts, lots: PointSet, parts: Sequence[PointSet], near: _Near | None) -> tuple[Array, Array]:
    """Return the variances within and between lots by each replicate, (rows, replicates) each; less those of `near`."""
    size = len(parts) * lots.weights.size * parts[0].weights.shape[1]
    step = max(_BLOCK // size, 1)
    centre = split.at_medians()
    pieces = []
    for start in range(0, split.rows, step):
        rows = slice(start, start + step)
        found = _variances(_outputs(split, centre, lots, parts, rows), lots, parts)
        if near:
            of_near = _variances(near.crossed(rows), lots, parts)
            found = found[0] - of_near[0], found[1] - of_near[1]
        pieces.append(found)
    within, between = (np.concatenate(values) for values in zip(*pieces, strict=True))
    return within, between


def _along(alone: RowModel, group: Inputs) -> LineDirection:
    """Return directions for lines; where none is steepest, that of the input which closes the plane."""
    direction = direction_of(alone, group)
    still = ~(direction.vector != 0).any(axis=0)
    vector = direction.vector.copy()
    vector[direction.order[-1, still], np.flatnonzero(still)] = 1.0
    return LineDirection(vector=vector, order=direction.order)


def _on_lines(inputs: Inputs, direction: LineDirection, seed: int, lines: int, stream: int) -> PointSet:
    """Return points on lines: one set for each stream of randomness."""
    generator = np.random.default_rng([seed, lines, stream])
    lines = lines if len(inputs.names) > 1 else LINE_REPLICATES
    net, net_weights = _across(len(inputs.names) - 1, lines // LINE_REPLICATES, generator)
    net = net.reshape(len(net), lines)
    shift = generator.random((LINE_REPLICATES, 1, 1)) - 0.5
    position = np.broadcast_to(_POSITIONS + shift, (LINE_REPLICATES, lines // LINE_REPLICATES, len(_POSITIONS)))
    weight = normal_density(position) * net_weights[:, :, None]
    weight = weight.reshape(LINE_REPLICATES, -1)
    origin = scores_across(direction, net).reshape(*direction.vector.shape, LINE_REPLICATES, -1, 1)
    scores = inputs.correlated(origin + direction.vector[:, :, None, None, None] * position)
    values = {}
    for index, name in enumerate(inputs.names):
        standard = inputs.shapes[index].standard_at(scores[index].reshape(inputs.count, LINE_REPLICATES, -1))
        values[name] = inputs.location[index, :, None, None] + inputs.scale[index, :, None, None] * standard
    return PointSet(values=values, weights=weight / weight.sum(axis=1, keepdims=True))


def _outputs(split: LotsAndParts, centre: Array, lots: PointSet, parts: Sequence[PointSet], rows: slice) -> Array:
    """Return how far outputs of some rows lie off those at the medians, (rows, replicates, sets, lots, parts)."""
    shape = (len(lots.weights), len(parts), lots.weights.shape[1], parts[0].weights.shape[1])
    varied = {name: values[rows, :, None, :, None] for name, values in lots.values.items()}
    for name in parts[0].values:
        varied[name] = np.stack([each.values[name][rows] for each in parts], axis=2)[:, :, :, None, :]
    chosen = np.arange(split.rows)[rows]
    count = len(chosen)
    columns = {name: np.broadcast_to(values, (count, *shape)).reshape(count, -1).T for name, values in varied.items()}
    return np.ascontiguousarray((split.model(columns, chosen) - centre[rows]).T).reshape(count, *shape)


def _variances(deviation: Array, lots: PointSet, parts: Sequence[PointSet]) -> tuple[Array, Array]:
    """Return the variances of outputs within and between lots by each replicate, (rows, replicates) each."""
    count = len(deviation)
    lot_weight = lots.weights
    part_weight = np.stack([each.weights for each in parts], axis=1)[:, :, None, :]
    mean = (deviation * part_weight).sum(axis=-1)
    middle = (mean * lot_weight[:, None, :]).sum(axis=-1).reshape(count, -1).mean(axis=1)
    deviation = deviation - middle[:, None, None, None, None]
    squares = (deviation * deviation * part_weight).sum(axis=-1)
    mean = mean - middle[:, None, None, None]
    product = mean[:, :, 0] * mean[:, :, 1]
    within = (((squares[:, :, 0] + squares[:, :, 1]) / 2 - product) * lot_weight).sum(axis=-1)
    return within, (product * lot_weight).sum(axis=-1)
