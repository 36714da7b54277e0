"""Rows with measured dimensions → what the number of measured parts leaves open of their spread.

What few parts say of a process is far less sure than any calculation: the mean and the standard deviation of each
measured dimension are moved to the ends of their intervals, one at a time, and the row is spread anew.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from flexlash.analysis.measured_parameters import EndRows, ends_of, moves_of, products_of
from flexlash.tolerance.combined_uncertainty import (
    OutputNumbers,
    Parameter,
    Product,
    percentile_interval,
    probability_interval,
)
from flexlash.tolerance.row_batches import TolerancedRow, batch_statistics, batches_alike
from flexlash.tolerance.sampling import SamplingPlan
from flexlash.tolerance.spread_statistics import SpreadStatistics

__all__ = ["with_measured_uncertainty"]

_SIDES = ("low", "high")


def with_measured_uncertainty(
    rows: Sequence[TolerancedRow], statistics: Sequence[SpreadStatistics], plan: SamplingPlan
) -> list[SpreadStatistics]:
    """Return the statistics of rows [SI] with what measured parts leave open, where there are any.

    Rows are spread by lines for it, whatever the method of the plan is: points would not tell rare shares.
    """
    by_lines = plan.method == "line"
    uncertain = {index: ends for index, row in enumerate(rows) if (ends := ends_of(row))}
    work: list[TolerancedRow] = []
    for index, ends in uncertain.items():
        work += [] if by_lines else [replace(rows[index], between=None)]
        work += [row for end in ends for row in (end.at_low, end.at_high)]
    lines = replace(plan, method="line", samples=plan.samples if by_lines else None, cross_check=False, shares=False)
    found, known = iter(_spread(work, lines)), list(statistics)
    for index, ends in uncertain.items():
        first = known[index] if by_lines else next(found)
        spread = [(next(found), next(found)) for _ in ends]
        numbers = {**known[index].numbers, **_intervals(rows[index], first, ends, spread)}
        known[index] = replace(known[index], numbers=numbers)
    return known


def _spread(rows: Sequence[TolerancedRow], plan: SamplingPlan) -> list[SpreadStatistics | None]:
    """Return the statistics of rows, rows alike together; None where shapes that cannot be are reached."""
    found: dict[int, SpreadStatistics | None] = {}
    with np.errstate(all="ignore"):
        for batch in batches_alike(rows):
            try:
                found |= zip(batch, batch_statistics([rows[index] for index in batch], plan), strict=True)
            except ValueError:
                found |= {index: _alone(rows[index], plan) for index in batch}
    return [found[index] for index in range(len(rows))]


def _alone(row: TolerancedRow, plan: SamplingPlan) -> SpreadStatistics | None:
    """Return the statistics of a row whose like reach shapes that cannot be; None where it does so itself."""
    try:
        return batch_statistics([row], plan)[0]
    except ValueError:
        return None


def _intervals(
    row: TolerancedRow,
    first: SpreadStatistics | None,
    ends: Sequence[EndRows],
    spread: Sequence[tuple[SpreadStatistics | None, SpreadStatistics | None]],
) -> dict[str, float]:
    """Return the ends of the intervals of one row, of its spread as it is and with each parameter at either end.

    There are none where nothing scatters, or where a parameter's end reaches shapes that cannot be.
    """
    known = [_numbers(one) for one in (first, *(one for pair in spread for one in pair)) if one is not None]
    if len(known) <= 2 * len(spread) or not known[0].sd > 0 or not all(one.is_known for one in known):
        return {}
    output, at_ends = known[0], zip(known[1::2], known[2::2], strict=True)
    parameters = [
        Parameter(
            moves=moves,
            low=end.low,
            high=end.high,
            at_low=low,
            at_high=high,
            scatters=end.scatters,
        )
        for moves, end, (low, high) in zip(moves_of(row), ends, at_ends, strict=True)
    ]
    products = [
        Product(first=parameters[one], second=parameters[two], correlation=parameters[place], estimate=estimate)
        for one, two, place, estimate in products_of(row)
    ]
    intervals = {"p99_865": percentile_interval(output, parameters, products)}
    if output.probability is not None:
        intervals["probability_over_limit"] = probability_interval(output, parameters, products)
    return {
        f"{key}_sample_{side}": end
        for key, interval in intervals.items()
        for side, end in zip(_SIDES, interval, strict=True)
    }


def _numbers(statistics: SpreadStatistics) -> OutputNumbers:
    """Return what of a row's statistics the intervals are made of; NaN where it has none."""
    found = (statistics.numbers.get(name) for name in ("mean", "sd", "p99_865"))
    mean, sd, percentile = (math.nan if number is None else number for number in found)
    return OutputNumbers(
        mean=mean, sd=sd, percentile=percentile, probability=statistics.numbers.get("probability_over_limit")
    )
