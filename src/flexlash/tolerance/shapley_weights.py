"""Shapley's value: how what several cause together is shared out among them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations
from typing import TypeAlias

import numpy as np

from flexlash.schema.arrays import Array

__all__ = ["EXACT_SIZE", "ORDERS", "Coalition", "coalitions"]

EXACT_SIZE = 8
"""Most members all of whose coalitions are looked at."""

ORDERS = 32
"""Orders in which more members come together, in each replicate others; half of them are the others' reverse."""

Coalition: TypeAlias = tuple[int, ...]
"""Some of the members, in rising order."""


def coalitions(size: int, replicates: int) -> Iterator[tuple[Coalition, Array]]:
    """Yield coalitions with the weights (members, replicates) by which their worths sum to Shapley's value.

    Equation: φᵢ = Σ_S wᵢ(S) v(S), wᵢ(S) = (|S| − 1)! (k − |S|)!/k! with i in S, else −|S|! (k − 1 − |S|)!/k!, which is
        the mean over all orders of what i adds to those before it
    Arguments: number k of members; replicates.
    Valid: exact for up to eight members; beyond, the mean over 32 orders drawn for each replicate, whose scatter tells
        the error of that.
    Source: Shapley 1953; Castro, Gómez and Tejada 2009 (orders drawn), with the reverse of each.

    >>> [(members, weights[:, 0].tolist()) for members, weights in coalitions(2, 1)]
    [((0,), [0.5, -0.5]), ((1,), [-0.5, 0.5]), ((0, 1), [0.5, 0.5])]
    """
    return _all_coalitions(size, replicates) if size <= EXACT_SIZE else _drawn_coalitions(size, replicates)


def _all_coalitions(size: int, replicates: int) -> Iterator[tuple[Coalition, Array]]:
    """Yield every coalition, with the same weights for all replicates."""
    for count in range(1, size + 1):
        of_members = 1 / (size * math.comb(size - 1, count - 1))
        of_others = -1 / (size * math.comb(size - 1, count)) if count < size else 0.0
        for members in combinations(range(size), count):
            weights = np.full((size, replicates), of_others)
            weights[list(members)] = of_members
            yield members, weights


def _drawn_coalitions(size: int, replicates: int) -> Iterator[tuple[Coalition, Array]]:
    """Yield the coalitions through which members come together in orders drawn for each replicate."""
    weights: dict[Coalition, Array] = {}
    generator = np.random.default_rng([size, replicates])
    for replicate in range(replicates):
        half = [generator.permutation(size) for _ in range(ORDERS // 2)]
        for order in (*half, *(order[::-1] for order in half)):
            for count, member in enumerate(order.tolist()):
                for known, share in ((count, -1 / ORDERS), (count + 1, 1 / ORDERS)):
                    members = tuple(sorted(order[:known].tolist()))
                    weights.setdefault(members, np.zeros((size, replicates)))[member, replicate] += share
    del weights[()]
    yield from weights.items()
