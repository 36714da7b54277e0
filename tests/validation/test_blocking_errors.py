"""A row that is not computed names what stops it, wherever that stands."""

from __future__ import annotations

import pytest

from flexlash.analysis.run_summary import summary_lines
from flexlash.pipeline import check

MATERIAL = {"material": "mine", "youngs_modulus_GPa": 211.0, "poisson_ratio": 0.3}
CLASS = {"tolerance_class": "fine", "dimension": "wall_thickness", "grade": "IT7"}


def _stopped(outcome):
    return dict(outcome.results.select("variant", "findings").iter_rows())


def _rows(sound):
    return [
        sound | {"variant": "mine", "material": "mine"},
        sound | {"variant": "fine", "tolerance_class": "fine"},
        sound | {"variant": "plain"},
    ]


@pytest.mark.slow
def test_errors_of_a_material_and_a_class_are_named_at_their_rows(workbook, sound):
    """Rows that use a faulty material or class name its error and place; other rows are computed."""
    outcome = check(
        workbook(
            _rows(sound),
            materials=[MATERIAL | {"poisson_ratio": None}, MATERIAL | {"material": "20Cr2Ni4"}],
            tolerances=[CLASS | {"grade": None}],
        )
    )
    places = {found.code: found.place for found in outcome.findings if found.level == "error"}
    assert set(places) == {"E322", "E317"}
    told = {code: f"{code} {place}" for code, place in places.items()}
    lines = _stopped(outcome)
    assert lines["mine"] == f"stopped by {told['E322']}"
    assert lines["fine"].startswith("stopped by E317 Tolerances!")
    assert "stopped" not in (lines["plain"] or "")


@pytest.mark.slow
def test_an_error_that_stops_all_is_named_by_all(workbook, sound):
    """A faulty setting is named by every row that has no error itself."""
    rows = [*_rows(sound)[2:], sound | {"variant": "own", "torque_Nm": -1}]
    outcome = check(workbook(rows, settings={"seed": -1}))
    (fault,) = [found for found in outcome.findings if found.sheet == "Settings"]
    lines = _stopped(outcome)
    assert lines["plain"] == f"stopped by {fault.code} {fault.place}"
    assert lines["own"].startswith("E207 ")
    assert "stopped" not in lines["own"]


def test_a_value_under_a_faulty_header_names_the_header(table, sound):
    """A row with a value under a misspelt header names that header; a row without one is computed."""
    rows = [sound | {"hub_filet_radius_mm": 2}, sound | {"variant": "b", "hub_filet_radius_mm": ""}]
    lines = _stopped(check(table(rows)))
    assert lines == {"B3-160": "stopped by E112 Variants!J1", "b": None}


@pytest.mark.slow
def test_many_errors_are_counted(workbook, sound):
    """Of more than three errors elsewhere the rest is counted."""
    broken = [
        CLASS | {"dimension": name, "grade": None} for name in ("wall_thickness", "rim_length", "cylinder_length")
    ]
    outcome = check(workbook(_rows(sound)[1:2], tolerances=broken))
    assert _stopped(outcome)["fine"].endswith(" and 3 more")


@pytest.mark.parametrize("strict", [False, True])
def test_a_row_held_back_says_so(table, sound, strict):
    """With --strict a sound row says that it is held back; without it the row is computed."""
    rows = [sound, sound | {"variant": "b", "torque_Nm": -1}]
    line = _stopped(check(table(rows), strict=strict))["B3-160"]
    assert line == ("held back by --strict, since other rows have errors" if strict else None)


def _messages(outcome):
    return {found.code: found.message for found in outcome.findings if found.level == "error"}


def test_an_error_in_a_class_names_the_rows_that_wait_for_it(table, sound, tmp_path):
    """A faulty cell of Tolerances says which class it is and which rows wait, and so does the closing line."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text(
        "tolerance_class,dimension,lower_deviation,upper_deviation\ngrinding,wall_thickness,-0.01,x\n", encoding="utf-8"
    )
    classes = ["Grinding", "grinding", "", "grinding"]
    rows = [sound | {"variant": f"V{place}", "tolerance_class": name} for place, name in enumerate(classes)]
    path = table(rows)
    outcome = check(path, tolerances=tolerances)
    (message,) = _messages(outcome).values()
    assert message.endswith(" Rows 2 to 3, 5 of Variants wait for class Grinding.")
    first = next(iter(summary_lines(outcome, path.name, ran=False)))
    assert first == "submission.csv: 1 of 4 rows ready; 1 cell to fix; 3 rows wait for class Grinding."


@pytest.mark.slow
def test_an_error_in_a_material_names_the_row_that_waits_for_it(workbook, sound):
    """One row that waits is named by its number; a material that nobody uses makes nobody wait."""
    materials = [MATERIAL | {"poisson_ratio": None}, MATERIAL | {"material": "20Cr2Ni4"}]
    materials.append(MATERIAL | {"material": "unused", "youngs_modulus_GPa": -1})
    outcome = check(workbook(_rows(sound)[:1] + _rows(sound)[2:], materials=materials))
    messages = _messages(outcome)
    assert messages["E322"].endswith(" of Variants waits for material mine.")
    assert "wait" not in messages["E207"]


def test_rows_without_a_class_wait_for_standard(table, sound, tmp_path):
    """A fault in class standard holds up the rows whose class is blank."""
    tolerances = tmp_path / "tolerances.csv"
    tolerances.write_text("tolerance_class,dimension,grade\nstandard,wall_thickness,IT99\n", encoding="utf-8")
    messages = _messages(check(table([sound]), tolerances=tolerances))
    assert messages["E210"].endswith(" Row 2 of Variants waits for class standard.")


@pytest.mark.slow
def test_an_error_that_stops_all_says_so(workbook, sound):
    """A faulty setting says that all rows wait for it."""
    messages = _messages(check(workbook([sound], settings={"seed": -1})))
    assert messages["E207"].endswith(" All rows of Variants wait for it.")
