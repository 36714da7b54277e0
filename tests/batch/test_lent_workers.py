"""A driver, a process of its own, has work done by the workers of the one that started it."""

from __future__ import annotations

import os
import pickle
import signal
import sys
import threading
import time

import pytest
from worker_tasks import borrow, borrow_and_wait

from flexlash.batch.executor import ClusterError
from flexlash.batch.lent_workers import driven
from flexlash.batch.local_executor import local_executor
from flexlash.workers import StoppedError, Worker

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")]


@pytest.fixture(scope="module")
def executor():
    """Return two workers, a piece of work may cost one of which."""
    with local_executor(2, 1) as executor:
        yield executor


@pytest.fixture
def driver():
    """Return a process that drives."""
    driver = Worker()
    yield driver
    driver.end()


def test_answers_come_back_to_who_wants_them(driver, executor):
    """A hundred pieces of work of several sizes are done by the workers lent, and each answer finds its piece."""
    pieces = [b"%d" % number * (10**5 if number % 10 == 0 else 1) for number in range(100)]
    heard = []
    answer = driven(driver, borrow, executor, heard.append, "doubled", pieces)
    assert pickle.loads(answer) == [piece * 2 for piece in pieces]  # noqa: S301
    assert [pickle.loads(one) for one in heard] == ["begun"]  # noqa: S301


def test_work_that_loses_its_worker_is_tried_three_times(driver, executor, tmp_path):
    """Whatever a piece of work may cost the workers themselves, three losses are too many; it hears of them then."""
    trace = tmp_path / "trace"
    text = f"import os\nopen({str(trace)!r}, 'a').write('x')\nos.kill(os.getpid(), 9)"
    answer = driven(driver, borrow, executor, print, "told", [text.encode()])
    (fault,) = pickle.loads(answer)  # noqa: S301
    assert fault.startswith("WorkerLostError: a worker process was stopped")
    assert trace.read_text() == "xxx"


def test_a_lost_cluster_reaches_the_driver(driver):
    """What an executor raises is raised in the driver."""

    class Lost:
        workers = 1

        def submit(self, *_):
            from concurrent.futures import Future

            future = Future()
            future.set_exception(ClusterError("gone"))
            return future

    assert pickle.loads(driven(driver, borrow, Lost(), print, "doubled", [b"x"])) == ["ClusterError: gone"]  # noqa: S301


def test_a_driver_that_is_killed_gives_up_what_it_wanted(driver, executor):
    """The one that asked is told, what has not begun is not begun, and the workers are free."""
    threading.Timer(1.0, os.kill, (driver._process.pid, signal.SIGKILL)).start()
    begun = time.monotonic()
    with pytest.raises(StoppedError):
        driven(driver, borrow_and_wait, executor, print, 50)
    assert time.monotonic() - begun < 10
    other = Worker()
    assert pickle.loads(driven(other, borrow, executor, print, "doubled", [b"x"])) == [b"xx"]  # noqa: S301
    other.end()
    assert time.monotonic() - begun < 20
