"""Many submissions while servers and workers are killed every few seconds: all end right, memory stays flat (R10)."""

from __future__ import annotations

import json
import os
import random
import signal
import sqlite3
import sys
import time
from collections import Counter
from contextlib import closing
from itertools import cycle

import pytest
from dispatching import hand_in, table
from service_process import MEASURED, STORE, children_of, served

from flexlash.service.store import Store
from flexlash.service.store_place import DATABASE

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform != "linux", reason="processes are listed in /proc")]

POISON = ("kills-1.csv", "kills-2.csv")


def _handed_in(folder, count):
    """Hand in so many submissions, among them poison, each unlike the others; return their IDs by name."""
    folder.mkdir()
    with Store(folder / STORE, serving=True) as store:
        names = [f"{number}.csv" for number in range(count - len(POISON))]
        names[2:2], names[7:7] = POISON[:1], POISON[1:]
        return {name: hand_in(store, table(700, 800, mark=f"-{name}"), name) for name in names}


def _found(folder, ids):
    """Return the end of each submission and the digests of its files, but of the texts that name its ID."""
    with Store(folder / STORE, serving=True) as store:
        return {
            name: (
                store.submission(id_).state,
                {role: file.sha256 for role, file in store.files(id_).items() if role != "reasons"},
            )
            for name, id_ in ids.items()
        }


def _undisturbed(folder, count, workers=2):
    ids = _handed_in(folder, count)
    server = served(folder, workers, "poisoned")
    assert server.wait(3600) == 0
    return _found(folder, ids)


def _disturbed(folder, count, *, kinds, seed, after=(1, 4)):
    """Compute submissions while servers and workers are stopped, each after some have ended; say what was stopped."""
    draw, stopped = random.Random(seed), Counter()  # noqa: S311
    ids = _handed_in(folder, count)
    server = served(folder, 2, "poisoned")
    for kind in cycle(kinds):
        enough = min(_ended(folder) + draw.randint(*after), count)
        while server.poll() is None and _ended(folder) < enough:
            time.sleep(0.02)
        time.sleep(draw.uniform(0, 1))
        if _ended(folder) == count:
            server.wait(60)
            return _found(folder, ids), stopped
        stopped[kind] += 1
        workers = children_of(server.pid)
        if kind == "worker" and workers:
            os.kill(draw.choice(workers), signal.SIGKILL)
        elif kind != "worker":
            server.send_signal(signal.SIGKILL if kind == "server" else signal.SIGTERM)
            server.wait(60)
            server = served(folder, 2, "poisoned")
    raise AssertionError


def _ended(folder):
    """Return how many submissions have ended, beside the server."""
    with closing(sqlite3.connect(f"file:{folder / STORE / DATABASE}?mode=ro", uri=True, timeout=30)) as database:
        return database.execute("SELECT count(*) FROM submission WHERE state IN ('done', 'rejected')").fetchone()[0]


def _checked(found, expected):
    """Whether the same came of all submissions: done but for poison, every file byte for byte, and nothing doubled."""
    states = {name: state for name, (state, _) in found.items()}
    assert {name for name, state in states.items() if state == "rejected"} == set(POISON)
    assert set(states.values()) == {"done", "rejected"}
    assert found == expected


def test_r10_all_end_right_though_servers_and_workers_are_killed(tmp_path):
    """Twelve files, two of them poison, with a worker, the server, and the server by SIGTERM stopped in turn."""
    expected = _undisturbed(tmp_path / "quiet", 12)
    found, stopped = _disturbed(tmp_path / "soak", 12, kinds=("worker", "server", "term"), seed=1)
    assert stopped["server"]
    _checked(found, expected)


@pytest.mark.long
def test_r10_five_hundred_end_right_and_memory_is_flat(tmp_path):
    """Five hundred files with kills every few seconds; undisturbed, memory after 200 and 480 is that after 20."""
    expected = _undisturbed(tmp_path / "quiet", 500)
    lines = (tmp_path / "quiet" / MEASURED).read_text().splitlines()
    measured = {line["done"] // 20: line for line in map(json.loads, lines)}
    for later in (10, 24):
        assert measured[later]["server"] <= 1.1 * measured[1]["server"]
        assert measured[later]["worker"] <= 1.1 * measured[1]["worker"]
    assert measured[24]["server"] <= 60
    kinds = ("worker", "server", "worker", "term")
    found, stopped = _disturbed(tmp_path / "soak", 500, kinds=kinds, seed=2, after=(4, 16))
    print(stopped)  # noqa: T201
    _checked(found, expected)
