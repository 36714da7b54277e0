"""The first pass over a large table: what it counts, where it finds rows again, and what it refuses."""

import hashlib
import pickle
from dataclasses import replace

import polars as pl
import pytest

from flexlash.reading import survey as surveys
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.survey import LARGE_ROWS, is_large, limits_of_survey, survey

LIMITS = ReadingLimits()
HEADER = "variant,material,torque_Nm,cylinder_length_mm,mean_radius_mm,wall_thickness_mm\n"


def _written(folder, text, name="study.csv"):
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def _rows(count, start=1):
    return "".join(f"V{number},20Cr2Ni4,800,160,80,1.6\n" for number in range(start, start + count))


@pytest.mark.parametrize("end", ["\n", "\r", "\r\n"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_a_text_is_large_from_its_rows_on(end, encoding, tmp_path):
    """More line ends than LARGE_ROWS make a text large, of whatever kind they are."""
    for count, large in ((LARGE_ROWS, False), (LARGE_ROWS + 1, True)):
        assert is_large(_written(tmp_path, (end * count).join("a;").encode(encoding)), LIMITS) == large


def test_a_parquet_file_is_large_by_its_footer(tmp_path):
    """The footer alone tells how many rows there are; a damaged one, a workbook and a picture are not large."""
    path = tmp_path / "study.parquet"
    for count, large in ((LARGE_ROWS, False), (LARGE_ROWS + 1, True)):
        pl.DataFrame({"a": range(count)}).write_parquet(path)
        assert is_large(path, LIMITS) == large
    data = path.read_bytes()
    for other in (
        data[:-9] + data[-8:],
        data[:100],
        b"PAR1",
        b"PK\x03\x04" + b"\n" * 99_999,
        b"\x89PNG" + b"\n" * 99_999,
    ):
        assert not is_large(_written(tmp_path, other, "other"), LIMITS)


def test_what_is_counted_and_where_it_stands(tmp_path, monkeypatch):
    """Blocks follow each other from the first byte behind the mark to the last, and chunks from the first row on."""
    monkeypatch.setattr(surveys, "_ROWS", 4)
    path = _written(tmp_path, b"\xef\xbb\xbf" + ("\n\n" + HEADER + _rows(5) + "\n\n" + _rows(6, 6)).encode())
    data = path.read_bytes()
    found = survey(path, LIMITS)
    assert (found.header_row, found.first, found.last, found.rows) == (3, 4, 16, 11)
    assert found.sha256 == hashlib.sha256(data).hexdigest()
    assert found.size == len(data)
    position, row = 3, 1
    for block in found.blocks:
        assert (block.start, block.first) == (position, row)
        position, row = position + block.size, row + block.rows
    assert (position, row) == (len(data), 17)
    assert [list(chunk) for chunk in found.chunks(6)] == [[4, 5, 6, 7, 8, 9], [10, 11, 12, 13, 14, 15], [16]]
    sent = pickle.dumps(found)
    assert pickle.loads(sent).whole == found.whole  # noqa: S301
    # Whoever receives it need load no such library.
    assert not any(name in sent for name in (b"numpy", b"polars"))


def test_no_row_is_one_excerpt(tmp_path):
    """A table without a row below its headers, or without headers, has one excerpt, which has no row."""
    for text in (HEADER, HEADER + "\n\n", "a,b\n1,2\n"):
        assert [len(chunk) for chunk in survey(_written(tmp_path, text), LIMITS).chunks(5)] == [0]


def test_a_file_of_any_size_has_time(tmp_path):
    """A survey may take a day and the memory of its file beyond that of reading."""
    limits = limits_of_survey(LIMITS, 3 * 2**30)
    assert (limits.seconds, limits.processor_seconds) == (86_400, 86_400)
    assert limits.memory_mebibytes == LIMITS.memory_mebibytes + 3 * 2**10 + 1
    path = _written(tmp_path, HEADER + _rows(30))
    assert survey(path, replace(LIMITS, table_rows=5, table_cells=5, file_mebibytes=1)).rows == 30


SMALL = replace(LIMITS, columns=8, characters=100)
HOSTILE = {
    "empty": (b"", "E101"),
    "a line without end": ("a,b\n" + "x" * 5_000_000, "E110"),
    "a line without end, wide": (("a,b\n" + "x" * 5_000_000).encode("utf-16"), "E110"),
    "a quote without end": (HEADER + '"' + _rows(100_000), "E102"),
    "a million columns": (HEADER + "," * 1_000_000, "E110"),
    "some columns too many": (HEADER + "A" + "," * 20 + "x\n", "E110"),
    "a text too long": (HEADER + "x" * 101 + ",20Cr2Ni4,800\n", "E110"),
    "a text too long for a reader": (HEADER + "x" * 1500 + ",20Cr2Ni4,800\n", "E110"),
    "a zero": (HEADER + _rows(900) + "\0", "E102"),
    "no text": ((HEADER + _rows(9)).encode() + b"\x81", "E107"),
    "half a letter": (b"\xff\xfe" + (HEADER + _rows(9)).encode("utf-16-le") + b"\0", "E107"),
    "another file": (b"%PDF-1.7\n" + b"\n" * 99, "E101"),
    "a workbook": (b"PK\x03\x04", "E101"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_what_no_table_is_ends_in_a_refusal(name, tmp_path):
    """Texts without end, too wide or without a meaning are refused, whatever their size."""
    content, code = HOSTILE[name]
    with pytest.raises(Refusal) as refused:
        survey(_written(tmp_path, content), SMALL)
    assert refused.value.code == code


def test_more_rows_than_addresses_are_refused(tmp_path, monkeypatch):
    """Rows are counted, blank ones as well, up to the last that has an address."""
    monkeypatch.setattr(surveys, "MOST_ROWS", 3000)
    assert survey(_written(tmp_path, HEADER + "\n" * 2990 + _rows(9)), LIMITS).last == 3000
    for text in (HEADER + "\n" * 5000, "\n" * 5000 + HEADER, HEADER + _rows(3000)):
        with pytest.raises(Refusal) as refused:
            survey(_written(tmp_path, text), LIMITS)
        assert refused.value.code == "E110"


def test_a_damaged_parquet_file_is_refused(tmp_path):
    """A changed byte in a page, or half a file, is refused before any of it is used."""
    path = tmp_path / "study.parquet"
    pl.DataFrame({"variant": [f"V{number}" for number in range(999)]}).write_parquet(path, row_group_size=100)
    data = path.read_bytes()
    for other in (data[: len(data) // 2], data[:40] + b"\xff" * 20 + data[60:], data[:-4] + b"PAR2"):
        path.write_bytes(other)
        with pytest.raises(Refusal) as refused:
            survey(path, LIMITS)
        assert refused.value.code in {"E102", "E110"}
