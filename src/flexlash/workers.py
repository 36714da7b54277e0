"""Work in worker processes, which end with this one; one that dies costs its own piece of work, which is repeated."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.context import SpawnContext, SpawnProcess
from types import ModuleType
from typing import Any, TypeVar

from pebble import ProcessExpired, ProcessFuture, ProcessPool

__all__ = ["WorkerLostError", "end", "mapped", "started"]

Item = TypeVar("Item")
Result = TypeVar("Result")

_TRIES = 3
"""Times that a piece of work may lose its worker: the system may stop one process by chance, hardly three."""

_SAFE = {"PYTHONSAFEPATH": "1"}
"""No module of the working folder, where a stranger's files may lie, is imported while a worker starts."""


class WorkerLostError(RuntimeError):
    """A piece of work lost every worker that took it up."""


@contextmanager
def _environment(variables: Mapping[str, str]) -> Iterator[None]:
    """Set environment variables for the processes that are started meanwhile."""
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


class _Worker(SpawnProcess):
    """A process of its own that does not run the script of its user once more: it needs nothing of it."""

    variables: Mapping[str, str] = _SAFE

    def start(self) -> None:
        main = sys.modules["__main__"]
        sys.modules["__main__"] = ModuleType("__main__")
        try:
            with _environment(self.variables):
                super().start()
        finally:
            sys.modules["__main__"] = main


class _Context(SpawnContext):
    """How workers are made."""

    def __init__(self, variables: Mapping[str, str]) -> None:
        super().__init__()
        self.variables = variables

    def Process(self, *arguments: Any, **named: Any) -> _Worker:  # type: ignore[override]  # noqa: N802
        """Return a worker that is not started yet."""
        worker = _Worker(*arguments, **named)
        worker.variables = {**_SAFE, **self.variables}
        return worker


def started(
    workers: int, initializer: Callable[[], None] | None = None, variables: Mapping[str, str] | None = None
) -> ProcessPool:
    """Return a pool of workers, under these environment variables, that are started and load what they need.

    They are spawned, since threads may already run here. Raises BrokenProcessPool where no process can be started.
    """
    pool = ProcessPool(workers, initializer=initializer, context=_Context(variables or {}))
    # The process that keeps track of the pool's locks is started here.
    with _environment(_SAFE):
        pool.schedule(_nothing)
    return pool


def end(pool: ProcessPool) -> None:
    """End the workers of a pool, whatever they are doing."""
    pool.stop()  # type: ignore[no-untyped-call]
    pool.join()


def _nothing() -> None:
    """Do nothing: a worker that does so has started."""


def mapped(function: Callable[[Item], Result], items: Sequence[Item], workers: int) -> Iterator[Result]:
    """Yield a function of each item in order, by worker processes when there is to be more than one.

    Where no process can be started all is done here. Raises WorkerLostError when an item loses its worker three times,
    and what the function raises.
    """
    if workers <= 1:
        yield from map(function, items)
        return
    try:
        pool = started(workers)
    except (BrokenProcessPool, OSError):
        yield from map(function, items)
        return
    try:
        futures = [pool.schedule(function, (item,)) for item in items]
        for item, future in zip(items, futures, strict=True):
            yield _finished(pool, function, item, future)
    finally:
        end(pool)


def _finished(
    pool: ProcessPool,
    function: Callable[[Item], Result],
    item: Item,
    future: ProcessFuture[Result],
    tries: int = _TRIES,
) -> Result:
    """Return what a worker gives, asking another where one was lost."""
    try:
        return future.result()
    except ProcessExpired as lost:
        if tries == 1:
            raise WorkerLostError(f"a worker process was stopped {_TRIES} times (exit {lost.exitcode})") from lost
        return _finished(pool, function, item, pool.schedule(function, (item,)), tries - 1)
