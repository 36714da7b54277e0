"""Changes in words, and the order in which they are read."""

from __future__ import annotations

import pytest
from told_levers import CASE_1, CASE_3, lever, levers_table, study_levers

from flexlash.report.wording.lever_words import change_words, lever_name, shown_levers, shown_value, within_words


def test_failing_variants_come_first_and_their_cheapest_change_before_all():
    """Of the study: the six changes by rank, what cannot do it, then what the sound variant leaves open."""
    rows = shown_levers(study_levers()).to_dicts()
    assert [row["variant"] for row in rows] == [CASE_3] * 8 + [CASE_1] * 2
    assert [row["rank"] for row in rows[:6]] == [1, 2, 3, 4, 5, 6]
    assert [row["possible"] for row in rows[6:8]] == ["no", "no"]
    assert [row["what"] for row in rows[8:]] == ["tolerance", "nominal"]


def test_what_is_out_of_range_follows_what_is_in_it():
    """A change that leaves the range stands behind the most expensive one within it, before what cannot do it."""
    rows = [
        lever("rim_length", "", (20, None or 0, 0, 0, 0, 0, 0, 0, 0), possible="no", rank=None, relative_cost=None),
        lever("mean_radius", "", (80, 99, 99, 100, 0, 86, 0, 1), in_range="no", rank=None),
        lever("cylinder_length", "", (200, 161, 161, 700, 0, 86, 0, 77), rank=1),
    ]
    ordered = shown_levers(levers_table(*rows))["dimension"].to_list()
    assert ordered == ["cylinder_length", "mean_radius", "rim_length"]


def test_shared_dimensions_that_change_without_the_others_are_told_as_alone():
    """Wall with disk, wall alone, disk alone; a mean radius that moves the disk's edge is a mean radius."""
    names = {(row["dimension"], row["moves"]): lever_name(row) for row in shown_levers(study_levers()).to_dicts()}
    assert names["wall_thickness", "disk_thickness"] == "wall and disk thickness"
    assert names["wall_thickness", None] == "wall thickness alone"
    assert names["disk_thickness", None] == "disk thickness alone"
    assert names["mean_radius", "disk_outer_radius"] == "mean radius"
    assert names["disk_inner_radius", None] == "hub radius"


def test_a_hat_has_no_hub_at_the_inner_radius_of_its_disk():
    """Named as a hat, a variant has its disk inner radius changed, not the hub that it has at the outer edge."""
    as_hat = {row["dimension"]: change_words(row) for row in shown_levers(study_levers(), {CASE_3}).to_dicts()}
    assert as_hat["disk_inner_radius"] == "disk inner radius 40 → 46 mm"


@pytest.mark.parametrize(
    ("known", "words"),
    [
        ({"what": "material", "dimension": "material", "to_material": "40CrNiMoA"}, "material 40CrNiMoA"),
        ({"what": "material", "dimension": "material", "to_material": "a\x1b[2Jb"}, "material a·[2Jb"),
        ({"what": "tolerance", "from_value": 0.03, "drawing_value": 0.012}, "wall thickness ± 30 → ± 12 µm"),
        ({"possible": "no", "drawing_value": None}, "wall thickness 1.6 mm"),
        ({"direction": "relax", "drawing_value": 1.6}, "wall thickness 1.6 mm, may go no further"),
        ({"what": "tolerance", "from_value": 0.0025, "drawing_value": 1.027},
         "wall thickness ± 0.0025 → ± 1.027 mm"),
        ({"what": "tolerance", "dimension": "all", "moves": "a+b+c", "unit": "×", "from_value": 1.0,
          "drawing_value": 0.4}, "all 3 tolerances × 0.4"),
        ({"what": "tolerance", "dimension": "all", "moves": "a+b", "unit": "×", "from_value": 1.0,
          "direction": "relax", "drawing_value": 11.7}, "all 2 tolerances, may be × 11.7"),
        ({"what": "tolerance", "dimension": "all", "moves": "a+b", "unit": "×", "from_value": 1.0,
          "drawing_value": None}, "all 2 tolerances"),
        ({"dimension": "disk_cone_angle", "unit": "°", "drawing_value": 84.5, "from_value": 90.0},
         "disk cone angle 90 → 84.5 °"),
        ({"direction": "relax", "drawing_value": 1.58}, "wall thickness 1.6 mm, may go to 1.58 mm"),
    ],
)  # fmt: skip
def test_changes_in_words(known, words):
    """A change names what it changes, both values in the drawing's digits and their unit; texts are inert."""
    row = lever("wall_thickness", "", (1.6, 1.8169, 1.82, 566, 13.75, 76.1, 13.75, 22, 3)) | known
    assert change_words(row) == words


def test_an_exact_solution_has_four_digits_and_a_drawn_value_its_own():
    """45.8406 is told as 45.84, a drawn 161.5 as that; tolerances of lengths are in micrometres."""
    row = lever("disk_inner_radius", "", (40, 45.8406, 46, 320))
    assert [shown_value(row, key) for key in ("from_value", "to_value", "drawing_value")] == [40.0, 45.84, 46.0]
    wall = lever("wall_thickness", "", (0.0025, 0.029664, 0.029, 1237), what="tolerance")
    assert [shown_value(wall, key) for key in ("from_value", "to_value", "drawing_value")] == [2.5, 29.66, 29.0]


def test_a_share_within_is_told_to_the_first_digit_of_what_is_beyond():
    """However few are beyond, the share told is never 100 %, and it leaves what is beyond within a factor of two."""
    for exponent in range(1, 9):
        for first in (1.0, 3.3, 7.7):
            beyond = first * 10.0**-exponent / 10
            told = 1 - float(within_words(beyond).removesuffix(" %")) / 100
            assert 0 < told < 2 * beyond + 1e-12 or beyond > 0.01
    assert within_words(1e-12) == "practically all"
