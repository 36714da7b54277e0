"""When a file counts as whole and settled, at every length that a torn copy of it may have."""

import io
import os
import zipfile
from pathlib import Path

import polars as pl
import pytest

from flexlash.service.settling import Settling, is_whole

DATA = Path(__file__).parents[2] / "data"
_STEP = 512
"""Bytes by which copies grow: a sector."""


def torn(folder: Path, data: bytes) -> list[int]:
    """Return the lengths, sector by sector, at which a piece of a file is taken for the whole of it."""
    path = folder / "piece"
    lengths = []
    for length in range(0, len(data), _STEP):
        path.write_bytes(data[:length])
        if is_whole(path):
            lengths.append(length)
    path.write_bytes(data)
    return lengths if is_whole(path) else [*lengths, len(data)]


@pytest.mark.slow
def test_r11_no_piece_of_a_workbook_is_whole(tmp_path):
    """Of the studies in data/, torn at every sector, the last length alone is taken."""
    wrong = {path.name: found for path in sorted(DATA.glob("*.xlsx")) if (found := torn(tmp_path, path.read_bytes()))}
    assert wrong == {}


def test_r11_the_end_of_an_archive_inside_is_not_that_of_the_workbook(tmp_path):
    """A workbook that holds another, unpacked, has an end record in its middle: cut there, it is torn."""
    inner = (DATA / "catalogue-sizes.xlsx").read_bytes()
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as outer:
        outer.writestr("xl/embeddings/inside.xlsx", inner)
        outer.writestr("xl/workbook.xml", "<workbook/>")
    data = made.getvalue()
    cut = data.index(inner) + len(inner)
    (tmp_path / "a.xlsx").write_bytes(data[:cut])
    assert data[:cut].endswith(inner)
    assert not is_whole(tmp_path / "a.xlsx")
    (tmp_path / "a.xlsx").write_bytes(data)
    assert is_whole(tmp_path / "a.xlsx")


def test_a_workbook_with_a_comment_at_its_end_is_whole(tmp_path):
    """Some programs write one; it may even hold what looks like an end."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        archive.writestr("a", "b" * 5000)
        archive.comment = b"PK\x05\x06" * 20
    assert torn(tmp_path, made.getvalue()) == []


def test_r11_no_piece_of_a_parquet_file_is_whole(tmp_path):
    """Torn at every sector, also where PAR1 stands in a cell at the very cut, the last length alone is taken."""
    pl.DataFrame({"a": ["PAR1" * 200] * 50, "b": range(50)}).write_parquet(tmp_path / "a", compression="uncompressed")
    data = (tmp_path / "a").read_bytes()
    assert torn(tmp_path, data) == []
    at = data.index(b"PAR1PAR1") + 4
    (tmp_path / "b").write_bytes(data[:at])
    assert not is_whole(tmp_path / "b")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-16-le", "cp1252"])
@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r"])
def test_r11_a_text_that_stops_in_a_line_is_torn(tmp_path, encoding, line_end):
    """A text is whole behind a line end alone, in each of the encodings that say what they are."""
    text = line_end.join(["Variant,T", "ä,1", ""])
    data = text.encode(encoding)
    unit = 2 if encoding.startswith("utf-16") else 1
    (tmp_path / "a.csv").write_bytes(data)
    assert is_whole(tmp_path / "a.csv") == (encoding != "utf-16-le")
    (tmp_path / "a.csv").write_bytes(data[: -unit * len(line_end)])
    assert not is_whole(tmp_path / "a.csv")


@pytest.mark.parametrize("name", ["b3-160-study.xlsx", "README.md"])
def test_r11_a_copy_whose_size_was_set_beforehand_is_torn(tmp_path, name):
    """Some copies have their last size at once, and nothing but zeros where the rest is to come."""
    data = (DATA / name).read_bytes()
    (tmp_path / name).write_bytes(data[: len(data) // 2] + bytes(len(data) - len(data) // 2))
    assert not is_whole(tmp_path / name)


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04", b"PAR1", b"PAR1PAR1", b"\xd0\xcf\x11\xe0" + bytes(600) + b"\n"])
def test_r11_what_has_no_end_is_never_whole(tmp_path, data):
    """Nothing, a mere beginning, and a kind without a known end wait for a minute."""
    (tmp_path / "a").write_bytes(data)
    assert not is_whole(tmp_path / "a")


def settled_after(path: Path, moments: list[float], change=lambda _: None) -> float | None:
    """Return the first of the moments, in s, at which a file has settled that is changed before each look."""
    settling = Settling()
    for moment in moments:
        change(moment)
        if settling.settled(path, path.lstat(), moment):
            return moment
    return None


def test_settled_is_five_seconds_and_two_looks(tmp_path):
    """Neither a file seen for the first time, however late, nor one that is young is taken."""
    path = tmp_path / "a.csv"
    path.write_text("a\n")
    assert settled_after(path, [0, 2, 4, 6, 8]) == 6
    assert settled_after(path, [0, 4.9, 5.0]) == 5
    assert settled_after(path, [100, 200]) == 200
    assert settled_after(path, [100]) is None


def test_r11_torn_and_empty_files_wait_for_a_minute(tmp_path):
    """A copy that stopped may go on; after a minute it is judged as it is."""
    looks = list(range(0, 80, 2))
    for data in (b"", b"a,b\n1,2", b"PK\x03\x04 and so on"):
        (tmp_path / "a.csv").write_bytes(data)
        assert settled_after(tmp_path / "a.csv", looks) == 60


@pytest.mark.parametrize("change", ["size", "time", "number"])
def test_whatever_changes_a_file_starts_the_wait_anew(tmp_path, change):
    """Size, time and number on the disk each tell that somebody still writes."""
    path = tmp_path / "a.csv"
    path.write_text("a\n")

    def touch(moment: float) -> None:
        if moment != 4:
            return
        status = path.stat()
        if change == "size":
            path.write_text("a\nb\n")
        elif change == "number":
            (tmp_path / "b").write_text("b\n")
            (tmp_path / "b").replace(path)
        if change != "time":
            os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
        else:
            path.write_text("b\n")

    assert settled_after(path, list(range(0, 20, 2)), touch) == 10
