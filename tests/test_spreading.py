"""Rows spread here or elsewhere: the same numbers, whatever becomes of the workers."""

from __future__ import annotations

import pytest

from flexlash.tolerance import spreading
from flexlash.tolerance.limits import Limits
from flexlash.tolerance.spreading import Draws, spread_batch, spread_rows


def double(dimensions):
    """Return twice the torque, as a model that a worker can import."""
    return 2 * dimensions["torque"]


DRAWS = Draws(method="sobol", samples=256, seed=3)
TASKS = [(double, {"torque": 1.0 + n}, {"torque": Limits(low=0.5 + n, high=1.5 + n)}, 2.5) for n in range(60)]


def _means(spreads):
    return [spread.statistics["mean"] for spread in spreads]


@pytest.fixture
def here():
    """Return the mean of every row, computed in this process."""
    return _means(spread_rows(TASKS, DRAWS, coverage=0.95, jobs=1))


def test_few_rows_start_no_worker(here, monkeypatch):
    """Where rows are fewer than a worker is worth, none is started whatever jobs says."""
    monkeypatch.setattr(spreading, "_in_workers", None)
    assert _means(spread_rows(TASKS, DRAWS, coverage=0.95, jobs=8)) == here


def test_a_batch_is_what_its_rows_are(here):
    """A worker's batch gives each row the numbers that it has here, and draws its points once."""
    spreading._DRAWN.clear()
    assert _means(spread_batch(TASKS[:7], DRAWS, 0.95)) == here[:7]
    drawn = spreading._DRAWN[DRAWS]
    assert _means(spread_batch(TASKS[7:9], Draws("sobol", 256, 3), 0.95)) == here[7:9]
    assert spreading._DRAWN[DRAWS] is drawn


@pytest.mark.parametrize("fault", [spreading.BrokenProcessPool, OSError])
def test_rows_of_a_lost_worker_are_computed_here(here, monkeypatch, fault):
    """When workers cannot be started, or are lost on the way, the rows they leave are computed here."""

    def lose(tasks, draws, coverage, workers):  # noqa: ARG001
        yield spread_batch(tasks[:25], draws, coverage)
        raise fault

    monkeypatch.setattr(spreading, "WORTH_A_WORKER", 1)
    monkeypatch.setattr(spreading, "_in_workers", lose)
    assert _means(spread_rows(TASKS, DRAWS, coverage=0.95, jobs=2)) == here
