"""What would bring a failing variant within its limit: half the tolerances, or a stiffer flexspline."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from flexlash.analysis.computed import Computed
from flexlash.analysis.tolerance_spread import spread_again
from flexlash.mechanics.flexspline import backlash
from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import Limits, Settings
from flexlash.tolerance.spread_statistics import SpreadStatistics

__all__ = ["Halving", "Lever", "Recommendation", "Thickening", "recommendations_of"]

_STEP = 1e-4
"""Part of a dimension by which it is moved for a derivative."""

_THICKEST = 2.0
"""Times the wall up to which a thicker one is looked for."""

_BISECTIONS = 40
"""Halvings of the interval in which the wall is looked for: more than a double can tell apart on a drawing."""


@dataclass(frozen=True, kw_only=True)
class Halving:
    """Some dimensions with half their tolerance about the same middle, and what is over the limit then, by key."""

    limits: Mapping[str, Limits]
    over: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Lever:
    """A dimension and by what part the backlash rises when it grows, per part: −1 for a wall without a disk."""

    dimension: str
    slope: float


@dataclass(frozen=True, kw_only=True)
class Thickening:
    """The wall [m] as it is, the thickest that was tried, and that which brings P97.5 to the limit, None if none."""

    present: float
    thickest: float
    wanted: float | None


@dataclass(frozen=True, kw_only=True)
class Recommendation:
    """What would help one variant; `halvings` are empty where half of its units or more are over the limit."""

    variant: str
    halvings: tuple[Halving, ...]
    levers: tuple[Lever, ...]
    thickening: Thickening | None


def recommendations_of(computed: Mapping[int, Computed], settings: Settings) -> list[Recommendation]:
    """Return what helps the worst failing variant, and the worst of those that tighter tolerances can help."""
    failing = [one for one in computed.values() if settings.verdict_bounds.misses(_over(one))]
    helped = [one for one in failing if _can_be_tightened(one)]
    chosen = {one.variant.row: one for group in (failing, helped) if group for one in [max(group, key=_badness)]}
    return [
        Recommendation(
            variant=one.variant.name,
            halvings=tuple(_halvings(one, settings)) if _can_be_tightened(one) else (),
            levers=_levers(one),
            thickening=_thickening(one),
        )
        for one in chosen.values()
    ]


def _number(spread: SpreadStatistics | None, key: str) -> float:
    """Return a number of a spread, NaN where there is none."""
    value = spread.numbers.get(key) if spread else None
    return float("nan") if value is None else value


def _over(one: Computed) -> float | None:
    """Return the share of units of a variant over its limit; None without a limit."""
    return one.spread.numbers.get("probability_over_limit") if one.spread else None


def _can_be_tightened(one: Computed) -> bool:
    """Whether half of the units at least are within the limit and some dimension scatters."""
    limit = one.variant.backlash_limit
    return limit is not None and _number(one.spread, "p50") <= limit and bool(one.spread and one.spread.shares)


def _badness(one: Computed) -> tuple[float, float]:
    """Return what failing variants are ordered by: share over the limit, then P99.865 over the limit."""
    tail = _number(one.spread, "p99_865") / (one.variant.backlash_limit or 1.0)
    return _number(one.spread, "probability_over_limit"), tail


def _halvings(one: Computed, settings: Settings) -> Iterable[Halving]:
    """Spread a variant again with half the tolerance of its main contributor, of its main drawing dimension, of all."""
    shares = one.spread.shares if one.spread else {}
    ranked = sorted(shares, key=lambda name: (-shares[name], name))
    drawing = [name for name in ranked if DIMENSIONS[name].quantity in {"length", "angle"}]
    wanted = dict.fromkeys([(ranked[0],), *((name,) for name in drawing[:1]), tuple(ranked)])
    halved = [{name: _half(one.limits[name]) for name in names} for names in wanted]
    spread = spread_again(one, [{**one.limits, **limits} for limits in halved], settings)
    for limits, statistics in zip(halved, spread, strict=True):
        keys = (f"probability_over_limit{end}" for end in ("", "_low", "_high"))
        yield Halving(limits=limits, over={key: _number(statistics, key) for key in keys})


def _half(limits: Limits) -> Limits:
    """Return limits half as far apart about the same middle, and a process that is as capable between them."""
    quarter = (limits.high - limits.low) / 4
    return replace(
        limits,
        low=limits.middle - quarter,
        high=limits.middle + quarter,
        mean_shift=limits.mean_shift / 2,
        sd=None if limits.sd is None else limits.sd / 2,
    )


def _levers(one: Computed) -> tuple[Lever, ...]:
    """Return the lengths of a variant by how much the backlash follows them, most first."""
    dimensions, kind = one.variant.dimensions, one.variant.flexspline_type
    present = float(backlash(kind, dimensions))
    slopes = {}
    for name in (name for name in dimensions if DIMENSIONS[name].quantity == "length"):
        less, more = (
            float(backlash(kind, {**dimensions, name: dimensions[name] * (1 + step)})) for step in (-_STEP, _STEP)
        )
        slopes[name] = (more - less) / (2 * _STEP * present)
    # Slopes that differ by the error of their derivative alone stand by name.
    ranked = sorted(slopes, key=lambda name: (-round(abs(slopes[name]), 6), name))
    return tuple(Lever(dimension=name, slope=slopes[name]) for name in ranked)


def _thickening(one: Computed) -> Thickening | None:
    """Return the wall at which P97.5 meets the limit, if it keeps its distance from the nominal backlash in parts."""
    limit, dimensions = one.variant.backlash_limit, one.variant.dimensions
    tail = _number(one.spread, "p97_5")
    if limit is None or tail <= limit:
        return None
    present = dimensions["wall_thickness"]
    thickest = min(_THICKEST * present, dimensions.get("rim_thickness", float("inf")))

    def reaches(wall: float) -> bool:
        with_wall = float(backlash(one.variant.flexspline_type, {**dimensions, "wall_thickness": wall}))
        return with_wall * tail <= limit * float(backlash(one.variant.flexspline_type, dimensions))

    if thickest <= present:
        return None
    if not reaches(thickest):
        return Thickening(present=present, thickest=thickest, wanted=None)
    too_thin, enough = present, thickest
    for _ in range(_BISECTIONS):
        middle = (too_thin + enough) / 2
        too_thin, enough = (too_thin, middle) if reaches(middle) else (middle, enough)
    return Thickening(present=present, thickest=thickest, wanted=enough)
