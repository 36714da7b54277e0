"""Correlation matrices: what is wrong with entries, the nearest admissible values, and factors, singular ones too."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.tolerance.correlation import (
    CorrelationMatrix,
    clusters_of,
    correlated_scores,
    entry_faults,
    score_factor,
)

thorough = settings(deadline=None, max_examples=60, derandomize=True)

NAMES = ("a", "b", "c", "d", "e", "f")


@pytest.mark.parametrize(
    ("entries", "kinds"),
    [
        ([("a", "b", 0.5), ("b", "c", -1.0), ("a", "c", 1)], []),
        ([("a", "x", 0.5)], [("name", 0)]),
        ([("a", "b", 0.5), ("c", "c", 1.0)], [("alone", 1)]),
        ([("a", "b", 0.5), ("b", "c", 0.5), ("b", "a", 0.5)], [("twice", 2)]),
        ([("a", "b", 0.5), ("a", "b", 0.5)], [("twice", 1)]),
        ([("a", "b", 1.0001), ("b", "c", -2)], [("range", 0), ("range", 1)]),
        ([("a", "b", float("nan"))], [("range", 0)]),
    ],
)
def test_faults_of_entries(entries, kinds):
    """Every entry that is wrong by itself is told with what is wrong, and no other."""
    faults = entry_faults(entries, NAMES)
    assert [(fault.kind, fault.entries[0]) for fault in faults] == kinds


def test_matrix_holds_entries_in_either_order():
    """An entry stands on both sides of the diagonal, whichever name comes first; the rest is independent."""
    matrix = CorrelationMatrix.of([("c", "a", 0.25)], NAMES[:3])
    assert matrix.scores.tolist() == [[1, 0, 0.25], [0, 1, 0], [0.25, 0, 1]]
    assert matrix.faults() == []


def test_the_entry_that_changes_least_is_named():
    """Of entries that contradict one another that is named which has to change least, with its nearest value."""
    entries = [("a", "b", 0.9), ("b", "c", 0.9), ("a", "c", 0.5), ("d", "e", 0.7)]
    (fault,) = CorrelationMatrix.of(entries, NAMES).faults()
    assert (fault.kind, fault.entries) == ("matrix", (0, 1, 2))
    assert fault.nearest == {0: pytest.approx(0.45 + (0.19 * 0.75) ** 0.5)}


def test_each_cluster_is_fixed_by_itself():
    """Two clusters that contradict themselves are two faults, each with a value of its own."""
    entries = [("a", "b", 0.9), ("b", "c", 0.9), ("a", "c", 0.5), ("d", "e", 1), ("e", "f", 1), ("d", "f", 0.2)]
    first, second = CorrelationMatrix.of(entries, NAMES).faults()
    assert first.nearest == {0: pytest.approx(0.45 + (0.19 * 0.75) ** 0.5)}
    assert second.nearest == {3: pytest.approx(0.2)}


@pytest.mark.slow
@thorough
@given(draw=st.integers(0, 10**6), count=st.integers(3, 10))
def test_nearest_values_are_admissible_when_entered(draw, count):
    """Entries replaced by the nearest values that are told contradict one another no more."""
    generator = np.random.default_rng(draw)
    pairs = [(one, other) for index, one in enumerate(NAMES[:5]) for other in NAMES[:index]]
    chosen = [pairs[index] for index in generator.permutation(len(pairs))[:count]]
    entries = [(*pair, round(float(generator.uniform(-1, 1)), 3)) for pair in chosen]
    matrix = CorrelationMatrix.of(entries, NAMES)
    for fault in matrix.faults():
        assert len(fault.nearest) in {1, len(fault.entries)}
        for index, value in fault.nearest.items():
            entries[index] = (*entries[index][:2], value)
    assert CorrelationMatrix.of(entries, NAMES).faults() == []


def test_all_values_are_told_where_no_single_pair_fixes():
    """Of four inputs each turned away from all others no single entry can be the one; all are told."""
    entries = [(one, other, -0.8) for index, one in enumerate(NAMES[:4]) for other in NAMES[:index]]
    (fault,) = CorrelationMatrix.of(entries, NAMES).faults()
    assert fault.nearest == {index: pytest.approx(-1 / 3, abs=1e-6) for index in range(6)}


def test_clusters_are_tied_through_others():
    """Inputs that are tied through others alone are one cluster, independent ones are none."""
    matrix = CorrelationMatrix.of([("a", "c", 0.1), ("c", "e", -0.1), ("b", "f", 1)], NAMES).scores
    assert clusters_of(matrix) == [[0, 2, 4], [1, 5]]


@thorough
@given(draw=st.integers(0, 10**6), size=st.integers(2, 7), rank=st.integers(1, 7))
def test_factor_makes_the_matrix(draw, size, rank):
    """L Lᵀ is the matrix, L is triangular in the order given, and has as many columns as the matrix's rank."""
    generator = np.random.default_rng(draw)
    root = generator.normal(size=(size, min(rank, size)))
    matrix = root @ root.T
    length = np.sqrt(np.diag(matrix))
    matrix = matrix / length / length[:, None]
    np.fill_diagonal(matrix, 1.0)
    order = generator.permutation(size).tolist()
    factor = score_factor(matrix, order)
    assert factor @ factor.T == pytest.approx(matrix, abs=1e-7)
    assert np.count_nonzero(factor.any(axis=0)) == min(rank, size)
    assert np.array_equal(np.tril(factor[np.ix_(order, order)]), factor[np.ix_(order, order)])
    assert (factor**2).sum(axis=1) == pytest.approx(1, abs=1e-15)


def test_independent_inputs_have_no_factor():
    """Without a correlation other than 0 there is no factor; with one, the others keep their scores bit for bit."""
    assert score_factor(CorrelationMatrix.of([("a", "b", 0.0)], NAMES).scores, range(6)) is None
    factor = score_factor(CorrelationMatrix.of([("a", "b", 0.3), ("c", "d", 0.0)], NAMES).scores, range(6))
    scores = np.random.default_rng(1).normal(size=(6, 50))
    made = correlated_scores(factor, list(scores))
    for index in (0, 2, 3, 4, 5):
        assert np.array_equal(made[index], scores[index])
    assert made[1] == pytest.approx(0.3 * scores[0] + np.sqrt(0.91) * scores[1], rel=1e-14)


def test_scores_of_correlation_1_are_equal():
    """Inputs with the correlation 1 have the same scores, with −1 opposite ones, to the bit and through chains."""
    matrix = CorrelationMatrix.of([("a", "b", 1), ("b", "c", -1), ("a", "c", -1)], NAMES).scores
    scores = np.random.default_rng(1).normal(size=(6, 50))
    for order in ([0, 1, 2, 3, 4, 5], [2, 0, 1, 3, 4, 5]):
        made = correlated_scores(score_factor(matrix, order), list(scores))
        assert np.array_equal(made[0], made[1])
        assert np.array_equal(made[0], -made[2])


def test_bits_of_scores_do_not_depend_on_the_array():
    """A score is the same to the bit wherever it stands in an array, and in an array of any size."""
    factor = score_factor(CorrelationMatrix.of([("a", "b", 0.3), ("c", "b", -0.7)], NAMES[:3]).scores, range(3))
    scores = np.random.default_rng(2).normal(size=(3, 1001))
    together = np.stack(correlated_scores(factor, list(scores)))
    for index in (0, 1, 500, 1000):
        alone = np.stack(correlated_scores(factor, list(scores[:, [index]])))
        assert np.array_equal(together[:, [index]], alone)
