"""Pieces of work done by processes of this machine: all are done, in order, whatever becomes of a process."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time

import pytest
import regenerate
from in_order import in_order
from worker_tasks import doubled, leave, random_bytes, read_within, tell_and_wait, tell_each, told

from flexlash.batch.executor import WorkerLostError
from flexlash.batch.local_executor import local_executor
from flexlash.workers import Workers

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL, no limits here")]

NUMBER = b"import os; answer['x'] = os.getpid()"


@pytest.fixture(scope="module")
def executor():
    """Return an executor of two processes."""
    with local_executor(2) as executor:
        yield executor


def _numbers(executor):
    """Return the processes of an executor."""
    found = {}
    while len(found) < executor.workers:
        text = NUMBER + b"; import time; time.sleep(0.1)"
        for future in [executor.submit(told, text) for _ in range(executor.workers)]:
            found[json.loads(future.result())["x"]] = True
    return list(found)


def test_bytes_come_back_in_the_order_of_the_items(executor):
    """Each item's answer is yielded at its place, and no more items are taken than the window holds."""
    taken = []

    def items():
        for number in range(40):
            taken.append(number)
            yield str(number).encode()

    for place, future in enumerate(in_order(executor, doubled, items(), 4)):
        assert future.result() == 2 * str(place).encode()
        assert len(taken) <= place + 4
    assert len(taken) == 40


def test_pieces_are_done_side_by_side_by_other_processes(executor):
    """Two processes, neither of them this one, work at the same time."""
    numbers = _numbers(executor)
    assert len(set(numbers)) == 2
    assert os.getpid() not in numbers


def test_files_are_read_in_the_worker_itself(executor):
    """A worker reads within limits that end with the file, and starts no process for it."""
    text = b"import os, resource as r; answer['x'] = [os.getpid(), r.getrlimit(r.RLIMIT_FSIZE)[0]]"
    number, size = json.loads(executor.submit(read_within, b"{}\n" + text).result())["x"]
    assert number in _numbers(executor)
    assert size == 0
    text = b"import os, resource as r, threading; answer['x'] = r.getrlimit(r.RLIMIT_FSIZE)[0]"
    assert json.loads(executor.submit(told, text).result())["x"] != 0


EXCEEDED = {
    "hangs": ("import time; time.sleep(60)", {"seconds": 1}, "seconds"),
    "loops in C, which keeps the interpreter": ("import re; re.match(r'(a+)+$', 'a' * 60 + 'b')", {"seconds": 1},
                                                "seconds"),
    "computes for ever": ("while True: pass", {"processor_seconds": 1}, "processor_seconds"),
}  # fmt: skip


@pytest.mark.parametrize("what", EXCEEDED)
def test_a_limit_that_stops_the_worker_is_named_at_once(executor, what):
    """A file that takes too long costs one worker, not three, and the limit is named; other pieces go on."""
    text, limits, setting = EXCEEDED[what]
    before = set(_numbers(executor))
    poison = executor.submit(read_within, f"{json.dumps(limits)}\n{text}".encode())
    others = [executor.submit(doubled, b"x") for _ in range(20)]
    with pytest.raises(WorkerLostError) as lost:
        poison.result()
    assert lost.value.setting == setting
    assert all(other.result() == b"xx" for other in others)
    assert len(before & set(_numbers(executor))) == 1


def test_memory_is_refused_in_place(executor):
    """A file that needs too much memory is refused by the worker that reads it, which lives on."""
    before = sorted(_numbers(executor))
    text = b'{"memory_mebibytes": 300}\nx = bytearray(3 * 2**30)'
    assert json.loads(executor.submit(read_within, text).result()) == {"refused": "memory_mebibytes"}
    assert sorted(_numbers(executor)) == before


def test_a_fault_of_the_program_is_told_in_words(executor):
    """Whatever a piece of work raises arrives as a RuntimeError with its trace, even what cannot travel."""
    own = b"class Own(Exception):\n    def __init__(self, a, b): super().__init__(a)\nraise Own(1, 2)"
    for text, kind in ((own, "Own"), (b"raise SystemExit(3)", "SystemExit"), (b"1 / 0", "ZeroDivisionError")):
        with pytest.raises(RuntimeError, match=f"^{kind} in a worker process\n(.|\n)*Traceback"):
            executor.submit(told, text).result()
    with pytest.raises(RuntimeError, match="ValueError in the limited process"):
        executor.submit(read_within, b"{}\nraise ValueError('no')").result()


def test_work_that_kills_every_worker_is_told(executor, tmp_path):
    """A piece of work that stops three workers is given up, having been tried three times; others are done."""
    trace = tmp_path / "trace"
    text = f"import os\nopen({str(trace)!r}, 'a').write('x')\nos.kill(os.getpid(), 9)"
    poison = executor.submit(told, text.encode())
    others = [executor.submit(doubled, b"x") for _ in range(20)]
    with pytest.raises(WorkerLostError, match="3 times") as lost:
        poison.result()
    assert (lost.value.setting, trace.read_text()) == ("", "xxx")
    assert all(other.result() == b"xx" for other in others)


def test_what_has_not_begun_can_be_cancelled(executor):
    """A piece of work that waits is cancelled and never done."""
    busy = [executor.submit(told, b"import time; time.sleep(0.3)") for _ in range(2)]
    waiting = executor.submit(doubled, b"x")
    assert waiting.cancel()
    assert [future.result() for future in busy] == [b"{}", b"{}"]
    assert executor.submit(doubled, b"x").result() == b"xx"


def test_what_a_worker_tells_comes_in_order_before_the_answer(executor):
    """Each message of a worker reaches the one that asked, in order, before the answer; others hear nothing of it."""
    heard, others = [], []
    future = executor.submit(tell_each, b"abc" * 100, heard.append)
    beside = executor.submit(doubled, b"x", others.append)
    assert future.result() == b"abc" * 200
    assert b"".join(heard) == b"abc" * 100
    assert (beside.result(), others) == (b"xx", [])
    assert executor.submit(tell_each, b"abc").result() == b"abcabc"


def test_a_listener_that_fails_harms_nobody(executor):
    """Whatever is raised by the one that is told, answers come back, each to the work that it is the answer of."""

    def leave_at_once(message):
        raise SystemExit(message)

    futures = [executor.submit(tell_each, b"%d" % number, leave_at_once) for number in range(20)]
    assert [future.result() for future in futures] == [b"%d" % number * 2 for number in range(20)]


def test_telling_buys_no_time(executor):
    """A worker that tells again and again is stopped by its clock all the same."""
    with pytest.raises(WorkerLostError) as lost:
        executor.submit(tell_and_wait, b"30", lambda _: None).result(20)
    assert (lost.value.setting, lost.value.losses) == ("seconds", 1)


@pytest.mark.parametrize("tries", [1, 2])
def test_a_piece_of_work_costs_no_more_workers_than_allowed(tries, tmp_path):
    """Work that kills its worker is tried as often as is said, and how many workers it has cost is told."""
    trace = tmp_path / "trace"
    text = f"import os\nopen({str(trace)!r}, 'a').write('x')\nos.kill(os.getpid(), 9)"
    with local_executor(1, tries) as executor:
        with pytest.raises(WorkerLostError) as lost:
            executor.submit(told, text.encode()).result()
        assert (lost.value.losses, trace.read_text()) == (tries, "x" * tries)


def test_killed_at_any_moment_nothing_is_lost_or_mixed_up():
    """Workers killed at any moment, mostly in the middle of a long answer, change no byte and hold nothing up."""
    draw = random.Random(3)  # noqa: S311
    items = [f"{number} {draw.choice([10, 10**5, 5 * 10**7])}".encode() for number in range(24)]
    with Workers(2) as workers:
        killed = []
        for place, (item, future) in enumerate(zip(items, in_order(workers, random_bytes, items, 4), strict=True)):
            assert future.result() == random_bytes(item)
            if place % 4 == 1:
                killed.append(json.loads(workers.submit(told, NUMBER).result())["x"])
                time.sleep(draw.uniform(0, 0.2))
                os.kill(killed[-1], signal.SIGKILL)
        assert len(set(killed)) == 6


def test_the_work_of_a_killed_worker_is_handed_back_at_once(executor, tmp_path):
    """Another worker that is free begins the work of a killed one within a second."""
    first = tmp_path / "first"
    text = f"""
import os, time, pathlib
path = pathlib.Path({str(first)!r})
if path.exists():
    answer['x'] = time.time()
else:
    path.touch()
    path.write_text(str(time.time()))
    os.kill(os.getpid(), 9)
"""
    _numbers(executor)
    again = json.loads(executor.submit(told, text.encode()).result())["x"]
    assert again - float(first.read_text()) < 1


ALONE = """
import sys
sys.path[:0] = {paths!r}
from flexlash.batch.local_executor import local_executor
from flexlash.workers import Workers
from worker_tasks import told
with local_executor(2) as executor:
    work = b"print('hello'); import time; time.sleep(0 if {brief} else 60)"
    futures = [executor.submit(told, work) for _ in range(6)]
    print(flush=True)
    print([future.result() for future in futures])
print("ended")
"""


def _processes_of(group):
    """Return the processes of a group that still run."""
    done = subprocess.run(["ps", "-o", "pid=", "-g", str(group)], capture_output=True, text=True, check=False)
    return done.stdout.split()


def test_workers_that_cannot_start_are_told():
    """Workers that end while they start are given up, and what is asked of them is told, at once and for ever."""
    with Workers(2, leave) as workers:
        for _ in range(2):
            with pytest.raises(WorkerLostError, match="no worker process can be started"):
                workers.submit(doubled, b"x").result()


def test_idle_workers_that_were_killed_cost_nothing():
    """A worker that is killed while it waits is replaced; the next piece of work loses nothing by it."""
    with Workers(1) as workers:
        for _ in range(5):
            os.kill(json.loads(workers.submit(told, NUMBER).result())["x"], signal.SIGKILL)
        assert workers.submit(doubled, b"x").result() == b"xx"


@pytest.mark.parametrize("wait", [0.0, 0.1, 3.0])
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_no_process_stays(how, wait, tmp_path):
    """Ctrl-C, which reaches all processes, and a kill of the program alone end everything, also while workers start."""
    code = ALONE.format(paths=[str(regenerate.ROOT / one) for one in ("src", "tests/support")], brief=False)
    with subprocess.Popen(
        [sys.executable, "-c", code],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True, cwd=tmp_path,
    ) as command:  # fmt: skip
        command.stdout.readline()
        time.sleep(wait)
        (os.killpg if how == signal.SIGINT else os.kill)(command.pid, how)
        assert command.wait(10) != 0
        complaints = command.stderr.read()
    assert complaints.count("Traceback") == (how == signal.SIGINT)
    end = time.monotonic() + 5
    while _processes_of(command.pid) and time.monotonic() < end:
        time.sleep(0.1)
    assert _processes_of(command.pid) == []


def test_an_unguarded_script_is_not_run_again(tmp_path):
    """A script without a guard may use an executor; nothing that its workers print is seen."""
    script = tmp_path / "alone.py"
    paths = [str(regenerate.ROOT / one) for one in ("src", "tests/support")]
    script.write_text(ALONE.format(paths=paths, brief=True), encoding="utf-8")
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False, timeout=60)
    assert (done.stdout.split(), done.stderr) == ([*f"[{'b{}, ' * 5}b{{}}]".replace("{}", "'{}'").split(), "ended"], "")
