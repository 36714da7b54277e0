"""A thread that does a step again and again; a fault of this machine makes it wait, never end."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Callable

from flexlash.schema.findings import readable
from flexlash.service.log import Log

__all__ = ["ENVIRONMENT_FAULTS", "LONGEST_REST", "Repeated", "back_off"]

ENVIRONMENT_FAULTS = (OSError, sqlite3.OperationalError)
"""What this machine raises when its disk is full or gone: no submission is to blame."""

_SHORTEST = 5.0
LONGEST_REST = 300.0
"""Seconds after which whatever met a fault is tried again at the latest."""


def back_off(faults: int) -> float:
    """Return how many seconds to wait after so many faults in a row.

    >>> back_off(1), back_off(2), back_off(99)
    (5.0, 10.0, 300.0)
    """
    return min(LONGEST_REST, _SHORTEST * 2.0 ** min(faults - 1, 10))


class Repeated:
    """A step that is done every so many seconds, and whenever it is woken, in a thread of its own.

    A step returns True when there is more to be done at once.
    """

    def __init__(self, name: str, step: Callable[[], bool | None], seconds: float, log: Log) -> None:
        self._name = name
        self._step = step
        self._seconds = seconds
        self._log = log
        self._woken = threading.Event()
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"flexlash {name}", daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    @property
    def is_alive(self) -> bool:
        """Whether steps are being done."""
        return self._thread.is_alive()

    def wake(self) -> None:
        """Have the next step done at once."""
        self._woken.set()

    def stop(self, seconds: float | None = None) -> None:
        """Do no further step, and wait so long until the present one has ended."""
        self._stopping.set()
        self._woken.set()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(seconds)

    def _run(self) -> None:
        faults = 0
        while not self._stopping.is_set():
            self._woken.clear()
            rest = self._seconds
            try:
                if self._step():
                    rest = 0.0
                faults = 0
            except ENVIRONMENT_FAULTS as fault:
                faults += 1
                rest = back_off(faults)
                self._log.say("fault", what=self._name, why=readable(fault), again_in_seconds=rest)
            except Exception as fault:  # noqa: BLE001
                faults += 1
                rest = back_off(faults)
                self._log.say("internal error", what=self._name, why=f"{type(fault).__name__}: {readable(fault)}")
            self._woken.wait(rest)
