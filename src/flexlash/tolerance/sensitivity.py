"""What the limits and the first derivatives say, without sampling: worst case and first-order spread."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from flexlash.arrays import Array
from flexlash.tolerance.distributions import Distribution

__all__ = ["WorstCase", "first_order_sd", "gradient", "worst_case"]

Model = Callable[..., Array]


def _table(centre: Mapping[str, float], rows: int) -> dict[str, Array]:
    """Return every input at its centre, `rows` times."""
    return {name: np.full(rows, value) for name, value in centre.items()}


def gradient(model: Model, centre: Mapping[str, float], steps: Mapping[str, float]) -> dict[str, float]:
    """Return the partial derivatives of a model at a point by central differences over ± its steps."""
    arguments = _table(centre, 2 * len(steps))
    for place, (name, step) in enumerate(steps.items()):
        arguments[name][2 * place] += step
        arguments[name][2 * place + 1] -= step
    output = model(**arguments)
    return {
        name: float(output[2 * place] - output[2 * place + 1])
        / float(arguments[name][2 * place] - arguments[name][2 * place + 1])
        for place, name in enumerate(steps)
    }


def first_order_sd(model: Model, middle: Mapping[str, float], scatter: Mapping[str, Distribution]) -> float:
    """Return the first-order (GUM) standard uncertainty at mid-limits, with each input's true sd.

    >>> from flexlash.tolerance import Normal
    >>> model = lambda a, b: a + b * b
    >>> round(first_order_sd(model, {"a": 0.0, "b": 2.0}, {"a": Normal(0, 3), "b": Normal(2, 1)}), 9)
    5.0
    """
    sds = {name: distribution.standard_deviation for name, distribution in scatter.items()}
    steps = {name: max(1e-3 * sd, 1e-6 * abs(middle[name])) for name, sd in sds.items()}
    slopes = gradient(model, middle, steps)
    return math.sqrt(sum((slopes[name] * sds[name]) ** 2 for name in sds))


@dataclass(frozen=True, kw_only=True)
class WorstCase:
    """Least and greatest output with every input at a limit; `swings` the outputs at one input's limits."""

    low: float
    high: float
    swings: dict[str, tuple[float, float]]


def worst_case(model: Model, ends: Mapping[str, tuple[float, float]]) -> WorstCase:
    """Return the least and greatest output of a monotone model with every input at one of its limits.

    Which limit hurts is found with the other inputs at the middle of theirs.

    >>> found = worst_case(lambda a, b: a - b, {"a": (1.0, 2.0), "b": (5.0, 7.0)})
    >>> found.low, found.high, found.swings["b"]
    (-6.0, -3.0, (-3.5, -5.5))
    """
    middle = {name: (low + high) / 2 for name, (low, high) in ends.items()}
    arguments = _table(middle, 2 * len(ends))
    for place, (name, limits) in enumerate(ends.items()):
        arguments[name][2 * place : 2 * place + 2] = limits
    output = model(**arguments)
    swings = {name: (float(output[2 * place]), float(output[2 * place + 1])) for place, name in enumerate(ends)}
    corners = _table(middle, 2)
    for name, limits in ends.items():
        at_low, at_high = swings[name]
        corners[name][:] = limits if at_high >= at_low else limits[::-1]
    least, greatest = model(**corners)
    return WorstCase(low=float(least), high=float(greatest), swings=swings)
