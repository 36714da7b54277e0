"""Parquet: values as stored at their own rows; whatever is damaged is refused."""

import base64
import datetime
import io
import struct
import tracemalloc

import polars as pl
import pytest

from flexlash.pipeline import check
from flexlash.reading.parquet import read_parquet
from flexlash.reading.parquet_file import check_file
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.thrift import read_struct


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


LIMITS = ReadingLimits()
FAR = "a date or time beyond the year 9999"
KINDS = {
    "lists": (pl.Series([[1, 2], None, []]), ["[1, 2]", None, "[]"]),
    "arrays": (pl.Series([[1, 2]], dtype=pl.Array(pl.Int64, 2)), ["[1, 2]"]),
    "records": (pl.Series([{"x": 1}, None]), ["{'x': 1}", None]),
    "bytes": (pl.Series([b"abc", b"\xff", None]), ["abc", "\\xff", None]),
    "categories": (pl.Series(["x", None], dtype=pl.Categorical), ["x", None]),
    "a list of entries": (pl.Series(["x", None], dtype=pl.Enum(["x"])), ["x", None]),
    "small whole numbers": (pl.Series([7, None], dtype=pl.UInt8), [7, None]),
    "whole numbers that are doubles": (pl.Series([2**53]), [2**53]),
    "whole numbers that are none": (pl.Series([2**64 - 1, None], dtype=pl.UInt64), [float(2**64), None]),
    "half as exact numbers": (pl.Series([1.5], dtype=pl.Float32), [1.5]),
    "long decimals": (pl.Series(["1.60"]).cast(pl.Decimal(38, 2)), [1.6]),
    "durations": (pl.Series([datetime.timedelta(days=3)]), [datetime.timedelta(days=3)]),
    "times": (pl.Series([datetime.time(3, 4)]), [datetime.time(3, 4)]),
    "nothing": (pl.Series([None], dtype=pl.Null), [None]),
    "a day far away": (pl.Series([2**30, 0]).cast(pl.Int32).cast(pl.Date), [FAR, datetime.date(1970, 1, 1)]),
    "a moment far away": (pl.Series([-(2**62)]).cast(pl.Datetime("us")), [FAR]),
    "a duration without end": (pl.Series([2**62]).cast(pl.Duration("ms")), [FAR]),
}


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_column_becomes_cells(kind):
    """What is neither number, text, truth value nor date becomes a text, and no column stops the reader."""
    series, values = KINDS[kind]
    rows = _rows(pl.DataFrame({"a": series}))
    assert [rows.get(number, {}).get(1) for number in range(2, len(values) + 2)] == values


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_column_ends_in_findings(kind, tmp_path):
    """A check of any kind of column ends in findings by name, in every column of the template."""
    series = KINDS[kind][0]
    keys = ("variant", "material", "torque_Nm", "cylinder_length_mm", "mean_radius_mm", "wall_thickness_mm")
    pl.DataFrame(dict.fromkeys(keys, series)).write_parquet(tmp_path / "a.parquet")
    assert check(tmp_path / "a.parquet").exit_code == 4


TOO_MUCH = {
    "columns": (pl.DataFrame({f"c{number}": [1] for number in range(257)}), "columns"),
    "rows": (pl.DataFrame({"a": pl.repeat(1, 3_000_000, eager=True)}), "table_rows"),
    "cells": (pl.DataFrame({f"c{n}": pl.repeat(1, 100_000, eager=True) for n in range(31)}), "table_cells"),
    "a long text": (pl.DataFrame({"a": ["x" * 32_768]}), "characters"),
    "a long list": (pl.DataFrame({"a": [list(range(20_000))]}), "characters"),
    "one text for many rows": (pl.DataFrame({"a": ["x" * 32_000] * 20_000}), "unpacked_mebibytes"),
}


@pytest.mark.slow
@pytest.mark.parametrize("what", TOO_MUCH)
def test_what_is_too_much_is_refused_by_its_limit(what):
    """A file that unpacks to more than the limits is refused by name before it costs the memory."""
    frame, setting = TOO_MUCH[what]
    data = _bytes(frame)
    with pytest.raises(Refusal) as caught:
        read_parquet(data)
    assert (caught.value.code, caught.value.facts["setting"]) == ("E110", setting)


def test_sizes_are_judged_before_anything_is_unpacked():
    """Numbers that unpack to more than a limit are refused by what the footer says."""
    data = _bytes(pl.DataFrame({"a": pl.int_range(0, 300_000, eager=True)}))
    assert check_file(data, LIMITS) is False
    with pytest.raises(Refusal) as caught:
        check_file(data, ReadingLimits(unpacked_mebibytes=1))
    assert caught.value.facts["setting"] == "unpacked_mebibytes"


def test_a_footer_without_end_is_not_taken_apart():
    """A footer of many megabytes, whatever it lists, is refused by its length."""
    footer = b"\x15\2" * (2 * 2**20)
    data = b"PAR1" + footer + struct.pack("<L", len(footer)) + b"PAR1"
    tracemalloc.start()
    with pytest.raises(Refusal) as caught:
        check_file(data, LIMITS)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert caught.value.facts["setting"] == "columns"
    assert peak < 2**20


WITH_CHECKSUMS = base64.b64decode(
    "UEFSMRUEFRQVFBWazvbfDTwVBBUAEgAAAQAAAEEBAAAAQhUAFRIVEhWqlZWSCBwVBBUQFQYVBhwAAAACAAAABAEBAwIVABUsFSwViayfhQ4cFQQVABUG"
    "FQYcAAAAAgAAAAQBAAAAAAAAiUAAAAAAAGiQQBUEGTw1ABgGc2NoZW1hFQQAFQwlAhgHdmFyaWFudCUATBwAAAAVCiUCGAl0b3JxdWVfTm0AFgQZHBks"
    "JgAcFQwZNQAGEBkYB3ZhcmlhbnQVABYEFoABFoABJkQmCCksFQQVABUCABUAFRAVAgA8FgQZBhkmAAQAAAAmABwVChklBgAZGAl0b3JxdWVfTm0VABYE"
    "Fl4WXiaIAUkcFQAVABUCADwpBhkmAAQAAAAW3gEWBCYIFt4BACggcGFycXVldC1jcHAtYXJyb3cgdmVyc2lvbiAyNi4wLjEZLBwAABwAAADiAAAAUEFS"
    "MQ=="
)
"""Two columns, variant with a dictionary and torque_Nm without, as Arrow 26 writes them with page checksums."""


def _pages(data):
    """Return where the content of each page of the sample begins and ends."""
    end = len(data) - 8 - int.from_bytes(data[-8:-4], "little")
    place, found = 4, []
    while place < end:
        head, content = read_struct(data, place)
        place = content + head[3]
        found.append((content, place))
    return found


@pytest.mark.slow
def test_pages_are_compared_with_their_checksums():
    """A page whose checksum is right is read; a single flipped bit in the content of any page is damage."""
    assert check_file(WITH_CHECKSUMS, LIMITS) is True
    (sheet,) = read_parquet(WITH_CHECKSUMS).sheets
    assert sheet.rows == {1: {1: "variant", 2: "torque_Nm"}, 2: {1: "A", 2: 800.0}, 3: {1: "B", 2: 1050.0}}
    pages = _pages(WITH_CHECKSUMS)
    assert len(pages) == 3
    flips = 0
    for start, end in pages:
        for place in range(start, end):
            for bit in range(8):
                flipped = bytearray(WITH_CHECKSUMS)
                flipped[place] ^= 1 << bit
                with pytest.raises(Refusal) as caught:
                    read_parquet(bytes(flipped))
                assert caught.value.code == "E102"
                flips += 1
    assert flips == 8 * 41


def test_a_wrong_checksum_is_damage():
    """A checksum that is not that of its page is damage as well, whichever of the two was altered."""
    written = b"\x9a\xce\xf6\xdf\x0d"
    assert WITH_CHECKSUMS.count(written) == 1
    for place in range(WITH_CHECKSUMS.index(written), WITH_CHECKSUMS.index(written) + len(written)):
        flipped = bytearray(WITH_CHECKSUMS)
        flipped[place] ^= 1
        with pytest.raises(Refusal):
            check_file(bytes(flipped), LIMITS)


def test_files_without_checksums_are_told_from_others():
    """What polars writes has none, which is no fault; a file without rows has none either."""
    assert check_file(_bytes(pl.DataFrame({"a": [1, 2]})), LIMITS) is False
    assert check_file(_bytes(pl.DataFrame({"a": []})), LIMITS) is False


def _code(data):
    """Return the code by which a file is refused, empty where it is not."""
    try:
        check_file(data, LIMITS)
    except Refusal as refusal:
        return refusal.code
    return ""


@pytest.mark.slow
def test_nonsense_is_damage():
    """No footer, however it was altered or cut, surprises the walk through it."""
    data = _bytes(pl.DataFrame({"a": [1, 2], "b": ["x", None]}))
    changed = [
        data[:place] + bytes([value]) + data[place + 1 :]
        for place in range(len(data))
        for value in (0, 0x7F, 0xFF, data[place] ^ 1)
    ]
    cut = [data[:place] for place in range(len(data))]
    assert {_code(one) for one in changed} <= {"", "E102", "E110"}
    assert {_code(one) for one in cut} == {"E102"}
