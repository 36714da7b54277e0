"""Correlations that contradict one another: between which values a pair may be, and which matrix is nearest."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from flexlash.tolerance.nearest_correlation import admissible, admissible_interval, nearest_correlations

thorough = settings(deadline=None, max_examples=40, derandomize=True)


def symmetric(*upper):
    """Return the matrix with ones on its diagonal and these numbers above and below it, row by row."""
    size = round((1 + (1 + 8 * len(upper)) ** 0.5) / 2)
    matrix = np.eye(size)
    matrix[np.triu_indices(size, 1)] = upper
    return np.maximum(matrix, matrix.T) + np.minimum(matrix, matrix.T) - np.diag(np.diag(matrix))


def least(matrix):
    """Return the least eigenvalue."""
    return np.linalg.eigvalsh(matrix)[0]


def of_rank(draw, size, rank):
    """Return correlations of so many inputs that follow from fewer ones."""
    root = np.random.default_rng(draw).normal(size=(size, rank))
    matrix = root @ root.T
    length = np.sqrt(np.diag(matrix))
    return matrix / length / length[:, None]


def test_singular_matrices_are_admissible_and_contradictions_are_not():
    """Correlations of ±1 and chains of them may be; a chain that turns back on itself may not."""
    assert admissible(symmetric(1, 1, 1))
    assert admissible(symmetric(-1, -1, 1))
    assert admissible(symmetric(1, 0.3, 0.3))
    assert not admissible(symmetric(1, 1, -1))
    assert not admissible(symmetric(-1, -1, -1))
    assert not admissible(symmetric(1, 0.3, 0.3 + 1e-4))
    assert admissible(of_rank(1, 6, 2))


@thorough
@given(first=st.floats(-1, 1), second=st.floats(-1, 1))
def test_interval_of_three_is_the_textbooks(first, second):
    """Of three inputs the third correlation lies within ab ± √((1 − a²)(1 − b²))."""
    reach = np.sqrt((1 - first**2) * (1 - second**2))
    found = admissible_interval(symmetric(first, 0.123, second), 0, 2)
    assert found == pytest.approx((first * second - reach, first * second + reach), abs=1e-7)


@thorough
@given(draw=st.integers(0, 10**6), size=st.integers(3, 6), deficit=st.integers(0, 2), moved=st.floats(-1, 1))
def test_interval_ends_where_an_eigenvalue_becomes_negative(draw, size, deficit, moved):
    """Inside the interval the least eigenvalue is not negative, a little outside it is; also of singular matrices."""
    matrix = of_rank(draw, size, max(size - deficit, 1))
    matrix[0, 1] = matrix[1, 0] = moved
    low, high = admissible_interval(matrix, 0, 1)
    for value, inside in (
        (low, True),
        ((low + high) / 2, True),
        (high, True),
        (low - 1e-3, False),
        (high + 1e-3, False),
    ):
        matrix[0, 1] = matrix[1, 0] = value
        assert bool(least(matrix) >= -1e-7) is inside


def test_no_value_of_a_pair_fixes_what_the_others_contradict():
    """Where the other inputs contradict one another there is no interval, nor where one follows them no way."""
    assert admissible_interval(symmetric(0.1, 0.1, 0.1, 0.1, 0.1, -0.9), 0, 1) is not None
    twisted = symmetric(0, 0.9, 0.9, 0, 0, -0.9)
    assert admissible_interval(twisted, 0, 1) is None
    assert admissible_interval(symmetric(0, 0, 0.5, 0, 0, 1.0), 0, 1) is None


def test_nearest_matrix_of_highams_example():
    """The nearest correlation matrix of Higham 2002, section 4, is the printed one."""
    matrix = symmetric(1, 0, 1)
    found = nearest_correlations(matrix, ~np.eye(3, dtype=bool))
    assert found == pytest.approx(symmetric(0.7607, 0.1573, 0.7607), abs=5e-5)


@pytest.mark.parametrize("draw", range(4))
def test_nearest_matrix_is_what_a_minimiser_finds(draw):
    """Over the entered pairs alone no admissible matrix is nearer than the one found, by a general minimiser."""
    generator = np.random.default_rng(draw)
    matrix = symmetric(*generator.uniform(-1, 1, size=6))
    matrix[0, 3] = matrix[3, 0] = 0.0
    entered = (matrix != 0) & (matrix != 1)
    found = nearest_correlations(matrix, entered)
    assert least(found) >= -1e-9
    assert np.array_equal(found[~entered], matrix[~entered])
    pairs = [pair for pair in zip(*np.triu_indices(4, 1), strict=True) if entered[pair]]

    def at(values):
        other = matrix.copy()
        for (row, column), value in zip(pairs, values, strict=True):
            other[row, column] = other[column, row] = value
        return other

    best = minimize(
        lambda values: ((at(values) - matrix) ** 2).sum(),
        np.zeros(len(pairs)),
        constraints={"type": "ineq", "fun": lambda values: least(at(values))},
        method="SLSQP",
    )
    assert np.linalg.norm(found - matrix) <= np.sqrt(best.fun) + 1e-4


def test_an_admissible_matrix_is_its_own_nearest():
    """What is admissible stays as it is."""
    matrix = of_rank(3, 5, 5)
    assert nearest_correlations(matrix, ~np.eye(5, dtype=bool)) == pytest.approx(matrix, abs=1e-12)
