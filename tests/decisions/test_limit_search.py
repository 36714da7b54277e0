"""What a search does where its prediction is wrong, or where there is nothing to predict."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from lever_terms import presents_of, terms_of

import flexlash
from flexlash.decisions.changes import Change
from flexlash.decisions.drawing_steps import on_drawing
from flexlash.decisions.known_tail import tail_of
from flexlash.decisions.limit_search import LimitSearch
from flexlash.decisions.nominal_levers import changed_alike
from flexlash.decisions.part_range import makes_a_part

DEVIATIONS = """\
tolerance_class,dimension,lower_deviation,upper_deviation,distribution
standard,wall_thickness,-0.01,0.01,normal
standard,junction_fillet_radius,-0.3,0.3,truncated normal
"""


@pytest.fixture
def searched(table, sound, tmp_path):
    """Return a function that looks for one dimension of a cup, whose tail is told too low and too steep."""

    def search(dimension, step, told=0.0, steeper=1.0, **row):
        tolerances = tmp_path / "tolerances.csv"
        tolerances.write_text(DEVIATIONS, encoding="utf-8")
        outcome = flexlash.run(table([sound | row]), tolerances=tolerances)
        presents, terms = presents_of(outcome), terms_of(outcome)
        alike = changed_alike(presents, Change(dimension=dimension), terms)
        tail = tail_of(presents, changed_alike(presents, Change(dimension="wall_thickness"), terms), terms.level)
        rounded = partial(_upwards_or_downwards, step=step)
        tail = tail._replace(score=tail.score - told, rise=tail.rise * steeper)
        return LimitSearch(alike, presents, terms, tail).solution(rounded)

    return search


def _upwards_or_downwards(value, upwards, *, step):
    return on_drawing(value, step, upwards=upwards)


@pytest.mark.slow
def test_a_prediction_that_points_the_wrong_way_costs_time_not_the_answer(searched):
    """A tail that is told by some standard deviations too low says that any value will do; the value is found."""
    row = {"rim_length_mm": 20.0, "rim_thickness_mm": 2.0, "backlash_limit_arcmin": 3.6}
    right, wrong = (searched("rim_thickness", 0.01, *tail, **row) for tail in ((0.0, 1.0), (50.0, 1e4)))
    assert right.value[0] > 0.002
    assert wrong.value[0] == pytest.approx(right.value[0], rel=1e-6)
    assert wrong.drawing[0] == right.drawing[0]
    assert wrong.over[0] == right.over[0] <= 0.00135


@pytest.mark.slow
def test_where_a_part_ends_is_no_value_that_meets_the_limit(searched):
    """A fillet that keeps the limit down to where its limits make no part has no value at which it misses it."""
    found = searched("junction_fillet_radius", 0.01, junction_fillet_radius_mm=2.5, backlash_limit_arcmin=5.0)
    assert np.isnan(found.value[0])
    assert np.isnan(found.drawing[0])


def test_what_is_no_number_makes_no_part():
    """A size that is no number makes no part, though no rule that compares it is broken."""
    sizes = {"cylinder_length": 0.16, "mean_radius": 0.08, "wall_thickness": 0.0016, "disk_inner_radius": 0.04}
    values = np.array([0.003, np.nan])
    rim = {name: np.array(size) for name, size in sizes.items()} | {
        "rim_length": np.array(0.02),
        "rim_thickness": values,
    }
    assert makes_a_part("cup", rim, {}).tolist() == [True, False]
