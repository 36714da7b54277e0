"""Keeping house: what was kept long enough is forgotten, what nothing names is removed, a full disk is foretold."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from flexlash.service.log import Log
from flexlash.service.repeated import Repeated
from flexlash.service.store import Store

__all__ = ["Keeper"]

_EVERY = 3600.0
_REMEMBERED = 10
"""How many times as long as submissions the IDs of the forgotten are known."""


class Keeper:
    """What is done in a store every hour, in a thread of its own."""

    def __init__(self, store: Store, keep_seconds: float, log: Log, clock: Callable[[], float] = time.time) -> None:
        """Keep submissions that have ended for so many seconds."""
        self._store = store
        self._keep = keep_seconds
        self._log = log
        self._clock = clock
        self._warned: Sequence[str] = ()
        self._repeated = Repeated("keeping house", self.step, _EVERY, log)
        self.start = self._repeated.start
        self.wake = self._repeated.wake
        self.stop = self._repeated.stop

    def step(self) -> bool:
        """Forget, remove and warn once; return whether more is to be forgotten at once."""
        now = self._clock()
        forgotten = self._store.forget_ended(now - self._keep)
        if forgotten:
            self._log.say("forgotten", submissions=forgotten)
            return True
        self._store.prune(now - self._keep, now - _REMEMBERED * self._keep)
        if swept := self._store.sweep():
            self._log.say("swept", files=swept)
        warnings = self._store.warnings()
        for warning in warnings if warnings != self._warned else ():
            self._log.say("warning", why=warning)
        self._warned = warnings
        return False
