"""What a first-order sd is made of: slopes by calculus, and the sum that they add up to."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from toleranced import plan

from flexlash.schema.variant import Limits
from flexlash.tolerance.row_batches import RowBatch, TolerancedRow, batch_statistics
from flexlash.tolerance.sensitivity import first_order_slopes

LIMITS = {
    "a": Limits(low=1.0, high=1.6),
    "b": Limits(low=-0.3, high=0.1, distribution="uniform"),
    "c": Limits(low=2.0, high=2.0),
    "d": Limits(low=4.9, high=5.1, sd=0.05, mean_shift=0.02),
}


def _model(sizes):
    return np.asarray(sizes["a"] ** 2 + 3 * sizes["b"] + sizes["c"] * sizes["d"])


def _row(**more):
    return TolerancedRow(model=_model, nominal={"a": 1.2, "b": 0.0, "c": 1.9, "d": 5.0}, limits=LIMITS, **more)


def test_slopes_are_those_at_mid_limits():
    """Slopes are calculus's in the middle of the limits, whatever the process; what does not scatter has none."""
    (found,) = RowBatch([_row()]).first_order()
    assert found.slopes == pytest.approx({"a": 2.6, "b": 3.0, "d": 2.0}, rel=1e-9)
    assert found.ties == ()


@pytest.mark.parametrize("ties", [(), (("a", "b", 0.6), ("a", "d", -0.3))])
def test_they_add_up_to_the_first_order_sd(ties):
    """Slope times sd, squared and summed, and twice the correlated products make the square of the first-order sd."""
    row, sampling = _row(correlation=ties), replace(plan("random", 64, 0), inputs=tuple(LIMITS))
    (found,), (told,) = RowBatch([row]).first_order(), batch_statistics([row], sampling)
    sds = {"a": 0.1, "b": 0.4 / math.sqrt(12), "d": 0.05}
    parts = {name: slope * sds[name] for name, slope in found.slopes.items()}
    total = sum(part * part for part in parts.values())
    total += sum(2 * value * parts[first] * parts[second] for first, second, value in found.ties)
    assert len(found.ties) == len(ties)
    assert told.numbers["first_order_sd"] == pytest.approx(math.sqrt(total), rel=1e-12)
    if ties:
        # A normal and a uniform that are tied by their scores: r = √(3/π)·ρ, by Stein's lemma.
        assert found.ties[0][2] == pytest.approx(0.6 * math.sqrt(3 / math.pi), rel=1e-9)


def test_rows_alike_keep_their_own():
    """Rows in one batch have the slopes that each has alone."""
    other = TolerancedRow(
        model=_model,
        nominal={"a": 1.2, "b": 0.0, "c": 1.9, "d": 5.0},
        limits={**LIMITS, "a": Limits(low=2.0, high=3.0)},
    )
    both = RowBatch([_row(), other]).first_order()
    assert both == [RowBatch([_row()]).first_order()[0], RowBatch([other]).first_order()[0]]
    assert both[1].slopes["a"] == pytest.approx(5.0, rel=1e-9)


def test_the_step_is_a_thousandth_of_the_standard_deviation():
    """Of x³ at 0 a central difference with the step h is h², which tells its step; it has a least one."""
    assert first_order_slopes(lambda a: a**3, {"a": 0.0}, {"a": 2.0})["a"] == pytest.approx(4e-6, rel=1e-9)
    cubic = first_order_slopes(lambda a: (a - 5.0) ** 3, {"a": 5.0}, {"a": 1e-9})["a"]
    assert cubic == pytest.approx((5.0 * 1e-6) ** 2, rel=1e-6)
