"""A row of Sweep becomes the values of a study, or a finding at the cell that makes none."""

from __future__ import annotations

import pytest
from decided_drives import CYLINDER, SWEEPS
from decided_rows import UNLIMITED, told, validated

from flexlash.schema.decision_rows import SweptDimension

LENGTH = {"variant": "case 3", "dimension": "cylinder_length", "from": 100.0, "to": 200.0, "step": 20.0}
SECOND = {"second_dimension": "disk_inner_radius", "second_from": 40.0, "second_to": 50.0, "second_step": 5.0}


def _found(*rows, **rest):
    return validated(sweep=rows, **rest)


def test_studies_in_the_unit_of_the_column():
    """Values run from the first to the last in decimal steps, downwards where that is less; blank is every variant."""
    found = _found(*SWEEPS, LENGTH | {"dimension": "wall_thickness", "from": 0.1, "to": 0.4, "step": 0.1})
    assert told(found) == []
    length, both, every, decimal = found.sweeps
    assert (length.row, length.variant, length.second) == (2, "case 3", None)
    assert length.first == SweptDimension(key="cylinder_length_mm", values=(100.0, 120.0, 140.0, 160.0, 180.0, 200.0))
    assert both.first.values == (2.0, 1.8, 1.6, 1.4)
    assert both.second == SweptDimension(key="disk_inner_radius_mm", values=(40.0, 45.0, 50.0))
    assert (every.variant, every.first.values) == (None, (1.5, 1.6, 1.7))
    assert decimal.first.values == (0.1, 0.2, 0.3, 0.4)
    assert found.faulty_sweeps == ()


FAULTS = [
    (LENGTH | {"variant": "case 4"}, ("E366", "variant")),
    (LENGTH | {"variant": "n/a"}, ("E221", "variant")),
    (LENGTH | {"dimension": "length"}, ("E209", "dimension")),
    (LENGTH | {"dimension": "material"}, ("E209", "dimension")),
    (LENGTH | {"dimension": "backlash_limit"}, ("E209", "dimension")),
    (LENGTH | {"from": None}, ("E201", "from")),
    (LENGTH | {"step": -20.0}, ("E207", "step")),
    (LENGTH | {"step": 0.0}, ("E207", "step")),
    (LENGTH | {"step": 100.1}, ("E368", "step")),
    (LENGTH | {"from": 0.0}, ("E207", "from")),
    (LENGTH | {"to": -200.0}, ("E207", "to")),
    (LENGTH | {"dimension": "disk_cone_angle", "from": 80.0, "to": 91.0, "step": 1.0}, ("E208", "to")),
    (LENGTH | {"step": 0.05}, ("E369", "step")),
    (LENGTH | {"step": 1e-300}, ("E369", "step")),
    (LENGTH | SECOND | {"second_step": 0.005}, ("E369", "second_step")),
    (LENGTH | SECOND | {"step": 1.0, "second_step": 0.5}, ("E369", "step")),
    (LENGTH | SECOND | {"second_to": None}, ("E201", "second_to")),
    (LENGTH | SECOND | {"second_dimension": None}, ("E201", "second_dimension")),
    (LENGTH | SECOND | {"second_dimension": "cylinder_length"}, ("E367", "second_dimension")),
    (LENGTH | SECOND | {"second_step": 20.0}, ("E368", "second_step")),
    (LENGTH | {"dimension": "bore_diameter"}, ("E370", "dimension")),
    (LENGTH | {"dimension": "rim_length", "from": 5.0, "to": 20.0, "step": 5.0}, ("E370", "dimension")),
    (LENGTH | {"dimension": "disk_inner_radius", "from": 80.0, "to": 90.0, "step": 5.0}, ("E370", "dimension")),
    (LENGTH | {"variant": "pinned", "dimension": "disk_inner_radius"}, ("E370", "dimension")),
    (LENGTH | {"variant": "pinned", "dimension": "mean_radius"}, ("E370", "dimension")),
    (
        LENGTH | {"variant": "pinned", "dimension": "hub_fillet_radius", "from": 1.0, "to": 3.0, "step": 1.0},
        ("E370", "dimension"),
    ),
]


@pytest.mark.parametrize(("row", "fault"), FAULTS)
def test_a_fault_leaves_its_study_out(row, fault):
    """Each is told once at its cell; the other study and every variant are computed."""
    found = _found(SWEEPS[0], row)
    assert told(found) == [(*fault, 3)]
    assert [one.row for one in found.sweeps] == [2]
    assert found.faulty_sweeps == (3,)
    assert len(found.variants) == 2


@pytest.mark.parametrize("name", ["Case 3", " case  3", "CASE3"])
def test_a_variant_in_other_letters(name):
    """The variant is known in other letters, as a class is."""
    found = _found(LENGTH | {"variant": name})
    assert [one[0] for one in told(found)] == ["I504"]
    assert [one.variant for one in found.sweeps] == ["case 3"]


def test_a_misspelt_variant_is_suggested():
    """What was probably meant is offered."""
    found = validated([UNLIMITED | {"variant": "grinding"}], sweep=[LENGTH | {"variant": "grindin"}])
    (error,) = (one for one in found.findings if one.code == "E366")
    assert (error.suggestion, error.certain_value) == ("grinding", "grinding")


SOUND = [
    LENGTH | {"to": 100.0},
    LENGTH | {"from": 200.0, "to": 100.0, "step": 30.0},
    LENGTH | {"dimension": "torque", "from": 100.0, "to": 800.0, "step": 100.0},
    LENGTH | {"dimension": "hub_fillet_radius", "from": 0.0, "to": 3.0, "step": 1.0},
    LENGTH | {"dimension": "disk_thickness", "from": 1.0, "to": 2.0, "step": 0.5},
    LENGTH | {"dimension": "disk_inner_radius", "from": 40.0, "to": 90.0, "step": 5.0},
    LENGTH
    | {"dimension": "rim_length", "from": 5.0, "to": 20.0, "step": 5.0}
    | {"second_dimension": "rim_thickness", "second_from": 2.0, "second_to": 3.0, "second_step": 0.5},
    LENGTH | {"step": 0.1},
    LENGTH | {"variant": "pinned", "dimension": "bore_diameter", "from": 150.0, "to": 160.0, "step": 2.0},
]


@pytest.mark.parametrize("row", SOUND)
def test_nothing_sound_is_blamed(row):
    """One value, down, a fillet of 0, a rim by both its dimensions, values of which some make a part are studies."""
    found = _found(row)
    assert (told(found), found.faulty_sweeps, len(found.sweeps)) == ([], (), 1)


def test_all_rows_together_have_a_limit():
    """Studies are added up in their order; the one that exceeds 2,000 is told with its number, a smaller one fits."""
    found = _found(
        LENGTH | {"step": 0.1},
        LENGTH | {"variant": None, "step": 0.2},
        LENGTH | {"step": 0.1, "to": 199.0},
        LENGTH,
    )
    assert told(found) == [("E369", "step", 3)]
    assert [one.row for one in found.sweeps] == [2, 4, 5]
    message = next(one.message for one in found.findings if one.code == "E369")
    assert "computes 1,002 rows beside the 1,001 of the rows above; at most 2,000" in message


def test_variants_that_lack_the_dimension_are_left_out_with_a_warning():
    """A study of every variant names those of which no value makes a part; where that is all of them it is an error."""
    row = LENGTH | {"variant": None, "dimension": "disk_inner_radius", "from": 40.0, "to": 50.0, "step": 5.0}
    found = _found(row)
    assert told(found) == [("W465", "dimension", 2)]
    assert "makes a part of pinned: a cylinder has no disk inner radius" in found.findings[-1].message
    assert len(found.sweeps) == 1
    pipes = [CYLINDER | {"variant": name} for name in "AB"]
    assert told(validated(pipes, sweep=[row])) == [("E370", "dimension", 2)]


def test_a_variant_with_an_error_is_not_judged_twice():
    """Of a variant that is not computed no value is judged."""
    found = validated([UNLIMITED | {"disk_inner_radius_mm": 90.0}], sweep=[LENGTH])
    assert [one[0] for one in told(found)] == ["E303"]
