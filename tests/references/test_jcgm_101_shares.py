"""Shares of variance of the gauge block calibration, JCGM 101:2008 clause 9.5, against its moments in closed form.

The model is a sum of products of independent quantities, so that every index follows from their means and variances:
0.548 of the variance comes from the length of the reference standard.
"""

import math

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from flexlash.tolerance import Normal, Uniform, propagate
from flexlash.tolerance.student import Student

NOMINAL = 50e6
"""Length of the gauge block [nm]."""

EXPANSION_DIFFERENCE, TEMPERATURE_DIFFERENCE = (1e-6, 0.1e-6), (0.05, 0.025)
"""Curvilinear trapezoids about 0 [1/°C], [°C]: half the width, and by how much that is in doubt."""

INPUTS = {
    "standard": Student(50_000_623.0, 25.0, 18.0),
    "comparator": Student(215.0, 6.0, 24.0),
    "random_effects": Student(0.0, 4.0, 5.0),
    "systematic_effects": Student(0.0, 7.0, 8.0),
    "expansion": Uniform(9.5e-6, 13.5e-6),
    "mean_temperature": Normal(-0.1, 0.2),
    "cyclic_temperature": Uniform(0.0, 1.0),
    "expansion_difference": Uniform(0.0, 1.0),
    "temperature_difference": Uniform(0.0, 1.0),
}
"""Clause 9.5, table 10 [nm, °C, 1/°C]; the last three are probabilities of an arcsine and two trapezoids."""


def trapezoid(half, doubt):
    """Return the quantiles of a curvilinear trapezoid: uniform within ± w, and w uniform within half ± doubt."""
    value = np.linspace(0, half + doubt, 2001)
    inside = np.maximum(value, half - doubt)
    below = 0.5 + ((inside - (half - doubt)) + value * np.log((half + doubt) / inside)) / (4 * doubt)
    return PchipInterpolator(np.concatenate([1 - below[:0:-1], below]), np.concatenate([-value[:0:-1], value]))


EXPANDED, WARMER = trapezoid(*EXPANSION_DIFFERENCE), trapezoid(*TEMPERATURE_DIFFERENCE)


def deviation(
    *,
    standard,
    comparator,
    random_effects,
    systematic_effects,
    expansion,
    mean_temperature,
    cyclic_temperature,
    expansion_difference,
    temperature_difference,
):
    """Return the deviation [nm] of the gauge block from its nominal length."""
    warm = mean_temperature - 0.5 * np.cos(np.pi * cyclic_temperature)
    thermal = EXPANDED(expansion_difference) * warm + expansion * WARMER(temperature_difference)
    return standard + comparator + random_effects + systematic_effects - standard * thermal - NOMINAL


def exact():
    """Return first-order and total indices by input; the length of the standard counts as nominal beside expansions."""
    widths = [(half * half + doubt * doubt / 3) / 3 for half, doubt in (EXPANSION_DIFFERENCE, TEMPERATURE_DIFFERENCE)]
    expanded, warmer = (NOMINAL**2 * variance for variance in widths)
    mean, slope = 11.5e-6, 4e-6**2 / 12
    lengths = {name: one.standard_deviation**2 for name, one in list(INPUTS.items())[:4]}
    first = lengths | {
        "expansion": 0.0,
        "mean_temperature": 0.0,
        "cyclic_temperature": 0.0,
        "expansion_difference": 0.01 * expanded,
        "temperature_difference": mean**2 * warmer,
    }
    total = lengths | {
        "expansion": slope * warmer,
        "mean_temperature": 0.04 * expanded,
        "cyclic_temperature": 0.125 * expanded,
        "expansion_difference": 0.175 * expanded,
        "temperature_difference": (mean**2 + slope) * warmer,
    }
    variance = math.fsum(lengths.values()) + total["expansion_difference"] + total["temperature_difference"]
    return ({name: part / variance for name, part in parts.items()} for parts in (first, total))


def test_variance_of_the_closed_form_is_the_printed_one():
    """Clause 9.5.4: the standard uncertainty is 36 nm, and 0.548 of the variance comes from the standard's length."""
    first, _ = exact()
    sd = math.sqrt(INPUTS["standard"].standard_deviation ** 2 / first["standard"])
    assert sd == pytest.approx(36, abs=0.5)
    assert first["standard"] == pytest.approx(0.548, abs=5e-4)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["random", "sobol", "line"])
def test_9_5_gauge_block_calibration(method):
    """All eighteen indices agree with the closed form within four of their standard errors, which are below 0.013."""
    first, total = exact()
    spread = propagate(deviation, INPUTS, method=method)
    for exact_shares, shares, errors in (
        (first, spread.shares, spread.shares_standard_error),
        (total, spread.total_shares, spread.total_shares_standard_error),
    ):
        for name, share in exact_shares.items():
            assert abs(shares[name] - share) <= 4 * errors[name] + 1e-6
            assert errors[name] <= 0.013
    assert max(spread.shares, key=spread.shares.get) == "standard"
