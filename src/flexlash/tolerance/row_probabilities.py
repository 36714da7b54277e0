"""The probability over the limit of many rows and nothing else: with the bits of their whole statistics, but sooner."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from flexlash.tolerance.engine.line_direction import Inputs
from flexlash.tolerance.engine.line_statistics import line_probabilities
from flexlash.tolerance.row_batches import RowBatch, TolerancedRow, batches_alike
from flexlash.tolerance.sampling import SamplingPlan

__all__ = ["OverLimit", "probabilities_over"]


class OverLimit(NamedTuple):
    """The probability over the limit of a row, and the ends of its 95 % interval."""

    probability: float
    low: float
    high: float


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
