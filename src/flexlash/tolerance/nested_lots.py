"""Lots and parts of one model: by lines through the inputs of both, or by lots and parts drawn at points."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array, Quantity
from flexlash.tolerance.digital_nets import scrambled_net
from flexlash.tolerance.distributions import Distribution
from flexlash.tolerance.engine.line_direction import Indices, Inputs, RowModel, direction_of
from flexlash.tolerance.engine.line_points import LINE_REPLICATES, line_net
from flexlash.tolerance.engine.line_precision import unresolved
from flexlash.tolerance.engine.line_quantiles import quantiles_of
from flexlash.tolerance.engine.line_spread import LinesUnsuitable
from flexlash.tolerance.engine.line_tables import FAULTS, NODES, Lines
from flexlash.tolerance.engine.lot_inputs import LotsAndParts, holding, of_rows, values_at
from flexlash.tolerance.engine.lot_statistics import LotPrecision, LotStatistics, lot_statistics
from flexlash.tolerance.engine.lot_variance import PointSet, VarianceSplit, crossed_variance
from flexlash.tolerance.lots import AllLots, AllParts, Division, Lots, OverLimit
from flexlash.tolerance.sampling import DEFAULT_SAMPLES, REPLICATES, PointMethod, standard_error
from flexlash.tolerance.spread import Method

__all__ = ["NOT_LINES", "lots_of"]

NOT_LINES = "Lots by points instead of lines"

_WANTED = LotPrecision(sd=2e-4, failing=0.01, most_pairs=1 << 16)
_WANTED_FAILING = replace(_WANTED, sd=np.inf)

_CROSSED = 128
"""Lots, and parts in each of two sets, that each replicate crosses."""

_LOTS, _PARTS = 1 << 11, 1 << 13
"""Most lots, and most parts in each, behind a share of lots that fail."""

_LOT_OF, _PART_OF = 16, 4
"""Fewer lots than samples by these factors, and fewer parts in each, where samples are few."""

_LINES = 16
"""Lines through the parts of a lot, where they serve."""

_FEW = 16
"""Lots up to which a count has the error of independent draws, however even the points are."""

_BLOCK = 1 << 20

Bools = npt.NDArray[np.bool_]


def lots_of(
    model: RowModel,
    inputs: Mapping[str, Distribution],
    between: Collection[str],
    method: Method,
    *,
    samples: int | None,
    seed: int,
) -> tuple[Lots, tuple[str, ...]]:
    """Return how lots and parts divide a spread, and the notes that say why it is not by lines.

    Arguments: the model of one row, its inputs, the names of those that are one value for a lot; method, lines or
        points in all, and seed as of the spread.
    """
    if not between:
        return AllParts(), ()
    if len(between) == len(inputs):
        return AllLots(), ()
    split = LotsAndParts(model, Inputs.of([inputs]), between)
    if method != "line":
        return PointLots(split, method, samples, seed), ()
    points = PointLots(split, "sobol", None, seed)
    try:
        return LineLots(split, samples, seed, points), ()
    except LinesUnsuitable as reason:
        return points, (f"{NOT_LINES}: {reason}.",)


def _division(split: VarianceSplit | LotStatistics) -> Division:
    """Return the division of a single row."""
    return Division(
        within=float(split.within[0]),
        between=float(split.between[0]),
        within_error=float(split.within_error[0]),
        between_error=float(split.between_error[0]),
    )


class LineLots(Lots):
    """Lots and parts of one row by lines; a question that they cannot answer goes to the points.

    Raises LinesUnsuitable where lines serve for none.
    """

    def __init__(self, split: LotsAndParts, samples: int | None, seed: int, points: Lots) -> None:
        self._split = split
        self._samples = samples
        self._seed = seed
        self._points = points
        found = self._statistics(np.nan, 0.0, _WANTED)
        if found.faults[0]:
            raise LinesUnsuitable(FAULTS[found.faults[0]])
        self._division = _division(found)

    def _statistics(self, limit: float, acceptable: float, wanted: LotPrecision) -> LotStatistics:
        return lot_statistics(
            self._split, np.array([limit]), acceptable, seed=self._seed, samples=self._samples, precision=wanted
        )

    @property
    def division(self) -> Division:
        """How the standard deviation is divided."""
        return self._division

    def failing(self, limit: float, acceptable: float, over: OverLimit) -> tuple[float, float]:
        """Return the share of lots with more than the acceptable share over a limit, and its standard error."""
        if acceptable >= 1:
            return 0.0, 0.0
        found = self._statistics(limit, acceptable, _WANTED_FAILING)
        if found.faults[0]:
            return self._points.failing(limit, acceptable, over)
        return float(found.failing[0]), float(found.failing_error[0])


class PointLots(Lots):
    """Lots and parts of one row at points: lots are drawn, and parts in each.

    Within a lot lines answer where they serve, else the same parts in every lot. The share of lots has the error of
    their number, and that of lots which may be on the other side of what is acceptable.
    """

    def __init__(self, split: LotsAndParts, method: PointMethod, samples: int | None, seed: int) -> None:
        self._split = split
        self._method = method
        self._seed = seed
        self._samples = DEFAULT_SAMPLES[method] if samples is None else samples

    @cached_property
    def division(self) -> Division:
        """How the standard deviation is divided."""
        lots = self._points(self._split.lots, 0, _CROSSED)
        parts = [self._points(self._split.parts, stream, _CROSSED) for stream in (1, 2)]
        weights = np.full((REPLICATES, _CROSSED), 1 / _CROSSED)
        first, *others = (PointSet(values=values, weights=weights) for values in (lots, *parts))
        with np.errstate(all="ignore"):
            return _division(crossed_variance(self._split, first, others))

    def _points(self, inputs: Inputs, stream: int, count: int) -> dict[str, Array]:
        """Return inputs at points by name, (1, replicates, count) each; each stream has its own."""
        generator = np.random.default_rng([self._seed, count, stream])
        shape = len(inputs.names), REPLICATES, count
        points = scrambled_net(*shape, generator) if self._method == "sobol" else generator.random(shape)
        scores = np.asarray(ndtri(np.clip(points, 2.0**-53, 1 - 2.0**-53)))
        return values_at(inputs, scores.reshape(len(scores), -1, 1), (1, REPLICATES, count))

    @np.errstate(all="ignore")
    def failing(self, limit: float, acceptable: float, over: OverLimit) -> tuple[float, float]:  # noqa: ARG002
        """Return the share of lots with more than the acceptable share over a limit, and its standard error."""
        if acceptable >= 1:
            return 0.0, 0.0
        count = _each(min(self._samples // _LOT_OF, _LOTS))
        lots = {name: values.ravel() for name, values in self._points(self._split.lots, 3, count).items()}
        model = holding(self._split.model, lots, np.zeros(REPLICATES * count, dtype=np.intp))
        score, sound = self._by_lines(model, REPLICATES * count, limit, acceptable)
        others = np.flatnonzero(~sound)
        if len(others):
            score[others] = self._by_points(of_rows(model, others), len(others), limit, acceptable)
        fails = (score > 0).reshape(REPLICATES, count)
        error = float(standard_error(fails.mean(axis=1)))
        if self._method == "random" or min(fails.sum(), fails.size - fails.sum()) < _FEW:
            error = float(_counted(float(fails.sum()), fails.size))
        return float(fails.mean()), math.hypot(error, float(ndtr(-np.abs(score)).mean()))

    def _by_lines(self, model: RowModel, lots: int, limit: float, acceptable: float) -> tuple[Array, Bools]:
        """Return how far beyond the limit the quantile of each lot is, in standard errors, and whether lines serve."""
        parts = self._split.parts.take(np.zeros(lots, dtype=np.intp))
        direction = direction_of(model, parts)
        number = _LINES if len(parts.names) > 1 else LINE_REPLICATES
        net = line_net(self._seed, len(parts.names) - 1, number, single_curved=parts.single_curved)
        score, sound = np.zeros(lots), np.zeros(lots, dtype=bool)
        for some in _blocks(np.flatnonzero((direction.vector != 0).any(axis=0)), number * len(NODES)):
            lines = Lines(of_rows(model, some), parts.take(some), direction.take(some), net)
            found = quantiles_of(lines, np.array([1 - acceptable]))
            score[some] = (found.output[0] - limit) / np.maximum(found.output_error[0], np.finfo(float).tiny)
            sound[some] = (lines.faults == 0) & ~unresolved(lines, found) & np.isfinite(score[some])
        return score, sound

    def _by_points(self, model: RowModel, lots: int, limit: float, acceptable: float) -> Array:
        """Return how far beyond what is acceptable the share of parts in each lot is, in standard errors.

        Raises ValueError for a model that returns a number that is not finite.
        """
        count = _each(min(self._samples // _PART_OF, _PARTS))
        parts = {name: values.reshape(-1, 1) for name, values in self._points(self._split.parts, 4, count).items()}
        total = REPLICATES * count
        over = np.empty(lots)
        for some in _blocks(np.arange(lots), total):
            output = of_rows(model, some)(parts, np.arange(len(some)))
            if not np.isfinite(output).all():
                raise ValueError("the model returned a number that is not finite within the range of its inputs")
            over[some] = (output > limit).sum(axis=0)
        return np.asarray((over / total - acceptable) / _counted(over, total))


def _each(total: int) -> int:
    """Return a power of two of points in each replicate, about as many as this in all."""
    return 1 << max(0, -(-total // REPLICATES) - 1).bit_length()


def _counted(count: Quantity, total: int) -> Quantity:
    """Return the standard error of the share of some of `total` independent draws.

    Equation: √(p (1 − p)/(n + 4)), p = (count + 2)/(n + 4)
    Arguments: whole numbers, an array or one.
    Valid: any count, 0 too.
    Source: Agresti and Coull 1998.
    """
    share = (count + 2) / (total + 4)
    return (share * (1 - share) / (total + 4)) ** 0.5


def _blocks(lots: Indices, size: int) -> Iterator[Indices]:
    """Yield lots in blocks that fit the memory, `size` numbers each."""
    step = max(_BLOCK // size, 1)
    for start in range(0, len(lots), step):
        yield lots[start : start + step]
