"""Deviations that add up along a chain: how far their sum may lie from its middle, by the rules in use.

contribution        one link: half the width T of its limits, how strongly it moves the sum, how it scatters
sensitivity         a, what the sum moves for a unit of the link
inflation           c = 3σ/T: 1 of a normal whose limits lie three standard deviations out, more of what fills them
shift               η, the part of T by which the mean of a process may lie off the middle of the limits
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from flexlash.schema.arrays import Array, Quantity
from flexlash.schema.variant import Limits
from flexlash.tolerance.dimension_limits import distribution_of

__all__ = ["BENDER", "Combined", "Contribution", "combined", "inflation_of"]

BENDER = 1.5
"""What Bender adds to the root of the sum of squares for processes that are not what they should be."""

_LIMITS = 3.0
"""Standard deviations from the middle to the limits of the processes that the root of the sum of squares assumes."""


@dataclass(frozen=True, kw_only=True)
class Contribution:
    """A link of a chain: `tolerance` T ≥ 0 and `sensitivity` a, numbers or arrays of one shape; c and η as numbers."""

    tolerance: Quantity
    sensitivity: Quantity = 1.0
    inflation: float = 1.0
    shift: float = 0.0


class Combined(NamedTuple):
    """How far a sum may lie from its middle, by each rule, in the unit of the sum."""

    worst_case: Array
    rss: Array
    bender: Array
    mean_shift: Array


def combined(contributions: Iterable[Contribution]) -> Combined:
    """Return how far the sum of contributions may lie from its middle, in the shape of their tolerances.

    Equation: worst case W = Σ |a| T; root of the sum of squares R = √(Σ (c a T)²); Bender min(1.5 R, W); mean shift
        Σ η |a| T + √(Σ ((1 − η) c a T)²)
    Arguments: independent contributions, in units that their sensitivities turn into that of the sum.
    Valid: any limits; R, Bender and mean shift mean three standard deviations of a sum that is about normal. R may
        exceed W where few contributions fill their limits evenly.
    Source: Bender 1962; Chase and Greenwood 1988 for the mean shift.

    >>> loop = [Contribution(tolerance=t, sensitivity=a) for t, a in ((.25, 1), (.25, -1), (.2, -1), (.25, -1))]
    >>> [f"{float(value):.6f}" for value in combined(loop)[:3]]
    ['0.950000', '0.476970', '0.715454']
    """
    worst = square = shifted = rest = np.asarray(0.0)
    for one in contributions:
        reach = np.abs(one.sensitivity * one.tolerance)
        worst = worst + reach
        square = square + (one.inflation * reach) ** 2
        shifted = shifted + one.shift * reach
        rest = rest + ((1 - one.shift) * one.inflation * reach) ** 2
    rss = np.sqrt(square)
    return Combined(
        worst_case=worst, rss=rss, bender=np.minimum(BENDER * rss, worst), mean_shift=shifted + np.sqrt(rest)
    )


def inflation_of(limits: Limits) -> float:
    """Return how much wider than that of a normal whose limits lie at three standard deviations a scatter is.

    Equation: c = 3σ/T, T half the width of the limits
    Arguments: limits that differ.
    Valid: any distribution; of a normal 3/k, of a triangular one √(3/2), of a uniform one √3.
    Source: definition.

    >>> kinds = ("normal", "triangular", "uniform", "truncated normal")
    >>> [f"{inflation_of(Limits(low=-1, high=1, distribution=kind)):.4f}" for kind in kinds]
    ['1.0000', '1.2247', '1.7321', '0.9866']
    """
    return _LIMITS * distribution_of(limits).standard_deviation / ((limits.high - limits.low) / 2)
