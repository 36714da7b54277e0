"""The probability over the limit of many rows and nothing else: with the bits of their whole statistics, but sooner."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.correlated_inputs import correlation_factor
from flexlash.tolerance.correlation import Entry
from flexlash.tolerance.distributions import Distribution, Normal, Triangular, Uniform
from flexlash.tolerance.engine.line_direction import Indices, Inputs
from flexlash.tolerance.engine.line_statistics import line_probabilities
from flexlash.tolerance.limit_arrays import LimitArrays
from flexlash.tolerance.row_batches import RowBatch, TolerancedRow, batches_alike
from flexlash.tolerance.sampling import SamplingPlan

__all__ = ["SCALED_SHAPES", "OverLimit", "OverLimits", "probabilities_alike", "probabilities_over"]

SCALED_SHAPES: Mapping[str, Distribution] = {
    "normal": Normal(0.0, 1.0),
    "uniform": Uniform(0.0, 1.0),
    "triangular": Triangular(0.0, 1.0),
}
"""The distributions whose shape is the same between any limits, by their name in Tolerances."""


class OverLimit(NamedTuple):
    """The probability over the limit of a row, and the ends of its 95 % interval."""

    probability: float
    low: float
    high: float


class OverLimits(NamedTuple):
    """The same of many rows, arrays (rows,)."""

    probability: Array
    low: Array
    high: Array


def probabilities_over(rows: Sequence[TolerancedRow], plan: SamplingPlan) -> list[OverLimit]:
    """Return the probability over its limit of each row; equal plans give the bits of `batch_statistics`.

    Arguments: rows, each with a limit, in any order; a plan, of which coverage, shares and lots have no part in it.
    Raises LookupError for a row without a limit.
    """
    found: dict[int, OverLimit] = {}
    with np.errstate(all="ignore"):
        for indices in batches_alike(rows):
            found |= zip(indices, _of_batch([rows[index] for index in indices], plan), strict=True)
    return [found[index] for index in range(len(rows))]


def _of_batch(rows: Sequence[TolerancedRow], plan: SamplingPlan) -> list[OverLimit]:
    """Return the probabilities of rows alike."""
    batch = RowBatch(rows)
    limit = np.array([_limit_of(row) for row in rows])
    if not batch.limits:
        over = (np.broadcast_to(batch.output(batch.centre), limit.shape) > limit).astype(float)
        return [OverLimit(*[one] * 3) for one in over.tolist()]
    found: dict[int, OverLimit] = {}
    if plan.method == "line":
        for index, answer in line_probabilities(batch.outputs_of, Inputs.of(batch.inputs, batch.factor), limit, plan):
            if not isinstance(answer, str):
                found[index] = OverLimit(*answer)
    for index in range(len(rows)):
        if index not in found:
            spread = batch.sampled(index, plan.points("random" if plan.method == "random" else "sobol"))
            low, high = spread.probability_interval(limit[index])
            found[index] = OverLimit(spread.probability_above(limit[index]), low, high)
    return [found[index] for index in range(len(rows))]


def _limit_of(row: TolerancedRow) -> float:
    if row.upper_limit is None:
        raise LookupError("a row without a limit has no probability over it")
    return row.upper_limit


def probabilities_alike(
    model: Callable[[Mapping[str, Array | float]], Array],
    sizes: Mapping[str, Array],
    limits: Mapping[str, tuple[LimitArrays, str]],
    upper_limit: Array,
    *,
    plan: SamplingPlan,
    ties: Sequence[Entry] = (),
) -> OverLimits:
    """Return the probability over its limit of each row alike, to the bit that of `probabilities_over`.

    Nothing is made of each row by itself, which takes as long as its lines.

    Arguments: model of the output; sizes (rows,) by name; limits in the order of the inputs, none of them cut, each
        with the name of a distribution of `SCALED_SHAPES`; the greatest outputs allowed; a plan; ties between
        dimensions that scatter. NaN is returned of rows that lines do not serve.
    Valid: dimensions each of which scatters in all rows or in none.
    """
    centre = {**sizes} | {name: (one.low + one.high) / 2 for name, (one, _) in limits.items()}
    inputs = {name: (one, shape) for name, (one, shape) in limits.items() if (one.low < one.high).all()}
    if not inputs:
        over = np.asarray(np.broadcast_to(model(centre), upper_limit.shape) > upper_limit, dtype=float)
        return OverLimits(over, over, over)
    shapes = {name: SCALED_SHAPES[shape] for name, (_, shape) in inputs.items()}
    placed = [
        (one.mean, one.sd) if shape == "normal" else (one.low, one.high - one.low) for one, shape in inputs.values()
    ]
    scores = {(first, second): tie for first, second, tie in ties}
    varied = Inputs(
        names=tuple(shapes),
        shapes=tuple(shapes.values()),
        location=np.stack([location for location, _ in placed]),
        scale=np.stack([scale for _, scale in placed]),
        factor=correlation_factor(scores, "scores", shapes) if scores else None,
    )
    fixed = {name: size for name, size in centre.items() if name not in inputs}

    def outputs(arguments: Mapping[str, Array], rows: Indices) -> Array:
        all_sizes = {name: size[rows] for name, size in fixed.items()} | dict(arguments)
        shape = np.broadcast_shapes(*(np.shape(size) for size in all_sizes.values()))
        return np.broadcast_to(model(all_sizes), shape)

    found = np.full((len(upper_limit), 3), np.nan)
    with np.errstate(all="ignore"):
        for index, answer in line_probabilities(outputs, varied, upper_limit, plan):
            if not isinstance(answer, str):
                found[index] = answer
    return OverLimits(*found.T)
