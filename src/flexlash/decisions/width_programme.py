"""The widest tolerances at least cost between straight bounds: a convex programme in the squares of their factors.

How far a normal output stays below its limit is told by y, the inverse square of its distance to it in standard
deviations: y is a sum of what each tolerance has, in proportion to the square of its factor. What is not so straight is
drawn anew where the last answer lies, by whoever asks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import Bounds, NonlinearConstraint, minimize

from flexlash.schema.arrays import Array

__all__ = ["Cuts", "cheapest"]

_SLACK = 1e-12
_MOST = 200


@dataclass(frozen=True, kw_only=True)
class Cuts:
    """What each variant allows: `slopes` (variants, widths) · squares of factors ≤ `room` (variants,)."""

    slopes: Array
    room: Array

    def keep(self, logs: Array, slack: float = _SLACK) -> bool:
        """Return whether factors, by their logarithms (widths,), keep to all of them."""
        return bool((self.slopes @ np.exp(2 * logs) <= self.room + slack).all())


def cheapest(costs: Array, cuts: Cuts, bounds: Sequence[tuple[float, float]]) -> Array | None:
    """Return the logarithms of the factors (widths,) that cost least; None where even the least widths are too wide.

    Equation: min −Σ cᵢ xᵢ with Σᵢ d_vᵢ exp(2 xᵢ) ≤ r_v and bounds of x
    Arguments: costs cᵢ > 0 per grade (widths,); bounds of the logarithms.
    Valid: slopes d ≥ 0, so that the programme is convex and has one least cost.
    Source: SLSQP of scipy (Kraft 1988), from a point within.
    """
    low, high = np.array(bounds).T
    if not cuts.keep(low):
        return None
    start = _within(cuts, low, high)
    free = high - low > _SLACK
    if cuts.keep(high, 0.0):
        return np.asarray(high)
    if not free.any():
        return np.asarray(low)
    scale = np.maximum(cuts.room, np.finfo(float).tiny)

    def room_left(logs: Array) -> Array:
        return np.asarray((cuts.room - cuts.slopes @ np.exp(2 * logs)) / scale)

    def rises(logs: Array) -> Array:
        return np.asarray(-2 * cuts.slopes * np.exp(2 * logs) / scale[:, None])

    weights: Array = costs / costs.max()

    def gain(logs: Array) -> float:
        return -float(weights @ logs)

    def falls(_: Array) -> Array:
        return -weights

    found = minimize(
        gain,
        start,
        jac=falls,
        bounds=Bounds(low, high),
        constraints=NonlinearConstraint(room_left, 0.0, np.inf, jac=rises),
        method="SLSQP",
        options={"maxiter": _MOST, "ftol": 1e-10},
    )
    return _pulled_in(np.clip(found.x, low, high), start, cuts)


def _within(cuts: Cuts, low: Array, high: Array) -> Array:
    """Return a point between the bounds that keeps the cuts: as far from the low end to the high one as that goes."""
    return _pulled_in(high, low, cuts)


def _pulled_in(logs: Array, kept: Array, cuts: Cuts) -> Array:
    """Return the farthest point on the way from one that keeps the cuts to another."""
    if cuts.keep(logs, 0.0):
        return logs
    near, far = 0.0, 1.0
    for _ in range(50):
        middle = (near + far) / 2
        near, far = (middle, far) if cuts.keep(kept + middle * (logs - kept), 0.0) else (near, middle)
    return np.asarray(kept + near * (logs - kept))
