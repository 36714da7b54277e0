"""The numbers of a row's spread that are kept: those of the report, by name, in SI.

numbers        by result key without unit: `mean`, `p97_5`, `p97_5_standard_error`, `probability_over_limit`, …
texts          by result key: `spread_method`, `spread_note`, `first_order_valid`, `cross_check`
shares         first-order Sobol' index of each dimension, `total_shares` the total ones; `share_errors` and
               `total_share_errors` their standard errors
swings         output with one dimension at its lower and upper limit, the others in the middle of theirs
limit          greatest output allowed
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from flexlash.tolerance.capability import ppk_normal, ppk_upper
from flexlash.tolerance.spread import Method, Spread
from flexlash.tolerance.variance_shares import VarianceShares

__all__ = ["PERCENTILES", "SpreadStatistics", "exact_statistics", "named_probabilities", "statistics_of"]

PERCENTILES = {
    "p0_135": 0.00135,
    "p1": 0.01,
    "p2_5": 0.025,
    "p5": 0.05,
    "p25": 0.25,
    "p50": 0.5,
    "p75": 0.75,
    "p95": 0.95,
    "p97_5": 0.975,
    "p99": 0.99,
    "p99_865": 0.99865,
}

_MOMENTS = ("mean", "sd", "skewness", "kurtosis")


@dataclass(frozen=True, kw_only=True)
class SpreadStatistics:
    """What is kept of one row's spread; a number that the row does not have is left out or None."""

    numbers: Mapping[str, float | None]
    texts: Mapping[str, str | None] = field(default_factory=dict)
    shares: Mapping[str, float] = field(default_factory=dict)
    total_shares: Mapping[str, float] = field(default_factory=dict)
    share_errors: Mapping[str, float] = field(default_factory=dict)
    total_share_errors: Mapping[str, float] = field(default_factory=dict)
    swings: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        numbers: Mapping[str, float],
        *,
        limit: float | None,
        method: Method,
        size: int,
        note: str,
        shares: VarianceShares,
    ) -> SpreadStatistics:
        """Return the statistics with the numbers that follow from others; NaN is none, `size` lines or points."""
        kept: dict[str, float | None] = {name: value for name, value in numbers.items() if not math.isnan(value)}
        main = max(shares.first, key=lambda name: shares.first[name], default=None)
        if main is not None:
            kept["main_contributor_share_standard_error"] = shares.first_error[main]
        if limit is not None:
            kept["ppk"] = ppk_upper(limit, numbers["p50"], numbers["p99_865"])
            kept["ppk_normal"] = ppk_normal(limit, numbers["mean"], numbers["sd"])
        return cls(
            numbers=kept | {"spread_points": float(size)},
            texts={"spread_method": method, "spread_note": note or None},
            shares=shares.first,
            total_shares=shares.total,
            share_errors=shares.first_error,
            total_share_errors=shares.total_error,
        )


def named_probabilities(coverage: float) -> dict[str, float]:
    """Return the probabilities whose quantiles are kept, by name: percentiles and ends of the coverage interval."""
    return PERCENTILES | {"coverage_low": (1 - coverage) / 2, "coverage_high": (1 + coverage) / 2}


def statistics_of(
    spread: Spread, limit: float | None, *, coverage: float, note: str = "", shares: bool = True
) -> SpreadStatistics:
    """Return the statistics of a spread, without shares where they are not asked for.

    `note` says why it was not made otherwise.
    """
    probabilities = named_probabilities(coverage)
    levels = np.array(list(probabilities.values()))
    numbers: dict[str, float] = dict(zip(probabilities, spread.quantile(levels).tolist(), strict=True))
    errors = spread.standard_error(levels).tolist()
    numbers |= {f"{name}_standard_error": error for name, error in zip(probabilities, errors, strict=True)}
    for name in _MOMENTS:
        numbers |= {name: getattr(spread, name), f"{name}_standard_error": getattr(spread, f"{name}_standard_error")}
    if limit is not None:
        low, high = spread.probability_interval(limit)
        numbers |= {
            "probability_over_limit": spread.probability_above(limit),
            "probability_over_limit_low": low,
            "probability_over_limit_high": high,
        }
    return SpreadStatistics.of(
        numbers,
        limit=limit,
        method=spread.method,
        size=spread.size,
        note=note,
        shares=spread.variance_shares if shares else VarianceShares(first={}, total={}, first_error={}, total_error={}),
    )


def exact_statistics(value: float, limit: float | None) -> SpreadStatistics:
    """Return the statistics of a row none of whose dimensions scatters."""
    quantiles = named_probabilities(0.95)
    numbers: dict[str, float | None] = dict.fromkeys((*quantiles, "mean", "worst_case_low", "worst_case_high"), value)
    numbers |= dict.fromkeys((f"{name}_standard_error" for name in (*quantiles, *_MOMENTS)), 0.0)
    numbers |= dict.fromkeys(("sd", "skewness", "kurtosis", "first_order_sd"), 0.0)
    if limit is not None:
        over = float(value > limit)
        numbers |= dict.fromkeys((f"probability_over_limit{end}" for end in ("", "_low", "_high")), over)
    return SpreadStatistics(numbers=numbers, texts={"first_order_valid": "yes"})
