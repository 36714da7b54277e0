"""Where the process behind a row of Tolerances has its mean, and how it scatters about it.

A process is what parts do, whatever their drawing says: its mean may lie off the middle of the limits, its standard
deviation may be its own, that of a capability, or that of a sample. What is said of one size holds for arrays of sizes,
to the bit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.schema.variant import FAR, MeasuredDimension, ToleranceRow
from flexlash.tolerance.measured import Measured

__all__ = ["Output", "harmful_sides", "measured_ends", "measured_shape", "process_of", "sides_of"]

Output: TypeAlias = Callable[[Mapping[str, Array]], Array]
"""The output of a part, which the harmful side of its limits raises, as a function of its dimensions."""

_Size: TypeAlias = Any
"""A float, or an array (variants,)."""


def process_of(row: ToleranceRow, nominal: _Size, low: _Size, high: _Size, sides: _Size) -> tuple[_Size, _Size | None]:
    """Return what the mean lies above the middle of the limits, and the sd where the limits do not tell it [SI].

    Equation: shift = x̄ − (low + high)/2 and s of a sample, whose x̄ is the nominal value and the mean of deviations;
        else shift as entered, or the share of the width that Cp and Cpk leave, to the harmful side
    Arguments: the row; entered value and limits [SI], side ±1 that raises the output; floats or arrays (variants,).
    Valid: limits that differ.
    Source: ISO 22514-2 (capability); definition.

    >>> row = ToleranceRow(row=3, tolerance_class="own", dimension="wall_thickness", harmful_shift=0.25)
    >>> process_of(row, 5.0, 4.0, 8.0, -1.0)
    (-1.0, None)
    """
    if row.sample is not None:
        centre = nominal + row.sample.mean if row.sample.are_deviations else row.sample.mean
        return centre - (low + high) / 2, row.sample.standard_deviation
    unit = nominal if row.relative else 1.0
    shift = row.mean_shift * unit
    if row.harmful_shift:
        shift = shift + sides * row.harmful_shift * (high - low)
    return shift, None if row.sd is None else row.sd * abs(unit)


def harmful_sides(dimension: str, sizes: Mapping[str, Array], low: Array, high: Array, output: Output) -> Array:
    """Return 1 where a dimension's upper limit gives the greater output, −1 where the lower one does.

    Equation: sign of y(high) − y(low), the other dimensions as entered; 1 where both are alike
    Arguments: name of the dimension; sizes of all dimensions, its limits [SI], arrays (variants,); model of the output.
    Valid: outputs that rise or fall between the limits.
    Source: definition.

    >>> size, half = np.array([5.0]), np.array([1.0])
    >>> harmful_sides("wall", {"wall": size}, size - half, size + half, lambda part: 1 / part["wall"])
    array([-1.])
    """
    with np.errstate(all="ignore"):
        at_low, at_high = (output({**sizes, dimension: end}) for end in (low, high))
    return np.where(at_high >= at_low, 1.0, -1.0)


def sides_of(row: ToleranceRow, sizes: Mapping[str, Array], low: Array, high: Array, output: Output | None) -> Array:
    """Return the side of the limits of a row that raises the output; 1 where the row does not ask for it."""
    if not row.harmful_shift:
        return np.ones(len(low))
    if output is None:
        raise LookupError(f"which limit of {row.dimension} is harmful takes a model of the output")
    return harmful_sides(row.dimension, sizes, low, high, output)


@lru_cache(maxsize=256)
def measured_shape(sample: MeasuredDimension) -> Measured:
    """Return the distribution through the values of a sample."""
    return Measured(sample.values)


@lru_cache(maxsize=256)
def measured_ends(sample: MeasuredDimension) -> tuple[float, float]:
    """Return the standard values at which the distribution through a sample ends."""
    low, high = measured_shape(sample).standard_at(np.array([-FAR, FAR])).tolist()
    return low, high
