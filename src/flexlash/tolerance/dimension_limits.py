"""Tolerance rows of a class → limits of a variant's dimensions → distributions."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.tolerance_grades import deviations, deviations_of
from flexlash.schema.variant import FAR, Limits, ToleranceRow, Variant
from flexlash.tolerance.distributions import Distribution, Normal, Triangular, Uniform
from flexlash.tolerance.gaps import Gap, gaps
from flexlash.tolerance.truncated_normal import TruncatedNormal

__all__ = [
    "LimitArrays",
    "Limits",
    "LimitsProblem",
    "beyond_doubt",
    "distribution_of",
    "distributions",
    "limits_alike",
    "limits_of",
    "shape_problems",
]

_ROUNDING = 1e-12
"""Decimals become binary with a relative error below this; limits that close count as reached."""

_DOUBT = 1e3 * _ROUNDING
"""Part of the numbers of a comparison within which its outcome is in doubt."""


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


def limits_of(variant: Variant, rows: Iterable[ToleranceRow]) -> tuple[dict[str, Limits], tuple[LimitsProblem, ...]]:
    """Return the limits of the dimensions that vary, in the order of `DIMENSIONS`, and what is wrong."""
    limits = {}
    problems = []
    for row in sorted(rows, key=_turn):
        nominal = variant.dimensions.get(row.dimension)
        if nominal is None:
            continue
        found, unit = _deviations(row, nominal), nominal if row.relative else 1.0
        if found is None:
            problems.append(LimitsProblem(kind="untabulated", dimension=row.dimension, detail=row.grade or "", row=row))
        elif found[0] < found[1]:
            limits[row.dimension] = Limits(
                low=nominal + found[0],
                high=nominal + found[1],
                distribution=row.distribution,
                sigma=row.limits_sigma,
                mean_shift=row.mean_shift * unit,
                sd=None if row.sd is None else row.sd * abs(unit),
                scatters_between=row.scatters_between,
            )
        elif found[0]:
            limits[row.dimension] = Limits(low=nominal + found[0], high=nominal + found[1])
    return limits, tuple(problems)


_TURNS = {name: turn for turn, name in enumerate(DIMENSIONS)}


def _turn(row: ToleranceRow) -> int:
    return _TURNS[row.dimension]


class LimitArrays(NamedTuple):
    """The limits of a dimension of many variants [SI], each of shape (variants,).

    `least` and `most` are the ends of what the limits and the parts reach; `given` says where `limits_of` gives the
    dimension limits. What a grade does not tabulate is NaN.
    """

    low: Array
    high: Array
    least: Array
    most: Array
    given: npt.NDArray[np.bool_]


def limits_alike(sizes: Mapping[str, Array], rows: Iterable[ToleranceRow]) -> dict[str, LimitArrays]:
    """Return the limits of variants that have the same dimensions, given by name, in one class."""
    limits = {}
    for row in rows:
        if (nominal := sizes.get(row.dimension)) is None:
            continue
        if row.grade:
            parts = 2 if DIMENSIONS[row.dimension].grade_at == "diameter" else 1
            lower, upper = (found / parts for found in deviations_of(row.grade, parts * nominal))
        else:
            lower, upper = (
                side * nominal if row.relative else np.full(len(nominal), side) for side in (row.lower, row.upper)
            )
        low, high = nominal + lower, nominal + upper
        least, most = _reached(row, nominal, low, high) if row.distribution == "normal" else (low, high)
        limits[row.dimension] = LimitArrays(low, high, least, most, (lower < upper) | (abs(lower) > 0))
    return limits


def _reached(row: ToleranceRow, nominal: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """Return the least and greatest of the limits and of a normal's values."""
    unit = nominal if row.relative else np.ones(1)
    mean = (low + high) / 2 + row.mean_shift * unit
    far = FAR * ((high - low) / (2 * row.limits_sigma) if row.sd is None else row.sd * abs(unit))
    return np.minimum(low, mean - far), np.maximum(high, mean + far)


def beyond_doubt(
    flexspline_type: str, sizes: Mapping[str, Array], limits: Mapping[str, LimitArrays]
) -> npt.NDArray[np.bool_]:
    """Return which of some variants alike `shape_problems` surely leaves alone; of the others it may have to say.

    What comes near to a bound within a thousand times the rounding of numbers is in doubt.
    """
    reach = {name: (one.least, one.most) for name, one in limits.items()}
    sure = np.ones(len(sizes["torque"]), dtype=bool)
    for name, (low, high) in reach.items():
        least, most = _bounds(name)
        slack = _DOUBT * (abs(low) + abs(high))
        sure &= (low > least + slack) & (high < most - slack)
    for gap in gaps(flexspline_type, sizes):
        ends = [factor * reach.get(name, (sizes[name],) * 2)[factor < 0] for name, factor in gap.factors.items()]
        sure &= sum(ends) > _DOUBT * sum(map(abs, ends))
    return sure


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
    every = gaps(variant.flexspline_type, variant.dimensions)
    for gap in every:
        if gap.reached.kind == "impossible":
            problems.extend(_keep_open(variant, kept, gap))
    problems.extend(_overlaps(variant, limits, (gap for gap in every if gap.reached.kind == "overlap")))
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


def _closes(variant: Variant, limits: Mapping[str, Limits], gap: Gap) -> tuple[bool, float]:
    """Return whether the limits close a gap, and the room between those that face each other."""
    ends = [factor * _ends(variant, limits, name)[factor < 0] for name, factor in gap.factors.items()]
    room, slack = sum(ends), _ROUNDING * sum(map(abs, ends))
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
    if limits.distribution == "truncated normal":
        return TruncatedNormal(limits.mean, limits.standard_deviation, limits.low, limits.high)
    if limits.cut:
        return TruncatedNormal(limits.mean, limits.standard_deviation, *limits.cut)
    return Normal(limits.mean, limits.standard_deviation)


def distributions(limits: Mapping[str, Limits]) -> dict[str, Distribution]:
    """Return the distributions of the dimensions that scatter; limits that coincide shift without scatter."""
    return {name: distribution_of(limit) for name, limit in limits.items() if limit.low < limit.high}
