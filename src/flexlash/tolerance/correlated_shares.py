"""Which input causes how much where inputs are correlated: Sobol' indices of clusters, shared out by Shapley's value.

What correlated inputs cause cannot be told apart: where two thicknesses scatter together, either moves the output in
the other's name, and Sobol' indices of single inputs overlap. A cluster as a whole is independent of all others, so it
has Sobol' indices as an input has: first-order Var(E[y | cluster])/Var y, total E[Var(y | all but the cluster)]/Var y.
Within it Shapley's value shares them out: it leaves nothing over, treats alike what causes the same, and is never
negative here. Inputs outside clusters keep their Sobol' indices; what first-order shares leave to 1 is interaction.

    coalition       some of the inputs of a cluster; its worth is the index of its inputs together
    projection      the matrix that takes scores to their expectation when a coalition's scores alone are known
    move            change of the output where a coalition goes from its scores in one set of points to those in another
    effect          what an input does by itself, the others at their medians, as a series of Hermite polynomials
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array
from flexlash.tolerance.correlation import clusters_of
from flexlash.tolerance.hermite_series import hermite_polynomials
from flexlash.tolerance.shapley_weights import coalitions

__all__ = ["ScoreModel", "caused_variance"]

Indices: TypeAlias = npt.NDArray[np.intp]
ScoreModel: TypeAlias = Callable[[Array], Array]
"""The outputs (rows, replicates, points) at correlated scores (inputs, replicates, points)."""

_TERMS = 8
"""Terms of an effect: up to the seventh power of the score."""

_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(10)
_SINGULAR = 1e-9
"""Eigenvalues of correlations below are rounding."""


def caused_variance(model: ScoreModel, matrix: Array, first: Array, second: Array) -> Array:
    """Return what each input causes of the variance, first-order and total: (2, inputs, rows, replicates).

    Equation: Shapley's value over the coalitions S of a cluster of v(S) = Var(E[y | x_S]) for the first-order, and of
        v(S) = E[Var(y | all but x_S)] for the total shares
    Arguments: the model of scores; their correlations (inputs, inputs); two sets of correlated scores (inputs,
        replicates, points), independent of one another and between replicates.
    Valid: any model with a variance.
    Source: Owen 2014; Song, Nelson and Staum 2016; Owen and Prieur 2017 (Shapley's value where inputs are dependent);
        Jacques, Lavergne and Devictor 2006 (indices of clusters).
    """
    sides = _Sides(model, matrix, first, second)
    caused = np.zeros((2, len(matrix), *sides.values[0].shape[:2]))
    tied = clusters_of(matrix)
    alone = [[index] for index in range(len(matrix)) if not any(index in cluster for cluster in tied)]
    for cluster in tied + alone:
        for members, weights in coalitions(len(cluster), first.shape[1]):
            used = np.flatnonzero(weights.any(axis=0))
            worth = sides.worth(cluster, [cluster[member] for member in members], used)
            for index, weight in zip(cluster, weights[:, used], strict=True):
                caused[:, index][:, :, used] += weight * worth
    return caused


class _Sides:
    """A model at two sets of points, and its moves between them."""

    def __init__(self, model: ScoreModel, matrix: Array, first: Array, second: Array) -> None:
        self._model = model
        self._matrix = matrix
        self._scores = first, second
        self.values = model(first), model(second)
        self._effects = _effects(model, len(matrix))

    def worth(self, cluster: Sequence[int], coalition: Sequence[int], replicates: Indices) -> Array:
        """Return the parts of the variance that a coalition causes, first-order and total: (2, rows, replicates).

        Equation: E[d d′]/2 with d, d′ the moves of the coalition in either set, what else is in the cluster following
            as it must; E[d² + d′²]/4 with d, d′ its moves while all else stays
        Source: Owen 2013 (better estimation of small Sobol' sensitivity indices); Jansen 1999.
        """
        rest = [index for index in cluster if index not in coalition]
        known = _projection(self._matrix, coalition)
        within = np.diag(np.isin(np.arange(len(known)), cluster).astype(float))
        moves = self._moves(cluster, known, replicates)
        products, of_effects = (move * again / 2 for move, again in moves)
        first = _controlled(products, of_effects, self._additive(cluster, known))
        unknown = within - _projection(self._matrix, rest)
        if rest:
            moves = self._moves(cluster, unknown, replicates)
        exact = self._additive(cluster, within) - self._additive(cluster, within - unknown)
        squares, of_effects = ((move * move + again * again) / 4 for move, again in moves)
        return np.stack([first, _controlled(squares, of_effects, exact)])

    def _moves(
        self, cluster: Sequence[int], projection: Array, replicates: Indices
    ) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Return the moves (rows, replicates, points) in both sets, of the model and of the effects of a cluster."""
        first, second = (scores[:, replicates] for scores in self._scores)
        step = np.tensordot(projection, second - first, 1)
        moved = self._model(first + step) - self.values[0][:, replicates]
        again = self.values[1][:, replicates] - self._model(second - step)
        effects = [self._effect(cluster, scores) for scores in (first, first + step, second - step, second)]
        return (moved, again), (effects[1] - effects[0], effects[3] - effects[2])

    def _effect(self, cluster: Sequence[int], scores: Array) -> Array:
        """Return the sum of the effects of a cluster (rows, replicates, points)."""
        total = np.zeros((self._effects.shape[1], *scores.shape[1:]))
        for index in cluster:
            polynomials = hermite_polynomials(scores[index], _TERMS)
            for coefficient, values in zip(self._effects[index].T, polynomials, strict=True):
                total += coefficient[:, None, None] * values
        return total

    def _additive(self, cluster: Sequence[int], projection: Array) -> Array:
        """Return the variance (rows,) of what is expected of a cluster's effects after a projection of the scores.

        Equation: Σᵢⱼ Σₙ aᵢₙ aⱼₙ qᵢⱼⁿ, n ≥ 1, with q = P R Pᵀ the covariance of the projected scores
        Source: Mehler 1866.
        """
        common = projection @ self._matrix @ projection.T
        variance = np.zeros(self._effects.shape[1])
        for row in cluster:
            for column in cluster:
                for power in range(1, _TERMS):
                    product = self._effects[row, :, power] * self._effects[column, :, power]
                    variance += product * common[row, column] ** power
        return variance


def _projection(matrix: Array, known: Sequence[int]) -> Array:
    """Return the projection (inputs, inputs) to what is expected when some scores are known.

    Equation: E[u | u_S] = R_·S R_SS⁻¹ u_S
    Arguments: correlations (inputs, inputs); indices of the known scores, none of them twice.
    Valid: singular correlations too, by the pseudo-inverse.
    Source: conditional expectation of jointly normal scores.
    """
    projection = np.zeros_like(matrix)
    if known:
        among = np.linalg.pinv(matrix[np.ix_(known, known)], rcond=_SINGULAR, hermitian=True)
        projection[:, known] = matrix[:, known] @ among
        projection[known] = 0.0
        projection[known, known] = 1.0
    return projection


def _effects(model: ScoreModel, count: int) -> Array:
    """Return the series of each input's effect, (inputs, rows, terms); 0 where the output is not finite on its way."""
    scores = np.zeros((count, count, len(_NODES)))
    scores[np.arange(count), np.arange(count)] = _NODES
    try:
        values = model(scores)
    except ValueError:  # A model may refuse what none of its points meets.
        values = np.full((1, count, len(_NODES)), np.nan)
    weighted = hermite_polynomials(_NODES, _TERMS) * (_WEIGHTS / _WEIGHTS.sum())
    series = np.add.reduce((values - values[:, :, :1])[:, :, None, :] * weighted, axis=3)
    sound = np.isfinite(series).all(axis=2, keepdims=True)
    return np.asarray(np.where(sound, series, 0.0).transpose(1, 0, 2))


def _controlled(parts: Array, of_effects: Array, exact: Array) -> Array:
    """Return the means in each replicate (rows, replicates) of parts of the variance, freed of what effects explain.

    Equation: mean of p − β (q − E q), with β by regression of p on q
    Arguments: parts p of the model and q of its effects (rows, replicates, points); E q (rows,).
    Valid: any model; of a sum of functions of single inputs nothing is left to chance.
    Source: control variates with a known expectation.
    """
    rows = len(parts)
    off = of_effects - np.add.reduce(of_effects.reshape(rows, -1), axis=1)[:, None, None] / of_effects[0].size
    squares = np.add.reduce((off * off).reshape(rows, -1), axis=1)
    products = np.add.reduce((off * parts).reshape(rows, -1), axis=1)
    slope = products / np.where(squares > 0, squares, 1.0)
    freed = parts - slope[:, None, None] * (of_effects - exact[:, None, None])
    return np.asarray(np.add.reduce(freed, axis=2) / freed.shape[2])
