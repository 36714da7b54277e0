"""The store → workers → the store: what waits is taken, computed and ended; whatever goes wrong, nothing is lost.

One thread does all of it. Workers and their answers are heard through a queue of events, so that no other thread waits
for the store.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from functools import partial
from pathlib import Path
from queue import Empty, SimpleQueue

from flexlash.analysis.options import Options
from flexlash.batch.answer import Answer
from flexlash.batch.ended import fault_of, refused_answer
from flexlash.batch.executor import ClusterError, Executor, WorkerLostError
from flexlash.batch.large_apart import LargeAnswer
from flexlash.batch.side_by_side import computed_apart, large_tables
from flexlash.reading.refusal import Refusal
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.findings import readable, shown
from flexlash.service.blobs import DamagedFileError
from flexlash.service.endings import ending_of
from flexlash.service.large_submissions import LargeSubmissions
from flexlash.service.log import Log
from flexlash.service.open_executor import OpenExecutor, Opening
from flexlash.service.progress import Begun
from flexlash.service.questions import Questions
from flexlash.service.records import StoredSubmission
from flexlash.service.repeated import ENVIRONMENT_FAULTS, Repeated, back_off
from flexlash.service.store import Store
from flexlash.service.store_place import WORK
from flexlash.service.tasks import answer_of, run_task, service_options, submitted

__all__ = ["Dispatcher"]

_SECONDS = 1.0
"""Seconds after which it is looked for submissions that may be begun again, or that another process handed back."""

_AHEAD = 2
"""Submissions for each worker that are handed over, so that none waits for this thread."""

_MOST_LOST = 3
"""Workers, or servers, that a submission may cost."""

_LONGEST_STOP = 28.0
"""Seconds that stopping may take; whoever stops a service kills it after 30."""


class Dispatcher(Questions):
    """Has workers compute what the store holds, oldest first.

    What was at work when a server ended runs with nothing beside it. `ended` is called after each ending.
    """

    def __init__(
        self,
        store: Store,
        open_executor: Opening,
        options: Options,
        log: Log,
        *,
        ended: Callable[[], None] | None = None,
    ) -> None:
        super().__init__(service_options(options), store.blobs)
        self._store = store
        self._executor = OpenExecutor(open_executor, log)
        self._large = LargeSubmissions(store.folder / WORK, self._options)
        self._passed_over: set[str] = set()
        self._log = log
        self._on_end = ended
        self._begun: dict[str, Begun] = {}
        self._events: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._owed: dict[str, Callable[[], None]] = {}
        self._faults: Counter[str] = Counter()
        self._is_recovered = self._is_stopping = self._is_draining = False
        self._loop = Repeated("dispatcher", self._step, _SECONDS, log)

    @property
    def workers(self) -> int:
        """How many submissions are computed side by side, 0 while there are no workers."""
        return self._executor.workers

    @property
    def busy(self) -> int:
        """How many submissions are at work."""
        return len(self._begun)

    @property
    def is_alive(self) -> bool:
        """Whether what waits is taken as soon as there are workers."""
        return self._loop.is_alive and not self._is_stopping

    def start(self) -> None:
        """Begin; what was at work when the last server ended comes first."""
        self._loop.start()

    def wake(self) -> None:
        """Say that a submission has come in."""
        self._loop.wake()

    def stop(self, seconds: float = _LONGEST_STOP) -> None:
        """Let what is at work end within so many seconds, and hand back the rest, for which no try is counted."""
        end = time.monotonic() + min(seconds, _LONGEST_STOP)
        self._is_stopping = True
        # What is done of a large table is kept anyway.
        while any(not one.is_large for one in list(self._begun.values())) and time.monotonic() < end:
            time.sleep(0.05)
        self._loop.stop(max(1.0, end - time.monotonic()))
        for begun in list(self._begun.values()):
            self._hand_back(begun.submission)
        try:
            self._settle()
        except ENVIRONMENT_FAULTS as fault:
            # The next server finds them at work, and begins with them.
            self._log.say("fault", what="handing back", why=readable(fault))
        self._large.stop()
        self._cancel()
        self._executor.close(max(1.0, end - time.monotonic()))

    # Steps of the thread

    def _step(self) -> None:
        """Hear what has become of what is at work, and begin as much as there are workers for."""
        if not self._is_recovered:
            self._recover()
        self._settle()
        while True:
            try:
                event = self._events.get_nowait()
            except Empty:
                break
            event()
            self._settle()
        executor = self._executor.get()
        if executor is not None:
            self._hand_over(executor)
            while self._may_begin(executor) and (taken := self._store.take(self._passed_over)):
                self._begin(taken, executor)
                self._settle()

    def _recover(self) -> None:
        """Have what was at work when a server ended come first; keep what was done of large tables that still wait."""
        self._store.recover()
        self._large.keep_only(lambda id_: (known := self._store.submission(id_)) is not None and not known.has_ended)
        self._is_recovered = True

    def _may_begin(self, executor: Executor) -> bool:
        """Whether another submission is begun: beside one that runs alone there is none."""
        if self._is_stopping:
            return False
        if not self._begun:
            self._is_draining = False
            return True
        if self._is_draining or any(one.submission.alone for one in self._begun.values()):
            return False
        return sum(not one.is_large for one in self._begun.values()) < _AHEAD * executor.workers

    def _begin(self, submission: StoredSubmission, executor: Executor) -> None:
        """Hand a submission over to a worker, or end it where it is refused without."""
        if submission.alone and self._begun:
            self._is_draining = True
            self._hand_back(submission)
            return
        begun = self._begun[submission.id] = Begun(submission=submission)
        self._guarded(submission, partial(self._handed_over, begun, executor))

    def _handed_over(self, begun: Begun, executor: Executor) -> None:
        """Hand a submission over to a worker, or end it where none is to see it."""
        submission, limits = begun.submission, self._options.limits
        path = self._store.blobs.path(submission.sha256)
        if submission.server_ends >= _MOST_LOST:
            self._end_lost(submission, f"was alone at work {submission.server_ends} times when the server ended")
            return
        try:
            data = submitted(self._store.blobs.checked(submission.sha256), submission.name, limits)
        except DamagedFileError:
            self._end_lost(submission, "was damaged on the disk of the service after it came in: hand it in again")
            return
        except Refusal as refusal:
            self._end(submission, refused_answer(Path(submission.name), refusal, submission.sha256))
            return
        told = partial(self._say, self._told, begun)
        if large_tables(self._options, [path]):
            if self._large.is_busy:
                self._passed_over.add(submission.id)
                self._hand_back(submission)
                return
            begun.is_large = True
            begun.future = self._large.begin(submission, path, executor, told)
        else:
            task = run_task(submission.name, data, self._options)
            begun.future = executor.submit(computed_apart, task.as_bytes(), told)
        begun.future.add_done_callback(lambda _: self._say(self._answered, begun))

    def _say(self, event: Callable[..., None], *facts: object) -> None:
        """Have something done by the thread of the dispatcher."""
        self._events.put(partial(event, *facts))
        self._loop.wake()

    # What is heard of a submission at work

    def _told(self, begun: Begun, message: bytes) -> None:
        """Write down how far a submission is, if it is still that which is told of."""
        if self._begun.get(begun.submission.id) is begun:
            begun.note(message, self._store, self._log)

    def _answered(self, begun: Begun) -> None:
        """End a submission, or hand it back; what nobody waits for any more is dropped."""
        if begun.is_large:
            self._passed_over.clear()
        if begun.future is not None and self._begun.get(begun.submission.id) is begun:
            self._guarded(begun.submission, partial(self._heard, begun.submission, begun.future))

    def _heard(self, submission: StoredSubmission, future: Future[bytes]) -> None:
        """End a submission by what a worker says of it, or because it has lost so many."""
        try:
            answer = answer_of(future, submission.name, self._options.limits, submission.sha256)
        except WorkerLostError as lost:
            tries = submission.tries + lost.losses
            self._log.say("worker lost", submission.id, tries=tries, why=readable(lost))
            if not lost.losses:
                self._wait(submission, lost)
            elif tries < _MOST_LOST:
                self._hand_back(submission, lost=lost.losses)
            else:
                self._end_lost(submission, f"stopped the worker {tries} times, so it was not computed")
        else:
            self._end(submission, answer)

    # How it goes on

    def _guarded(self, submission: StoredSubmission, step: Callable[[], None]) -> None:
        """Take a step with a submission; a fault of this machine has it wait, one of the program ends it alone."""
        try:
            step()
        except CancelledError:
            self._hand_back(submission)
        except ClusterError as fault:
            self._wait(submission, fault)
            self._lose_executor(fault)
        except ENVIRONMENT_FAULTS as fault:
            self._wait(submission, fault)
        except Exception as fault:  # noqa: BLE001
            why = fault_of(fault)
            self._log.say("internal error", submission.id, why=f"{why.kind}: {readable(fault)}")
            if self._faults[submission.id]:
                self._wait(submission, fault)
                return
            self._faults[submission.id] += 1
            self._guarded(submission, partial(self._end, submission, Answer(exit_code=ExitCode.INTERNAL, fault=why)))

    def _end_lost(self, submission: StoredSubmission, why: str) -> None:
        """End a submission that has cost as many workers or servers as it may."""
        answer = refused_answer(Path(submission.name), Refusal("E118"), submission.sha256)
        self._end(submission, answer, f"{submission.name} {why}.")

    def _end(self, submission: StoredSubmission, answer: Answer, reason: str = "") -> None:
        """Keep the result of a submission and write down how it ended."""
        with self._store.blobs.keeping():
            blobs = self._store.blobs
            files = self._large.kept(submission, answer, blobs) if isinstance(answer, LargeAnswer) else {}
            ending = ending_of(submission, answer, blobs, self._options.limits, reason=reason, further=files)
            self._store.end(submission.id, ending)
        self._large.forget(submission.id)
        self._begun.pop(submission.id, None)
        self._faults.pop(submission.id, None)
        self._log.say(ending.state, submission.id, exit_code=ending.exit_code, words=ending.words)
        if self._on_end is not None:
            self._on_end()

    def _hand_back(self, submission: StoredSubmission, *, lost: int = 0, after: float = 0.0, trouble: str = "") -> None:
        """Put a submission back among those that wait, as soon as the store can be written to."""
        self._begun.pop(submission.id, None)
        self._owed[submission.id] = partial(
            self._store.hand_back, submission.id, lost=lost, after=after, trouble=trouble
        )

    def _wait(self, submission: StoredSubmission, fault: BaseException) -> None:
        """Have a submission wait, longer each time, since this machine or its workers have a fault."""
        self._faults[submission.id] += 1
        rest = back_off(self._faults[submission.id])
        self._log.say("fault", submission.id, why=readable(fault), again_in_seconds=rest)
        self._hand_back(submission, after=rest, trouble=shown(fault, 400))

    def _settle(self) -> None:
        """Hand back what could not be handed back before; raise what keeps it from being."""
        for id_, hand_back in list(self._owed.items()):
            hand_back()
            del self._owed[id_]

    def _lose_executor(self, fault: ClusterError) -> None:
        """Hand back whatever the workers have, since they are of no more use, and have others come."""
        for begun in list(self._begun.values()):
            self._hand_back(begun.submission)
        self._executor.lose(fault)
