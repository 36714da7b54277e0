"""Data → an axis that begins and ends at round numbers near them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

__all__ = ["Axis", "axis_around", "axis_over"]

_TICKS = 6
_CLEAR = 0.1
"""Part of a step that an end keeps away from the data, so that no mark is cut."""

_NEAR = 0.25
"""An axis whose data begin below this part of their end begins at 0."""


@dataclass(frozen=True, kw_only=True)
class Axis:
    """Ends and step of an axis near its data."""

    low: float
    high: float
    step: float

    def options(self, *, per_cent: bool = False) -> dict[str, Any]:
        """Return what a chart wants to know of the axis."""
        decimals = max(0, -math.floor(math.log10(self.step * (100 if per_cent else 1)) + 1e-9))
        number = "0." + "0" * decimals if decimals else "0"
        ends = {"min": self.low, "max": self.high, "major_unit": self.step}
        return {**ends, "num_format": f"{number}%" if per_cent else number, "crossing": "min"}


def axis_around(values: Sequence[float]) -> Axis:
    """Return an axis with 0 in its middle and two or three round steps to either side, around values of any sign.

    >>> axis_around([0.121, -0.05]), axis_around([0.079])
    (Axis(low=-0.15, high=0.15, step=0.05), Axis(low=-0.1, high=0.1, step=0.05))
    """
    most = max((abs(value) for value in values), default=0.0) or 1.0
    power = 10.0 ** math.floor(math.log10(most / 3))
    steps = ((factor * power, count) for factor in (1, 2, 5, 10) for count in (2, 3))
    step, count = next((step, count) for step, count in steps if step * count >= most * (1 - 1e-9))
    end = float(f"{count * step:.9g}")
    return Axis(low=-end, high=end, step=float(f"{step:.9g}"))


def axis_over(values: Sequence[float]) -> Axis:
    """Return an axis with round ends and steps around values, beginning at 0 where that does not squeeze them.

    >>> axis_over([3.63, 3.80])
    Axis(low=3.6, high=3.85, step=0.05)
    >>> axis_over([0.2, 1.9])
    Axis(low=0.0, high=2.0, step=0.5)
    """
    low, high = min(values), max(values)
    low = 0.0 if 0 <= low < _NEAR * high else low
    span = high - low or abs(high) / 10 or 1.0
    power = 10.0 ** math.floor(math.log10(span / _TICKS))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= span / _TICKS * (1 - 1e-9))
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    first -= int(low != 0 and low - first * step < _CLEAR * step)
    last += int(last * step - high < _CLEAR * step)
    return Axis(low=float(f"{first * step:.9g}"), high=float(f"{last * step:.9g}"), step=float(f"{step:.9g}"))
