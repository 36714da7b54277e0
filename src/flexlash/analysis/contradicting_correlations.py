"""Correlations of a class that no parts can have, and the nearest that parts can.

Dimensions that no part has at once, such as mean radius and bore, contradict nothing together.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping
from typing import TypeAlias

import numpy as np

from flexlash.tolerance.correlation import CorrelationMatrix
from flexlash.tolerance.nearest_correlation import admissible, nearest_correlations

__all__ = ["Pair", "contradictions", "without_contradiction"]

_NEVER_TOGETHER = (
    ("bore_diameter", "mean_radius"),
    ("shear_modulus", "youngs_modulus"),
    ("shear_modulus", "poisson_ratio"),
    ("disk_thickness", "disk_thickness_exponent"),
    ("disk_cone_angle", "hub_fillet_radius"),
    ("disk_cone_angle", "junction_fillet_radius"),
)
"""Dimensions of which a part has one or the other."""

_STEPS = 10_000
"""Admissible values are told in these parts of 1, rounded to the side where they stay admissible."""

Pair: TypeAlias = tuple[str, str]
"""Two dimensions in the order of `DIMENSIONS`."""


def contradictions(entered: Collection[Pair], correlations: Mapping[Pair, float]) -> Iterator[tuple[Pair, float, bool]]:
    """Yield each entered correlation that has to change, its nearest admissible value, and whether it has to alone.

    Where one of several that contradict one another can fix it, the one that has to change least is named. Of each set
    of dimensions that a part can have at once the first fault is told.

    Arguments: the pairs that are entered; all correlations by pairs, of which the others are measured and
        contradict nothing among themselves.

    >>> tied = {("a", "b"): 0.9, ("a", "c"): 0.9, ("b", "c"): 0.5}
    >>> list(contradictions(tied, tied))
    [(('a', 'b'), 0.8274, True)]
    >>> list(contradictions([("b", "c")], tied))
    [(('b', 'c'), 0.62, True)]
    """
    told: set[Pair] = set()
    for names in [] if _are_weak(correlations) else _possible(correlations):
        some = {pair: value for pair, value in correlations.items() if names.issuperset(pair)}
        own = [(*pair, value) for pair, value in some.items() if pair in entered]
        matrix = _matrix(some)
        for fault in CorrelationMatrix(names=matrix.names, entries=tuple(own), scores=matrix.scores).faults():
            values = {own[index][:2]: value for index, value in fault.nearest.items()}
            if not told & values.keys():
                told |= values.keys()
                yield from ((pair, value, len(values) == 1) for pair, value in _rounded(some, values).items())


def without_contradiction(measured: Mapping[Pair, float]) -> dict[Pair, float]:
    """Return measured correlations, or the nearest to them that can be: those of different parts may contradict.

    >>> without_contradiction({("a", "b"): 0.9, ("a", "c"): 0.9, ("b", "c"): 0.8})
    {('a', 'b'): 0.9, ('a', 'c'): 0.9, ('b', 'c'): 0.8}
    >>> fixed = without_contradiction({("a", "b"): 0.9, ("a", "c"): -0.9, ("b", "c"): 0.9})
    >>> {pair: round(value, 6) for pair, value in fixed.items()}
    {('a', 'b'): 0.5, ('a', 'c'): -0.5, ('b', 'c'): 0.5}
    """
    matrix = _matrix(measured)
    if not measured or admissible(matrix.scores):
        return dict(measured)
    places = {pair: (matrix.names.index(pair[0]), matrix.names.index(pair[1])) for pair in measured}
    may_change = np.zeros(matrix.scores.shape, dtype=bool)
    for first, second in places.values():
        may_change[first, second] = may_change[second, first] = True
    nearest = nearest_correlations(matrix.scores, may_change)
    return {pair: float(nearest[place]) for pair, place in places.items()}


def _are_weak(correlations: Mapping[Pair, float]) -> bool:
    """Return whether no dimension has correlations of more than 1 in all, which never contradict (Gershgorin 1931).

    >>> _are_weak({("a", "b"): 0.5, ("b", "c"): -0.5}), _are_weak({("a", "b"): 0.5, ("b", "c"): 0.6})
    (True, False)
    """
    total: dict[str, float] = defaultdict(float)
    for pair, value in correlations.items():
        for name in pair:
            total[name] += abs(value)
    return max(total.values(), default=0.0) <= 1


def _matrix(correlations: Mapping[Pair, float]) -> CorrelationMatrix:
    """Return correlations by pairs as a matrix."""
    names = list(dict.fromkeys(name for pair in correlations for name in pair))
    return CorrelationMatrix.of([(*pair, value) for pair, value in correlations.items()], names)


def _possible(correlations: Mapping[Pair, float]) -> list[set[str]]:
    """Return the greatest sets of dimensions that a part can have at once.

    >>> sorted(sorted(names) for names in _possible({("bore_diameter", "a"): 1.0, ("mean_radius", "a"): -1.0}))
    [['a', 'bore_diameter'], ['a', 'mean_radius']]
    """
    sets = [{name for pair in correlations for name in pair}]
    for alternatives in _NEVER_TOGETHER:
        sets = [
            names - ({one} if both else set())
            for names in sets
            for both in [names.issuperset(alternatives)]
            for one in (alternatives if both else alternatives[:1])
        ]
    return sets


def _rounded(correlations: Mapping[Pair, float], nearest: Mapping[Pair, float]) -> dict[Pair, float]:
    """Return nearest admissible values with few decimals, where they stay admissible so; else with all of them."""
    told = {pair: _inward(value, correlations[pair]) for pair, value in nearest.items()}
    matrix = _matrix({**correlations, **told})
    return told if _admits(matrix, nearest) else dict(nearest)


def _admits(matrix: CorrelationMatrix, pairs: Mapping[Pair, float]) -> bool:
    """Whether none of these pairs is in a fault of a matrix."""
    return not any(set(pairs) & {matrix.entries[index][:2] for index in fault.entries} for fault in matrix.faults())


def _inward(value: float, entered: float) -> float:
    """Return a value with few decimals, rounded away from what was entered."""
    shifted = round(value * _STEPS, 6)
    return (math.ceil(shifted) if value > entered else math.floor(shifted)) / _STEPS
