"""What carries work out: bytes go to a worker, bytes come back, whatever becomes of the worker."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from typing import Protocol

from flexlash.workers import WorkerLostError

__all__ = ["ClusterError", "Executor", "Work", "WorkerLostError", "in_order"]

Work = Callable[[bytes], bytes]
"""A function of a module, so that it can travel by its name."""


class ClusterError(OSError):
    """A scheduler or its workers cannot be reached or cannot do the work."""


class Executor(Protocol):
    """Workers on this machine or on others. A worker that is lost costs its own piece of work, which is repeated."""

    @property
    def workers(self) -> int:
        """How many pieces of work are done side by side."""

    def submit(self, work: Work, data: bytes) -> Future[bytes]:
        """Return what will be the answer.

        It raises WorkerLostError, the ProcessFaultError that says which fault of the program the work has, or
        ChangedLibrary.
        """


def in_order(executor: Executor, work: Work, items: Iterable[bytes], window: int) -> Iterator[Future[bytes]]:
    """Yield the finished future of each item in the order of the items, which are taken only as they are needed.

    At most `window` pieces of work are in the hands of the executor, or finished and not yet yielded. What is under way
    when the caller stops is cancelled, as far as it has not begun.
    """
    ahead: deque[Future[bytes]] = deque()
    coming = iter(items)
    try:
        while True:
            while len(ahead) < max(window, 1) and (data := next(coming, None)) is not None:
                ahead.append(executor.submit(work, data))
            if not ahead:
                return
            ahead[0].exception()
            yield ahead.popleft()
    finally:
        for future in ahead:
            future.cancel()
