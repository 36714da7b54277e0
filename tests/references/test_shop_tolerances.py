"""What a shop knows of its process, through whole submissions of B3-160 (case 1): worked by hand, or by two ways.

The wall is drawn 1.6 ± 0.02 mm; the process has the mean 1.607 and s 0.0041 mm. The backlash is 3.686999′ · 1.6/wall:
5.899198 mm·′ over the wall.
"""

from __future__ import annotations

from statistics import NormalDist

import numpy as np
import pytest
from filled import SOUND

from flexlash.pipeline import run

BACKLASH_TIMES_WALL = 3.686998640539453 * 1.6
"""Of the closed form at 800 N·m, l 160, r_m 80, r_ci 40 mm, E 211 GPa, ν 0.3 [mm·arcmin]."""

MEAN, SD, PARTS = 1.607, 0.0041, 60
DRAWN = {"dimension": "wall_thickness", "lower_deviation": -0.02, "upper_deviation": 0.02}
SPREAD = ("mean_arcmin", "sd_arcmin", "p0_135_arcmin", "p50_arcmin", "p99_865_arcmin", "probability_over_limit")
E_AND_NU = (
    {"dimension": "youngs_modulus", "lower_deviation": -2.0, "upper_deviation": 2.0, "deviation_unit": "%"},
    {"dimension": "poisson_ratio", "lower_deviation": -0.01, "upper_deviation": 0.01, "distribution": "uniform"},
)


def parts(mean, sd):
    """Return measured sizes of exactly this mean and standard deviation, with a normal's spacing."""
    scores = np.array([NormalDist().inv_cdf((place + 0.5) / PARTS) for place in range(PARTS)])
    return [float(size) for size in mean + sd * scores / scores.std(ddof=1)]


@pytest.fixture
def results(workbook):
    """Return a function that runs classes, each given by name as its rows, for case 1, and gives Results by class."""

    def computed(classes, **filling):
        rows = [SOUND | {"variant": name, "tolerance_class": name, "backlash_limit_arcmin": 3.8} for name in classes]
        tolerances = [{"tolerance_class": name, **row} for name, own in classes.items() for row in own]
        outcome = run(workbook(rows, tolerances=tolerances, **filling))
        assert [one for one in outcome.findings if one.level == "error"] == []
        return {row["variant"]: row for row in outcome.results.iter_rows(named=True)}

    return computed


def spread_of(row):
    """Return the numbers of a row's spread."""
    return [row[key] for key in SPREAD]


def test_a_process_with_mean_and_sd(results):
    """The wall's mean and sd give the backlash's: 5.899/1.607 with the sd's share of curvature, and the tail."""
    row = results({"shop": [DRAWN | {"mean_shift": 0.007, "standard_deviation": 0.0041}]})["shop"]
    assert row["p50_arcmin"] == pytest.approx(BACKLASH_TIMES_WALL / MEAN, abs=1e-5)
    assert round(row["p50_arcmin"], 4) == 3.6709
    assert row["mean_arcmin"] == pytest.approx(BACKLASH_TIMES_WALL / MEAN * (1 + (SD / MEAN) ** 2), abs=1e-5)
    assert row["sd_arcmin"] == pytest.approx(BACKLASH_TIMES_WALL / MEAN**2 * SD, rel=2e-4)
    assert row["p99_865_arcmin"] == pytest.approx(BACKLASH_TIMES_WALL / (MEAN - 2.9999770 * SD), abs=1e-5)
    assert row["worst_case_low_arcmin"] == pytest.approx(BACKLASH_TIMES_WALL / 1.62, rel=1e-12)
    assert row["worst_case_high_arcmin"] == pytest.approx(BACKLASH_TIMES_WALL / 1.58, rel=1e-12)


def test_a_capability_is_the_process_it_stands_for(results):
    """Cp 1.1 centred is k = 3.3; Cpk moves the mean to the thin side, which raises the backlash, or as it is told."""
    cp = 0.04 / (6 * SD)
    rows = results(
        {
            "capable": [DRAWN | {"cp": 1.1}],
            "sigma": [DRAWN | {"limits_sigma": 3.3}],
            "harmed": [DRAWN | {"cp": cp, "cpk": cp - 0.007 / (3 * SD)}],
            "thin": [DRAWN | {"mean_shift": -0.007, "standard_deviation": SD}],
            "told": [DRAWN | {"cp": cp, "cpk": cp - 0.007 / (3 * SD), "mean_shift": 0.007}],
            "thick": [DRAWN | {"mean_shift": 0.007, "standard_deviation": SD}],
        }
    )
    for capability, process in (("capable", "sigma"), ("harmed", "thin"), ("told", "thick")):
        assert spread_of(rows[capability]) == pytest.approx(spread_of(rows[process]), rel=1e-9), capability


@pytest.mark.parametrize("use_as", ["value", "deviation"])
def test_measured_parts_are_the_process_they_show(results, use_as):
    """Sixty parts of that mean and s give the numbers of the process entered by hand, and a far wider interval."""
    nominal = 1.6 if use_as == "deviation" else 0.0
    measured = [
        {"sample": "lathe 3", "part": f"{place}", "use_as": use_as, "wall_thickness_mm": size - nominal}
        for place, size in enumerate(parts(MEAN, SD), start=1)
    ]
    by_hand = DRAWN | {"mean_shift": 0.007, "standard_deviation": SD}
    rows = results({"measured": [DRAWN | {"sample": "lathe 3"}], "by hand": [by_hand]}, measurements=measured)
    assert spread_of(rows["measured"]) == pytest.approx(spread_of(rows["by hand"]), rel=1e-9)
    row = rows["measured"]
    assert rows["by hand"]["p99_865_sample_low_arcmin"] is None
    assert row["p99_865_sample_low_arcmin"] < row["p99_865_arcmin"] < row["p99_865_sample_high_arcmin"]
    assert row["p99_865_sample_high_arcmin"] - row["p99_865_sample_low_arcmin"] > 0.5 * row["sd_arcmin"]


def test_classes_inherit(results):
    """A class takes over what it does not hold itself: the wall of its own, the rest of the other class, to the bit.

    The share over 3.8′ is that of 80 · 120 Gauss points over ν and the wall, with the exact tail of E at each.
    """
    wall = DRAWN | {"lower_deviation": -0.0125, "upper_deviation": 0.0125}
    rows = results(
        {
            "full": [wall, *E_AND_NU],
            "shop": [{"based_on": "full"}, wall],
            "bare": [{"based_on": "FULL "}],
            "own": [{"based_on": "standard"}, wall],
        }
    )
    assert round(rows["shop"]["p99_865_arcmin"], 3) == 3.780
    assert rows["shop"]["ppm_over_limit"] == pytest.approx(118.8602820, rel=1e-6)
    for name in ("shop", "bare"):
        assert spread_of(rows[name]) == spread_of(rows["full"]), name
    assert spread_of(rows["own"]) != spread_of(rows["full"])


def test_lots_alone_and_parts_alone(results):
    """What a lot shares alone leaves nothing within it; without it lots do not differ; each lot then fails or not."""
    wall = DRAWN | {"lower_deviation": -0.0125, "upper_deviation": 0.0125}
    rows = results({"modulus": [E_AND_NU[0]], "wall": [wall], "told": [wall | {"scatters_between": "lots"}]})
    assert rows["modulus"]["within_lot_sd_arcmin"] == 0.0
    assert rows["modulus"]["between_lots_sd_arcmin"] == pytest.approx(rows["modulus"]["sd_arcmin"], rel=1e-12)
    assert rows["modulus"]["lots_failing"] == rows["modulus"]["probability_over_limit"] > 0
    assert rows["wall"]["between_lots_sd_arcmin"] == 0.0
    assert rows["wall"]["within_lot_sd_arcmin"] == pytest.approx(rows["wall"]["sd_arcmin"], rel=1e-12)
    assert rows["wall"]["lots_failing"] == 0.0
    assert rows["told"]["within_lot_sd_arcmin"] == 0.0
    assert spread_of(rows["told"]) == spread_of(rows["wall"])
