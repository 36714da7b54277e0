"""Which inputs scatter together: correlations, what is wrong with them, and the factor that brings them about.

entry           two inputs and the correlation entered for them
scores          standard normal quantiles of the inputs' probabilities; a Gaussian copula correlates these
ranks, values   Spearman's correlation, which is Pearson's of the ranks; Pearson's of the values themselves
cluster         inputs that correlations other than 0 tie, directly or through others
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np

from flexlash.schema.arrays import Array
from flexlash.tolerance.nearest_correlation import admissible, admissible_interval, nearest_correlations

__all__ = [
    "CorrelationFault",
    "CorrelationMatrix",
    "Entry",
    "clusters_of",
    "correlated_scores",
    "entry_faults",
    "score_factor",
]

Entry: TypeAlias = tuple[str, str, float]

_NO_VARIANCE = 1e-12
"""Variance of a score's own below which it is rounding: the score follows those before it."""


@dataclass(frozen=True, kw_only=True)
class CorrelationFault:
    """What is wrong with entries, by their indices.

    `kind` says what: `name` that an input does not scatter, `alone` that it is correlated with itself, `twice` that the
    pair was entered before, `range` that the correlation is none from −1 to 1, `matrix` that no scores have these
    correlations. Of the latter `nearest` holds the nearest admissible values: of the one entry that has to change least
    if the others are kept, or of all entries of the cluster where no single one can fix it.
    """

    kind: Literal["name", "alone", "twice", "range", "matrix"]
    entries: tuple[int, ...]
    nearest: Mapping[int, float] = field(default_factory=dict)


def entry_faults(entries: Sequence[Entry], names: Collection[str]) -> list[CorrelationFault]:
    """Return what is wrong with single entries; `names` are those of the inputs that scatter.

    >>> [fault.kind for fault in entry_faults([("a", "b", 0.5), ("b", "a", 0.5), ("a", "c", 2.0)], {"a", "b"})]
    ['twice', 'name']
    """
    faults: list[CorrelationFault] = []
    seen: set[frozenset[str]] = set()
    for index, (first, second, correlation) in enumerate(entries):
        pair = frozenset((first, second))
        kinds: dict[Literal["name", "alone", "twice", "range"], bool] = {
            "name": not pair <= set(names),
            "alone": first == second,
            "twice": pair in seen,
            "range": not -1 <= correlation <= 1,
        }
        seen.add(pair)
        faults += [CorrelationFault(kind=kind, entries=(index,)) for kind, found in kinds.items() if found][:1]
    return faults


@dataclass(frozen=True, kw_only=True)
class CorrelationMatrix:
    """Correlations of the inputs' normal scores: `scores` (inputs, inputs), symmetric, with ones on its diagonal.

    `entries` are what it was made of: each pair once, known names, from −1 to 1.
    """

    names: tuple[str, ...]
    entries: tuple[Entry, ...]
    scores: Array

    @classmethod
    def of(cls, entries: Sequence[Entry], names: Sequence[str]) -> CorrelationMatrix:
        """Return the matrix of entries without faults of their own; pairs that are not entered are independent."""
        scores = np.eye(len(names))
        for first, second, correlation in entries:
            row, column = names.index(first), names.index(second)
            scores[row, column] = scores[column, row] = correlation
        return cls(names=tuple(names), entries=tuple(entries), scores=scores)

    def faults(self) -> list[CorrelationFault]:
        """Return the clusters that no scores can have, each with the nearest admissible values."""
        clusters = clusters_of(self.scores)
        return [self._fault(cluster) for cluster in clusters if not admissible(self.scores[np.ix_(cluster, cluster)])]

    def _fault(self, cluster: Sequence[int]) -> CorrelationFault:
        """Return what is wrong with a cluster."""
        matrix = self.scores[np.ix_(cluster, cluster)]
        place = {self.names[index]: inside for inside, index in enumerate(cluster)}
        inside = {
            index: (place[first], place[second])
            for index, (first, second, _) in enumerate(self.entries)
            if first in place and second in place
        }
        nearest: dict[int, float] = {}
        for index, (first, second) in inside.items():
            interval = admissible_interval(matrix, first, second)
            if interval is not None:
                nearest[index] = float(np.clip(matrix[first, second], *interval))
        if nearest:
            # Rounded, so that of equal changes the pair that was entered first is named.
            least = min(nearest, key=lambda index: round(abs(nearest[index] - self.entries[index][2]), 9))
            return CorrelationFault(kind="matrix", entries=tuple(inside), nearest={least: nearest[least]})
        entered = np.zeros(matrix.shape, dtype=bool)
        for first, second in inside.values():
            entered[first, second] = entered[second, first] = True
        fixed = nearest_correlations(matrix, entered)
        values = {index: float(fixed[pair]) for index, pair in inside.items()}
        return CorrelationFault(kind="matrix", entries=tuple(inside), nearest=values)


def clusters_of(matrix: Array) -> list[list[int]]:
    """Return the indices of each two or more inputs that numbers other than 0 tie, in their order.

    >>> clusters_of(np.array([[1.0, 0.0, 0.5], [0.0, 1.0, 0.0], [0.5, 0.0, 1.0]]))
    [[0, 2]]
    """
    from scipy.sparse.csgraph import connected_components

    count, label = connected_components(matrix != 0, directed=False)
    clusters = [np.flatnonzero(label == number).tolist() for number in range(count)]
    return [cluster for cluster in clusters if len(cluster) > 1]


def score_factor(matrix: Array, order: Sequence[int]) -> Array | None:
    """Return the factor that makes scores of these correlations out of independent ones; None if all are independent.

    Equation: u = L z, L Lᵀ = R; Lᵢⱼ = (Rᵢⱼ − Σ Lᵢₘ Lⱼₘ)/Lⱼⱼ with the sum over the m before j, 0 where Lⱼⱼ is 0
    Arguments: an admissible matrix (inputs, inputs); the order of all inputs, of which the earlier ones keep a score
        of their own. L is triangular in this order.
    Valid: singular matrices too: a score that follows from the earlier ones has a column of zeros. Each uᵢ has the
        variance 1 to rounding, whatever was cut off. An input outside clusters keeps its score.
    Source: Cholesky; Higham 1990 for semidefinite matrices.

    >>> score_factor(np.array([[1.0, 0.6], [0.6, 1.0]]), [0, 1]).tolist()
    [[1.0, 0.0], [0.6, 0.8]]
    >>> score_factor(np.array([[1.0, -1.0], [-1.0, 1.0]]), [1, 0]).tolist()
    [[0.0, -1.0], [0.0, 1.0]]
    """
    if not clusters_of(matrix):
        return None
    factor = np.zeros_like(matrix)
    for number, column in enumerate(order):
        before = list(order[:number])
        own = matrix[column, column] - math.fsum(factor[column, before] ** 2)
        if own <= _NO_VARIANCE:
            continue
        factor[column, column] = math.sqrt(own)
        for row in order[number + 1 :]:
            common = math.fsum(factor[row, before] * factor[column, before])
            factor[row, column] = (matrix[row, column] - common) / factor[column, column]
    length = [math.sqrt(math.fsum(row * row)) for row in factor]
    return np.asarray(factor / np.array(length)[:, None])


def correlated_scores(factor: Array, scores: Sequence[Array]) -> list[Array]:
    """Return correlated scores, made of independent ones.

    Equation: uᵢ = Σ Lᵢⱼ zⱼ
    Arguments: a factor (inputs, inputs); independent scores, an array of one shape for each input.
    Valid: each number is summed in the order of the inputs, so that it has the same bits in any array.
    Source: definition of the factor.
    """
    made = []
    for row in factor:
        first, *others = np.flatnonzero(row).tolist()
        score = row[first] * scores[first]
        for other in others:
            score += row[other] * scores[other]
        made.append(score)
    return made
