"""A dispatcher over a store of its own, with the submissions that its tests hand in."""

from __future__ import annotations

import io
import time
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path

import pytest
from filled import SOUND
from here import HereExecutor

from flexlash.analysis.options import Options
from flexlash.batch.answer import Answer
from flexlash.schema.exit_codes import ExitCode
from flexlash.service.dispatcher import Dispatcher
from flexlash.service.log import Log
from flexlash.service.records import HandedIn
from flexlash.service.store import Store

__all__ = [
    "BROKEN",
    "GOOD",
    "MIXED",
    "QUICK",
    "Clock",
    "HeldExecutor",
    "dispatching",
    "ended",
    "hand_in",
    "here",
    "table",
]

DATA = Path(__file__).resolve().parents[2] / "data"
QUICK = Options(samples=64)


def table(*torques, mark="", limited=1):
    """Return a table of variants of these torques; `mark` makes its bytes unlike those of others.

    Each variant has a limit, or one of every `limited`.
    """
    free = {"backlash_limit_arcmin": ""}
    rows = [
        {**SOUND, "variant": f"v{number}{mark}", "torque_Nm": one} | (free if number % limited else {})
        for number, one in enumerate(torques)
    ]
    lines = [",".join(SOUND), *(",".join(map(str, row.values())) for row in rows), ""]
    return "\n".join(lines).encode()


GOOD, MIXED, BROKEN = table(800, 700), table(800, "much"), table("much")


class Clock:
    """The time of a store, which a test moves on."""

    def __init__(self):
        self.now = 1_700_000_000.0

    def __call__(self):
        """Return the time."""
        return self.now


class HeldExecutor:
    """An executor of two workers that hold what they are given until a test lets it go."""

    workers = 2

    def __init__(self):
        self.held = []

    def submit(self, work, data, told=None):
        """Return what will be the answer."""
        self.held.append((work, data, told, Future()))
        return self.held[-1][-1]

    def let_go(self, number=0):
        """Have a piece of work end as one that found nothing wrong: what it is about comes after its answer."""
        self.held.pop(number)[-1].set_result(Answer(exit_code=ExitCode.FINE, words="computed").as_bytes())

    def fail(self, fault, number=0):
        """Have a piece of work end with an exception."""
        self.held.pop(number)[-1].set_exception(fault)


@contextmanager
def here():
    """Open an executor that works in this process."""
    yield HereExecutor()


@contextmanager
def dispatching(store, opening=here, options=QUICK, stop=1.0):
    """Give a dispatcher that has begun, and the lines of its log."""
    lines = io.StringIO()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flexlash.service.dispatcher._SECONDS", 0.05)
        dispatcher = Dispatcher(store, opening, options, Log(stream=lines))
    dispatcher.lines = lines
    dispatcher.start()
    try:
        yield dispatcher
    finally:
        dispatcher.stop(stop)


def hand_in(store, content=GOOD, name="a.csv", **how):
    """Hand a submission in and return its ID."""
    return store.accept(HandedIn(name=name, options="o", door="page", **how), content).id


def ended(store, *ids, seconds=60.0):
    """Wait until submissions have ended, and return them."""
    end = time.monotonic() + seconds
    while not all(store.submission(id_).has_ended for id_ in ids):
        assert time.monotonic() < end, [store.submission(id_) for id_ in ids]
        time.sleep(0.01)
    return [store.submission(id_) for id_ in ids]


@contextmanager
def opened(folder, **how):
    """Open a store in a folder as its server."""
    with Store(folder, serving=True, **how) as store:
        yield store
