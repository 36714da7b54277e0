"""The settings of what is decided: the target of the limit, how far means drift alike, the unit of angles."""

from __future__ import annotations

import pytest
from decided_rows import told, validated

from flexlash.validation.blocking_errors import stopped_by

SETTINGS = [
    ("target_percent", 97.5, [("W440", "target_percent", 2)]),
    ("target_percent", 99.0, []),
    ("target_percent", 99.9999, []),
    ("target_percent", 97.4, [("E207", "target_percent", 2)]),
    ("target_percent", 100.0, [("E208", "target_percent", 2)]),
    ("target_percent", "99,9", [("E202", "target_percent", 2)]),
    ("mean_shift_factor", 0.0, []),
    ("mean_shift_factor", 1.0, []),
    ("mean_shift_factor", -0.1, [("E207", "mean_shift_factor", 2)]),
    ("mean_shift_factor", 30.0, [("E208", "mean_shift_factor", 2)]),
    ("angle_unit", "arcsec", []),
    ("angle_unit", "degrees", [("E209", "angle_unit", 2)]),
]


@pytest.mark.parametrize(("name", "value", "findings"), SETTINGS)
def test_each_is_held_to_its_bounds(name, value, findings):
    """Bounds are errors, of which nothing is computed; what is unusual is told and used."""
    found = validated(settings=[{"setting": name, "value": value}])
    assert told(found) == findings
    if any(code[0] == "E" for code, _, _ in findings):
        assert found.blocked.everything
    else:
        assert getattr(found.settings, name) == value


def test_blank_ones_take_their_default():
    """Without a value, or without the row, the target is 99.865 %, the factor 0.3, the unit arcmin."""
    names = ("target_percent", "mean_shift_factor", "angle_unit")
    for rows in ([], [{"setting": name} for name in names]):
        found = validated(settings=rows)
        assert [getattr(found.settings, name) for name in names] == [99.865, 0.3, "arcmin"]


def test_a_fault_of_the_settings_is_not_told_as_one_of_the_sheets():
    """Where a setting stops every row, a fault of Levers is none of the reasons."""
    found = validated(
        settings=[{"setting": "target_percent", "value": 100.0}], levers=[{"dimension": "torque", "lowest": -1.0}]
    )
    stops = stopped_by(found.table, found.blocked, found.findings)
    assert [{error.sheet for error in errors} for errors in stops.values()] == [{"Settings"}, {"Settings"}]
