"""Plain Monte Carlo beside another method: the same statistics twice, and whether they agree."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from flexlash.tolerance.sampled_spread import SampledSpread
from flexlash.tolerance.spread_statistics import PERCENTILES, SpreadStatistics

__all__ = ["AGREEMENT", "cross_checked"]

AGREEMENT = 4.0
"""Combined standard errors within which two methods agree."""


def cross_checked(statistics: SpreadStatistics, plain: SampledSpread, limit: float | None) -> SpreadStatistics:
    """Return a row's statistics with the numbers of plain Monte Carlo beside its own.

    Equation: cross_check_deviation = max |a − b|/√(e_a² + e_b²) over mean, sd, percentiles, probability over the limit
    Arguments: statistics of another method; the plain spread of the same row; its limit in the unit of the output.
    Valid: independent methods whose errors are close to normal.
    Source: combined standard errors.
    """
    levels = np.array(list(PERCENTILES.values()))
    values = dict(zip(PERCENTILES, plain.quantile(levels).tolist(), strict=True))
    errors = dict(zip(PERCENTILES, plain.standard_error(levels).tolist(), strict=True))
    values |= {"mean": plain.mean, "sd": plain.sd}
    errors |= {"mean": plain.mean_standard_error, "sd": plain.sd_standard_error}
    own = {name: value for name, value in statistics.numbers.items() if value is not None}
    deviations = [
        _deviation(values[name] - own[name], math.hypot(errors[name], own[f"{name}_standard_error"])) for name in values
    ]
    if limit is not None:
        over = own["probability_over_limit"]
        values["probability_over_limit"] = plain.probability_above(limit)
        # A rare probability is counted in whole draws: half a draw is the least that can be told.
        counted = max(math.sqrt(over * (1 - over) / plain.size), 0.5 / plain.size)
        width = own["probability_over_limit_high"] - own["probability_over_limit_low"]
        error = math.hypot(counted, width / (2 * 1.96))
        deviations.append(abs(values["probability_over_limit"] - over) / error)
    greatest = max(deviations)
    beside: dict[str, float | None] = {f"random_{name}": value for name, value in values.items()}
    beside |= {f"random_{name}_standard_error": error for name, error in errors.items()}
    beside |= {"cross_check_deviation": greatest, "random_points": float(plain.size)}
    agrees = "agrees" if greatest <= AGREEMENT else "differs"
    return replace(
        statistics,
        numbers={**statistics.numbers, **beside},
        texts={**statistics.texts, "cross_check": agrees},
    )


def _deviation(difference: float, error: float) -> float:
    """Return a difference in standard errors; where nothing scatters, 0 or infinitely many."""
    return abs(difference) / error if error > 0 else math.inf if difference else 0.0
