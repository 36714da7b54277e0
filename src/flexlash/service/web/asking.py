"""What a page has a worker do while its visitor waits: not many at once, and not for ever."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from typing import TypeVar

from flexlash.batch.executor import ClusterError, WorkerLostError
from flexlash.service.questions import TooManyQuestionsError
from flexlash.service.web.refusals import Refused

__all__ = ["answer_of"]

Result = TypeVar("Result")


async def answer_of(ask: Callable[[], Future[Result]], seconds: float) -> Result:
    """Return what a worker answers within so many seconds; raise Refused where too many are asked, or none answers."""
    try:
        future = ask()
        return await asyncio.wait_for(asyncio.shield(asyncio.wrap_future(future)), seconds)
    except TooManyQuestionsError:
        raise Refused(503, "Other files are being checked just now: try again in a minute.") from None
    except TimeoutError:
        raise Refused(503, "The workers are busy: hand it in, and it waits its turn.") from None
    except WorkerLostError as lost:
        raise Refused(422, f"This file stopped the program that reads it: {lost}.") from None
    except ClusterError:
        raise Refused(503, "There are no workers just now: try again in a minute.") from None
    except (CancelledError, asyncio.CancelledError):
        if future.cancelled():
            raise Refused(503, "flexlash is being stopped: try again when it runs.") from None
        raise
