"""The front holds the variants that no other one beats, and no more."""

from __future__ import annotations

import numpy as np
import pytest

from flexlash.decisions.pareto import pareto_front


def _brute(rows):
    """Return the same row by row, in Python's own numbers."""

    def beats(one, other):
        return all(a <= b for a, b in zip(one, other, strict=True)) and any(
            a < b for a, b in zip(one, other, strict=True)
        )

    return [not any(beats(other, row) for other in rows) for row in rows]


@pytest.mark.parametrize("figures", [1, 2, 3])
def test_the_front_is_that_of_comparing_every_pair(figures):
    """Of 60 random sets, with many equal figures among them, the front is what every pair compared says."""
    source = np.random.default_rng(7)
    for count in range(1, 61):
        rows = [tuple(float(source.integers(12)) for _ in range(figures)) for _ in range(count)]
        front = pareto_front(np.array(rows)).tolist()
        assert front == _brute(rows)
        assert any(front)


def test_the_order_of_variants_changes_nothing():
    """Whatever the order, the same variants are on the front."""
    source = np.random.default_rng(3)
    rows = [tuple(row) for row in source.random((40, 2)).tolist()]
    on = {row for row, is_on in zip(rows, pareto_front(np.array(rows)).tolist(), strict=True) if is_on}
    source.shuffle(rows)
    assert {row for row, is_on in zip(rows, pareto_front(np.array(rows)).tolist(), strict=True) if is_on} == on


def test_what_is_unknown_neither_stands_nor_beats():
    """A variant without one of the figures is on no front and keeps none off it."""
    assert pareto_front(np.array([[np.nan, 0.0], [1.0, 1.0], [0.0, np.nan]])).tolist() == [False, True, False]
    assert pareto_front(np.empty((0, 2))).tolist() == []
