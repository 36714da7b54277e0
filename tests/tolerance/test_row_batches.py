"""Batches of rows alike: the same bits in any batch and in any order."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from b3_160 import CUP, NOMINAL
from toleranced import every_number, plan, statistics_of_row
from unlike_rows import LINES, ROWS

from flexlash.tolerance import row_batches
from flexlash.tolerance.row_batches import batch_statistics, batches_alike


def _statistics(rows, sampling=LINES):
    """Return what is told of every row, computed by batches."""
    told = {}
    for batch in batches_alike(rows):
        told |= zip(batch, map(every_number, batch_statistics([rows[index] for index in batch], sampling)), strict=True)
    assert sorted(told) == list(range(len(rows)))
    return [told[index] for index in range(len(rows))]


@pytest.fixture(scope="module")
def told():
    """Return what is told of every row."""
    return _statistics(ROWS)


def test_every_row_has_the_bits_that_it_has_alone(told):
    """Every row's statistics are, to the last bit, those that the row has alone."""
    assert told == [every_number(statistics_of_row(row, LINES)) for row in ROWS]


@pytest.mark.slow
@pytest.mark.parametrize("method", ["line", "sobol", "random"])
def test_the_order_of_rows_changes_no_bit(method):
    """Rows in another order, and so in other batches, keep every bit of their statistics."""
    sampling = plan(method, 256, 3, cross_check=method == "line")
    before = _statistics(ROWS, sampling)
    for order in ([*range(len(ROWS))][::-1], [*range(1, len(ROWS), 2), *range(0, len(ROWS), 2)]):
        after = _statistics([ROWS[index] for index in order], sampling)
        assert after == [before[index] for index in order], order


def test_rows_alike_make_a_batch():
    """A batch holds the rows with the same model, dimensions and shapes of distribution, and no others."""
    batches = sorted(batches_alike(ROWS))
    alone = [index for index in range(12, len(ROWS)) if [index] in batches]
    assert batches[0] == list(range(12))
    assert [12, 13, 14] in batches
    assert [15, 17] in batches
    assert [19, 21] in batches
    assert alone == [16, 18, 20]


def test_a_batch_has_no_more_rows_than_a_batch_may(monkeypatch, told):
    """Many rows alike are cut into batches, which changes no bit of them."""
    monkeypatch.setattr(row_batches, "_ROWS_PER_BATCH", 5)
    assert [len(batch) for batch in batches_alike(ROWS)][:3] == [5, 5, 2]
    assert _statistics(ROWS) == told


def test_equal_plans_draw_their_points_once():
    """The points of a plan are drawn once a process, for every plan equal to it."""
    assert plan("sobol", 256, 3).points("sobol") is plan("sobol", 256, 3).points("sobol")
    assert plan("sobol", 256, 3).points("sobol") is not plan("sobol", 256, 4).points("sobol")
    assert plan("line", 64, 3).points("sobol").size == 2**15
    assert plan("sobol", 256, 3).points("random").size == 2**17


def test_no_rows_give_nothing():
    """Without rows there is no batch."""
    assert list(batches_alike([])) == []


def test_limits_that_coincide_shift_their_row_alone(told):
    """In a batch the dimension whose limits coincide sits at its limit in that row and at its entry in the others."""
    exact, shifted, other = (told[index][0]["mean"] for index in (19, 20, 21))
    torques = np.array([700.0, 700.0, 701.0])
    radii = np.array([0.040, 0.0402, 0.040])
    expected = CUP(NOMINAL | {"torque": torques, "disk_inner_radius": radii})
    assert [exact, shifted, other] == expected.tolist()


@pytest.mark.slow
@pytest.mark.parametrize("method", ["line", "sobol"])
def test_without_shares_all_else_keeps_its_bits(method):
    """Where nobody asks which dimension causes how much, every other number is the same to the last bit."""
    sampling = plan(method, 256, 3)
    for row in ROWS[::3]:
        whole, bare = statistics_of_row(row, sampling), statistics_of_row(row, replace(sampling, shares=False))
        assert bare.shares == bare.total_shares == {}
        numbers = {name: value for name, value in whole.numbers.items() if not name.startswith("main_contributor")}
        assert [bare.numbers, bare.texts, bare.swings] == [numbers, whole.texts, whole.swings]
