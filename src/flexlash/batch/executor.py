"""What carries work out: bytes go to a worker, bytes come back, whatever becomes of the worker."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Protocol

__all__ = ["Executor", "Work", "WorkerLostError"]

Work = Callable[[bytes], bytes]
"""A function of a module, so that it can travel by its name."""


class WorkerLostError(RuntimeError):
    """A piece of work lost every worker that took it up, or exceeded a limit of reading.

    `setting` names the limit that it exceeded, empty where none is known.
    """

    def __init__(self, message: str, setting: str = "") -> None:
        super().__init__(message)
        self.setting = setting


class Executor(Protocol):
    """Workers on this machine or on others. A worker that is lost costs its own piece of work, which is repeated."""

    @property
    def workers(self) -> int:
        """How many pieces of work are done side by side."""

    def submit(self, work: Work, data: bytes) -> Future[bytes]:
        """Return what will be the answer.

        It raises WorkerLostError, or the RuntimeError that says which fault of the program the work has.
        """
