"""Tolerance rows of a class → limits of a variant's dimensions → distributions."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.tolerance_grades import deviations
from flexlash.schema.variant import ToleranceRow, Variant
from flexlash.tolerance.distributions import Distribution, Normal, Triangular, TruncatedNormal, Uniform

__all__ = ["Limits", "LimitsProblem", "distributions", "limits_of", "shape_problems"]

_RADII = frozenset({"mean_radius", "disk_inner_radius", "disk_outer_radius"})
_ROUNDING = 1e-12
"""Decimals become binary with a relative error below this; limits that close count as reached."""

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
    unbounded normal would. Kind `overlap`: refinements overlap at the limits, beyond what they are meant for.
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
    for gap in _gaps(variant):
        problems.extend(_keep_open(variant, kept, gap))
    problems.extend(_overlaps(variant, limits))
    once = {(problem.kind, problem.dimension): problem for problem in problems}
    return kept, tuple(once.values())


def _bounds(name: str) -> tuple[float, float]:
    """Open lower and closed upper bound [SI] that a shape must respect."""
    if name == "poisson_ratio":
        return -1.0, 0.5
    if name == "disk_thickness_exponent":
        return -math.inf, math.inf
    if name == "disk_cone_angle":
        return 0.0, math.pi
    return 0.0, math.inf


def _beyond_bounds(limits: Mapping[str, Limits]) -> Iterator[LimitsProblem]:
    """Yield the dimensions whose own limits leave the valid region."""
    for name, limit in limits.items():
        low, high = _bounds(name)
        slack = _ROUNDING * (abs(limit.low) + abs(limit.high))
        if limit.low <= low + slack:
            yield LimitsProblem(kind="impossible", dimension=name, detail="0")
        elif limit.high > high + slack:
            yield LimitsProblem(
                kind="impossible", dimension=name, detail="180°" if name == "disk_cone_angle" else "0.5"
            )


def _ends(variant: Variant, limits: Mapping[str, Limits], name: str) -> tuple[float, float]:
    """Smallest and largest limit of a dimension that may be exact."""
    if name in limits:
        return limits[name].low, limits[name].high
    return variant.dimensions[name], variant.dimensions[name]


@dataclass(frozen=True, kw_only=True)
class _Gap:
    """What must stay above 0, or at it where `may_close`: a sum of dimensions, each with its factor.

    A part whose limits close the gap is impossible: the first dimension then reaches what `barrier` names.
    """

    factors: Mapping[str, float]
    barrier: str
    may_close: bool = False


def _mean_radius(variant: Variant) -> dict[str, float]:
    """Return what makes up the mean radius, each dimension with its factor."""
    if "bore_diameter" in variant.dimensions:
        return {"bore_diameter": 0.5, "wall_thickness": 0.5}
    return {"mean_radius": 1.0}


def _bore(variant: Variant) -> dict[str, float]:
    """Return what makes up the bore's radius, each dimension with its factor."""
    factors = _mean_radius(variant)
    factors["wall_thickness"] = factors.get("wall_thickness", 0.0) - 0.5
    return {name: factor for name, factor in factors.items() if factor}


def _difference(one: Mapping[str, float], other: Mapping[str, float], first: str) -> dict[str, float]:
    """Return one sum less another; the dimension `first` stands first."""
    factors = {first: 0.0, **one}
    for name, factor in other.items():
        factors[name] = factors.get(name, 0.0) - factor
    factors[first] = one.get(first, 0.0) - other.get(first, 0.0)
    return {name: factor for name, factor in factors.items() if factor}


def _gaps(variant: Variant) -> Iterator[_Gap]:
    """Yield what a part needs to have an inside: a bore, and a disk or flange between its two radii."""
    bore = _bore(variant)
    if "bore_diameter" not in variant.dimensions:
        yield _Gap(factors=_difference(bore, {}, "wall_thickness"), barrier="the axis: no bore is left")
    if variant.flexspline_type == "cylinder":
        return
    inner, outer = _disk_sides(variant)
    yield _Gap(factors=_difference(outer, inner, next(iter(inner))), barrier="the other radius of the disk")
    if "junction_fillet_radius" in variant.dimensions:
        fillet = {"junction_fillet_radius": 1.0}
        factors = _difference(bore, fillet, "junction_fillet_radius")
        yield _Gap(factors=factors, barrier="beyond the axis", may_close=True)


def _disk_sides(variant: Variant) -> tuple[dict[str, float], dict[str, float]]:
    """Return what makes up inner and outer radius of the disk, each dimension with its factor."""
    mean_radius = _mean_radius(variant)
    inner = {"disk_inner_radius": 1.0} if "disk_inner_radius" in variant.dimensions else mean_radius
    outer = {"disk_outer_radius": 1.0} if "disk_outer_radius" in variant.dimensions else mean_radius
    return inner, outer


def _keep_open(variant: Variant, limits: dict[str, Limits], gap: _Gap) -> Iterator[LimitsProblem]:
    """Yield whether limits close a gap; cut the far tails that would.

    Each normal keeps as much of its tail as its share in the gap between the facing limits.
    """
    ends = [factor * _ends(variant, limits, name)[factor < 0] for name, factor in gap.factors.items()]
    room, slack = sum(ends), _ROUNDING * sum(map(abs, ends))
    if room < -slack or (room <= slack and not gap.may_close):
        yield LimitsProblem(kind="impossible", dimension=next(iter(gap.factors)), detail=gap.barrier)
        return
    tails = {}
    for name, factor in gap.factors.items():
        limit = limits.get(name)
        if limit and limit.distribution == "normal":
            tail = limit.reach[1] - limit.high if factor < 0 else limit.low - limit.reach[0]
            if tail > 0:
                tails[name] = (tail, factor)
    total = sum(tail * abs(factor) for tail, factor in tails.values())
    if total < room:
        return
    for name, (tail, factor) in tails.items():
        limit = limits[name]
        low, high = limit.cut or _bounds(name)
        kept = tail * max(room, 0.0) / total
        cut = (low, min(high, limit.high + kept)) if factor < 0 else (max(low, limit.low - kept), high)
        limits[name] = replace(limit, cut=cut)
        yield LimitsProblem(kind="cut", dimension=name, detail=gap.barrier)


def _overlaps(variant: Variant, limits: Mapping[str, Limits]) -> Iterator[LimitsProblem]:
    """Yield the refinements that at their limits outgrow the cylinder or the disk."""

    def reached(name: str, end: int) -> float:
        return _ends(variant, limits, name)[end] if name in variant.dimensions else 0.0

    along = [name for name in ("rim_length", "junction_fillet_radius") if name in variant.dimensions]
    if sum(reached(name, 1) for name in along) > reached("cylinder_length", 0) and along:
        yield LimitsProblem(kind="overlap", dimension=along[-1], detail="the cylinder length")
    sides = _disk_sides(variant)
    if sides and "hub_fillet_radius" in variant.dimensions:
        inner, outer = sides
        width = sum(factor * reached(name, 0) for name, factor in outer.items())
        width -= sum(factor * reached(name, 1) for name, factor in inner.items())
        if reached("hub_fillet_radius", 1) > width:
            yield LimitsProblem(kind="overlap", dimension="hub_fillet_radius", detail="the width of the disk")


def distributions(limits: Mapping[str, Limits]) -> dict[str, Distribution]:
    """Return the distributions of the dimensions that scatter; limits that coincide shift without scatter."""
    return {name: limit.as_distribution() for name, limit in limits.items() if limit.low < limit.high}
