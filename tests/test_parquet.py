"""Parquet: values as stored at their own rows; whatever is damaged is refused."""

import datetime
import io

import polars as pl
import pytest

from flexlash.submission.reading.parquet import read_parquet
from flexlash.submission.reading.refusal import Refusal


def _bytes(frame):
    buffer = io.BytesIO()
    frame.write_parquet(buffer)
    return buffer.getvalue()


def _rows(frame):
    (sheet,) = read_parquet(_bytes(frame)).sheets
    assert sheet.name == "Variants"
    return sheet.rows


def test_types_and_addresses_are_kept():
    """Parquet has its header in row 1, each row's own number after gaps, and values as stored."""
    day = datetime.date(2026, 4, 1)
    frame = pl.DataFrame(
        {
            "variant": ["A", None, "C"],
            "count": [1, None, 3],
            "wall": [1.6, None, None],
            "flag": [True, None, False],
            "day": [day, None, None],
            "empty": [None, None, None],
        }
    )
    assert _rows(frame) == {
        1: {1: "variant", 2: "count", 3: "wall", 4: "flag", 5: "day", 6: "empty"},
        2: {1: "A", 2: 1, 3: 1.6, 4: True, 5: day},
        4: {1: "C", 2: 3, 4: False},
    }


def test_what_is_no_number_is_kept():
    """Not-a-number and infinity come through Parquet as they are, for validation to refuse."""
    rows = _rows(pl.DataFrame({"a": [float("nan"), float("inf"), -float("inf")]}))
    assert repr(rows) == "{1: {1: 'a'}, 2: {1: nan}, 3: {1: inf}, 4: {1: -inf}}"


def test_decimal_numbers_are_numbers():
    """Decimal numbers of a database are numbers."""
    assert _rows(pl.DataFrame({"a": ["1.60"]}).with_columns(pl.col("a").cast(pl.Decimal(10, 2)))) == {
        1: {1: "a"},
        2: {1: 1.6},
    }


def test_no_rows():
    """A Parquet file without rows still has its header."""
    assert _rows(pl.DataFrame({"a": [], "b": []})) == {1: {1: "a", 2: "b"}}


DAMAGED = {
    "a lost end": _bytes(pl.DataFrame({"a": [1, 2, 3]}))[:-20],
    "the mark alone": b"PAR1",
    "marks around nothing": b"PAR1" + b"\0" * 20 + b"PAR1",
    "a footer longer than the file": b"PAR1" + b"\xff\xff\xff\x7f" + b"PAR1",
    "text behind the mark": b"PAR1, a table\n1,2\n",
}


@pytest.mark.parametrize("what", DAMAGED)
def test_what_is_damaged_is_refused(what):
    """A Parquet file that cannot be read is damaged."""
    with pytest.raises(Refusal) as caught:
        read_parquet(DAMAGED[what])
    assert caught.value.code == "E102"
