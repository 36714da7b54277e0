"""The store: each step holds or does not, the same submission is answered again, what is computed anew leaves once."""

from __future__ import annotations

import sqlite3
import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path

import pytest
from dispatching import Clock
from stored import computed, handed, left

from flexlash.service.repeated import ENVIRONMENT_FAULTS
from flexlash.service.store import Store

SOURCE = Path(__file__).resolve().parents[2] / "src"


@pytest.fixture
def clock():
    """Return the time of the store."""
    return Clock()


@pytest.fixture
def store(tmp_path, clock):
    """Return a store that is served, with a webhook."""
    with Store(tmp_path / "store", serving=True, webhook=True, clock=clock) as store:
        yield store


# A step holds, or it does not


def test_r3_a_commit_that_the_disk_refuses_is_undone_and_the_next_holds(store):
    """A real write error at COMMIT (a limit on file sizes) leaves neither a row nor an open transaction behind."""
    resource = pytest.importorskip("resource", reason="this system cannot limit the size of files")
    store.accept(handed("first.csv"), b"1")
    full = store.folder.joinpath("flexlash.sqlite-wal").stat().st_size
    _, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (full, hard))
    try:
        with pytest.raises(ENVIRONMENT_FAULTS):
            store.accept(handed("second.csv"), b"2")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (hard, hard))
    assert not store._database._connection.in_transaction
    assert store.accept(handed("third.csv"), b"3").state == "waiting"
    with sqlite3.connect(store.folder / "flexlash.sqlite") as other:
        assert [name for (name,) in other.execute("SELECT name FROM submission")] == ["first.csv", "third.csv"]


def test_r3_a_commit_that_leaves_its_transaction_open_is_rolled_back(store):
    """Of a COMMIT that SQLite refuses, here because a file belongs to no submission, nothing is left for the next."""
    database = store._database
    with pytest.raises(sqlite3.IntegrityError), database.transaction():  # noqa: PT012
        database.run("PRAGMA defer_foreign_keys = ON")
        database.run("INSERT INTO forgotten VALUES ('x', 0)")
        database.run("INSERT INTO file VALUES ('nobody', 'report', '', 0, '')")
    assert not database._connection.in_transaction
    store.accept(handed(), b"1")
    assert not store.was_forgotten("x")


def test_r3_a_commit_that_fails_in_one_thread_is_not_part_of_the_next_of_another(store):
    """What was undone in one thread is not committed by another thread's transaction."""

    def fail():
        with suppress(ZeroDivisionError), store._database.transaction():
            store._database.run("INSERT INTO forgotten VALUES ('x', 0)")
            1 / 0  # noqa: B018

    thread = threading.Thread(target=fail)
    thread.start()
    thread.join()
    store.accept(handed(), b"1")
    assert not store.was_forgotten("x")


def test_r1_what_was_committed_is_there_after_the_process_was_killed(tmp_path):
    """A process that is killed right after a submission was accepted has kept it, and its lock hinders nobody."""
    code = (
        "import os, sys\nfrom pathlib import Path\nfrom flexlash.service.store import Store\n"
        "from flexlash.service.records import HandedIn\n"
        "store = Store(Path(sys.argv[1]), serving=True)\n"
        "store.accept(HandedIn(id='f' * 32, name='a.csv', options='o', door='page'), b'data')\n"
        "store.take()\nos.kill(os.getpid(), 9)\n"
    )
    folder = tmp_path / "store"
    killed = subprocess.run([sys.executable, "-c", code, folder], env={"PYTHONPATH": str(SOURCE)}, check=False)
    assert killed.returncode in {-9, 9}
    with Store(folder, serving=True) as store:
        assert store.submission("f" * 32).state == "working"
        assert [one.alone for one in store.recover()] == [True]
        assert store.take().server_ends == 0


def test_a_try_in_which_the_server_ends_counts_only_alone(store):
    """The first end of a server has a submission run alone; each further one while it is alone is counted."""
    store.accept(handed(), b"1")
    for ends in (0, 1, 2):
        store.take()
        assert store.recover()[0].server_ends == ends
    store.take()
    store.hand_back(store.history()[0].id)
    assert store.take().server_ends == 2


def test_many_threads_hand_in_at_once(store):
    """Submissions of eight threads are all kept, each once."""

    def hand_in(number):
        for each in range(5):
            store.accept(handed(f"{number}-{each}.csv"), f"{number}-{each}".encode())

    threads = [threading.Thread(target=hand_in, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert store.totals()["waiting"] == 40
    assert {one.number for one in store.history()} == {*range(1, 41)}


def test_the_same_id_is_accepted_once(store):
    """A browser that resends a form gets what is there, whatever the bytes."""
    first = store.accept(handed(id="a" * 32), b"1")
    assert store.accept(handed(id="a" * 32), b"2") == first


# The same submission again


def test_the_same_submission_is_answered_with_the_result_of_the_first(store):
    """Name, content and options decide; the report is that of the first, and leaves the store again."""
    store.accept(handed(), b"1")
    first = computed(store)
    again = store.accept(handed(door="folder"), b"1")
    assert (again.state, again.same_as, again.words) == ("done", first.id, first.words)
    assert store.files(again.id)["report"].sha256 == store.files(first.id)["report"].sha256
    assert left(store) == ["message", "report", "original", "message"]
    for other in (store.accept(handed("b.csv"), b"1"), store.accept(handed(options="p"), b"1"),
                  store.accept(handed(), b"2")):  # fmt: skip
        assert other.state == "waiting"


def test_a_refusal_that_may_end_otherwise_is_no_answer(store):
    """What ended by clock, memory or lost workers is computed anew."""
    store.accept(handed(), b"1")
    computed(store, state="rejected", repeatable=False)
    assert store.accept(handed(), b"1").state == "waiting"


def test_while_the_first_is_computed_anew_another_waits_too(store):
    """The result that a submission had before it is computed anew is not handed out."""
    store.accept(handed(), b"1")
    store.retry(computed(store).id)
    assert store.accept(handed(), b"1").state == "waiting"


def test_a_repetition_outlives_the_first(store):
    """With the first forgotten and its files swept, a repetition has its result, and is the first from then on."""
    store.accept(handed(), b"1")
    first = computed(store)
    again = store.accept(handed(), b"1")
    assert store.forget(first.id)
    store.sweep(-10.0)
    assert store.blobs.read(store.files(again.id)["report"].sha256) == b"report"
    assert not store.submission(again.id).same_as
    assert store.accept(handed(), b"1").same_as == again.id


def test_a_rule_counts_once_for_the_same_submission(store):
    """Handed in thrice, computed anew once: its rule is broken by one submission, also with the first forgotten."""
    store.accept(handed(), b"1")
    first = computed(store)
    store.accept(handed(), b"1")
    store.retry(store.accept(handed(), b"1").id)
    computed(store)
    [most] = store.failing_most()
    assert (most["code"], most["cells"], most["submissions"]) == ("E201", 3, 1)
    store.forget(first.id)
    assert store.failing_most() == [most]


# Computed anew


def test_what_is_computed_anew_keeps_its_files_until_it_has_ended(store):
    """Until the new result is there the report of the last can be had; then the new one replaces it."""
    store.accept(handed(), b"1")
    found = computed(store)
    assert store.retry(found.id)
    store.take()
    assert store.blobs.read(store.files(found.id)["report"].sha256) == b"report"
    store.hand_back(found.id)
    computed(store, report=b"new")
    assert store.blobs.read(store.files(found.id)["report"].sha256) == b"new"


def test_an_original_moves_once_and_files_go_out_again(store):
    """Computed anew, a submission of the folder gets its files delivered anew, its original stays where it is."""
    store.accept(handed(door="folder"), b"1")
    found = computed(store)
    assert left(store) == ["report", "original", "message"]
    store.retry(found.id)
    assert left(store) == []
    computed(store)
    assert left(store) == ["report", "message"]


def test_a_delivery_that_had_begun_goes_on_under_its_name(store):
    """Computed anew before all was delivered, a file keeps the name that was chosen, and nothing goes out twice."""
    store.accept(handed(door="folder"), b"1")
    found = computed(store)
    store.choose_target(store.deliveries()[0], "a-report (2).xlsx")
    store.retry(found.id)
    assert store.deliveries() == []
    computed(store)
    assert [one.target for one in store.deliveries()] == ["a-report (2).xlsx"]
    assert left(store) == ["report", "original", "message"]


def test_a_file_that_the_new_result_lacks_does_not_go_out(store):
    """Planned for the last result and not delivered yet, it is dropped."""
    store.accept(handed(door="folder"), b"1")
    store.retry(computed(store).id)
    computed(store, report=None, state="rejected")
    assert left(store) == ["original", "message"]


def test_another_process_has_a_submission_computed_anew(store):
    """`retry` needs no lock: the server finds it among what waits."""
    store.accept(handed(), b"1")
    found = computed(store)
    with Store(store.folder, serving=False) as other:
        assert other.retry(found.id)
        assert not other.retry(found.id)
    assert store.take().id == found.id


# What is to leave


def test_what_failed_is_tried_again_later_and_says_why(store, clock):
    """A delivery that is postponed is not due before its time; `undelivered` shows it with its reason."""
    store.accept(handed(), b"1")
    computed(store)
    store.postpone(store.deliveries()[0], 5.0, "no answer")
    assert store.deliveries() == []
    assert [(one.trouble, one.tries) for one in store.undelivered()] == [("no answer", 1)]
    clock.now += 6
    assert len(store.deliveries()) == 1


def test_nothing_is_forgotten_before_it_has_left(store):
    """A submission whose original is not moved yet stays; a message that nobody takes holds nothing up."""
    store.accept(handed(door="folder"), b"1")
    found = computed(store)
    assert not store.forget(found.id)
    for _ in range(2):
        store.delivered(store.deliveries()[0])
    assert [one.kind for one in store.undelivered()] == ["message"]
    assert store.forget(found.id)
    assert store.was_forgotten(found.id)
    assert [event["kind"] for event in store.events(found.id)] == ["forgotten"]


# What is asked


def test_a_queue_counts_what_runs_alone_first(store):
    """The position of each that waits is the number of those that `take` gives before it."""
    ids = [store.accept(handed(f"{number}.csv"), b"%d" % number).id for number in range(4)]
    for _ in range(3):
        store.take()
    for id_ in ids[:2]:
        store.hand_back(id_)
    store.recover()
    queue = [one.id for one in store.queue()]
    assert [store.position(one) for one in store.queue()] == [0, 1, 2, 3]
    assert [store.take().id for _ in range(4)] == queue
    assert queue[0] == ids[2]


def test_sizes_are_those_of_what_waits_and_of_what_is_kept(store):
    """What waits counts with its bytes; what is kept counts each content once, results included."""
    store.accept(handed("a.csv"), b"12345")
    store.accept(handed("b.csv"), b"12345")
    assert (store.waiting_bytes(), store.kept_bytes()) == (10, 5)
    computed(store, report=b"123")
    assert (store.waiting_bytes(), store.kept_bytes()) == (5, 8)


def test_what_waits_for_a_time_is_not_held_up_by_a_clock_that_is_set_back(store, clock):
    """A submission and a delivery that met a fault are tried again after minutes, though the clock went back a year."""
    store.accept(handed(), b"1")
    computed(store)
    waiting = store.accept(handed("b.csv"), b"2").id
    store.take()
    store.hand_back(waiting, after=300.0, trouble="disk full")
    (delivery,) = store.deliveries()
    store.postpone(delivery, 300.0, "disk full")
    assert (store.take(), store.deliveries()) == (None, [])
    clock.now -= 365 * 86_400
    assert [one.number for one in store.deliveries()] == [delivery.number]
    assert store.take().id == waiting
