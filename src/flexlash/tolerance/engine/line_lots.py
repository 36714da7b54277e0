"""Lots and parts by lines: the share of lots in which too many parts lie above a limit.

A lot fails where the output that its parts stay below with the probability 1 − a lies above the limit. This output, the
lot's quantile, is a smooth function of the lot inputs alone, so that lines through the space of the lot inputs find the
share of lots that fail, and lines through that of the part inputs the quantile in a lot.

Equation: P(p(l) > a) = P(q(l) > limit), with p(l) = P(Y > limit | l) and q(l) the quantile of Y | l at 1 − a
Valid: what keeps lines from a row is told by `FAULTS`, as for its spread.
Source: line sampling, as in `line_tables`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_direction import Indices, Inputs, LineDirection, RowModel, direction_of
from flexlash.tolerance.engine.line_drawing import DrawnLines, LineDrawing
from flexlash.tolerance.engine.line_moments import moments_of
from flexlash.tolerance.engine.line_points import LINE_REPLICATES, Net, line_net
from flexlash.tolerance.engine.line_precision import unresolved
from flexlash.tolerance.engine.line_quantiles import LineQuantiles, quantiles_at, quantiles_of
from flexlash.tolerance.engine.line_tables import STEPS, Lines
from flexlash.tolerance.engine.lot_inputs import LOTS_ALIKE, PARTS_ALIKE, PRODUCT, LotsAndParts
from flexlash.tolerance.engine.lot_variance import VarianceSplit, split_of
from flexlash.tolerance.lots import step_at

__all__ = ["FailingLots", "LineNumbers", "LotLines", "SeparableLots", "drawn_lines", "drawn_net", "worse_faults"]

_PLAIN_LINES = 64
"""Lines up to which a surrogate would take longer than all of them."""

_SIGN = 3
"""The fault of an output that falls somewhere, as a product does beyond a change of sign."""


class LineNumbers(NamedTuple):
    """How many lines pass through the lot inputs of a row, and through the part inputs."""

    lots: int
    parts: int


@dataclass(frozen=True, kw_only=True)
class FailingLots:
    """The share of lots that fail in each row, and the fault that kept lines from it; (rows,) each.

    Its standard error is made of that which the lines through the lot inputs leave and that through the part inputs.
    """

    share: Array
    lots_error: Array
    parts_error: Array
    faults: Indices

    @property
    def error(self) -> Array:
        """Standard error of the share."""
        return np.asarray(np.hypot(self.lots_error, self.parts_error))


class LotLines(ABC):
    """Lines through the lot inputs and through the part inputs of rows alike.

    The rows have one relation of lots and parts, and inputs of both kinds. `faults` (rows,) is as that of `Lines`; what
    else is read holds for the other rows.
    """

    faults: Indices

    def __init__(self, split: LotsAndParts, seed: int, lines: LineNumbers) -> None:
        self.split = split
        self.seed = seed
        self.lines = lines
        self.centre = split.at_medians()
        self._every = np.arange(split.rows)

    def _stream(self, number: int) -> int:
        """Return the seed of a stream of randomness: lines of two streams have nothing in common."""
        return int(np.random.default_rng([self.seed, number]).integers(1 << 62))

    @abstractmethod
    def variance(self) -> VarianceSplit:
        """Return how the variance of each row is split."""

    @abstractmethod
    def failing(self, limit: Array, acceptable: float) -> FailingLots:
        """Return the share of lots with more than the acceptable share of parts over the limit (rows,)."""


class SeparableLots(LotLines):
    """Rows whose output is the sum or the product of what the lot and what the part does, exact for each by itself.

    Equation: q(l) = g(l) + h at the quantile, or g(l) h
    """

    def __init__(self, split: LotsAndParts, relation: int, seed: int, lines: LineNumbers) -> None:
        super().__init__(split, seed, lines)
        self._product = relation == PRODUCT
        self._lots = self._parts = None
        self.faults = np.zeros(split.rows, dtype=np.intp)
        if relation != LOTS_ALIKE:
            self._lots = self._drawn(split.lots_alone, split.lots, 1, lines.lots)
            self.faults = self._lots.lines.faults
            if self._product:
                ends = np.stack(self._lots.lines.bounds) * self.centre
                self.faults = np.where((ends <= 0).any(axis=0) & (self.faults == 0), _SIGN, self.faults)
        if relation != PARTS_ALIKE:
            self._parts = self._drawn(split.parts_alone, split.parts, 2, lines.parts)
            self.faults = np.where(self.faults > 0, self.faults, self._parts.lines.faults)

    def _drawn(self, alone: RowModel, inputs: Inputs, stream: int, lines: int) -> DrawnLines:
        """Return lines through one kind of inputs."""
        return drawn_lines(alone, inputs, None, self._stream(stream), lines)

    def variance(self) -> VarianceSplit:
        """Return how the variance of each row is split.

        Equation: between² = Var g and within² = Var h for a sum; for a product, with v = Var/E² of each, between² ∝ v_g
            and within² ∝ v_h (1 + v_g)
        """
        between, between_error = self._variance(self._lots)
        within, within_error = self._variance(self._parts)
        if self._product:
            within, within_error = within * (1 + between), within_error * (1 + between)
        return split_of(within, between, within_error, between_error)

    def _variance(self, lines: DrawnLines | None) -> tuple[Array, Array]:
        """Return the variance over some lines, for a product over the squared mean, and its standard error."""
        if lines is None:
            return np.zeros(self.split.rows), np.zeros(self.split.rows)
        moments = moments_of(lines)
        size = np.abs(moments.mean) if self._product else np.ones(self.split.rows)
        spread = moments.sd / size
        error = 2 * spread * (moments.sd_error + (spread * moments.mean_error if self._product else 0.0)) / size
        return spread * spread, error

    def failing(self, limit: Array, acceptable: float) -> FailingLots:
        """Return the share of lots with more than the acceptable share of parts over the limit (rows,)."""
        quantile, error, faults = self.centre, np.zeros(self.split.rows), self.faults
        if self._parts is not None:
            found = quantiles_of(self._parts, np.array([1 - acceptable]))
            quantile, error = found.output[0], found.output_error[0]
            faults = worse_faults(faults, self._parts.lines, found)
        if self._lots is None:
            share, unsure = step_at(quantile - limit, error)
            return FailingLots(share=share, lots_error=np.zeros_like(share), parts_error=unsure, faults=faults)
        if self._product:
            ratio = quantile / self.centre
            faults = np.where((ratio <= 0) & (faults == 0), _SIGN, faults)
            threshold = limit / np.where(ratio > 0, ratio, 1.0)
            error = error * np.abs(threshold / np.where(ratio > 0, quantile, 1.0))
        else:
            threshold = limit - (quantile - self.centre)
        above = quantiles_at(self._lots, threshold[None])
        # What a crossing far out may still move is told as an error; only no number at all is a fault.
        faults = np.where(~np.isfinite(above.above[0]) & (faults == 0), STEPS, faults)
        return _failing(above, error, faults)


def drawn_lines(model: RowModel, inputs: Inputs, direction: LineDirection | None, seed: int, lines: int) -> DrawnLines:
    """Return lines through rows alike, in their own direction where none is given; many with their surrogates."""
    if len(inputs.names) > 1 and lines > _PLAIN_LINES:
        return LineDrawing(model, inputs, seed).drawn(np.arange(inputs.count), lines)
    direction = direction_of(model, inputs) if direction is None else direction
    return DrawnLines(lines=Lines(model, inputs, direction, drawn_net(seed, inputs, lines)))


def drawn_net(seed: int, inputs: Inputs, lines: int) -> Net:
    """Return a net across lines through inputs; one input alone has one line."""
    width = len(inputs.names) - 1
    return line_net(seed, width, lines if width else LINE_REPLICATES, single_curved=inputs.single_curved)


def _failing(above: LineQuantiles, error: Array, faults: Indices) -> FailingLots:
    """Return the share of lots beyond thresholds that are known with this standard error (rows,)."""
    return FailingLots(
        share=above.above[0],
        lots_error=above.above_error[0] + above.density[0] * above.residual[0],
        parts_error=above.density[0] * error,
        faults=faults,
    )


def worse_faults(faults: Indices, lines: Lines, found: LineQuantiles) -> Indices:
    """Return the faults, and that of steps where quantiles could not be found or are no numbers."""
    lost = unresolved(lines, found) | ~np.isfinite(found.output[0] + found.output_error[0])
    return np.where(lost & (faults == 0), STEPS, faults)
