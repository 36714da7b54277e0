"""Cells as JSON and back: nothing changes on the way between two processes."""

import datetime
import json
import math

import pytest
from grids import for_each
from hypothesis import given
from hypothesis import strategies as st

from flexlash.reading.cells_json import cells_from_json, cells_to_json
from flexlash.reading.raw import (
    CommaNumber,
    CsvDialect,
    DoubtfulNumber,
    ErrorCell,
    Percentage,
    RawSheet,
    Unstored,
)
from flexlash.reading.xlsx import Cells

VALUES = [
    "",
    "text",
    "moment",
    "Δ µ 𝄞 \x1b[31m\u202e\0\ud800",
    "=2+2",
    0,
    -7,
    10**18,
    0.1 + 0.2,
    5e-324,
    1.7976931348623157e308,
    math.inf,
    -math.inf,
    True,
    False,
    datetime.datetime(2026, 1, 2, 3, 4, 5, 678),  # noqa: DTZ001
    datetime.date(2026, 1, 2),
    datetime.time(3, 4, 5, 678),
    datetime.timedelta(days=-3, seconds=1.5),
    ErrorCell("#REF!"),
    Percentage(0.05),
    CommaNumber("1,6"),
    DoubtfulNumber("1.200"),
    ErrorCell(""),
    Unstored(),
]


def _through(value):
    """Return a value after its way as JSON."""
    cells = Cells(sheets=[RawSheet(name="S", rows={7: {3: value}})])
    return cells_from_json(json.loads(json.dumps(cells_to_json(cells)))).sheets[0].rows[7][3]


@for_each("value", VALUES)
def test_a_value_comes_through(value):
    """Every kind of value comes out as what went in, of the same type."""
    found = _through(value)
    assert (found, type(found)) == (value, type(value))


def test_not_a_number_comes_through():
    """Not-a-number, which Parquet can hold, comes through."""
    assert math.isnan(_through(float("nan")))


@pytest.mark.slow
@given(st.one_of(st.floats(allow_nan=False), st.text(), st.integers(), st.datetimes(), st.timedeltas(
    datetime.timedelta(-999), datetime.timedelta(999))))  # fmt: skip
def test_any_value_comes_through(value):
    """No number, text, date or duration changes on its way."""
    assert _through(value) == value


def test_what_has_no_kind_becomes_its_text():
    """A value of an unknown kind, such as a list in Parquet, comes through as text."""
    assert _through([1, 2]) == "[1, 2]"
    assert _through(b"x") == "b'x'"


def test_everything_about_a_file_comes_through():
    """Names, hidden and merged places, the order of sheets and rows, and the file's own words come through."""
    cells = Cells(
        sheets=[
            RawSheet(name="b", rows={2: {1: 1}, 9: {7: "x"}}, hidden_rows=frozenset({2}), merged=((1, 1, 2, 3),)),
            RawSheet(name="a", rows={}, hidden=True),
            RawSheet(
                name="c",
                rows={1: {1: "x"}},
                numbers_are_texts=True,
                dialect=CsvDialect(
                    delimiter=";",
                    encoding="UTF-8",
                    file="c.csv",
                    comma_number=(2, 3),
                    foreign_text=None,
                    longer=frozenset({4}),
                ),
            ),
        ],
        modified=datetime.datetime(2026, 1, 2, 3, 4, 5),  # noqa: DTZ001
        role="report",
        template_version="7",
    )
    assert cells_from_json(json.loads(json.dumps(cells_to_json(cells)))) == cells
