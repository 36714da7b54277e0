"""Which way lines run: the direction in which the output rises fastest, and the order in which inputs meet the net."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.tolerance.correlation import correlated_scores
from flexlash.tolerance.distributions import Distribution, Normal

__all__ = ["Indices", "Inputs", "LineDirection", "RowModel", "direction_of", "scores_across"]

_SECANT = np.array([-1.5, -0.75, 0.75, 1.5])
"""Scores between which rise and curvature are taken."""

_SLANT = 0.1
"""The input that closes the plane has at least this part of the greatest squared component of the direction."""

_SINGULAR = 1e-6
_GOES = 0.2
"""The least part of its own rise by which an input goes along with others; tried from 0 to 1 on sums and products."""

Indices = npt.NDArray[np.intp]
RowModel = Callable[[Mapping[str, Array], Indices], Array]
"""The outputs (k, columns) at inputs (k, columns) by name; each column belongs to the row of that index."""


@dataclass(frozen=True, kw_only=True)
class Inputs:
    """What varies in rows alike: distributions of the same shapes, each with a location and a scale per row.

    `location` and `scale` are (inputs, rows). `factor` (inputs, inputs) makes the inputs' correlated scores out of
    independent ones, where directions, nets and lines are; None where the inputs are independent.
    """

    names: tuple[str, ...]
    shapes: tuple[Distribution, ...]
    location: Array
    scale: Array
    factor: Array | None = None

    @classmethod
    def of(cls, rows: Sequence[Mapping[str, Distribution]], factor: Array | None = None) -> Inputs:
        """Return the inputs of rows whose distributions have the same names and shapes."""
        names = tuple(rows[0])
        return cls(
            names=names,
            shapes=tuple(rows[0].values()),
            location=np.array([[row[name].location for row in rows] for name in names]),
            scale=np.array([[row[name].scale for row in rows] for name in names]),
            factor=factor,
        )

    @property
    def count(self) -> int:
        """Rows."""
        return int(self.location.shape[1])

    @property
    def single_curved(self) -> bool:
        """Whether all that is not normal follows one independent score, so that the output curves with it alone."""
        curved = np.array([shape.shape != Normal.shape for shape in self.shapes])
        return bool(np.count_nonzero(curved if self.factor is None else self.factor[curved].any(axis=0)) == 1)

    def correlated(self, scores: Array) -> Array:
        """Return the scores of the inputs (inputs, …) that independent scores (inputs, …) make."""
        return scores if self.factor is None else np.stack(correlated_scores(self.factor, list(scores)))

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

    Equation: αᵢ ∝ y(zᵢ = 1.5) − y(zᵢ = −1.5), the other independent scores at 0
    Arguments: model and inputs of rows alike.
    Valid: any model; an output that changes by less than rounding has no direction.
    Source: Koutsourelakis, Pradlwarter and Schuëller 2004 take the gradient; secants see past small waves.
    """
    output = _probed(model, inputs)
    low, inner_low, inner_high, high = (output[:, probe] for probe in range(len(_SECANT)))
    rise = (high - low) / 2
    if inputs.factor is not None and any(shape.shape != Normal.shape for shape in inputs.shapes):
        alone = _probed(model, replace(inputs, factor=None))
        rise = _with_every_input(rise, inputs.factor, alone[:, -1] - alone[:, 0])
    curvature = np.abs(high - low - 2 * (inner_high - inner_low)) + np.abs(high + low - inner_high - inner_low)
    length = np.sqrt(np.cumsum(rise * rise, axis=0)[-1])
    noise = 64 * np.finfo(float).eps * np.abs(output).max(axis=(0, 1))
    steady = np.isfinite(length) & (length > noise)
    vector = np.where(steady, rise / np.where(steady, length, 1.0), 0.0)
    slant = vector * vector
    last = np.argmin(np.where(slant >= _SLANT * slant.max(axis=0), curvature, np.inf), axis=0)
    curvature[last, np.arange(inputs.count)] = -1.0
    return LineDirection(vector=vector, order=np.argsort(-curvature, axis=0, kind="stable"))


def _probed(model: RowModel, inputs: Inputs) -> Array:
    """Return the outputs (inputs, secants, rows) with one independent score after the other at the secants."""
    count, probes = len(inputs.names), len(_SECANT)
    scores = np.zeros((count, probes * count, 1))
    for index in range(count):
        scores[index, probes * index : probes * (index + 1), 0] = _SECANT
    scores = inputs.correlated(scores)
    arguments = {
        name: inputs.location[index] + inputs.scale[index] * inputs.shapes[index].standard_at(scores[index])
        for index, name in enumerate(inputs.names)
    }
    return np.asarray(model(arguments, np.arange(inputs.count)).reshape(count, probes, inputs.count))


def _with_every_input(rise: Array, factor: Array, alone: Array) -> Array:
    """Return the nearest rise along which every input moves the way in which it raises the output by itself.

    Where inputs are correlated the output may rise fastest while one of them goes the wrong way, pulled by the others;
    near the limits of bounded inputs it would then fall. Any direction serves lines, if the output only rises along it.

    Equation: the α nearest to d with sᵢ (L α)ᵢ ≥ κ |gᵢ|: α = d + Aᵀ λ with the λ ≥ 0 that makes ‖d − κ L⁻¹ g + Aᵀ λ‖
        least, A = diag(s) L
    Arguments: the rise d by independent scores, the rise g with the signs s by each input alone, (inputs, rows) each;
        the factor L, whose pseudo-inverse serves where inputs follow others.
    Valid: rows whose rise is finite; one along which no input goes the wrong way stays as it is.
    Source: projection on a polyhedral cone by its dual (Moreau 1962), non-negative least squares (Lawson and Hanson).
    """
    from scipy.optimize import nnls

    nearest = rise.copy()
    inverse = np.linalg.pinv(factor, rcond=_SINGULAR)
    for row, (wanted, own) in enumerate(zip(rise.T, alone.T, strict=True)):
        ways = np.sign(own)[:, None] * factor
        if np.isfinite(wanted).all() and np.isfinite(own).all() and (ways @ wanted).min() < 0:
            least = _GOES * (inverse @ own)
            pull, _ = nnls(ways.T, least - wanted)
            nearest[:, row] = wanted + ways.T @ pull
    return nearest


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
    before, after = remaining[:-2], remaining[1:-1]
    scores = np.zeros((*vector.shape, net.shape[1]))
    # What the inputs before have left for one to make up for.
    np.cumsum((vector[:-1] / np.sqrt(before * after))[:, :, None] * net[:, None], axis=0, out=scores[1:])
    scores *= -vector[:, :, None]
    scores[:-1] += np.sqrt(after / before)[:, :, None] * net[:, None]
    sorted_back = np.empty_like(scores)
    np.put_along_axis(sorted_back, direction.order[:, :, None], scores, axis=0)
    return sorted_back
