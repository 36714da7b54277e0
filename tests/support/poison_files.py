"""Submissions that stop whoever reads them, by their names; a server that hands them on loads nothing heavy for it."""

from __future__ import annotations

import os
import signal
import time

from flexlash.batch.answer import Answer, Task
from flexlash.batch.side_by_side import computed_apart
from flexlash.reading.limited_process import ask
from flexlash.reading.refusal import Refusal

__all__ = ["stopped_by_name"]


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
    return computed_apart(data)


def _loop() -> None:
    while True:
        pass
