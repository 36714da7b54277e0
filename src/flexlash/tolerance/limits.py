"""Tolerance rows of a class → limits of a variant's dimensions → distributions."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from flexlash.columns import DIMENSIONS
from flexlash.tolerance.distributions import Distribution, Normal, Triangular, TruncatedNormal, Uniform
from flexlash.tolerance.grades import deviations
from flexlash.variant import ToleranceRow, Variant

__all__ = ["Limits", "LimitsProblem", "distributions", "limits_of", "shape_problems"]

_RADII = frozenset({"mean_radius", "disk_inner_radius", "disk_outer_radius"})
_FAR = 8.3
"""Beyond this many standard deviations a normal has no weight in double precision."""


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Smallest and largest allowed value of a dimension [SI] and how parts scatter between them."""

    low: float
    high: float
    distribution: str = "normal"
    sigma: float = 3.0
    cut: tuple[float, float] | None = None

    @property
    def middle(self) -> float:
        """Middle of the limits."""
        return (self.low + self.high) / 2

    @property
    def standard_deviation(self) -> float:
        """Standard deviation of the normal before any cut."""
        return (self.high - self.low) / (2 * self.sigma)

    @property
    def reach(self) -> tuple[float, float]:
        """Smallest and largest value that the distribution can produce."""
        if self.distribution == "normal":
            far = _FAR * self.standard_deviation
            return self.middle - far, self.middle + far
        return self.low, self.high

    def as_distribution(self) -> Distribution:
        """Return the distribution between, or around, the limits."""
        if self.distribution == "uniform":
            return Uniform(self.low, self.high)
        if self.distribution == "triangular":
            return Triangular(self.low, self.high)
        if self.distribution == "truncated normal":
            return TruncatedNormal(self.middle, self.standard_deviation, self.low, self.high)
        if self.cut:
            return TruncatedNormal(self.middle, self.standard_deviation, *self.cut)
        return Normal(self.middle, self.standard_deviation)


@dataclass(frozen=True, kw_only=True)
class LimitsProblem:
    """What is wrong with a variant's limits: the kind, the dimension and the row that set it."""

    kind: str
    dimension: str
    detail: str
    row: ToleranceRow | None = None


def _deviations(row: ToleranceRow, nominal: float) -> tuple[float, float] | None:
    """Lower and upper deviation [SI] from the entered value; None where a grade has no entry."""
    if row.grade:
        diameter = row.dimension in _RADII
        found = deviations(row.grade, 2 * nominal if diameter else nominal)
        return (found[0] / 2, found[1] / 2) if found and diameter else found
    return (row.lower * nominal, row.upper * nominal) if row.relative else (row.lower, row.upper)


def limits_of(variant: Variant, rows: Iterable[ToleranceRow]) -> tuple[dict[str, Limits], tuple[LimitsProblem, ...]]:
    """Return the limits of the dimensions that vary, in the order of `DIMENSIONS`, and what is wrong."""
    limits = {}
    problems = []
    for row in sorted(rows, key=lambda row: list(DIMENSIONS).index(row.dimension)):
        nominal = variant.dimensions.get(row.dimension)
        if nominal is None:
            continue
        found = _deviations(row, nominal)
        if found is None:
            problems.append(LimitsProblem(kind="untabulated", dimension=row.dimension, detail=row.grade or "", row=row))
        elif found[0] < found[1]:
            limits[row.dimension] = Limits(
                low=nominal + found[0],
                high=nominal + found[1],
                distribution=row.distribution,
                sigma=row.limits_sigma,
            )
        elif found[0]:
            limits[row.dimension] = Limits(low=nominal + found[0], high=nominal + found[1])
    return limits, tuple(problems)


def shape_problems(
    variant: Variant, limits: Mapping[str, Limits]
) -> tuple[dict[str, Limits], tuple[LimitsProblem, ...]]:
    """Return limits with far normal tails cut at the valid region, and the problems found.

    Kind `impossible`: the limits themselves reach an impossible shape. Kind `cut`: only the tail of an
    unbounded normal would.
    """
    problems = list(_beyond_bounds(limits))
    if problems:
        return dict(limits), tuple(problems)
    kept = {}
    for name, limit in limits.items():
        low, high = _bounds(name)
        reach = limit.reach
        if reach[0] <= low or reach[1] > high:
            kept[name] = replace(limit, cut=(low, high))
            problems.append(LimitsProblem(kind="cut", dimension=name, detail="0"))
        else:
            kept[name] = limit
    gap = _disk_gap(variant, kept)
    if gap:
        inner, outer, low, high = gap
        if low >= high:
            problems.append(LimitsProblem(kind="impossible", dimension="disk_inner_radius", detail=outer))
        else:
            problems.extend(_cut_disk(kept, inner, outer, (low, high)))
    return kept, tuple(problems)


def _bounds(name: str) -> tuple[float, float]:
    """Open lower and closed upper bound [SI] that a shape must respect."""
    if name == "poisson_ratio":
        return -1.0, 0.5
    return 0.0, math.inf


def _beyond_bounds(limits: Mapping[str, Limits]) -> Iterator[LimitsProblem]:
    """Yield the dimensions whose own limits leave the valid region."""
    for name, limit in limits.items():
        low, high = _bounds(name)
        if limit.low <= low or limit.high > high:
            yield LimitsProblem(kind="impossible", dimension=name, detail="0" if limit.low <= low else "0.5")


def _ends(variant: Variant, limits: Mapping[str, Limits], name: str) -> tuple[float, float]:
    """Smallest and largest limit of a dimension that may be exact."""
    if name in limits:
        return limits[name].low, limits[name].high
    return variant.dimensions[name], variant.dimensions[name]


def _disk_gap(variant: Variant, limits: Mapping[str, Limits]) -> tuple[str, str, float, float] | None:
    """Return the dimensions that bound the disk and the limits that face each other, or None without a disk."""
    if variant.flexspline_type == "cylinder":
        return None
    sizes = {
        side: f"disk_{side}_radius" if f"disk_{side}_radius" in variant.dimensions else _radius_name(variant)
        for side in ("inner", "outer")
    }
    facing = []
    for side, end in (("inner", 1), ("outer", 0)):
        radius = _ends(variant, limits, sizes[side])[end]
        if sizes[side] == "bore_diameter":
            radius = (radius + _ends(variant, limits, "wall_thickness")[end]) / 2
        facing.append(radius)
    return sizes["inner"], sizes["outer"], facing[0], facing[1]


def _radius_name(variant: Variant) -> str:
    return "mean_radius" if "mean_radius" in variant.dimensions else "bore_diameter"


def _cut_disk(limits: dict[str, Limits], inner: str, outer: str, gap: tuple[float, float]) -> Iterator[LimitsProblem]:
    """Cut the tails that would let the hub outgrow the disk, at a wall between the facing limits."""
    halves = {inner: 2 if inner == "bore_diameter" else 1, outer: 2 if outer == "bore_diameter" else 1}
    ends = []
    for name, end in ((inner, 1), (outer, 0)):
        limit = limits.get(name)
        slack = 0.0
        if limit and limit.distribution == "normal":
            slack = abs(limit.reach[end] - (limit.high if end else limit.low)) / halves[name]
        ends.append(slack)
    if sum(ends) < gap[1] - gap[0]:
        return
    fence = gap[0] + (gap[1] - gap[0]) * ends[0] / sum(ends)
    for name, end in ((inner, 1), (outer, 0)):
        limit = limits.get(name)
        if limit and ends[1 - end] > 0:
            low, high = limit.cut or _bounds(name)
            edge = fence * halves[name]
            limits[name] = replace(limit, cut=(low, edge) if end else (edge, high))
            yield LimitsProblem(kind="cut", dimension=name, detail="the other disk radius")


def distributions(limits: Mapping[str, Limits]) -> dict[str, Distribution]:
    """Return the distributions of the dimensions that scatter; limits that coincide shift without scatter."""
    return {name: limit.as_distribution() for name, limit in limits.items() if limit.low < limit.high}
