"""The three slopes of whole drives: the published value, against numbers read off the table, what is not listed."""

import numpy as np
import pytest

from flexlash.mechanics.catalogue_curve import catalogue_curve
from flexlash.schema import tables

_RADIUS_PER_SIZE = 2.54e-3 / 2


def test_a_drive_of_size_32_and_ratio_100():
    """At 60 N·m it turns 29/67000 + 31/110000 rad, at 200 N·m by the third slope's part more."""
    curve = catalogue_curve(32 * _RADIUS_PER_SIZE, 100)
    assert curve.angle(60.0) == pytest.approx(7.1465e-4, abs=5e-9)
    assert curve.angle(20.0) == pytest.approx(20 / 67e3, rel=1e-12)
    assert curve.angle(200.0) == pytest.approx(29 / 67e3 + 79 / 110e3 + 92 / 120e3, rel=1e-12)


def test_every_listed_drive_by_summing_slopes():
    """Every drive of the table turns as its stiffness integrated over the torque says, step by step."""
    for row in tables.rows("catalogue_stiffness"):
        curve = catalogue_curve(int(row["size"]) * _RADIUS_PER_SIZE, float(row["ratio_from"]))
        most = 1.5 * float(row["T2_Nm"]) if row["K3_Nm_per_rad"] else float(row["T2_Nm"])
        torque = (np.arange(20_000) + 0.5) * most / 20_000
        slopes = [float(row[f"K{number}_Nm_per_rad"] or "nan") for number in (1, 2, 3)]
        place = (torque > float(row["T1_Nm"])).astype(int) + (torque > float(row["T2_Nm"]))
        summed = (most / 20_000 / np.array(slopes)[place]).sum()
        assert curve.angle(most) == pytest.approx(summed, rel=1e-4), row


def test_the_ratio_chooses_among_those_listed():
    """The greatest listed ratio up to the drive's is taken, the least where the drive's is less, or not known."""
    ratios = [catalogue_curve(0.0406, ratio).ratio_from for ratio in (None, 5, 30, 49.9, 50, 80, 320)]
    assert ratios == [30, 30, 30, 30, 50, 80, 80]


def test_a_drive_without_its_ratio_is_the_least_stiff():
    """Along the ratios of a size no slope gets less stiff, so that the first is the least in all of them."""
    for size in {int(row["size"]) for row in tables.rows("catalogue_stiffness")}:
        least = catalogue_curve(size * _RADIUS_PER_SIZE)
        for row in (row for row in tables.rows("catalogue_stiffness") if int(row["size"]) == size):
            listed = [float(row[f"K{number}_Nm_per_rad"] or "inf") for number in (1, 2, 3)]
            assert all(a <= b for a, b in zip(least[4:], listed, strict=True) if a is not None)


def test_what_the_catalogue_does_not_list():
    """Beyond its sizes there is no curve, and beyond T2 none where the third slope is blank."""
    assert catalogue_curve(0.0127) is None
    assert catalogue_curve(0.2) is None
    hundred = catalogue_curve(100 * _RADIUS_PER_SIZE)
    assert (hundred.angle(3040.0), hundred.angle(3041.0)) == (pytest.approx(843 / 1.62e6 + 2197 / 2.22e6), None)
