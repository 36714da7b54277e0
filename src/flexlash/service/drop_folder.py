"""The drop folder: what people put into INBOX becomes submissions, what became of these is put into OUT.

It looks again and again, since network drives tell of nothing; every step may be cut short and is done again.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from flexlash.reading.reading_limits import ReadingLimits
from flexlash.service.delivering import Delivering
from flexlash.service.inbox import Inbox
from flexlash.service.log import Log
from flexlash.service.original import KeptPart
from flexlash.service.places import Places
from flexlash.service.repeated import Repeated
from flexlash.service.store import Store

__all__ = ["DropFolder"]

_MOST = ReadingLimits().file_mebibytes * 2**20
_POLL = 2.0
"""Seconds between two looks."""


class DropFolder:
    """INBOX and OUT of a store. `wake` is called when there is something new to compute."""

    def __init__(
        self,
        store: Store,
        places: Places,
        options_digest: str,
        log: Log,
        wake: Callable[[], object] = lambda: None,
        *,
        most_bytes: int = _MOST,
        clock: Callable[[], float] = time.monotonic,
        seconds: float = _POLL,
    ) -> None:
        """Use places that are held.

        Of a file of more than `most_bytes`, which nobody reads, the store keeps the beginning. `clock` only goes
        forward [s], `seconds` lie between two looks.
        """
        kept = KeptPart(most=most_bytes)
        self._store = store
        self._wake = wake
        self._inbox = Inbox(store, places, options_digest, log, kept=kept, clock=clock)
        self._delivering = Delivering(store, places, log, kept=kept, claimed=self._inbox.expect, clock=clock)
        self._has_begun = False
        self._repeated = Repeated("drop folder", self.step, seconds, log)

    def step(self) -> bool:
        """Look through INBOX, claim and accept what has settled, deliver what is due.

        Return whether more is to be done at once. Raises OSError, or a fault of the store, where nothing can be done.
        """
        if not self._has_begun:
            self._inbox.begin()
            self._delivering.begin()
            self._has_begun = True
        accepted, more = self._inbox.step()
        if accepted:
            self._wake()
        return self._delivering.step() or more

    def start(self) -> None:
        """Begin to look, in a thread of its own."""
        self._repeated.start()

    def wake(self) -> None:
        """Look at once, as when a submission has ended."""
        self._repeated.wake()

    def stop(self, seconds: float | None = None) -> None:
        """Look no more, and wait so long until the present step has ended."""
        self._repeated.stop(seconds)

    def troubles(self) -> list[str]:
        """Return what keeps it from its work, in words that name nobody and no file."""
        told = [] if self._repeated.is_alive else ["nothing looks into INBOX"]
        if self._inbox.is_hindered:
            told.append("INBOX or OUT cannot be used")
        if any(one.trouble for one in self._store.undelivered() if one.kind != "message"):
            told.append("files cannot be put into OUT")
        return told

    @property
    def is_idle(self) -> bool:
        """Whether nothing waits in INBOX, to settle or to be taken, all was computed, and all was delivered."""
        totals = self._store.totals()
        return (
            self._inbox.is_idle()
            and not totals["waiting"] + totals["working"]
            and all(one.kind == "message" for one in self._store.undelivered())
        )
