"""Whether the output along lines is smooth, where a table alone cannot tell: steps, bends, dips, or only steep.

A model that rises in steps has a table like that of a smooth one as soon as its steps are narrower than the distance
of the nodes. Close together they part: a smooth output is nearly straight there, a stepped one is flat or jumps.

Equation: r = |Σ nᵢ y(t + δᵢ)|/(y(t + δ₄) − y(t + δ₁)), n across every quadratic through four points: y‴δ³/(y′δ) or less
Valid: steps from 0.001 to 1 standard deviation of the output; narrower ones move no percentile by more than half that.
Source: divided differences of third order.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.tolerance.engine.line_points import normal_density

__all__ = ["ALMOST_STRAIGHT", "LineOutputs", "Looked", "is_stepped", "looked_closely"]

Indices: TypeAlias = npt.NDArray[np.intp]
Bools: TypeAlias = npt.NDArray[np.bool_]
LineOutputs: TypeAlias = Callable[[Indices, Array], Array]
"""The outputs (k, n) on some n lines, by their indices, at positions (k, 1) or (k, n)."""

ALMOST_STRAIGHT = 1e-5
"""A table that the model follows this closely, in steps of it, hides no steps worth looking for."""

_WINDOW = 0.01 * np.array([-1.0, -0.4, 0.15, 1.0])
"""Points of a window about a position; unevenly, so that no width of steps fits them all."""

_SPAN = float(_WINDOW[-1] - _WINDOW[0])
"""Width of a window, in scores."""

_FAR_OUT, _PLACES = 2.9, 2
"""How far out the windows are spread, and how many lie on each line that is looked at."""

_BENT = 0.003
"""A window whose points lie further off a quadratic than this part of its rise is not smooth."""

_STEPPED = 3
"""Windows that are not smooth from which the output is stepped: a single bend lies in one of them at most."""

_SLOWER = 0.01
"""A window is flat that rises by no more than rounding, where this part of the table's slope would rise by more."""

_ROUNDING = 64 * np.finfo(float).eps
"""Part of the size of an output below which its differences are rounding."""

_INSIDE = 5.0
"""How far out a closer look goes on; further out inputs come to the end of their own reach, which is a bend."""

_DENSE, _FINER, _ZOOMS = 16, 16, 2
"""Points a unit of score of a closer look, how much finer each next one is, and how many follow."""

_PRECISION = 1e-3
"""How well mean and sd follow from the table of an output that is not steep, in standard deviations."""

_SINGULAR = 0.1
"""A third difference of this part of the rise around it, however close one looks, is a jump or a bend."""

_JUMPED = 0.5
"""Part of the rise that is left in the closest look where it is a jump; that of a bend falls with the distance."""


def _across_quadratics() -> Array:
    """Return the unit vector (4,) across every quadratic in the points of a window."""
    powers = np.vander(_WINDOW / _WINDOW[-1], 3, increasing=True)
    return np.asarray(np.linalg.svd(powers.T)[2][-1])


_ACROSS = _across_quadratics()[:, None]


def is_stepped(outputs: LineOutputs, lines: Indices, nodes: Array, table: Array) -> Bools:
    """Return which rows rise in steps, by windows of a few points on some of their lines.

    Arguments: outputs of lines; lines (rows, n) that are looked at; nodes (k,) and the table (k, rows × n) of outputs
        on these lines.
    """
    rows, count = lines.shape
    number = np.arange(_PLACES * count).reshape(_PLACES, count)
    # Each line has positions of its own, so that together they are close.
    position = np.tile(_FAR_OUT * ((2 * number + 1) / (_PLACES * count) - 1), rows)
    points = position[:, None] + _WINDOW[:, None]
    values = outputs(lines.ravel(), points.reshape(-1, rows * count)).reshape(points.shape)
    rise = values[:, -1] - values[:, 0]
    rounding = _ROUNDING * np.abs(values).max(axis=1)
    below, column = np.searchsorted(nodes, position, side="right") - 1, np.arange(rows * count)
    expected = (table[below + 1, column] - table[below, column]) * _SPAN / (nodes[1] - nodes[0])
    flat = (np.abs(rise) <= rounding) & (_SLOWER * expected > rounding)
    off, usual = np.abs((_ACROSS * (values - values[:, :1])).sum(axis=1)), np.maximum(np.abs(rise), expected)
    uneven = flat | ((off > _BENT * usual) & (off > rounding))
    return np.asarray(uneven.reshape(_PLACES, rows, count).sum(axis=(0, 2)) >= _STEPPED)


@dataclass(frozen=True, kw_only=True)
class Looked:
    """What a closer look finds on lines, the worst first."""

    falls: bool
    jumps: bool
    bends: bool
    steep: bool


def looked_closely(outputs: LineOutputs, lines: Indices, nodes: Array, table: Array | None, slack: Array) -> Looked:
    """Return what is found where each line is least smooth, looked at closer and closer.

    Steep is an output whose moments cannot be had from its table, or from twice the spacing of a first close look.

    Arguments: outputs of lines; lines (n,) that are looked at; nodes (k,) and the table (k, n) of outputs on them, None
        where moments do not come from it; slack (n,) within which a fall is rounding.
    """
    width = 1 / _DENSE
    positions = np.arange(nodes[0], nodes[-1] + width / 2, width)[:, None]
    values = outputs(lines, positions)
    falls = (np.diff(values, axis=0) < -slack).any()
    coarse = (positions[::2], values[::2]) if table is None else (nodes[:, None], table)
    steep = _moments_differ(coarse, (positions, values))
    inside = np.abs(positions[:, 0]) <= _INSIDE
    place, ratio, first = _least_smooth(values[inside])
    start, rise = width * place - _INSIDE, first
    for _ in range(_ZOOMS):
        width = width / _FINER
        values = outputs(lines, start + width * np.arange(3 * _FINER + 1)[:, None])
        falls |= (np.diff(values, axis=0) < -slack).any()
        place, ratio, rise = _least_smooth(values)
        start = start + width * place
    jumps = (ratio > _SINGULAR) & (rise > _JUMPED * first)
    bends = (ratio > _SINGULAR) & ~jumps
    return Looked(falls=bool(falls), jumps=bool(jumps.any()), bends=bool(bends.any()), steep=steep)


def _moments_differ(*rules: tuple[Array, Array]) -> bool:
    """Return whether mean or sd of outputs (k, lines) at positions (k, 1) differ from one spacing to another."""
    positions, values = rules[-1]
    centre = (_weights(positions) * values).sum(axis=0)
    means = [(_weights(at) * (one - centre)).sum(axis=0).mean() for at, one in rules]
    squares = [(_weights(at) * (one - centre) ** 2).sum(axis=0).mean() for at, one in rules]
    # A square that is off by twice as much puts its root off by as much.
    return bool(
        abs(means[0] - means[1]) > _PRECISION * np.sqrt(squares[1])
        or abs(squares[0] - squares[1]) > 2 * _PRECISION * squares[1]
    )


def _weights(positions: Array) -> Array:
    """Return weights (k, 1) of even positions (k, 1): the normal density, faded out where a sum would feel its end."""
    weights = normal_density(positions) * (1 - (positions / positions[-1]) ** 2) ** 2
    return np.asarray(weights / weights.sum())


def _least_smooth(values: Array) -> tuple[Array, Array, Array]:
    """Return where values (k, lines) are least smooth: the first of four points, how far from it, the greatest step.

    The measure is the third difference over the rise of the four; one of rounding counts nothing.
    """
    step = np.diff(values, axis=0)
    third = np.abs(step[2:] - 2 * step[1:-1] + step[:-2])
    rise = values[3:] - values[:-3]
    third = np.where(third > 8 * _ROUNDING * np.abs(values).max(axis=0), third, 0.0)
    ratio = third / np.where(rise > 0, rise, np.inf)
    place = ratio.argmax(axis=0)
    column = np.arange(values.shape[1])
    greatest = np.maximum(np.maximum(step[:-2], step[1:-1]), step[2:])
    return place.astype(float), ratio[place, column], greatest[place, column]
