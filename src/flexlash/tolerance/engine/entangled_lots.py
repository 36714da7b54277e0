"""Lots and parts that act together otherwise than by a sum or a product: each lot has a quantile of its own.

Equation: P(q > limit) = P(y > limit) + mean over few lines of Φ(−t_q) − Φ(−t_y), with q(l) the quantile of the parts in
    lot l and y(l) the output with the parts at their design point, which is near to q and costs one output
Valid: outputs that rise along lines through the lot inputs, and in each lot along those through the part inputs.
Source: line sampling, as in `line_lots`; the quantile at a fixed design point is that of first-order reliability
    (Hasofer and Lind 1974), whose slopes at the medians are the quantile's; as a control variate it adds no bias.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_crossings import FAR, NODES
from flexlash.tolerance.engine.line_direction import Indices, Inputs, LineDirection, RowModel, direction_of
from flexlash.tolerance.engine.line_drawing import DrawnLines
from flexlash.tolerance.engine.line_lots import FailingLots, LineNumbers, LotLines, drawn_lines, drawn_net, worse_faults
from flexlash.tolerance.engine.line_points import Net
from flexlash.tolerance.engine.line_precision import MOST_LINES
from flexlash.tolerance.engine.line_quantiles import LEAST_PROBABILITY, quantiles_at, quantiles_of
from flexlash.tolerance.engine.line_tables import STEPS, Lines
from flexlash.tolerance.engine.lot_inputs import LotsAndParts, holding
from flexlash.tolerance.engine.lot_variance import VarianceSplit, variance_split

__all__ = ["EntangledLots"]

_BLOCK = 1 << 21
"""Numbers of the tables through lots that are held at once."""

_CHEAPER = 16
"""How many times more lines the output at the parts' design point takes than the quantiles of lots."""

_EXACT, _SLOPE_ERROR, _ROUNDS = 1e-3, 0.1, 8
"""Part of the share of lots by which it may still move, what a secant leaves of that, and most secants."""

_APART, _FARTHEST = 1e-6, 1.0
"""Least distance of two positions between which a slope is taken, and the farthest that a crossing moves at once."""

_NO_GRADIENT = 1
"""The fault of an output without a gradient."""


class EntangledLots(LotLines):
    """Rows in which lots and parts act together otherwise: crossings are corrected with the lots' own quantiles.

    The same lines through the part inputs serve every lot, so that the quantile is smooth over the lots.
    """

    def __init__(self, split: LotsAndParts, seed: int, lines: LineNumbers) -> None:
        super().__init__(split, seed, lines)
        self._lot_direction = direction_of(split.lots_alone, split.lots)
        self._part_direction = direction_of(split.parts_alone, split.parts)
        self._lot_net = drawn_net(self._stream(1), split.lots, lines.lots)
        self._near_net = drawn_net(self._stream(3), split.lots, min(_CHEAPER * lines.lots, MOST_LINES))
        steady = (self._lot_direction.vector != 0).any(axis=0) & (self._part_direction.vector != 0).any(axis=0)
        self.faults = np.where(steady, 0, _NO_GRADIENT)

    def variance(self) -> VarianceSplit:
        """Return how the variance of each row is split."""
        return variance_split(self.split, self.seed, min(self.lines))

    def failing(self, limit: Array, acceptable: float) -> FailingLots:
        """Return the share of lots with more than the acceptable share of parts over the limit (rows,).

        Equation: P(q > limit) = P(y > limit) + mean over few lines of Φ(−t_q) − Φ(−t_y), y the output of the lot inputs
            with the parts at their design point, by many lines
        """
        quantiles = _LotQuantiles(
            self.split, self._part_direction, (self._stream(2), self.lines.parts), np.array([1 - acceptable])
        )
        medians = quantiles({name: values[None] for name, values in self.split.lot_medians.items()}, self._every)
        near, lots, direction = self._at_design_point(acceptable, medians[0]), self.split.lots, self._lot_direction
        many = Lines(near, lots, direction, self._near_net)
        above = quantiles_at(DrawnLines(lines=many), limit[None])
        few = (
            Lines(near, lots, direction, self._lot_net),
            _QuantileLines(near, quantiles, lots, direction, self._lot_net),
        )
        (by_near, near_left), (by_lot, left) = (_beyond(lines, limit) for lines in few)
        share = above.above[0] + few[0].mean_over_lines(by_lot - by_near)[0]
        faults = np.maximum(np.maximum(many.faults, few[0].faults), quantiles.faults)
        faults = np.where(self.faults > 0, self.faults, faults)
        error = np.hypot(above.above_error, few[0].standard_error(by_lot - by_near))[0]
        return FailingLots(
            share=np.clip(share, 0.0, 1.0),
            lots_error=error + above.density[0] * above.residual[0] + near_left + left,
            parts_error=above.density[0] * quantiles.errors.reshape(len(limit), -1).mean(axis=1),
            faults=np.where(~np.isfinite(share + error) & (faults == 0), STEPS, faults),
        )

    def _at_design_point(self, acceptable: float, quantile: Array) -> RowModel:
        """Return the output of the lot inputs with the parts at their design point, moved to the medians' quantile.

        Equation: y(l) = Y(l, p*) + q(l₀) − Y(l₀, p*), p* at the score Φ⁻¹(1 − a) α in the direction α of the parts
        """
        score = float(ndtri(np.clip(1 - acceptable, LEAST_PROBABILITY, 1 - LEAST_PROBABILITY)))
        scores = self.split.parts.correlated(score * self._part_direction.vector)
        parts = {
            name: self.split.parts.location[index]
            + self.split.parts.scale[index] * self.split.parts.shapes[index].standard_at(scores[index])
            for index, name in enumerate(self.split.parts.names)
        }
        fixed = holding(self.split.model, parts, self._every)
        medians = fixed({name: values[None] for name, values in self.split.lot_medians.items()}, self._every)[0]
        return lambda arguments, rows: fixed(arguments, rows) + (quantile - medians)[rows]


class _LotQuantiles:
    """The model of a lot's quantile: an output that depends on the lot inputs alone.

    `errors` are the standard errors that it was last found with; `faults` (rows,) tells what kept lines from any lot.
    """

    def __init__(
        self, split: LotsAndParts, direction: LineDirection, sampling: tuple[int, int], probability: Array
    ) -> None:
        self._split = split
        self._direction = direction
        self._seed, self._lines = sampling
        self._probability = probability
        self.errors = np.zeros(0)
        self.faults = np.zeros(split.rows, dtype=np.intp)

    def __call__(self, arguments: Mapping[str, Array], rows: Indices) -> Array:
        """Return the quantiles in lots (k, columns) by name; each column belongs to the row of its index."""
        shape = next(iter(arguments.values())).shape
        lots = {name: values.reshape(-1) for name, values in arguments.items()}
        every = np.broadcast_to(rows, shape).reshape(-1)
        step = max(_BLOCK // (len(NODES) * self._lines), 1)
        pieces = [self._quantiles(lots, every, slice(start, start + step)) for start in range(0, len(every), step)]
        quantiles, errors = (np.concatenate(values) for values in zip(*pieces, strict=True))
        self.errors = errors
        return np.asarray(quantiles).reshape(shape)

    def _quantiles(self, lots: Mapping[str, Array], rows: Indices, chosen: slice) -> tuple[Array, Array]:
        """Return the quantiles and their standard errors in some lots, (n,) each."""
        rows = rows[chosen]
        model = holding(self._split.model, {name: values[chosen] for name, values in lots.items()}, rows)
        parts, direction = self._split.parts.take(rows), self._direction.take(rows)
        drawn = drawn_lines(model, parts, direction, self._seed, self._lines)
        found = quantiles_of(drawn, self._probability)
        faults = worse_faults(drawn.lines.faults, drawn.lines, found)
        np.maximum.at(self.faults, rows, faults)
        return found.output[0], found.output_error[0]


class _QuantileLines(Lines):
    """Lines tabulated by a model that is near to another one, on which their crossings are corrected."""

    def __init__(self, near: RowModel, exact: RowModel, inputs: Inputs, direction: LineDirection, net: Net) -> None:
        super().__init__(near, inputs, direction, net)
        self._model = exact


def _beyond(lines: Lines, limit: Array) -> tuple[Array, Array]:
    """Return the part of each line that lies above limits (rows,), (1, rows × lines), and what is left of its mean.

    Equation: Φ(−t), t by secants on the lines' own model
    """
    output = lines.each(limit[None])
    position, slope = lines.crossings(output)
    before, left = None, np.zeros(len(limit))
    for _ in range(_ROUNDS):
        reached = lines.outputs(position)
        if before is not None:
            moved = position - before[0]
            apart = np.abs(moved) > _APART
            secant = (reached - before[1]) / np.where(apart, moved, 1.0)
            slope = np.where(apart, np.clip(secant, 0.2 * slope, 5 * slope), slope)
        before = position, reached
        gap = np.clip((output - reached) / slope, -_FARTHEST, _FARTHEST)
        position = np.clip(position + gap, -FAR, FAR)
        above = ndtr(-position)
        left = lines.mean_over_lines(np.abs(above - ndtr(-before[0])))[0]
        share = lines.mean_over_lines(above)[0]
        if (left <= _EXACT * np.minimum(share, 1 - share) + LEAST_PROBABILITY).all():
            break
    return above, _SLOPE_ERROR * left
