"""Whole columns measured in another unit, or sizes called deviations: told at the header, with the unit."""

from __future__ import annotations

import pytest
from measured_parts import HEADERS, samples_of, scattered

from flexlash.pipeline import check
from flexlash.schema.columns import columns_of


@pytest.fixture
def told(book, sound):
    """Return a function that checks walls under a header, used by the classes of these variants."""

    def read(values, header=HEADERS[3], use=None, variants=({},), uses=(("shop", "wall_thickness", "wall"),)):
        own = [sound | {"variant": f"V{place}", "tolerance_class": "shop"} | one for place, one in enumerate(variants)]
        label = {key: column.label for key, column in columns_of("Variants").items()}
        sheet = [[label[key] for key in own[0]], *(list(row.values()) for row in own)]
        rows = [["wall", use, value] for value in values]
        sheets = {
            "Variants": sheet,
            "Tolerances": samples_of(*uses),
            "Measurements": [["Sample", "Use as", header], *rows],
        }
        outcome = check(book(sheets))
        return [(one.cell, one.suggestion, one.message) for one in outcome.findings if one.code == "W454"]

    return read


UNITS = {
    "micrometres": (1000.0, "[mm]", "Wall thickness Δ [µm]"),
    "metres": (0.001, "[mm]", "Wall thickness Δ [m]"),
    "inches": (1 / 25.4, "[mm]", "Wall thickness Δ [in]"),
    "mils": (1000 / 25.4, "[mm]", "Wall thickness Δ [mil]"),
    "millimetres under µm": (1.0, "[µm]", "Wall thickness Δ [mm]"),
    "nothing that is a unit": (7.0, "[mm]", ""),
}


@pytest.mark.parametrize("unit", UNITS)
def test_a_column_in_another_unit(told, unit):
    """The header is told, with the unit that makes sizes of the values where there is one."""
    factor, header, meant = UNITS[unit]
    ((cell, suggestion, message),) = told([value * factor for value in scattered(30)], f"Wall thickness Δ {header}")
    assert (cell, suggestion) == ("C1", meant)
    assert "entered 1.6 mm" in message


def test_sizes_called_deviations(told):
    """Values of the entered size are no deviations from it."""
    ((cell, _, message),) = told(scattered(30), use="deviation")
    assert cell == "C1"
    assert "deviations as large as the entered 1.6 mm itself" in message


@pytest.mark.parametrize(
    ("values", "use"),
    [
        (scattered(30), None),
        ([value * 2 for value in scattered(30)], None),
        ([value - 1.607 for value in scattered(30)], "deviation"),
        ([value * 100 for value in scattered(30)], "deviation"),
    ],
)
def test_nothing_is_said_of_sound_columns(told, values, use):
    """Sizes within five times the entered one, and small deviations, are no other unit."""
    assert told(values, use=use) == []


def test_the_middle_of_the_variants_counts(told):
    """The variants of the class are what a sample is compared with, of whatever size the others are."""
    thin = {"wall_thickness_mm": 0.16, "tolerance_class": "standard"}
    assert told(scattered(30), variants=({}, thin, thin, thin)) == []
    assert len(told([1000 * value for value in scattered(30)], uses=(("base", "wall_thickness", "wall"),))) == 1


def test_a_size_of_nothing_is_told_alone(told):
    """A 0 among sizes has an error of its own, and says nothing of their unit."""
    assert told([*(value * 1000 for value in scattered(30)), 0.0]) == []
