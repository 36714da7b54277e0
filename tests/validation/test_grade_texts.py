"""Tolerance grades as drawings write them."""

from __future__ import annotations

import pytest
from grids import for_each

from flexlash.feedback.fixing.certain_fixes import certain_value_of
from flexlash.pipeline import check
from flexlash.validation.grade_texts import meant_grade

MEANT = [
    ("it7", "IT7"),
    ("IT 7", "IT7"),
    ("IT\u00a07", "IT7"),
    ("IT-7", "IT7"),
    ("IT07", "IT7"),
    ("ＩＴ７", "IT7"),
    ("7", "IT7"),
    ("h 7", "h7"),
    ("H 7", "H7"),
    ("Js7", "JS7"),
    ("js 10", "js10"),
    ("2768m", "2768-m"),
    ("2768 m", "2768-m"),
    ("2768-M", "2768-m"),
    ("ISO 2768-m", "2768-m"),
    ("ISO 2768-mK", "2768-m"),
    ("ISO 2768 - fH", "2768-f"),
    ("DIN ISO 2768-mK", "2768-m"),
    ("ISO 2768-1 c", "2768-c"),
    ("IT13", ""),
    ("4", ""),
    ("g6", ""),
    ("H7/g6", ""),
    ("2768", ""),
    ("2768-x", ""),
    ("fine", ""),
    ("", ""),
]


@for_each("entered, meant", MEANT)
def test_the_grade_that_was_meant(entered, meant):
    """Spaces, letter case where it cannot mean two, and the standard's full name do not hide a grade."""
    assert meant_grade(entered) == meant


@pytest.mark.parametrize(
    ("entered", "certain_value"), [("IT 7", "IT7"), ("ISO 2768-mK", "2768-m"), ("7", None), ("g6", None)]
)
def test_a_grade_is_repaired_unless_its_letters_are_missing(table, sound, entered, certain_value):
    """A grade that is written otherwise can be fixed without asking; a bare number cannot."""
    rows = [{"tolerance_class": "standard", "dimension": "wall_thickness", "grade": entered}]
    outcome = check(table([sound]), tolerances=table(rows, "tolerances.csv"))
    (found,) = [one for one in outcome.findings if one.code == "E210"]
    assert certain_value_of(found) == certain_value
