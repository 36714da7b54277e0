"""Gradient, first-order standard uncertainty and worst case, against calculus and against every corner."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.mechanics.flexspline import backlash
from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform
from flexlash.tolerance.sensitivity import first_order_sd, first_order_valid, gradient, worst_case

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
    scatter = dict(zip(names, sds, strict=True))

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
    found = first_order_sd(lambda a: 2 * a, {"a": 0.0}, {"a": distribution.standard_deviation})
    assert found == pytest.approx(2 * sd, rel=1e-4)


def test_first_order_sd_is_blind_to_curvature():
    """At the bottom of a parabola the first-order uncertainty is 0 though the output scatters."""
    assert first_order_sd(lambda a: a * a, {"a": 0.0}, {"a": 1.0}) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("relative", [1e-3, 1e-8, 1e-12, 1e-14])
def test_first_order_sd_of_a_tolerance_next_to_nothing(relative):
    """A tolerance far below the size of its dimension still has its first-order uncertainty, to 1 %."""
    sd = 800.0 * relative
    found = first_order_sd(lambda torque: 2 * torque, {"torque": 800.0}, {"torque": sd})
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


ROWS = 5
SCALES = np.array([0.3, 0.7, 1.0, 1.9, 4.0])
MANY_ENDS = {
    name: (middle - half, middle + half)
    for name, (low, high) in B3_160_ENDS.items()
    for middle, half in [((low + high) / 2 * np.ones(ROWS), (high - low) / 2 * SCALES / 4)]
}


def _row(values, row):
    """Return one row's scalars of arrays (rows,) by name."""
    return {name: value[row] for name, value in values.items()}


def test_rows_of_arrays_are_what_each_row_is_alone():
    """Gradient, first-order uncertainty and worst case of many rows are, bit for bit, those of each row alone."""
    middle = {name: (low + high) / 2 for name, (low, high) in MANY_ENDS.items()}
    sds = {name: (high - low) / 6 for name, (low, high) in MANY_ENDS.items()}
    slopes, first_order, worst = (
        gradient(wind, middle, sds),
        first_order_sd(wind, middle, sds),
        worst_case(wind, MANY_ENDS),
    )
    assert first_order.shape == worst.low.shape == worst.high.shape == (ROWS,)
    assert (np.diff(first_order) > 0).all()
    for row in range(ROWS):
        alone = {name: (low[row], high[row]) for name, (low, high) in MANY_ENDS.items()}
        assert _row(slopes, row) == gradient(wind, _row(middle, row), _row(sds, row))
        assert first_order[row] == first_order_sd(wind, _row(middle, row), _row(sds, row))
        found = worst_case(wind, alone)
        assert (worst.low[row], worst.high[row]) == (found.low, found.high)
        for name, (at_low, at_high) in worst.swings.items():
            assert (at_low[row], at_high[row]) == found.swings[name]


def test_each_row_finds_the_limit_that_hurts_it():
    """Rows in which the same input raises or lowers the output have their worst cases at opposite limits."""
    signs = np.array([1.0, -1.0])
    found = worst_case(lambda a: signs * a, {"a": (np.array([1.0, 2.0]), np.array([3.0, 5.0]))})
    assert found.low.tolist() == [1.0, -5.0]
    assert found.high.tolist() == [3.0, -2.0]


# JCGM 101:2008 (three digits are ours): estimate, first-order uncertainty, 95 % interval, significant digits, and
# whether the first-order interval is valid.
JCGM_101 = {
    "9.2.2 four normals": (0.0, 2.0, (-3.92, 3.92), 2, True),
    "9.2.3 four rectangular": (0.0, 2.0, (-3.88, 3.88), 2, True),
    "9.2.3 to three digits": (0.0, 2.0, (-3.88, 3.88), 3, False),
    "9.2.4 one dominant": (0.0, 10.1, (-17.0, 17.0), 2, False),
    "9.3 first order": (1.234, 0.0539, (1.0834, 1.3825), 2, False),
    "9.3 higher order": (1.234, 0.0750, (1.0834, 1.3825), 2, False),
}


@pytest.mark.parametrize("clause", JCGM_101)
def test_validity_by_the_examples_of_jcgm_101(clause):
    """The first-order interval is valid in just those examples of JCGM 101 where clause 8 finds it valid."""
    estimate, uncertainty, interval, digits, valid = JCGM_101[clause]
    assert first_order_valid(estimate, uncertainty, interval, 0.95, digits) == valid


@pytest.mark.parametrize(("uncertainty", "half_unit"), [(2.0, 0.05), (0.0754, 0.0005), (9.96, 0.5), (9.94, 0.05)])
def test_tolerance_of_validity_is_half_a_unit_of_the_second_digit(uncertainty, half_unit):
    """Either end may be off by half a unit in the uncertainty's second digit and no more; 9.96 rounds to 10."""
    reach = 1.959963985 * uncertainty
    for sign in (1, -1):
        for part, valid in ((0.99, True), (1.01, False)):
            off = sign * part * half_unit
            assert first_order_valid(7.0, uncertainty, (7 - reach + off, 7 + reach), 0.95) == valid
            assert first_order_valid(7.0, uncertainty, (7 - reach, 7 + reach + off), 0.95) == valid


def test_validity_of_many_rows_and_of_other_coverage():
    """Each row is judged by itself, and the interval's own coverage sets how far the first-order interval reaches."""
    estimate, uncertainty = np.zeros(3), np.array([2.0, 2.0, 10.1])
    ends = np.array([3.92, 3.80, 17.0])
    assert first_order_valid(estimate, uncertainty, (-ends, ends), 0.95).tolist() == [True, False, False]
    assert first_order_valid(0.0, 1.0, (-2.575829, 2.575829), 0.99)
    assert not first_order_valid(0.0, 1.0, (-2.575829, 2.575829), 0.95)


def test_validity_without_scatter():
    """Where the first-order uncertainty is 0, only an interval that is a point next to the estimate is met."""
    assert first_order_valid(1e-3, 0.0, (1e-3, 1e-3), 0.95)
    assert not first_order_valid(1e-3, 0.0, (0.0, 1.0), 0.95)


def test_validity_is_decided_by_the_figures_in_arcmin():
    """A row whose ends miss by 1.0e-6′ with an uncertainty of 4.7e-5′ is not valid, though in radians it would be."""
    estimate, uncertainty, low = 0.1048719406, 4.7137e-5, 0.1047805663
    high = estimate + 1.959963985 * uncertainty
    assert not first_order_valid(estimate, uncertainty, (low, high), 0.95)
    radians = [math.radians(number / 60) for number in (estimate, uncertainty, low, high)]
    assert first_order_valid(*radians[:2], tuple(radians[2:]), 0.95)


@pytest.mark.parametrize(
    ("uncertainty", "half_unit"), [(0.0994, 0.0005), (0.09951, 0.005), (1e-3, 5e-5), (9.5e-7, 5e-9), (9.96e-7, 5e-8)]
)
def test_the_uncertainty_is_rounded_in_decimal_as_it_is_printed(uncertainty, half_unit):
    """The unit is that of the uncertainty printed to two digits, whatever its logarithm rounds to."""
    for part, valid in ((0.999, True), (1.001, False)):
        reach = 1.959963984540054 * uncertainty
        assert first_order_valid(0.0, uncertainty, (part * half_unit - reach, reach), 0.95) == valid


def test_first_order_sd_of_inputs_that_cancel_is_no_root_of_a_negative():
    """Inputs that follow one another and undo each other leave 0 up to rounding, never NaN."""
    for factor in np.linspace(0.1, 3.0, 40):
        found = first_order_sd(
            lambda a, b, factor=factor: factor * a - b / 3,
            {"a": 7.3, "b": 2.9},
            {"a": 3 / factor, "b": 9.0},
            [("a", "b", 1.0)],
        )
        assert 0 <= found < 1e-6
