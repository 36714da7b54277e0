"""Work that is lost at one row: a process that meets the row ends by SIGKILL, as if the system had stopped it."""

from __future__ import annotations

import os
import signal
import time

from flexlash.batch.answer import Answer, Task
from flexlash.batch.chunk import ChunkTask, compute_chunk
from flexlash.batch.compute import compute
from flexlash.reading.limited_process import ask
from flexlash.reading.read import submission_of
from flexlash.reading.refusal import Refusal

__all__ = ["POISON", "lost_at_poison", "lost_at_reading_poison", "stopped_by_name"]

POISON = "poison"
"""Name of the variant that stops whoever computes it."""


def lost_at_poison(data: bytes) -> bytes:
    """Compute a chunk; a chunk in which the poison is to be computed ends the process."""
    if not ChunkTask.of(data).passed_over and _holds_poison(data):
        os.kill(os.getpid(), signal.SIGKILL)
    return compute_chunk(data)


def lost_at_reading_poison(data: bytes) -> bytes:
    """Compute a chunk; a chunk in which the poison is merely read ends the process as well."""
    if _holds_poison(data):
        os.kill(os.getpid(), signal.SIGKILL)
    return compute_chunk(data)


def _holds_poison(data: bytes) -> bool:
    task = ChunkTask.of(data)
    sheets = submission_of(task.source, task.options.limits).sheets.values()
    return any(POISON in cells.values() for sheet in sheets for cells in sheet.rows.values())


def stopped_by_name(data: bytes) -> bytes:
    """Answer a task; a submission whose name begins with `kills`, `hangs` or `loops` does so to whoever reads it."""
    task = Task.of(data)
    kind = task.source.name.partition("-")[0]
    try:
        if kind == "kills":
            os.kill(os.getpid(), signal.SIGKILL)
        elif kind == "hangs":
            ask(time.sleep, task.options.limits, 3600)
        elif kind == "loops":
            ask(_loop, task.options.limits)
    except Refusal as refusal:
        return Answer(exit_code=refusal.exit_code).as_bytes()
    return compute(data)


def _loop() -> None:
    while True:
        pass
