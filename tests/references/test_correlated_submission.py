"""The references of wall and disk that scatter together, through a submission with a sheet Correlations.

Source: as in `test_correlated_walls.py`, backlash 2U: sd in 1e-5 rad, percentiles in 1e-3 rad, each ± 3e-9 rad. A
submission's correlation is one of normal scores: 2 sin(π ρ/6) of Pearson's between the uniform values.
"""

import math
from functools import cache

import numpy as np
import pytest
from entry_books import CUP, UNIFORM_CUP, correlations, entry_book
from reference_inputs import CORRELATED_WALLS, REFERENCE_ERROR, SCATTER

from flexlash.mechanics.flexspline import backlash
from flexlash.pipeline import run
from flexlash.schema.units import ARCMIN

TIED = ("wall_thickness", "disk_thickness")
BLANK = CUP | {"variant": "one thickness", "disk_thickness_mm": None}


@pytest.fixture(scope="module")
def outcome_of(tmp_path_factory):
    """Return a function that gives the outcome for both parts, by Pearson's correlation of the values and method."""
    folder = tmp_path_factory.mktemp("correlated")

    @cache
    def of(correlation, method="line"):
        scores = min(2 * math.sin(math.pi * correlation / 6), 1.0)
        rows = correlations((*TIED, scores))
        path = entry_book(folder / "tied.xlsx", variants=[CUP, BLANK], tolerances=UNIFORM_CUP, correlations=rows)
        return run(path, method=method, seed=1)

    return of


@pytest.mark.slow
@pytest.mark.parametrize("method", ["line", "sobol", "random"])
@pytest.mark.parametrize("correlation", CORRELATED_WALLS)
def test_published_spread_through_a_submission(outcome_of, correlation, method):
    """sd, P97.5 and P99.865 are the references' within four of the told standard errors beside their own 3e-9 rad."""
    outcome = outcome_of(correlation, method)
    row = outcome.results.row(0, named=True)
    assert [found.code for found in outcome.findings if found.level != "info"] == []
    assert row["spread_method"] == method
    sd, p97_5, p99_865 = CORRELATED_WALLS[correlation]
    for name, value in (("sd", sd * 1e-5), ("p97_5", p97_5 * 1e-3), ("p99_865", p99_865 * 1e-3)):
        error = row[f"{name}_standard_error_arcmin"] * ARCMIN
        assert abs(row[f"{name}_arcmin"] * ARCMIN - value) <= 4 * math.hypot(error, REFERENCE_ERROR), name
        assert method != "line" or error < 1.3e-3 * sd * 1e-5


def test_a_shared_thickness_does_without_the_pair(outcome_of):
    """Where the disk takes the wall's thickness nothing is tied: the same bits for every correlation, and no finding.

    With a correlation of 1 the other part's spread comes to the same.
    """
    rows = {correlation: outcome_of(correlation).results for correlation in CORRELATED_WALLS}
    shared = [frame.row(1) for frame in rows.values()]
    assert all(row == shared[0] for row in shared)
    tied, one = (rows[1.0].row(place, named=True) for place in (0, 1))
    for name in ("mean", "sd", "p2_5", "p99_865"):
        error = math.hypot(*(row[f"{name}_standard_error_arcmin"] for row in (tied, one)))
        assert abs(tied[f"{name}_arcmin"] - one[f"{name}_arcmin"]) <= 4 * error, name
    assert tied["first_order_sd_arcmin"] == pytest.approx(one["first_order_sd_arcmin"], rel=1e-6)
    assert tied["worst_case_high_arcmin"] == pytest.approx(one["worst_case_high_arcmin"], rel=1e-12)


@pytest.mark.parametrize("correlation", CORRELATED_WALLS)
def test_first_order_follows_the_reference(outcome_of, correlation):
    """The first-order sd at mid-limits is the reference's sd within half a per cent, as the model is nearly linear."""
    row = outcome_of(correlation).results.row(0, named=True)
    assert row["first_order_sd_arcmin"] * ARCMIN == pytest.approx(CORRELATED_WALLS[correlation][0] * 1e-5, rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("correlation", [0.5, 1.0])
def test_lots_and_parts_of_tied_thicknesses(outcome_of, correlation):
    """Within and between lots are what the part as a product of its lot (E, ν) and its dimensions says.

    Y = g h: within² = E[g²] Var h and between² = Var g (E h)², each by draws of its own.
    """
    draws = np.random.default_rng(8).standard_normal((7, 1 << 19))
    scores = min(2 * math.sin(math.pi * correlation / 6), 1.0)
    draws[1] = scores * draws[0] + math.sqrt(1 - scores**2) * draws[1]
    of_part = (*TIED, "cylinder_length", "mean_radius", "disk_inner_radius")
    of_lot = ("youngs_modulus", "poisson_ratio")
    drawn = {
        name: SCATTER[name].location + SCATTER[name].scale * SCATTER[name].standard_at(score)
        for name, score in zip((*of_part, *of_lot), draws, strict=True)
    }
    middle = {"torque": 800.0} | {name: distribution.expectation for name, distribution in SCATTER.items()}
    centre, of_parts, of_lots = (
        backlash("cup", middle | {name: drawn[name] for name in group}) / ARCMIN for group in ((), of_part, of_lot)
    )
    factor = of_lots / centre
    row = outcome_of(correlation).results.row(0, named=True)
    for name, exact in (
        ("within_lot_sd", math.sqrt(np.mean(factor**2)) * of_parts.std()),
        ("between_lots_sd", factor.std() * of_parts.mean()),
    ):
        error = math.hypot(row[f"{name}_standard_error_arcmin"], 8e-4 * exact)
        assert abs(row[f"{name}_arcmin"] - exact) <= 4 * error, name
