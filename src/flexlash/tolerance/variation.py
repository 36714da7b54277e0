"""One variant's tolerance spread: every statistic that the report prints, from one model and its limits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from flexlash.arrays import Array
from flexlash.tolerance.capability import ppk_upper
from flexlash.tolerance.limits import Limits, distributions
from flexlash.tolerance.propagate import Spread, propagate
from flexlash.tolerance.sampling import UnitPoints
from flexlash.tolerance.sensitivity import first_order_sd, worst_case

__all__ = ["CURVE_PROBABILITIES", "Variation", "variation_of"]

PERCENTILES = {
    "p0_135": 0.00135,
    "p2_5": 0.025,
    "p5": 0.05,
    "p50": 0.5,
    "p95": 0.95,
    "p97_5": 0.975,
    "p99_865": 0.99865,
}
CURVE_PROBABILITIES = (
    0.00135, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5,
    0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 0.975, 0.99, 0.995, 0.9975, 0.99865,
)  # fmt: skip
"""Where the cumulative curve of the report is stored."""

HISTOGRAM_BINS = 40


@dataclass(frozen=True, kw_only=True)
class Variation:
    """Spread of one variant [SI]: statistics by result key without unit, shares by dimension, two curves.

    `curve` are the values at `CURVE_PROBABILITIES`; `edges` (bins + 1,) and `heights` (bins,) a histogram
    whose heights are shares of all units; the three are None when nothing scatters. `swings` is the
    backlash with one dimension at its lower and upper limit and the others in the middle of theirs.
    """

    statistics: dict[str, float | None]
    shares: dict[str, float]
    swings: dict[str, tuple[float, float]] = field(default_factory=dict)
    curve: Array | None = None
    edges: Array | None = None
    heights: Array | None = None


def variation_of(
    backlash: Callable[[Mapping[str, Array | float]], Array],
    nominal: Mapping[str, float],
    limits: Mapping[str, Limits],
    points: UnitPoints,
    *,
    limit: float | None,
    coverage: float,
) -> Variation:
    """Return the spread of a variant's backlash over its limits.

    `backlash` maps dimensions in SI to the backlash; `nominal` are the entered values; `limit` is the
    greatest backlash allowed; `coverage` the share of units inside the coverage interval.
    """
    centre = {**nominal, **{name: one.middle for name, one in limits.items()}}
    scatter = distributions(limits)
    if not scatter:
        return _exact(float(backlash(centre)), limit)

    def model(**varying: Array) -> Array:
        return backlash({**centre, **varying})

    spread = propagate(model, scatter, points=points)
    ends = {name: (limits[name].low, limits[name].high) for name in scatter}
    worst = worst_case(model, ends)
    statistics: dict[str, float | None] = {
        "mean": spread.mean,
        "sd": spread.sd,
        **{key: spread.quantile(share) for key, share in PERCENTILES.items()},
        "p97_5_standard_error": spread.standard_error(0.975),
        "p99_865_standard_error": spread.standard_error(0.99865),
        "mean_standard_error": spread.mean_standard_error,
        "sd_standard_error": spread.sd_standard_error,
        "coverage_low": spread.quantile((1 - coverage) / 2),
        "coverage_high": spread.quantile((1 + coverage) / 2),
        "worst_case_low": worst.low,
        "worst_case_high": worst.high,
        "first_order_sd": first_order_sd(model, {name: centre[name] for name in scatter}, scatter),
    }
    edges, heights = spread.histogram(HISTOGRAM_BINS)
    return Variation(
        statistics=statistics | _against(spread, limit),
        shares=spread.shares,
        swings=worst.swings,
        curve=spread.quantile(np.array(CURVE_PROBABILITIES)),
        edges=edges,
        heights=heights,
    )


def _against(spread: Spread, limit: float | None) -> dict[str, float | None]:
    """Statistics against the limit; none without one."""
    if limit is None:
        return {}
    low, high = spread.probability_interval(limit)
    return {
        "probability_over_limit": spread.probability_above(limit),
        "probability_over_limit_low": low,
        "probability_over_limit_high": high,
        "ppk": ppk_upper(limit, spread.quantile(0.5), spread.quantile(0.99865)),
    }


def _exact(value: float, limit: float | None) -> Variation:
    """Spread of a variant none of whose dimensions scatters."""
    same = (*PERCENTILES, "mean", "coverage_low", "coverage_high", "worst_case_low", "worst_case_high")
    none = ("sd", "first_order_sd", "p97_5_standard_error", "p99_865_standard_error")
    statistics: dict[str, float | None] = dict.fromkeys(same, value)
    statistics |= dict.fromkeys((*none, "mean_standard_error", "sd_standard_error"), 0.0)
    if limit is not None:
        over = float(value > limit)
        sides = ("", "_low", "_high")
        statistics |= dict.fromkeys((f"probability_over_limit{side}" for side in sides), over)
    return Variation(statistics=statistics, shares={})
