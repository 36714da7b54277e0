"""Work on many items in worker processes, or here where they cannot be started; the same results either way."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import TypeVar

__all__ = ["mapped"]

Item = TypeVar("Item")
Result = TypeVar("Result")


def mapped(function: Callable[[Item], Result], items: Sequence[Item], workers: int) -> Iterator[Result]:
    """Yield a function of each item in order, by worker processes when there is to be more than one.

    Processes are spawned, since threads may already run here. Where they cannot be started, or one was stopped, the
    rest is done here.
    """
    done = 0
    if workers > 1:
        try:
            with ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn")) as pool:
                for result in pool.map(function, items):
                    yield result
                    done += 1
        except (BrokenProcessPool, OSError):
            pass
    for item in items[done:]:
        yield function(item)
