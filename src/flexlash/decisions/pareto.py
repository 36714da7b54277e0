"""Which of several variants no other one beats in everything that counts."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from flexlash.schema.arrays import Array

__all__ = ["pareto_front"]


def pareto_front(figures: Array) -> npt.NDArray[np.bool_]:
    """Return which rows (rows,) are on the front: no other one is as small in every figure and smaller in one.

    Equation: i is on the front if there is no j with f_j ≤ f_i in every figure and f_j < f_i in one
    Arguments: figures (rows, figures), of which the smaller is the better, each in any unit.
    Valid: any figures; rows that are equal in all of them are on the front together. A row with NaN is not on it and
        keeps no other off it.
    Source: Pareto efficiency.

    >>> pareto_front(np.array([[1.0, 5.0], [2.0, 3.0], [2.0, 4.0], [3.0, 3.0], [np.nan, 1.0]])).tolist()
    [True, True, False, False, False]
    """
    known = np.asarray(~np.isnan(figures).any(axis=1))
    front = known.copy()
    for row in np.flatnonzero(known):
        beside = figures[row]
        front[row] = not ((figures <= beside).all(axis=1) & (figures < beside).any(axis=1)).any()
    return front
