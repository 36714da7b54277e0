"""What a worker of Dask does: it hands each piece of work to processes of its own machine, which live as long as it.

Whatever a file does to its reader stops such a process alone: the worker of Dask neither has limits nor is lost, and no
piece of work that waits for it is blamed.
"""

from __future__ import annotations

import threading
import zlib
from concurrent.futures import CancelledError

from flexlash import __version__
from flexlash.batch.executor import Work, WorkerLostError
from flexlash.batch.local_executor import worked
from flexlash.reading.inside_limits import prepare
from flexlash.reading.libraries import ChangedLibrary
from flexlash.reading.limited_process import ProcessFaultError
from flexlash.workers import FEW_THREADS, Told, Workers

__all__ = ["OtherVersion", "begin_processes", "carried_out_here", "end_processes"]


class OtherVersion(Exception):
    """Another version of flexlash than the one that asks would give other numbers."""


_STARTING = threading.Lock()
_PROCESSES: list[Workers] = []
"""The processes of this worker, as many as it has threads."""

_ENDED = threading.Event()
"""Set once the worker ends: a piece of work that it takes up then would start others, which nobody ends."""


def _processes() -> Workers:
    """Return the processes of this worker, which the first piece of work starts."""
    from distributed import get_worker

    with _STARTING:
        if _ENDED.is_set():
            raise CancelledError
        if not _PROCESSES:
            _PROCESSES.append(Workers(get_worker().state.nthreads, prepare, FEW_THREADS))
        return _PROCESSES[0]


def begin_processes() -> None:
    """Let a worker in this process have processes, also after another has ended here."""
    _ENDED.clear()


def end_processes() -> None:
    """End the processes of a worker that ends before its own process does."""
    with _STARTING:
        _ENDED.set()
        while _PROCESSES:
            _PROCESSES.pop().close()


_MOST_TOLD = 2**18
"""Bytes of a message, made small, beyond which it is not told: the scheduler keeps the last thousand of a topic."""


def _teller(topic: str, piece: int) -> Told:
    """Return what hands the messages of a piece of work on to the one that asks, as events of this topic."""
    from distributed import get_worker

    worker = get_worker()

    def tell(message: bytes) -> None:
        small = zlib.compress(message, 1)
        if len(small) <= _MOST_TOLD:
            worker.log_event(topic, (piece, small))

    return tell


def carried_out_here(version: str, work: Work, data: bytes, topic: str = "", piece: int = 0) -> bytes | Exception:
    """Return the answer to a piece of work of this version of flexlash, or what it raises.

    What it tells meanwhile is told under a topic, if there is one, with its number.
    An exception is returned, since Dask would tell it in its own log and take it for one of its own.
    """
    if version != __version__:
        return OtherVersion(__version__)
    try:
        told = _teller(topic, piece) if topic else None
        return _processes().submit(worked, work, data, told=told).result()
    except (WorkerLostError, ProcessFaultError, ChangedLibrary, CancelledError) as fault:
        return fault
