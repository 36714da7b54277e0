"""Plain Monte Carlo beside another method: the same statistics twice, and whether they agree."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.special import betainc, ndtri, stdtr

from flexlash.tolerance.engine.line_points import LINE_REPLICATES
from flexlash.tolerance.sampled_spread import SampledSpread
from flexlash.tolerance.sampling import REPLICATES, widening
from flexlash.tolerance.spread_statistics import PERCENTILES, SpreadStatistics

__all__ = ["AGREEMENT", "cross_checked", "deviation"]

AGREEMENT = 5.0
"""Standard errors within which two methods agree: right ones differ by chance in fewer than one row in 10,000.

One statistic of a normal is beyond by chance once in 1.7 million, with few replicates behind one side at most once in
140,000; a row has 14, and most of them lie together.
"""

_LEAST = float(np.finfo(float).tiny)
"""Odds that are not told from none: a deviation of 37."""


def cross_checked(statistics: SpreadStatistics, plain: SampledSpread, limit: float | None) -> SpreadStatistics:
    """Return a row's statistics with the numbers of plain Monte Carlo beside its own.

    Equation: cross_check_deviation = the greatest `deviation` of mean, sd, percentiles, probability over the limit
    Arguments: statistics of another method; the plain spread of the same row; its limit in the unit of the output.
    Valid: independent methods whose errors are close to normal; a probability by the exact odds of its count.
    Source: `deviation`; binomial tails.
    """
    levels = np.array(list(PERCENTILES.values()))
    values = dict(zip(PERCENTILES, plain.quantile(levels).tolist(), strict=True))
    errors = dict(zip(PERCENTILES, plain.standard_error(levels).tolist(), strict=True))
    values |= {"mean": plain.mean, "sd": plain.sd}
    errors |= {"mean": plain.mean_standard_error, "sd": plain.sd_standard_error}
    own = {name: value for name, value in statistics.numbers.items() if value is not None}
    replicates = LINE_REPLICATES if statistics.texts["spread_method"] == "line" else REPLICATES
    deviations = [
        deviation(values[name] - own[name], errors[name], own[f"{name}_standard_error"], replicates) for name in values
    ]
    if limit is not None:
        over, found = own["probability_over_limit"], plain.probability_above(limit)
        values["probability_over_limit"] = found
        end = own[f"probability_over_limit_{'high' if found > over else 'low'}"]
        counted = _counted_error(round(found * plain.size), plain.size, over)
        deviations.append(deviation(found - over, counted, abs(end - over) / 1.96, replicates))
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


def deviation(difference: float, plain_error: float, error: float, replicates: int) -> float:
    """Return a difference in standard errors, as many as are as rare for a normal as it is: at most 37.

    Equation: z with Φ(−z) = P(t_ν > |d|/√(e² + s²)), ν = (n − 1) (1 + e²/s²), s the other error without its widening
    Arguments: difference d; its error e of theory; the other error, from so many replicates n, widened for them.
    Valid: errors close to normal; where nothing scatters, 0 without a difference.
    Source: Welch 1947 and Satterthwaite 1946, whose ν has a square: far out in the tail that is up to 65 times too
        rare (e = s/4, z = 5), this at most 12 times.

    >>> round(deviation(0.3, 0.1, 0.0, 8), 9), round(deviation(0.3, 0.0, 0.1, 8), 2)
    (3.0, 2.63)
    """
    scatter = error / widening(replicates)
    combined = math.hypot(plain_error, scatter)
    if not difference or math.isinf(combined):
        return 0.0
    if not combined:
        return float(-ndtri(_LEAST))
    freedom = (replicates - 1) * (combined / scatter) ** 2 if scatter > 0 else math.inf
    return float(-ndtri(max(float(stdtr(freedom, -abs(difference) / combined)), _LEAST)))


def _counted_error(count: int, total: int, share: float) -> float:
    """Return the standard error by which so many of all draws are as far from their share as their exact odds say."""
    more = count > share * total
    odds = betainc(count, total - count + 1, share) if more else betainc(total - count, count + 1, 1 - share)
    score = -float(ndtri(max(float(odds), _LEAST)))
    return abs(count / total - share) / score if score > 0 else math.inf
