"""What number a text means: as one unit, one sign, one digit after another is taken for what its author wrote."""

from __future__ import annotations

import pytest
from grids import for_each

from flexlash.schema.columns import SETTINGS, columns_of
from flexlash.validation.number_texts import Measure, is_both_ways, meant_number

COLUMNS = {
    **columns_of("Variants"),
    **columns_of("Materials"),
    **columns_of("Tolerances"),
    **{column.key: column for column in SETTINGS},
}
WALL, RADIUS, BORE = "wall_thickness_mm", "mean_radius_mm", "bore_diameter_mm"
TORQUE, YOUNG, POISSON = "torque_Nm", "youngs_modulus_GPa", "poisson_ratio"
ANGLE, DENSITY, INERTIA = "backlash_limit_arcmin", "density_kg_m3", "load_inertia_kg_m2"

CERTAIN = [
    (WALL, "1,6", 1.6),
    (WALL, "1.6", 1.6),
    (WALL, " 1.6", 1.6),
    (WALL, "+1.6", 1.6),
    (WALL, "'1.6", 1.6),
    (WALL, "1.6.", 1.6),
    (WALL, "160. mm", 160.0),
    (WALL, "1.6..", 1.6),
    (WALL, ".5 mm", 0.5),
    (WALL, "1.6 mm", 1.6),
    (WALL, "1.6mm", 1.6),
    (WALL, "1,6 MM", 1.6),
    (WALL, "1.6e-3", 0.0016),
    (WALL, "1,6e0 mm", 1.6),
    (WALL, "0.0016 m", 1.6),
    (WALL, "1600 µm", 1.6),
    (WALL, "1600 μm", 1.6),
    (WALL, "1600 um", 1.6),
    (WALL, '0.5"', 12.7),
    (WALL, "0,5 inch", 12.7),
    (WALL, "\u00a01.6", 1.6),
    (WALL, "1.6\u00a0mm", 1.6),
    (WALL, "1.6\u202fmm", 1.6),
    (WALL, "1\u200b.6", 1.6),
    (WALL, "１．６", 1.6),
    (WALL, "１，６\u3000ｍｍ", 1.6),
    (WALL, "\u0661\u066b\u0666", 1.6),
    (WALL, "0,800", 0.8),
    (WALL, "1600,5", 1600.5),
    (WALL, "1600,500", 1600.5),
    (WALL, "1.600,5", 1600.5),
    (WALL, "1,600.5", 1600.5),
    (WALL, "1 600", 1600.0),
    (WALL, "1\u202f600,5", 1600.5),
    (WALL, "1'600.5", 1600.5),
    (WALL, "1\u2019600.5", 1600.5),
    (WALL, "1.234.567", 1234567.0),
    (WALL, "1,234,567.8", 1234567.8),
    ("lower_deviation", "\u22120.02", -0.02),
    ("lower_deviation", "\u20130,02", -0.02),
    ("lower_deviation", "\uff0d0.02", -0.02),
    ("lower_deviation", "- 0.02", -0.02),
    (RADIUS, "R3.5", 3.5),
    (RADIUS, "r 80 mm", 80.0),
    (BORE, "Ø80", 80.0),
    (BORE, "⌀ 80 mm", 80.0),
    (TORQUE, "800 Nm", 800.0),
    (TORQUE, "800 N·m", 800.0),
    (TORQUE, "800 N m", 800.0),
    (TORQUE, "0,8 kNm", 800.0),
    (TORQUE, "1 000 000 N·mm", 1000.0),
    (YOUNG, "211 GPa", 211.0),
    (YOUNG, "211 000 N/mm²", 211.0),
    (YOUNG, "211000 N/mm2", 211.0),
    (YOUNG, "30e6 psi", 206.842718795),
    (POISSON, "0,3", 0.3),
    (POISSON, "30%", 0.3),
    (POISSON, "30 %", 0.3),
    (POISSON, "0.3 -", 0.3),
    ("coverage_percent", "95%", 95.0),
    ("coverage_percent", "95 ％", 95.0),
    ("cylinder_calibration", "105 %", 1.05),
    (ANGLE, "3'", 3.0),
    (ANGLE, "3′", 3.0),
    (ANGLE, '180"', 3.0),
    (ANGLE, "3 arcmin", 3.0),
    ("disk_cone_angle_deg", "60°", 60.0),
    ("disk_cone_angle_deg", "45,000", 45.0),
    (DENSITY, "7,85 g/cm3", 7850.0),
    (DENSITY, "7850 kg/m³", 7850.0),
    (INERTIA, "0,5 kg m²", 0.5),
    (INERTIA, "0.5 kg m^2", 0.5),
    ("seed", "10 000", 10000.0),
    ("seed", "1,600", 1600.0),
]

GUESSED = [
    (WALL, "1,600", "1.6 or 1600"),
    (WALL, "1,600 mm", "1.6 or 1600"),
    (TORQUE, "1.600 N·m", "1.6 or 1600"),
    (TORQUE, "1,600 kNm", "1600 or 1600000"),
    (YOUNG, "211.000 MPa", "0.211 or 211"),
    (POISSON, "1,600", "1.6 or 1600"),
    (WALL, "\u22121,6", "-1.6"),
    (WALL, "0 mm", "0"),
    (WALL, "~1.6", "1.6"),
    (WALL, "≈ 1,6 mm", "1.6"),
    (WALL, "ca. 1,6", "1.6"),
    (WALL, "ca 1.6", "1.6"),
    (WALL, "approx. 1.6", "1.6"),
    (WALL, "±0.02", "0.02"),
    (WALL, "± 0,02 mm", "0.02"),
    ("upper_deviation", "±0.02", "-0.02 in lower and 0.02 in upper"),
    ("lower_deviation", "±0.02", "-0.02 in lower and 0.02 in upper"),
    ("lower_deviation", "+/-0,02", "-0.02 in lower and 0.02 in upper"),
    (WALL, "1/4", "0.25"),
    (WALL, "½", "0.5"),
    (WALL, '1 1/4"', "31.75"),
    (RADIUS, "Ø80", "40"),
    (RADIUS, "⌀ 160 mm", "80"),
    (BORE, "R40", "80"),
]

NOTHING = [
    *((WALL, text) for text in (
        "", " ", "n/a", "x", "-", ".", ",", "mm", "+0.01/-0.02", "1.2.3", "12.34,5", "1,6,5", "1-2", "1 6", "1,",
        "0x10", "1.6 kg", "5%", "1.6 furlong", "1.6 mm x 2", "<2", "max 2", "Ø80", "R3.5", "1e400", "1/4/2026",
        "1.6 m/s", "2 x 0.8", "1,6 / 1,8", "nan", "inf", "\x00",
    )),
    (POISSON, "0.3-1"),
    (POISSON, "0,3 mm"),
    (TORQUE, "800 N"),
    (TORQUE, "800 W"),
    (ANGLE, "2′ 30″"),
    ("seed", "1,5"),
    ("seed", "5 Nm"),
    ("lower_deviation", "0.02 mm"),
    ("lower_deviation", "5%"),
]  # fmt: skip


@for_each("key, text, number", CERTAIN)
def test_what_can_mean_one_number_only(key, text, number):
    """Signs, digits, spaces and known units of all countries give the number in the column's unit, to be written."""
    meant = meant_number(text, COLUMNS[key])
    assert meant.certain_value == number
    assert float(meant.words) == number


@for_each("key, text, words", GUESSED)
def test_what_is_guessed_is_never_written(key, text, words):
    """What may mean thousands, is said roughly, is out of bounds or needs halving is only suggested."""
    meant = meant_number(text, COLUMNS[key])
    assert (meant.words, meant.certain_value) == (words, None)


@for_each("key, text", NOTHING)
def test_where_nothing_is_suggested(key, text):
    """An unknown unit, a unit of something else, or more than one number suggests nothing."""
    assert meant_number(text, COLUMNS[key]).numbers == ()


@pytest.mark.parametrize(
    ("text", "number"), [("1,6", 1.6), ("1.6 in", 1.6), ("40.64 mm", 1.6), ("0.0016 m", 0.0629921259843)]
)
def test_the_number_is_in_the_unit_of_its_header(text, number):
    """Under a header in inches the number to write is one in inches."""
    column = COLUMNS[WALL]
    assert meant_number(text, column, Measure.of(column, 25.4)).certain_value == pytest.approx(number, rel=1e-11)


def test_a_deviation_takes_the_unit_beside_it():
    """A deviation of 0.02 mm beside the unit µm is 20; one beside a unit of another kind is nothing."""
    column = COLUMNS["lower_deviation"]
    assert meant_number("-0.02 mm", column, Measure(quantity="length", si=1e-6)).certain_value == -20
    assert meant_number("5 %", column, Measure(quantity="ratio", si=0.01)).certain_value == 5
    assert meant_number("5 %", column, Measure(quantity="length", si=1e-3)).numbers == ()


OPEN = {
    "5 %": "5, and % as the deviation unit",
    "-2,5%": "-2.5, and % as the deviation unit",
    "±5 %": "-5 in lower and 5 in upper, and % as the deviation unit",
    "± 0.1 mm": "-0.1 in lower and 0.1 in upper",
    "±-0.1": "-0.1 in lower and 0.1 in upper",
    "±100 µm": "-0.1 in lower and 0.1 in upper",
    "±5 kg": "",
    "±1,600": "",
    "± %": "",
}


@pytest.mark.parametrize("text", OPEN)
def test_two_cells_are_suggested_where_one_entry_needs_them(text):
    """Per cent beside a blank unit, and ± in one cell, are told with every cell that they take; never written."""
    measure = Measure(quantity="length", si=1e-3, unit_is_open=True)
    for key in ("lower_deviation", "upper_deviation"):
        meant = meant_number(text, COLUMNS[key], measure)
        assert (meant.words if meant.entries else "", meant.certain_value) == (OPEN[text], None)
    assert is_both_ways(text) == ("±" in text)


def test_both_ways_in_per_cent_where_the_unit_says_so():
    """Beside the unit %, ±5 % takes two cells and no other unit."""
    measure = Measure(quantity="ratio", si=0.01)
    assert meant_number("±5 %", COLUMNS["lower_deviation"], measure).words == "-5 in lower and 5 in upper"
