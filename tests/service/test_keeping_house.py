"""What was kept long enough is forgotten, its bytes go, its ID is known; a backup is whole whenever it is taken."""

from __future__ import annotations

import io
import os
import shutil
import threading
import time
from collections import namedtuple

import pytest
from dispatching import Clock
from stored import computed, handed, left

from flexlash.service import backup
from flexlash.service.backup import back_up
from flexlash.service.blobs import Blobs
from flexlash.service.keeper import Keeper
from flexlash.service.log import Log
from flexlash.service.outbox import Outbox
from flexlash.service.store import Store
from flexlash.service.store_place import StoreError

DAY = 86_400.0
Usage = namedtuple("Usage", "total used free")  # noqa: PYI024


@pytest.fixture
def clock():
    """Return the time of the store."""
    return Clock()


@pytest.fixture
def store(tmp_path, clock):
    """Return a store that is served."""
    with Store(tmp_path / "store", serving=True, clock=clock) as store:
        yield store


def kept_house(store, clock, said=None):
    """Keep house until nothing is to be done."""
    keeper = Keeper(store, 90 * DAY, Log(stream=said or io.StringIO()), clock)
    while keeper.step():
        pass
    return keeper


def test_what_ended_long_ago_is_forgotten_and_its_id_known(store, clock):
    """After 90 days a submission, its events and its bytes are gone; what ended later, waits, or has not left stays."""
    store.accept(handed("old.csv"), b"old")
    old = computed(store, report=b"old report")
    store.accept(handed("here.csv", door="folder"), b"here")
    here = computed(store)
    store.accept(handed("waits.csv"), b"waits")
    clock.now += 89 * DAY
    kept_house(store, clock)
    assert store.totals()["done"] == 2
    clock.now += 2 * DAY
    for path in store.blobs._folder.glob("??/*"):
        os.utime(path, (time.time() - 91 * DAY,) * 2)
    kept_house(store, clock)
    assert [one.name for one in store.history()] == ["waits.csv", "here.csv"]
    assert store.was_forgotten(old.id)
    assert not store.was_forgotten(here.id)
    assert {path.read_bytes() for path in store.blobs._folder.glob("??/*")} == {b"here", b"report", b"waits"}
    left(store)
    kept_house(store, clock)
    assert [one.name for one in store.history()] == ["waits.csv"]


def test_ids_of_the_forgotten_are_known_ten_times_as_long(store, clock):
    """The address of a forgotten submission says so for 900 days; the events of the store are as old as submissions."""
    store.accept(handed(), b"1")
    found = computed(store)
    clock.now += 91 * DAY
    kept_house(store, clock)
    clock.now += 899 * DAY
    kept_house(store, clock)
    assert store.was_forgotten(found.id)
    assert store.events() == []
    clock.now += 2 * DAY
    kept_house(store, clock)
    assert not store.was_forgotten(found.id)


def test_what_is_old_is_forgotten_piece_by_piece(store, clock):
    """What is forgotten at once is bounded, the oldest first, so that others of the service's work need not wait."""
    for number in range(8):
        store.accept(handed(f"{number}"), b"1")
        computed(store, report=None)
        clock.now += 1
    clock.now += 91 * DAY
    assert store.forget_ended(clock.now, most=3) == 3
    assert [one.name for one in store.history()] == ["7", "6", "5", "4", "3"]
    kept_house(store, clock)
    assert store.totals()["done"] == 0


def test_a_full_disk_is_told_once(store, clock, monkeypatch):
    """Little space is a warning of the store, and one line in the log, not one an hour."""
    monkeypatch.setattr(shutil, "disk_usage", lambda _: Usage(10**12, 10**12, 10 * 2**20))
    assert store.warnings() == ["the disk of the store has only 10 MiB left"]
    said = io.StringIO()
    keeper = kept_house(store, clock, said)
    keeper.step()
    assert said.getvalue().count("only 10 MiB left") == 1


# Backups


def whole(folder):
    """Return the names of all submissions of a store that is served from a folder; every file it names is whole."""
    with Store(folder, serving=True) as copy:
        assert [sha256 for sha256, _ in copy.named() if not copy.blobs.is_whole(sha256)] == []
        copy.recover()
        return sorted(one.name for one in copy.history(most=10_000))


def test_a_backup_is_a_store_that_goes_on(store, tmp_path):
    """Served from the copy, what was done is there, what waited is computed, under the same name of the store."""
    store.accept(handed("done.csv"), b"1")
    done = computed(store)
    store.accept(handed("waits.csv"), b"2")
    told = back_up(store, tmp_path / "copy")
    assert (told.copied, told.copied_before, told.damaged) == (3, 0, [])
    with Store(tmp_path / "copy", serving=True) as copy:
        assert copy.name == store.name
        assert copy.blobs.read(copy.files(done.id)["report"].sha256) == b"report"
        assert computed(copy).name == "waits.csv"
    assert store.totals()["waiting"] == 1


def test_a_second_backup_copies_what_is_new_and_drops_what_is_forgotten(store, tmp_path):
    """What is there is not copied again, what the store forgot goes from the copy."""
    store.accept(handed("a"), b"1")
    first = computed(store, report=b"first")
    back_up(store, tmp_path / "copy")
    store.accept(handed("b"), b"2")
    computed(store, report=b"second")
    store.forget(first.id)
    told = back_up(store, tmp_path / "copy")
    assert (told.copied, told.copied_before) == (2, 0)
    assert {path.read_bytes() for path in (tmp_path / "copy" / "blobs").glob("??/*")} == {b"2", b"second"}
    assert back_up(store, tmp_path / "copy").copied == 0


@pytest.mark.slow
def test_a_backup_taken_while_the_store_is_written_is_whole(store, tmp_path):
    """While submissions come, end and are forgotten and files swept, each backup has every file that it names."""
    ended = threading.Event()

    def busy():
        number = 0
        while not ended.is_set():
            number += 1
            store.accept(handed(f"{number}"), b"%d" % number)
            found = computed(store, report=b"report %d" % number)
            if number % 3 == 0:
                store.forget(found.id)
                store.sweep(-10.0)

    writer = threading.Thread(target=busy)
    writer.start()
    try:
        for number in range(5):
            with Outbox.opened(store.folder) as held:
                back_up(held, tmp_path / f"copy{number % 2}")
    finally:
        ended.set()
        writer.join()
    assert len(whole(tmp_path / "copy0")) >= len(whole(tmp_path / "copy1")) > 0


def test_nothing_is_swept_while_a_backup_is_made(store, tmp_path, monkeypatch):
    """A file that is forgotten after the database was copied is still there when its turn comes."""
    store.accept(handed(), b"1")
    found = computed(store)
    real = backup._copied

    def late(*arguments):
        store.forget(found.id)
        assert store.sweep(-10.0) == 0
        return real(*arguments)

    monkeypatch.setattr(backup, "_copied", late)
    assert back_up(store, tmp_path / "copy").damaged == []
    assert store.sweep(-10.0) == 2
    assert whole(tmp_path / "copy") == ["a.csv"]


def test_a_backup_that_is_cut_short_leaves_the_last_one(store, tmp_path, monkeypatch):
    """A full disk while files are copied leaves the backup that was there, with every file of it."""
    store.accept(handed("first"), b"1")
    computed(store)
    back_up(store, tmp_path / "copy")
    store.accept(handed("second"), b"2")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Blobs, "put_file", full)
    with pytest.raises(OSError, match="No space"):
        back_up(store, tmp_path / "copy")
    monkeypatch.undo()
    assert whole(tmp_path / "copy") == ["first"]


def test_damaged_files_are_named_and_the_rest_is_copied(store, tmp_path):
    """A file that is damaged in the store is not copied as if it were whole."""
    store.accept(handed(), b"1")
    found = computed(store)
    sha256 = store.files(found.id)["report"].sha256
    store.blobs.path(sha256).write_bytes(b"rep0rt")
    assert back_up(store, tmp_path / "copy").damaged == [sha256]


def test_a_backup_overwrites_nothing_but_a_backup_of_the_same_store(store, tmp_path):
    """Other files, another store, its backup, a store that was restored, the store itself: all stay as they are."""
    with Store(tmp_path / "other", serving=True) as other:
        back_up(other, tmp_path / "backup of other")
    back_up(store, tmp_path / "restored")
    with Store(tmp_path / "restored", serving=True) as restored:
        restored.accept(handed("new here"), b"1")
    (tmp_path / "letters").mkdir()
    (tmp_path / "letters" / "letter.txt").touch()
    for name in ("other", "backup of other", "restored", "letters", "store", "store/inside", "."):
        with pytest.raises(StoreError):
            back_up(store, tmp_path / name)
    assert whole(tmp_path / "restored") == ["new here"]
