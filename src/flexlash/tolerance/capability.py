"""How sure one can be of staying below a limit: Ppk and the interval of a counted probability."""

from __future__ import annotations

import math

from scipy.special import betaincinv

__all__ = ["clopper_pearson", "ppk_normal", "ppk_upper"]


def clopper_pearson(count: float, total: float, confidence: float = 0.95) -> tuple[float, float]:
    """Return the ends of the exact two-sided interval of a probability of which `count` in `total` were seen.

    Equation: the ends p with P(X ≥ count | p) = P(X ≤ count | p) = (1 − confidence)/2, by the inverse beta function
    Arguments: 0 ≤ count ≤ total, total ≥ 1, of draws that are worth so many where they are no whole numbers; confidence
        between 0 and 1.
    Valid: independent draws; it holds the probability at least as often as `confidence` says.
    Source: Clopper and Pearson 1934.

    >>> f"{clopper_pearson(0, 10_000)[1] * 1e6:.1f} ppm"
    '368.8 ppm'
    """
    tail = (1 - confidence) / 2
    low = 0.0 if count == 0 else float(betaincinv(count, total - count + 1, tail))
    high = 1.0 if count == total else float(betaincinv(count + 1, total - count, 1 - tail))
    return low, high


def ppk_upper(limit: float, median: float, upper: float) -> float | None:
    """Return the performance index against an upper limit, None when nothing scatters.

    Equation: Ppk = (limit − x50)/(x99.865 − x50)
    Arguments: limit, median x50 and percentile x99.865 in one unit.
    Valid: any distribution.
    Source: ISO 22514-2.

    >>> ppk_upper(3.0, 1.0, 2.0)
    2.0
    """
    width = upper - median
    return (limit - median) / width if width > 0 and math.isfinite(width) else None


def ppk_normal(limit: float, mean: float, sd: float) -> float | None:
    """Return the performance index against an upper limit by normal theory, None when nothing scatters.

    Equation: Ppk = (limit − mean)/(3 sd)
    Arguments: limit, mean and sd in one unit.
    Valid: right only for a normal output.
    Source: ISO 22514-2.

    >>> ppk_normal(3.0, 1.0, 0.5)
    1.3333333333333333
    """
    return (limit - mean) / (3 * sd) if sd > 0 and math.isfinite(sd) else None
