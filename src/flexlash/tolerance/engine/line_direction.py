"""Which way lines run: the direction in which the output rises fastest, and the order in which inputs meet the net."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.tolerance.distributions import Distribution, Normal

__all__ = ["Indices", "Inputs", "LineDirection", "RowModel", "direction_of", "scores_across"]

_SECANT = np.array([-1.5, -0.75, 0.75, 1.5])
"""Scores between which rise and curvature are taken."""

_SLANT = 0.1
"""The input that closes the plane has at least this part of the greatest squared component of the direction."""

Indices = npt.NDArray[np.intp]
RowModel = Callable[[Mapping[str, Array], Indices], Array]
"""The outputs (k, columns) at inputs (k, columns) by name; each column belongs to the row of that index."""


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
    def single_curved(self) -> bool:
        """Whether all distributions but one are normal, so that the output curves with one score alone."""
        return [shape.shape != Normal.shape for shape in self.shapes].count(True) == 1

    def take(self, rows: Indices) -> Inputs:
        """Return some of the rows."""
        return replace(self, location=self.location[:, rows], scale=self.scale[:, rows])


@dataclass(frozen=True, kw_only=True)
class LineDirection:
    """The direction of the lines of each row, and the order in which inputs meet the net.

    `vector` (inputs, rows) has the length 1, and 0 where the output does not change; `order` (inputs, rows) ends with
    the input that closes the plane across the direction.
    """

    vector: Array
    order: Indices

    def take(self, rows: Indices) -> LineDirection:
        """Return some of the rows."""
        return LineDirection(vector=self.vector[:, rows], order=self.order[:, rows])


def direction_of(model: RowModel, inputs: Inputs) -> LineDirection:
    """Return the direction in which the output rises fastest, by secants over the middle of each input.

    What lines do not even out is the curvature of the output in the single inputs: the more curved, the earlier an
    input comes in the order, so that the best coordinates of the net serve it.

    Equation: αᵢ ∝ y(uᵢ = 1.5) − y(uᵢ = −1.5), the others at their medians
    Arguments: model and inputs of rows alike.
    Valid: any model; an output that changes by less than rounding has no direction.
    Source: Koutsourelakis, Pradlwarter and Schuëller 2004 take the gradient; secants see past small waves.
    """
    count = len(inputs.names)
    probes = len(_SECANT)
    arguments = {}
    for index, name in enumerate(inputs.names):
        score = np.zeros((probes * count, 1))
        score[probes * index : probes * (index + 1), 0] = _SECANT
        standard = inputs.shapes[index].standard_at(score)
        arguments[name] = inputs.location[index] + inputs.scale[index] * standard
    output = model(arguments, np.arange(inputs.count)).reshape(count, probes, inputs.count)
    low, inner_low, inner_high, high = (output[:, probe] for probe in range(probes))
    rise = (high - low) / 2
    curvature = np.abs(high - low - 2 * (inner_high - inner_low)) + np.abs(high + low - inner_high - inner_low)
    length = np.sqrt(np.cumsum(rise * rise, axis=0)[-1])
    noise = 64 * np.finfo(float).eps * np.abs(output).max(axis=(0, 1))
    steady = np.isfinite(length) & (length > noise)
    vector = np.where(steady, rise / np.where(steady, length, 1.0), 0.0)
    slant = vector * vector
    last = np.argmin(np.where(slant >= _SLANT * slant.max(axis=0), curvature, np.inf), axis=0)
    curvature[last, np.arange(inputs.count)] = -1.0
    return LineDirection(vector=vector, order=np.argsort(-curvature, axis=0, kind="stable"))


def scores_across(direction: LineDirection, net: Array) -> Array:
    """Return scores (inputs, rows, lines) of points in the planes across the directions.

    Equation: u = L w with L Lᵀ = 1 − ααᵀ, so that αᵀu = 0
    Arguments: the directions of rows alike; net of standard normal scores w (inputs − 1, lines).
    Valid: a direction of length 1; where it is 0 the points are the net's.
    Source: the Cholesky factor of the covariance across α in closed form: each input has a coordinate of its own, and
        what keeps it in the plane.
    """
    vector = np.take_along_axis(direction.vector, direction.order, axis=0)
    squares = vector * vector
    remaining = np.concatenate([np.cumsum(squares[::-1], axis=0)[::-1], np.zeros((1, vector.shape[1]))])
    remaining = np.where(remaining > 0, remaining, 1.0)
    scores = np.empty((*vector.shape, net.shape[1]))
    gathered = np.zeros(scores.shape[1:])
    for index, coordinate in enumerate(net):
        before, after = remaining[index], remaining[index + 1]
        scores[index] = np.sqrt(after / before)[:, None] * coordinate - vector[index][:, None] * gathered
        gathered += (vector[index] / np.sqrt(before * after))[:, None] * coordinate
    scores[-1] = -vector[-1][:, None] * gathered
    sorted_back = np.empty_like(scores)
    np.put_along_axis(sorted_back, direction.order[:, :, None], scores, axis=0)
    return sorted_back
