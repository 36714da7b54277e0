"""A submission as a task for a worker, with the options and limits that hold for all submissions of a service."""

from __future__ import annotations

from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path

from flexlash.analysis.options import Options
from flexlash.batch.answer import Answer, Task
from flexlash.batch.ended import fault_of, refused_answer
from flexlash.batch.executor import WorkerLostError
from flexlash.reading.gate import read_bytes
from flexlash.reading.libraries import ChangedLibrary
from flexlash.reading.limited_process import ProcessFaultError
from flexlash.reading.products import Companions
from flexlash.reading.read import Source
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.exit_codes import ExitCode

__all__ = ["answer_of", "check_task", "run_task", "service_options", "submitted"]

_SECONDS = 20
"""Seconds that reading may take: a file that hangs its reader keeps a worker from all others for so long."""

_LOCK = "~$"
"""How the name of a file begins by which Excel marks a workbook as open."""


def service_options(options: Options) -> Options:
    """Return options as the service computes with them: nothing of one place or one caller, and its own limits.

    On these its digest of options depends (`manifest.options_digest(service_options(options), {}, marked=True)`).
    """
    limits = options.limits
    limits = replace(
        limits,
        parquet_mebibytes=min(limits.parquet_mebibytes, limits.file_mebibytes),
        seconds=min(limits.seconds, _SECONDS),
    )
    return options.without_tables(jobs=1, given=(), marked_copy=None, progress=None, limits=limits)


def run_task(name: str, data: bytes, options: Options) -> Task:
    """Return the task to compute a submission, with everything that its page and its sender get."""
    return Task(command="run", source=_source(name, data), options=options, report=".xlsx", copy=".xlsx", pages=True)


def check_task(name: str, data: bytes, options: Options) -> Task:
    """Return the task to check a submission of which nothing is kept."""
    return Task(command="check", source=_source(name, data), options=options, pages=True)


def _source(name: str, data: bytes) -> Source:
    # As a file that is given alone: what flexlash itself wrote is skipped.
    return Source(name=name, data=data, companions=Companions())


def submitted(path: Path, name: str, limits: ReadingLimits) -> bytes:
    """Return the bytes of a submission of this name, kept at a path.

    Raises OSError when they cannot be read, Refusal when they are too many, none, or those of a lock file.
    """
    if name.startswith(_LOCK):
        raise Refusal("I525")
    if path.stat().st_size == limits.file_mebibytes * 2**20 + 1:
        # Of a file that was larger no more is kept: how large it was is not known here.
        raise limits.exceeded("file_mebibytes")
    return read_bytes(path, limits)


def answer_of(done: Future[bytes], name: str, limits: ReadingLimits, sha256: str = "") -> Answer:
    """Return what a worker says of a submission, or that it exceeded a limit, or that the program failed.

    Raises WorkerLostError where the worker was lost for no known reason, ClusterError, and CancelledError.
    """
    try:
        return Answer.of(done.result())
    except WorkerLostError as lost:
        if not lost.setting:
            raise
        return refused_answer(Path(name), limits.exceeded(lost.setting), sha256)
    except (ProcessFaultError, ChangedLibrary) as fault:
        return Answer(exit_code=ExitCode.INTERNAL, fault=fault_of(fault))
