"""The statistics of many rows: rows alike together, each with the bits that it has alone.

row                 a model of the output, its nominal dimensions, their limits, the greatest output allowed
rows alike          rows with the same model, dimensions, shapes of distribution and ties: one array holds them all
tie                 two dimensions that scatter and the correlation of their normal scores
batch               rows alike, few enough for one piece of work
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.schema.units import ARCMIN
from flexlash.schema.variant import Limits
from flexlash.tolerance.correlated_inputs import correlation_factor
from flexlash.tolerance.correlation import Entry
from flexlash.tolerance.cross_check import cross_checked
from flexlash.tolerance.dimension_limits import distributions
from flexlash.tolerance.distributions import Distribution, Normal
from flexlash.tolerance.engine.line_direction import Indices, Inputs
from flexlash.tolerance.engine.line_statistics import line_statistics
from flexlash.tolerance.hermite_series import value_correlation
from flexlash.tolerance.propagate import NOT_LINES
from flexlash.tolerance.row_lots import with_lots
from flexlash.tolerance.sampled_spread import SampledSpread
from flexlash.tolerance.sampling import SamplingPlan, UnitPoints
from flexlash.tolerance.sensitivity import first_order_sd, first_order_slopes, first_order_valid, worst_case
from flexlash.tolerance.spread_statistics import SpreadStatistics, exact_statistics, statistics_of

__all__ = ["FirstOrder", "RowBatch", "TolerancedRow", "batch_statistics", "batches_alike"]

_ROWS_PER_BATCH = 200
"""Rows that a worker process takes at a time."""


@dataclass(frozen=True, kw_only=True)
class TolerancedRow:
    """A row to be spread [SI]: the model of its output, entered dimensions, their limits, the greatest output allowed.

    `model` takes dimensions by name, floats or arrays of one shape. Dimensions without limits are exact. `between`
    names the dimensions that are one value for a whole lot; without it nothing is told of lots. `correlation` ties the
    normal scores of pairs of dimensions, each pair once; of those that do not both scatter it says nothing.
    """

    model: Callable[[Mapping[str, Array | float]], Array]
    nominal: Mapping[str, float]
    limits: Mapping[str, Limits]
    upper_limit: float | None = None
    between: frozenset[str] | None = None
    correlation: tuple[Entry, ...] = ()

    @cached_property
    def distributions(self) -> dict[str, Distribution]:
        """How the dimensions that scatter do so."""
        return distributions(self.limits)

    @cached_property
    def ties(self) -> tuple[Entry, ...]:
        """The correlations between dimensions that scatter."""
        scattering = self.distributions
        return tuple(tie for tie in self.correlation if tie[2] and tie[0] in scattering and tie[1] in scattering)

    @property
    def value_ties(self) -> tuple[Entry, ...]:
        """The same as Pearson's correlations of the values, which are those of the scores where both are normal."""
        return tuple((first, second, self._of_values(first, second, scores)) for first, second, scores in self.ties)

    def _of_values(self, first: str, second: str, scores: float) -> float:
        """Return a correlation of scores as that of the values, without the last digits that linear algebra moves."""
        one, other = self.distributions[first], self.distributions[second]
        if one.shape == other.shape == Normal.shape:
            return scores
        return round(value_correlation(one, other)(scores), 12)


def batches_alike(rows: Sequence[TolerancedRow]) -> Iterator[list[int]]:
    """Yield the indices of rows that are alike, each index once."""
    alike: dict[tuple[Any, ...], list[int]] = {}
    for index, row in enumerate(rows):
        shapes = tuple((name, distribution.shape) for name, distribution in row.distributions.items())
        key = row.model, tuple(row.nominal), tuple(row.limits), shapes, row.between, row.ties
        alike.setdefault(key, []).append(index)
    for indices in alike.values():
        for start in range(0, len(indices), _ROWS_PER_BATCH):
            yield indices[start : start + _ROWS_PER_BATCH]


def batch_statistics(rows: Sequence[TolerancedRow], plan: SamplingPlan) -> list[SpreadStatistics]:
    """Return the statistics of rows alike [SI]; equal plans give the same bits, in any batch and any process."""
    batch = RowBatch(rows)
    if not batch.limits:
        outputs = np.broadcast_to(batch.output(batch.centre), len(rows))
        exact = [exact_statistics(float(output), row.upper_limit) for output, row in zip(outputs, rows, strict=True)]
        return batch.with_lots(exact, plan)
    statistics: dict[int, SpreadStatistics] = {}
    notes = dict.fromkeys(range(len(rows)), "")
    if plan.method == "line":
        limit = np.array([np.nan if row.upper_limit is None else row.upper_limit for row in rows])
        for index, result in line_statistics(batch.outputs_of, Inputs.of(batch.inputs, batch.factor), limit, plan):
            if isinstance(result, SpreadStatistics):
                statistics[index] = result
            else:
                notes[index] = f"{NOT_LINES}: {result}"
    for index, note in notes.items():
        limit_of_row = rows[index].upper_limit
        if index not in statistics:
            points = plan.points("random" if plan.method == "random" else "sobol")
            spread = batch.sampled(index, points)
            statistics[index] = statistics_of(
                spread, limit_of_row, coverage=plan.coverage, note=note, shares=plan.shares
            )
        if plan.cross_check and plan.method != "random":
            plain = batch.sampled(index, plan.points("random"))
            statistics[index] = cross_checked(statistics[index], plain, limit_of_row)
    told = batch.with_lots([statistics[index] for index in notes], plan)
    return batch.with_first_order(told, plan.coverage)


@dataclass(frozen=True, kw_only=True)
class FirstOrder:
    """What the first-order sd of a row is made of [SI]: slopes at mid-limits, correlations of the values of pairs."""

    slopes: Mapping[str, float]
    ties: tuple[Entry, ...] = ()


class RowBatch:
    """Rows alike as arrays by dimension: `centre` (rows,) at mid-limits, `limits` of the dimensions that scatter.

    `inputs` are the distributions of each row's scattering dimensions; `factor` makes their correlated scores, None
    where they are independent. Raises ValueError for correlations that contradict one another.
    """

    def __init__(self, rows: Sequence[TolerancedRow]) -> None:
        self._model = rows[0].model
        self._between = rows[0].between
        self._upper_limits = [row.upper_limit for row in rows]
        self.inputs = [row.distributions for row in rows]
        self._ties = rows[0].value_ties
        ties = {(first, second): scores for first, second, scores in rows[0].ties}
        self.factor = correlation_factor(ties, "scores", self.inputs[0]) if ties else None
        limits = {name: [row.limits[name] for row in rows] for name in rows[0].limits}
        self.centre = {name: np.array([row.nominal[name] for row in rows]) for name in rows[0].nominal}
        self.centre |= {name: np.array([limit.middle for limit in column]) for name, column in limits.items()}
        self.limits = {name: limits[name] for name in self.inputs[0]}
        self._fixed = {name: values for name, values in self.centre.items() if name not in self.limits}

    def output(self, dimensions: Mapping[str, Array]) -> Array:
        """Return the output in the shape of all dimensions, also of those that have no part in it."""
        shape = np.broadcast_shapes(*(np.shape(values) for values in dimensions.values()))
        return np.broadcast_to(self._model(dimensions), shape)

    def outputs_of(self, arguments: Mapping[str, Array], rows: Indices) -> Array:
        """Return the output of some rows, one per column, with these dimensions varied."""
        return self.output({**{name: values[rows] for name, values in self._fixed.items()}, **arguments})

    def sampled(self, row: int, points: UnitPoints) -> SampledSpread:
        """Return the spread of one row at points."""

        def model(**varied: Array) -> Array:
            return self.outputs_of(varied, np.array([row]))

        return SampledSpread(model=model, inputs=self.inputs[row], points=points, factor=self.factor)

    def with_lots(self, statistics: list[SpreadStatistics], plan: SamplingPlan) -> list[SpreadStatistics]:
        """Return the rows' statistics with what lots and parts have of them, where it is said what lots share."""
        if self._between is None:
            return statistics
        inputs = Inputs.of(self.inputs, self.factor)
        return with_lots(self.outputs_of, inputs, self._between, statistics, self._upper_limits, plan=plan)

    @property
    def _estimate(self) -> dict[str, Array]:
        """The dimensions at mid-limits, those of a shifted process at its mean after any cut."""
        means = {
            name: np.array(
                [
                    inputs[name].expectation if limit.mean_shift else limit.middle
                    for inputs, limit in zip(self.inputs, column, strict=True)
                ]
            )
            for name, column in self.limits.items()
        }
        return self.centre | means

    def _about_middle(self, **varied: Array) -> Array:
        """Return the output at mid-limits with these dimensions varied."""
        return self.output({**self.centre, **varied})

    @property
    def _middle(self) -> dict[str, Array]:
        return {name: self.centre[name] for name in self.limits}

    @property
    def _sds(self) -> dict[str, Array]:
        return {name: np.array([inputs[name].standard_deviation for inputs in self.inputs]) for name in self.limits}

    def first_order(self) -> list[FirstOrder]:
        """Return what the first-order sd of each row is made of."""
        slopes = first_order_slopes(self._about_middle, self._middle, self._sds) if self.limits else {}
        return [
            FirstOrder(slopes={name: float(values[index]) for name, values in slopes.items()}, ties=self._ties)
            for index in range(len(self.inputs))
        ]

    def with_first_order(self, statistics: Sequence[SpreadStatistics], coverage: float) -> list[SpreadStatistics]:
        """Return the rows' statistics with what limits and first derivatives say beside them."""
        ends = {
            name: (np.array([limit.low for limit in column]), np.array([limit.high for limit in column]))
            for name, column in self.limits.items()
        }
        worst = worst_case(self._about_middle, ends)
        first_order = first_order_sd(self._about_middle, self._middle, self._sds, self._ties)
        low, high = (
            np.array([row.numbers[f"coverage_{end}"] for row in statistics], dtype=float) for end in ("low", "high")
        )
        interval = low / ARCMIN, high / ARCMIN
        valid = first_order_valid(self.output(self._estimate) / ARCMIN, first_order / ARCMIN, interval, coverage)
        numbers = np.stack([worst.low, worst.high, first_order], axis=1).tolist()
        swings = {name: np.stack(pair, axis=1).tolist() for name, pair in worst.swings.items()}
        return [
            replace(
                row,
                numbers={**row.numbers, **dict(zip(_FIRST_ORDER, numbers[index], strict=True))},
                texts={**row.texts, "first_order_valid": "yes" if valid[index] else "no"},
                swings={name: tuple(pairs[index]) for name, pairs in swings.items()},
            )
            for index, row in enumerate(statistics)
        ]


_FIRST_ORDER = ("worst_case_low", "worst_case_high", "first_order_sd")
