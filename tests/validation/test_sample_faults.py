"""What classes take of samples: enough parts that differ; a fault of a sample spoils who takes it, and no one else."""

from __future__ import annotations

import pytest
from measured_parts import HEADERS, LIMITS, measured_rows, samples_of

from flexlash.pipeline import check
from flexlash.schema.columns import columns_of


@pytest.fixture
def told(book, sound):
    """Return a function that checks a Tolerances sheet and rows of Measurements, with a variant of each class."""

    def read(tolerances, rows, headers=HEADERS):
        classes = list(dict.fromkeys(row[0] for row in tolerances[1:]))
        label = {key: column.label for key, column in columns_of("Variants").items()}
        variants = [sound | {"variant": name, "tolerance_class": name} for name in classes]
        sheet = [[label[key] for key in variants[0]], *(list(row.values()) for row in variants)]
        return check(book({"Variants": sheet, "Tolerances": tolerances, "Measurements": [headers, *rows]}))

    return read


def _at(outcome, *sheets):
    return [(one.code, one.sheet, one.cell) for one in outcome.findings if one.sheet in sheets and one.code[0] in "EW"]


def _waiting(outcome):
    """Return the variants that are not computed."""
    return {name for row, name, _ in outcome.validated.submitted if row in outcome.validated.blocked.rows}


@pytest.mark.parametrize(("count", "code"), [(1, "E340"), (4, "E340"), (5, "W445"), (19, "W445"), (20, "")])
def test_how_many_parts(told, count, code):
    """Fewer than 5 measured parts are an error where a class uses them, fewer than 20 a warning."""
    outcome = told(samples_of(("shop", "wall_thickness", "wall")), measured_rows(count))
    of_sample = [one for one in _at(outcome, "Tolerances") if one[0] != "W438"]
    assert of_sample == ([(code, "Tolerances", "F2")] if code else [])
    assert _waiting(outcome) == ({"shop"} if code.startswith("E") else set())
    if code:
        assert f"{count} value" in next(one.message for one in outcome.findings if one.code == code)


def test_a_column_of_few_parts_harms_nobody_who_does_not_use_it(told):
    """Three disks beside sixty walls are told only where a class uses the disks."""
    rows = measured_rows()
    for row in rows[3:]:
        row[4] = None
    assert [
        one for one in _at(told(samples_of(("shop", "wall_thickness", "wall")), rows), "Tolerances") if one[0] != "W438"
    ] == []
    uses = samples_of(("shop", "wall_thickness", "wall"), ("disk", "disk_thickness", "wall"))
    outcome = told(uses, rows)
    assert ("E340", "Tolerances", "F3") in _at(outcome, "Tolerances")
    assert _waiting(outcome) == {"disk"}


def test_values_that_do_not_differ(told):
    """Equal values have no scatter: an error that names the value in the unit of the dimension."""
    outcome = told(samples_of(("shop", "wall_thickness", "wall")), [["wall", n, None, 1.607] for n in range(30)])
    (found,) = [one for one in outcome.findings if one.level == "error"]
    assert (found.code, found.cell) == ("E341", "F2")
    assert "1.607 mm" in found.message
    assert _waiting(outcome) == {"shop"}


def test_a_fault_of_a_sample_spoils_who_takes_it(told):
    """An unreadable wall keeps classes from using walls of this sample, not its disks, nor another sample."""
    uses = samples_of(
        ("wall", "wall_thickness", "first"), ("disk", "disk_thickness", "first"), ("other", "wall_thickness", "second")
    )
    rows = [*measured_rows(20, "first"), *measured_rows(20, "second")]
    rows[4][3] = "1,6 ?"
    outcome = told(uses, rows)
    assert _at(outcome, "Measurements") == [("E202", "Measurements", "D6")]
    assert _waiting(outcome) == {"wall"}
    assert "Row 2 of Variants waits for class wall" in next(
        one.message for one in outcome.findings if one.code == "E202"
    )


def test_a_fault_of_a_sample_spoils_who_inherits_it(told):
    """A class that takes over the row waits, too; one that has its own row for the dimension does not."""
    limits = [[*LIMITS, "Based on class"], *(["full", "wall_thickness", -0.02, 0.02, "mm", "wall", None],)]
    limits += [["heir", None, None, None, None, None, "full"], ["own", None, None, None, None, None, "full"]]
    limits += [["own", "wall_thickness", -0.01, 0.01, "mm", None, None]]
    rows = measured_rows()
    rows[4][3] = -1
    outcome = told(limits, rows)
    assert _at(outcome, "Measurements") == [("E207", "Measurements", "D6")]
    assert _waiting(outcome) == {"full", "heir"}
    few = told(limits, measured_rows(4))
    assert [one for one in _at(few, "Tolerances") if one[0] == "E340"] == [("E340", "Tolerances", "F2")]
    assert _waiting(few) == {"full", "heir"}


@pytest.mark.parametrize(("place", "header"), [(3, "Wal thickness [mm]"), (0, "Sampel")])
def test_a_header_that_cannot_be_read_is_told_once(told, place, header):
    """A misspelt header of Measurements is not told again as a sample or dimension that is missing."""
    headers = [*HEADERS]
    headers[place] = header
    outcome = told(samples_of(("shop", "wall_thickness", "wall")), measured_rows(), headers)
    assert [(one.code, one.sheet) for one in outcome.findings if one.level == "error"] == [("E112", "Measurements")]
    assert _waiting(outcome) == {"shop"}


def test_samples_that_nobody_uses(told):
    """A sample left over is an information, one that resembles a sample in use a warning with that."""
    rows = [*measured_rows(), *measured_rows(5, "walls"), *measured_rows(5, "spare")]
    outcome = told(samples_of(("shop", "wall_thickness", "wall")), rows)
    found = [(one.code, one.cell, one.suggestion) for one in outcome.findings if one.code in {"W453", "I529"}]
    assert found == [("W453", "A62", "wall"), ("I529", "A67", "")]


def test_a_sample_whose_row_is_faulty_is_in_use(told):
    """A row of Tolerances with another fault uses its sample all the same."""
    limits = samples_of(("shop", "wall_thickness", "wall"))
    limits[1] = ["shop", "wall_thickness", "x", 0.02, "mm", "wall"]
    assert [one.code for one in told(limits, measured_rows()).findings if one.code in {"W453", "I529"}] == []
