"""The share over the limit by mean and standard deviation alone is that of a normal distribution."""

from __future__ import annotations

import statistics

import pytest

from flexlash.report.wording.normal_theory import normal_share, normal_words

ROW = {"backlash_limit_arcmin": 3.8, "mean_arcmin": 3.687, "sd_arcmin": 0.0297}


def test_the_share_is_that_of_a_normal_distribution():
    """Python's own normal distribution has the same share above the limit; without limit or scatter there is none."""
    expected = 1 - statistics.NormalDist(ROW["mean_arcmin"], ROW["sd_arcmin"]).cdf(ROW["backlash_limit_arcmin"])
    assert normal_share(ROW) == pytest.approx(expected, rel=1e-9)
    assert normal_words(ROW) == f"{1e6 * expected:.3g} ppm"
    assert normal_share({**ROW, "backlash_limit_arcmin": None}) is None
    assert normal_words({**ROW, "sd_arcmin": 0.0}) == "–"
