"""Shapley's value by weights of coalitions: the mean over all orders, exactly or by orders drawn."""

import math
from itertools import combinations, permutations

import numpy as np
import pytest

from flexlash.tolerance.shapley_weights import EXACT_SIZE, coalitions


def worth(members, generator_seed=5):
    """Return a game that is neither a sum nor symmetric: the cube of a sum, and a little for some pairs."""
    weights = np.random.default_rng(generator_seed).normal(size=20)
    return weights[list(members)].sum() ** 3 + sum(0.3 for one in members for other in members if one + 1 == other)


def by_orders(size):
    """Return Shapley's value as the mean over all orders of what each adds to those before it."""
    value = np.zeros(size)
    orders = list(permutations(range(size)))
    for order in orders:
        for count, member in enumerate(order):
            value[member] += (worth(order[: count + 1]) - worth(order[:count])) / len(orders)
    return value


def by_subsets(size):
    """Return Shapley's value as the sum over the others' subsets of what each adds to them."""
    value = np.zeros(size)
    for member in range(size):
        others = [other for other in range(size) if other != member]
        for count in range(size):
            orders = math.factorial(count) * math.factorial(size - 1 - count) / math.factorial(size)
            value[member] += orders * sum(
                worth((*subset, member)) - worth(subset) for subset in combinations(others, count)
            )
    return value


@pytest.mark.parametrize("size", range(1, 6))
def test_weights_make_the_mean_over_all_orders(size):
    """Worths times weights sum to the mean over all orders, in every replicate."""
    found = sum(weights * worth(members) for members, weights in coalitions(size, 3))
    assert found == pytest.approx(np.repeat(by_orders(size)[:, None], 3, axis=1), abs=1e-12)


@pytest.mark.parametrize("size", [EXACT_SIZE, EXACT_SIZE + 3])
def test_nothing_is_left_over(size):
    """In every replicate the shares sum to the worth of all, also by orders drawn."""
    found = sum(weights * worth(members) for members, weights in coalitions(size, 8))
    assert found.sum(axis=0) == pytest.approx(np.full(8, worth(range(size))), rel=1e-12)


def test_drawn_orders_are_near_the_exact_value():
    """Over orders drawn the mean of the replicates is the exact value within four standard errors, every time alike."""
    size = EXACT_SIZE + 1
    drawn, again = (np.array(sum(w * worth(m) for m, w in coalitions(size, 16))) for _ in range(2))
    assert np.array_equal(drawn, again)
    error = drawn.std(axis=1, ddof=1) / 4
    assert (np.abs(drawn.mean(axis=1) - by_subsets(size)) <= 4 * error).all()
    assert (error > 1e-3 * np.abs(drawn).max()).all()
