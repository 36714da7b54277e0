"""Work in worker processes, which end with this one; one that dies costs its own piece of work, which is repeated.

Each worker answers through a pipe of its own, whose other end no other process holds: whenever it dies, also in the
middle of a long answer, the pipe ends at once, and no answer of another worker passes through it.
"""

from __future__ import annotations

import itertools
import os
import pickle
import signal
import sys
import threading
import time
import traceback
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from multiprocessing import parent_process, resource_tracker
from multiprocessing.connection import Connection, Pipe, wait
from multiprocessing.context import SpawnProcess
from multiprocessing.process import current_process
from queue import Empty, PriorityQueue
from types import ModuleType
from typing import Any, Self, TypeVar

__all__ = [
    "FEW_THREADS",
    "StoppedError",
    "Told",
    "Worker",
    "WorkerLostError",
    "Workers",
    "hear",
    "mapped",
    "tell",
    "timed",
    "with_children",
]

Item = TypeVar("Item")
Result = TypeVar("Result")

Told = Callable[[bytes], object]
"""Called with what a worker tells, while it works, in a thread that waits for it: quickly, or the worker waits."""

_TRIES = 3
"""Times that a piece of work may lose its worker: the system may stop one process by chance, hardly three."""

_SAFE = {"PYTHONSAFEPATH": "1"}
"""No module of the working folder, where a stranger's files may lie, is imported while a worker starts."""

FEW_THREADS = {"POLARS_MAX_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "RUST_BACKTRACE": "0"}
"""Environment of a worker whose memory is limited: each thread reserves some. Rust's panics are not told at length."""

_ENDING = 5
"""Seconds that a worker may take to end once its pipe has ended."""

_STARTING = threading.Lock()
"""What is changed of this process while another is started belongs to one thread at a time."""


class WorkerLostError(RuntimeError):
    """A piece of work lost every worker that took it up, or exceeded a limit of reading.

    `setting` names the limit that it exceeded, empty where none is known; `losses` are the workers that it has cost.
    """

    def __init__(self, message: str, setting: str = "", losses: int = 0) -> None:
        super().__init__(message)
        self.setting = setting
        self.losses = losses


class StoppedError(Exception):
    """A worker was stopped while it worked, by a limit of reading (`setting`) or by whatever gave this exit code."""

    def __init__(self, setting: str, exit_code: int | None) -> None:
        super().__init__(f"exit {exit_code}")
        self.setting = setting


@contextmanager
def _environment(variables: Mapping[str, str]) -> Iterator[None]:
    """Set environment variables for the processes that are started meanwhile."""
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Have Ctrl-C wait, also in a process that is started meanwhile, which would print where it was interrupted."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # Where it is started only afterwards, it would take this away again.
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def with_children() -> Iterator[None]:
    """Let a daemonic process, such as a worker of Dask, start others: these end with it of their own accord."""
    configuration = current_process()._config  # type: ignore[attr-defined]  # noqa: SLF001
    daemon = configuration.pop("daemon", None)
    try:
        yield
    finally:
        if daemon is not None:
            configuration["daemon"] = daemon


class _Process(SpawnProcess):
    """A process of its own that does not run the script of its user once more: it needs nothing of it."""

    variables: Mapping[str, str] = _SAFE

    def start(self) -> None:
        main = sys.modules["__main__"]
        sys.modules["__main__"] = ModuleType("__main__")
        try:
            with _environment(self.variables), _uninterrupted(), with_children():
                super().start()
        finally:
            sys.modules["__main__"] = main


class Worker:
    """A process that does one thing after another, for one thread at a time."""

    def __init__(
        self, initializer: Callable[[], None] | None = None, variables: Mapping[str, str] | None = None
    ) -> None:
        """Start it under these environment variables; it does the first thing once the initializer has returned.

        It is spawned, since threads may already run here. Raises OSError where no process can be started.
        """
        (requests, self._requests), (self._answers, answers) = Pipe(duplex=False), Pipe(duplex=False)
        self._process = _Process(target=_serve, args=(requests, answers, initializer), daemon=True)
        self._process.variables = {**_SAFE, **(variables or {})}
        try:
            with _STARTING:
                self._process.start()
        except BaseException:
            self._close()
            raise
        finally:
            requests.close()
            answers.close()
        self._saying = threading.Lock()

    def asked(self, function: Callable[..., Result], *arguments: object, told: Told | None = None) -> Result:
        """Return a function of these arguments, worked out there; `told` is called with what it tells meanwhile.

        Raises what the function raises, in words where that cannot travel, and StoppedError when the worker is stopped,
        also by the clock that it asks for (`timed`); then it is of no more use.
        """
        try:
            self._requests.send((function, arguments))
            kind, value = self._answer(told)
        except (EOFError, OSError):
            raise self._stopped() from None
        if kind == "raised":
            raise value
        return value  # type: ignore[no-any-return]

    def say(self, message: bytes) -> None:
        """Hand a message to what the worker is doing, which must hear it (`hear`); raise OSError where it has ended."""
        with self._saying:
            self._requests.send_bytes(message)

    def wait(self) -> None:
        """Wait until the initializer has returned; raise StoppedError when the worker is stopped before."""
        try:
            self._answers.recv()
        except (EOFError, OSError):
            raise self._stopped() from None

    def is_alive(self) -> bool:
        """Whether the process has not ended."""
        return self._process.is_alive()

    def _answer(self, told: Told | None) -> tuple[str, Any]:
        """Return what the worker says at last, keeping time for it as it asks; what it tells buys it no time."""
        end: float | None = None
        while self._answers.poll(None if end is None else max(0.0, end - time.monotonic())):
            kind, value = self._answers.recv()
            if kind in {"done", "raised"}:
                return kind, value
            if kind == "timed":
                end = None if value is None else time.monotonic() + value
            elif told is not None:
                # What it raises is its own affair: the worker would answer the next piece of work with this one.
                with suppress(BaseException):
                    told(value)
        raise self._stopped("seconds")

    def _stopped(self, setting: str = "") -> StoppedError:
        """End the worker and return what it was stopped by."""
        if not setting:
            wait([self._process.sentinel], _ENDING)
        code = self.end()
        processor_time = not setting and code == -getattr(signal, "SIGXCPU", 0)
        return StoppedError("processor_seconds" if processor_time else setting, code)

    def kill(self) -> None:
        """Stop the process, whatever it is doing; whoever waits for it is told."""
        self._process.kill()

    def end(self) -> int | None:
        """Stop the process, wait until it has gone and return its exit code, which is None where it is not known."""
        self.kill()
        # Starting another process asks what became of each; only one of two that ask is told.
        with _STARTING:
            self._process.join()
            code = self._process.exitcode
        self._close()
        return code

    def _close(self) -> None:
        """Close this process's ends of the pipes."""
        self._requests.close()
        self._answers.close()


class _Own:
    """What leads to the one that asks, in a worker."""

    requests: Connection | None = None
    answers: Connection | None = None


@contextmanager
def timed(seconds: float) -> Iterator[None]:
    """Have this worker stopped by the one that asks if this takes longer, whatever it does; elsewhere do nothing."""
    if _Own.answers is None:
        yield
        return
    _Own.answers.send(("timed", seconds))
    try:
        yield
    finally:
        _Own.answers.send(("timed", None))


def tell(message: bytes) -> None:
    """Hand a message to whoever asked for what this worker is doing; elsewhere do nothing."""
    if _Own.answers is not None:
        _Own.answers.send(("told", message))


def hear() -> bytes:
    """Wait for a message to what this worker is doing (`Worker.say`); the next thing that is asked would be one, too.

    Raises EOFError in a process that nobody asks, or once nobody asks any more.
    """
    if _Own.requests is None:
        raise EOFError
    return _Own.requests.recv_bytes()


def _serve(requests: Connection, answers: Connection, initializer: Callable[[], None] | None) -> None:
    """Do what is asked, one thing after another, until nobody asks."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    threading.Thread(target=_end_with_parent, daemon=True).start()
    _Own.requests, _Own.answers = requests, answers
    if initializer:
        initializer()
    with suppress(EOFError, OSError):
        answers.send(("ready", None))
        while True:
            answers.send_bytes(_done(requests.recv_bytes()))


def _end_with_parent() -> None:
    """End this process, whatever it is doing, when the one that started it ends."""
    if parent := parent_process():
        parent.join()
        os._exit(1)


def _done(request: bytes) -> bytes:
    """Return what was asked, or what was raised instead; nothing may end this process without an answer."""
    try:
        function, arguments = pickle.loads(request)  # noqa: S301
        return pickle.dumps(("done", function(*arguments)))
    except BaseException as fault:  # noqa: BLE001
        return pickle.dumps(("raised", _able_to_travel(fault)))


def _able_to_travel(fault: BaseException) -> BaseException:
    """Return an exception with its trace, in words where another process could not rebuild it."""
    trace = "".join(traceback.format_exception(fault))
    try:
        fault.add_note(trace)
        pickle.loads(pickle.dumps(fault))  # noqa: S301
    except Exception:  # noqa: BLE001
        return RuntimeError(trace)
    return fault


@dataclass(frozen=True, kw_only=True)
class _Piece:
    """A piece of work, and how many workers it has lost."""

    future: Future[Any]
    function: Callable[..., Any]
    arguments: tuple[object, ...]
    told: Told | None
    losses: int = 0


class Workers:
    """Several workers that are started and load what they need; whoever is free takes the next piece of work."""

    def __init__(
        self,
        number: int,
        initializer: Callable[[], None] | None = None,
        variables: Mapping[str, str] | None = None,
        *,
        tries: int = _TRIES,
    ) -> None:
        """Start them; raise WorkerLostError where no process can be started.

        A piece of work may cost so many workers (`tries`).
        """
        self._made_of = (initializer, variables)
        self._tries = tries
        self._pieces: PriorityQueue[tuple[int, _Piece | None]] = PriorityQueue()
        self._numbers = itertools.count()
        self._closing = False
        self._lock = threading.Lock()
        self._workers: dict[int, Worker] = {}
        self._places = set(range(number))
        self._threads = [
            threading.Thread(target=self._work, args=(place,), name=f"flexlash worker {place}", daemon=True)
            for place in range(number)
        ]
        try:
            # A thread that sees its worker end, as it does when Ctrl-C ends this process, would start another.
            with _uninterrupted():
                for place in range(number):
                    self._workers[place] = Worker(*self._made_of)
                for thread in self._threads:
                    thread.start()
        except BaseException as fault:
            self.close()
            if isinstance(fault, OSError):
                raise WorkerLostError(f"no worker process can be started: {fault}") from fault
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def submit(self, function: Callable[..., Result], *arguments: object, told: Told | None = None) -> Future[Result]:
        """Return what will be the function of these arguments; pieces are begun in the order they are given in.

        `told` is called with what it tells meanwhile. The future raises what the function raises, and WorkerLostError
        when it exceeds a limit or loses three workers.
        """
        future: Future[Result] = Future()
        with self._lock:
            if self._closing:
                raise RuntimeError("the workers have ended")
            piece = _Piece(future=future, function=function, arguments=arguments, told=told)
            self._pieces.put((next(self._numbers), piece))
        return future

    def close(self) -> None:
        """Stop all workers, whatever they are doing; what has not been done is cancelled."""
        given_up = []
        with self._lock:
            self._closing = True
            with suppress(Empty):
                while piece := self._pieces.get_nowait()[1]:
                    given_up.append(piece)
            for place, worker in self._workers.items():
                self._pieces.put((-1 - place, None))
                worker.kill()
        for piece in given_up:
            _give_up(piece)
        for thread in self._threads:
            if thread.ident is not None:
                thread.join()
        for worker in self._workers.values():
            worker.end()

    def _work(self, place: int) -> None:
        """Have the worker of a place do one piece after another; a piece waits for no worker that is still starting."""
        worker = self._ready(place, self._workers[place])
        while worker or self._is_last(place):
            number, piece = self._pieces.get()
            if piece is None:
                return
            if worker and not worker.is_alive():
                self._pieces.put((number, piece))
                worker = self._ready(place)
            elif piece.losses or piece.future.set_running_or_notify_cancel():
                worker = self._asked(worker, number, piece) or self._ready(place)
            # What was asked may be large, and the next piece may be long in coming.
            del piece

    def _ready(self, place: int, worker: Worker | None = None) -> Worker | None:
        """Return the worker of a place once it can begin, or another; None where several end before they can."""
        for _ in range(_TRIES):
            with suppress(StoppedError, OSError):
                with self._lock:
                    if self._closing:
                        return None
                    worker = worker or Worker(*self._made_of)
                    self._workers[place] = worker
                worker.wait()
                return worker
            worker = None
        return None

    def _is_last(self, place: int) -> bool:
        """Give up a place that has no worker, where others have one: there may be no memory for so many."""
        with self._lock:
            if len(self._places) > 1:
                self._places.discard(place)
            return place in self._places

    def _asked(self, worker: Worker | None, number: int, piece: _Piece) -> Worker | None:
        """Have a worker do a piece of work, and return it if it was not stopped."""
        try:
            if worker is None:
                raise WorkerLostError("no worker process can be started", losses=piece.losses)  # noqa: TRY301
            answer = worker.asked(piece.function, *piece.arguments, told=piece.told)
        except StoppedError as stopped:
            self._repeat(number, piece, stopped)
            return None
        except BaseException as fault:  # noqa: BLE001
            piece.future.set_exception(fault)
        else:
            piece.future.set_result(answer)
        return worker

    def _repeat(self, number: int, piece: _Piece, stopped: StoppedError) -> None:
        """Have whoever is free repeat the work of a worker that was stopped, before any other work."""
        lost = replace(piece, losses=piece.losses + 1)
        fault: BaseException = CancelledError()
        with self._lock:
            if not self._closing:
                if not stopped.setting and lost.losses < self._tries:
                    self._pieces.put((number, lost))
                    return
                message = f"a worker process was stopped {lost.losses} times ({stopped})"
                if stopped.setting:
                    message = f"a worker process exceeded its {stopped.setting}"
                fault = WorkerLostError(message, stopped.setting, lost.losses)
        # Whoever is told of it may ask for something else, which takes the lock.
        piece.future.set_exception(fault)


def _give_up(piece: _Piece) -> None:
    """Cancel a piece of work, whether it has begun or not."""
    if not piece.future.cancel():
        piece.future.set_exception(CancelledError())


def mapped(function: Callable[[Item], Result], items: Sequence[Item], workers: int) -> Iterator[Result]:
    """Yield a function of each item in order, by worker processes when there is to be more than one.

    Where no process can be started all is done here. Raises WorkerLostError when an item loses its worker three times,
    and what the function raises.
    """
    if workers <= 1:
        yield from map(function, items)
        return
    try:
        pool = Workers(workers)
    except WorkerLostError:
        yield from map(function, items)
        return
    with pool:
        futures = deque(pool.submit(function, item) for item in items)
        while futures:
            yield futures.popleft().result()
