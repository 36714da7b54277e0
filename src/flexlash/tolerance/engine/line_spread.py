"""Line sampling: how many lines a row needs, and the spread of one row."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.engine.line_direction import Inputs, LineDirection, RowModel, Rows, direction_of
from flexlash.tolerance.engine.line_points import LINE_REPLICATES, line_net, mirrored_net
from flexlash.tolerance.engine.line_quantiles import (
    LEAST,
    LineQuantiles,
    Moments,
    moments_of,
    normal_density,
    quantiles_at,
    quantiles_of,
)
from flexlash.tolerance.engine.line_shares import variance_shares
from flexlash.tolerance.engine.line_tables import FAULTS, STEPS, Lines
from flexlash.tolerance.spread import Spread

__all__ = [
    "FEWEST_LINES",
    "MOST_LINES",
    "PROBABILITY_PRECISION",
    "RAREST",
    "SD_PRECISION",
    "SETTLED",
    "LineSpread",
    "NoLines",
    "first_lines",
    "lines_wanted",
    "missed",
    "share_interval",
    "unsettled",
]

FEWEST_LINES = 64
MOST_LINES = 1 << 14

SETTLED = (0.00135, 0.025, 0.5, 0.975, 0.99865)
"""Probabilities whose quantiles decide how many lines are enough."""

SD_PRECISION = 1e-3
"""Standard error wanted of those quantiles, in standard deviations of the output."""

PROBABILITY_PRECISION = 0.05
"""Standard error wanted of the share over a limit, as a part of itself, down to `RAREST`."""

RAREST = 1e-9

_SMOOTH = 1e-4
"""Roughness of a table below which its quantiles need not be tried on the model before they are asked for."""

_STOPPED = 0.3
_MARGIN = 1.5
"""How much better than wanted the next number of lines should be, since errors are only estimated."""


Bools = npt.NDArray[np.bool_]


class NoLines(Exception):
    """Raised where lines do not serve a model; the argument says why."""


def first_lines(inputs: int, samples: int | None) -> int:
    """Return how many lines a row starts with; one input alone has but one line, the same in each replicate."""
    if samples is not None and samples < 1:
        raise ValueError(f"samples = {samples} must be at least 1")
    if inputs == 1:
        return LINE_REPLICATES
    wanted = FEWEST_LINES if samples is None else samples
    return LINE_REPLICATES << max(0, -(-wanted // LINE_REPLICATES) - 1).bit_length()


def lines_wanted(
    lines: Lines, settled: LineQuantiles, over: LineQuantiles | None = None, limited: Bools | None = None
) -> tuple[Rows, Array]:
    """Return how many lines the precision of each row takes, those it has where they are enough, and a margin.

    Where lines were found enough by an error that came out small by chance, it looks too small: errors are to be
    multiplied by the margin. `settled` are the quantiles at `SETTLED`; `over` the crossings (1, rows) at the limits of
    the rows `limited`.
    """
    excess = (settled.output_error / np.where(lines.scale > 0, lines.scale, 1.0)).max(axis=0) / SD_PRECISION
    if over is not None:
        rarer = np.minimum(over.above, 1 - over.above)[0]
        told = (rarer >= RAREST) & (True if limited is None else limited)
        relative = over.above_error[0] / np.where(told, rarer, 1.0) / PROBABILITY_PRECISION
        excess = np.maximum(excess, np.where(told, relative, 0.0))
    margin = 1 + _STOPPED * np.minimum(excess, 1) ** 2
    excess = excess * margin
    further = 2.0 ** np.ceil(np.log2(np.maximum(excess * _MARGIN, 2.0)))
    wanted = np.where(excess <= 1, lines.lines, np.minimum(lines.lines * further, MOST_LINES))
    return wanted.astype(np.intp), margin


def unsettled(lines: Lines, settled: LineQuantiles) -> Bools:
    """Return of which rows (rows,) the crossings could not be found, since the output has steps or dips."""
    return np.asarray((settled.residual > SD_PRECISION * lines.scale).any(axis=0))


def missed(settled: LineQuantiles, sd: Array) -> list[str]:
    """Return for each row the note that its precision was not reached, empty where it was."""
    reached = (settled.output_error / np.where(sd > 0, sd, 1.0)).max(axis=0).tolist()
    return [
        ""
        if one <= SD_PRECISION
        else f"standard errors reach {one:.2g} standard deviations, {SD_PRECISION:g} was wanted"
        for one in reached
    ]


def share_interval(share: Array, error: Array, factor: float = 1.96) -> tuple[Array, Array]:
    """Return the ends of intervals of shares, ± factor standard errors on the normal scale, never below 0."""
    inside = np.clip(share, LEAST, 1 - LEAST)
    score = ndtri(inside)
    reach = factor * error / normal_density(score)
    low, high = ndtr(score - reach), ndtr(score + reach)
    return np.where(share <= LEAST, 0.0, low), np.where(share >= 1 - LEAST, 1.0, high)


class LineSpread(Spread):
    """The spread of one row by line sampling; statistics are computed when asked for.

    Raises NoLines where lines do not serve the model.
    """

    method = "line"

    def __init__(self, model: RowModel, inputs: Mapping[str, Distribution], *, samples: int | None, seed: int) -> None:
        self._model = model
        self._inputs = Inputs.of([inputs])
        self._seed = seed
        with np.errstate(all="ignore"):
            course = direction_of(model, self._inputs)
            self.notes = ()
            self.size = first_lines(len(inputs), samples)
            self._lines = self._drawn(course)
            self._margin = np.ones(1)
            if self._lines.roughness[0] > _SMOOTH and (samples is not None or len(inputs) == 1):
                self._follow(np.array(SETTLED if len(inputs) == 1 else SETTLED[2:3]))
            while samples is None and len(inputs) > 1:
                settled = quantiles_of(self._lines, np.array(SETTLED))
                (wanted,), self._margin = lines_wanted(self._lines, settled)
                if wanted == self.size:
                    self._refuse(settled)
                    self.notes = tuple(note for note in missed(settled, self._moments.sd) if note)
                    break
                self.size = int(wanted)
                self._lines = self._drawn(course)

    def _drawn(self, course: LineDirection) -> Lines:
        """Return the lines, or raise NoLines."""
        net = line_net(self._seed, len(self._inputs.names) - 1, self.size, one_bent=self._inputs.one_bent)
        lines = Lines(self._model, self._inputs, course, net)
        if lines.faults[0]:
            raise NoLines(FAULTS[lines.faults[0]])
        return lines

    def _follow(self, probability: Array) -> None:
        """Raise NoLines where quantiles cannot be followed on the model."""
        self._refuse(quantiles_of(self._lines, probability))

    def _refuse(self, settled: LineQuantiles) -> None:
        if unsettled(self._lines, settled)[0]:
            raise NoLines(FAULTS[STEPS])

    @cached_property
    @np.errstate(all="ignore")
    def _moments(self) -> Moments:
        return moments_of(self._lines).widened(self._margin)

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

    def _quantiles(self, probability: Array) -> Array:
        return self._crossed(probability).output[:, 0]

    def _quantile_errors(self, probability: Array) -> Array:
        return self._crossed(probability).output_error[:, 0]

    @np.errstate(all="ignore")
    def _crossed(self, probability: Array) -> LineQuantiles:
        return quantiles_of(self._lines, probability).widened(self._margin)

    @np.errstate(all="ignore")
    def _shares_above(self, value: Array) -> Array:
        return quantiles_at(self._lines, value[:, None]).above[:, 0]

    @np.errstate(all="ignore")
    def _interval(self, value: float, confidence: float) -> tuple[float, float]:
        """Return an interval of the share above a value, even on the normal scale."""
        crossing = quantiles_at(self._lines, np.array([[value]])).widened(self._margin)
        low, high = share_interval(crossing.above, crossing.above_error, float(ndtri((1 + confidence) / 2)))
        return float(low[0, 0]), float(high[0, 0])

    @cached_property
    @np.errstate(all="ignore")
    def _both_shares(self) -> tuple[dict[str, float], dict[str, float]]:
        names = self._inputs.names
        net = mirrored_net(self._seed, len(names), self.size)
        first, total = variance_shares(self._model, self._inputs, net, self._moments.sd**2)
        return dict(zip(names, first[:, 0].tolist(), strict=True)), dict(zip(names, total[:, 0].tolist(), strict=True))

    @cached_property
    def shares(self) -> dict[str, float]:
        """First-order Sobol' index of each input."""
        return self._both_shares[0]

    @cached_property
    def total_shares(self) -> dict[str, float]:
        """Total Sobol' index of each input."""
        return self._both_shares[1]
