"""The direction of lines: the direction in which the output rises fastest, and scores in the plane across it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from line_models import MIXED, NORMALS, curved, linear, row_model

from flexlash.tolerance import Normal, Triangular, TruncatedNormal, Uniform
from flexlash.tolerance.engine.line_direction import Inputs, LineDirection, direction_of, scores_across
from flexlash.tolerance.engine.line_points import line_net

thorough = settings(deadline=None, max_examples=40, derandomize=True)


def direction_from(*directions):
    """Return a direction of these unit directions, inputs in their own order."""
    direction = np.array(directions, dtype=float).T
    direction = direction / np.linalg.norm(direction, axis=0)
    order = np.repeat(np.arange(len(direction))[:, None], direction.shape[1], axis=1)
    return LineDirection(vector=direction, order=order)


def test_inputs_hold_location_and_scale_per_row():
    """Inputs of rows alike keep names and shapes once, locations and scales for each row."""
    rows = [MIXED, {"a": Normal(5, 1), "b": Uniform(1, 2), "c": Triangular(0, 8)}]
    inputs = Inputs.of(rows)
    assert inputs.names == ("a", "b", "c")
    assert inputs.count == 2
    assert inputs.location.tolist() == [[1, 5], [0, 1], [-1, 0]]
    assert inputs.scale.tolist() == [[2, 1], [4, 1], [2, 8]]
    assert inputs.take(np.array([1])).location.tolist() == [[5], [1], [0]]
    assert inputs.take(np.array([1, 0])).scale.tolist() == [[1, 2], [1, 4], [8, 2]]


@pytest.mark.parametrize(
    ("row", "bent"),
    [
        (NORMALS, False),
        (MIXED, False),
        ({"a": Normal(0, 1), "b": Uniform(0, 1)}, True),
        ({"a": Normal(0, 1), "b": TruncatedNormal(0, 1, -3, 3)}, True),
        ({"b": Uniform(0, 1)}, True),
        ({"b": Uniform(0, 1), "c": Uniform(0, 1)}, False),
    ],
)
def test_single_curved_input_is_told(row, bent):
    """Inputs tell whether exactly one of them is not normal."""
    assert Inputs.of([row]).single_curved is bent


def test_direction_of_a_linear_model_is_its_gradient():
    """Of normals in a linear model the direction is the unit vector of slope times sd, with its signs."""
    rows = [NORMALS, {"a": Normal(0, 1), "b": Normal(0, 4), "c": Normal(9, 6)}]
    direction = direction_of(row_model(linear), Inputs.of(rows))
    wanted = np.array([[2 * 2, -3 * 0.5, 0.5], [2 * 1, -3 * 4, 0.5 * 6]]).T
    assert direction.vector == pytest.approx(wanted / np.linalg.norm(wanted, axis=0), rel=1e-12)


@thorough
@given(weights=st.lists(st.floats(-5, 5), min_size=3, max_size=3).filter(lambda one: max(map(abs, one)) > 1e-6))
def test_direction_is_a_unit_vector_with_the_signs_of_the_slopes(weights):
    """Whatever the distributions, the direction is of unit length and points where the output rises."""
    one, two, three = weights
    direction = direction_of(row_model(lambda a, b, c: one * a + two * b + three * c), Inputs.of([MIXED]))
    assert np.linalg.norm(direction.vector) == pytest.approx(1, rel=1e-12)
    signs = np.sign(direction.vector[:, 0])
    steady = np.abs(weights) > 1e-6 * np.max(np.abs(weights))
    assert np.array_equal(signs[steady], np.sign(weights)[steady])


def test_direction_of_each_row_is_its_own():
    """The direction of a row does not depend on the rows beside it, bit for bit."""
    rows = [MIXED, {"a": Normal(5, 1), "b": Uniform(1, 2), "c": Triangular(0, 8)}]
    together = direction_of(row_model(curved), Inputs.of(rows))
    for place, row in enumerate(rows):
        alone = direction_of(row_model(curved), Inputs.of([row]))
        assert np.array_equal(together.vector[:, [place]], alone.vector)
        assert np.array_equal(together.order[:, [place]], alone.order)
        taken = together.take(np.array([place]))
        assert np.array_equal(taken.vector, alone.vector)
        assert np.array_equal(taken.order, alone.order)


def test_direction_is_0_where_the_output_does_not_change():
    """A constant output has no direction, also where a large constant leaves nothing but rounding."""
    for function in (lambda a, b, c: 0 * (a + b + c) + 7.0, lambda a, b, c: 1e17 + 0.01 * (a + b + c)):
        assert (direction_of(row_model(function), Inputs.of([MIXED])).vector == 0).all()


def test_most_curved_input_meets_the_net_first():
    """Inputs meet the net from the most curved on, and one in which the output is straight closes the plane."""
    row = {name: Normal(0, 1) for name in "abcd"}
    direction = direction_of(
        row_model(lambda a, b, c, d: d + c + 0.2 * b**2 + b + 0.05 * a**3 + 2 * a), Inputs.of([row])
    )
    assert direction.order[:2, 0].tolist() in ([0, 1], [1, 0])
    assert sorted(direction.order[:, 0].tolist()) == [0, 1, 2, 3]
    assert direction.order[-1, 0] in (2, 3)


@thorough
@given(st.lists(st.floats(-1, 1), min_size=2, max_size=6).filter(lambda one: max(map(abs, one)) > 0.1))
def test_scores_across_lie_in_the_plane(weights):
    """Scores across a direction are perpendicular to it, whatever the direction."""
    # The largest weight closes the plane, as a direction sees to.
    direction = direction_from(sorted(weights, key=abs))
    scores = scores_across(direction, line_net(0, len(weights) - 1, 64, single_curved=False).scores)
    assert scores.shape == (len(weights), 1, 64)
    assert np.abs((direction.vector[:, :, None] * scores).sum(axis=0)).max() <= 1e-12 * np.abs(scores).max()


@pytest.mark.parametrize(
    "directions",
    [
        [[1.0, 2.0, -3.0]],
        [[0.6, 0.8]],
        [[0.0, 0.0, 1.0], [0.5, -0.5, 0.5]],
        [[0.0, 1.0, 0.0, 2.0], [1.0, 1.0, 1.0, 1.0], [3.0, 0.1, 0.0, -0.5]],
    ],
)
def test_scores_across_have_the_covariance_of_the_plane(directions):
    """Standard normal coordinates become scores of covariance 1 − ααᵀ, exactly."""
    direction = direction_from(*directions)
    width = len(directions[0]) - 1
    # Coordinates ±√width on one axis at a time have the mean 0 and exactly the unit covariance.
    net = np.concatenate([np.eye(width), -np.eye(width)], axis=1) * np.sqrt(width)
    scores = scores_across(direction, net)
    for row in range(len(directions)):
        vector = direction.vector[:, row]
        covariance = scores[:, row] @ scores[:, row].T / (2 * width)
        assert covariance == pytest.approx(np.eye(width + 1) - np.outer(vector, vector), abs=1e-14)
        assert vector @ scores[:, row] == pytest.approx(np.zeros(2 * width), abs=1e-14)


def test_scores_across_do_not_depend_on_the_order_of_inputs_in_law():
    """Another order gives other scores, each with the same covariance and in the same plane."""
    direction = direction_from([1.0, 2.0, -3.0])
    turned = LineDirection(vector=direction.vector, order=direction.order[[1, 0, 2]])
    net = np.concatenate([np.eye(2), -np.eye(2)], axis=1) * np.sqrt(2)
    first, second = scores_across(direction, net)[:, 0], scores_across(turned, net)[:, 0]
    assert not np.allclose(first, second)
    assert first @ first.T == pytest.approx(second @ second.T, abs=1e-14)


def test_a_single_input_has_one_line():
    """The plane across a single input is its one point 0, for every line."""
    scores = scores_across(direction_from([-2.0]), np.empty((0, 8)))
    assert np.array_equal(scores, np.zeros((1, 1, 8)))
