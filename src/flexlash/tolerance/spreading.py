"""The spread of many rows, here or in worker processes: the same points for all, so the same numbers either way."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Literal, TypeAlias

from flexlash.columns import DIMENSIONS
from flexlash.tolerance.limits import Limits
from flexlash.tolerance.sampling import UnitPoints
from flexlash.tolerance.variation import Variation, variation_of

__all__ = ["Draws", "Task", "spread_rows"]

Task: TypeAlias = tuple[Callable[[Mapping[str, Any]], Any], Mapping[str, float], Mapping[str, Limits], float | None]
"""A row to spread: its backlash model, entered dimensions, limits of dimensions, and greatest backlash allowed."""

WORTH_A_WORKER = 300
"""Rows per worker below which starting it costs more than it saves."""

_ROWS_PER_BATCH = 25


@dataclass(frozen=True)
class Draws:
    """Which points are drawn; each process draws them for itself, the same ones."""

    method: Literal["sobol", "random"]
    samples: int | None
    seed: int

    @cached_property
    def points(self) -> UnitPoints:
        """The points, one coordinate per dimension that may have a tolerance."""
        return UnitPoints(list(DIMENSIONS), method=self.method, samples=self.samples, seed=self.seed)

    @property
    def size(self) -> int:
        """Points per row."""
        return self.points.size


_DRAWN: dict[Draws, UnitPoints] = {}
"""In a worker: the points that it has drawn."""


def spread_rows(tasks: Sequence[Task], draws: Draws, *, coverage: float, jobs: int) -> Iterator[Variation]:
    """Yield the spread of each row in order, by up to `jobs` processes where there are rows enough."""
    workers = min(jobs, len(tasks) // WORTH_A_WORKER)
    done = 0
    if workers > 1:
        try:
            for batch in _in_workers(tasks, draws, coverage, workers):
                yield from batch
                done += len(batch)
        except (BrokenProcessPool, OSError):
            # Where processes cannot be started, or one was stopped, the rest is computed here.
            pass
    for task in tasks[done:]:
        yield _spread(task, draws.points, coverage)


def _in_workers(tasks: Sequence[Task], draws: Draws, coverage: float, workers: int) -> Iterator[list[Variation]]:
    """Yield the spreads of batches of rows in order; processes are spawned, since threads may already run here."""
    batches = [tasks[start : start + _ROWS_PER_BATCH] for start in range(0, len(tasks), _ROWS_PER_BATCH)]
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(workers, mp_context=context) as pool:
        # A fresh record, since this one may hold its points already.
        fresh = Draws(draws.method, draws.samples, draws.seed)
        yield from pool.map(partial(spread_batch, draws=fresh, coverage=coverage), batches)


def spread_batch(batch: Sequence[Task], draws: Draws, coverage: float) -> list[Variation]:
    """Return the spreads of a batch; a process draws its points once."""
    if draws not in _DRAWN:
        _DRAWN[draws] = draws.points
    points = _DRAWN[draws]
    return [_spread(task, points, coverage) for task in batch]


def _spread(task: Task, points: UnitPoints, coverage: float) -> Variation:
    """Return the spread of one row."""
    model, nominal, limits, limit = task
    return variation_of(model, nominal, limits, points, limit=limit, coverage=coverage)
