"""The cheapest widths between straight bounds are those of the closed form, and of trying every pair."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flexlash.decisions.width_programme import Cuts, cheapest

WIDE = (-10.0, 10.0)


def test_one_bound_is_shared_out_by_cost():
    """With one variant each tolerance has the part of the room that its cost is of all costs: uᵢ = r cᵢ/(Σc dᵢ)."""
    costs, slopes, room = np.array([1.0, 2.0, 0.5]), np.array([[0.3, 0.02, 4.0]]), np.array([0.11])
    logs = cheapest(costs, Cuts(slopes=slopes, room=room), [WIDE] * 3)
    assert np.exp(2 * logs) == pytest.approx(room[0] * costs / costs.sum() / slopes[0], rel=1e-4)


def test_two_bounds_are_those_of_a_grid():
    """Of two tolerances and three variants the cost is that of the best of a million pairs."""
    costs = np.array([1.0, 3.0])
    cuts = Cuts(slopes=np.array([[1.0, 0.2], [0.1, 1.0], [0.5, 0.6]]), room=np.array([1.0, 0.8, 0.75]))
    logs = cheapest(costs, cuts, [(-2.0, 1.0)] * 2)
    first, second = np.meshgrid(*[np.linspace(-2, 1, 1001)] * 2)
    keeps = [
        slope @ np.exp(2 * np.stack([first.ravel(), second.ravel()])) <= room
        for slope, room in zip(cuts.slopes, cuts.room, strict=True)
    ]
    best = (costs[0] * first + costs[1] * second).ravel()[np.all(keeps, axis=0)].max()
    assert cuts.keep(logs)
    assert best - 1e-9 <= costs @ logs <= best + 0.02


def test_bounds_end_what_costs_nothing_to_widen():
    """What no variant feels goes to its upper end; where even the narrowest is too wide there is none."""
    cuts = Cuts(slopes=np.array([[1.0, 0.0]]), room=np.array([0.5]))
    logs = cheapest(np.ones(2), cuts, [(-2.0, 2.0)] * 2)
    assert logs == pytest.approx([math.log(0.5) / 2, 2.0], abs=1e-5)
    assert cheapest(np.ones(2), Cuts(slopes=np.ones((1, 2)), room=np.array([0.01])), [(-2.0, 2.0)] * 2) is None
    assert cheapest(np.ones(2), Cuts(slopes=np.ones((1, 2)), room=np.array([9.0])), [(-2.0, 0.5)] * 2) == pytest.approx(
        0.5
    )
