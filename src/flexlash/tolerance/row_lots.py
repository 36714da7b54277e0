"""Lots and parts of rows alike, beside what is kept of their spreads."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.special import ndtri

from flexlash.tolerance.engine.line_direction import Indices, Inputs, RowModel
from flexlash.tolerance.engine.lot_inputs import LotsAndParts
from flexlash.tolerance.engine.lot_statistics import lot_statistics
from flexlash.tolerance.lots import AllLots, AllParts, Division, Lots
from flexlash.tolerance.nested_lots import require_lots_apart
from flexlash.tolerance.point_lots import PointLots
from flexlash.tolerance.sampling import SamplingPlan
from flexlash.tolerance.spread_statistics import SpreadStatistics

__all__ = ["with_lots"]

_REACH = 2 * float(ndtri(0.975))
"""Standard errors that a 95 % interval spans."""


def with_lots(
    model: RowModel,
    inputs: Inputs,
    between: frozenset[str],
    statistics: Sequence[SpreadStatistics],
    limits: Sequence[float | None],
    *,
    plan: SamplingPlan,
) -> list[SpreadStatistics]:
    """Return the statistics of rows alike, with the sds within and between lots and the share of lots that fail.

    Arguments: model and inputs of rows alike; the names of the inputs that are one value for a lot; statistics and
        limit of each row, none for no limit.

    Raises ValueError where an input that is one value for a lot is correlated with one that is not.
    """
    names = frozenset(inputs.names) & between
    if not names or len(names) == len(inputs.names):
        lots: Lots = AllLots() if names else AllParts()
        return [
            _told(row, lots.division, _asked(lots, row, limit, plan))
            for row, limit in zip(statistics, limits, strict=True)
        ]
    require_lots_apart(inputs, names)
    split = LotsAndParts(model, inputs, names)
    found: dict[int, SpreadStatistics] = {}
    if plan.method == "line":
        by_lines = np.flatnonzero([row.texts["spread_method"] == "line" for row in statistics])
        found = _by_lines(split, by_lines, statistics, limits, plan)
    for index, row in enumerate(statistics):
        if index not in found:
            points = PointLots(
                split.take(np.array([index])), "random" if plan.method == "random" else "sobol", plan.samples, plan.seed
            )
            found[index] = _told(row, points.division, _asked(points, row, limits[index], plan))
    return [found[index] for index in range(len(statistics))]


def _by_lines(
    split: LotsAndParts,
    rows: Indices,
    statistics: Sequence[SpreadStatistics],
    limits: Sequence[float | None],
    plan: SamplingPlan,
) -> dict[int, SpreadStatistics]:
    """Return the statistics of those rows whose lots and parts lines tell."""
    if not len(rows):
        return {}
    limit = np.array([np.nan if limits[row] is None else limits[row] for row in rows], dtype=float)
    found = lot_statistics(split.take(rows), limit, plan.acceptable, seed=plan.seed, samples=plan.samples)
    columns = [values.tolist() for values in (found.within, found.between, found.within_error, found.between_error)]
    failing = zip(found.failing.tolist(), found.failing_error.tolist(), strict=True)
    told = {}
    for row, fault, asked, parts in zip(rows.tolist(), found.faults, failing, zip(*columns, strict=True), strict=True):
        if not fault:
            within, between, within_error, between_error = parts
            division = Division(within=within, between=between, within_error=within_error, between_error=between_error)
            told[row] = _told(statistics[row], division, None if limits[row] is None else asked)
    return told


def _asked(lots: Lots, row: SpreadStatistics, limit: float | None, plan: SamplingPlan) -> tuple[float, float] | None:
    """Return the share of lots that fail and its standard error; None without a limit."""
    if limit is None:
        return None
    probability, low, high = (
        float(row.numbers.get(f"probability_over_limit{end}") or 0.0) for end in ("", "_low", "_high")
    )
    return lots.failing(limit, plan.acceptable, lambda _: (probability, (high - low) / _REACH))


def _told(row: SpreadStatistics, division: Division, failing: tuple[float, float] | None) -> SpreadStatistics:
    """Return statistics with what lots and parts have of them; of an output without a variance only who fails."""
    sd, error = (row.numbers.get(name) for name in ("sd", "sd_standard_error"))
    numbers: dict[str, float | None] = {} if sd is None else _divided(sd, error or 0.0, division)
    if failing is not None:
        numbers |= dict(zip(("lots_failing", "lots_failing_standard_error"), failing, strict=True))
    return replace(row, numbers={**row.numbers, **numbers})


def _divided(sd: float, error: float, division: Division) -> dict[str, float | None]:
    """Return the standard deviations within and between lots, with their standard errors."""
    return {
        "within_lot_sd": division.within * sd,
        "within_lot_sd_standard_error": math.hypot(division.within * error, division.within_error * sd),
        "between_lots_sd": division.between * sd,
        "between_lots_sd_standard_error": math.hypot(division.between * error, division.between_error * sd),
    }
