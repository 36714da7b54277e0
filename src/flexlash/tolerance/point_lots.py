"""Lots and parts of one model at points: lots are drawn, and parts in each of them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array, Quantity
from flexlash.tolerance.digital_nets import scrambled_net
from flexlash.tolerance.engine.line_crossings import NODES
from flexlash.tolerance.engine.line_direction import Indices, Inputs, RowModel, direction_of
from flexlash.tolerance.engine.line_drawing import DrawnLines
from flexlash.tolerance.engine.line_points import LINE_REPLICATES, line_net
from flexlash.tolerance.engine.line_precision import unresolved
from flexlash.tolerance.engine.line_quantiles import quantiles_of
from flexlash.tolerance.engine.line_tables import Lines
from flexlash.tolerance.engine.lot_inputs import (
    OTHERWISE,
    PARTS_ALIKE,
    PRODUCT,
    SUM,
    LotsAndParts,
    holding,
    of_rows,
    values_at,
)
from flexlash.tolerance.engine.lot_statistics import LotStatistics
from flexlash.tolerance.engine.lot_variance import PointSet, VarianceSplit, crossed_variance, split_of
from flexlash.tolerance.lots import Division, Lots, OverLimit
from flexlash.tolerance.sampling import DEFAULT_SAMPLES, REPLICATES, PointMethod, standard_error

__all__ = ["PointLots", "division_of"]

_CROSSED = 128
"""Lots, and parts in each of two sets, that each replicate crosses."""

_LOTS, _PARTS = 1 << 11, 1 << 13
"""Most lots, and most parts in each, behind a share of lots that fail."""

_LOT_OF, _PART_OF = 16, 4
"""Fewer lots than samples by these factors, and fewer parts in each, where samples are few."""

_LINES, _LINES_ALONE = 16, 1024
"""Lines through the parts of one of many lots, and of a lot that stands for all."""

_FEW = 16
"""Lots up to which a count has the error of independent draws, however even the points are."""

_ALIKE = 1.5
"""Lots more or less that may fail where all replicates count as many."""

_BLOCK = 1 << 20
_TINY = np.finfo(float).tiny

Bools = npt.NDArray[np.bool_]


def division_of(split: VarianceSplit | LotStatistics) -> Division:
    """Return the division of a single row."""
    return Division(
        within=float(split.within[0]),
        between=float(split.between[0]),
        within_error=float(split.within_error[0]),
        between_error=float(split.between_error[0]),
    )


class PointLots(Lots):
    """Lots and parts of one row at points: lots are drawn, and parts in each.

    Where the output is the sum or the product of what the lot and what the part does, one lot tells of the parts, and
    every other lot takes one output. Within a lot lines answer where they serve, else the same parts in every lot. The
    share of lots has the error of their number, and that of lots which may be on the other side of what is acceptable.
    """

    def __init__(self, split: LotsAndParts, method: PointMethod, samples: int | None, seed: int) -> None:
        self._split = split
        self._method = method
        self._seed = seed
        self._samples = DEFAULT_SAMPLES[method] if samples is None else samples

    @cached_property
    @np.errstate(all="ignore")
    def _relation(self) -> int:
        return int(self._split.relation()[0])

    @cached_property
    @np.errstate(all="ignore")
    def division(self) -> Division:
        """How the standard deviation is divided."""
        if self._relation in {SUM, PRODUCT}:
            return self._separate_division()
        lots = self._points(self._split.lots, 0, _CROSSED)
        parts = [self._points(self._split.parts, stream, _CROSSED) for stream in (1, 2)]
        weights = np.full((REPLICATES, _CROSSED), 1 / _CROSSED)
        first, *others = (PointSet(values=values, weights=weights) for values in (lots, *parts))
        return division_of(crossed_variance(self._split, first, others))

    def _separate_division(self) -> Division:
        """Return the division of a sum or a product by the variances of lots alone and of parts alone.

        Equation: within² : between² = Var h : Var g for a sum g + h; for a product v_h (1 + v_g) : v_g, v = Var/E²
        """
        parts = self._alone(self._split.parts, _each(self._samples))
        between, within = (self._variances(alone) for alone in (self._lots_alone, parts))
        if self._relation == PRODUCT:
            within = within * (1 + between.mean())
        return division_of(
            split_of(
                *(np.array([each]) for each in (within.mean(), between.mean())),
                *(np.array([standard_error(each)]) for each in (within, between)),
            )
        )

    def _variances(self, alone: Array) -> Array:
        """Return the variance of one kind of inputs by each replicate, of a product over the squared mean."""
        middle = alone.mean()
        size = middle if self._relation == PRODUCT else 1.0
        return np.asarray((((alone - middle) / size) ** 2).mean(axis=1))

    @cached_property
    def _lots_alone(self) -> Array:
        """The outputs (replicates, count) of lots, parts at their medians."""
        return self._alone(self._split.lots, _each(self._samples))

    def _alone(self, inputs: Inputs, count: int) -> Array:
        """Return the outputs (replicates, count) of one kind of inputs, the others at their medians."""
        lots = inputs is self._split.lots
        model = self._split.lots_alone if lots else self._split.parts_alone
        points = self._points(inputs, 0 if lots else 1, count)
        columns = {name: values.reshape(-1, 1) for name, values in points.items()}
        return _finite(model(columns, np.zeros(1, dtype=np.intp))).reshape(REPLICATES, count)

    def _points(self, inputs: Inputs, stream: int, count: int) -> dict[str, Array]:
        """Return inputs at points by name, (1, replicates, count) each; each stream has its own."""
        scores = _normal_scores(self._method, len(inputs.names), count, (self._seed, stream))
        return values_at(inputs, scores, (1, REPLICATES, count))

    @np.errstate(all="ignore")
    def failing(self, limit: float, acceptable: float, over: OverLimit) -> tuple[float, float]:  # noqa: ARG002
        """Return the share of lots with more than the acceptable share over a limit, and its standard error."""
        if acceptable >= 1:
            return 0.0, 0.0
        score = None if self._relation == OTHERWISE else self._separate_scores(limit, acceptable)
        if score is None:
            score = self._nested_scores(limit, acceptable)
        fails = (score > 0).reshape(REPLICATES, -1)
        error = max(float(standard_error(fails.mean(axis=1))), _ALIKE / fails.size)
        if self._method == "random" or min(fails.sum(), fails.size - fails.sum()) < _FEW:
            error = float(_counted(float(fails.sum()), fails.size))
        return float(fails.mean()), math.hypot(error, float(ndtr(-np.abs(score)).mean()))

    def _separate_scores(self, limit: float, acceptable: float) -> Array | None:
        """Return how far beyond the limit each lot's quantile is, in standard errors; None where they tell no quantile.

        Equation: q(l) = g(l) + q(l₀) − g(l₀) for a sum, g(l) q(l₀)/g(l₀) for a product, l₀ the lot at the medians
        """
        centre, quantile, error = float(self._split.at_medians()[0]), np.zeros(1), np.zeros(1)
        if self._relation == PARTS_ALIKE:
            quantile = np.array([centre])
        else:
            quantile, error, (sound,) = self._by_lines(self._split.parts_alone, 1, acceptable)
            if not sound:
                return None
        lots = self._lots_alone
        if self._relation != PRODUCT:
            return _scores(lots + (quantile - centre) - limit, error)
        if min((lots / centre).min(), quantile[0] / centre) <= 0:
            # Where a factor is negative the greatest outputs are those of the other's least values.
            return None
        return _scores(lots * (quantile / centre) - limit, np.abs(lots / centre) * error)

    def _nested_scores(self, limit: float, acceptable: float) -> Array:
        """Return how far beyond what is acceptable each of some lots is, in standard errors, by parts in each."""
        total = REPLICATES * _each(min(self._samples // _LOT_OF, _LOTS))
        points = self._points(self._split.lots, 0, total // REPLICATES)
        lots = {name: values.ravel() for name, values in points.items()}
        model = holding(self._split.model, lots, np.zeros(total, dtype=np.intp))
        quantile, error, sound = self._by_lines(model, total, acceptable)
        score = _scores(quantile - limit, error)
        others = np.flatnonzero(~sound)
        if len(others):
            score[others] = self._by_points(of_rows(model, others), len(others), limit, acceptable)
        return score

    def _by_lines(self, model: RowModel, lots: int, acceptable: float) -> tuple[Array, Array, Bools]:
        """Return the quantile of each lot by lines, its standard error, and whether they serve."""
        parts = self._split.parts.take(np.zeros(lots, dtype=np.intp))
        direction = direction_of(model, parts)
        number = LINE_REPLICATES if len(parts.names) == 1 else _LINES if lots > 1 else _LINES_ALONE
        net = line_net(self._seed, len(parts.names) - 1, number, single_curved=parts.single_curved)
        quantile, error, sound = np.zeros(lots), np.zeros(lots), np.zeros(lots, dtype=bool)
        for some in _blocks(np.flatnonzero((direction.vector != 0).any(axis=0)), number * len(NODES)):
            lines = Lines(of_rows(model, some), parts.take(some), direction.take(some), net)
            found = quantiles_of(DrawnLines(lines=lines), np.array([1 - acceptable]))
            quantile[some], error[some] = found.output[0], found.output_error[0]
            sound[some] = (lines.faults == 0) & ~unresolved(lines, found) & np.isfinite(quantile[some] + error[some])
        return quantile, error, sound

    def _by_points(self, model: RowModel, lots: int, limit: float, acceptable: float) -> Array:
        """Return how far beyond what is acceptable the share of parts in each lot is, in standard errors.

        Raises ValueError for a model that returns a number that is not finite.
        """
        count = _each(min(self._samples // _PART_OF, _PARTS))
        parts = {name: values.reshape(-1, 1) for name, values in self._points(self._split.parts, 4, count).items()}
        total = REPLICATES * count
        over = np.empty(lots)
        for some in _blocks(np.arange(lots), total):
            output = _finite(of_rows(model, some)(parts, np.arange(len(some))))
            over[some] = (output > limit).sum(axis=0)
        return np.asarray((over / total - acceptable) / _counted(over, total))


@lru_cache(maxsize=4)
def _normal_scores(method: PointMethod, width: int, count: int, stream: tuple[int, int]) -> Array:
    """Return scores (width, replicates × count, 1) of points, which rows share; a stream is a seed and a number."""
    seed, number = stream
    generator = np.random.default_rng([seed, count, number])
    shape = width, REPLICATES, count
    points = scrambled_net(*shape, generator) if method == "sobol" else generator.random(shape)
    scores = np.asarray(ndtri(np.clip(points, 2.0**-53, 1 - 2.0**-53))).reshape(width, -1, 1)
    scores.setflags(write=False)
    return scores


def _scores(apart: Array, error: Array) -> Array:
    """Return differences in their standard errors, both flat."""
    return np.asarray(apart.ravel() / np.maximum(error, _TINY).ravel())


def _finite(outputs: Array) -> Array:
    """Return outputs; raise ValueError for a number that is not finite."""
    if not np.isfinite(outputs).all():
        raise ValueError("the model returned a number that is not finite within the range of its inputs")
    return outputs


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
