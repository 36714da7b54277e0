"""Axes end at round numbers around their data."""

from __future__ import annotations

import pytest

from flexlash.report.layout.axes import Axis, axis_over

CASES = {
    "near the data": ([3.63, 3.80], (3.6, 3.85, 0.05)),
    "from zero where that does not squeeze": ([0.2, 1.9], (0.0, 2.0, 0.5)),
    "both signs": ([-0.09, 0.1], (-0.1, 0.15, 0.05)),
    "a single value": ([2.0], (1.95, 2.05, 0.05)),
    "a single zero": ([0.0, 0.0], (0.0, 0.2, 0.2)),
    "small numbers": ([0.00012, 0.00047], (0.0001, 0.0005, 0.0001)),
    "large numbers": ([61.0, 118.0], (60.0, 120.0, 10.0)),
}


@pytest.mark.parametrize("name", CASES)
def test_ends_and_step_are_round_and_hold_the_data(name):
    """Ends are multiples of a step of 1, 2 or 5, and no value lies outside."""
    values, (low, high, step) = CASES[name]
    assert axis_over(values) == Axis(low=low, high=high, step=step)
    assert low <= min(values)
    assert high >= max(values)


@pytest.mark.parametrize(
    ("step", "per_cent", "number"),
    [(0.05, False, "0.00"), (0.5, False, "0.0"), (2.0, False, "0"), (0.1, True, "0%"), (0.005, True, "0.0%")],
)
def test_labels_have_the_decimals_of_the_step(step, per_cent, number):
    """Labels of an axis show its step and no digit more."""
    options = Axis(low=0.0, high=1.0, step=step).options(per_cent=per_cent)
    assert options["num_format"] == number
    assert (options["min"], options["max"], options["major_unit"]) == (0.0, 1.0, step)
