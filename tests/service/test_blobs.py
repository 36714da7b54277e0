"""Kept files: written once, whole, never handed out with other bytes, removed when nothing names them."""

from __future__ import annotations

import errno
import hashlib
import os
import threading
import time
from pathlib import Path

import pytest
from dispatching import dispatching, ended, hand_in
from stored import computed, handed

from flexlash.service.blobs import Blobs, ChangedFileError, DamagedFileError
from flexlash.service.records import Ending, HandedIn, StoredFile
from flexlash.service.store import Store
from flexlash.service.web.downloads import download
from flexlash.service.web.refusals import Refused


@pytest.fixture
def blobs(tmp_path):
    """Return kept files in a folder of their own."""
    blobs = Blobs(tmp_path / "blobs")
    blobs.prepare()
    return blobs


def digest(data):
    """Return the digest by which bytes are kept."""
    return hashlib.sha256(data).hexdigest()


def test_the_same_bytes_are_kept_once(blobs):
    """A second time the file that is there stays as it is."""
    assert blobs.put(b"data") == (digest(b"data"), 4)
    before = blobs.path(digest(b"data")).stat()
    blobs.put(b"data")
    after = blobs.path(digest(b"data")).stat()
    assert (after.st_ino, after.st_mtime_ns) == (before.st_ino, before.st_mtime_ns)


@pytest.mark.parametrize("damage", ["flipped", "cut", "gone"])
def test_r2_damaged_bytes_are_not_handed_out_and_are_fixed_by_the_same_ones(blobs, damage):
    """A file with a flipped bit, cut short, or gone is refused by name; put again, it is whole again."""
    sha256, _ = blobs.put(b"a report")
    path = blobs.path(sha256)
    if damage == "gone":
        path.unlink()
    else:
        path.write_bytes(b"a rep/rt" if damage == "flipped" else b"a rep")
    for ask in (blobs.checked, blobs.read):
        with pytest.raises(DamagedFileError, match=sha256):
            ask(sha256)
    assert not blobs.is_whole(sha256)
    blobs.put(b"a report")
    assert blobs.read(sha256) == b"a report"


def test_r2_a_damaged_result_answers_nobody_and_computing_anew_fixes_it(tmp_path):
    """With a flipped bit in its report a submission is no answer to the same one, which is computed instead."""
    with Store(tmp_path / "store", serving=True) as store:

        def end():
            sha256, size = store.blobs.put(b"a report")
            file = StoredFile(role="report", sha256=sha256, size=size, name="a-report.xlsx")
            store.end(store.take().id, Ending(state="done", exit_code=0, words="", files=[file]))
            return sha256

        store.accept(HandedIn(name="a", options="o", door="page"), b"1")
        path = store.blobs.path(end())
        path.write_bytes(b"a rep/rt")
        again = store.accept(HandedIn(name="a", options="o", door="page"), b"1")
        assert again.state == "waiting"
        end()
        assert path.read_bytes() == b"a report"


def test_a_result_that_the_disk_does_not_give_back_keeps_nobody_from_handing_in(tmp_path, monkeypatch):
    """Where the report of the same submission cannot be read, that is computed, in place of a fault for ever."""
    with Store(tmp_path / "store", serving=True) as store:
        store.accept(handed(), b"1")
        found = computed(store)
        bad, real = store.blobs.path(store.files(found.id)["report"].sha256), Path.open

        def failing(path, *arguments):
            if path == bad:
                raise OSError(errno.EIO, "Input/output error")
            return real(path, *arguments)

        monkeypatch.setattr(Path, "open", failing)
        assert store.accept(handed(), b"1").state == "waiting"


@pytest.mark.slow
@pytest.mark.parametrize("damage", ["flipped", "gone"])
def test_a_submission_that_is_damaged_on_our_disk_is_rejected_with_that_reason(tmp_path, damage):
    """It is neither computed with other bytes nor tried for ever; handed in again it is computed."""
    with Store(tmp_path / "store", serving=True) as store:
        id_ = hand_in(store)
        path = store.blobs.path(store.submission(id_).sha256)
        if damage == "gone":
            path.unlink()
        else:
            path.write_bytes(path.read_bytes().replace(b"800", b"801"))
        with dispatching(store):
            [found] = ended(store, id_)
            assert (found.state, "damaged on the disk of the service" in found.reason) == ("rejected", True)
            [again] = ended(store, hand_in(store))
        assert again.state == "done"


def test_r2_a_damaged_file_cannot_be_downloaded(blobs):
    """The page says that its bytes cannot be read, in place of other bytes."""
    sha256, size = blobs.put(b"a report")
    file = StoredFile(role="report", sha256=sha256, size=size, name="a-report.xlsx")
    assert download(blobs, file).status_code == 200
    blobs.path(sha256).write_bytes(b"a rep/rt")
    with pytest.raises(Refused):
        download(blobs, file)


def test_a_file_that_changes_while_it_is_copied_is_not_kept(blobs, tmp_path, monkeypatch):
    """A file that grows, or is replaced, between the first byte and the last is not taken."""
    path = tmp_path / "growing.csv"
    path.write_bytes(b"1" * 10)
    real = os.fstat

    def grown(handle):
        status = real(handle)
        with path.open("ab") as file:
            file.write(b"2")
        return status

    monkeypatch.setattr(os, "fstat", grown)
    with pytest.raises(ChangedFileError):
        blobs.put_file(path)


def test_what_an_interrupted_run_left_is_removed(blobs, tmp_path):
    """Half a file that was coming in when a run was killed is gone after the next start."""
    (tmp_path / "blobs" / "incoming" / ".flexlash-0123456789abcdef.tmp").write_bytes(b"half")
    blobs.prepare()
    assert list((tmp_path / "blobs" / "incoming").iterdir()) == []


def test_only_old_files_that_nothing_names_are_swept(blobs):
    """A file that is named stays, and so does a young one."""
    named, orphan, young = (blobs.put(data)[0] for data in (b"named", b"orphan", b"young"))
    for sha256 in (named, orphan):
        os.utime(blobs.path(sha256), (time.time() - 1000,) * 2)
    assert blobs.sweep({named}, 500.0) == 1
    assert [blobs.path(one).exists() for one in (named, orphan, young)] == [True, False, True]


@pytest.mark.slow
def test_nothing_is_swept_between_keeping_a_file_and_naming_it(tmp_path):
    """An old file that nothing names, handed in again while files are swept all the time, is there when it is named."""
    with Store(tmp_path / "store", serving=True) as store:
        ended = threading.Event()

        def sweep():
            while not ended.is_set():
                store.sweep(-10.0)

        sweeping = threading.Thread(target=sweep)
        sweeping.start()
        try:
            for number in range(20):
                data = b"%d" % (number % 4)
                store.blobs.put(data)
                found = store.accept(HandedIn(name=f"{number}", options="o", door="page"), data)
                assert Path(store.blobs.path(found.sha256)).read_bytes() == data
                store.take()
                store.end(found.id, Ending(state="done", exit_code=0, words=""))
                store.forget(found.id)
        finally:
            ended.set()
            sweeping.join()
