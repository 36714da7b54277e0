"""Wider and narrower tolerances: the limits of one dimension, or of several, about the same middle.

factor     how many times as wide the limits are as on the drawing; 0 leaves the middle alone
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

from flexlash.schema.columns import DIMENSIONS
from flexlash.schema.variant import Limits, Variant
from flexlash.tolerance.dimension_limits import bounds_of, shape_problems
from flexlash.tolerance.gaps import gaps

__all__ = [
    "FACTOR_STEP",
    "GRADE",
    "USUAL",
    "grades_finer",
    "greatest_factor",
    "half_width",
    "is_made",
    "shop_tolerances",
    "with_widths",
]

GRADE = 10 ** (1 / 5)
"""How many times as wide an IT grade is as the next finer one (ISO 286-1)."""

FACTOR_STEP = 0.01
"""Step of a factor that widens several tolerances together."""

USUAL = 0.1
"""Half the width of limits as a share of the value up to which a tolerance is usual."""

_CLOSED = 1e-9
"""Part of the greatest factor that keeps limits off an impossible shape."""


def shop_tolerances(limits: Mapping[str, Limits]) -> tuple[str, ...]:
    """Return the dimensions that scatter and whose tolerance a drawing sets and a shop keeps: those of the part itself.

    Moduli and calibrations are what they are; the torque is not made.
    """
    return tuple(name for name, one in limits.items() if one.low < one.high and is_made(name))


def is_made(name: str) -> bool:
    """Return whether a dimension is one of the part itself, so that a drawing sets its tolerance."""
    column = DIMENSIONS[name]
    return column.sheet == "Variants" and column.quantity != "torque"


def half_width(limits: Limits) -> float:
    """Return half the width of limits [SI], without the last digits that a difference leaves."""
    return float(f"{(limits.high - limits.low) / 2:.11g}")


def grades_finer(factor: float) -> float:
    """Return how many IT grades finer limits are that are so many times as wide; negative: wider.

    Equation: −5 log₁₀ k
    Arguments: factor k > 0.
    Valid: any k; grades have steps of 10^(1/5) from IT6 on.
    Source: ISO 286-1.

    >>> grades_finer(0.1), round(grades_finer(GRADE), 12)
    (5.0, -1.0)
    """
    return -5 * math.log10(factor)


def with_widths(variant: Variant, limits: Mapping[str, Limits], factors: Mapping[str, float]) -> dict[str, Limits]:
    """Return the limits of a variant with some so many times as wide, far tails cut anew.

    Middle, distribution and capability of each process stay as they are: its mean shift and its standard deviation
    go with the width. A factor of 0 leaves the middle alone.
    """
    wider = {
        name: _wider(one, factors[name]) if name in factors else replace(one, cut=None) for name, one in limits.items()
    }
    return shape_problems(variant, wider)[0]


def _wider(limits: Limits, factor: float) -> Limits:
    """Return limits so many times as far apart about the same middle, and a process as capable between them."""
    middle, half = limits.middle, (limits.high - limits.low) / 2 * factor
    if not half:
        return Limits(low=middle, high=middle, scatters_between=limits.scatters_between)
    return replace(
        limits,
        low=middle - half,
        high=middle + half,
        mean_shift=limits.mean_shift * factor,
        sd=None if limits.sd is None else limits.sd * factor,
        cut=None,
    )


def greatest_factor(variant: Variant, limits: Mapping[str, Limits], names: Iterable[str]) -> tuple[float, bool]:
    """Return how many times as wide the limits of these dimensions may be together, and whether a shape sets that.

    Equation: the least k at which limits reach `USUAL` of a value; or a bound of their dimension or the end of a gap of
        the book of rules: room between the middles over what the ends reach there at k = 1
    Valid: limits that make a part as they are; 1 or less where they are wider than usual.
    """
    moved = set(names)
    usual = min(USUAL * (abs(variant.dimensions[name]) or 1.0) / half_width(limits[name]) for name in moved)
    shape = min([*_to_bounds(limits, moved), *_to_gaps(variant, limits, moved)]) * (1 - _CLOSED)
    return min(usual, shape), shape < usual


def _reach(limits: Limits) -> tuple[float, float]:
    """Return how far below and above the middle limits, or the mean of a normal process, reach."""
    half = (limits.high - limits.low) / 2
    shift = limits.mean_shift if limits.distribution == "normal" else 0.0
    return max(half, -shift), max(half, shift)


def _to_bounds(limits: Mapping[str, Limits], moved: set[str]) -> Iterable[float]:
    for name in moved:
        (low, high), middle, (below, above) = bounds_of(name), limits[name].middle, _reach(limits[name])
        yield min((middle - low) / below, (high - middle) / above)


def _to_gaps(variant: Variant, limits: Mapping[str, Limits], moved: set[str]) -> Iterable[float]:
    for gap in gaps(variant.flexspline_type, variant.dimensions):
        if gap.reached.kind != "impossible" or not moved & set(gap.factors):
            continue
        room = taken = 0.0
        for name, factor in gap.factors.items():
            if name not in limits:
                room += factor * variant.dimensions[name]
                continue
            ends = abs(factor) * _reach(limits[name])[factor < 0]
            room += factor * limits[name].middle - (0.0 if name in moved else ends)
            taken += ends if name in moved else 0.0
        if taken > 0:
            yield room / taken
