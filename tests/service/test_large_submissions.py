"""A large table runs by a process of its own beside everything else, and loses nothing when that is killed."""

from __future__ import annotations

import sys
import time
from contextlib import nullcontext

import pytest
from dispatching import dispatching, ended, hand_in, opened, table
from here import HereExecutor

from flexlash.analysis.options import Options
from flexlash.batch.large_tables import LargeTable, large_table
from flexlash.batch.local_executor import local_executor
from flexlash.outputs.plan import Plan
from flexlash.reading.products import Companions
from flexlash.service.tasks import service_options

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL here")]

FEW = Options(samples=16, method="random")
ROWS = 3_000
TORQUES = (500 + number % 400 if number != 77 else "much" for number in range(ROWS))
LARGE = table(*TORQUES, limited=30)
_LEAST = 20_000
"""Bytes that make a table a large one in these tests."""


@pytest.fixture(scope="module")
def processes():
    """Return two real workers."""
    with local_executor(2, tries=1) as executor:
        yield executor


@pytest.fixture
def store(tmp_path, monkeypatch):
    """Return a store whose server takes a table of a few thousand rows for a large one."""
    monkeypatch.setattr("flexlash.service.dispatcher.large_tables", lambda _, paths: paths[0].stat().st_size > _LEAST)
    with opened(tmp_path / "store") as store:
        yield store


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """Return the files that the command writes for the large table, by how they are called."""
    folder = tmp_path_factory.mktemp("command")
    path = folder / "a.csv"
    path.write_bytes(LARGE)
    plan = Plan(inputs=[path])
    asked = LargeTable(
        path=path, ran=True, options=service_options(FEW), companions=Companions(),
        report=plan.claim(folder / "a-report.xlsx"), copy=plan.claim(folder / "a-checked.xlsx"),
    )  # fmt: skip
    _, written = large_table(asked, HereExecutor())
    return {path.name: path.read_bytes() for path in written.paths}


def _files(store, id_):
    roles = ("report", "results", "findings", "checked")
    return {one.name: store.blobs.read(one.sha256) for role, one in store.files(id_).items() if role in roles}


def _until_rows(store, id_, rows):
    end = time.monotonic() + 120
    while store.submission(id_).rows_done < rows:
        assert time.monotonic() < end
        assert not store.submission(id_).has_ended, store.submission(id_)
        time.sleep(0.02)


def test_small_ones_are_done_meanwhile_and_files_are_those_of_the_command(store, processes, expected):
    """Submissions that come in during a large table end before it, another large one waits; no byte differs."""
    with dispatching(store, lambda: nullcontext(processes), FEW):
        large = hand_in(store, LARGE)
        second = hand_in(store, table(*range(500, 1000), limited=30), "b.csv")
        _until_rows(store, large, 1000)
        small = ended(store, *(hand_in(store, table(800, mark=str(number)), "s.csv") for number in range(3)))
        assert {store.submission(large).state, store.submission(second).state} == {"working", "waiting"}
        assert [one.state for one in small] == ["done"] * 3
        found, other = ended(store, large, second, seconds=300)
    assert (found.state, found.exit_code, found.rows_done, found.rows) == ("done", 3, ROWS, ROWS)
    assert found.counts["errors"] == 1
    assert _files(store, large) == expected
    assert "page" in store.files(large)
    assert b"a-findings.csv lists them all" in store.blobs.read(store.files(large)["reasons"].sha256)
    assert other.state == "done"
    assert list((store.folder / "work").iterdir()) == []


@pytest.mark.long
def test_what_is_done_of_a_killed_one_is_taken_up(store, processes, expected):
    """When its process is killed, or the service stops, the chunks that are done are not done again."""
    with dispatching(store, lambda: nullcontext(processes), FEW) as dispatcher:
        large = hand_in(store, LARGE)
        _until_rows(store, large, 1000)
        dispatcher._large._driver.kill()
        while not store.submission(large).tries:
            time.sleep(0.02)
        begun = time.monotonic()
        _until_rows(store, large, 2000)
        dispatcher.stop(0.0)
        assert time.monotonic() - begun < 60
    assert (store.submission(large).state, store.submission(large).tries) == ("waiting", 1)
    assert len(list((store.folder / "work" / large).rglob("*.part"))) >= 2
    computed = []

    class Counting:
        workers = 2

        def submit(self, work, data, told=None):
            computed.append(work.__name__)
            return processes.submit(work, data, told)

    with dispatching(store, lambda: nullcontext(Counting()), FEW):
        (found,) = ended(store, large, seconds=300)
    assert found.state == "done"
    assert computed.count("compute_chunk") <= ROWS / 1000 - 2
    assert _files(store, large) == expected


def test_a_store_opens_again_with_a_large_table_underway(tmp_path):
    """What a large table has left in the store's folder keeps no server from starting, and goes with its submission."""
    with opened(tmp_path) as store:
        waiting = hand_in(store)
    for name in (waiting, "0" * 32):
        (tmp_path / "work" / name / "parts").mkdir(parents=True)
    with opened(tmp_path) as store, dispatching(store, stop=0.0):
        while (tmp_path / "work" / ("0" * 32)).exists():
            time.sleep(0.01)
        ended(store, waiting)
        while (tmp_path / "work" / waiting).exists():
            time.sleep(0.01)


def test_a_large_one_that_is_none_is_refused(store, processes):
    """What is no table after all is rejected with its reason; the store that has seen a large one opens again."""
    with dispatching(store, lambda: nullcontext(processes), FEW):
        (found,) = ended(store, hand_in(store, b"nothing of the kind\n" * 2000))
    assert (found.state, found.exit_code) == ("rejected", 4)
    assert found.reason.startswith("Variants!A1: rows 1 to 15 hold no header row")
    assert (store.folder / "work").is_dir()
    store.close()
    with opened(store.folder) as again:
        assert again.submission(found.id).state == "rejected"
