"""ISO 286 and ISO 2768 grades as deviations, against entries typed from the standards."""

import math

import pytest
from grids import for_each
from hypothesis import given, settings
from hypothesis import strategies as st

from flexlash.schema.tolerance_grades import deviations, is_grade

thorough = settings(deadline=None, max_examples=80, derandomize=True)

GRADES = [f"{letters}{number}" for letters in ("IT", "js", "JS", "h", "H") for number in range(5, 13)]


@for_each("text", [*GRADES, "2768-f", "2768-m", "2768-c", "2768-v"])
def test_grades_are_recognised(text):
    """IT, js, h and H from 5 to 12 and the four general tolerances are grades."""
    assert is_grade(text)


@pytest.mark.parametrize(
    "text", ["", "IT4", "IT13", "IT", "it7", "g6", "K7", "h 7", "h7 ", "H77", "7", "2768", "2768-x", "2768m", "2768-M"]
)
def test_other_texts_are_no_grades(text):
    """Grades outside the tables, other letters and other spellings are no grades."""
    assert not is_grade(text)


@pytest.mark.parametrize("text", ["IT4", "2768-x", "g6", ""])
def test_other_texts_have_no_deviations(text):
    """Asking for the deviations of what is no grade is refused by name."""
    with pytest.raises(ValueError, match="is not a tolerance grade") as refusal:
        deviations(text, 0.08)
    assert str(refusal.value) == f"{text!r} is not a tolerance grade"


@pytest.mark.parametrize(
    ("grade", "millimetres", "micrometres"),
    [
        ("IT5", 3, 4),
        ("IT6", 5, 8),
        ("IT7", 10, 15),
        ("IT7", 160, 40),
        ("IT8", 25, 33),
        ("IT9", 1.6, 25),
        ("IT9", 80, 74),
        ("IT10", 100, 140),
        ("IT11", 160, 250),
        ("IT12", 20, 210),
        ("IT12", 450, 630),
    ],
)
def test_widths_of_iso_286(grade, millimetres, micrometres):
    """The width of an IT grade is the standard's entry, shared evenly by ITn and jsn."""
    low, high = deviations(grade, millimetres / 1000)
    assert (low, high) == pytest.approx((-micrometres / 2 * 1e-6, micrometres / 2 * 1e-6), rel=1e-12)
    assert deviations(grade.replace("IT", "js"), millimetres / 1000) == (low, high)
    assert deviations(grade.replace("IT", "JS"), millimetres / 1000) == (low, high)


@pytest.mark.parametrize(
    ("grade", "expected"),
    [("h7", (-40e-6, 0.0)), ("H7", (0.0, 40e-6)), ("js7", (-20e-6, 20e-6)), ("IT7", (-20e-6, 20e-6))],
)
def test_letters_place_the_width(grade, expected):
    """On a diameter of 160 mm h7 takes the 40 µm downwards, H7 upwards, js7 and IT7 evenly."""
    assert deviations(grade, 0.160) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("grade", "millimetres", "half"),
    [
        ("2768-f", 1.6, 0.05),
        ("2768-m", 1.6, 0.1),
        ("2768-c", 1.6, 0.2),
        ("2768-v", 5, 0.5),
        ("2768-m", 80, 0.3),
        ("2768-m", 160, 0.5),
        ("2768-c", 160, 1.2),
        ("2768-v", 160, 2.5),
        ("2768-f", 2000, 0.5),
        ("2768-m", 4000, 2.0),
    ],
)
def test_general_tolerances_of_iso_2768(grade, millimetres, half):
    """A general tolerance is ± the standard's entry in mm."""
    assert deviations(grade, millimetres / 1000) == pytest.approx((-half / 1000, half / 1000), rel=1e-12)


@pytest.mark.parametrize(
    ("grade", "millimetres", "below", "above"),
    [("IT7", 80, 30, 35), ("IT7", 120, 35, 40), ("IT9", 3, 25, 30), ("IT12", 400, 570, 630)],
)
def test_sizes_are_over_one_and_up_to_the_next(grade, millimetres, below, above):
    """A size on a bound belongs to the row that ends there, a hair more to the next one."""
    for size, width in ((millimetres, below), (millimetres + 1e-6, above)):
        low, high = deviations(grade, size / 1000)
        assert high - low == pytest.approx(width * 1e-6, rel=1e-9)


@pytest.mark.parametrize(("millimetres", "half"), [(3, 0.1), (3.000001, 0.1), (6, 0.1), (6.000001, 0.2), (30, 0.2)])
def test_general_tolerances_are_over_one_and_up_to_the_next(millimetres, half):
    """A size on a bound of ISO 2768 belongs to the row that ends there."""
    assert deviations("2768-m", millimetres / 1000) == pytest.approx((-half / 1000, half / 1000), rel=1e-9)


@pytest.mark.parametrize("millimetres", [80, 120, 180, 0.5, 3])
def test_a_bound_in_metres_is_still_that_bound(millimetres):
    """A bound that was converted to metres and back by rounding arithmetic is still the bound."""
    once, twice = millimetres * 1e-3, 2 * (millimetres / 2 * 1e-3)
    assert deviations("2768-m", once) == deviations("2768-m", twice) == deviations("2768-m", millimetres / 1000)


@pytest.mark.parametrize(
    ("grade", "millimetres"),
    [
        ("IT7", 500.001),
        ("H12", 5000),
        ("2768-m", 0.4999),
        ("2768-f", 2001),
        ("2768-v", 2),
        ("2768-v", 3),
        ("2768-m", 4001),
    ],
)
def test_sizes_without_an_entry(grade, millimetres):
    """Beyond the tables, below 0.5 mm and in the standard's blank cells there are no deviations."""
    assert deviations(grade, millimetres / 1000) is None


def test_general_tolerance_begins_at_half_a_millimetre():
    """ISO 2768 holds from 0.5 mm on, that size included."""
    assert deviations("2768-m", 0.0005) == pytest.approx((-1e-4, 1e-4), rel=1e-12)


@thorough
@given(grade=st.sampled_from(GRADES), size=st.floats(1e-6, 0.5), factor=st.floats(1, 100))
def test_coarser_grades_and_larger_sizes_are_never_narrower(grade, size, factor):
    """A coarser grade, and a larger size in the same grade, never has a narrower width."""
    low, high = deviations(grade, size)
    letters = grade.rstrip("0123456789")
    number = int(grade[len(letters) :])
    assert low <= 0 <= high
    if number < 12:
        coarser = deviations(f"{letters}{number + 1}", size)
        assert coarser[1] - coarser[0] > high - low
    larger = deviations(grade, min(size * factor, 0.5))
    assert larger[1] - larger[0] >= (high - low) * (1 - 1e-12)
    assert math.isfinite(larger[1])
