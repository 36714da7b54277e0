"""What carries work out: bytes go to a worker, bytes come back, whatever becomes of the worker."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Protocol

from flexlash.workers import Told, WorkerLostError

__all__ = ["ClusterError", "Executor", "Told", "Work", "WorkerLostError"]

Work = Callable[[bytes], bytes]
"""A function of a module, so that it can travel by its name."""


class ClusterError(OSError):
    """A scheduler or its workers cannot be reached or cannot do the work."""


class Executor(Protocol):
    """Workers on this machine or on others. A worker that is lost costs its own piece of work, which is repeated."""

    @property
    def workers(self) -> int:
        """How many pieces of work are done side by side."""

    def submit(self, work: Work, data: bytes, told: Told | None = None) -> Future[bytes]:
        """Return what will be the answer; `told` is called with what a worker tells meanwhile (`workers.tell`).

        It raises WorkerLostError, the ProcessFaultError that says which fault of the program the work has, or
        ChangedLibrary.
        """
