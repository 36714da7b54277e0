"""The whole distribution of a row as a curve that a report can store: percentiles far into both tails."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeAlias

import numpy as np
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_spread import LineSpread
from flexlash.tolerance.row_batches import RowsAlike
from flexlash.tolerance.spread import Spread
from flexlash.tolerance.spread_statistics import SamplingPlan, SpreadStatistics, Task
from flexlash.workers import mapped

__all__ = ["CURVE_SCORES", "HISTOGRAM_BINS", "Curve", "CurveTask", "curve_of", "curves_of"]

_TAIL = tuple(step / 10 for step in range(31, 51))
CURVE_SCORES = (*(-score for score in reversed(_TAIL)), *(step / 5 for step in range(-15, 16)), *_TAIL)
"""Normal scores of the stored percentiles: a normal's mean ± 5 sd, so that 1 ppm lies well inside.

They are closer in the tails, where the curve of a bounded distribution bends.
"""

HISTOGRAM_BINS = 40

_HISTOGRAM_CUT = 0.0005
_WORTH_A_WORKER = 100_000
"""Lines or points per worker below which starting it costs more than it saves."""

CurveTask: TypeAlias = tuple[Task, SpreadStatistics]
"""A row and its spread, whose lines or points are to be drawn once more."""


@dataclass(frozen=True, kw_only=True)
class Curve:
    """Percentiles `outputs` at `CURVE_SCORES` with the standard errors of their scores, and a histogram.

    `rarest` is the least share of units that the curve can tell from none. `edges` (bins + 1,) and `heights` (bins,),
    shares of all units, leave out a little of both tails.
    """

    outputs: Array
    score_errors: Array
    rarest: float
    edges: Array
    heights: Array


def curves_of(tasks: Sequence[CurveTask], draws: SamplingPlan, *, jobs: int) -> Iterator[Curve]:
    """Yield each row's curve, from the lines or points that its spread was found by."""
    sizes = sum(int(statistics.numbers.get("spread_points") or 0) for _, statistics in tasks)
    # Fresh draws, since these may hold their points already, which are not worth sending.
    of_one = partial(curve_of, draws=replace(draws))
    yield from mapped(of_one, tasks, min(jobs, sizes // _WORTH_A_WORKER))


def curve_of(task: CurveTask, draws: SamplingPlan) -> Curve:
    """Return one row's curve; where nothing scatters, all of it is one value."""
    (model, nominal, limits, over), statistics = task
    row = RowsAlike([(model, nominal, limits, over)])
    median = statistics.numbers["p50"]
    if not row.limits or median is None:
        return _level(float(median or 0.0))
    if statistics.texts["spread_method"] == "line":
        size = int(statistics.numbers["spread_points"] or 0)
        return _of_lines(LineSpread(row.of_some, row.scatter[0], samples=size, seed=draws.seed), statistics)
    return _of_points(row.sampled(0, draws.random if statistics.texts["spread_method"] == "random" else draws.sobol))


def _level(value: float) -> Curve:
    """Return the curve of a row that does not scatter."""
    scores = np.array(CURVE_SCORES)
    heights = np.zeros(HISTOGRAM_BINS)
    heights[HISTOGRAM_BINS // 2] = 1.0
    return Curve(
        outputs=np.full(len(scores), value),
        score_errors=np.zeros(len(scores)),
        rarest=0.0,
        edges=np.full(HISTOGRAM_BINS + 1, value),
        heights=heights,
    )


def _of_lines(spread: Spread, statistics: SpreadStatistics) -> Curve:
    """Return the curve that lines give; their errors are widened as those of the row's spread were."""
    scores = np.array(CURVE_SCORES)
    shares = ndtr(scores)
    outputs = spread.quantile(shares)
    alone = spread.standard_error(0.5)
    told = statistics.numbers["p50_standard_error"] or 0.0
    errors = spread.standard_error(shares) * (told / alone if alone > 0 else 1.0)
    low, high = np.interp(ndtri([_HISTOGRAM_CUT, 1 - _HISTOGRAM_CUT]), scores, outputs).tolist()
    edges = np.linspace(low, high, HISTOGRAM_BINS + 1)
    return Curve(
        outputs=outputs,
        score_errors=_score_errors(outputs, errors),
        rarest=float(shares[0]),
        edges=edges,
        heights=np.diff(ndtr(np.interp(edges, outputs, scores))),
    )


def _of_points(spread: Spread) -> Curve:
    """Return the curve that points give; beyond the rarest of them it goes on in a straight line."""
    scores = np.array(CURVE_SCORES)
    shares = ndtr(scores)
    inside = np.minimum(shares, 1 - shares) >= 1 / spread.size
    if np.count_nonzero(inside) <= 1:
        return replace(_level(float(spread.quantile(0.5))), rarest=1 / spread.size)
    within = scores[inside]
    found = spread.quantile(shares[inside])
    outputs = np.interp(scores, within, found)
    for beyond, end, inner in ((scores < within[0], 0, 1), (scores > within[-1], -1, -2)):
        slope = (found[end] - found[inner]) / (within[end] - within[inner])
        outputs[beyond] = found[end] + slope * (scores[beyond] - within[end])
    errors = np.interp(scores, within, spread.standard_error(shares[inside]))
    edges, heights = spread.histogram(HISTOGRAM_BINS, _HISTOGRAM_CUT)
    return Curve(
        outputs=outputs,
        score_errors=_score_errors(outputs, errors),
        rarest=1 / spread.size,
        edges=edges,
        heights=heights,
    )


def _score_errors(outputs: Array, errors: Array) -> Array:
    """Return standard errors of outputs as those of their scores."""
    slope = np.gradient(outputs, np.array(CURVE_SCORES))
    return np.asarray(errors / np.where(slope > 0, slope, np.inf))
