"""What waits is computed, oldest first, and ends once: done, rejected with its reason, or still waiting."""

from __future__ import annotations

import errno
import json
import sqlite3
import threading
import time
from contextlib import contextmanager

import pytest
from dispatching import (
    BROKEN,
    GOOD,
    MIXED,
    Clock,
    HeldExecutor,
    dispatching,
    ended,
    hand_in,
    opened,
)

from flexlash.analysis.options import Options
from flexlash.batch.executor import ClusterError, WorkerLostError
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.service.questions import TooManyQuestionsError


@pytest.fixture
def clock():
    """Return the time of the store."""
    return Clock()


@pytest.fixture
def store(tmp_path, clock):
    """Return a store with its server's lock."""
    with opened(tmp_path / "store", clock=clock) as store:
        yield store


@pytest.fixture
def held():
    """Return an executor whose work a test lets go."""
    return HeldExecutor()


def _opening(executor):
    @contextmanager
    def opening():
        yield executor

    return opening


def _until(condition, seconds=30.0):
    """Wait until something is so."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def _states(store, ids):
    return [store.submission(id_).state for id_ in ids]


ENDINGS = {
    "every row computed": ("a.csv", GOOD, "done", 0, ""),
    "some rows": ("a.csv", MIXED, "done", 3, ""),
    "no row": ("a.csv", BROKEN, "rejected", 4, "Variants!"),
    "damaged": ("a.xlsx", b"PK\3\4nothing", "rejected", 4, "a.xlsx is damaged"),
    "empty": ("a.csv", b"", "rejected", 4, "a.csv"),
    "lock file": ("~$a.xlsx", b"anybody", "rejected", 4, "~$a.xlsx is a lock file by which Excel marks a workbook"),
    "too large": ("a.csv", bytes(2**20 + 1), "rejected", 4, "a.csv exceeds a limit: the file's size"),
    "Parquet too large": ("a.parquet", b"PAR1" + bytes(2**20), "rejected", 4, "a.parquet exceeds a limit"),
}


@pytest.mark.slow
def test_each_submission_ends_as_it_should(store):
    """State and exit code follow the contract; a rejected one says why and how to fix it."""
    options = Options(samples=64, limits=ReadingLimits(file_mebibytes=1))
    with dispatching(store, options=options) as dispatcher:
        ids = {what: hand_in(store, content, name) for what, (name, content, *_) in ENDINGS.items()}
        dispatcher.wake()
        for what, id_ in ids.items():
            (found,) = ended(store, id_)
            _, _, state, code, reason = ENDINGS[what]
            assert (found.state, found.exit_code, found.reason.startswith(reason)) == (state, code, True), found
            assert bool(found.reason) == (state == "rejected")
            files = store.files(id_)
            assert ("report" in files) == (state == "done")
            assert ("reasons" in files) == (code != 0)
            told = json.loads(store.blobs.read(files["outcome"].sha256))
            assert (told["exit_code"], told["sha256"]) == (code, found.sha256)
            assert set(told["outputs"]) == {
                file.name for role, file in files.items() if role not in {"outcome", "page"}
            }


@pytest.mark.slow
def test_a_report_that_is_handed_in_again_is_told_so(store):
    """A report, met again among submissions, is rejected with that reason, and computed by nobody."""
    with dispatching(store):
        (first,) = ended(store, hand_in(store))
        report = store.files(first.id)["report"]
        (again,) = ended(store, hand_in(store, store.blobs.read(report.sha256), report.name))
    assert (report.name, again.state, again.exit_code) == ("a-report.xlsx", "rejected", 4)
    assert again.reason.startswith("a-report.xlsx is a report of flexlash, not a submission")
    assert "report" not in store.files(again.id)


def test_the_oldest_are_begun_first_and_no_more_than_workers_can_have(store, held):
    """Of many that wait the oldest are taken, two for each worker; another when one has ended."""
    ids = [hand_in(store, name=f"{number}.csv") for number in range(8)]
    with dispatching(store, _opening(held), stop=0.0):
        _until(lambda: len(held.held) == 4)
        time.sleep(0.1)
        assert _states(store, ids) == ["working"] * 4 + ["waiting"] * 4
        held.let_go()
        ended(store, ids[0])
        _until(lambda: len(held.held) == 4)
        assert _states(store, ids) == ["done"] + ["working"] * 4 + ["waiting"] * 3


def test_what_a_task_tells_is_there_before_its_answer(store, held):
    """Rows and findings of a submission at work are in the store while a worker still has it."""
    from flexlash.batch.answer import Told

    with dispatching(store, _opening(held), stop=0.0):
        id_ = hand_in(store)
        _until(lambda: held.held)
        told = held.held[0][2]
        told(Told(rows=7, counts={"rows": 9, "errors": 2}, page=b'{"page": 1}').as_bytes())
        _until(lambda: store.submission(id_).rows == 7)
        assert store.submission(id_).counts == {"rows": 9, "errors": 2}
        assert store.blobs.read(store.files(id_)["page"].sha256) == b'{"page": 1}'
        for done in range(1, 7):
            told(Told(rows=7, rows_done=done).as_bytes())
        assert store.submission(id_).state == "working"
        time.sleep(0.6)
        told(Told(rows=7, rows_done=7).as_bytes())
        _until(lambda: store.submission(id_).rows_done == 7)


def test_the_first_rows_and_the_last_are_not_waited_for(store, held):
    """However soon rows follow what was found, some are told at once; so is that the report is being written."""
    from flexlash.batch.answer import Told

    with dispatching(store, _opening(held), stop=0.0):
        id_ = hand_in(store)
        _until(lambda: held.held)
        told = held.held[0][2]
        told(Told(rows=7, counts={"rows": 7}, page=b"{}").as_bytes())
        told(Told(rows=7, rows_done=3, stage="computing").as_bytes())
        _until(lambda: store.submission(id_).rows_done == 3)
        told(Told(rows=7, rows_done=5, stage="computing").as_bytes())
        told(Told(rows=7, rows_done=7, stage="writing").as_bytes())
        _until(lambda: store.submission(id_).rows_done == 7)


def test_rows_are_written_down_at_most_twice_a_second(store, held, monkeypatch):
    """However often a task tells its rows, the store is written to twice a second."""
    from flexlash.batch.answer import Told

    written = []
    monkeypatch.setattr(store, "note_rows", lambda *facts: written.append(facts))
    with dispatching(store, _opening(held), stop=0.0):
        hand_in(store)
        _until(lambda: held.held)
        begun = time.monotonic()
        while time.monotonic() < begun + 1.2:
            held.held[0][2](Told(rows=1000, rows_done=1).as_bytes())
            time.sleep(0.005)
        _until(lambda: written)
    assert 2 <= len(written) <= 4


def test_a_lost_worker_is_counted_and_three_are_too_many(store, held):
    """A submission that loses its worker waits again at once; the third loss rejects it, and it can be tried anew."""
    with dispatching(store, _opening(held)):
        id_ = hand_in(store, name="p.csv")
        for tries in range(3):
            _until(lambda: held.held)
            assert store.submission(id_).tries == tries
            begun = time.monotonic()
            held.fail(WorkerLostError("a worker process was stopped 1 times", losses=1))
            _until(lambda: held.held or store.submission(id_).has_ended)
            assert time.monotonic() - begun < 1
        (found,) = ended(store, id_)
        assert (found.state, found.exit_code) == ("rejected", 4)
        assert found.reason == "p.csv stopped the worker 3 times, so it was not computed."
        assert "stopped the worker 3 times" in store.blobs.read(store.files(id_)["reasons"].sha256).decode()
        again = hand_in(store, name="p.csv")
        assert not store.submission(again).same_as
        _until(lambda: held.held)
        held.let_go()
        assert ended(store, again)[0].state == "done"


def test_a_limit_that_stops_the_worker_rejects_at_once(store, held):
    """A file that exceeds its time is not tried again by itself; its sender may."""
    with dispatching(store, _opening(held)):
        id_ = hand_in(store)
        _until(lambda: held.held)
        held.fail(WorkerLostError("a worker process exceeded its seconds", "seconds", 1))
        (found,) = ended(store, id_)
        assert (found.state, found.exit_code) == ("rejected", 4)
        assert found.reason.startswith("a.csv exceeds a limit: the time for reading is more than 20 s")
        assert not store.submission(hand_in(store)).same_as


def test_a_fault_of_the_program_ends_one_submission(store, held):
    """An internal error rejects its submission with exit code 1 and says that the file is not to blame."""
    from flexlash.reading.limited_process import ProcessFaultError

    with dispatching(store, _opening(held)) as dispatcher:
        id_, other = hand_in(store), hand_in(store, name="b.csv")
        _until(lambda: len(held.held) == 2)
        held.fail(ProcessFaultError("ZeroDivisionError in a worker process\nTraceback"))
        held.let_go()
        found, fine = ended(store, id_, other)
        assert (found.state, found.exit_code, fine.state) == ("rejected", 1, "done")
        assert "this is a fault of flexlash, not of your file" in found.reason
        assert not store.submission(hand_in(store)).same_as
    assert "Traceback" not in dispatcher.lines.getvalue()


FAULTS = {
    "keeping a result": ("blobs.put", OSError(errno.ENOSPC, "No space left on device")),
    "reading a submission": ("blobs.path", OSError(errno.EIO, "Input/output error")),
    "writing down the end": ("end", sqlite3.OperationalError("database or disk is full")),
}


@pytest.mark.parametrize("where", FAULTS)
@pytest.mark.parametrize("times", [1, 3])
def test_a_fault_of_the_machine_has_a_submission_wait(store, clock, monkeypatch, where, times):
    """Where the disk is full or gone a submission waits, longer each time, says why, and is done in the end."""
    name, fault = FAULTS[where]
    owner = store.blobs if name.startswith("blobs.") else store
    name = name.removeprefix("blobs.")
    real, left = getattr(owner, name), [times]

    def failing(*facts, **further):
        is_result = name != "put" or facts[0].startswith(b"PK")
        if threading.current_thread().name == "flexlash dispatcher" and left[0] and is_result:
            left[0] -= 1
            raise fault
        return real(*facts, **further)

    monkeypatch.setattr(owner, name, failing)
    with dispatching(store) as dispatcher:
        id_ = hand_in(store)
        for rest in (5.0, 10.0, 20.0)[:times]:
            dispatcher.wake()
            _until(lambda rest=rest: store.submission(id_).not_before == clock.now + rest, 60)
            found = store.submission(id_)
            assert (found.state, found.tries) == ("waiting", 0)
            assert str(fault.args[-1]) in found.trouble
            clock.now += rest
        dispatcher.wake()
        assert ended(store, id_)[0].state == "done"
    assert store.submission(id_).trouble == ""


def test_a_store_that_cannot_be_written_to_loses_nothing(store, clock, monkeypatch):
    """Where even handing back fails it is done as soon as the store can be written to."""
    real, is_full = store._database.run, threading.Event()

    def failing(*facts):
        if is_full.is_set() and threading.current_thread().name == "flexlash dispatcher":
            raise sqlite3.OperationalError("database or disk is full")
        return real(*facts)

    executor = HeldExecutor()
    monkeypatch.setattr(store._database, "run", failing)
    with dispatching(store, _opening(executor)) as dispatcher:
        id_ = hand_in(store)
        _until(lambda: executor.held)
        is_full.set()
        executor.let_go()
        _until(lambda: "what=dispatcher why=database or disk is full" in dispatcher.lines.getvalue())
        is_full.clear()
        dispatcher.wake()
        _until(lambda: store.submission(id_).state == "waiting")
        clock.now += 300
        dispatcher.wake()
        _until(lambda: executor.held)
        executor.let_go()
        assert ended(store, id_)[0].state == "done"


def test_lost_workers_of_a_cluster_blame_nobody(store, clock, monkeypatch):
    """When the scheduler is lost everything waits, without a try counted, and others come."""
    monkeypatch.setattr("flexlash.service.open_executor.back_off", lambda _: 0.0)
    executors = []

    @contextmanager
    def opening():
        executors.append(HeldExecutor())
        if len(executors) == 2:
            raise ClusterError("the Dask scheduler at tcp://10.0.0.1:8786 is not reachable")
        yield executors[-1]

    with dispatching(store, opening) as dispatcher:
        ids = [hand_in(store, name=f"{number}.csv") for number in range(3)]
        _until(lambda: executors and len(executors[0].held) == 3)
        executors[0].fail(ClusterError("the Dask scheduler at tcp://10.0.0.1:8786 is not reachable"))
        _until(lambda: len(executors) == 3 and len(executors[2].held) == 2)
        assert [store.submission(id_).tries for id_ in ids] == [0, 0, 0]
        assert "is not reachable" in store.submission(ids[0]).trouble
        clock.now += 5
        dispatcher.wake()
        _until(lambda: len(executors[2].held) == 3)
        for _ in ids:
            executors[2].let_go()
        assert [one.state for one in ended(store, *ids)] == ["done"] * 3


def test_what_was_at_work_when_the_server_ended_runs_alone_first(store, held):
    """After a server that ended in the middle what was at work comes before what is older, and runs alone."""
    ids = [hand_in(store, name=f"{number}.csv") for number in range(4)]
    store.take(), store.take()
    store.hand_back(ids[0], after=0.001)
    store._clock.now += 1
    with dispatching(store, _opening(held)):
        _until(lambda: held.held)
        time.sleep(0.1)
        assert _states(store, ids) == ["waiting", "working", "waiting", "waiting"]
        held.let_go()
        ended(store, ids[1])
        _until(lambda: len(held.held) == 3)
        while held.held:
            held.let_go()
        assert [one.state for one in ended(store, *ids)] == ["done"] * 4


def test_one_that_is_to_run_alone_waits_until_the_others_have_ended(store, clock, held):
    """What may be begun again only later runs alone all the same, and the others are not begun beside it."""
    first = hand_in(store)
    store.take()
    store.recover()
    store.take()
    store.hand_back(first, after=5.0, trouble="disk full")
    others = [hand_in(store, name=f"{number}.csv") for number in range(3)]
    with dispatching(store, _opening(held)) as dispatcher:
        _until(lambda: len(held.held) == 3)
        clock.now += 6
        dispatcher.wake()
        late = hand_in(store, name="late.csv")
        time.sleep(0.2)
        assert _states(store, [first, late]) == ["waiting", "waiting"]
        while held.held:
            held.let_go()
        ended(store, *others)
        _until(lambda: held.held)
        time.sleep(0.1)
        assert _states(store, [first, late]) == ["working", "waiting"]
        held.let_go()
        _until(lambda: held.held)
        held.let_go()
        ended(store, first, late)


def test_what_ends_the_server_three_times_while_alone_is_rejected(store, held):
    """The fourth server rejects it without looking into it, and goes on with the others."""
    id_ = hand_in(store, name="p.csv")
    for _ in range(4):
        store.recover()
        store.take()
    other = hand_in(store, name="b.csv")
    with dispatching(store, _opening(held)):
        (found,) = ended(store, id_)
        assert (found.state, found.exit_code) == ("rejected", 4)
        assert found.reason == "p.csv was alone at work 3 times when the server ended."
        _until(lambda: held.held)
        held.let_go()
        assert ended(store, other)[0].state == "done"


def test_a_stop_lets_work_end_and_hands_back_the_rest(store, held):
    """What ends in time ends; the rest waits again, with no try and no server counted, and nothing else is begun."""
    ids = [hand_in(store, name=f"{number}.csv") for number in range(5)]
    with dispatching(store, _opening(held), stop=1.0) as dispatcher:
        _until(lambda: len(held.held) == 4)
        threading.Timer(0.3, held.let_go).start()
        begun = time.monotonic()
        dispatcher.stop(1.0)
        assert time.monotonic() - begun < 7
    assert _states(store, ids) == ["done"] + ["waiting"] * 4
    left = [store.submission(id_) for id_ in ids[1:]]
    assert {(one.tries, one.alone, one.server_ends, one.not_before) for one in left} == {(0, False, 0, 0.0)}
    assert store.recover() == []


def test_a_stop_ends_though_workers_do_not(store):
    """Workers that cannot be ended hold a stop up no longer than it may take."""
    is_over = threading.Event()

    @contextmanager
    def opening():
        yield HeldExecutor()
        is_over.wait(60)

    with dispatching(store, opening) as dispatcher:
        id_ = hand_in(store)
        _until(lambda: store.submission(id_).state == "working")
        begun = time.monotonic()
        dispatcher.stop(0.5)
        assert time.monotonic() - begun < 7
        is_over.set()
    assert store.submission(id_).state == "waiting"


def test_a_file_is_checked_and_nothing_of_it_is_kept(store):
    """Checking answers with the findings, and leaves neither a row nor a file."""
    with dispatching(store) as dispatcher:
        answer = dispatcher.check("a.csv", MIXED).result(30)
    assert (answer.exit_code, answer.told["counts"]["errors"]) == (3, 1)
    assert store.history() == []
    assert [path for path in store.folder.rglob("*") if path.is_file() and "blobs" in path.parts] == []


def test_no_more_files_are_checked_than_there_is_room_for(store, held):
    """The ninth file is refused while eight are open; another is taken when one has ended."""
    with dispatching(store, _opening(held)) as dispatcher:
        futures = [dispatcher.check("a.csv", GOOD) for _ in range(8)]
        with pytest.raises(TooManyQuestionsError, match="8 files are being checked already; try again in a moment"):
            dispatcher.check("a.csv", GOOD)
        _until(lambda: len(held.held) == 8)
        held.let_go()
        assert futures[0].result(10).exit_code == 0
        _until(lambda: dispatcher.check("a.csv", GOOD))
        held.fail(WorkerLostError("a worker process was stopped 1 times", losses=1))
        assert futures[1].result(10).told["findings"][0]["code"] == "E118"
        held.fail(WorkerLostError("no worker process can be started"))
        with pytest.raises(ClusterError, match="no worker process can be started"):
            futures[2].result(10)
        held.held[0][-1].cancel()
        with pytest.raises(ClusterError, match="the workers have ended"):
            futures[3].result(10)
