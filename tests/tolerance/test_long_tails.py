"""Tails in which one long-tailed input outdoes all others: what lines do not see of them is told."""

import numpy as np
import pytest
from scipy import stats
from scipy.fft import irfft, rfft
from scipy.special import ndtri

from flexlash.tolerance import Lognormal, Student, propagate

SEEDS = range(6)
RARE = np.array([1e-4, 1e-5, 1e-6])
CELLS = 1 << 17

LOGNORMAL = stats.lognorm(np.sqrt(np.log(1.25)), scale=1 / np.sqrt(1.25))
CASES = {
    "lognormal": (Lognormal(1.0, 0.5), LOGNORMAL, 5, 0.0, 30.0),
    "slightly lognormal": (
        Lognormal(1.0, 0.3),
        stats.lognorm(np.sqrt(np.log(1.09)), scale=1 / np.sqrt(1.09)),
        4,
        0,
        15,
    ),
    "student": (Student(0.0, 1.0, 20), stats.t(20), 3, -40.0, 40.0),
}
"""A distribution, scipy's, how many inputs have it, and between what values it is convolved."""


def values_rarely_passed(one, inputs, low, high):
    """Return the values that a sum of the same inputs is above with `RARE`, by masses on a lattice, convolved."""
    step = (high - low) / CELLS
    masses = np.diff(one.cdf(low + step * np.arange(CELLS + 1)))
    size = inputs * CELLS
    above = np.cumsum(irfft(rfft(masses, size) ** inputs, size)[::-1])[::-1]
    # The middles of cells add up, and the mass of a cell is spread over it.
    edges = inputs * (low + step / 2) + step * (np.arange(size) - 0.5)
    return np.interp(-RARE, -above, edges)


@pytest.mark.parametrize("case", CASES)
def test_rare_sums_of_long_tailed_inputs_are_as_well_known_as_told(case):
    """Probabilities above rare sums are off by their told errors, not by many, where one input makes such a sum."""
    distribution, one, inputs, low, high = CASES[case]
    values = values_rarely_passed(one, inputs, low, high)
    names = [f"x{index}" for index in range(inputs)]
    off = []
    for seed in SEEDS:
        spread = propagate(lambda **each: sum(each.values()), dict.fromkeys(names, distribution), samples=64, seed=seed)
        ends = np.array([spread.probability_interval(value) for value in values])
        told = (ndtri(ends[:, 1]) - ndtri(ends[:, 0])) / (2 * 1.96)
        off.append((ndtri(spread.probability_above(values)) - ndtri(RARE)) / np.hypot(told, 3e-5))
    assert np.sqrt(np.mean(np.square(off), axis=0)).max() < 1.5
