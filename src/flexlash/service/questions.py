"""What a page asks of the workers and keeps nothing of: to check a file, to compare two reports."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

from flexlash.batch.executor import ClusterError, Executor, Work

__all__ = ["Question", "Questions", "TooManyQuestionsError"]


class TooManyQuestionsError(RuntimeError):
    """As many files are being checked or compared already as the service does at once."""


@dataclass(frozen=True, kw_only=True)
class Question:
    """A piece of work, what becomes of its answer or of what it raises, and who waits for that."""

    work: Work
    data: bytes
    told: Callable[[Future[bytes]], Any]
    future: Future[Any]


class Questions:
    """Questions that wait for workers, or for their answer; a bounded number of them. Any thread may ask."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._lock = threading.Lock()
        self._waiting: deque[Question] = deque()
        self._open: set[Future[Any]] = set()

    def ask(self, work: Work, data: bytes, told: Callable[[Future[bytes]], Any]) -> Future[Any]:
        """Return what `told` will make of the answer; raise TooManyQuestionsError where too many are open."""
        question = Question(work=work, data=data, told=told, future=Future())
        with self._lock:
            if len(self._open) >= self._most:
                raise TooManyQuestionsError(f"{self._most} files are being checked already; try again in a moment")
            self._open.add(question.future)
            self._waiting.append(question)
        question.future.add_done_callback(self._forget)
        return question.future

    def hand_over(self, executor: Executor) -> None:
        """Give what waits to the workers."""
        while question := self._next():
            if question.future.set_running_or_notify_cancel():
                asked = executor.submit(question.work, question.data)
                asked.add_done_callback(lambda done, question=question: _answer(question, done))  # type: ignore[misc]

    def close(self) -> None:
        """Tell whoever still waits that nobody will answer."""
        while question := self._next():
            question.future.cancel()
            question.future.set_running_or_notify_cancel()

    def _next(self) -> Question | None:
        with self._lock:
            return self._waiting.popleft() if self._waiting else None

    def _forget(self, future: Future[Any]) -> None:
        with self._lock:
            self._open.discard(future)


def _answer(question: Question, done: Future[bytes]) -> None:
    """Tell who waits what came of a question; one that was cancelled lost its workers when they ended."""
    try:
        if done.cancelled():
            raise ClusterError("the workers have ended")  # noqa: TRY301
        question.future.set_result(question.told(done))
    except BaseException as fault:  # noqa: BLE001
        question.future.set_exception(fault)
