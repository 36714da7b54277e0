"""Series of Hermite polynomials: orthonormal, and correlations of values for those of scores known in closed form."""

import math

import numpy as np
import pytest
from grids import for_each
from scipy import special, stats

from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform
from flexlash.tolerance.hermite_series import hermite_polynomials, score_correlation, value_correlation

SHAPES = {
    "normal": Normal(3, 2),
    "uniform": Uniform(-1, 4),
    "triangular": Triangular(0, 1),
    "falling": Triangular(0, 1, 0.0),
    "skewed": Triangular(0, 1, 0.2),
    "cut": TruncatedNormal(0, 1, -0.5, 2),
}
PAIRS = [(one, other) for one in SHAPES for other in SHAPES]


def test_polynomials_are_scipys():
    """The normalised polynomials are scipy's of the probabilists, over the root of the factorial."""
    score = np.linspace(-5, 5, 21)
    for order, values in enumerate(hermite_polynomials(score, 30)):
        assert values == pytest.approx(special.eval_hermitenorm(order, score) / math.sqrt(math.factorial(order)))


@for_each("of_scores", [-1.0, -0.999, -0.5, 0.0, 0.3, 0.9, 0.9999, 1.0])
def test_uniform_values_in_closed_form(of_scores):
    """Uniform values correlate by 6/π · asin(ρ/2) (Pearson 1907), to rounding at either end too."""
    found = value_correlation(Uniform(0, 1), Uniform(2, 9))(of_scores)
    assert found == pytest.approx(6 / math.pi * math.asin(of_scores / 2), abs=2e-15)


@for_each("of_scores", [-0.8, 0.1, 0.95])
def test_a_uniform_and_a_normal_in_closed_form(of_scores):
    """A uniform value and a normal one correlate by √(3/π) ρ."""
    for pair in ((Uniform(0, 1), Normal(0, 1)), (Normal(0, 1), Uniform(0, 1))):
        assert value_correlation(*pair)(of_scores) == pytest.approx(math.sqrt(3 / math.pi) * of_scores, abs=1e-14)


@pytest.mark.slow
@for_each("pair", PAIRS)
def test_values_correlate_as_quadrature_in_the_plane_says(pair):
    """For every pair of shapes the correlation of values is that of Gauss–Legendre nodes in the plane of scores."""
    first, second = SHAPES[pair[0]], SHAPES[pair[1]]
    nodes, mass = np.polynomial.legendre.leggauss(160)
    score, weight = 8.5 * nodes, mass * stats.norm.pdf(8.5 * nodes)
    weights = np.outer(weight, weight)
    weights /= weights.sum()
    for of_scores in (-0.7, 0.5):
        tied = of_scores * score[:, None] + math.sqrt(1 - of_scores**2) * score
        values = np.broadcast_to(first.standard_at(score)[:, None], tied.shape), second.standard_at(tied)
        one, other = (column - (weights * column).sum() for column in values)
        exact = (weights * one * other).sum() / math.sqrt((weights * one**2).sum() * (weights * other**2).sum())
        assert value_correlation(first, second)(of_scores) == pytest.approx(exact, abs=2e-6)


@pytest.mark.slow
@for_each("pair", PAIRS)
def test_ends_are_those_of_sorted_values(pair):
    """With ρ = ±1 values correlate as their quantile functions at one score, or at opposite ones."""
    first, second = SHAPES[pair[0]], SHAPES[pair[1]]
    probability = (np.arange(200_000) + 0.5) / 200_000
    values = first.standard(probability), second.standard(probability)
    correlation = value_correlation(first, second)
    assert correlation(1.0) == pytest.approx(np.corrcoef(*values)[0, 1], abs=1e-4)
    assert correlation(-1.0) == pytest.approx(np.corrcoef(values[0], values[1][::-1])[0, 1], abs=1e-4)


@pytest.mark.slow
@for_each("pair", PAIRS)
def test_score_correlation_turns_value_correlation_back(pair):
    """The scores' correlation that is found has the values correlate as was asked, at the ends exactly ±1."""
    first, second = SHAPES[pair[0]], SHAPES[pair[1]]
    correlation = value_correlation(first, second)
    for of_scores in (-0.99, -0.3, 0.0, 0.6, 0.97):
        assert score_correlation(first, second, correlation(of_scores)) == pytest.approx(of_scores, abs=1e-10)
    for end in (-1.0, 1.0):
        assert score_correlation(first, second, correlation(end)) == end


def test_values_that_no_scores_correlate_so():
    """Beyond what the distributions can be correlated by there is no correlation of scores."""
    assert score_correlation(Uniform(0, 1), Normal(0, 1), 0.98) is None
    assert score_correlation(Uniform(0, 1), Normal(0, 1), -0.98) is None
    assert score_correlation(Uniform(0, 1), Normal(0, 1), math.sqrt(3 / math.pi) - 1e-6) is not None
    assert score_correlation(Normal(0, 1), Normal(0, 1), 1.1) is None
