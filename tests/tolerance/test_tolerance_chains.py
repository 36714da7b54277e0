"""Chains of deviations: the published loop, the rules against sums written out, and sampled chains."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flexlash.schema.variant import Limits
from flexlash.tolerance.tolerance_chains import Contribution, combined, inflation_of

LOOP = ((1, 0.25), (-1, 0.25), (-1, 0.20), (-1, 0.25))
"""Links 25 ± .25, 5 ± .25, 14 ± .20, 5 ± .25, of which the first adds and the others take away."""


def _loop(inflation=1.0, shift=0.0):
    """Return the loop's contributions, those of ± .25 with this inflation and shift."""
    return [
        Contribution(tolerance=t, sensitivity=a, **({"inflation": inflation, "shift": shift} if t == 0.25 else {}))
        for a, t in LOOP
    ]


def test_the_published_loop():
    """The loop comes out to 1e-6 by every rule, with uniform links and with a shift of each of these."""
    uniform = math.sqrt(3)
    found = combined(_loop())
    assert (found.worst_case, found.rss, found.bender) == pytest.approx((0.95, 0.476970, 0.715454), abs=1e-6)
    assert combined(_loop(uniform)).rss == pytest.approx(0.776209, abs=1e-6)
    assert combined(_loop(uniform, 0.3)).mean_shift == pytest.approx(0.786805, abs=1e-6)


def test_bender_stays_within_the_worst_case():
    """1.5 times the root of the sum of squares counts only up to the sum, as with a single link."""
    assert combined([Contribution(tolerance=2.0)]).bender == 2.0
    assert combined([Contribution(tolerance=2.0)] * 9).bender == pytest.approx(1.5 * 6.0)


def test_the_mean_shift_lies_between_its_ends():
    """Without a shift it is the root of the sum of squares, with a full one the worst case."""
    none, full = ([Contribution(tolerance=t, shift=shift) for t in (1.0, 2.0, 2.0)] for shift in (0.0, 1.0))
    assert combined(none).mean_shift == combined(none).rss == 3.0
    assert combined(full).mean_shift == combined(full).worst_case == 5.0


def test_arrays_give_each_row_what_it_has_alone():
    """Rows combined together have the bits that each has alone."""
    tolerances = np.random.default_rng(3).uniform(0.1, 2.0, (4, 7))
    together = combined([Contribution(tolerance=t, sensitivity=-2.0, inflation=1.3, shift=0.2) for t in tolerances])
    for row in range(7):
        alone = combined(
            [Contribution(tolerance=t, sensitivity=-2.0, inflation=1.3, shift=0.2) for t in tolerances[:, row].tolist()]
        )
        assert [values[row] for values in together] == list(alone)


def test_nothing_combines_to_nothing():
    """A chain without links cannot deviate."""
    assert combined([]) == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("limits", "expected"),
    [
        (Limits(low=1.0, high=3.0), 1.0),
        (Limits(low=1.0, high=3.0, sigma=2.0), 1.5),
        (Limits(low=1.0, high=3.0, sigma=6.0), 0.5),
        (Limits(low=1.0, high=3.0, distribution="triangular"), math.sqrt(1.5)),
        (Limits(low=1.0, high=3.0, distribution="uniform"), math.sqrt(3)),
    ],
)
def test_inflation_is_three_sigma_over_half_the_width(limits, expected):
    """Each distribution's 3σ/T is the one in closed form."""
    assert inflation_of(limits) == pytest.approx(expected, rel=1e-12)


def test_inflation_of_a_cut_normal_by_quadrature():
    """A normal cut at its limits has its own standard deviation, here by quadrature of its density."""
    for sigma in (0.7, 2.0, 3.0, 5.0):
        nodes, weights = np.polynomial.legendre.leggauss(200)
        density = weights * np.exp(-((sigma * nodes) ** 2) / 2)
        sd = math.sqrt((density * nodes**2).sum() / density.sum())
        limits = Limits(low=-1.0, high=1.0, distribution="truncated normal", sigma=sigma)
        assert inflation_of(limits) == pytest.approx(3 * sd, rel=1e-9)


@pytest.mark.slow
def test_the_root_of_the_sum_of_squares_is_three_sigma_of_a_sampled_chain():
    """Three standard deviations of a million sampled chains with links of every kind are RSS."""
    generator, count = np.random.default_rng(0), 1_000_000
    drawn = generator.normal(0, 0.1, count) - 2 * generator.uniform(-0.4, 0.4, count)
    drawn += 0.5 * generator.triangular(-0.6, 0, 0.6, count)
    kinds = (("normal", 0.3, 1.0), ("uniform", 0.4, -2.0), ("triangular", 0.6, 0.5))
    chain = [
        Contribution(
            tolerance=t, sensitivity=a, inflation=inflation_of(Limits(low=-t, high=t, distribution=distribution))
        )
        for distribution, t, a in kinds
    ]
    assert combined(chain).rss == pytest.approx(3 * drawn.std(), rel=4e-3)
