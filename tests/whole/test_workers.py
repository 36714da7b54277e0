"""Work in worker processes: the same results in the same order, also when one is lost; none stays behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from multiprocessing import active_children

import pytest
import regenerate
from worker_tasks import die, die_once, square

from flexlash.workers import WorkerLostError, Workers, mapped


def test_one_worker_is_this_process():
    """With one worker, or none, everything is done here."""
    for count in (0, 1):
        assert list(mapped(square, [1, 2, 3], count)) == [(1, os.getpid()), (4, os.getpid()), (9, os.getpid())]


def test_workers_keep_the_order_and_are_other_processes():
    """Two workers give the results in the order of the items, from other processes."""
    found = list(mapped(square, range(6), 2))
    assert [value for value, _ in found] == [0, 1, 4, 9, 16, 25]
    assert os.getpid() not in {process for _, process in found}


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL here")
def test_the_work_of_a_killed_worker_is_done_by_another(tmp_path):
    """A worker that the system kills costs its own item one more try, and no other item anything."""
    items = [(number, str(tmp_path / "died")) for number in range(5)]
    assert list(mapped(die_once, items, 2)) == [0, 1, 2, 3, 4]
    assert (tmp_path / "died").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL here")
def test_work_that_kills_every_worker_is_told():
    """An item that stops three workers is not tried in this process, which it would stop as well."""
    found = mapped(die, [(number, os.getpid()) for number in range(4)], 2)
    assert [next(found), next(found)] == [0, 1]
    with pytest.raises(WorkerLostError, match="3 times"):
        next(found)


def test_where_no_process_can_be_started_all_is_done_here(monkeypatch):
    """Where the system starts no process, the work is done in this one."""

    def refuse(*_):
        raise OSError(11, "Resource temporarily unavailable")

    monkeypatch.setattr("flexlash.workers._Process.start", refuse)
    assert list(mapped(square, [1, 2, 3], 2)) == [(1, os.getpid()), (4, os.getpid()), (9, os.getpid())]


def test_nothing_asks_for_nothing():
    """No items give no results, whatever the workers."""
    assert list(mapped(square, [], 2)) == []


SLEEPING = """
import sys
sys.path[:0] = {paths!r}
from flexlash.workers import mapped
from worker_tasks import sleep, square
for _, number in mapped(square, [1, 2, 3, 4, 5, 6], 2):
    print(number)
print(flush=True)
list(mapped(sleep, [2, 2], 2))
"""


def _processes_of(group):
    """Return the processes of a group that still run."""
    done = subprocess.run(["ps", "-o", "pid=", "-g", str(group)], capture_output=True, text=True, check=False)
    return done.stdout.split()


@pytest.mark.skipif(sys.platform != "linux", reason="processes are listed by ps")
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_worker_stays(how, tmp_path):
    """Ctrl-C, a request to end and a kill of the program leave neither workers nor their helpers behind."""
    paths = [str(regenerate.ROOT / one) for one in ("src", "tests/support")]
    with subprocess.Popen(
        [sys.executable, "-c", SLEEPING.format(paths=paths)],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, start_new_session=True, cwd=tmp_path,
    ) as command:  # fmt: skip
        while command.stdout.readline().strip():
            pass
        time.sleep(1)
        command.send_signal(how)
        assert command.wait(20) != 0
    end = time.monotonic() + 20
    while _processes_of(command.pid) and time.monotonic() < end:
        time.sleep(0.2)
    assert _processes_of(command.pid) == []


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="no signals are held back here")
def test_ctrl_c_while_workers_start_leaves_none(monkeypatch):
    """Ctrl-C between the start of the processes and that of the threads beside them ends them all, and is heard."""
    start = threading.Thread.start
    # Workers of an earlier test may still be at hand in this process.
    others, threads = set(active_children()), set(threading.enumerate())

    def interrupted(thread):
        signal.raise_signal(signal.SIGINT)
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", interrupted)
    with pytest.raises(KeyboardInterrupt):
        Workers(2)
    assert set(active_children()) <= others
    assert not [new for new in set(threading.enumerate()) - threads if new.name.startswith("flexlash worker")]
