"""One cell at a time: what counts as a number or a text, which code says why not, and what was probably meant."""

import datetime

import pytest
from grids import for_each

from flexlash.reading.raw import CommaNumber, DoubtfulNumber, ErrorCell, Percentage, Unstored
from flexlash.schema.columns import ENTRY_SHEETS, SETTINGS, columns_of
from flexlash.validation.cell_values import Fault, as_number, as_text
from flexlash.validation.number_texts import Measure

WALL = columns_of("Variants")["wall_thickness_mm"]

DAY = datetime.date(2026, 4, 1)
MIDNIGHT = datetime.datetime(2026, 4, 1)  # noqa: DTZ001
NOON = datetime.datetime(2026, 4, 1, 12)  # noqa: DTZ001

NO_ENTRY = [
    (True, Fault(code="E204", value=True)),
    (False, Fault(code="E204", value=False)),
    (ErrorCell("#REF!"), Fault(code="E205", value="#REF!")),
    (Unstored(), Fault(code="E206", value="")),
    (DAY, Fault(code="E203", value=DAY)),
    (MIDNIGHT, Fault(code="E203", value=DAY)),
    (NOON, Fault(code="E203", value=NOON)),
    (datetime.time(1, 4), Fault(code="E203", value=datetime.time(1, 4))),
    (datetime.timedelta(days=2), Fault(code="E203", value=datetime.timedelta(days=2))),
    (float("inf"), Fault(code="E212", value=float("inf"))),
    (float("-inf"), Fault(code="E212", value=float("-inf"))),
]


@for_each("value, fault", NO_ENTRY)
@for_each("from_text", [False, True])
def test_what_is_no_entry(value, fault, from_text):
    """Truth values, errors, formulas without result, dates and infinities are neither numbers nor texts."""
    assert as_number(value, from_text=from_text) == fault
    assert as_text(value, 200) == fault


def test_not_a_number_is_none():
    """Not-a-number has its own code wherever it stands."""
    for fault in (as_number(float("nan"), from_text=False), as_text(float("nan"), 200)):
        assert isinstance(fault, Fault)
        assert fault.code == "E212"


@pytest.mark.parametrize("value", [1.6, 160, 0, -0.05, 1e-300, 2**60])
def test_numbers_are_taken_as_they_are(value):
    """A stored number is taken to the last digit, whole or not."""
    found = as_number(value, from_text=False)
    assert found == value
    assert isinstance(found, float)


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("1.6", 1.6),
        (" 1.6 ", 1.6),
        ("+1.6", 1.6),
        ("-1.6", -1.6),
        ("160", 160.0),
        ("160.", 160.0),
        (".5", 0.5),
        ("1e3", 1000.0),
        ("1.5E-3", 0.0015),
        ("007", 7.0),
        ("0.1000000000000000055511151231257827", 0.1),
        ("1e-400", 0.0),
    ],
)
def test_a_text_of_a_table_may_be_a_number(text, number):
    """In a CSV file a number is a plain decimal with a point; in a workbook the same text is text."""
    assert as_number(text, from_text=True) == number
    fault = as_number(text, from_text=False)
    assert isinstance(fault, Fault)
    assert fault.code == "E202"


@for_each(
    "text",
    ["1,6", "1.6 mm", "1_000", "0x10", "nan", "inf", "infinity", "1e", "e5", "1.2.3", "--1", "1/4", "١٢", "１６", "x"],
)
@for_each("from_text", [False, True])
def test_other_texts_are_not_numbers(text, from_text):
    """What only a programming language, another country or a human would read as a number is text."""
    fault = as_number(text, from_text=from_text)
    assert isinstance(fault, Fault)
    assert (fault.code, fault.value) == ("E202", text)


def test_a_number_too_large_to_hold():
    """A number beyond the range of doubles is refused, not taken as infinite."""
    assert as_number("1e400", from_text=True) == Fault(code="E212", value="1e400")


@pytest.mark.parametrize(
    ("value", "suggestion", "certain_value"), [("1,6 mm", "1.6", 1.6), ("~1.6", "1.6", None), ("1.6 kg", "", None)]
)
def test_a_text_in_a_column_gets_what_was_meant(value, suggestion, certain_value):
    """What a text probably means comes with its fault, as a fix only where it can mean nothing else."""
    assert as_number(value, WALL, from_text=True) == Fault(
        code="E202", value=value, suggestion=suggestion, certain_value=certain_value
    )


def test_numbers_with_a_comma_where_it_is_the_decimal_sign():
    """A number that its table settles is taken with its comma; one that it leaves open is not taken at all."""
    assert as_number(CommaNumber("1,6"), WALL, from_text=True) == 1.6
    assert as_text(CommaNumber("1,6"), 200) == "1,6"
    assert as_number(DoubtfulNumber("1.600"), WALL, from_text=True) == Fault(
        code="E202", value="1.600", suggestion="1.6 or 1600"
    )
    assert as_number(DoubtfulNumber("1.7"), WALL, from_text=True) == Fault(
        code="E202", value="1.7", suggestion="1,7 with this table's decimal comma"
    )


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("B3-160", "B3-160"),
        ("  B3 \t 160\n", "B3 160"),
        ("B3\u00a0160", "B3 160"),
        ("e\u0301t\u00e9", "\u00e9t\u00e9"),
        ("=2+2", "=2+2"),
        ("", ""),
        (" ", ""),
        (160, "160"),
        (160.0, "160"),
        (1.5, "1.5"),
        (0.1, "0.1"),
        ("x" * 200, "x" * 200),
    ],
)
def test_texts(value, text):
    """A text loses outer and double spaces and keeps one form of its accents; a whole number loses its point."""
    assert as_text(value, 200) == text


def test_a_text_without_end():
    """A text of more characters than its column takes is refused."""
    assert as_text("x" * 201, 200) == Fault(code="E222", value="x" * 201, facts={"found": "201", "limit": "200"})


PERCENTAGES = {
    "per cent are wanted": ("coverage_percent", "Settings", None, 0.95, 95.0),
    "a deviation in per cent": ("lower_deviation", "Tolerances", Measure(quantity="ratio", si=0.01), -0.05, -5.0),
    "a ratio": ("poisson_ratio", "Materials", None, 0.3, 0.3),
    "a length": ("wall_thickness_mm", "Variants", None, 1.6, None),
    "a deviation in mm": ("lower_deviation", "Tolerances", Measure(quantity="length", si=1e-3), -0.05, None),
    "a deviation of unknown unit": ("lower_deviation", "Tolerances", Measure(quantity="", si=1.0), -0.05, None),
}


@pytest.mark.parametrize("what", PERCENTAGES)
def test_a_cell_that_shows_a_percentage(what):
    """What a cell shows as 5% is read as 5 where per cent are wanted, as 0.05 in a ratio, and refused elsewhere."""
    key, sheet, measure, stored, expected = PERCENTAGES[what]
    column = next(one for one in (*ENTRY_SHEETS[sheet], *SETTINGS) if one.key == key)
    found = as_number(Percentage(stored), column, from_text=False, measure=measure or Measure.of(column))
    if expected is None:
        assert (found.code, found.value) == ("E216", f"{stored * 100:.10g}%")
    else:
        assert found == expected


def test_a_percentage_as_a_name_is_what_it_shows():
    """A name that a cell shows as a percentage is that text."""
    assert as_text(Percentage(0.07), longest=9) == "7%"
