"""The statistics of many rows alike by line sampling, as many lines for each row as its precision takes.

Statistics are named by result key without unit; a row's limit is NaN where it has none.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TypeAlias, TypeVar

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_crossings import NODES
from flexlash.tolerance.engine.line_direction import Indices, Inputs, RowModel
from flexlash.tolerance.engine.line_drawing import DrawnLines, LineDrawing
from flexlash.tolerance.engine.line_moments import moments_of
from flexlash.tolerance.engine.line_precision import (
    DECISIVE,
    FEWEST_ROW_LINES,
    initial_lines,
    lines_needed,
    precision_notes,
    unresolved,
)
from flexlash.tolerance.engine.line_quantiles import probability_interval, quantiles_at, quantiles_of
from flexlash.tolerance.engine.line_shares import line_shares
from flexlash.tolerance.engine.line_tables import FAULTS, STEPS
from flexlash.tolerance.sampling import SamplingPlan
from flexlash.tolerance.spread_statistics import SpreadStatistics, named_probabilities
from flexlash.tolerance.variance_shares import VarianceShares

__all__ = ["line_probabilities", "line_statistics"]

_BLOCK = 1 << 16
"""Numbers of an array that leave room in the cache for a few others."""


Answer = TypeVar("Answer")


def line_statistics(
    model: RowModel, inputs: Inputs, limit: Array, plan: SamplingPlan
) -> Iterator[tuple[int, SpreadStatistics | str]]:
    """Yield each row's index with its statistics, or with what keeps lines from serving it.

    Rows whose precision takes more lines are drawn again with as many; what a row gets does not depend on others.

    Arguments: model and inputs of rows alike; limit (rows,) in the unit of the output, NaN for none.
    """

    def statistics(reading: _Reading, rows: Indices, own: Indices, drawing: LineDrawing) -> list[SpreadStatistics]:
        return reading.statistics(rows, own, drawing, plan)

    return _answers(model, inputs, limit, plan, (_Levels(named_probabilities(plan.coverage)), statistics))


def line_probabilities(
    model: RowModel, inputs: Inputs, limit: Array, plan: SamplingPlan
) -> Iterator[tuple[int, tuple[float, float, float] | str]]:
    """Yield each row's index with its probability over the limit and the ends of its interval, to the bit as above.

    Nothing else is asked of the lines, which takes about a third of the time.

    Arguments: as of `line_statistics`; limit (rows,) all finite.
    """

    def over(reading: _Reading, rows: Indices, _: Indices, __: LineDrawing) -> list[tuple[float, float, float]]:
        return reading.over(rows)

    return _answers(model, inputs, limit, plan, (_Levels({}), over))


def _answers(
    model: RowModel, inputs: Inputs, limit: Array, plan: SamplingPlan, question: tuple[_Levels, _Asked[Answer]]
) -> Iterator[tuple[int, Answer | str]]:
    """Yield each row's index with what is asked of as many lines as it takes, or with what keeps lines from it."""
    levels, asked = question
    adaptive = plan.samples is None and len(inputs.names) > 1
    with np.errstate(all="ignore"):
        drawing = LineDrawing(model, inputs, plan.seed)
        pending = [(initial_lines(len(inputs.names), plan.samples, FEWEST_ROW_LINES), np.arange(inputs.count))]
        while pending:
            number, rows = pending.pop()
            needed = np.full(len(rows), number)
            for block in _blocks(len(rows), number * len(NODES)):
                drawn = drawing.drawn(rows[block], number)
                if drawn.lines.faults.any():
                    faulty = np.flatnonzero(drawn.lines.faults)
                    yield from ((int(rows[block][row]), FAULTS[drawn.lines.faults[row]]) for row in faulty)
                    block = np.delete(block, faulty)  # noqa: PLW2901
                    if not len(block):
                        continue
                    drawn = drawing.drawn(rows[block], number)
                reading = _Reading(drawn, levels, limit[rows[block]])
                if adaptive:
                    needed[block] = reading.refine(plan.bounds)
                enough = needed[block] == number
                lost = unresolved(drawn.lines, reading.decisive) & enough
                yield from ((int(row), FAULTS[STEPS]) for row in rows[block[lost]])
                finished = np.flatnonzero(enough & ~lost)
                if len(finished):
                    own = rows[block[finished]]
                    yield from zip(own.tolist(), asked(reading, finished, own, drawing), strict=True)
            further = needed[needed != number]
            pending += [(int(larger), rows[needed == larger]) for larger in np.unique(further)[::-1]]


def _blocks(count: int, size: int) -> Iterator[Indices]:
    """Yield the indices of rows in blocks that fit the cache, `size` numbers a row."""
    step = max(_BLOCK // size, 1)
    for start in range(0, count, step):
        yield np.arange(start, min(start + step, count))


class _Levels:
    """The probabilities whose quantiles are found on the model itself; those of `DECISIVE` come first."""

    def __init__(self, named: Mapping[str, float]) -> None:
        # Rounded, since (1 − 0.95)/2 is not quite 0.025.
        levels = list(dict.fromkeys(round(probability, 12) for probability in (*DECISIVE, *named.values())))
        self.probabilities = np.array(levels)
        self.index = {name: levels.index(round(probability, 12)) for name, probability in named.items()}


class _Reading:
    """What lines through some rows say of all their statistics."""

    def __init__(self, drawn: DrawnLines, levels: _Levels, limit: Array) -> None:
        self._drawn = drawn
        self._lines = lines = drawn.lines
        self._levels = levels
        self._limit = limit
        self._limited = np.isfinite(limit)
        self._quantiles = quantiles_of(drawn, levels.probabilities)
        median = self._quantiles.output[DECISIVE.index(0.5)]
        self._over = quantiles_at(drawn, np.where(self._limited, limit, median)[None]) if self._limited.any() else None
        self.decisive = self._quantiles.take(len(DECISIVE))
        self._margin = np.ones(lines.rows)

    def refine(self, bounds: Sequence[float]) -> Indices:
        """Return how many lines each row needs, and widen the errors of those that have them.

        `bounds` are the shares over the limit at which a verdict changes.
        """
        needed, margin = lines_needed(self._lines, self.decisive, self._over, self._limited, bounds)
        self._margin = margin
        self._quantiles = self._quantiles.widened(margin)
        self._over = self._over.widened(margin) if self._over else None
        return needed

    def statistics(
        self, rows: Indices, drawn: Indices, drawing: LineDrawing, plan: SamplingPlan
    ) -> list[SpreadStatistics]:
        """Return the statistics of some of the rows, which are these ones of the drawing."""
        inputs = self._lines.inputs.take(rows)
        moments = moments_of(self._drawn).widened(self._margin)
        variance = moments.sd[rows] ** 2, 2 * moments.sd[rows] * moments.sd_error[rows]
        shares, names = np.empty((4, 0, len(rows))), inputs.names if plan.shares else ()
        if plan.shares:
            shares = line_shares(drawing.model(drawn), inputs, variance, plan.seed, drawing.surrogate(drawn))
        numbers = self._quantile_numbers() | self._over_numbers()
        numbers |= {
            "mean": moments.mean,
            "mean_standard_error": moments.mean_error,
            "sd": moments.sd,
            "sd_standard_error": moments.sd_error,
            "skewness": moments.skewness,
            "skewness_standard_error": moments.skewness_error,
            "kurtosis": moments.kurtosis,
            "kurtosis_standard_error": moments.kurtosis_error,
        }
        notes = precision_notes(self.decisive, moments.sd) if plan.samples is None else [""] * self._lines.rows
        columns = {name: values[rows].tolist() for name, values in numbers.items()}
        limits = [None if math.isnan(limit) else limit for limit in self._limit[rows].tolist()]
        return [
            SpreadStatistics.of(
                dict(zip(columns, values, strict=True)),
                limit=limits[index],
                method="line",
                size=self._lines.lines,
                note=notes[rows[index]],
                shares=VarianceShares.of(names, shares[:, :, index]),
            )
            for index, values in enumerate(zip(*columns.values(), strict=True))
        ]

    def over(self, rows: Indices) -> list[tuple[float, float, float]]:
        """Return the probabilities over the limits of some rows, and the ends of their intervals."""
        values = zip(*(numbers[rows].tolist() for numbers in self._over_numbers().values()), strict=True)
        return [(probability, low, high) for probability, low, high in values]

    def _quantile_numbers(self) -> dict[str, Array]:
        """Return percentiles with their standard errors, and the coverage interval."""
        output, error = self._quantiles.output, self._quantiles.output_error
        numbers = {name: output[index] for name, index in self._levels.index.items()}
        return numbers | {f"{name}_standard_error": error[index] for name, index in self._levels.index.items()}

    def _over_numbers(self) -> dict[str, Array]:
        """Return the probability over the limit with its interval; NaN without a limit."""
        if self._over is None:
            return {}
        above = self._over.above[0]
        low, high = probability_interval(above, self._over.above_error[0])
        ends = {"": above, "_low": low, "_high": high}
        return {f"probability_over_limit{end}": np.where(self._limited, values, np.nan) for end, values in ends.items()}


_Asked: TypeAlias = Callable[[_Reading, Indices, Indices, LineDrawing], list[Answer]]
"""What is asked of a reading: of some of its rows, which are these ones of the drawing."""
