"""The whole distribution of a row as a curve that a report can store: percentiles far into both tails.

score               quantile of the standard normal with the same probability; a normal output has a straight curve
score error         standard error of an output, as that of its score
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtr, ndtri

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_direction import Inputs
from flexlash.tolerance.engine.line_drawing import LineDrawing
from flexlash.tolerance.engine.line_quantiles import quantiles_of
from flexlash.tolerance.row_batches import RowBatch, TolerancedRow
from flexlash.tolerance.sampling import SamplingPlan
from flexlash.tolerance.spread import Spread
from flexlash.tolerance.spread_statistics import SpreadStatistics

__all__ = ["CURVE_SCORES", "HISTOGRAM_BINS", "Curve", "curve_of", "curves_of"]

_TAIL = tuple(step / 10 for step in range(31, 51))
CURVE_SCORES = (*(-score for score in reversed(_TAIL)), *(step / 5 for step in range(-15, 16)), *_TAIL)
"""Normal scores of the stored percentiles: a normal's mean ± 5 sd, so that 1 ppm lies well inside.

They are closer in the tails, where the curve of a bounded distribution bends.
"""

HISTOGRAM_BINS = 40

_HISTOGRAM_CUT = 0.0005
_SCORES = np.array(CURVE_SCORES)
_PROBABILITIES = ndtr(_SCORES)
_MEDIAN = np.array([0.5])

_TOGETHER = 1 << 11
"""Lines of rows alike that are looked at together, so that their tables fit the cache."""


@dataclass(frozen=True, kw_only=True)
class Curve:
    """Percentiles `outputs` at `CURVE_SCORES` with the standard errors of their scores, and a histogram.

    `rarest` is the least probability that the curve can tell from none. `edges` (bins + 1,) and `heights` (bins,), the
    probabilities between them, leave out a little of both tails.
    """

    outputs: Array
    score_errors: Array
    rarest: float
    edges: Array
    heights: Array


def curve_of(row: TolerancedRow, statistics: SpreadStatistics, plan: SamplingPlan) -> Curve:
    """Return a row's curve [SI] from the lines or points that its statistics come from, drawn once more.

    Where nothing scatters, all of it is one value.
    """
    return curves_of([row], [statistics], plan)[0]


def curves_of(rows: Sequence[TolerancedRow], statistics: Sequence[SpreadStatistics], plan: SamplingPlan) -> list[Curve]:
    """Return the curves of rows alike; each has the bits that it has alone."""
    batch, curves = RowBatch(rows), dict[int, Curve]()
    lines: dict[int, list[int]] = {}
    for index, one in enumerate(statistics):
        method = one.texts.get("spread_method")
        if not batch.limits:
            curves[index] = _level(one.numbers["p50"] or 0.0)
        elif method == "line":
            lines.setdefault(int(one.numbers["spread_points"] or 0), []).append(index)
        else:
            points = plan.points("random" if method == "random" else "sobol")
            curves[index] = _of_points(batch.sampled(index, points))
    for number, indices in lines.items():
        step = max(_TOGETHER // number, 1)
        for start in range(0, len(indices), step):
            some = indices[start : start + step]
            median_errors = [statistics[index].numbers["p50_standard_error"] or 0.0 for index in some]
            found = _of_lines(RowBatch([rows[index] for index in some]), number, plan.seed, median_errors)
            curves |= dict(zip(some, found, strict=True))
    return [curves[index] for index in range(len(rows))]


def _level(output: float) -> Curve:
    """Return the curve of a row that does not scatter."""
    heights = np.zeros(HISTOGRAM_BINS)
    heights[HISTOGRAM_BINS // 2] = 1.0
    return Curve(
        outputs=np.full(len(_SCORES), output),
        score_errors=np.zeros(len(_SCORES)),
        rarest=0.0,
        edges=np.full(HISTOGRAM_BINS + 1, output),
        heights=heights,
    )


@np.errstate(all="ignore")
def _of_lines(batch: RowBatch, number: int, seed: int, median_errors: Sequence[float]) -> Iterator[Curve]:
    """Yield the curves that so many lines give; their errors are widened as those of the rows' medians were."""
    drawing = LineDrawing(batch.outputs_of, Inputs.of(batch.inputs, batch.factor), seed)
    drawn = drawing.drawn(np.arange(len(batch.inputs)), number)
    quantiles, median = quantiles_of(drawn, _PROBABILITIES), quantiles_of(drawn, _MEDIAN)
    for row, (median_error, plain_error) in enumerate(zip(median_errors, median.output_error[0].tolist(), strict=True)):
        widened = median_error / plain_error if plain_error > 0 else 1.0
        yield _of_line_quantiles(quantiles.output[:, row], quantiles.output_error[:, row] * widened)


def _of_line_quantiles(outputs: Array, errors: Array) -> Curve:
    """Return the curve through the quantiles that lines give, with their standard errors."""
    low, high = np.interp(ndtri([_HISTOGRAM_CUT, 1 - _HISTOGRAM_CUT]), _SCORES, outputs).tolist()
    edges = np.linspace(low, high, HISTOGRAM_BINS + 1)
    return Curve(
        outputs=outputs,
        score_errors=_score_errors(outputs, errors),
        rarest=float(_PROBABILITIES[0]),
        edges=edges,
        heights=np.diff(ndtr(np.interp(edges, outputs, _SCORES))),
    )


def _of_points(spread: Spread) -> Curve:
    """Return the curve that points give; beyond the rarest of them it goes on in a straight line."""
    inside = np.minimum(_PROBABILITIES, 1 - _PROBABILITIES) >= 1 / spread.size
    if np.count_nonzero(inside) <= 1:
        return replace(_level(float(spread.quantile(0.5))), rarest=1 / spread.size)
    scores = _SCORES[inside]
    quantiles = spread.quantile(_PROBABILITIES[inside])
    outputs = np.interp(_SCORES, scores, quantiles)
    for beyond, end, inner in ((scores[0] > _SCORES, 0, 1), (scores[-1] < _SCORES, -1, -2)):
        slope = (quantiles[end] - quantiles[inner]) / (scores[end] - scores[inner])
        outputs[beyond] = quantiles[end] + slope * (_SCORES[beyond] - scores[end])
    errors = np.interp(_SCORES, scores, spread.standard_error(_PROBABILITIES[inside]))
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
    slope = np.gradient(outputs, _SCORES)
    return np.asarray(errors / np.where(slope > 0, slope, np.inf))
