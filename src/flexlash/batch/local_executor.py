"""Work done by processes of this machine, each of which reads files within limits of its own."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass

from flexlash.batch.executor import Executor, Told, Work
from flexlash.reading.inside_limits import Fault, prepare
from flexlash.reading.libraries import ChangedLibrary
from flexlash.reading.limited_process import ProcessFaultError
from flexlash.workers import FEW_THREADS, Workers

__all__ = ["local_executor", "worked"]


@dataclass(frozen=True, kw_only=True)
class _LocalExecutor:
    """Processes of this machine."""

    workers: int
    processes: Workers

    def submit(self, work: Work, data: bytes, told: Told | None = None) -> Future[bytes]:
        """Return what will be the answer; threads may ask side by side."""
        return self.processes.submit(worked, work, data, told=told)


@contextmanager
def local_executor(workers: int, tries: int = 3, *, warm: bool = False) -> Iterator[Executor]:
    """Give an executor of so many processes, which have ended when it is left.

    A piece of work may cost so many of them (`tries`). A `warm` process has loaded all that answers need before it
    takes up the first. Raises WorkerLostError where no process can be started.
    """
    with Workers(workers, _prepare_warm if warm else prepare, FEW_THREADS, tries=tries) as processes:
        yield _LocalExecutor(workers=workers, processes=processes)


def worked(work: Work, data: bytes) -> bytes:
    """Return the answer of a piece of work; what it raises is told in words, which every process understands."""
    try:
        return work(data)
    except (ProcessFaultError, ChangedLibrary):
        raise
    except BaseException as exception:  # noqa: BLE001
        fault = Fault.of(exception)
        raise ProcessFaultError(f"{fault.kind} in a worker process\n{fault.trace}") from None


def _prepare_warm() -> None:
    """Make a process one that can be limited, and load the rest of what answers need."""
    prepare()
    from flexlash.batch import page_answer  # noqa: F401
    from flexlash.report import workbook  # noqa: F401
