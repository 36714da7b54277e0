"""Work that is lost at one row: a process that meets the row ends by SIGKILL, as if the system had stopped it."""

from __future__ import annotations

import os
import signal

from flexlash.batch.chunk import ChunkTask, compute_chunk
from flexlash.reading.read import submission_of

__all__ = ["POISON", "lost_at_poison", "lost_at_reading_poison"]

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
