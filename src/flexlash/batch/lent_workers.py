"""A process that drives a computation borrows the workers of the one that started it, so that all share the same few.

It tells which pieces of work it wants done, and hears their answers, through its own two pipes.
"""

from __future__ import annotations

import pickle
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from itertools import count

from flexlash.batch.executor import Executor, Told, Work, WorkerLostError
from flexlash.workers import Worker, hear, tell, with_children

__all__ = ["borrowed_workers", "driven"]

_TRIES = 3
"""Times that a piece of work may lose its worker, whatever the workers themselves allow."""


@dataclass(frozen=True, kw_only=True)
class _Wanted:
    """A piece of work that is to be done."""

    number: int
    work: Work
    data: bytes


@dataclass(frozen=True, kw_only=True)
class _Answered:
    """What came of a piece of work, or what it raised."""

    number: int
    answer: bytes = b""
    fault: BaseException | None = None


def driven(driver: Worker, function: Callable[..., bytes], executor: Executor, told: Told, *arguments: object) -> bytes:
    """Return a function of these arguments, worked out by a driver that may borrow an executor (`borrowed_workers`).

    `told` is called with what it tells beside that. Raises what the function raises, and StoppedError when the driver
    is stopped; what it has asked for is given up then.
    """
    lending = _Lending(driver, executor, told)
    try:
        return driver.asked(function, *arguments, told=lending.heard)
    finally:
        lending.give_up()


class _Lending:
    """The pieces of work that a driver has asked for."""

    def __init__(self, driver: Worker, executor: Executor, told: Told) -> None:
        self._driver = driver
        self._executor = executor
        self._told = told
        self._asked: dict[int, Future[bytes]] = {}

    def heard(self, message: bytes) -> None:
        """Have a piece of work done that the driver asks for, or hand on what it tells."""
        said = pickle.loads(message)  # noqa: S301
        if isinstance(said, _Wanted):
            self._hand_over(said, 0)
        else:
            self._told(message)

    def give_up(self) -> None:
        """Cancel whatever nobody waits for any more."""
        for number in list(self._asked):
            if future := self._asked.pop(number, None):
                future.cancel()

    def _hand_over(self, wanted: _Wanted, losses: int) -> None:
        try:
            future = self._executor.submit(wanted.work, wanted.data)
        except RuntimeError:
            # The workers have ended.
            future = Future()
            future.cancel()
        self._asked[wanted.number] = future
        future.add_done_callback(partial(self._answered, wanted, losses))

    def _answered(self, wanted: _Wanted, losses: int, future: Future[bytes]) -> None:
        """Tell the driver what came of a piece of work; one that has lost its worker is done again."""
        if self._asked.pop(wanted.number, None) is None:
            return
        fault = CancelledError() if future.cancelled() else future.exception()
        if isinstance(fault, WorkerLostError) and not fault.setting and fault.losses:
            losses += fault.losses
            if losses < _TRIES:
                self._hand_over(wanted, losses)
                return
        answer = b"" if fault else future.result()
        # A driver that was stopped hears nothing.
        with suppress(OSError):
            self._driver.say(pickle.dumps(_Answered(number=wanted.number, answer=answer, fault=fault)))


class _Borrowed:
    """The workers of another process, of which this driver may have so many busy."""

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self._numbers = count()
        self._asked: dict[int, Future[bytes]] = {}

    def submit(self, work: Work, data: bytes, told: Told | None = None) -> Future[bytes]:  # noqa: ARG002
        """Return what will be the answer; nothing is told meanwhile."""
        number = next(self._numbers)
        future = self._asked[number] = Future()
        future.set_running_or_notify_cancel()
        tell(pickle.dumps(_Wanted(number=number, work=work, data=data)))
        return future

    def listen(self) -> None:
        """Hand answers to whoever waits for them, until nobody asks for this process any more."""
        with suppress(EOFError, OSError):
            while True:
                known: _Answered = pickle.loads(hear())  # noqa: S301
                future = self._asked.pop(known.number)
                if known.fault is not None:
                    future.set_exception(known.fault)
                else:
                    future.set_result(known.answer)


@contextmanager
def borrowed_workers(workers: int) -> Iterator[Executor]:
    """Give, in a driver, an executor of so many of the workers of the process that started it.

    A driver is good for one thing, and may have processes of its own meanwhile.
    """
    borrowed = _Borrowed(workers)
    threading.Thread(target=borrowed.listen, name="flexlash answers", daemon=True).start()
    with with_children():
        yield borrowed
