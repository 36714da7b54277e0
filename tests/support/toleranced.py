"""Rows to be spread, the plan they are sampled by, and what is told of them."""

from __future__ import annotations

from flexlash.analysis.tolerance_spread import FIRST_INPUTS, LATER_INPUTS
from flexlash.tolerance.dimension_limits import Limits
from flexlash.tolerance.row_batches import TolerancedRow, batch_statistics
from flexlash.tolerance.sampling import SamplingPlan

__all__ = ["SUM", "SUM_LIMITS", "SUM_NAMES", "every_number", "plan", "row", "statistics_of_row", "total"]


def plan(method="line", samples=None, seed=0, **rest):
    """Return a plan for rows of any dimensions."""
    drawn = {"inputs": FIRST_INPUTS, "later_inputs": LATER_INPUTS}
    return SamplingPlan(method=method, samples=samples, seed=seed, **drawn, **rest)


def row(model, nominal, limits, upper_limit=None):
    """Return a row to be spread."""
    return TolerancedRow(model=model, nominal=nominal, limits=limits, upper_limit=upper_limit)


def statistics_of_row(toleranced, sampling):
    """Return the statistics of one row alone."""
    (statistics,) = batch_statistics([toleranced], sampling)
    return statistics


def every_number(statistics):
    """Return everything that is told of a row, so that == compares it to the last bit."""
    numbers = {name: value for name, value in statistics.numbers.items() if value is not None}
    shares = statistics.shares, statistics.total_shares, statistics.share_errors, statistics.total_share_errors
    return [numbers, statistics.texts, *shares, statistics.swings]


def total(dimensions):
    """Return a sum, which is normal with mean 10 and sd 3."""
    return 10.0 + dimensions["torque"] + dimensions["cylinder_length"] - dimensions["wall_thickness"]


SUM_NAMES = ("torque", "cylinder_length", "wall_thickness")
SUM_LIMITS = {name: Limits(low=-3.0 * sd, high=3.0 * sd) for name, sd in zip(SUM_NAMES, (1.0, 2.0, 2.0), strict=True)}
SUM = row(total, dict.fromkeys(SUM_NAMES, 0.0), SUM_LIMITS, 16.0)
"""A row whose output is normal with mean 10 and sd 3, its limit two sd above the mean."""
