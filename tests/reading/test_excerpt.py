"""Rows of a surveyed table as bytes, and back."""

import os
import random

import polars as pl
import pytest

from flexlash.pipeline import check
from flexlash.reading.excerpt import excerpt, is_excerpt
from flexlash.reading.read import Source, submission_of
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.survey import survey

LIMITS = ReadingLimits()
HEADER = "variant,material,torque_Nm,cylinder_length_mm,mean_radius_mm,wall_thickness_mm,notes\n"


def _csv(folder, count=12_000):
    draw = random.Random(1)  # noqa: S311
    rows = (
        f"V{number},20Cr2Ni4,{draw.uniform(1, 900):.2f},{draw.uniform(50, 200):.2f},{draw.uniform(40, 90):.3f},1.6,x\n"
        for number in range(count)
    )
    path = folder / "study.csv"
    path.write_text(HEADER + "".join(rows), encoding="utf-8")
    return path


def _parquet(folder):
    path = folder / "study.parquet"
    pl.read_csv(_csv(folder)).write_parquet(path, row_group_size=4000)
    return path


MADE = {"csv": _csv, "parquet": _parquet}


def _read(data):
    return submission_of(Source(name="study", data=data), LIMITS)


@pytest.mark.parametrize("kind", MADE)
def test_rows_stand_at_their_own_places(kind, tmp_path):
    """Any rows, in any order, stand under their true numbers with the cells of the whole file, and no others do."""
    path = MADE[kind](tmp_path)
    found = survey(path, LIMITS)
    whole = submission_of(Source.at(path, LIMITS), LIMITS)
    for rows in (range(2, 9), [11_999, 3, 5000, 3, 99_999, 0], range(3990, 4010), [12_001], []):
        submission = _read(excerpt(path, found, rows))
        cells = submission.sheets["Variants"].rows
        assert cells == {row: whole.sheets["Variants"].rows[row] for row in {1, *rows} if 1 <= row <= 12_001}
        facts = (submission.name, submission.kind, submission.sha256, submission.delimiter, submission.encoding)
        assert facts == (whole.name, whole.kind, whole.sha256, whole.delimiter, whole.encoding)


@pytest.mark.parametrize("kind", MADE)
def test_an_excerpt_is_small_and_the_same_bytes(kind, tmp_path):
    """5,000 rows take at most 0.3 MiB, and the same bytes each time."""
    path = MADE[kind](tmp_path)
    found = survey(path, LIMITS)
    data = excerpt(path, found, range(2, 5002))
    assert len(data) <= 0.3 * 2**20
    assert is_excerpt(data)
    assert data == excerpt(path, survey(path, LIMITS), range(2, 5002))


@pytest.mark.parametrize("kind", MADE)
def test_another_file_in_its_place_is_refused(kind, tmp_path):
    """What is read for an excerpt is what was surveyed: one byte that changed, of the same size and time, is told."""
    path = MADE[kind](tmp_path)
    found, data, status = survey(path, LIMITS), path.read_bytes(), path.stat()
    place = len(data) // 2
    for other in (data[:place] + bytes([data[place] ^ 1]) + data[place + 1 :], data + b"\n", data[:-1]):
        path.write_bytes(other)
        os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))
        with pytest.raises(Refusal) as refused:
            excerpt(path, found, range(2, 12_002))
        assert refused.value.code in {"E101", "E102"}
    path.write_bytes(data)
    assert excerpt(path, found, [12_001])
    path.unlink()
    with pytest.raises(OSError, match="No such file"):
        excerpt(path, found, [12_001])


def test_no_file_is_an_excerpt(tmp_path):
    """The bytes of an excerpt that lie in a file are no submission."""
    path = _csv(tmp_path)
    file = tmp_path / "made.csv"
    file.write_bytes(excerpt(path, survey(path, LIMITS), range(2, 20)))
    assert [found.code for found in check(file).findings] == ["E101"]


@pytest.mark.parametrize("kind", MADE)
def test_damaged_bytes_are_refused(kind, tmp_path):
    """Bytes that begin like an excerpt and are none are refused, and nothing else happens."""
    path = MADE[kind](tmp_path)
    data = excerpt(path, survey(path, LIMITS), range(2, 40))
    draw = random.Random(2)  # noqa: S311
    for _ in range(40):
        place = draw.randrange(18, len(data))
        broken = draw.choice([data[:place], data[:place] + draw.randbytes(3) + data[place + 3 :]])
        try:
            assert _read(broken).sheets.keys() == {"Variants"}
        except Refusal as refusal:
            assert refusal.code in {"E118", "E102", "E110"}  # noqa: PT017
