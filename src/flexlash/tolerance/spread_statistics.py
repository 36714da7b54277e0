"""The tolerance spread of one variant as a record, and how it is to be sampled."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, TypeAlias

from flexlash.schema.arrays import Array
from flexlash.schema.columns import DIMENSIONS
from flexlash.tolerance.dimension_limits import Limits
from flexlash.tolerance.sampling import UnitPoints
from flexlash.tolerance.spread import Method

__all__ = ["PERCENTILES", "SamplingPlan", "SpreadStatistics", "Task"]

PERCENTILES = {
    "p0_135": 0.00135,
    "p2_5": 0.025,
    "p5": 0.05,
    "p50": 0.5,
    "p95": 0.95,
    "p97_5": 0.975,
    "p99_865": 0.99865,
}

Task: TypeAlias = tuple[
    Callable[[Mapping[str, Array | float]], Array], Mapping[str, float], Mapping[str, Limits], float | None
]
"""A row to spread: its backlash model, entered dimensions, limits of dimensions, and greatest backlash allowed."""


@dataclass(frozen=True)
class SamplingPlan:
    """How the spread is sampled; each process draws its points for itself, the same ones.

    `cross_check` puts plain Monte Carlo beside the method. `coverage` is the share of units inside the coverage
    interval.
    """

    method: Method
    samples: int | None
    seed: int
    coverage: float = 0.95
    cross_check: bool = False

    @cached_property
    def sobol(self) -> UnitPoints:
        """Sobol' points, one coordinate per dimension that may have a tolerance."""
        return self._points("sobol")

    @cached_property
    def random(self) -> UnitPoints:
        """Points of plain Monte Carlo."""
        return self._points("random")

    def _points(self, method: Literal["sobol", "random"]) -> UnitPoints:
        samples = self.samples if method == self.method else None
        return UnitPoints(list(DIMENSIONS), method=method, samples=samples, seed=self.seed)


@dataclass(frozen=True, kw_only=True)
class SpreadStatistics:
    """Spread of one variant [SI]: `numbers` by result key without unit, shares by dimension.

    `texts` are what is said in words: by which method, with which note. `total_shares` are the total indices beside the
    first-order `shares`. `swings` is the backlash with one dimension at its lower and upper limit and the others in the
    middle of theirs.
    """

    numbers: dict[str, float | None]
    texts: dict[str, str | None] = field(default_factory=dict)
    shares: dict[str, float] = field(default_factory=dict)
    total_shares: dict[str, float] = field(default_factory=dict)
    swings: dict[str, tuple[float, float]] = field(default_factory=dict)
