"""Rows with measured dimensions → what the number of measured parts leaves open of their spread.

What few parts say of a process is far less sure than any calculation: the mean and the standard deviation of each
measured dimension are moved to the ends of their intervals, one at a time, and the row is spread anew.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from flexlash.schema.variant import Limits
from flexlash.tolerance.combined_uncertainty import (
    OutputNumbers,
    Parameter,
    percentile_interval,
    probability_interval,
    standard_scores,
)
from flexlash.tolerance.row_batches import TolerancedRow, batch_statistics, batches_alike
from flexlash.tolerance.sample_uncertainty import SampleUncertainty
from flexlash.tolerance.sampling import SamplingPlan
from flexlash.tolerance.spread_statistics import SpreadStatistics

__all__ = ["with_measured_uncertainty"]

_ENDS = 4
"""Rows that one measured dimension takes: mean and standard deviation at the lower and upper end."""


def with_measured_uncertainty(
    rows: Sequence[TolerancedRow], statistics: Sequence[SpreadStatistics], plan: SamplingPlan
) -> list[SpreadStatistics]:
    """Return the statistics of rows [SI] with what measured parts leave open, where there are any.

    Rows are spread by lines for it, whatever the method of the plan is: points would not tell rare shares.
    """
    by_lines = plan.method == "line"
    moved = {index: list(_moved(row, with_itself=not by_lines)) for index, row in enumerate(rows) if _measured(row)}
    lines = replace(plan, method="line", samples=plan.samples if by_lines else None, cross_check=False)
    found = iter(_spread([other for others in moved.values() for other in others], lines))
    known = list(statistics)
    for index, others in moved.items():
        ends = [next(found) for _ in others]
        first = known[index] if by_lines else ends.pop(0)
        interval = _interval(rows[index], first, ends)
        known[index] = replace(known[index], numbers={**known[index].numbers, **interval})
    return known


def _measured(row: TolerancedRow) -> dict[str, Limits]:
    """Return the limits of the dimensions that scatter as measured parts do."""
    return {name: limit for name, limit in row.limits.items() if limit.sample is not None and limit.low < limit.high}


def _uncertainty(limit: Limits) -> SampleUncertainty:
    values = limit.sample.values if limit.sample else ()
    measured = limit.distribution == "measured"
    return SampleUncertainty.of_values(values) if measured else SampleUncertainty(size=len(values))


def _moved(row: TolerancedRow, *, with_itself: bool) -> Iterator[TolerancedRow]:
    """Yield a row with each parameter of its measured dimensions at either end, before them the row as it is."""
    alone = replace(row, between=None)
    if with_itself:
        yield alone
    for name, limit in _measured(row).items():
        uncertainty, sd = _uncertainty(limit), limit.standard_deviation
        off = uncertainty.offset_end * sd
        ends = [(-off, sd), (off, sd), *((0.0, ratio * sd) for ratio in uncertainty.sd_ends)]
        for offset, end in ends:
            moved = replace(limit, mean_shift=limit.mean_shift + offset, sd=end)
            yield replace(alone, limits={**row.limits, name: moved})


def _spread(rows: Sequence[TolerancedRow], plan: SamplingPlan) -> list[SpreadStatistics]:
    """Return the statistics of rows, rows alike together."""
    found: dict[int, SpreadStatistics] = {}
    for batch in batches_alike(rows):
        found |= zip(batch, batch_statistics([rows[index] for index in batch], plan), strict=True)
    return [found[index] for index in range(len(rows))]


def _interval(row: TolerancedRow, first: SpreadStatistics, ends: Sequence[SpreadStatistics]) -> dict[str, float]:
    """Return the ends of the intervals of one row, of its spread as it is and with each parameter at either end."""
    output = _numbers(first)
    if not output.sd > 0:
        return {}
    parameters = list(_parameters(row, [_numbers(end) for end in ends]))
    intervals = {"p99_865": percentile_interval(output, parameters)}
    if output.probability is not None:
        intervals["probability_over_limit"] = probability_interval(output, parameters)
    return {
        f"{key}_sample_{end}": value for key, pair in intervals.items() for end, value in zip(_SIDES, pair, strict=True)
    }


_SIDES = ("low", "high")


def _parameters(row: TolerancedRow, ends: Sequence[OutputNumbers]) -> Iterator[Parameter]:
    """Yield mean and standard deviation of each measured dimension as parameters of the output."""
    measured = _measured(row)
    scores = standard_scores(2 * len(measured))
    for place, limit in enumerate(measured.values()):
        uncertainty = _uncertainty(limit)
        of_mean, of_sd = scores[2 * place], scores[2 * place + 1]
        of_mean = of_mean * (1 - uncertainty.tie**2) ** 0.5 + of_sd * uncertainty.tie
        ratios, (low, high) = uncertainty.sd_ratios(of_sd), uncertainty.sd_ends
        mean_low, mean_high, sd_low, sd_high = ends[_ENDS * place : _ENDS * (place + 1)]
        offset = uncertainty.offset_end
        moves = ratios * of_mean / uncertainty.size**0.5
        yield Parameter(moves=moves, low=-offset, high=offset, at_low=mean_low, at_high=mean_high, scatters=False)
        squares = low**2 - 1, high**2 - 1
        yield Parameter(
            moves=ratios**2 - 1, low=squares[0], high=squares[1], at_low=sd_low, at_high=sd_high, scatters=True
        )


def _numbers(statistics: SpreadStatistics) -> OutputNumbers:
    """Return what of a row's statistics the intervals are made of."""
    mean, sd, percentile = (statistics.numbers[name] or 0.0 for name in ("mean", "sd", "p99_865"))
    return OutputNumbers(
        mean=mean, sd=sd, percentile=percentile, probability=statistics.numbers.get("probability_over_limit")
    )
