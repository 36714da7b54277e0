"""What a page has a worker do while its visitor waits: not many at once, and not for ever."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from typing import TypeVar

from flexlash.batch.executor import WorkerLostError
from flexlash.service.web.refusals import Refused

__all__ = ["Asking"]

Result = TypeVar("Result")


class Asking:
    """Asks workers for `most` answers at once, each within so many seconds."""

    def __init__(self, most: int, seconds: float) -> None:
        self._most = most
        self._seconds = seconds
        self._asked = 0
        self._counting = threading.Lock()

    async def answer(self, ask: Callable[[], Future[Result]]) -> Result:
        """Return what a worker answers; raise Refused where too many are asked, or none answers."""
        if self._asked >= self._most:
            raise Refused(503, "Others are having files looked through just now: try again in a minute.")
        future = ask()
        with self._counting:
            self._asked += 1
        # As long as a worker is at it, whoever has left it is counted: the next visitor would wait behind it.
        future.add_done_callback(self._answered)
        try:
            return await asyncio.wait_for(asyncio.shield(asyncio.wrap_future(future)), self._seconds)
        except TimeoutError:
            raise Refused(503, "The workers are busy: hand it in, and it gets its turn.") from None
        except WorkerLostError as lost:
            raise Refused(422, f"This file stopped the program that reads it: {lost}.") from None
        except (CancelledError, asyncio.CancelledError):
            if future.cancelled():
                raise Refused(503, "flexlash is being stopped: try again when it runs.") from None
            raise

    def _answered(self, _: object) -> None:
        with self._counting:
            self._asked -= 1
