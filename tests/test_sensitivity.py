"""Gradient, first-order standard uncertainty and worst case, against calculus and against every corner."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.mechanics.flexspline import backlash
from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform
from flexlash.tolerance.sensitivity import first_order_sd, gradient, worst_case

thorough = settings(deadline=None, max_examples=60, derandomize=True)

factors = st.floats(-5, 5)
positions = st.floats(-10, 10)

B3_160_ENDS = {
    "cylinder_length": (0.1598, 0.1602),
    "wall_thickness": (0.00155, 0.00165),
    "disk_thickness": (0.00155, 0.00165),
    "mean_radius": (0.07994, 0.08006),
    "disk_inner_radius": (0.03985, 0.04015),
    "youngs_modulus": (204.67e9, 217.33e9),
    "poisson_ratio": (0.28, 0.32),
}


def wind(**dimensions):
    """Return the backlash of the cup at 800 N·m [rad]."""
    return backlash("cup", {"torque": 800.0, **dimensions})


def test_gradient_of_a_product():
    """The gradient of a product and of a sine is calculus's."""
    slopes = gradient(lambda a, b: a**2 * np.sin(b), {"a": 3.0, "b": 0.5}, {"a": 1e-4, "b": 1e-4})
    assert slopes == pytest.approx({"a": 6 * math.sin(0.5), "b": 9 * math.cos(0.5)}, rel=1e-8)


def test_gradient_asks_for_some_inputs_alone():
    """Inputs without a step stay at the centre and have no slope."""
    slopes = gradient(lambda a, b: a * b, {"a": 3.0, "b": 5.0}, {"b": 1e-3})
    assert slopes == pytest.approx({"b": 3.0}, rel=1e-9)


def test_gradient_divides_by_the_step_taken():
    """A step that a large centre rounds is divided by as taken, so that a slope of 1 stays 1."""
    centre = 2.0**30 + 1
    assert gradient(lambda a: a, {"a": centre}, {"a": 1e-6 / 3}) == {"a": 1.0}


@thorough
@given(slopes=st.tuples(factors, factors, factors), sds=st.tuples(*[st.floats(0.01, 10)] * 3), centre=positions)
def test_first_order_sd_of_a_linear_model(slopes, sds, centre):
    """The first-order uncertainty of a linear model is the root of the summed squares."""
    names = ("a", "b", "c")
    middle = dict.fromkeys(names, centre)
    scatter = {name: Normal(mean=centre, sd=sd) for name, sd in zip(names, sds, strict=True)}

    def model(a, b, c):
        return slopes[0] * a + slopes[1] * b + slopes[2] * c

    exact = math.sqrt(sum((slope * sd) ** 2 for slope, sd in zip(slopes, sds, strict=True)))
    assert first_order_sd(model, middle, scatter) == pytest.approx(exact, rel=1e-6, abs=1e-7)


@pytest.mark.parametrize(
    ("distribution", "sd"),
    [
        (Normal(mean=0, sd=0.3), 0.3),
        (Uniform(low=-0.3, high=0.3), 0.3 / math.sqrt(3)),
        (Triangular(low=-0.3, high=0.3), 0.3 / math.sqrt(6)),
        (TruncatedNormal(mean=0, sd=1.0, low=-1.0, high=1.0), 0.5396),
    ],
)
def test_first_order_sd_takes_the_true_standard_deviation(distribution, sd):
    """Each distribution enters with its own standard deviation, a cut normal with that after the cut."""
    found = first_order_sd(lambda a: 2 * a, {"a": 0.0}, {"a": distribution})
    assert found == pytest.approx(2 * sd, rel=1e-4)


def test_first_order_sd_is_blind_to_curvature():
    """At the bottom of a parabola the first-order uncertainty is 0 though the output scatters."""
    assert first_order_sd(lambda a: a * a, {"a": 0.0}, {"a": Normal(mean=0, sd=1)}) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("relative", [1e-3, 1e-8, 1e-12, 1e-14])
def test_first_order_sd_of_a_tolerance_next_to_nothing(relative):
    """A tolerance far below the size of its dimension still has its first-order uncertainty, to 1 %."""
    sd = 800.0 * relative
    found = first_order_sd(lambda torque: 2 * torque, {"torque": 800.0}, {"torque": Normal(mean=800.0, sd=sd)})
    assert found == pytest.approx(2 * sd, rel=0.01)


@thorough
@given(
    slopes=st.tuples(factors, factors, factors),
    centres=st.tuples(positions, positions, positions),
    halves=st.tuples(*[st.floats(0.01, 5)] * 3),
)
def test_worst_case_of_a_linear_model(slopes, centres, halves):
    """The worst case of a linear model is the sum of all absolute effects, either way."""
    names = ("a", "b", "c")
    ends = {name: (middle - half, middle + half) for name, middle, half in zip(names, centres, halves, strict=True)}

    def model(a, b, c):
        return slopes[0] * a + slopes[1] * b + slopes[2] * c

    found = worst_case(model, ends)
    middle = sum(slope * centre for slope, centre in zip(slopes, centres, strict=True))
    reach = sum(abs(slope) * half for slope, half in zip(slopes, halves, strict=True))
    assert (found.low, found.high) == pytest.approx((middle - reach, middle + reach), rel=1e-9, abs=1e-9)


def test_worst_case_of_the_flexspline_over_every_corner():
    """The worst case of B3-160 is the least and greatest backlash over all 128 corners of its limits."""
    corners = np.array(list(itertools.product(*B3_160_ENDS.values()))).T
    every = wind(**dict(zip(B3_160_ENDS, corners, strict=True)))
    found = worst_case(wind, B3_160_ENDS)
    assert (found.low, found.high) == (every.min(), every.max())
    assert found.low * 1e3 == pytest.approx(0.988170, abs=5.1e-7)
    assert found.high * 1e3 == pytest.approx(1.165969, abs=5.1e-7)


@thorough
@given(shrink=st.floats(0.05, 1.0), name=st.sampled_from(list(B3_160_ENDS)))
def test_wider_limits_never_have_a_narrower_worst_case(shrink, name):
    """Narrowing one dimension's limits around their middle never widens the worst case."""
    low, high = B3_160_ENDS[name]
    middle, half = (low + high) / 2, (high - low) / 2
    wide = worst_case(wind, B3_160_ENDS)
    narrow = worst_case(wind, B3_160_ENDS | {name: (middle - shrink * half, middle + shrink * half)})
    assert wide.low * (1 - 1e-12) <= narrow.low
    assert narrow.high <= wide.high * (1 + 1e-12)


def test_swings_are_the_effect_of_one_dimension():
    """A swing is the output with one input at its limits and the others in the middle of theirs."""
    found = worst_case(wind, B3_160_ENDS)
    middle = {name: (low + high) / 2 for name, (low, high) in B3_160_ENDS.items()}
    assert list(found.swings) == list(B3_160_ENDS)
    for name, limits in B3_160_ENDS.items():
        alone = tuple(float(wind(**middle | {name: limit})) for limit in limits)
        assert found.swings[name] == pytest.approx(alone, rel=1e-14)


def test_input_without_effect_has_a_level_swing():
    """An input that the output ignores swings nothing and leaves the worst case alone."""
    found = worst_case(lambda a, b: a + 0 * b, {"a": (1.0, 2.0), "b": (-5.0, 7.0)})
    assert found.swings["b"] == (1.5, 1.5)
    assert (found.low, found.high) == (1.0, 2.0)
