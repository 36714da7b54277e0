"""Tolerance rows of a class → limits of a variant's dimensions → distributions."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.tolerance_grades import deviations
from flexlash.schema.variant import Limits, ToleranceRow, Variant
from flexlash.tolerance.distributions import Distribution, Normal, Triangular, Uniform
from flexlash.tolerance.gaps import Gap, gaps
from flexlash.tolerance.placed import Placed
from flexlash.tolerance.processes import Output, measured_ends, measured_shape, process_of, sides_of
from flexlash.tolerance.truncated_normal import TruncatedNormal

__all__ = [
    "ROUNDING",
    "Limits",
    "LimitsProblem",
    "bounds_of",
    "distribution_of",
    "distributions",
    "limits_of",
    "shape_problems",
    "share_outside",
]

ROUNDING = 1e-12
"""Decimals become binary with a relative error below this; limits that close count as reached."""


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
        diameter = DIMENSIONS[row.dimension].grade_at == "diameter"
        found = deviations(row.grade, 2 * nominal if diameter else nominal)
        return (found[0] / 2, found[1] / 2) if found and diameter else found
    return (row.lower * nominal, row.upper * nominal) if row.relative else (row.lower, row.upper)


def limits_of(
    variant: Variant, rows: Iterable[ToleranceRow], output: Output | None = None
) -> tuple[dict[str, Limits], tuple[LimitsProblem, ...]]:
    """Return the limits of the dimensions that vary, in the order of `DIMENSIONS`, and what is wrong.

    `output` is the model that tells which side of the limits is harmful, where a row asks for that.
    """
    limits = {}
    problems = []
    for row in sorted(rows, key=_turn):
        nominal = variant.dimensions.get(row.dimension)
        if nominal is None:
            continue
        found = _deviations(row, nominal)
        if found is None:
            problems.append(LimitsProblem(kind="untabulated", dimension=row.dimension, detail=row.grade or "", row=row))
        elif found[0] < found[1]:
            low, high = nominal + found[0], nominal + found[1]
            shift, sd = process_of(row, nominal, low, high, _harmful_side(variant, row, low, high, output))
            limits[row.dimension] = Limits(
                low=low,
                high=high,
                distribution=row.distribution,
                sigma=row.limits_sigma,
                mean_shift=shift,
                sd=sd,
                sample=row.sample,
                scatters_between=row.scatters_between,
            )
        elif found[0]:
            low, high = nominal + found[0], nominal + found[1]
            limits[row.dimension] = Limits(low=low, high=high, scatters_between=row.scatters_between)
    return limits, tuple(problems)


def _harmful_side(variant: Variant, row: ToleranceRow, low: float, high: float, output: Output | None) -> float:
    """Return the side of the limits of a row that raises the output, as it is found for many variants at once."""
    sizes = {name: np.array([size]) for name, size in variant.dimensions.items()} if row.harmful_shift else {}
    return float(sides_of(row, sizes, np.array([low]), np.array([high]), output)[0])


_TURNS = {name: turn for turn, name in enumerate(DIMENSIONS)}


def _turn(row: ToleranceRow) -> int:
    return _TURNS[row.dimension]


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
        low, high = bounds_of(name)
        reach = limit.reach
        if reach[0] <= low or reach[1] > high:
            kept[name] = replace(limit, cut=(low, high))
            problems.append(LimitsProblem(kind="cut", dimension=name, detail="0"))
        else:
            kept[name] = limit
    every = gaps(variant.flexspline_type, variant.dimensions)
    for gap in every:
        if gap.reached.kind == "impossible":
            problems.extend(_keep_open(variant, kept, gap))
    problems.extend(_overlaps(variant, limits, (gap for gap in every if gap.reached.kind == "overlap")))
    once = {(problem.kind, problem.dimension): problem for problem in problems}
    return kept, tuple(once.values())


def bounds_of(name: str) -> tuple[float, float]:
    """Open lower and closed upper bound [SI] that a shape must respect."""
    if name == "poisson_ratio":
        return -1.0, 0.5
    if name == "disk_thickness_exponent":
        return -math.inf, math.inf
    if name == "disk_cone_angle":
        return 0.0, math.pi
    return 0.0, math.inf


def _beyond_bounds(limits: Mapping[str, Limits]) -> Iterator[LimitsProblem]:
    """Yield the dimensions whose own limits, or measured values, leave the valid region."""
    for name, limit in limits.items():
        (low, high), (least, most) = bounds_of(name), _ends_of(limit)
        slack = ROUNDING * (abs(least) + abs(most))
        if least > low + slack and most <= high + slack:
            continue
        detail = "0" if least <= low + slack else "180°" if name == "disk_cone_angle" else "0.5"
        if limit.low > low + slack and limit.high <= high + slack:
            detail += " with what its sample shows" if limit.sample else " with the mean of its process"
        yield LimitsProblem(kind="impossible", dimension=name, detail=detail)


def _ends_of(limits: Limits) -> tuple[float, float]:
    """Smallest and largest value that must make a part: the limits, the mean of a process, what a measured one makes.

    Of a normal whose mean makes no part a cut would leave nothing. A measured shape ends where its sample can tell
    nothing more, so that no far tail of it is cut.
    """
    if limits.distribution == "normal":
        return min(limits.low, limits.mean), max(limits.high, limits.mean)
    if limits.distribution != "measured" or limits.sample is None:
        return limits.low, limits.high
    first, last = measured_ends(limits.sample)
    mean, sd = limits.mean, limits.standard_deviation
    return min(limits.low, mean + first * sd), max(limits.high, mean + last * sd)


def _ends(variant: Variant, limits: Mapping[str, Limits], name: str) -> tuple[float, float]:
    """Smallest and largest value that must make a part, of a dimension that may be exact."""
    if name in limits:
        return _ends_of(limits[name])
    return variant.dimensions[name], variant.dimensions[name]


def _closes(variant: Variant, limits: Mapping[str, Limits], gap: Gap) -> tuple[bool, float]:
    """Return whether the limits close a gap, and the room between those that face each other."""
    ends = [factor * _ends(variant, limits, name)[factor < 0] for name, factor in gap.factors.items()]
    room, slack = sum(ends), ROUNDING * sum(map(abs, ends))
    return room < -slack or (room <= slack and not gap.may_close), room


def _keep_open(variant: Variant, limits: dict[str, Limits], gap: Gap) -> Iterator[LimitsProblem]:
    """Yield whether limits close a gap; cut the far tails that would.

    Each normal keeps as much of its tail as its share in the gap between the facing limits.
    """
    is_closed, room = _closes(variant, limits, gap)
    if is_closed:
        yield LimitsProblem(kind="impossible", dimension=gap.dimension, detail=gap.reached.words)
        return
    tails = {}
    for name, factor in gap.factors.items():
        limit = limits.get(name)
        if limit and limit.distribution == "normal":
            low, high = _ends_of(limit)
            tail = limit.reach[1] - high if factor < 0 else low - limit.reach[0]
            if tail > 0:
                tails[name] = (tail, factor)
    total = sum(tail * abs(factor) for tail, factor in tails.values())
    if total < room:
        return
    for name, (tail, factor) in tails.items():
        limit = limits[name]
        (low, high), (least, most) = limit.cut or bounds_of(name), _ends_of(limit)
        kept = tail * max(room, 0.0) / total
        cut = (low, min(high, most + kept)) if factor < 0 else (max(low, least - kept), high)
        limits[name] = replace(limit, cut=cut)
        yield LimitsProblem(kind="cut", dimension=name, detail=gap.reached.words)


def _overlaps(variant: Variant, limits: Mapping[str, Limits], overlapping: Iterable[Gap]) -> Iterable[LimitsProblem]:
    """Return the refinements that at their limits outgrow the cylinder or the disk, the last one that does it."""
    return {
        gap.reached.words: LimitsProblem(kind="overlap", dimension=gap.dimension, detail=gap.reached.words)
        for gap in overlapping
        if _closes(variant, limits, replace(gap, may_close=True))[0]
    }.values()


def distribution_of(limits: Limits) -> Distribution:
    """Return the distribution between limits, or around the mean of the process."""
    if limits.distribution == "uniform":
        return Uniform(limits.low, limits.high)
    if limits.distribution == "triangular":
        return Triangular(limits.low, limits.high)
    if limits.distribution == "measured":
        if limits.sample is None:
            raise LookupError("a measured distribution without its sample")
        return Placed(measured_shape(limits.sample), limits.mean, limits.standard_deviation)
    if limits.distribution == "truncated normal":
        return TruncatedNormal(limits.mean, limits.standard_deviation, limits.low, limits.high)
    if limits.cut:
        return TruncatedNormal(limits.mean, limits.standard_deviation, *limits.cut)
    return Normal(limits.mean, limits.standard_deviation)


def share_outside(limits: Limits) -> float:
    """Return the share of parts outside the limits of the drawing, whatever their process.

    Equation: P(x < low) + P(x > high)
    Arguments: limits that differ [SI].
    Valid: any distribution; 0 of one that is cut at the limits.
    Source: definition.

    >>> f"{1e6 * share_outside(Limits(low=1.58, high=1.62)):.0f} ppm"
    '2700 ppm'
    """
    spread = distribution_of(limits)
    ends = (np.array([limits.low, limits.high]) - spread.location) / spread.scale
    below, within = spread.probability_below(ends).tolist()
    return float(below + (1 - within))


def distributions(limits: Mapping[str, Limits]) -> dict[str, Distribution]:
    """Return the distributions of the dimensions that scatter; limits that coincide shift without scatter."""
    return {name: distribution_of(limit) for name, limit in limits.items() if limit.low < limit.high}
