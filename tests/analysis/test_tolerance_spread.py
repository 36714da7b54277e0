"""Rows spread here or in worker processes: the same bits, and no more workers than they are worth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from b3_160 import CUP, NOMINAL
from scipy.special import ndtri
from scipy.stats import norm
from toleranced import every_number, plan, row, statistics_of_row
from unlike_rows import LINES, ROWS
from worker_tasks import fail

from flexlash import workers
from flexlash.analysis import tolerance_spread
from flexlash.analysis.tolerance_spread import row_curves, row_statistics
from flexlash.tolerance.dimension_limits import Limits
from flexlash.tolerance.distribution_curves import CURVE_SCORES
from flexlash.tolerance.engine.line_precision import PROBABILITY_PRECISION


def _statistics(sampling=LINES, *, jobs=1):
    """Return what is told of every row in the order of the rows."""
    statistics = dict(row_statistics(ROWS, sampling, jobs))
    assert sorted(statistics) == list(range(len(ROWS)))
    return [every_number(statistics[index]) for index in range(len(ROWS))]


@pytest.fixture(scope="module")
def here():
    """Return what is told of every row, computed in this process."""
    return _statistics()


def test_every_index_is_yielded_once_with_its_own_row(here):
    """Every row's index is yielded once, with the statistics that the row has alone."""
    assert len([*row_statistics(ROWS, LINES, 1)]) == len(ROWS)
    assert here == [every_number(statistics_of_row(each, LINES)) for each in ROWS]


def test_no_worker_is_started_where_rows_or_jobs_are_few(here, monkeypatch):
    """Rows fewer than a worker is worth start none whatever jobs says, and one job none however many they are."""
    monkeypatch.setattr(workers, "Workers", None)
    assert _statistics(jobs=8) == here
    monkeypatch.setattr(tolerance_spread, "ROWS_PER_WORKER", 1)
    assert _statistics(jobs=1) == here


@pytest.mark.parametrize(
    "sampling", [LINES, plan("sobol", 256, 3), plan("line", 64, 3, coverage=0.9, cross_check=True)]
)
def test_worker_processes_give_the_same_bits(monkeypatch, sampling):
    """Two worker processes give every row the bits that it has here."""
    monkeypatch.setattr(tolerance_spread, "ROWS_PER_WORKER", 1)
    asked = []
    start = workers.Workers
    monkeypatch.setattr(workers, "Workers", lambda count: asked.append(count) or start(count))
    elsewhere = _statistics(sampling, jobs=2)
    assert asked == [2]
    assert elsewhere == _statistics(sampling)


def test_workers_are_no_more_than_are_worth_it(monkeypatch):
    """There are as many workers as jobs allow and rows are worth, and no more."""
    asked = []

    def refuse(count):
        asked.append(count)
        raise workers.WorkerLostError("none can be started")

    monkeypatch.setattr(workers, "Workers", refuse)
    monkeypatch.setattr(tolerance_spread, "ROWS_PER_WORKER", 7)
    for jobs in (2, 3, 8):
        list(row_statistics(ROWS, plan("sobol", 16), jobs))
    assert asked == [2, 3, 3]


def test_any_other_fault_of_a_worker_is_told(monkeypatch):
    """A defect of the model in a worker is raised, not computed again."""
    monkeypatch.setattr(tolerance_spread, "ROWS_PER_WORKER", 1)
    with pytest.raises(ValueError, match="the model failed"):
        list(row_statistics([replace(each, model=fail) for each in ROWS], LINES, 2))


def test_no_rows_give_nothing():
    """Without rows nothing is yielded and nothing is started."""
    assert list(row_statistics([], LINES, 4)) == []


def test_workers_and_neighbours_change_no_bit_of_a_curve():
    """A row's curve has the same bits in a worker process, alone, and among other rows."""
    limits = {
        "cylinder_length": Limits(low=0.1598, high=0.1602, distribution="uniform"),
        "wall_thickness": Limits(low=0.00155, high=0.00165),
    }
    sampling = plan("sobol", 2**17, 3)
    rows = [
        (each, statistics_of_row(each, sampling))
        for each in (row(CUP, NOMINAL, limits, 1.08e-3), row(CUP, NOMINAL, limits))
    ]
    here = list(row_curves(rows, sampling, 1))
    there = list(row_curves(rows[::-1], sampling, 2))[::-1]
    for one, other in zip(here, there, strict=True):
        for name, values in vars(one).items():
            assert np.array_equal(values, getattr(other, name))


@pytest.mark.slow
def test_the_share_over_a_limit_is_sharp_near_every_target():
    """With the limit where a target decides, the share over it is told to a twentieth of itself, as many more lines do.

    So the lines that are drawn settle a verdict by any target unless the share lies within a tenth of what it allows.
    """
    bounded = {name: replace(limits, distribution="uniform") for name, limits in ROWS[0].limits.items()}
    for toleranced in (ROWS[0], replace(ROWS[0], limits=bounded)):
        statistics = statistics_of_row(toleranced, plan(samples=1 << 12))
        (curve,) = row_curves([(toleranced, statistics)], plan(samples=1 << 12), 1)
        for target in (97.5, 99.0, 99.9, 99.99, 99.9999):
            limit = float(np.interp(ndtri(target / 100), CURVE_SCORES, curve.outputs))
            share, error = _over(replace(toleranced, upper_limit=limit), plan(bounds=(1 - target / 100,)))
            assert share == pytest.approx(1 - target / 100, rel=0.2)
            assert error <= 1.1 * PROBABILITY_PRECISION * share
            sure, sure_error = _over(replace(toleranced, upper_limit=limit), plan(samples=1 << 12, seed=1))
            assert abs(share - sure) <= 4 * (error + sure_error) + 1e-4 * sure


def _over(toleranced, sampling):
    """Return the share over the limit of a row, and its standard error on the normal scale as a share."""
    numbers = statistics_of_row(toleranced, sampling).numbers
    share, low, high = (numbers[f"probability_over_limit{end}"] for end in ("", "_low", "_high"))
    return share, float(norm.pdf(norm.isf(share)) * (norm.isf(low) - norm.isf(high)) / (2 * norm.isf(0.025)))
