"""Student's t: tails against closed forms for four degrees of freedom, and what a model makes of it."""

import math

import numpy as np
import pytest
from scipy import stats
from scipy.special import ndtr

from flexlash.tolerance import Normal, Student, propagate


@pytest.mark.parametrize("score", [-8.3, -8.0, -5.0, -1.0, 1.0, 5.0, 8.0, 8.3])
def test_both_tails_are_exact(score):
    """The share of t of 4 degrees beyond its value at a score, in closed form, is the score's, out to ±8.3."""
    value = abs(Student(0, 1, 4).standard_at(np.array([score]))[0])
    part = 4 / (4 + value * value)
    root = math.sqrt(1 - part)
    beyond = part * part * (2 + root) / (4 * (1 + root) ** 2)
    assert beyond == pytest.approx(ndtr(-abs(score)), rel=1e-12)


def test_opposite_scores_have_opposite_values():
    """Values at opposite scores are opposite to the last bit, and 0 at the score 0."""
    scores = np.linspace(0, 8.3, 84)
    own = Student(0, 1, 7)
    assert np.array_equal(own.standard_at(-scores), -own.standard_at(scores))
    assert own.standard_at(np.zeros(1))[0] == pytest.approx(0, abs=1e-15)


def test_many_degrees_are_normal():
    """With a hundred million degrees of freedom values at scores are the scores."""
    scores = np.linspace(-8, 8, 33)
    assert Student(0, 1, 1e8).standard_at(scores) == pytest.approx(scores, abs=2e-6)


def test_mean_of_few_observations_beside_a_normal():
    """Percentiles of t of 5 degrees plus a normal, by lines, are those of the convolution by quadrature."""
    spread = propagate(lambda a, b: a + b, {"a": Student(1.0, 0.5, 5), "b": Normal(0.0, 1.0)})
    nodes, weights = np.polynomial.legendre.leggauss(400)
    t = np.tan(nodes * math.pi / 2)
    density = stats.t(5).pdf(t) * (1 + t * t) * math.pi / 2 * weights
    for level in (0.00135, 0.025, 0.5, 0.975, 0.99865):
        value = float(spread.quantile(level))
        below = float(density @ ndtr(value - 1 - 0.5 * t))
        assert abs(below - level) <= 4 * float(spread.standard_error(level)) * 0.4 + 1e-7
    assert spread.sd == pytest.approx(math.sqrt(1 + 0.25 * 5 / 3), abs=4 * spread.sd_standard_error + 1e-6)
