"""How sure one can be of staying below a limit: Ppk and the interval of a counted share."""

from __future__ import annotations

import math

from scipy.special import betaincinv

__all__ = ["clopper_pearson", "ppk_normal", "ppk_upper"]


def clopper_pearson(count: int, total: int, confidence: float = 0.95) -> tuple[float, float]:
    """Return the exact two-sided interval of a share of which `count` in `total` were seen.

    >>> f"{clopper_pearson(0, 10_000)[1] * 1e6:.1f} ppm"
    '368.8 ppm'
    """
    tail = (1 - confidence) / 2
    low = 0.0 if count == 0 else float(betaincinv(count, total - count + 1, tail))
    high = 1.0 if count == total else float(betaincinv(count + 1, total - count, 1 - tail))
    return low, high


def ppk_upper(limit: float, median: float, upper: float) -> float | None:
    """Return the performance index against an upper limit, ISO 22514-2: (limit − x50)/(x99.865 − x50).

    None when nothing scatters.

    >>> ppk_upper(3.0, 1.0, 2.0)
    2.0
    """
    width = upper - median
    return (limit - median) / width if width > 0 and math.isfinite(width) else None


def ppk_normal(limit: float, mean: float, sd: float) -> float | None:
    """Return the performance index against an upper limit as if the output were normal: (limit − mean)/(3 sd).

    None when nothing scatters.

    >>> ppk_normal(3.0, 1.0, 0.5)
    1.3333333333333333
    """
    return (limit - mean) / (3 * sd) if sd > 0 and math.isfinite(sd) else None
