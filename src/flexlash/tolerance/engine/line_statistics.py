"""Every statistic that the report prints: of rows alike by line sampling, of one row by points.

Statistics are named by result key without unit; a row's limit is NaN where it has none.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.capability import ppk_normal, ppk_upper
from flexlash.tolerance.engine.line_direction import Inputs, RowModel, Rows, direction_of
from flexlash.tolerance.engine.line_points import line_net, mirrored_net
from flexlash.tolerance.engine.line_quantiles import moments_of, quantiles_at, quantiles_of
from flexlash.tolerance.engine.line_shares import variance_shares
from flexlash.tolerance.engine.line_spread import (
    SETTLED,
    first_lines,
    lines_wanted,
    missed,
    share_interval,
    unsettled,
)
from flexlash.tolerance.engine.line_tables import FAULTS, NODES, STEPS, Lines
from flexlash.tolerance.spread import Spread
from flexlash.tolerance.spread_statistics import PERCENTILES, SamplingPlan, SpreadStatistics

__all__ = ["line_statistics", "statistics_of"]

_BLOCK = 1 << 16
"""Numbers of an array that leave room in the cache for a few others."""


class _Levels:
    """The probabilities whose quantiles are found on the model itself; those of `SETTLED` come first."""

    def __init__(self, coverage: float) -> None:
        self.named = PERCENTILES | {"coverage_low": (1 - coverage) / 2, "coverage_high": (1 + coverage) / 2}
        # Rounded, since (1 − 0.95)/2 is not quite 0.025.
        shares = list(dict.fromkeys(round(share, 12) for share in (*SETTLED, *self.named.values())))
        self.probabilities = np.array(shares)
        self.places = {name: shares.index(round(share, 12)) for name, share in self.named.items()}


class _Drawing:
    """Lines drawn through some of the rows at a time."""

    def __init__(self, model: RowModel, inputs: Inputs, draws: SamplingPlan) -> None:
        self._model = model
        self._inputs = inputs
        self._seed = draws.seed
        self._course = direction_of(model, inputs)

    def model(self, rows: Rows) -> RowModel:
        """Return the model of some rows."""
        return lambda arguments, chosen: self._model(arguments, rows[chosen])

    def lines(self, rows: Rows, number: int) -> Lines:
        """Return this number of lines through each of some rows."""
        net = line_net(self._seed, len(self._inputs.names) - 1, number, one_bent=self._inputs.one_bent)
        return Lines(self.model(rows), self._inputs.take(rows), self._course.take(rows), net)


def line_statistics(
    model: RowModel, inputs: Inputs, limit: Array, draws: SamplingPlan
) -> Iterator[tuple[int, SpreadStatistics | str]]:
    """Yield each row's place with its spread, or with what keeps lines from serving it.

    Rows whose precision takes more lines are drawn again with as many; what a row gets does not depend on others.
    """
    levels = _Levels(draws.coverage)
    adaptive = draws.samples is None and len(inputs.names) > 1
    with np.errstate(all="ignore"):
        drawing = _Drawing(model, inputs, draws)
        pending = [(first_lines(len(inputs.names), draws.samples), np.arange(inputs.count))]
        while pending:
            number, rows = pending.pop()
            wanted = np.full(len(rows), number)
            for block in _blocks(len(rows), number * len(NODES)):
                lines = drawing.lines(rows[block], number)
                if lines.faults.any():
                    faulty = np.flatnonzero(lines.faults)
                    yield from ((int(rows[block][row]), FAULTS[lines.faults[row]]) for row in faulty)
                    block = np.delete(block, faulty)  # noqa: PLW2901
                    if not len(block):
                        continue
                    lines = drawing.lines(rows[block], number)
                reading = _Reading(lines, levels, limit[rows[block]])
                if adaptive:
                    wanted[block] = reading.settle()
                settled = wanted[block] == number
                lost = unsettled(lines, reading.settled) & settled
                yield from ((int(row), FAULTS[STEPS]) for row in rows[block[lost]])
                done = np.flatnonzero(settled & ~lost)
                if len(done):
                    found = rows[block[done]]
                    yield from zip(found.tolist(), reading.statistics(done, drawing.model(found), draws), strict=True)
            further = wanted[wanted != number]
            pending += [(int(larger), rows[wanted == larger]) for larger in np.unique(further)[::-1]]


def _blocks(count: int, size: int) -> Iterator[Rows]:
    """Yield places of rows in blocks that fit the cache, `size` numbers a row."""
    step = max(_BLOCK // size, 1)
    for start in range(0, count, step):
        yield np.arange(start, min(start + step, count))


class _Reading:
    """What lines through some rows say of all their statistics."""

    def __init__(self, lines: Lines, levels: _Levels, limit: Array) -> None:
        self._lines = lines
        self._levels = levels
        self._limit = limit
        self._limited = np.isfinite(limit)
        self._quantiles = quantiles_of(lines, levels.probabilities)
        median = self._quantiles.output[levels.places["p50"]]
        self._over = quantiles_at(lines, np.where(self._limited, limit, median)[None]) if self._limited.any() else None
        self.settled = self._quantiles.take(len(SETTLED))
        self._margin = np.ones(lines.rows)

    def settle(self) -> Rows:
        """Return how many lines each row needs, and widen the errors of those that have them."""
        wanted, margin = lines_wanted(self._lines, self.settled, self._over, self._limited)
        self._margin = margin
        self._quantiles = self._quantiles.widened(margin)
        self._over = self._over.widened(margin) if self._over else None
        return wanted

    def statistics(self, rows: Rows, model: RowModel, draws: SamplingPlan) -> list[SpreadStatistics]:
        """Return the spreads of some of the rows, whose model this is."""
        inputs = self._lines.inputs.take(rows)
        moments = moments_of(self._lines).widened(self._margin)
        net = mirrored_net(draws.seed, len(inputs.names), self._lines.lines)
        first, total = variance_shares(model, inputs, net, moments.sd[rows] ** 2)
        numbers = self._quantile_numbers() | self._over_numbers()
        numbers |= {
            "mean": moments.mean,
            "mean_standard_error": moments.mean_error,
            "sd": moments.sd,
            "sd_standard_error": moments.sd_error,
            "skewness": moments.skewness,
            "skewness_standard_error": moments.skewness_error,
        }
        notes = missed(self.settled, moments.sd) if draws.samples is None else [""] * self._lines.rows
        columns = {name: values[rows].tolist() for name, values in numbers.items()}
        return [
            SpreadStatistics(
                numbers=_finished(dict(zip(columns, values, strict=True)), self._lines.lines),
                texts=_words("line", notes[rows[place]]),
                shares=dict(zip(inputs.names, first[:, place].tolist(), strict=True)),
                total_shares=dict(zip(inputs.names, total[:, place].tolist(), strict=True)),
            )
            for place, values in enumerate(zip(*columns.values(), strict=True))
        ]

    def _quantile_numbers(self) -> dict[str, Array]:
        """Return percentiles with their standard errors, and the coverage interval."""
        output, error = self._quantiles.output, self._quantiles.output_error
        places = self._levels.places
        numbers = {name: output[place] for name, place in places.items()}
        return numbers | {f"{name}_standard_error": error[place] for name, place in places.items()}

    def _over_numbers(self) -> dict[str, Array]:
        """Return the limit and the probability over it with its interval; NaN without a limit."""
        if self._over is None:
            return {}
        share = self._over.above[0]
        low, high = share_interval(share, self._over.above_error[0])
        named = {"": share, "_low": low, "_high": high}
        return {"limit": self._limit} | {
            f"probability_over_limit{end}": np.where(self._limited, values, np.nan) for end, values in named.items()
        }


def statistics_of(spread: Spread, limit: float | None, draws: SamplingPlan, note: str = "") -> SpreadStatistics:
    """Return the statistics of one row's spread."""
    levels = _Levels(draws.coverage)
    names, shares = list(levels.named), np.array(list(levels.named.values()))
    numbers: dict[str, float] = dict(zip(names, spread.quantile(shares).tolist(), strict=True))
    errors = spread.standard_error(shares).tolist()
    numbers |= {f"{name}_standard_error": error for name, error in zip(names, errors, strict=True)}
    for name in ("mean", "sd", "skewness"):
        numbers |= {name: getattr(spread, name), f"{name}_standard_error": getattr(spread, f"{name}_standard_error")}
    if limit is not None:
        low, high = spread.probability_interval(limit)
        numbers |= {
            "limit": limit,
            "probability_over_limit": spread.probability_above(limit),
            "probability_over_limit_low": low,
            "probability_over_limit_high": high,
        }
    return SpreadStatistics(
        numbers=_finished(numbers, spread.size),
        texts=_words(spread.method, note),
        shares=spread.shares,
        total_shares=spread.total_shares,
    )


def _finished(numbers: dict[str, float], points: int) -> dict[str, float | None]:
    """Return a row's statistics with those that follow from them, without those it has not."""
    told: dict[str, float | None] = {name: value for name, value in numbers.items() if not math.isnan(value)}
    limit = told.pop("limit", None)
    if limit is not None:
        told["ppk"] = ppk_upper(limit, numbers["p50"], numbers["p99_865"])
        told["ppk_normal"] = ppk_normal(limit, numbers["mean"], numbers["sd"])
    return told | {"spread_points": float(points)}


def _words(method: str, note: str) -> dict[str, str | None]:
    return {"spread_method": method, "spread_note": note or None}
