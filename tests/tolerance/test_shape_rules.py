"""What is known of a shape once for all rows: its variable, and rules that integrate waves and powers of it."""

import math
import os
import subprocess
import sys

import numpy as np
import pytest
from scipy import special

from flexlash.tolerance import Lognormal, Measured, Normal, Student, Triangular, TruncatedNormal, Uniform
from flexlash.tolerance.engine.shape_rules import gauss_rule, shape_rule

SHAPES = {
    "normal": Normal(3, 0.5),
    "uniform": Uniform(2, 5),
    "triangular": Triangular(-1, 1),
    "skewed": Triangular(0, 1, 0.2),
    "cut": TruncatedNormal(0, 1, -3, 3),
    "cut off centre": TruncatedNormal(0, 1, -1, 2.5),
    "lognormal": Lognormal(mean=8, sd=2),
    "student": Student(0, 1, 6),
    "measured": Measured([1.0, 1.2, 1.25, 1.4, 1.41, 1.6, 2.0]),
}
each_shape = pytest.mark.parametrize("distribution", SHAPES.values(), ids=list(SHAPES))

SCORES = np.linspace(-8.3, 8.3, 40_001)
MASS = np.exp(-SCORES * SCORES / 2) / np.exp(-SCORES * SCORES / 2).sum()


@each_shape
@pytest.mark.parametrize("nodes", [41, 97])
@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_waves_up_to_what_is_resolved_are_integrated(distribution, nodes, part):
    """The expectation of a wave of any frequency up to `resolved` is that of a fine sum over scores, to 2e-8."""
    rule = shape_rule(distribution, nodes)
    frequency = part * rule.resolved
    exact = (MASS * np.exp(1j * frequency * rule.variable(distribution.standard_at(SCORES)))).sum()
    assert abs((rule.weights * np.exp(1j * frequency * rule.variables)).sum() - exact) < 2e-8


@each_shape
def test_variables_and_standard_values_are_each_others_inverse(distribution):
    """The median's variable is the rule's, and standard values come back from their variables."""
    rule = shape_rule(distribution, 41)
    standard = distribution.standard_at(np.linspace(-4, 4, 33))
    assert rule.variable(distribution.standard_at(np.zeros(1)))[0] == rule.median
    assert rule.standard(rule.variable(standard)) == pytest.approx(standard, rel=1e-9, abs=1e-12)
    assert np.abs(rule.variables).max() < 1.5


def test_heavy_tails_have_an_end():
    """Tails that go on far beyond the range of the polynomials are pulled in, others are not touched."""
    heavy = {name for name, distribution in SHAPES.items() if shape_rule(distribution, 41).heavy}
    assert heavy == {"student", "lognormal"}
    assert np.abs(shape_rule(Student(0, 1, 3), 41).variable(np.array([1e9, -1e9]))) == pytest.approx(1 / math.tanh(1))


@pytest.mark.parametrize("nodes", [5, 20, 60])
def test_gauss_rule_of_a_uniform_is_that_of_legendre(nodes):
    """The nodes and weights found by recurrence are those of Gauss and Legendre."""
    found, weights = gauss_rule(Uniform(0, 1), nodes)
    exact, exact_weights = special.roots_sh_legendre(nodes)
    assert found == pytest.approx(exact, abs=1e-12)
    assert weights == pytest.approx(exact_weights, abs=1e-12)


def test_gauss_rule_of_a_normal_is_that_of_hermite():
    """So are those of Gauss and Hermite."""
    found, weights = gauss_rule(Normal(0, 1), 6)
    exact, exact_weights = special.roots_hermitenorm(6)
    assert found == pytest.approx(exact, abs=1e-9)
    assert weights == pytest.approx(exact_weights / math.sqrt(2 * math.pi), abs=1e-9)


@pytest.mark.parametrize("mode", [0.0, 0.3, 1.0])
def test_kinks_do_not_disturb_the_gauss_rule(mode):
    """Powers of a triangle are integrated exactly wherever its peak is."""
    found, weights = gauss_rule(Triangular(0, 1, mode), 9)
    for power in range(1, 17):
        # E xⁿ = 2 (1 + m + … + mⁿ)/((n + 1)(n + 2)), by integrating both sides of the triangle.
        exact = 2 * sum(mode**part for part in range(power + 1)) / ((power + 1) * (power + 2))
        assert float((weights * found**power).sum()) == pytest.approx(exact, rel=1e-12)


def test_rules_are_the_same_however_many_threads_there_are():
    """Worker processes, which have one thread for linear algebra, find the bits of a process with several."""
    program = (
        "import hashlib; from flexlash.tolerance import Triangular; "
        "from flexlash.tolerance.engine.shape_rules import gauss_rule; "
        "print(*(hashlib.sha256(one.tobytes()).hexdigest() for one in gauss_rule(Triangular(0, 1), 385)))"
    )
    found = {
        subprocess.run(
            [sys.executable, "-c", program],
            env=os.environ | {"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for threads in ("1", "2")
    }
    assert len(found) == 1
