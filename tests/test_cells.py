"""One cell at a time: what counts as a number or a text, which code says why not, and what was probably meant."""

import datetime

import pytest

from flexlash.submission.cells import Fault, as_number, as_text, suggested_number
from flexlash.submission.read import ErrorCell, Unstored

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


@pytest.mark.parametrize(("value", "fault"), NO_ENTRY, ids=repr)
@pytest.mark.parametrize("from_text", [False, True])
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
    assert (fault.code, float(fault.suggestion)) == ("E202", number)


@pytest.mark.parametrize(
    "text",
    ["1,6", "1.6 mm", "1_000", "0x10", "nan", "inf", "infinity", "1e", "e5", "1.2.3", "--1", "1/4", "١٢", "１６", "x"],
)
@pytest.mark.parametrize("from_text", [False, True])
def test_other_texts_are_not_numbers(text, from_text):
    """What only a programming language, another country or a human would read as a number is text."""
    fault = as_number(text, from_text=from_text)
    assert isinstance(fault, Fault)
    assert (fault.code, fault.value) == ("E202", text)


def test_a_number_too_large_to_hold():
    """A number beyond the range of doubles is refused, not taken as infinite."""
    assert as_number("1e400", from_text=True) == Fault(code="E212", value="1e400")


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("1,6", "1.6"),
        ("-0,5", "-0.5"),
        ("1.6 mm", "1.6"),
        ("1.6mm", "1.6"),
        ("1,6 mm", "1.6"),
        ("160 N·m", "160"),
        ("3 arcmin", "3"),
        ("30°", "30"),
        ("5%", "5"),
        ("5 %", "5"),
        ("±0.02", "0.02"),
        ("± 0,02 mm", "0.02"),
        ("\u00a01.6", "1.6"),
        ("1.6\u00a0mm", "1.6"),
        ("\u22120.02", "-0.02"),
        ("\u20130.02", "-0.02"),
        ("１６", "16"),
        ("１．６", "1.6"),
        ("1 600", "1600"),
        ("1\u202f600", "1600"),
        ("1'600.5", "1600.5"),
        ("1.5e-3 m", "1.5e-3"),
        ("1.6", "1.6"),
        (" 1.6", "1.6"),
    ],
)
def test_what_was_probably_meant(text, meant):
    """A comma, a unit, a typographic minus, a stray space or wide digits get the number as a suggestion."""
    assert suggested_number(text) == meant


@pytest.mark.parametrize(
    "text", ["", " ", "n/a", "x", "-", ".", "1/4", "+0.01/-0.02", "1.2.3", "1,234,567", "1.234,5", "1-2", "ca. 5", "mm"]
)
def test_where_nothing_is_suggested(text):
    """Where more than one number could be meant, or none, nothing is suggested."""
    assert suggested_number(text) == ""


@pytest.mark.parametrize("text", ["3 µm", "3 μm", "5 N/mm²", "2 kg/m³", "3′", '0.5"'])
def test_units_with_signs_are_cut_off_too(text):
    """A number with any unit of the template behind it is suggested without it."""
    assert suggested_number(text) == text[:3].split(" ")[0].strip("′")


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
    assert as_text("x" * 201, 200) == Fault(code="E212", value="x" * 201)
