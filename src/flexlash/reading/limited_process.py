"""Asking the limited process: bytes go in, what they hold comes back, whatever they do to their reader."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable
from concurrent.futures import TimeoutError as TookTooLong
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import current_process
from typing import Any, TypeVar

from pebble import ProcessExpired, ProcessPool

from flexlash.reading.inside_limits import Fault, carried_out, gone_on, kept, prepare
from flexlash.reading.libraries import ChangedLibrary
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.workers import end, started

__all__ = ["ProcessFaultError", "ask", "begin"]

Result = TypeVar("Result")

_VARIABLES = {"POLARS_MAX_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "RUST_BACKTRACE": "0"}
"""Each thread reserves memory, which the process has little of."""

_ANSWERING = 30
"""Seconds beyond its time after which a process that gives no answer never will: it died while it gave one."""

_DAEMON = (
    "flexlash reads files in a process of its own, which a daemonic process, such as one of multiprocessing.Pool, may "
    "not start; call it from concurrent.futures.ProcessPoolExecutor instead"
)

_ONE_AT_A_TIME = threading.Lock()

_POOLS: dict[int, ProcessPool] = {}
"""The limited process of this one, by this one's number: a copy of this process has none of its threads."""


class ProcessFaultError(RuntimeError):
    """What the limited process was to do has a fault of the program, not of the file."""


def begin() -> ProcessPool:
    """Have the limited process start, if there is none, and load its libraries while this one does something else.

    Raises ProcessFaultError in a process that may start none.
    """
    number = os.getpid()
    if number not in _POOLS:
        if current_process().daemon:
            raise ProcessFaultError(_DAEMON)
        _POOLS.clear()
        _POOLS[number] = started(1, prepare, _VARIABLES)
    return _POOLS[number]


def ask(
    task: Callable[..., Result],
    limits: ReadingLimits,
    *arguments: object,
    then: Callable[[Result], Result] | None = None,
) -> Result:
    """Return a task of these arguments, done in the limited process; `then` goes on there with what it has found.

    What `then` does has no limits: it must grow with what was found to be sound alone.
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
    """Return what the limited process answers, or what it died of."""
    try:
        start = kept if then else carried_out
        future = begin().schedule(start, (task, limits, arguments), timeout=limits.seconds)
        answer: Any = future.result(limits.seconds + _ANSWERING)
        return begin().schedule(gone_on, (then,)).result() if then and answer is None else answer  # type: ignore[no-any-return]
    except TookTooLong:
        _abandon()
        return limits.exceeded("seconds")
    except ProcessExpired as lost:
        # Another process is being started in its place, which would complain if this one ended meanwhile.
        _abandon()
        processor_time = lost.exitcode == -getattr(signal, "SIGXCPU", 0)
        return limits.exceeded("processor_seconds") if processor_time else Refusal("E118")
    except (BrokenProcessPool, OSError) as fault:
        _abandon()
        raise ProcessFaultError(f"the process that reads files cannot be started: {fault}") from fault
    except BaseException:
        _abandon()
        raise


def _abandon() -> None:
    """End the limited process, whatever it is doing; the next request starts another."""
    if pool := _POOLS.pop(os.getpid(), None):
        end(pool)
