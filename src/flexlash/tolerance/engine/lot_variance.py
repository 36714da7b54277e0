"""How much of the variance lies between lots and how much within them, for any model: lots crossed with parts.

Each replicate has its own lots and two independent sets of parts; every lot meets all parts of both sets. Lots and
parts stand at evenly spaced, randomly shifted positions on lines along which the output changes fastest, so that what
is nearly linear is integrated nearly exactly.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_direction import Inputs, LineDirection, RowModel, direction_of, scores_across
from flexlash.tolerance.engine.line_points import LINE_REPLICATES, line_net, normal_density
from flexlash.tolerance.engine.lot_inputs import LotsAndParts
from flexlash.tolerance.sampling import standard_error

__all__ = ["PointSet", "VarianceSplit", "crossed_variance", "split_of", "variance_split"]

_POSITIONS = np.arange(-6.0, 7.0)
"""Positions along a line, shifted by up to half of their distance to both sides."""

_SPACING = 1e-6
"""Part of a standard deviation that the spacing of the positions leaves, which no replicate shows."""

_TINY = np.finfo(float).tiny
_BLOCK = 1 << 19


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
        between² = E[(m − m̄)(m' − m̄)], within² = E[(s + s')/2 − m m']
    Arguments: rows alike with lot and part inputs; lines a multiple of LINE_REPLICATES.
    Valid: any model with a variance; the positions are shifted at random, so that steps show in the errors.
    Source: Sobol' 1993, the closed index of a group of inputs; products of independent means have no bias.
    """
    groups = (split.lots, split.lots_alone), (split.parts, split.parts_alone), (split.parts, split.parts_alone)
    lots, *parts = (
        _on_lines(group, _along(alone, group), seed, lines, stream) for stream, (group, alone) in enumerate(groups)
    )
    return crossed_variance(split, lots, parts)


def crossed_variance(split: LotsAndParts, lots: PointSet, parts: Sequence[PointSet]) -> VarianceSplit:
    """Return how the variance of each row is split, by lots that are crossed with two sets of parts.

    Equation: that of `variance_split`
    Arguments: rows alike; sets of lots and of parts, independent of each other, of as many replicates.
    Valid: any model with a variance.
    Source: that of `variance_split`.
    """
    size = len(parts) * lots.weights.size * parts[0].weights.shape[1]
    step = max(_BLOCK // size, 1)
    centre = split.at_medians()
    pieces = [
        _variances(split, centre, lots, parts, slice(start, start + step)) for start in range(0, split.rows, step)
    ]
    within, between = (np.concatenate(values) for values in zip(*pieces, strict=True))
    errors = standard_error(within), standard_error(between)
    return split_of(within.mean(axis=1), between.mean(axis=1), *errors)


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
    net = line_net(int(generator.integers(1 << 62)), len(inputs.names) - 1, lines, single_curved=False)
    shift = generator.random((LINE_REPLICATES, 1, 1)) - 0.5
    position = np.broadcast_to(_POSITIONS + shift, (LINE_REPLICATES, lines // LINE_REPLICATES, len(_POSITIONS)))
    weight = normal_density(position) * net.weights.reshape(LINE_REPLICATES, -1, 1)
    weight = weight.reshape(LINE_REPLICATES, -1)
    origin = scores_across(direction, net.scores).reshape(*direction.vector.shape, LINE_REPLICATES, -1, 1)
    scores = inputs.correlated(origin + direction.vector[:, :, None, None, None] * position)
    values = {}
    for index, name in enumerate(inputs.names):
        standard = inputs.shapes[index].standard_at(scores[index].reshape(inputs.count, LINE_REPLICATES, -1))
        values[name] = inputs.location[index, :, None, None] + inputs.scale[index, :, None, None] * standard
    return PointSet(values=values, weights=weight / weight.sum(axis=1, keepdims=True))


def _variances(
    split: LotsAndParts, centre: Array, lots: PointSet, parts: Sequence[PointSet], rows: slice
) -> tuple[Array, Array]:
    """Return the variances within and between lots of some rows by each replicate, (rows, replicates) each."""
    lot_weight = lots.weights
    part_weight = np.stack([each.weights for each in parts], axis=1)[:, :, None, :]
    shape = (len(lot_weight), len(parts), lot_weight.shape[1], part_weight.shape[-1])
    varied = {name: values[rows, :, None, :, None] for name, values in lots.values.items()}
    for name in parts[0].values:
        varied[name] = np.stack([each.values[name][rows] for each in parts], axis=2)[:, :, :, None, :]
    chosen = np.arange(split.rows)[rows]
    count = len(chosen)
    columns = {name: np.broadcast_to(values, (count, *shape)).reshape(count, -1).T for name, values in varied.items()}
    deviation = np.ascontiguousarray((split.model(columns, chosen) - centre[rows]).T).reshape(count, *shape)
    mean = (deviation * part_weight).sum(axis=-1)
    middle = (mean * lot_weight[:, None, :]).sum(axis=-1).reshape(count, -1).mean(axis=1)
    deviation -= middle[:, None, None, None, None]
    squares = (deviation * deviation * part_weight).sum(axis=-1)
    mean -= middle[:, None, None, None]
    product = mean[:, :, 0] * mean[:, :, 1]
    within = (((squares[:, :, 0] + squares[:, :, 1]) / 2 - product) * lot_weight).sum(axis=-1)
    return within, (product * lot_weight).sum(axis=-1)
