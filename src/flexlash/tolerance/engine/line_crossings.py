"""Where curves along lines, tabulated at the nodes, cross an output."""

from __future__ import annotations

import numpy as np

from flexlash.schema.arrays import Array

__all__ = ["FAR", "NODES", "STEP", "crossings", "values_at"]

STEP = 0.5
"""Step of the nodes; what cubics between them miss is corrected on the curves themselves."""

NODES = np.arange(-8.0, 8.0 + STEP / 2, STEP)
"""Positions on each line at which curves are tabulated."""

FAR = 8.5
"""The position of a crossing that a line does not have: Φ(−FAR) is nothing beside 1."""

_FEW = 1 << 10
"""Crossings up to which all nodes are compared at once."""

_LAST = 2
"""The last of the three intervals between four nodes."""


def crossings(table: Array, outputs: Array) -> tuple[Array, Array]:
    """Return the positions where curves cross outputs, and their slopes there, (levels, curves) each.

    Equation: the cubic through the four nodes around, solved by Newton's rule from the secant
    Arguments: table (nodes, curves) of curves that only rise; outputs (levels, curves) in its unit.
    Valid: beyond the table the position is ±FAR.
    Source: Lagrange interpolation.
    """
    width = table.shape[1]
    if outputs.size <= _FEW:
        passed = np.add.reduce(table[:, None] <= outputs, axis=0, dtype=np.int8)
    else:
        passed = np.zeros(outputs.shape, dtype=np.int8)
        for node in table:
            passed += (node <= outputs).view(np.int8)
    base = np.minimum(np.maximum(passed - np.int8(2), np.int8(0)), np.int8(len(NODES) - 4))
    index = base * np.int64(width) + np.arange(width)
    first, second, third, fourth = (table.reshape(-1).take(index + shift * width) for shift in range(4))
    interval = np.minimum(np.maximum(passed - np.int8(1) - base, 0), _LAST)
    low, starts, ends = interval.astype(float), interval == 0, interval == _LAST
    below = np.where(starts, first, np.where(ends, third, second))
    above = np.where(starts, second, np.where(ends, fourth, third))
    secant = above - below
    inside = (passed > 0) & (passed < len(NODES))
    secant = np.where(secant > 0, secant, 1.0)
    bend, twist = third - 2 * second + first, (fourth - 3 * third + 3 * second - first) / 3
    rise = second - first
    part = low + (outputs - below) / secant
    for _ in range(2):
        value = first + part * (rise + (part - 1) / 2 * (bend + (part - 2) * twist))
        part = part + (outputs - value) / _slope(part, rise, bend, twist, secant)
        part = np.minimum(np.maximum(part, low), low + 1)
    slope = _slope(part, rise, bend, twist, secant) / STEP
    position = NODES[0] + STEP * (base + part)
    outside = np.where(passed == 0, -FAR, FAR)
    return np.where(inside, position, outside), slope


def values_at(table: Array, positions: Array) -> tuple[Array, Array]:
    """Return the values of tabulated curves at positions, and their slopes there, (levels, curves) each.

    Equation: the cubic through the four nodes around
    Arguments: table (nodes, curves); positions (levels, curves), taken as the nearest end where they lie beyond.
    Valid: smooth curves.
    Source: Lagrange interpolation.
    """
    part = (np.minimum(np.maximum(positions, NODES[0]), NODES[-1]) - NODES[0]) / STEP
    base = np.minimum(np.maximum(part.astype(np.int64) - 1, 0), len(NODES) - 4)
    part = part - base
    index = base * table.shape[1] + np.arange(table.shape[1])
    first, second, third, fourth = (table.reshape(-1).take(index + shift * table.shape[1]) for shift in range(4))
    rise, bend = second - first, third - 2 * second + first
    twist = (fourth - 3 * third + 3 * second - first) / 3
    value = first + part * (rise + (part - 1) / 2 * (bend + (part - 2) * twist))
    return value, _slope(part, rise, bend, twist, np.zeros_like(rise)) / STEP


def _slope(part: Array, rise: Array, bend: Array, twist: Array, secant: Array) -> Array:
    """Return the slopes of cubics through four values a unit apart, no less than a tenth of the secant's."""
    slope = rise + (part - 0.5) * bend + (1.5 * part * part - 3 * part + 1) * twist
    return np.maximum(slope, 0.1 * secant)
