"""The triangle with a mode: closed forms of its moments and quantiles, and what lines make of its kink."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import ndtr

from flexlash.tolerance import Triangular, propagate

thorough = settings(deadline=None, max_examples=40, derandomize=True)

MODES = [0.0, 1e-6, 0.1, 0.5, 0.8, 1.0]


def central_moments(low, high, mode):
    """Return mean, sd, skewness and excess kurtosis of a triangle in closed form."""
    square = low * low + high * high + mode * mode - low * high - low * mode - high * mode
    lean = (low + high - 2 * mode) * (2 * low - high - mode) * (low - 2 * high + mode)
    return (low + high + mode) / 3, math.sqrt(square / 18), math.sqrt(2) * lean / (5 * square**1.5), -0.6


@thorough
@given(st.floats(-100, 100), st.floats(1e-3, 100), st.floats(0, 1))
def test_mean_and_sd_are_the_closed_form(low, width, fraction):
    """Mean and sd are those of the corners, wherever the mode lies."""
    high, mode = low + width, min(low + fraction * width, low + width)
    own = Triangular(low, high, mode)
    mean, sd, _, _ = central_moments(0.0, high - low, mode - low)
    assert own.expectation == pytest.approx(low + mean, rel=1e-12, abs=1e-12)
    assert own.standard_deviation == pytest.approx(sd, rel=1e-9)


@pytest.mark.parametrize("mode", MODES)
def test_quantiles_are_the_closed_form_in_both_tails(mode):
    """The area below the value at a score is the score's probability to its last digits, and so is that above."""
    own = Triangular(0.0, 1.0, mode)
    scores = np.linspace(-8, 8, 161)
    value = own.standard_at(scores)
    below = np.where(value < mode, value**2 / (mode or 1), 1 - (1 - value) ** 2 / ((1 - mode) or 1))
    assert below == pytest.approx(ndtr(scores), abs=1e-14)
    rising = value < mode
    assert value[rising] ** 2 / (mode or 1) == pytest.approx(ndtr(scores[rising]), rel=1e-12)
    # What is left to an upper end of 1 is known to the rounding of 1 alone.
    left = np.sqrt(ndtr(-scores[~rising]) * (1 - mode))
    assert 1 - value[~rising] == pytest.approx(left, abs=2e-16)
    assert own.probability_below(value) == pytest.approx(ndtr(scores), abs=1e-14)


@pytest.mark.parametrize("mode", MODES)
def test_one_triangle_alone_is_exact(mode):
    """By lines a triangle has the moments and percentiles of its closed form: the quadrature knows its kink."""
    spread = propagate(lambda a: 7 - 2 * a, {"a": Triangular(-1.0, 3.0, 4 * mode - 1)})
    mean, sd, skewness, kurtosis = central_moments(-1.0, 3.0, 4 * mode - 1)
    assert spread.method == "line"
    assert spread.mean == pytest.approx(7 - 2 * mean, abs=1e-9)
    assert spread.sd == pytest.approx(2 * sd, rel=1e-9)
    assert spread.skewness == pytest.approx(-skewness, abs=1e-8)
    assert spread.kurtosis == pytest.approx(kurtosis, abs=1e-7)
    levels = np.array([1e-6, 0.00135, 0.3, 0.5, 0.975, 0.99865])
    below, above = 4 * np.sqrt((1 - levels) * mode) - 1, 3 - 4 * np.sqrt(levels * (1 - mode))
    exact = 7 - 2 * np.where(1 - levels < mode, below, above)
    assert spread.quantile(levels) == pytest.approx(exact, abs=1e-6)


def irwin_hall(value, count):
    """Return the distribution function of the sum of so many uniform numbers between 0 and 1."""
    terms = ((-1) ** k * math.comb(count, k) * (value - k) ** count for k in range(math.floor(value) + 1))
    return sum(terms) / math.factorial(count)


@pytest.mark.parametrize("method", ["line", "sobol"])
def test_two_triangles_are_four_uniforms(method):
    """The sum of two symmetric triangles is that of four uniform numbers: percentiles within four standard errors."""
    spread = propagate(lambda a, b: a + b, {"a": Triangular(0, 2), "b": Triangular(0, 2)}, method=method)
    slack = 1e-6
    for level in (0.00135, 0.025, 0.5, 0.975, 0.99865):
        value, error = float(spread.quantile(level)), 4 * float(spread.standard_error(level)) + slack
        assert irwin_hall(value - error, 4) <= level <= irwin_hall(value + error, 4)
    assert spread.sd == pytest.approx(math.sqrt(4 / 12), abs=4 * spread.sd_standard_error + slack)


def share_below(first, second, value):
    """Return the share of a sum of two triangles that start at 0, by quadrature between the kinks of both."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    kinks = (0.0, second.mode, second.high)
    ends = sorted({0.0, first.mode, first.high, *(min(max(value - kink, 0.0), first.high) for kink in kinks)})
    below = 0.0
    for start, end in pairwise(ends):
        at = start + (end - start) * (1 + nodes) / 2
        rising, falling = 2 * at / first.mode, 2 * (first.high - at) / (first.high - first.mode)
        density = np.where(at < first.mode, rising, falling) / first.high
        below += (end - start) / 2 * float(weights @ (density * second.probability_below((value - at) / second.high)))
    return below


def test_skewed_triangles_against_quadrature():
    """Percentiles of a sum of skewed triangles, by lines, are those of the convolution, within four standard errors."""
    first, second = Triangular(0.0, 1.0, 0.1), Triangular(0.0, 2.0, 1.9)
    spread = propagate(lambda a, b: a + b, {"a": first, "b": second})
    assert spread.method == "line"
    for level in (0.00135, 0.025, 0.5, 0.975, 0.99865):
        value, error = float(spread.quantile(level)), 4 * float(spread.standard_error(level)) + 1e-6
        assert share_below(first, second, value - error) <= level <= share_below(first, second, value + error)
        assert error <= 0.01 * spread.sd
