"""Two thousand mutants of real workbooks: each is read or refused, soon, in little memory, and none reads otherwise."""

from __future__ import annotations

import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import mutants
import pytest

MUTANTS = 2_000
BATCH = 500
SECONDS = 20
"""Longest that one mutant may take."""

BATCH_SECONDS = 240
MEBIBYTES = 1_024
CHECKED_EVERY = 10
COMPARED_EVERY = 5

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="how much memory a process has is told otherwise there"),
]


def _batch(first: int) -> dict:
    """Return what a process of its own found in some mutants; it may neither die nor take too long."""
    wanted = [first, min(first + BATCH, MUTANTS), CHECKED_EVERY, COMPARED_EVERY]
    done = subprocess.run(
        [sys.executable, Path(mutants.__file__), *map(str, wanted)],
        capture_output=True,
        timeout=BATCH_SECONDS,
        check=False,
    )
    assert done.returncode == 0, (first, done.stderr[-2000:].decode())
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def batches():
    """Return what came of all mutants, batch by batch."""
    with ThreadPoolExecutor(2) as pool:
        return list(pool.map(_batch, range(0, MUTANTS, BATCH)))


@pytest.fixture(scope="module")
def found(batches):
    """Return what came of each mutant."""
    return [one for batch in batches for one in batch["found"]]


def test_every_mutant_is_read_or_refused(found):
    """A mutant ends in cells or in a refusal by name; none surprises the reader, and a whole check raises nothing."""
    assert [one["number"] for one in found] == list(range(MUTANTS))
    assert [one for one in found if one["code"] == "E118" or one["raised"]] == []


def test_many_mutants_of_either_kind_are_read(found):
    """The mutants do not all fail at the first look: some files read, and many of those with a sound archive."""
    files = [one["code"] for one in found if one["number"] < mutants.PARTS_FROM]
    parts = [one["code"] for one in found if one["number"] >= mutants.PARTS_FROM]
    assert files.count("") > 10
    assert parts.count("") > 150
    assert {"E101", "E102", "E105", "E110"} <= set(parts)


def test_no_mutant_takes_long_or_much(batches, found):
    """Each is done within seconds, and reading never needs the memory that it is allowed."""
    assert max(one["seconds"] for one in found) < SECONDS
    assert max(batch["memory"] for batch in batches) < MEBIBYTES


def test_nothing_is_warned_of(found):
    """No library's warning reaches whoever reads."""
    assert [one for one in found if one["warned"]] == []


def test_no_flipped_bit_alters_a_cell(found):
    """A damaged file is refused, or its cells are those of the sound one, to the last bit."""
    assert [one["number"] for one in found if one["altered"]] == []


def test_no_number_is_read_that_no_other_reader_sees(found):
    """Where a mutant's parts still read, each number is what one of two independent readers reads too."""
    assert sum(one["compared"] for one in found) > 30
    assert [one for one in found if one["alone"]] == []
