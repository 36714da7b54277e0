"""What the limits and the first derivatives say, without sampling: worst case and first-order spread.

Inputs are scalars or arrays (rows,); the model then meets arrays with one more axis in front.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import ndtri

from flexlash.schema.arrays import Array

__all__ = [
    "SD_STEP",
    "SIZE_STEP",
    "WorstCase",
    "first_order_sd",
    "first_order_slopes",
    "first_order_valid",
    "gradient",
    "worst_case",
]

Model = Callable[..., Array]
Number = Any
"""A float, or an array (rows,)."""


def _table(centre: Mapping[str, Number], rows: int) -> dict[str, Array]:
    """Return every input at its centre, `rows` times."""
    return {name: np.repeat(np.asarray(value, dtype=float)[None], rows, axis=0) for name, value in centre.items()}


def gradient(model: Model, centre: Mapping[str, Number], steps: Mapping[str, Number]) -> dict[str, Number]:
    """Return the partial derivatives of a model at a point, in its unit over that of each input.

    Equation: ∂y/∂xᵢ ≈ (y(xᵢ + hᵢ) − y(xᵢ − hᵢ))/(2 hᵢ)
    Arguments: the model of keyword arrays; centre and steps hᵢ in the units of the inputs, scalars or (rows,).
    Valid: smooth models and steps far above rounding.
    Source: central differences.

    >>> gradient(lambda a, b: a * b, {"a": 2.0, "b": 5.0}, {"a": 0.5})["a"].item()
    5.0
    """
    arguments = _table(centre, 2 * len(steps))
    for number, (name, step) in enumerate(steps.items()):
        arguments[name][2 * number] += step
        arguments[name][2 * number + 1] -= step
    output = model(**arguments)
    return {
        name: (output[2 * number] - output[2 * number + 1])
        / (arguments[name][2 * number] - arguments[name][2 * number + 1])
        for number, name in enumerate(steps)
    }


SD_STEP, SIZE_STEP = 1e-3, 1e-6
"""Part of a standard deviation by which a dimension is moved for its slope; at least this part of the dimension."""


def first_order_slopes(model: Model, middle: Mapping[str, Number], sds: Mapping[str, Number]) -> dict[str, Number]:
    """Return the partial derivatives that the first-order uncertainty takes, in the model's unit over the inputs'.

    Equation: as for `gradient`, with steps of 1e-3 sd, at least 1e-6 of the input
    Arguments: as for `first_order_sd`.
    Valid: as for `gradient`; what rounding leaves of slope times sd is 1e-13 of the output.
    Source: central differences.

    >>> round(first_order_slopes(lambda a: a * a, {"a": 2.0}, {"a": 0.1})["a"].item(), 9)
    4.0
    """
    return gradient(
        model, middle, {n: np.maximum(SD_STEP * sd, SIZE_STEP * np.abs(middle[n])) for n, sd in sds.items()}
    )


def first_order_sd(
    model: Model,
    middle: Mapping[str, Number],
    sds: Mapping[str, Number],
    ties: Iterable[tuple[str, str, Number]] = (),
) -> Number:
    """Return the first-order standard uncertainty at mid-limits, in the unit of the model.

    Equation: u² = Σ uᵢ² + 2 Σ rᵢⱼ uᵢ uⱼ, uᵢ = ∂y/∂xᵢ · sdᵢ
    Arguments: the model of keyword arrays; middle of the limits and each input's true sd, scalars or (rows,); Pearson's
        correlations r of the values of two inputs, each pair once.
    Valid: inputs independent but for these; a model close to linear over their spread (`first_order_valid`).
    Source: GUM (JCGM 100) 5.1.2, 5.2.2.

    >>> model = lambda a, b: a + b * b
    >>> round(float(first_order_sd(model, {"a": 0.0, "b": 2.0}, {"a": 3.0, "b": 1.0})), 9)
    5.0
    >>> round(float(first_order_sd(model, {"a": 0.0, "b": 2.0}, {"a": 3.0, "b": 1.0}, [("a", "b", -1.0)])), 9)
    1.0
    """
    slopes = first_order_slopes(model, middle, sds)
    total = 0.0
    for name, sd in sds.items():
        total = total + (slopes[name] * sd) * (slopes[name] * sd)
    for first, second, correlation in ties:
        total = total + 2 * correlation * (slopes[first] * sds[first]) * (slopes[second] * sds[second])
    # Where inputs that follow one another cancel out, rounding may leave less than nothing.
    return np.sqrt(np.maximum(total, 0.0))


def first_order_valid(
    estimate: Number, first_order: Number, interval: tuple[Number, Number], coverage: float, digits: int = 2
) -> Number:
    """Return whether the first-order interval does as well as another to the digits of its uncertainty.

    Equation: |y ∓ k u − end| ≤ δ at both ends, δ half a unit in the last of `digits` significant digits of u
    Arguments: estimate y, first-order uncertainty u and interval in the unit that is printed, since the same angle has
        its digits elsewhere in radians; scalars or (rows,).
    Valid: intervals of the same coverage; u is rounded in decimal as printed: 0.0996 is 0.10, and δ 0.005.
    Source: JCGM 101 clause 8.

    >>> [bool(first_order_valid(0.0, 2.0, (-end, end), 0.95)) for end in (3.92, 3.88)]
    [True, True]
    >>> bool(first_order_valid(0.0, 10.1, (-17.0, 17.0), 0.95))
    False
    """
    reach = float(ndtri((1 + coverage) / 2)) * first_order
    low, high = interval
    off = np.maximum(np.abs(estimate - reach - low), np.abs(estimate + reach - high))
    return off <= np.vectorize(_last_digit, otypes=[float])(first_order, digits) / 2


def _last_digit(value: float, digits: int) -> float:
    """Return one unit in the last of a number's significant digits.

    >>> _last_digit(0.0754, 2), _last_digit(9.96, 2)
    (0.001, 1.0)
    """
    power = int(f"{value or 1.0:.{digits - 1}e}".partition("e")[2])
    return float(f"1e{power - digits + 1}")


@dataclass(frozen=True, kw_only=True)
class WorstCase:
    """Least and greatest output with every input at a limit; `swings` the outputs at one input's limits, low first."""

    low: Number
    high: Number
    swings: dict[str, tuple[Number, Number]]


def worst_case(model: Model, ends: Mapping[str, tuple[Number, Number]]) -> WorstCase:
    """Return the least and greatest output with every input at one of its limits, in the unit of the model.

    Equation: y at the corner of the limits that raises, or lowers, the output in every input
    Arguments: the model of keyword arrays; low and high limit of each input, scalars or (rows,).
    Valid: models that rise or fall in each input; which limit raises is seen with the others in the middle of theirs.
    Source: worst-case tolerancing.

    >>> worst = worst_case(lambda a, b: a - b, {"a": (1.0, 2.0), "b": (5.0, 7.0)})
    >>> float(worst.low), float(worst.high), [float(end) for end in worst.swings["b"]]
    (-6.0, -3.0, [-3.5, -5.5])
    """
    middle = {name: (low + high) / 2 for name, (low, high) in ends.items()}
    arguments = _table(middle, 2 * len(ends))
    for number, (name, limits) in enumerate(ends.items()):
        arguments[name][2 * number], arguments[name][2 * number + 1] = limits
    output = model(**arguments)
    swings = {name: (output[2 * number], output[2 * number + 1]) for number, name in enumerate(ends)}
    corners = _table(middle, 2)
    for name, (low, high) in ends.items():
        at_low, at_high = swings[name]
        rising = at_high >= at_low
        corners[name][0], corners[name][1] = np.where(rising, low, high), np.where(rising, high, low)
    least, greatest = model(**corners)
    return WorstCase(low=least, high=greatest, swings=swings)
