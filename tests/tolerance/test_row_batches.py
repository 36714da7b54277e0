"""Rows spread here or elsewhere, alike ones together: the same bits, whatever becomes of the workers."""

from __future__ import annotations

import numpy as np
import pytest
from b3_160 import CUP, NOMINAL, TUBE
from worker_tasks import fail

from flexlash import workers
from flexlash.tolerance import row_batches as spreading
from flexlash.tolerance.dimension_limits import Limits
from flexlash.tolerance.row_batches import batch_statistics, spread_batch, spread_rows
from flexlash.tolerance.spread_statistics import SamplingPlan

ALIKE = {
    "wall_thickness": Limits(low=0.00155, high=0.00165),
    "disk_inner_radius": Limits(low=0.0398, high=0.0402),
    "poisson_ratio": Limits(low=0.28, high=0.32, distribution="uniform"),
}
BARE = {name: one for name, one in ALIKE.items() if name != "disk_inner_radius"}
WIDE_CUT = {"wall_thickness": Limits(low=0.00155, high=0.00165, distribution="truncated normal")}
NARROW_CUT = {"wall_thickness": Limits(low=0.00155, high=0.00165, distribution="truncated normal", sigma=2.0)}
SHIFTED = {"disk_inner_radius": Limits(low=0.0402, high=0.0402)}
LINES = SamplingPlan("line", None, 3)


def _row(model, limits, number=0, limit=None):
    return model, NOMINAL | {"torque": 700.0 + number}, limits, limit


TASKS = [
    *(_row(CUP, ALIKE, number, 1e-3 if number % 2 else None) for number in range(12)),
    *(_row(TUBE, BARE, number) for number in range(3)),
    _row(CUP, WIDE_CUT), _row(CUP, NARROW_CUT), _row(CUP, WIDE_CUT, 1),
    _row(CUP, ALIKE | SHIFTED), _row(CUP, {}), _row(CUP, SHIFTED), _row(CUP, {}, 1),
]  # fmt: skip
ORDERS = [list(range(len(TASKS))), list(range(len(TASKS)))[::-1], [*range(1, len(TASKS), 2), *range(0, len(TASKS), 2)]]


def told(spread):
    """Return everything that a spread tells, so that == compares it to the last bit."""
    statistics = {name: value for name, value in spread.numbers.items() if value is not None}
    return [statistics, spread.texts, spread.shares, spread.total_shares, spread.swings]


def _spread(tasks, draws=LINES, *, jobs=1):
    """Return what is told of every row in the order of the tasks."""
    found = dict(spread_rows(tasks, draws, jobs=jobs))
    assert sorted(found) == list(range(len(tasks)))
    return [told(found[place]) for place in range(len(tasks))]


@pytest.fixture(scope="module")
def here():
    """Return what is told of every row, computed in this process."""
    return _spread(TASKS)


def test_every_place_is_yielded_once_with_its_own_row(here):
    """Every row's place is yielded once, with the spread that the row has alone."""
    places = [place for place, _ in spread_rows(TASKS, LINES, jobs=1)]
    assert sorted(places) == list(range(len(TASKS)))
    for place, task in enumerate(TASKS):
        assert here[place] == told(batch_statistics([task], LINES)[0])


@pytest.mark.parametrize("method", ["line", "sobol", "random"])
@pytest.mark.parametrize("order", ORDERS[1:])
def test_the_order_of_rows_changes_no_bit(method, order):
    """Rows in another order, and so in other batches, keep every bit of their spread."""
    draws = SamplingPlan(method, 256, 3, cross_check=method == "line")
    before, after = _spread(TASKS, draws), _spread([TASKS[place] for place in order], draws)
    assert after == [before[place] for place in order]


def test_rows_alike_make_a_batch():
    """A batch holds the rows with the same model, dimensions and shapes of distribution, and no others."""
    batches = sorted(spreading._batches(TASKS))
    alone = [place for place in range(12, len(TASKS)) if [place] in batches]
    assert batches[0] == list(range(12))
    assert [12, 13, 14] in batches
    assert [15, 17] in batches
    assert [19, 21] in batches
    assert alone == [16, 18, 20]


def test_a_batch_has_no_more_rows_than_a_batch_may(monkeypatch, here):
    """Many rows alike are cut into batches, which changes no bit of them."""
    monkeypatch.setattr(spreading, "_ROWS_PER_BATCH", 5)
    assert [len(batch) for batch in spreading._batches(TASKS)][:3] == [5, 5, 2]
    assert _spread(TASKS) == here


def test_few_rows_start_no_worker(here, monkeypatch):
    """Where rows are fewer than a worker is worth, none is started whatever jobs says."""
    monkeypatch.setattr(workers, "started", None)
    assert _spread(TASKS, jobs=8) == here


def test_one_job_starts_no_worker(here, monkeypatch):
    """With one job the rows are computed here however many they are."""
    monkeypatch.setattr(workers, "started", None)
    monkeypatch.setattr(spreading, "WORTH_A_WORKER", 1)
    assert _spread(TASKS, jobs=1) == here


@pytest.mark.parametrize(
    "draws", [LINES, SamplingPlan("sobol", 256, 3), SamplingPlan("line", 64, 3, 0.9, cross_check=True)]
)
def test_worker_processes_give_the_same_bits(monkeypatch, draws):
    """Two worker processes give every row the bits that it has here."""
    monkeypatch.setattr(spreading, "WORTH_A_WORKER", 1)
    asked = []
    start = workers.started
    monkeypatch.setattr(workers, "started", lambda count: asked.append(count) or start(count))
    elsewhere = _spread(TASKS, draws, jobs=2)
    assert asked == [2]
    assert elsewhere == _spread(TASKS, draws, jobs=1)


def test_a_batch_is_what_its_rows_are(here):
    """A worker's batch gives each row the bits that it has here, and draws its points once."""
    spreading._DRAWN.clear()
    draws = SamplingPlan("sobol", 256, 3)
    first = spread_batch(TASKS[:7], draws)
    points = spreading._DRAWN[draws].sobol
    again = spread_batch(TASKS[7:9], SamplingPlan("sobol", 256, 3))
    assert spreading._DRAWN[draws].sobol is points
    assert [told(one) for one in (*first, *again)] == _spread(TASKS, draws)[:9]
    assert [told(one) for one in spread_batch(TASKS[:7], LINES)] == here[:7]


def test_workers_are_no_more_than_are_worth_it(monkeypatch):
    """There are as many workers as jobs allow and rows are worth, and no more."""
    asked = []

    def refuse(count):
        asked.append(count)
        raise OSError

    monkeypatch.setattr(workers, "started", refuse)
    monkeypatch.setattr(spreading, "WORTH_A_WORKER", 7)
    for jobs in (2, 3, 8):
        list(spread_rows(TASKS, SamplingPlan("sobol", 16, 0), jobs=jobs))
    assert asked == [2, 3, 3]


def test_any_other_fault_of_a_worker_is_told(monkeypatch):
    """A defect of the model in a worker is raised, not computed again."""
    monkeypatch.setattr(spreading, "WORTH_A_WORKER", 1)
    with pytest.raises(ValueError, match="the model failed"):
        list(spread_rows([(fail, *task[1:]) for task in TASKS], LINES, jobs=2))


def test_no_rows_give_nothing():
    """Without rows nothing is yielded and nothing is started."""
    assert list(spread_rows([], LINES, jobs=4)) == []


def test_limits_that_coincide_shift_their_row_alone(here):
    """In a batch the dimension whose limits coincide sits at its limit in that row and at its entry in the others."""
    exact, shifted, other = (here[place][0]["mean"] for place in (19, 20, 21))
    torques = np.array([700.0, 700.0, 701.0])
    radii = np.array([0.040, 0.0402, 0.040])
    expected = CUP(NOMINAL | {"torque": torques, "disk_inner_radius": radii})
    assert [exact, shifted, other] == expected.tolist()
