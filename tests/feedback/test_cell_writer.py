"""A value written to a workbook is the value that is read from it."""

from __future__ import annotations

import datetime
import io
import math

import pytest
import xlsxwriter
from grids import for_each

from flexlash.feedback.template.cell_writer import DATE_FORMATS, CellWriter, Formula, writable
from flexlash.reading.raw import ErrorCell, Unstored
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.xlsx import read_workbook

moment = datetime.datetime.fromisoformat
SAME = (
    "x", " a ", "a\nb", "\x01\x1f", "=1+1", "{=1}", "http://x.example", "'", "+1", "x" * 32_767, "𝕏",
    0, 1, -7, 10**15, 0.1 + 0.2, 1 / 3, 5e-324, 1e300, -0.5, True, False, moment("2026-04-01"),
    moment("2026-04-01T13:30:15"), moment("1900-02-01"), moment("9999-12-31"), datetime.time(12, 30, 5),
    datetime.timedelta(hours=30, minutes=1), ErrorCell("#REF!"), ErrorCell("#N/A"), ErrorCell("#SPILL!"), Unstored(),
)  # fmt: skip
"""Values that are read as what they were."""

CHANGED = (
    ("x" * 40_000, "x" * 32_767),
    (math.inf, "inf"),
    (math.nan, "nan"),
    (2**60, float(2**60)),
    (10**400, str(10**400)),
    (datetime.date(2026, 4, 1), moment("2026-04-01")),
    (datetime.date(1850, 1, 1), "1850-01-01"),
    (moment("2026-04-01T13:30:15+02:00"), "2026-04-01T13:30:15+02:00"),
    (["a", 1], "['a', 1]"),
    (Formula(text="=0.8*2", result=1.6), 1.6),
    (Formula(text="=NA()"), Unstored()),
)
"""Values without a form in a workbook, and what they are read as."""


def _through_a_workbook(value):
    """Return a value as it is read after it was written."""
    buffer = io.BytesIO()
    book = xlsxwriter.Workbook(buffer, {"in_memory": True})
    sheet = book.add_worksheet("S")
    dates = {kind: book.add_format({"num_format": form}) for kind, form in DATE_FORMATS.items()}
    CellWriter(sheet, dates).write(0, 0, value, book.add_format())
    book.close()
    (read,) = read_workbook(buffer.getvalue(), ReadingLimits()).sheets
    return read.rows[1][1]


@pytest.mark.slow
@for_each("value", SAME)
def test_what_is_written_is_read(value):
    """Texts stay texts, numbers keep every digit and their kind, times and errors stay what they are."""
    read = _through_a_workbook(value)
    assert (type(read), read) == (type(value), value)


@pytest.mark.parametrize(("value", "expected"), CHANGED, ids=lambda value: repr(value)[:30])
def test_what_a_workbook_cannot_hold(value, expected):
    """What no cell can hold becomes a text that says it, never another number."""
    assert _through_a_workbook(value) == expected


@for_each("value", SAME[:-2])
def test_the_same_value_is_writable_as_it_is(value):
    """A value that a cell can hold is not touched."""
    assert writable(value) is value


def test_nothing_is_written_for_nothing():
    """None leaves the cell alone."""
    with pytest.raises(KeyError):
        _through_a_workbook(None)
