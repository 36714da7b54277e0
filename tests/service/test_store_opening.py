"""A store opens, or says in one sentence why not, and what to do; looking at it changes nothing."""

from __future__ import annotations

import os
import sqlite3
import stat
import threading
from pathlib import Path

import pytest
from filelock import FileLock

from flexlash.service import store_place
from flexlash.service.outbox import Outbox
from flexlash.service.records import HandedIn
from flexlash.service.store import Store, StoreInUseError
from flexlash.service.store_place import StoreError, default_store, prepared, remote_kind

HANDED = HandedIn(name="a.csv", options="o", door="page")


def refusal(folder, *, serving=True):
    """Return the sentence by which a store is refused."""
    with pytest.raises(StoreError) as refused:
        Store(folder, serving=serving)
    assert "\n" not in str(refused.value)
    return str(refused.value)


@pytest.fixture
def folder(tmp_path):
    """Return the folder of a store with one submission that nobody serves."""
    with Store(tmp_path / "store", serving=True) as store:
        store.accept(HANDED, b"1")
    return tmp_path / "store"


def test_a_second_server_is_refused_and_the_store_named(folder):
    """While a server works on a store another is told so; once it has ended the other may."""
    with Store(folder, serving=True):
        with pytest.raises(StoreInUseError, match="another flexlash serves the store"):
            Store(folder, serving=True)
        assert str(folder) in refusal(folder)
    with Store(folder, serving=True) as store:
        assert store.totals()["waiting"] == 1


def test_fixed_files_of_a_store_of_before_are_still_offered(folder):
    """Before version 0.10 the file with the certain fixes was kept as `mended`; served again, it is `fixed`."""
    with Store(folder, serving=True) as store:
        (handed,) = store.queue()
    with sqlite3.connect(folder / "flexlash.sqlite") as database:
        database.execute("INSERT INTO file VALUES (?, 'mended', '0', 1, 'a-mended.csv')", (handed.id,))
    database.close()
    with Store(folder, serving=True) as store:
        assert store.files(handed.id)["fixed"].name == "a-mended.csv"


def test_a_lock_is_free_whichever_thread_closes_the_store(folder):
    """A store that was opened in one thread and closed in another can be served again."""
    store = Store(folder, serving=True)
    thread = threading.Thread(target=store.close)
    thread.start()
    thread.join()
    with Store(folder, serving=True):
        pass


def test_looking_whether_a_store_is_served_keeps_no_server_from_starting(folder):
    """A server that starts in the moment in which somebody else looks at its lock waits for that moment to pass."""
    lock = FileLock(folder / "server.lock", thread_local=False)
    lock.acquire()
    looking = threading.Timer(0.2, lock.release)
    looking.start()
    with Store(folder, serving=True) as store, Outbox.opened(folder) as held:
        looking.join()
        assert held.is_served()
        assert held.name == store.name


@pytest.mark.skipif(os.name != "posix", reason="permissions of this system are others")
def test_nobody_else_can_look_into_a_store(tmp_path):
    """Its folder is open to its user alone, also where it was there before."""
    (tmp_path / "open").mkdir(mode=0o755)
    for name in ("new", "open"):
        Store(tmp_path / name, serving=True).close()
        assert stat.S_IMODE((tmp_path / name).stat().st_mode) == 0o700


def test_a_folder_with_other_files_is_no_store(tmp_path):
    """A folder that is named by mistake stays as it is."""
    (tmp_path / "letter.txt").write_text("dear")
    assert "holds other files (letter.txt)" in refusal(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]


@pytest.mark.skipif(not Path("/proc/mounts").exists(), reason="this system does not tell its mounts so")
def test_a_network_drive_is_refused(tmp_path, monkeypatch):
    """A folder, or where it would be made, on a drive of another machine is refused with the kind of that drive."""
    assert remote_kind(tmp_path / "not" / "there") == ""
    mounts = Path("/proc/mounts").read_bytes() + b"host:/share %s nfs4 rw 0 0\n" % os.fsencode(tmp_path)
    real = Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda path: mounts if path == Path("/proc/mounts") else real(path))
    assert "on a network drive (nfs4)" in refusal(tmp_path / "not" / "there")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("kind", ["nfs", "nfs4", "cifs", "smb3", "fuse.sshfs", "9p", "fuse.rclone", "afs"])
def test_kinds_of_network_drives(kind):
    """Drives of other machines are known by their kind."""
    assert store_place._REMOTE.fullmatch(kind)


@pytest.mark.parametrize("kind", ["ext4", "xfs", "btrfs", "zfs", "tmpfs", "overlay", "fuseblk", "apfs", "ntfs3"])
def test_kinds_of_own_drives(kind):
    """Disks of this machine are not taken for others."""
    assert not store_place._REMOTE.fullmatch(kind)


def test_a_store_of_a_newer_form_is_refused(folder):
    """A store that another version has written is neither read nor changed."""
    with sqlite3.connect(folder / "flexlash.sqlite") as other:
        other.execute("PRAGMA user_version = 99")
    for serving in (True, False):
        assert "written by another version of flexlash (form 99; this one has form 1)" in refusal(
            folder, serving=serving
        )


def test_another_programs_database_is_refused_and_stays(tmp_path):
    """A SQLite file of something else is not taken over."""
    with sqlite3.connect(tmp_path / "flexlash.sqlite") as other:
        other.execute("CREATE TABLE letters (x)")
    before = (tmp_path / "flexlash.sqlite").read_bytes()
    assert "another program's database" in refusal(tmp_path)
    assert (tmp_path / "flexlash.sqlite").read_bytes() == before


@pytest.mark.parametrize("damage", ["other bytes", "flipped page", "cut"])
def test_a_damaged_store_is_refused_in_a_sentence(folder, damage):
    """A file that is no database, has other bytes in a page, or was cut short, says so, and what helps."""
    path = folder / "flexlash.sqlite"
    data = path.read_bytes()
    page = bytes(4096)
    whole = {"other bytes": b"letter" * 2000, "flipped page": data[:8192] + page + data[8192 + 4096 :],
             "cut": data[: len(data) // 2]}  # fmt: skip
    path.write_bytes(whole[damage])
    assert "is damaged or no store of flexlash" in refusal(folder)


def test_a_making_that_was_interrupted_goes_on(tmp_path):
    """An empty file of a database, as a kill may leave it, becomes a store."""
    (tmp_path / "flexlash.sqlite").touch()
    with Store(tmp_path, serving=True) as store:
        assert store.accept(HANDED, b"1").state == "waiting"


def test_looking_makes_no_store(tmp_path):
    """To ask for a store that is not there, or to retry in it, makes none."""
    with pytest.raises(StoreError, match="there is no store in"), Outbox.opened(tmp_path / "none"):
        pass
    for folder in (tmp_path / "none", tmp_path):
        with pytest.raises(StoreError):
            Store(folder, serving=False)
    assert list(tmp_path.iterdir()) == []


def test_looking_changes_nothing(folder):
    """Opened to be read, a store can be asked while it is served and while not, and takes no change."""
    before = {path.name for path in folder.iterdir()}
    for serving in (False, True):
        server = Store(folder, serving=True) if serving else None
        with Outbox.opened(folder) as held:
            assert held.totals()["waiting"] == 1
            assert held.is_served() == serving
            with pytest.raises(sqlite3.OperationalError, match="readonly"):
                held._database.run("DELETE FROM submission")
        if server:
            server.close()
    assert {path.name for path in folder.iterdir()} == before


def test_the_default_store_is_the_users_own():
    """Without --store everything is in a folder of the user's data, under the program's name."""
    assert default_store().name == "flexlash"
    assert default_store().is_absolute()


def test_a_folder_of_somebody_else_is_refused(tmp_path, monkeypatch):
    """A store that others can read, and whose permissions cannot be changed, is refused."""
    tmp_path.chmod(0o755)

    def refused(*_):
        raise PermissionError

    monkeypatch.setattr(Path, "chmod", refused)
    with pytest.raises(StoreError, match="open to other users"):
        prepared(tmp_path)
