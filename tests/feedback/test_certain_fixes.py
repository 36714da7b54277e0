"""What may be fixed without asking is fixed right: written into the cell, the finding is gone."""

from __future__ import annotations

import pytest

from flexlash.feedback.fixing.certain_fixes import certain_value_of
from flexlash.pipeline import check

FIXED = [
    ({"wall_thickness_mm": "1,6"}, "E202", 1.6),
    ({"wall_thickness_mm": "0.0016 m"}, "E202", 1.6),
    ({"torque_Nm": "0,8 kNm"}, "E202", 800.0),
    ({"torque_Nm": "1.600,5"}, "E202", 1600.5),
    ({"flexspline_type": "cupp"}, "E209", "cup"),
    ({"material": "20Cr2Nj4"}, "E307", "20Cr2Ni4"),
    ({"tolerance_class": "standart"}, "E309", "standard"),
    ({"material": " 20cr2ni4"}, "I504", "20Cr2Ni4"),
    ({"flexspline_type": "Cup"}, "I504", "cup"),
]
LEFT = [
    ({"torque_Nm": "1,600"}, "E202"),
    ({"wall_thickness_mm": "~1.6"}, "E202"),
    ({"wall_thickness_mm": "1.6 kg"}, "E202"),
    ({"wall_thickness_mm": ""}, "E201"),
    ({"wall_thickness_mm": -1.6}, "E207"),
    ({"flexspline_type": "cop"}, "E209"),
    ({"material": "20Cr2Ni5"}, "E307"),
]


def _only(outcome, code):
    (found,) = [one for one in outcome.findings if one.code == code]
    return found


@pytest.mark.slow
@pytest.mark.parametrize(("change", "code", "certain_value"), FIXED, ids=repr)
def test_a_repair_is_right(table, sound, change, code, certain_value):
    """The value of a fix, written into the cell, takes its finding away and the row is computed."""
    found = _only(check(table([sound | change])), code)
    assert certain_value_of(found) == certain_value
    assert type(certain_value_of(found)) is type(certain_value)
    fixed = check(table([sound | change | {found.column: certain_value}]))
    assert code not in {one.code for one in fixed.findings}
    assert fixed.counts["computed"] == 1


@pytest.mark.parametrize(("change", "code"), LEFT, ids=repr)
def test_what_a_person_must_decide(table, sound, change, code):
    """Where something else could be meant nothing is repaired."""
    assert certain_value_of(_only(check(table([sound | change])), code)) is None


def _renamed(path, old, new):
    path.write_text(path.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    return path


@pytest.mark.slow
@pytest.mark.parametrize(
    ("header", "certain_value"),
    [
        ("Wall thicknes Δ [mm]", "Wall thickness Δ [mm]"),
        ("Wal thickness [in]", "Wall thickness Δ [in]"),
        ("Wall thicknes", None),
        ("Wall thicknes [furlong]", None),
    ],
)
def test_a_header_keeps_its_unit(table, sound, header, certain_value):
    """A misspelt header is repaired with the unit that its author gave, and not where the unit would be a guess."""
    found = _only(check(_renamed(table([sound]), "wall_thickness_mm", header)), "E112")
    assert certain_value_of(found) == certain_value
    assert found.fix.startswith(f"Write {found.suggestion},")
    if certain_value:
        fixed = check(_renamed(table([sound]), "wall_thickness_mm", certain_value))
        assert "E112" not in {one.code for one in fixed.findings}


def test_a_repair_is_no_field_of_the_list_of_findings(table, sound):
    """The list of findings that other programs read has the fields of the contract and no other."""
    found = _only(check(table([sound | {"wall_thickness_mm": "1,6"}])), "E202")
    assert "certain_value" not in found.as_dictionary()
