"""Correlations that no parts can have: the nearest values that are told fix them, and are the nearest."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from flexlash.analysis.contradicting_correlations import contradictions, without_contradiction

NAMES = ("a", "b", "c", "d")
PAIRS = list(combinations(NAMES, 2))


def _least(correlations):
    """Return the least eigenvalue of the whole matrix."""
    matrix = np.eye(len(NAMES))
    for (first, second), value in correlations.items():
        place = NAMES.index(first), NAMES.index(second)
        matrix[place] = matrix[place[::-1]] = value
    return float(np.linalg.eigvalsh(matrix)[0])


def _drawn(seed):
    """Return correlations of some pairs, many of them close to 1 or just that."""
    source = np.random.default_rng(seed)
    values = source.choice([-1.0, -0.9, -0.6, 0.0, 0.3, 0.123456, 0.8, 0.95, 1.0], len(PAIRS))
    return {pair: float(value) for pair, value in zip(PAIRS, values, strict=True) if source.random() < 0.8}


@pytest.mark.slow
def test_told_values_fix_what_contradicts():
    """Whoever enters what is told, time after time, soon has correlations that can be; those that can be stay."""
    fixed = 0
    for seed in range(300):
        correlations = _drawn(seed)
        for _ in range(4):
            told = list(contradictions(correlations, correlations))
            assert bool(told) == (_least(correlations) < -1e-9), (seed, correlations)
            if not told:
                break
            fixed += 1
            assert len({pair for pair, _, _ in told}) == len(told)
            correlations |= {pair: value for pair, value, _ in told}
        else:
            pytest.fail(f"{seed}: {correlations}")
    assert fixed > 100


@pytest.mark.slow
def test_a_value_that_fixes_alone_is_the_nearest():
    """No value nearer to the entered one is admissible, up to the four decimals that are told."""
    alone = 0
    for seed in range(300):
        correlations = _drawn(seed)
        for pair, value, is_alone in contradictions(correlations, correlations):
            if is_alone:
                alone += 1
                nearer = value + np.sign(correlations[pair] - value) * 2e-4
                assert _least(correlations | {pair: value}) >= -1e-9, seed
                assert _least(correlations | {pair: float(nearer)}) < 0, seed
    assert alone > 50


def test_a_follower_has_exactly_what_it_follows():
    """Where two dimensions are one the third has one correlation with both, which no rounding may touch."""
    entered = {("a", "b"): 1.0, ("a", "c"): 0.123456, ("b", "c"): 0.5}
    ((pair, value, is_alone),) = contradictions([("b", "c")], entered)
    assert (pair, is_alone) == (("b", "c"), True)
    assert value == pytest.approx(0.123456, abs=1e-9)


def test_what_is_measured_is_not_told():
    """Of correlations that contradict those alone are told that were entered."""
    correlations = {("a", "b"): 0.9, ("a", "c"): 0.9, ("b", "c"): 0.5}
    for pair in correlations:
        assert [told for told, _, _ in contradictions([pair], correlations)] == [pair]


def test_measured_correlations_that_can_be_are_kept_to_the_bit():
    """Nothing is changed that needs no change; what is changed can be."""
    for seed in range(60):
        correlations = _drawn(seed)
        fixed = without_contradiction(correlations)
        assert fixed.keys() == correlations.keys()
        assert (fixed == correlations) == (_least(correlations) >= -1e-9), seed
        assert _least(fixed) >= -1e-9, seed
