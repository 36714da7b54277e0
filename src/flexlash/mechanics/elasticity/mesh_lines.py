"""Mesh lines that grow away from where the twist bends sharply."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from flexlash.mechanics.elasticity.part import SLACK, Grading
from flexlash.schema.arrays import Array

__all__ = ["Lines", "across", "graded", "nodes_on"]

_GROWTH = 2.5
"""Factor by which mesh steps grow from one to the next, away from a fine end."""

Lines = tuple[float, ...]
"""Mesh lines in rising order."""


def graded(start: float, end: float, first: float, last: float, least: int = 1) -> Lines:
    """Return mesh lines from start to end, the steps growing from `first` and from `last` towards the middle."""
    low, high = [start], [end]
    below, above = min(first, (end - start) / least), min(last, (end - start) / least)
    longest = (end - start) / least
    while high[-1] - low[-1] > below + above:
        if below <= above:
            low.append(low[-1] + below)
            below = min(below * _GROWTH, longest)
        else:
            high.append(high[-1] - above)
            above = min(above * _GROWTH, longest)
    gap = high[-1] - low[-1]
    pieces = max(1, math.ceil(gap / max(below, above) - SLACK))
    return (*low, *(low[-1] + gap * index / pieces for index in range(1, pieces)), *reversed(high))


def nodes_on(lines: Sequence[float], refinement: int) -> Array:
    """Return the nodes on mesh lines: each cell is halved once for its middle node and once per refinement."""
    nodes = np.asarray(lines, dtype=float)
    for _ in range(refinement + 1):
        halves = np.empty(2 * len(nodes) - 1)
        halves[::2] = nodes
        halves[1::2] = (nodes[:-1] + nodes[1:]) / 2
        nodes = halves
    return nodes


def across(grading: Grading, *, low_is_sharp: bool, high_is_sharp: bool) -> Lines:
    """Return mesh lines across a thickness, from 0 to 1, fine at the faces that have a sharp corner."""
    low, high = (grading.step(sharp=is_sharp, thickness=1.0) for is_sharp in (low_is_sharp, high_is_sharp))
    return graded(0.0, 1.0, low, high, 2)
