"""The lognormal distribution: closed forms of its numbers and tails, and products that are lognormal again."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import ndtri

from flexlash.tolerance import Lognormal, Normal, propagate

thorough = settings(deadline=None, max_examples=60, derandomize=True)

LEVELS = np.array([1e-6, 0.00135, 0.025, 0.5, 0.975, 0.99865, 1 - 1e-6])


@thorough
@given(st.floats(-50, 50), st.floats(1e-3, 100), st.floats(-3, 3))
def test_values_at_scores_follow_the_closed_form(low, distance, log_variation):
    """Values at scores ±8 and between are low + median · exp(σ score), to rounding, in both tails."""
    variation = 10**log_variation
    own = Lognormal(mean=low + distance, sd=variation * distance, low=low)
    distance = own.mean - low
    sigma = math.sqrt(math.log(1 + (own.sd / distance) ** 2))
    scores = np.linspace(-8, 8, 65)
    beyond = distance / math.sqrt(1 + (own.sd / distance) ** 2) * np.exp(sigma * scores)
    # The logarithm of a number close to 1 has lost digits; the code's own has not.
    assert own.scale * own.standard_at(scores) == pytest.approx(beyond, rel=1e-9)
    assert own.location == low


@pytest.mark.parametrize("variation", [1e-6, 1e-3, 0.1, 0.5, 1.0])
def test_moments_are_those_of_the_quantiles(variation):
    """Mean and sd as they were given are those that the standard values have by quadrature over the scores."""
    own = Lognormal(mean=5.0, sd=3 * variation, low=2.0)
    scores = np.linspace(-12, 12, 2401)
    weights = np.exp(-scores * scores / 2)
    weights /= weights.sum()
    beyond = own.scale * own.standard_at(scores) - 3
    mean = float(weights @ beyond)
    assert mean == pytest.approx(0, abs=1e-12)
    assert math.sqrt(weights @ (beyond - mean) ** 2) == pytest.approx(own.sd, rel=1e-9)
    assert (own.expectation, own.standard_deviation) == (5.0, 3 * variation)


def test_hardly_scattering_is_normal():
    """With a sd of a millionth of the mean the values are those of the normal distribution."""
    scores = np.linspace(-8, 8, 33)
    own = Lognormal(mean=1.0, sd=1e-6)
    assert own.scale * own.standard_at(scores) - 1 == pytest.approx(1e-6 * scores, abs=1e-10)


def product_of_powers(a, b, c):
    """Return a product that is lognormal where its factors are."""
    return a * a / b * c


FACTORS = {"a": Lognormal(3.0, 0.3), "b": Lognormal(1.0, 0.4), "c": Lognormal(50.0, 1.0)}
_SQUARES = {name: math.log(1 + (one.sd / one.mean) ** 2) for name, one in FACTORS.items()}
_MEANS = {name: math.log(one.mean) - _SQUARES[name] / 2 for name, one in FACTORS.items()}
LOG_MEAN = 2 * _MEANS["a"] - _MEANS["b"] + _MEANS["c"]
LOG_SD = math.sqrt(4 * _SQUARES["a"] + _SQUARES["b"] + _SQUARES["c"])


def test_logarithm_of_a_product_is_normal():
    """Percentiles of the logarithm of a product of lognormals are a normal's to rounding, from 1 ppm to all but 1."""
    spread = propagate(lambda **factors: np.log(product_of_powers(**factors)), FACTORS)
    assert spread.method == "line"
    assert spread.quantile(LEVELS) == pytest.approx(LOG_MEAN + LOG_SD * ndtri(LEVELS), abs=1e-9)
    assert (spread.mean, spread.sd) == pytest.approx((LOG_MEAN, LOG_SD), abs=1e-9)


def test_product_is_lognormal():
    """Percentiles of a product of lognormals are those of the lognormal that it is, within four standard errors."""
    spread = propagate(product_of_powers, FACTORS)
    exact = np.exp(LOG_MEAN + LOG_SD * ndtri(LEVELS))
    assert spread.method == "line"
    mean = math.exp(LOG_MEAN + LOG_SD**2 / 2)
    sd = mean * math.sqrt(math.expm1(LOG_SD**2))
    off = np.abs(spread.quantile(LEVELS) - exact)
    assert (off <= 4 * spread.standard_error(LEVELS) + 1e-9 * exact).all()
    assert (off <= 1e-4 * exact).all()
    assert spread.mean == pytest.approx(mean, abs=4 * spread.mean_standard_error)
    assert spread.sd == pytest.approx(sd, abs=4 * spread.sd_standard_error)


@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_sum_with_a_normal(method):
    """Mean, sd and skewness of a lognormal plus a normal are those of the sum, within four standard errors."""
    skewed = Lognormal(mean=2.0, sd=1.0, low=0.5)
    spread = propagate(lambda a, b: a + b, {"a": skewed, "b": Normal(1.0, 2.0)}, method=method)
    variation = 1 / 1.5
    third = (variation**3 + 3 * variation) * 1.0**3
    assert spread.mean == pytest.approx(3.0, abs=4 * spread.mean_standard_error + 1e-9)
    assert spread.sd == pytest.approx(math.sqrt(5), abs=4 * spread.sd_standard_error + 1e-9)
    assert spread.skewness == pytest.approx(third / 5**1.5, abs=4 * spread.skewness_standard_error + 1e-9)
