"""A whole service, taken step by step, that is killed or gets a fault at any one of its durable steps.

Store, drop folder and dispatcher are those of the service; the workers are played by answers that real ones gave
before. `service_judge.py` says what was wrong afterwards.
"""

from __future__ import annotations

import errno
import functools
import hashlib
import io
import json
import os
import pickle
import signal
import sqlite3
import sys
from concurrent.futures import Future
from contextlib import ExitStack, nullcontext
from dataclasses import dataclass
from pathlib import Path

from flexlash.analysis.options import Options
from flexlash.batch.answer import Task
from flexlash.service.dispatcher import Dispatcher
from flexlash.service.drop_folder import DropFolder
from flexlash.service.log import Log
from flexlash.service.places import Places, PlacesError
from flexlash.service.records import HandedIn
from flexlash.service.repeated import ENVIRONMENT_FAULTS
from flexlash.service.store import Store
from flexlash.service.tasks import run_task, service_options

__all__ = ["FAULTS", "Point", "Replayed", "Scene", "Service", "Steps", "once", "scene_of"]

_ROUNDS = 80
FAULTS = {"ENOSPC": errno.ENOSPC, "EIO": errno.EIO, "EACCES": errno.EACCES, "late": errno.EIO}
_NEEDS_SPACE = {"open", "write", "fsync", "mkdir", "link", "COMMIT", "BEGIN IMMEDIATE"}
_FREE_STEPS = 10**9


@dataclass(frozen=True, kw_only=True)
class Scene:
    """What is handed in: files for INBOX, files for the page by their ID, and the answers that workers gave to them.

    The first of INBOX is computed anew once it was delivered. An answer stands by name and digest of a submission: what
    was told meanwhile, and the answer.
    """

    inbox: dict[str, bytes]
    page: dict[str, tuple[str, bytes]]
    answers: dict[tuple[str, str], tuple[list[bytes], bytes]]


@dataclass(frozen=True, kw_only=True)
class Point:
    """Steps, counted from one, and what happens there; each further step belongs to the run after the one before.

    `how` is `before`, `after` or `half` (a kill before or after the step, or when half is written), or a fault, which
    goes on for `lasting` steps; `late` is one that is told although the step was taken, as network drives do. With a
    system `call` those are counted in place of steps, also within SQLite, and `how` is what strace injects.
    """

    steps: tuple[int, ...] = ()
    how: str = "before"
    lasting: int = 1
    call: str = ""


def scene_of(inbox, page):
    """Return a scene, for which workers answer to every submission."""
    from flexlash.batch.local_executor import local_executor
    from flexlash.batch.side_by_side import computed_apart

    answers, options = {}, service_options(Options())
    with local_executor(2) as executor:
        for name, data in {*inbox.items(), *page.values()}:
            told = []
            task = run_task(name, data, options).as_bytes()
            answers[name, hashlib.sha256(data).hexdigest()] = (told, executor.submit(computed_apart, task, told.append))
        answers = {key: (told, answer.result()) for key, (told, answer) in answers.items()}
    return Scene(inbox=inbox, page=page, answers=answers)


class Replayed:
    """An executor that gives the answers that real workers gave before."""

    workers = 1

    def __init__(self, answers) -> None:
        self._answers = answers

    def submit(self, work, data, told=None):
        """Return the answer to a task, having told what was told."""
        del work
        source, future = Task.of(data).source, Future()
        messages, answer = self._answers[source.name, hashlib.sha256(source.data).hexdigest()]
        for message in messages if told else ():
            told(message)
        future.set_result(answer)
        return future


class Steps:
    """The durable steps of this process: each is counted, and the one that was chosen goes wrong."""

    def __init__(self, step: int = _FREE_STEPS, how: str = "before", lasting: int = 1) -> None:
        self.done = 0
        self.names = []
        self._step, self._how, self._lasting = step, how, lasting

    def take(self, name, step, *arguments, half=None, fault=OSError, **named):
        """Take a step, or what has been chosen instead."""
        self.done += 1
        self.names.append(f"{name} {_site()}")
        if self._how in FAULTS:
            result = step(*arguments, **named) if self._how == "late" else None
            self._fail(name, fault)
            return result if self._how == "late" else step(*arguments, **named)
        is_chosen = self.done == self._step
        if is_chosen and self._how == "before":
            os.kill(os.getpid(), signal.SIGKILL)
        if is_chosen and self._how == "half" and half:
            half()
            os.kill(os.getpid(), signal.SIGKILL)
        result = step(*arguments, **named)
        if is_chosen:
            os.kill(os.getpid(), signal.SIGKILL)
        return result

    def _fail(self, name, fault):
        is_chosen = self._step <= self.done < self._step + self._lasting
        if self._how == "late" and fault is not OSError:
            # A transaction of which SQLite says that it failed does not hold.
            return
        if is_chosen and (self._how != "ENOSPC" or name in _NEEDS_SPACE):
            number = FAULTS[self._how]
            if fault is OSError:
                raise OSError(number, os.strerror(number))
            raise fault({"ENOSPC": "database or disk is full"}.get(self._how, "disk I/O error"))

    def watch(self):
        """Have every durable step of this process counted."""
        for name in ("fsync", "rename", "replace", "link", "unlink", "remove", "mkdir", "rmdir"):
            setattr(os, name, functools.partial(self.take, name, getattr(os, name)))
        real_open, real_fdopen, real_connect = os.open, os.fdopen, sqlite3.connect

        def opened(path, flags, *arguments, **named):
            if flags & (os.O_CREAT | os.O_WRONLY | os.O_RDWR):
                return self.take("open", real_open, path, flags, *arguments, **named)
            return real_open(path, flags, *arguments, **named)

        def connected(*arguments, **named):
            return real_connect(*arguments, **named, factory=functools.partial(_Connection, self))

        os.open = opened
        os.fdopen = lambda handle, *arguments, **named: _File(self, real_fdopen(handle, *arguments, **named))
        sqlite3.connect = connected


def _site():
    """Return where in the service a step is taken, by the functions that lead there from its start."""
    frame, names = sys._getframe(2), []
    while frame:
        if frame.f_globals.get("__name__", "").startswith("flexlash."):
            names.append(frame.f_code.co_name)
        frame = frame.f_back
    return "<".join(names)


class _File:
    """A file whose writes are counted."""

    def __init__(self, steps, file) -> None:
        self._steps, self._file = steps, file

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._file.close()

    def __getattr__(self, name):
        return getattr(self._file, name)

    def write(self, data):
        """Write, or write half of it."""

        def half():
            self._file.write(data[: len(data) // 2])
            self._file.flush()

        return self._steps.take("write", self._file.write, data, half=half)


class _Connection(sqlite3.Connection):
    """A database whose transactions are counted where they begin and where they are committed."""

    def __init__(self, steps, *arguments, **named) -> None:
        self._steps = steps
        super().__init__(*arguments, **named)

    def execute(self, query, *values):
        """Carry out a statement."""
        if query in {"COMMIT", "BEGIN IMMEDIATE"}:
            return self._steps.take(query, super().execute, query, fault=sqlite3.OperationalError)
        return super().execute(query, *values)


class Service:
    """Store, drop folder and dispatcher on one folder, taken step by step until all is done."""

    def __init__(self, root, scene, restarts, said) -> None:
        self._scene, self._now = scene, 1_000_000.0 * (restarts + 1)
        self._root, self._log = root, Log(stream=said)

    def run(self):
        """Go on until all is done; return whether it is."""
        with ExitStack() as stack:
            store = stack.enter_context(Store(self._root / "store", serving=True, clock=lambda: 1.7e9 + self._now))
            places = stack.enter_context(Places.of(self._root / "in", self._root / "out", self._root / "store"))
            opened = lambda: nullcontext(Replayed(self._scene.answers))  # noqa: E731
            dispatcher = Dispatcher(store, opened, Options(), self._log)
            folder = DropFolder(store, places, "options", self._log, clock=lambda: self._now)
            for _ in range(_ROUNDS):
                self._now += 10.0
                for step in (self._hand_in, lambda _: folder.step(), lambda _: dispatcher._step(), self._retry,
                             lambda each: each.sweep(0.0)):  # fmt: skip
                    try:
                        step(store)
                    except ENVIRONMENT_FAULTS as fault:
                        self._log.say("fault", why=fault)
                        self._now += 300.0
                if self._is_done(store) and folder.is_idle:
                    return True
        return False

    def _hand_in(self, store):
        """Send what the page sends, again and again until it is there; each once the one before has ended."""
        for id_, (name, data) in self._scene.page.items():
            found = store.accept(HandedIn(id=id_, name=name, options="options", door="page"), data)
            if not found.has_ended:
                return

    def _retry(self, store):
        """Have the first that came through the folder computed anew, once it was delivered."""
        for found in store.history():
            if self._is_anew(found) and found.has_ended and not _was_retried(store, found.id):
                delivered = all(one.submission != found.id for one in store.undelivered())
                if delivered:
                    store.retry(found.id)

    def _is_done(self, store):
        found = store.history()
        wanted = len(self._scene.inbox) + len(self._scene.page)
        return len(found) == wanted and all(
            one.has_ended and (not self._is_anew(one) or _was_retried(store, one.id)) for one in found
        )

    def _is_anew(self, one):
        return one.name == next(iter(self._scene.inbox))


def _was_retried(store, id_):
    return any(event["kind"] == "retried" for event in store.events(id_))


def once(root, scene, restarts, steps):
    """Run the service in this process; return its steps, what it said, and whether all was done."""
    said = io.StringIO()
    try:
        done = Service(root, scene, restarts, said).run()
    except (*ENVIRONMENT_FAULTS, PlacesError) as fault:
        # It could not start, and says so.
        done = False
        said.write(f"could not start: {fault}\n")
    return {"done": done, "steps": steps.names, "said": said.getvalue()}


def main():
    """Run a scene in a folder once."""
    scene = pickle.loads(Path(sys.argv[1]).read_bytes())  # noqa: S301
    print(json.dumps(once(Path(sys.argv[2]), scene, 0, Steps())))  # noqa: T201


if __name__ == "__main__":
    main()
