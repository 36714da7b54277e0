"""What a row of Tolerances says of its process: each contradiction at its cell, and what sound entries become in SI."""

from __future__ import annotations

import pytest
from tolerance_sheets import GRADED, WALL, judged, sample, told

from flexlash.schema.columns import DIMENSIONS, LOT_DIMENSIONS

CONTRADICTIONS = [
    ({"limits_sigma": 3, "standard_deviation": 0.004}, [("E335", "standard_deviation")]),
    ({"limits_sigma": 3, "cp": 1.1}, [("E335", "cp")]),
    ({"limits_sigma": 3, "sample": "wall"}, [("I504", "sample"), ("E335", "sample")]),
    ({"standard_deviation": 0.004, "cp": 1.1}, [("E335", "cp")]),
    ({"standard_deviation": 0.004, "cp": 1.1, "sample": "Wall"}, [("E335", "cp"), ("E335", "sample")]),
    ({"sample": "Wall", "mean_shift": 0.001}, [("E335", "mean_shift")]),
    ({"sample": "Wall", "cpk": 1}, [("E335", "cpk")]),
    ({"cpk": 1}, [("E336", "cpk")]),
    ({"cpk": 1, "limits_sigma": 3}, [("E336", "cpk")]),
    ({"cpk": 1.2, "cp": 1.1}, [("E336", "cpk")]),
    ({"distribution": "uniform", "mean_shift": 0.001}, [("E337", "mean_shift")]),
    ({"distribution": "triangular", "standard_deviation": 0.001}, [("E337", "standard_deviation")]),
    ({"distribution": "uniform", "cp": 1.1, "cpk": 1.1}, [("E337", "cp"), ("E337", "cpk")]),
    ({"distribution": "triangular", "sample": "Wall"}, [("E337", "sample")]),
    ({"distribution": "measured"}, [("E201", "sample")]),
    ({"distribution": "measured", "limits_sigma": 3}, [("E201", "sample")]),
    ({"distribution": "measured", "sample": "Wall", "limits_sigma": 3}, [("E335", "sample")]),
    ({"distribution": "measured", "sample": "Wall", "cp": 1}, [("E337", "cp")]),
    ({"distribution": "measured", "sample": "Wall", "mean_shift": 0.001}, [("E337", "mean_shift")]),
    ({"distribution": "measured", "standard_deviation": 0.001}, [("E337", "standard_deviation")]),
    ({"lower_deviation": 0.02, "cp": 1.1}, [("E337", "upper_deviation")]),
    ({"lower_deviation": 0, "upper_deviation": 0, "mean_shift": 0.001}, [("E337", "mean_shift")]),
    ({"sample": "walls"}, [("E223", "sample")]),
    ({"sample": "n/a"}, [("E221", "sample")]),
    ({"dimension": "disk_thickness", "sample": "Wall"}, [("E223", "sample")]),
    ({"mean_shift": 0.101, "standard_deviation": 0.004}, [("E339", "mean_shift")]),
    ({"mean_shift": -0.101, "standard_deviation": 0.004}, [("E339", "mean_shift")]),
    ({"mean_shift": 0.05, "standard_deviation": 0.004}, [("W442", "mean_shift")]),
    ({"standard_deviation": 4.1}, [("E339", "standard_deviation")]),
    ({"cp": 0.1}, [("W440", "cp")]),
    ({"cp": 0.03}, [("W440", "cp"), ("E339", "cp")]),
    ({"cp": 1.5, "cpk": -1.5}, [("W440", "cpk"), ("W442", "cpk")]),
    ({"cp": 1.5, "cpk": -6.5}, [("W440", "cpk"), ("E339", "cpk")]),
    ({"mean_shift": 0.021, "standard_deviation": 0.004}, [("W442", "mean_shift")]),
    ({"cp": 1.5, "cpk": -0.2}, [("W440", "cpk"), ("W442", "cpk")]),
    ({"mean_shift": 0.01, "cp": 1.5, "cpk": 1.2}, [("W443", "cpk")]),
    ({"mean_shift": 0, "cp": 1.5, "cpk": 1.2}, [("W443", "cpk")]),
    ({"standard_deviation": 4.1e-6}, [("E339", "standard_deviation")]),
    ({"standard_deviation": 5e-324}, [("E339", "standard_deviation")]),
    ({"mean_shift": 1e300}, [("E339", "mean_shift")]),
    ({"cp": 5e-324}, [("W440", "cp"), ("E339", "cp")]),
    ({"cp": 5e-324, "cpk": -1e300}, [("W440", "cp"), ("W440", "cpk"), ("E339", "cp")]),
    ({"cp": 100}, [("W440", "cp")]),
    ({"standard_deviation": 4.1e-4}, [("W444", "standard_deviation")]),
    ({"standard_deviation": 0.03}, [("W444", "standard_deviation")]),
    ({"standard_deviation": -0.004}, [("E207", "standard_deviation")]),
    ({"cp": 0}, [("E207", "cp")]),
    ({"cp": "1,1"}, [("E202", "cp")]),
    ({"cp": "1,1", "cpk": 1}, [("E202", "cp")]),
    ({"scatters_between": "batches"}, [("E209", "scatters_between")]),
    ({"dimension": None}, [("E201", "dimension")]),
]


@pytest.mark.parametrize(("change", "expected"), CONTRADICTIONS)
def test_each_contradiction_is_told_at_its_cell(change, expected):
    """What contradicts another entry is told once, at the cell that it stands in; an error spoils the class."""
    classes, ledger = judged({**WALL, **change})
    assert sorted(told(ledger)) == sorted((code, column, 2) for code, column in expected)
    has_error = any(code[0] == "E" for code, _ in expected)
    assert (ledger.classes == {"own"}) is has_error
    assert len(classes["own"]) == (not has_error)


SOUND = [
    {"mean_shift": 0.007, "standard_deviation": 0.0041},
    {"mean_shift": -0.02, "limits_sigma": 3},
    {"standard_deviation": 0.04 / 24},
    {"standard_deviation": 0.02},
    {"cp": 1.1},
    {"cp": 1.1, "cpk": 1.1},
    {"cp": 1.5, "cpk": 0},
    {"mean_shift": 0.007, "cp": 0.02 / (3 * 0.0041), "cpk": 1.06},
    {"mean_shift": -0.007, "cp": 0.02 / (3 * 0.0041), "cpk": 1.06},
    {"sample": "Wall"},
    {"sample": "Wall", "distribution": "measured"},
    {"sample": "Wall", "distribution": "truncated normal"},
    {"distribution": "truncated normal", "cp": 1, "mean_shift": 0.001},
    {"scatters_between": "lots"},
]


@pytest.mark.parametrize("change", SOUND)
def test_what_can_be_meant_is_not_blamed(change):
    """Sound processes have no finding."""
    classes, ledger = judged({**WALL, **change})
    assert told(ledger) == []
    assert len(classes["own"]) == 1


def test_a_process_in_si():
    """Shift and standard deviation are in the deviation unit, Cp is limits at 3 Cp, Cpk a share of the width."""
    rows = [
        {**WALL, "mean_shift": 7, "standard_deviation": 4.1, "deviation_unit": "µm", "lower_deviation": -20,
         "upper_deviation": 20},
        {**GRADED, "dimension": "disk_thickness", "mean_shift": 0.002, "cp": 1.1},
        {**WALL, "dimension": "youngs_modulus", "lower_deviation": -2, "upper_deviation": 2, "deviation_unit": "%",
         "mean_shift": 0.5, "standard_deviation": 0.4},
        {**WALL, "dimension": "mean_radius", "cp": 1.6, "cpk": 1.2},
    ]  # fmt: skip
    (wall, disk, modulus, radius) = judged(*rows)[0]["own"]
    assert (wall.mean_shift, wall.sd) == pytest.approx((7e-6, 4.1e-6), rel=1e-15)
    assert (disk.mean_shift, disk.limits_sigma, disk.sd, disk.harmful_shift) == (2e-6, 3.3, None, 0.0)
    assert (modulus.mean_shift, modulus.sd, modulus.relative) == (0.005, 0.004, True)
    assert (radius.limits_sigma, radius.harmful_shift) == (pytest.approx(4.8), pytest.approx(0.125))


def test_a_given_shift_goes_before_the_harmful_side():
    """Beside a mean shift Cpk moves nothing."""
    (row,) = judged({**WALL, "mean_shift": 0.007, "cp": 1.6, "cpk": 1.04})[0]["own"]
    assert (row.mean_shift, row.harmful_shift) == (7e-6, 0.0)


def test_samples_are_attached_by_their_plain_names():
    """A row gets the values of its dimension in the sample that it names in any case; the spelling is repaired."""
    classes, ledger = judged({**WALL, "sample": " WALL "})
    assert [row.sample for row in classes["own"]] == [sample()]
    assert {found.code for found in ledger.findings} == {"I504"}
    assert ledger.findings[-1].suggestion == "Wall"


def test_an_unknown_sample_is_told_with_what_was_probably_meant():
    """A sample that nobody measured is an error, with the one that is nearly spelt so, if there is one."""
    (found,) = judged({**WALL, "sample": "wal"}, measured={"wall": {"wall_thickness": sample("wall")}})[1].findings
    assert (found.suggestion, found.certain_value) == ("wall", "wall")
    (found,) = judged({**WALL, "sample": "wal"}, measured={})[1].findings
    assert (found.code, found.suggestion) == ("E223", "")


def test_a_dimension_whose_measured_values_are_faulty_is_told_there_alone():
    """What is wrong with the values has its own finding; the class cannot be used."""
    row = {**WALL, "dimension": "disk_thickness", "sample": "Wall"}
    _, ledger = judged(row, spoilt={("wall", "disk_thickness")})
    assert told(ledger) == []
    assert ledger.classes == {"own"}


@pytest.mark.parametrize(
    ("values", "told_of"),
    [
        ((0.006, 0.008, 0.007, 0.0065), []),
        ((0.023, 0.028, 0.017, 0.021), [("W442", "sample", 2)]),
        ((0.223, 0.228, 0.217, 0.221), [("E339", "sample", 2)]),
        ((16.2, -14.5, 2.3, 3.1), [("E339", "sample", 2)]),
        ((0.5,), []),
        ((0.5, 0.5, 0.5), []),
    ],
)
def test_a_sample_of_deviations_is_judged_beside_the_deviations(values, told_of):
    """Deviations are compared with limits that are deviations, too; too few or equal ones have findings elsewhere."""
    measured = {"wall": {"wall_thickness": sample(values=values, deviations=True)}}
    assert told(judged({**WALL, "sample": "Wall"}, measured=measured)[1]) == told_of


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_what_a_heat_shares_scatters_between_lots(dimension):
    """Elastic constants and calibrations scatter between lots unless the row says otherwise, all else between parts."""
    rows = [
        {**WALL, "tolerance_class": name, "dimension": dimension, "scatters_between": between}
        for name, between in (("blank", None), ("lots", "lots"), ("parts", "parts"))
    ]
    found = {name: rows[0].scatters_between for name, rows in judged(*rows)[0].items()}
    assert found == {"blank": "lots" if dimension in LOT_DIMENSIONS else "parts", "lots": "lots", "parts": "parts"}


def test_text_in_a_shift_is_understood_in_the_deviation_unit():
    """A shift with a unit behind it is suggested in the unit of the row's deviations."""
    row = {**WALL, "lower_deviation": -20, "upper_deviation": 20, "deviation_unit": "µm", "mean_shift": "0.007 mm"}
    (found,) = judged(row)[1].findings
    assert (found.code, found.column, found.suggestion) == ("E202", "mean_shift", "7")
