"""The executor of a service: opened when it is needed, closed and opened anew where it was lost."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack

from flexlash.batch.executor import Executor
from flexlash.schema.findings import readable
from flexlash.service.log import Log
from flexlash.service.repeated import back_off
from flexlash.workers import WorkerLostError

__all__ = ["OpenExecutor", "Opening"]

_CLOSING = 10.0
"""Seconds that workers which are of no more use may take to end, before it goes on without them."""

Opening = Callable[[], AbstractContextManager[Executor]]


class OpenExecutor:
    """An executor, or the time when opening it is tried again; for one thread, but for `close`."""

    def __init__(self, opening: Opening, log: Log) -> None:
        self._opening = opening
        self._log = log
        self._stack = ExitStack()
        self._executor: Executor | None = None
        self._faults = 0
        self._not_before = 0.0

    @property
    def workers(self) -> int:
        """How many pieces of work are done side by side, 0 while there is no executor."""
        return self._executor.workers if self._executor else 0

    def get(self) -> Executor | None:
        """Return the executor, None where it cannot be opened now."""
        if self._executor is None and time.monotonic() >= self._not_before:
            try:
                self._executor = self._stack.enter_context(self._opening())
                self._faults = 0
            except (OSError, WorkerLostError) as fault:
                self._faults += 1
                rest = back_off(self._faults)
                self._not_before = time.monotonic() + rest
                self._log.say("fault", what="workers", why=readable(fault), again_in_seconds=rest)
        return self._executor

    def lose(self, fault: BaseException) -> None:
        """Close an executor that is of no more use; the next is opened after a while."""
        self._faults += 1
        rest = back_off(self._faults)
        self._not_before = time.monotonic() + rest
        self._log.say("fault", what="workers", why=readable(fault), again_in_seconds=rest)
        self.close(_CLOSING)

    def close(self, seconds: float) -> None:
        """End the workers, whatever they are doing; wait no longer than so many seconds."""
        stack, self._stack, self._executor = self._stack, ExitStack(), None
        closing = threading.Thread(target=stack.close, name="flexlash closing", daemon=True)
        closing.start()
        closing.join(seconds)
