"""What a page asks of the workers and keeps nothing of: to check a file, to compare two reports."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from flexlash.analysis.options import Options
from flexlash.batch.answer import Answer
from flexlash.batch.ended import refused_answer
from flexlash.batch.executor import ClusterError, Executor, Work, WorkerLostError
from flexlash.batch.side_by_side import computed_apart
from flexlash.batch.two_reports import ComparisonTask, compare
from flexlash.reading.read import Source
from flexlash.reading.refusal import Refusal
from flexlash.service.blobs import Blobs
from flexlash.service.records import StoredFile
from flexlash.service.tasks import answer_of, check_task

__all__ = ["Questions", "TooManyQuestionsError"]

_MOST = 8
"""Files that are checked or compared at once, each of which may have 20 MiB."""


class TooManyQuestionsError(RuntimeError):
    """As many files are being checked or compared already as the service does at once."""


@dataclass(frozen=True, kw_only=True)
class _Question:
    """A piece of work, what becomes of its answer or of what it raises, and who waits for that."""

    work: Work
    data: bytes
    told: Callable[[Future[bytes]], Any]
    future: Future[Any]


class Questions:
    """Questions that wait for workers, or for their answer; a bounded number of them. Any thread may ask.

    What asks raises TooManyQuestionsError where too many are open. The futures raise ClusterError where the workers are
    lost, and are cancelled when the service ends before anybody could answer.
    """

    def __init__(self, options: Options, blobs: Blobs) -> None:
        self._options = options
        self._blobs = blobs
        self._asking = threading.Lock()
        self._waiting: deque[_Question] = deque()
        self._open: set[Future[Any]] = set()

    def wake(self) -> None:
        """Have what waits handed over soon."""
        raise NotImplementedError

    def check(self, name: str, data: bytes) -> Future[Answer]:
        """Return what will come of checking a file of which nothing is kept."""

        def told(done: Future[bytes]) -> Answer:
            try:
                return answer_of(done, name, self._options.limits)
            except WorkerLostError as lost:
                if not lost.losses:
                    raise ClusterError(str(lost)) from lost
                return refused_answer(Path(name), Refusal("E118"))

        return self._asked(computed_apart, check_task(name, data, self._options).as_bytes(), told)

    def compare(self, old: StoredFile, new: StoredFile) -> Future[bytes]:
        """Return what will be the difference between two stored reports, as JSON.

        Raises OSError where one of them cannot be read.
        """
        first, second = (Source(name=file.name, data=self._blobs.read(file.sha256)) for file in (old, new))
        return self.ask(compare, ComparisonTask(old=first, new=second, limits=self._options.limits).as_bytes())

    def ask(self, work: Work, data: bytes) -> Future[bytes]:
        """Return what will be the answer to a piece of work; the future raises what the executor's does as well."""
        return self._asked(work, data, Future.result)

    def _asked(self, work: Work, data: bytes, told: Callable[[Future[bytes]], Any]) -> Future[Any]:
        question = _Question(work=work, data=data, told=told, future=Future())
        with self._asking:
            if len(self._open) >= _MOST:
                raise TooManyQuestionsError(f"{_MOST} files are being checked already; try again in a moment")
            self._open.add(question.future)
            self._waiting.append(question)
        question.future.add_done_callback(self._forget)
        self.wake()
        return question.future

    def _hand_over(self, executor: Executor) -> None:
        """Give what waits to the workers."""
        while question := self._next():
            if question.future.set_running_or_notify_cancel():
                asked = executor.submit(question.work, question.data)
                asked.add_done_callback(lambda done, question=question: _answer(question, done))  # type: ignore[misc]

    def _cancel(self) -> None:
        """Tell whoever still waits that nobody will answer."""
        while question := self._next():
            question.future.cancel()

    def _next(self) -> _Question | None:
        with self._asking:
            return self._waiting.popleft() if self._waiting else None

    def _forget(self, future: Future[Any]) -> None:
        with self._asking:
            self._open.discard(future)


def _answer(question: _Question, done: Future[bytes]) -> None:
    """Tell who waits what came of a question; one that was cancelled lost its workers when they ended."""
    try:
        if done.cancelled():
            raise ClusterError("the workers have ended")  # noqa: TRY301
        question.future.set_result(question.told(done))
    except BaseException as fault:  # noqa: BLE001
        question.future.set_exception(fault)
