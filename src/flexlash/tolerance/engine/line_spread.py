"""The spread of one model's output by line sampling."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
from scipy.special import ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.engine.line_direction import Inputs, RowModel
from flexlash.tolerance.engine.line_drawing import DrawnLines, LineDrawing
from flexlash.tolerance.engine.line_moments import Moments, moments_of
from flexlash.tolerance.engine.line_precision import (
    DECISIVE,
    initial_lines,
    lines_needed,
    precision_notes,
    unresolved,
)
from flexlash.tolerance.engine.line_quantiles import LineQuantiles, probability_interval, quantiles_at, quantiles_of
from flexlash.tolerance.engine.line_shares import line_shares
from flexlash.tolerance.engine.line_tables import FAULTS, STEPS
from flexlash.tolerance.spread import Spread
from flexlash.tolerance.variance_shares import VarianceShares

__all__ = ["LineSpread", "LinesUnsuitable"]

_SMOOTH = 1e-2
"""Roughness of a table below which its quantiles need not be tried on the model before they are asked for."""


class LinesUnsuitable(Exception):
    """Raised where lines do not serve a model; the argument says why."""


class LineSpread(Spread):
    """The spread of one row by line sampling; statistics are computed when asked for.

    Raises LinesUnsuitable where lines do not serve the model.
    """

    method = "line"

    def __init__(
        self,
        model: RowModel,
        inputs: Mapping[str, Distribution],
        *,
        samples: int | None,
        seed: int,
        factor: Array | None = None,
    ) -> None:
        self._model = model
        self._inputs = Inputs.of([inputs], factor)
        self._seed = seed
        with np.errstate(all="ignore"):
            self.notes = ()
            self.size = initial_lines(len(inputs), samples)
            self._drawing = drawing = LineDrawing(model, self._inputs, seed)
            self._drawn = self._draw(drawing)
            self._margin = np.ones(1)
            if self._drawn.lines.roughness[0] > _SMOOTH and (samples is not None or len(inputs) == 1):
                probed = np.array(DECISIVE if len(inputs) == 1 else DECISIVE[2:3])
                self._require_resolved(quantiles_of(self._drawn, probed))
            if samples is None and len(inputs) > 1:
                self._refine(drawing)

    def _refine(self, drawing: LineDrawing) -> None:
        """Draw more lines until they are enough, or raise LinesUnsuitable."""
        while True:
            decisive = quantiles_of(self._drawn, np.array(DECISIVE))
            (needed,), self._margin = lines_needed(self._drawn.lines, decisive)
            if needed == self.size:
                break
            self.size = int(needed)
            self._drawn = self._draw(drawing)
        self._require_resolved(decisive)
        self.notes = tuple(note for note in precision_notes(decisive, self._moments.sd) if note)

    def _draw(self, drawing: LineDrawing) -> DrawnLines:
        """Return the lines, or raise LinesUnsuitable."""
        drawn = drawing.drawn(np.arange(1), self.size)
        if drawn.lines.faults[0]:
            raise LinesUnsuitable(FAULTS[drawn.lines.faults[0]])
        return drawn

    def _require_resolved(self, quantiles: LineQuantiles) -> None:
        """Raise LinesUnsuitable where quantiles cannot be followed on the model."""
        if unresolved(self._drawn.lines, quantiles)[0]:
            raise LinesUnsuitable(FAULTS[STEPS])

    @cached_property
    @np.errstate(all="ignore")
    def _moments(self) -> Moments:
        return moments_of(self._drawn).widened(self._margin)

    @cached_property
    def mean(self) -> float:
        """Mean of the output."""
        return float(self._moments.mean[0])

    @cached_property
    def mean_standard_error(self) -> float:
        """Standard error of the mean."""
        return float(self._moments.mean_error[0])

    @cached_property
    def sd(self) -> float:
        """Standard deviation of the output."""
        return float(self._moments.sd[0])

    @cached_property
    def sd_standard_error(self) -> float:
        """Standard error of the standard deviation."""
        return float(self._moments.sd_error[0])

    @cached_property
    def skewness(self) -> float:
        """Third central moment over the cube of the standard deviation."""
        return float(self._moments.skewness[0])

    @cached_property
    def skewness_standard_error(self) -> float:
        """Standard error of the skewness."""
        return float(self._moments.skewness_error[0])

    @cached_property
    def kurtosis(self) -> float:
        """Excess kurtosis of the output."""
        return float(self._moments.kurtosis[0])

    @cached_property
    def kurtosis_standard_error(self) -> float:
        """Standard error of the kurtosis."""
        return float(self._moments.kurtosis_error[0])

    def _quantiles(self, probability: Array) -> Array:
        return self._line_quantiles(probability).output[:, 0]

    def _quantile_errors(self, probability: Array) -> Array:
        return self._line_quantiles(probability).output_error[:, 0]

    @np.errstate(all="ignore")
    def _line_quantiles(self, probability: Array) -> LineQuantiles:
        return quantiles_of(self._drawn, probability).widened(self._margin)

    @np.errstate(all="ignore")
    def _probabilities_above(self, value: Array) -> Array:
        return quantiles_at(self._drawn, value[:, None]).above[:, 0]

    @np.errstate(all="ignore")
    def _interval(self, value: float, confidence: float) -> tuple[float, float]:
        """Return an interval of the probability above a value, even on the normal scale."""
        quantiles = quantiles_at(self._drawn, np.array([[value]])).widened(self._margin)
        factor = float(ndtri((1 + confidence) / 2))
        low, high = probability_interval(quantiles.above, quantiles.above_error, factor)
        return float(low[0, 0]), float(high[0, 0])

    @cached_property
    @np.errstate(all="ignore")
    def variance_shares(self) -> VarianceShares:
        """First-order and total Sobol' indices with their standard errors."""
        variance = self._moments.sd**2, 2 * self._moments.sd * self._moments.sd_error
        surrogate = self._drawing.surrogate(np.arange(1))
        found = line_shares(self._model, self._inputs, variance, self._seed, surrogate)
        return VarianceShares.of(self._inputs.names, found[:, :, 0])
