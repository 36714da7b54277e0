"""The variance within and between lots by lots that are crossed with parts."""

import numpy as np
import pytest
from line_models import row_model

from flexlash.tolerance import Normal, Uniform
from flexlash.tolerance.engine.line_direction import Inputs
from flexlash.tolerance.engine.lot_inputs import LotsAndParts
from flexlash.tolerance.engine.lot_variance import PointSet, crossed_variance, split_of, variance_split


def lots_and_parts(function, inputs, between):
    """Return the lots and parts of a single row."""
    return LotsAndParts(row_model(function), Inputs.of([inputs]), between)


def test_few_parts_leave_no_bias():
    """With two parts in each set the sd within and between lots are right in the mean over many draws."""
    split = lots_and_parts(lambda a, b: a + b, {"a": Normal(0, 1), "b": Normal(0, 1)}, {"a"})
    generator = np.random.default_rng(0)
    found = []
    for _ in range(400):
        lots, *parts = (
            PointSet(values={name: generator.standard_normal((1, 8, count))}, weights=np.full((8, count), 1 / count))
            for name, count in (("a", 32), ("b", 2), ("b", 2))
        )
        divided = crossed_variance(split, lots, parts)
        found.append((divided.within[0] ** 2, divided.between[0] ** 2))
    # Either is half of the whole; without the second set within² would be a third of it.
    assert np.mean(found, axis=0) == pytest.approx([0.5, 0.5], abs=0.03)


def test_lines_are_exact_for_linear_models():
    """What is linear in the scores is divided to a millionth by one line a replicate, steps of no width aside."""
    split = lots_and_parts(
        lambda a, b, c: 3 * a - 2 * b + 6 * c, {name: Normal(1, 1) for name in ("a", "b", "c")}, {"a", "c"}
    )
    divided = variance_split(split, 0, 8)
    assert divided.within[0] == pytest.approx(2 / 7, rel=2e-6)
    assert divided.between[0] == pytest.approx(np.sqrt(45) / 7, rel=2e-6)


@pytest.mark.slow
def test_told_errors_hold_the_truth():
    """± 1.96 of the told errors hold how weighed normal parts divide, in at least 115 of 128 seeds."""
    weight, part = Uniform(0.2, 2), Normal(1, 1)
    split = lots_and_parts(
        lambda a, b, c, d: a * b + c * d, {"a": weight, "b": part, "c": weight, "d": part}, {"a", "c"}
    )
    within, between = 2 * (1.1**2 + 1.8**2 / 12), 2 * 1.8**2 / 12
    exact = np.sqrt(np.array([within, between]) / (within + between))
    held = np.zeros(2)
    for seed in range(128):
        divided = variance_split(split, seed, 64)
        found = np.array([divided.within[0], divided.between[0]])
        held += np.abs(found - exact) <= 1.96 * np.array([divided.within_error[0], divided.between_error[0]])
    assert held.min() >= 115


def test_a_group_without_a_gradient_is_divided_too():
    """Even functions have no steepest direction, and yet their lots and parts are told apart."""
    split = lots_and_parts(
        lambda a, b, c: a * a + 2 * b * b * c * c, {"a": Normal(0, 1), "b": Uniform(-1, 1), "c": Normal(0, 1)}, {"a"}
    )
    divided = variance_split(split, 0, 64)
    # Var(2 b² c²) = 4 (E b⁴ E c⁴ − (E b² E c²)²) = 4 (3/5 − 1/9).
    within = np.sqrt(4 * (3 / 5 - 1 / 9))
    assert divided.between[0] == pytest.approx(np.sqrt(2) / np.hypot(within, np.sqrt(2)), rel=0.03)


def test_parts_of_the_whole_have_errors_that_stay_finite():
    """Where nothing varies both parts are 0; where one kind does all, the other's error is the root of the whole's."""
    divided = split_of(*(np.array(each) for each in ([0.0, 4.0], [0.0, 0.0], [0.0, 0.04], [0.0, 0.01])))
    assert divided.within.tolist() == [0.0, 1.0]
    assert divided.between.tolist() == [0.0, 0.0]
    assert divided.between_error[1] == pytest.approx(np.sqrt(0.01 / 4))
    assert np.isfinite(divided.within_error).all()
