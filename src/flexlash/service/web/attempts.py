"""Wrong tokens are counted, so that nobody tries them one after another."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable

__all__ = ["Attempts"]

_MOST, _SECONDS = 5, 60.0
_MOST_ADDRESSES = 1_000


class Attempts:
    """When wrong tokens came from which address; five a minute are borne with."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._wrong: dict[str, deque[float]] = {}

    def are_too_many(self, address: str) -> bool:
        """Whether so many wrong tokens came from an address lately that none is looked at now."""
        with self._lock:
            times = self._wrong.get(address, deque())
            return len(times) >= _MOST and self._clock() - times[0] < _SECONDS

    def wrong(self, address: str) -> None:
        """Count a wrong token."""
        with self._lock:
            times = self._wrong.pop(address, deque(maxlen=_MOST))
            times.append(self._clock())
            self._wrong[address] = times
            while len(self._wrong) > _MOST_ADDRESSES:
                self._wrong.pop(next(iter(self._wrong)))
