"""Work in worker processes: the same results in the same order, also when workers cannot be had."""

from __future__ import annotations

import os

import pytest

from flexlash import workers
from flexlash.workers import mapped
from worker_tasks import PoolHere, die_in_a_worker, square


def test_one_worker_is_this_process():
    """With one worker, or none, everything is done here."""
    for count in (0, 1):
        assert list(mapped(square, [1, 2, 3], count)) == [(1, os.getpid()), (4, os.getpid()), (9, os.getpid())]


def test_workers_keep_the_order_and_are_other_processes():
    """Two workers give the results in the order of the items, from other processes."""
    found = list(mapped(square, range(6), 2))
    assert [value for value, _ in found] == [0, 1, 4, 9, 16, 25]
    assert os.getpid() not in {process for _, process in found}


def test_the_work_of_a_killed_worker_is_done_here():
    """A worker that the system kills loses nothing: what is left is done here, each item once."""
    found = list(mapped(die_in_a_worker, [(number, os.getpid()) for number in range(5)], 2))
    assert [number for number, _ in found] == [0, 1, 2, 3, 4]
    assert found[2][1] == os.getpid()


@pytest.mark.parametrize("fault", [workers.BrokenProcessPool, OSError])
@pytest.mark.parametrize("delivered", [0, 2])
def test_where_processes_cannot_be_had_the_rest_is_done_here(monkeypatch, fault, delivered):
    """When the pool fails at once or on the way, the rest is done here."""

    class Pool(PoolHere):
        def map(self, function, items):
            yield from map(function, items[:delivered])
            raise fault

    monkeypatch.setattr(workers, "ProcessPoolExecutor", Pool)
    assert [value for value, _ in mapped(square, [0, 1, 2, 3], 2)] == [0, 1, 4, 9]


def test_nothing_asks_for_nothing():
    """No items give no results, whatever the workers."""
    assert list(mapped(square, [], 2)) == []
