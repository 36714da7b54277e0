"""What would bring a failing variant within its limit agrees with computing the changed submission."""

from __future__ import annotations

import pytest

from flexlash.analysis.recommendations import recommendations_of
from flexlash.pipeline import run

TOLERANCES = {"wall_thickness": 0.05, "disk_inner_radius": 0.3, "youngs_modulus": 3.0, "poisson_ratio": 0.01}
"""Deviations to both sides in the dimensions' own units."""


@pytest.fixture
def deviations(tmp_path):
    """Return a function that writes symmetric tolerances as a file, some of them halved, and gives its path."""

    def write(halved=()):
        lines = ["tolerance_class,dimension,lower_deviation,upper_deviation"]
        for name, deviation in TOLERANCES.items():
            size = deviation / 2 if name in halved else deviation
            lines.append(f"standard,{name},{-size},{size}")
        path = tmp_path / f"tolerances-{len(halved)}.csv"
        path.write_text("\n".join(lines), encoding="utf-8")
        return path

    return write


def _recommendations(outcome):
    return recommendations_of(outcome.computed, outcome.settings)


def _only(outcome):
    (recommendation,) = _recommendations(outcome)
    return recommendation


@pytest.mark.slow
@pytest.mark.parametrize("place", [0, 1], ids=["main contributor", "all"])
@pytest.mark.parametrize("limit", [3.75, 3.8], ids=["red", "amber"])
def test_half_a_tolerance_does_what_a_run_with_it_says(table, sound, deviations, place, limit):
    """The share over the limit that a halving promises is that of a run whose tolerances are halved."""
    rows = table([{**sound, "backlash_limit_arcmin": limit}])
    halving = _only(run(rows, tolerances=deviations())).halvings[place]
    assert list(halving.limits) == (["wall_thickness"] if place == 0 else list(halving.limits))
    assert len(halving.limits) == (1, 4)[place]
    again = run(rows, tolerances=deviations(halving.limits)).results.row(0, named=True)
    for key, value in halving.over.items():
        assert value == pytest.approx(again[key], rel=1e-9)
    assert again["probability_over_limit"] > 1e-9


def test_the_main_contributor_and_the_main_drawing_dimension_are_halved(table, sound):
    """Where a material constant scatters most, the dimension of the drawing that scatters most is halved as well."""
    outcome = run(table([sound]))
    first, second, every = _only(outcome).halvings
    shares = next(iter(outcome.computed.values())).spread.shares
    assert list(first.limits) == ["youngs_modulus"] == [max(shares, key=shares.get)]
    assert list(second.limits) == ["wall_thickness"]
    assert set(every.limits) == set(shares)


@pytest.mark.slow
def test_a_halved_tolerance_keeps_its_middle(table, sound, tmp_path):
    """A tolerance to one side is halved about its own middle, not about the entered value."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,wall_thickness,0,0.04\n", encoding="utf-8"
    )
    outcome = run(table([{**sound, "backlash_limit_arcmin": 3.65}]), tolerances=tolerances)
    limits = _only(outcome).halvings[0].limits["wall_thickness"]
    assert (limits.low, limits.high) == pytest.approx((1.61e-3, 1.63e-3), rel=1e-12)


@pytest.mark.parametrize("kind", ["mean_radius_mm", "bore_diameter_mm"])
def test_the_wall_that_is_wanted_keeps_the_limit(table, sound, kind):
    """A run with the thicker wall has its P97.5 at the limit, to the part of a per cent that "about" leaves."""
    row = {**sound, "mean_radius_mm": "", kind: 80.0 if kind == "mean_radius_mm" else 158.4}
    row["backlash_limit_arcmin"] = 3.0
    found = _only(run(table([row]))).thickening
    assert found.present == pytest.approx(1.6e-3)
    again = run(table([{**row, "wall_thickness_mm": 1000 * found.wanted}])).results.row(0, named=True)
    assert again["p97_5_arcmin"] == pytest.approx(3.0, rel=5e-3)


@pytest.mark.parametrize(
    ("changes", "thickest"),
    [({"backlash_limit_arcmin": 1.0}, 3.2e-3), ({"rim_length_mm": 20, "rim_thickness_mm": 1.7}, 1.7e-3)],
    ids=["twice the wall", "no thicker than the rim"],
)
def test_a_wall_is_not_wanted_thicker_than_makes_sense(table, sound, changes, thickest):
    """Where neither twice the wall nor a wall as thick as the rim is enough, no wall is named."""
    found = _only(run(table([{**sound, "backlash_limit_arcmin": 3.0, **changes}]))).thickening
    assert found.wanted is None
    assert found.thickest == pytest.approx(thickest)


def test_no_wall_is_looked_for_where_p97_5_is_within(table, sound):
    """An amber variant keeps 97.5 % of its units within the limit already."""
    assert _only(run(table([{**sound, "backlash_limit_arcmin": 3.77}]))).thickening is None


def test_levers_of_a_plain_tube(table, sound):
    """A tube's backlash follows length, wall and mean radius with the powers 1, −1 and −3."""
    row = {**sound, "flexspline_type": "cylinder", "disk_inner_radius_mm": "", "backlash_limit_arcmin": 1.5}
    levers = {lever.dimension: lever.slope for lever in _only(run(table([row]))).levers}
    assert list(levers) == ["mean_radius", "cylinder_length", "wall_thickness"]
    assert levers == pytest.approx({"mean_radius": -3, "cylinder_length": 1, "wall_thickness": -1}, rel=1e-6)


CHOICES = {
    "no limit": ([""], []),
    "green": ([5.0], []),
    "one fails": ([3.72, 5.0, ""], [("v0", True)]),
    "median over": ([3.5, 5.0], [("v0", False)]),
    "median over and one that can be helped": ([3.74, 3.5, 3.6, 3.72], [("v1", False), ("v3", True)]),
}


@pytest.mark.parametrize("case", CHOICES)
def test_the_worst_and_the_worst_that_can_be_helped_get_a_recommendation(table, sound, case):
    """The worst failing variant gets a recommendation; where its median is over the limit, the worst other one, too."""
    limits, expected = CHOICES[case]
    rows = [{**sound, "variant": f"v{place}", "backlash_limit_arcmin": limit} for place, limit in enumerate(limits)]
    found = [
        (recommendation.variant, bool(recommendation.halvings)) for recommendation in _recommendations(run(table(rows)))
    ]
    assert found == expected


def test_what_does_not_scatter_cannot_be_tightened(table, sound, tmp_path):
    """An exact variant over its limit has levers and a wall, but no tolerance to halve."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\nstandard,rim_length,-1,1\n", encoding="utf-8"
    )
    recommendation = _only(run(table([{**sound, "backlash_limit_arcmin": 3.6}]), tolerances=tolerances))
    assert recommendation.halvings == ()
    assert recommendation.levers
    assert recommendation.thickening.wanted > 1.6e-3
