"""A row of Levers becomes what may change of a dimension, in SI, or a finding that withholds this dimension alone."""

from __future__ import annotations

import pytest
from decided_drives import LEVERS
from decided_rows import told, validated

from flexlash.schema.columns import columns_of
from flexlash.schema.decision_rows import LeverRow

EVERY = frozenset(columns_of("Levers")["dimension"].choices)
LENGTH = {"dimension": "cylinder_length", "lowest": 120.0, "highest": 220.0, "step": 0.5}


def _found(*rows):
    return validated(levers=rows)


def _advised(found):
    """Return the dimensions with a row that lets the value change; of withheld ones the tolerance may not either."""
    assert not any(
        found.levers[name].may_change or found.levers[name].tolerance_may_change for name in found.withheld_levers
    )
    return {row.dimension for row in found.levers.values() if row.may_change is not False}


def test_levers_in_si():
    """Range and step are in SI by the unit of the dimension's column, answers are yes or no, costs as entered."""
    found = _found(
        *LEVERS,
        {"dimension": "torque", "may_change": "yes", "highest": 900.0},
        {"dimension": "disk_cone_angle", "lowest": 60.0},
    )
    assert told(found) == []
    assert found.withheld_levers == frozenset()
    close = pytest.approx
    length = found.levers["cylinder_length"]
    assert (length.lowest, length.highest, length.step) == (close(0.12), close(0.22), close(0.0005))
    assert (length.may_change, length.cost_per_step, length.cost_per_grade) == (None, 2.0, 1.0)
    wall, radius = found.levers["wall_thickness"], found.levers["mean_radius"]
    assert (wall.may_change, wall.tolerance_may_change, wall.step) == (True, False, close(2e-5))
    assert (radius.may_change, radius.cost_per_grade) == (False, 4.0)
    assert found.levers["material"] == LeverRow(row=5, dimension="material", cost_per_step=300.0)
    assert (found.levers["torque"].highest, found.levers["torque"].may_change) == (900.0, True)
    assert found.levers["disk_cone_angle"].lowest == close(1.0471975511965976)


FAULTS = [
    (LENGTH | {"lowest": 230.0}, ("E365", "lowest")),
    (LENGTH | {"lowest": -1.0}, ("E207", "lowest")),
    (LENGTH | {"lowest": None, "highest": 0.0}, ("E207", "highest")),
    ({"dimension": "disk_cone_angle", "highest": 91.0}, ("E208", "highest")),
    (LENGTH | {"step": 0.0}, ("E207", "step")),
    (LENGTH | {"step": "1/2"}, ("E202", "step")),
    (LENGTH | {"may_change": "perhaps"}, ("E209", "may_change")),
    (LENGTH | {"cost_per_step": -1.0}, ("E207", "cost_per_step")),
    *(
        ({"dimension": "material", key: "no" if key == "tolerance_may_change" else 1.0}, ("E362", key))
        for key in ("lowest", "highest", "step", "tolerance_may_change", "cost_per_grade")
    ),
]


@pytest.mark.parametrize(("row", "fault"), FAULTS)
def test_a_fault_withholds_its_dimension_alone(row, fault):
    """Each contradiction is told once at its cell; its dimension is left out of the levers, no other is."""
    found = _found({"dimension": "wall_thickness", "may_change": "no"}, row)
    assert told(found) == [(*fault, 3)]
    assert set(found.levers) == {"wall_thickness", row["dimension"]}
    assert found.withheld_levers == {row["dimension"]}
    assert _advised(found) == set()
    assert len(found.variants) == 2


def test_a_dimension_twice_is_left_out():
    """Both rows are told with each other, and neither counts."""
    found = _found(LENGTH, {"dimension": "Cylinder length"}, {"dimension": "torque"})
    assert [one for one in told(found) if one[0][0] == "E"] == [("E361", "dimension", 2), ("E361", "dimension", 3)]
    assert found.withheld_levers == {"cylinder_length"}
    assert _advised(found) == {"torque"}


@pytest.mark.parametrize("entry", ["length", None, True])
def test_a_row_of_an_unknown_dimension_withholds_all(entry):
    """It may be any of them that may not change, so that nothing is advised."""
    found = _found(
        {"dimension": "torque", "may_change": "yes"}, {"dimension": entry, "may_change": "no", "cost_per_step": 2.0}
    )
    (fault,) = told(found)
    assert (fault[0][0], fault[1:]) == ("E", ("dimension", 3))
    assert found.withheld_levers == EVERY == set(found.levers)
    assert _advised(found) == set()


WARNINGS = [
    (LENGTH | {"may_change": "no"}, [("W461", key) for key in ("lowest", "highest", "step")]),
    (LENGTH | {"step": 101.0}, [("W463", "step")]),
    ({"dimension": "cylinder_length", "step": 500.0}, [("W463", "step")]),
    ({"dimension": "wall_thickness", "step": 10.0}, [("W463", "step")]),
    ({"dimension": "cylinder_length", "lowest": 0.1, "highest": 0.2}, [("W464", "highest")]),
    ({"dimension": "cylinder_length", "lowest": 300.0}, [("W464", "lowest")]),
    ({"dimension": "cylinder_length", "lowest": 170.0, "highest": 190.0}, [("W464", "lowest")]),
]


@pytest.mark.parametrize(("row", "warnings"), WARNINGS)
def test_what_is_odd_is_a_warning(row, warnings):
    """A range that takes no part, a step or a range in another unit are told, and used as entered."""
    found = _found(row)
    assert told(found) == [(*one, 2) for one in warnings]
    assert set(found.levers) == {row["dimension"]}


SOUND = [
    LENGTH,
    LENGTH | {"lowest": 200.0, "highest": 200.0, "step": None},
    {"dimension": "wall_thickness", "lowest": 0.0},
    {"dimension": "hub_fillet_radius", "lowest": 0.0, "highest": 0.0},
    {"dimension": "rim_length", "lowest": 5.0, "highest": 50.0, "step": 1.0},
    {"dimension": "torque", "may_change": "yes"},
    {"dimension": "material", "may_change": "no"},
]


@pytest.mark.parametrize("row", SOUND)
def test_nothing_sound_is_blamed(row):
    """Ranges of one value, a bound that says nothing, dimensions that no variant has and a changing torque are fine."""
    found = _found(row)
    assert (told(found), found.withheld_levers) == ([], frozenset())


def test_the_step_that_leaves_one_value_says_so():
    """200 is the one multiple of 200 from 120 to 220; of 500 there is none."""
    words = [
        next(one.message for one in _found(LENGTH | {"step": step}).findings if one.code == "W463")
        for step in (200.0, 500.0)
    ]
    assert ["one multiple" in words[0], "no multiple" in words[1]] == [True, True]
