"""Unused tolerance classes: a slip of the keyboard is told once, another name never."""

from __future__ import annotations

import pytest

from flexlash.pipeline import check

NAMES = [
    (["standrad"], [None], [("A2", "standard")]),
    (["standrad"], ["standard"], [("A2", "standard")]),
    (["standrad", "Standrad ", "standrad"], [None], [("A2", "standard")]),
    (["standard", "standrad"], [None], [("A3", "standard")]),
    (["press fit", "pres fit"], ["Press Fit"], [("A3", "Press Fit")]),
    (["coarse", "standrad", "corase"], ["coarse", None], [("A3", "standard"), ("A4", "coarse")]),
    (["standrad"], ["standrad"], []),
    (["press fit", "standrad"], ["press fit"], []),
    (["fien"], ["fine"], []),
    (["fine", "fien"], ["fine"], [("A3", "fine")]),
    (["spare"], [None], []),
    (["class 12", "class 21"], ["class 12"], []),
    (["standard", "standrad"], ["standrad"], []),
    (["class 1", "class 2"], ["class 1"], []),
    (["STANDARD"], [None], []),
    (["standrad"], ["standart"], []),
]


@pytest.mark.parametrize(("classes", "used", "told"), NAMES)
def test_an_unused_class_that_resembles_one_in_use(table, sound, classes, used, told):
    """A class that nobody uses is a warning at its first row where its name is a slip of one in use, else nothing."""
    variants = [sound | {"variant": f"V{place}", "tolerance_class": name} for place, name in enumerate(used)]
    dimensions = ["wall_thickness", "mean_radius", "cylinder_length"]
    rows = [
        {"tolerance_class": name, "dimension": dimension, "grade": "IT7"}
        for name, dimension in zip(classes, dimensions, strict=False)
    ]
    outcome = check(table(variants), tolerances=table(rows, name="tolerances.csv"))
    found = [one for one in outcome.findings if one.code == "W429"]
    assert [(one.cell, one.suggestion) for one in found] == told
    assert all(one.sheet == "Tolerances" and one.certain_value is None for one in found)
