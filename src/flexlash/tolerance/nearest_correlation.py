"""Correlation matrices that cannot be, and what comes nearest to them.

A matrix of correlations is admissible if no eigenvalue is negative: otherwise some sum of the scores would have a
negative variance. Two pairs may well contradict a third: what is close to both of two things cannot turn away from
their likeness.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array

__all__ = ["admissible", "admissible_interval", "nearest_correlations"]

_ROUNDING = 1e-9
"""A negative eigenvalue up to this comes from rounding."""

_LEAST = 1e-12
"""Eigenvalues below are taken as this: what lies along them has next to no variance of its own."""

_ROUNDS, _SETTLED = 2000, 1e-10
"""Most projections, and the change of a correlation from which on they have settled."""


def admissible(matrix: Array) -> bool:
    """Return whether there are normal scores with these correlations.

    Equation: least eigenvalue ≥ 0
    Arguments: a symmetric matrix (k, k) with ones on its diagonal.
    Valid: up to rounding of 1e-9, so that −1, 1 and chains of them are admissible.
    Source: definition of a covariance matrix.

    >>> admissible(np.array([[1.0, -1.0], [-1.0, 1.0]]))
    True
    """
    return bool(np.linalg.eigvalsh(matrix)[0] >= -_ROUNDING)


def admissible_interval(matrix: Array, first: int, second: int) -> tuple[float, float] | None:
    """Return between which values one correlation may be, all others kept; None if their own contradict one another.

    Equation: c ± √(s₁ s₂), c = r₁ᵀ R⁻¹ r₂, sᵢ = 1 − rᵢᵀ R⁻¹ rᵢ, where R holds the other inputs, rᵢ what ties them to i
    Arguments: a symmetric matrix (k, k) with ones on its diagonal; two different indices.
    Valid: any matrix; a singular R is inverted where it is not 0.
    Source: the Schur complement of R, [[s₁, ρ − c], [ρ − c, s₂]], has no negative eigenvalue.

    >>> matrix = np.array([[1, 0.6, 0.9], [0.6, 1, 0.8], [0.9, 0.8, 1]])
    >>> [round(end, 2) for end in admissible_interval(matrix, 0, 2)]
    [0.0, 0.96]
    """
    others = [index for index in range(len(matrix)) if index not in (first, second)]
    values, vectors = np.linalg.eigh(matrix[np.ix_(others, others)])
    if others and values[0] < -_ROUNDING:
        return None
    along = vectors.T @ matrix[np.ix_(others, [first, second])]
    explained = along.T @ (along / np.maximum(values, _LEAST)[:, None])
    left = 1 - np.diag(explained)
    if left.min() < -_ROUNDING:
        return None
    centre, reach = float(explained[0, 1]), float(np.sqrt(np.prod(np.maximum(left, 0.0))))
    return max(centre - reach, -1.0), min(centre + reach, 1.0)


def nearest_correlations(matrix: Array, entered: npt.NDArray[np.bool_]) -> Array:
    """Return the nearest admissible matrix that differs in entered correlations alone.

    Equation: min ‖X − matrix‖ over X without negative eigenvalues, by projections in turn with Dykstra's correction
    Arguments: a symmetric matrix (k, k) with ones on its diagonal; which of its numbers may change, (k, k).
    Valid: to 1e-10, or as far as 2000 rounds go; what is left of a negative eigenvalue is taken out by shrinking.
    Source: Higham 2002, with the numbers that are not entered held beside the diagonal.

    >>> tied = np.array([[1, 0.9, -0.9], [0.9, 1, 0.9], [-0.9, 0.9, 1]])
    >>> nearest_correlations(tied, tied != 1).round(6)[0].tolist()
    [1.0, 0.5, -0.5]
    """
    nearest, correction = matrix, np.zeros_like(matrix)
    for _ in range(_ROUNDS):
        uncorrected = nearest - correction
        values, vectors = np.linalg.eigh(uncorrected)
        positive = (vectors * np.maximum(values, 0.0)) @ vectors.T
        correction = positive - uncorrected
        nearest = np.where(entered, (positive + positive.T) / 2, matrix)
        if np.abs(nearest - positive).max() <= _SETTLED:
            break
    least = min(float(np.linalg.eigvalsh(nearest)[0]), 0.0)
    shrunk = nearest / (1 - least)
    np.fill_diagonal(shrunk, 1.0)
    return shrunk
