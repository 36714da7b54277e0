"""The spread of many rows, here or in worker processes: rows alike together, the same numbers either way."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.schema.units import ARCMIN
from flexlash.tolerance.cross_check import cross_checked
from flexlash.tolerance.dimension_limits import distributions
from flexlash.tolerance.engine.line_direction import Inputs, Rows
from flexlash.tolerance.engine.line_statistics import line_statistics, statistics_of
from flexlash.tolerance.propagate import NOT_LINES
from flexlash.tolerance.sampled_spread import SampledSpread
from flexlash.tolerance.sampling import UnitPoints
from flexlash.tolerance.sensitivity import first_order_sd, first_order_valid, worst_case
from flexlash.tolerance.spread_statistics import PERCENTILES, SamplingPlan, SpreadStatistics, Task
from flexlash.workers import mapped

__all__ = ["RowsAlike", "batch_statistics", "spread_rows"]

WORTH_A_WORKER = 1000
"""Rows per worker below which starting it costs more than it saves."""

_ROWS_PER_BATCH = 200

_DRAWN: dict[SamplingPlan, SamplingPlan] = {}
"""Of this process: the draws that hold their points already."""


def spread_rows(tasks: Sequence[Task], draws: SamplingPlan, *, jobs: int) -> Iterator[tuple[int, SpreadStatistics]]:
    """Yield each row's place and spread, rows alike together, by up to `jobs` processes where there are rows enough."""
    batches = list(_batches(tasks))
    rows = [[tasks[place] for place in places] for places in batches]
    # Fresh draws, since these may hold their points already, which are not worth sending.
    of_batch = partial(spread_batch, draws=replace(draws))
    for places, spreads in zip(batches, mapped(of_batch, rows, min(jobs, len(tasks) // WORTH_A_WORKER)), strict=True):
        yield from zip(places, spreads, strict=True)


def _batches(tasks: Sequence[Task]) -> Iterator[list[int]]:
    """Yield places of rows that have the same model, dimensions and shapes of distribution."""
    alike: dict[tuple[Any, ...], list[int]] = {}
    for place, (model, nominal, limits, _) in enumerate(tasks):
        shapes = tuple((name, one.shape) for name, one in distributions(limits).items())
        alike.setdefault((model, tuple(nominal), tuple(limits), shapes), []).append(place)
    for places in alike.values():
        for start in range(0, len(places), _ROWS_PER_BATCH):
            yield places[start : start + _ROWS_PER_BATCH]


def spread_batch(tasks: Sequence[Task], draws: SamplingPlan) -> list[SpreadStatistics]:
    """Return the spreads of a batch; a process draws its points once."""
    return batch_statistics(tasks, _DRAWN.setdefault(draws, draws))


def batch_statistics(tasks: Sequence[Task], draws: SamplingPlan) -> list[SpreadStatistics]:
    """Return the spreads of rows that have the same model, dimensions and shapes of distribution."""
    rows = RowsAlike(tasks)
    if not rows.limits:
        values = np.broadcast_to(rows.backlash(rows.centre), len(tasks))
        return [_exact(float(value), limit) for value, limit in zip(values, rows.over, strict=True)]
    found: dict[int, SpreadStatistics] = {}
    notes = dict.fromkeys(range(len(tasks)), "")
    if draws.method == "line":
        limit = np.array([np.nan if one is None else one for one in rows.over])
        for row, result in line_statistics(rows.of_some, Inputs.of(rows.scatter), limit, draws):
            if isinstance(result, SpreadStatistics):
                found[row] = result
            else:
                notes[row] = f"{NOT_LINES}: {result}"
    for row, note in notes.items():
        if row not in found:
            points = draws.random if draws.method == "random" else draws.sobol
            found[row] = statistics_of(rows.sampled(row, points), rows.over[row], draws, note)
        if draws.cross_check and draws.method != "random":
            found[row] = cross_checked(found[row], rows.sampled(row, draws.random), rows.over[row])
    return rows.beside([found[row] for row in notes], draws.coverage)


class RowsAlike:
    """Rows alike, by dimension: `centre` (rows,) at mid-limits, `limits` of the dimensions that scatter."""

    def __init__(self, tasks: Sequence[Task]) -> None:
        self._model = tasks[0][0]
        self.over = [task[3] for task in tasks]
        self.scatter = [distributions(task[2]) for task in tasks]
        limits = {name: [task[2][name] for task in tasks] for name in tasks[0][2]}
        self.centre = {name: np.array([task[1][name] for task in tasks]) for name in tasks[0][1]}
        self.centre |= {name: np.array([one.middle for one in column]) for name, column in limits.items()}
        self.limits = {name: limits[name] for name in self.scatter[0]}
        self._fixed = {name: values for name, values in self.centre.items() if name not in self.limits}

    def backlash(self, dimensions: Mapping[str, Array]) -> Array:
        """Return the backlash in the shape of all dimensions, also of those that have no part in it."""
        shape = np.broadcast_shapes(*(np.shape(values) for values in dimensions.values()))
        return np.broadcast_to(self._model(dimensions), shape)

    def of_some(self, arguments: Mapping[str, Array], rows: Rows) -> Array:
        """Return the backlash of some rows, one per column, with these dimensions varied."""
        return self.backlash({**{name: values[rows] for name, values in self._fixed.items()}, **arguments})

    def sampled(self, row: int, points: UnitPoints) -> SampledSpread:
        """Return the spread of one row at points."""

        def of_row(**varying: Array) -> Array:
            return self.of_some(varying, np.array([row]))

        return SampledSpread(model=of_row, inputs=self.scatter[row], points=points)

    def beside(self, spreads: Sequence[SpreadStatistics], coverage: float) -> list[SpreadStatistics]:
        """Return the spreads with what limits and first derivatives say beside them."""

        def of_all(**varying: Array) -> Array:
            return self.backlash({**self.centre, **varying})

        ends = {
            name: (np.array([one.low for one in column]), np.array([one.high for one in column]))
            for name, column in self.limits.items()
        }
        worst = worst_case(of_all, ends)
        sds = {name: np.array([one[name].standard_deviation for one in self.scatter]) for name in self.limits}
        first_order = first_order_sd(of_all, {name: self.centre[name] for name in self.limits}, sds)
        low, high = (
            np.array([one.numbers[f"coverage_{end}"] for one in spreads], dtype=float) for end in ("low", "high")
        )
        interval = low / ARCMIN, high / ARCMIN
        valid = first_order_valid(self.backlash(self.centre) / ARCMIN, first_order / ARCMIN, interval, coverage)
        numbers = np.stack([worst.low, worst.high, first_order], axis=1).tolist()
        swings = {name: np.stack(pair, axis=1).tolist() for name, pair in worst.swings.items()}
        return [
            replace(
                one,
                numbers=one.numbers | dict(zip(_BESIDE, numbers[row], strict=True)),
                texts=one.texts | {"first_order_valid": "yes" if valid[row] else "no"},
                swings={name: tuple(pairs[row]) for name, pairs in swings.items()},
            )
            for row, one in enumerate(spreads)
        ]


_BESIDE = ("worst_case_low", "worst_case_high", "first_order_sd")


def _exact(value: float, limit: float | None) -> SpreadStatistics:
    """Return the spread of a variant none of whose dimensions scatters."""
    same = (*PERCENTILES, "mean", "coverage_low", "coverage_high", "worst_case_low", "worst_case_high")
    none = ("sd", "skewness", *(f"{name}_standard_error" for name in (*same[:10], "sd", "skewness")))
    statistics: dict[str, float | None] = dict.fromkeys(same, value)
    statistics |= dict.fromkeys((*none, "first_order_sd"), 0.0)
    if limit is not None:
        over = float(value > limit)
        statistics |= dict.fromkeys((f"probability_over_limit{side}" for side in ("", "_low", "_high")), over)
    return SpreadStatistics(numbers=statistics, texts={"first_order_valid": "yes"})
