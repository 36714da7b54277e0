"""Asking the limited process: bytes go in, what they hold comes back, whatever they do to their reader."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from multiprocessing import current_process
from typing import TypeVar

from flexlash.reading.inside_limits import Fault, answered, is_prepared, prepare
from flexlash.reading.libraries import ChangedLibrary
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.workers import FEW_THREADS, StoppedError, Worker

__all__ = ["ProcessFaultError", "ask", "begin"]

Result = TypeVar("Result")

_DAEMON = (
    "flexlash reads files in a process of its own, which a daemonic process, such as one of multiprocessing.Pool, may "
    "not start; call it from concurrent.futures.ProcessPoolExecutor instead"
)

_TRIES = 3
"""Times that a limited process may be lost over one task."""

_ONE_AT_A_TIME = threading.Lock()

_WORKERS: dict[int, Worker] = {}
"""The limited process of this one, by this one's number: a copy of this process may not ask it."""


class ProcessFaultError(RuntimeError):
    """What the limited process was to do has a fault of the program, not of the file."""


def begin() -> Worker:
    """Have the limited process start, if there is none, and load its libraries while this one does something else.

    Raises ProcessFaultError in a process that may start none, and where the system starts none.
    """
    number = os.getpid()
    if number not in _WORKERS:
        if current_process().daemon:
            raise ProcessFaultError(_DAEMON)
        _WORKERS.clear()
        try:
            _WORKERS[number] = Worker(prepare, FEW_THREADS)
        except OSError as fault:
            raise ProcessFaultError(f"the process that reads files cannot be started: {fault}") from fault
    return _WORKERS[number]


def ask(
    task: Callable[..., Result],
    limits: ReadingLimits,
    *arguments: object,
    then: Callable[[Result], Result] | None = None,
) -> Result:
    """Return a task of these arguments, done in the limited process; `then` goes on there with what it has found.

    A worker of a batch is such a process itself: there it is done in place. What `then` does has no limits: it must
    grow with what was found to be sound alone.
    Raises Refusal when the task refuses its file, exceeds a limit or stops the process, ChangedLibrary when a library
    is to blame, ProcessFaultError when the task itself is at fault or no process can be started.
    """
    with _ONE_AT_A_TIME:
        answer = _answer(task, limits, arguments, then)
    if isinstance(answer, Refusal | ChangedLibrary):
        raise answer
    if isinstance(answer, Fault):
        raise ProcessFaultError(f"{answer.kind} in the limited process\n{answer.trace}")
    return answer


def _answer(
    task: Callable[..., Result],
    limits: ReadingLimits,
    arguments: tuple[object, ...],
    then: Callable[[Result], Result] | None,
) -> Result | Refusal | ChangedLibrary | Fault:
    """Return what the limited process answers, or what it died of; it may be stopped by chance, hardly three times."""
    if is_prepared():
        return answered(task, limits, arguments, then)  # type: ignore[no-any-return]
    for _ in range(_TRIES):
        worker = begin()
        try:
            return worker.asked(answered, task, limits, arguments, then)  # type: ignore[no-any-return]
        except StoppedError as stopped:
            _abandon()
            if stopped.setting:
                return limits.exceeded(stopped.setting)
        except BaseException:
            _abandon()
            raise
    return Refusal("E118")


def _abandon() -> None:
    """End the limited process, whatever it is doing; the next request starts another."""
    if worker := _WORKERS.pop(os.getpid(), None):
        worker.end()
