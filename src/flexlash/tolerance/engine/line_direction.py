"""Which way lines run: the direction in which the output rises fastest, and the order in which inputs meet the net."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import Distribution, Normal

__all__ = ["Inputs", "LineDirection", "RowModel", "Rows", "across", "direction_of"]

_SECANT = np.array([-1.5, -0.75, 0.75, 1.5])
"""Scores between which rise and curvature are taken."""

_SLANT = 0.1
"""The input that closes the plane has at least this part of the greatest squared component of the direction."""

Rows = npt.NDArray[np.intp]
RowModel = Callable[[Mapping[str, Array], Rows], Array]
"""The outputs (k, L) at inputs (k, L) by name; L columns belong to the rows given."""


@dataclass(frozen=True, kw_only=True)
class Inputs:
    """What varies in rows alike: distributions of the same shapes, each with a location and a scale per row.

    `location` and `scale` are (inputs, rows).
    """

    names: tuple[str, ...]
    shapes: tuple[Distribution, ...]
    location: Array
    scale: Array

    @classmethod
    def of(cls, rows: Sequence[Mapping[str, Distribution]]) -> Inputs:
        """Return the inputs of rows whose distributions have the same names and shapes."""
        names = tuple(rows[0])
        return cls(
            names=names,
            shapes=tuple(rows[0].values()),
            location=np.array([[row[name].location for row in rows] for name in names]),
            scale=np.array([[row[name].scale for row in rows] for name in names]),
        )

    @property
    def count(self) -> int:
        """Rows."""
        return int(self.location.shape[1])

    @property
    def one_bent(self) -> bool:
        """Whether all distributions but one are normal, so that the output bends with one score alone."""
        return [shape.shape != Normal.shape for shape in self.shapes].count(True) == 1

    def take(self, rows: Rows) -> Inputs:
        """Return some of the rows."""
        return replace(self, location=self.location[:, rows], scale=self.scale[:, rows])


@dataclass(frozen=True, kw_only=True)
class LineDirection:
    """The direction of the lines of each row, a unit vector (inputs, rows), and the order in which inputs meet the net.

    `direction` is 0 where the output does not change; `order` (inputs, rows) ends with the input that closes the plane
    across the direction.
    """

    direction: Array
    order: Rows

    def take(self, rows: Rows) -> LineDirection:
        """Return some of the rows."""
        return LineDirection(direction=self.direction[:, rows], order=self.order[:, rows])


def direction_of(model: RowModel, inputs: Inputs) -> LineDirection:
    """Return the course of lines along which the output rises fastest, by secants over the middle of each input.

    What lines do not even out is the curvature of the output in the single inputs: the more curved, the earlier an
    input comes in the order, so that the best coordinates of the net serve it.
    """
    count = len(inputs.names)
    probes = len(_SECANT)
    arguments = {}
    for place, name in enumerate(inputs.names):
        score = np.zeros((probes * count, 1))
        score[probes * place : probes * (place + 1), 0] = _SECANT
        standard = inputs.shapes[place].standard_at(score)
        arguments[name] = inputs.location[place] + inputs.scale[place] * standard
    output = model(arguments, np.arange(inputs.count)).reshape(count, probes, inputs.count)
    low, inner_low, inner_high, high = (output[:, probe] for probe in range(probes))
    rise = (high - low) / 2
    curvature = np.abs(high - low - 2 * (inner_high - inner_low)) + np.abs(high + low - inner_high - inner_low)
    length = np.sqrt(np.cumsum(rise * rise, axis=0)[-1])
    noise = 64 * np.finfo(float).eps * np.abs(output).max(axis=(0, 1))
    steady = np.isfinite(length) & (length > noise)
    direction = np.where(steady, rise / np.where(steady, length, 1.0), 0.0)
    slant = direction * direction
    last = np.argmin(np.where(slant >= _SLANT * slant.max(axis=0), curvature, np.inf), axis=0)
    curvature[last, np.arange(inputs.count)] = -1.0
    return LineDirection(direction=direction, order=np.argsort(-curvature, axis=0, kind="stable"))


def across(course: LineDirection, net: Array) -> Array:
    """Return scores (inputs, rows, lines) of points in the planes across the directions.

    `net` are standard normal scores (inputs − 1, lines). The scores across α have the covariance 1 − ααᵀ; its Cholesky
    factor gives each input a coordinate of its own and what keeps it in the plane.
    """
    direction = np.take_along_axis(course.direction, course.order, axis=0)
    squares = direction * direction
    left = np.concatenate([np.cumsum(squares[::-1], axis=0)[::-1], np.zeros((1, direction.shape[1]))])
    left = np.where(left > 0, left, 1.0)
    scores = np.empty((*direction.shape, net.shape[1]))
    gathered = np.zeros(scores.shape[1:])
    for place, coordinate in enumerate(net):
        before, after = left[place], left[place + 1]
        scores[place] = np.sqrt(after / before)[:, None] * coordinate - direction[place][:, None] * gathered
        gathered += (direction[place] / np.sqrt(before * after))[:, None] * coordinate
    scores[-1] = -direction[-1][:, None] * gathered
    placed = np.empty_like(scores)
    np.put_along_axis(placed, course.order[:, :, None], scores, axis=0)
    return placed
