"""INBOX and OUT at the start: what is refused, in which words, and that nothing else is changed by trying."""

import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from drop_folders import as_nobody

from flexlash.service.places import Places, PlacesError

_POSIX = pytest.mark.skipif(os.name == "nt", reason="POSIX permission bits and links")


def refused(inbox: Path, out: Path, store: Path) -> str:
    """Return why these folders are refused, an empty text where they are not."""
    try:
        Places.of(inbox, out, store).close()
    except PlacesError as why:
        return str(why)
    return ""


def test_a_first_start_makes_its_folders_and_names_them(tmp_path):
    """Nobody has to make folders by hand; the second start says that they were there."""
    with Places.of(tmp_path / "a" / "in", tmp_path / "out", tmp_path / "store") as places:
        assert places.made == [tmp_path / "a" / "in", tmp_path / "out"]
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"work", "done", "rejected"}
    with Places.of(tmp_path / "a" / "in", tmp_path / "out", tmp_path / "store") as places:
        assert places.made == []


def test_nothing_is_left_where_people_put_and_find_files(tmp_path):
    """Neither the trial nor the locks show in INBOX or OUT, while they are held and afterwards."""
    with Places.of(tmp_path / "in", tmp_path / "out", tmp_path / "store"):
        assert not list((tmp_path / "in").iterdir())
        assert not [path for path in (tmp_path / "out").iterdir() if path.is_file()]


@pytest.mark.parametrize(
    ("inbox", "out", "store", "words"),
    [
        ("a", "a", "s", "are one folder"),
        ("a", "a/out", "s", "lies inside INBOX"),
        ("a/in", "a", "s", "lies inside OUT"),
        ("a", "b", "a/s", "the store, .* lies inside INBOX"),
        ("a", "b", "b/s", "the store, .* lies inside OUT"),
        ("s/in", "b", "s", "lies inside the store"),
        ("a", "s/out", "s", "lies inside the store"),
        ("a", "b", "b", "are one folder"),
        ("a", "b/../a/b", "s", "lies inside INBOX"),
    ],
)
def test_folders_that_overlap_are_refused(tmp_path, inbox, out, store, words):
    """A report that lands among the submissions, or a store among reports, is refused before anything is made."""
    with pytest.raises(PlacesError, match=words):
        Places.of(tmp_path / inbox, tmp_path / out, tmp_path / store)
    assert not list(tmp_path.iterdir())


@_POSIX
def test_folders_that_overlap_by_another_name_are_refused(tmp_path):
    """A way through a link to a folder above is no other folder."""
    (tmp_path / "real" / "in").mkdir(parents=True)
    (tmp_path / "other").symlink_to(tmp_path / "real")
    assert "lies inside INBOX" in refused(tmp_path / "real" / "in", tmp_path / "other" / "in" / "out", tmp_path / "s")


@_POSIX
@pytest.mark.parametrize("link", ["in", "out", "out/work", "out/done", "out/rejected"])
def test_links_are_refused(tmp_path, link):
    """Whoever may turn a link would decide where originals go."""
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "out").mkdir()
    if link == "out":
        (tmp_path / "out").rmdir()
    (tmp_path / link).symlink_to(tmp_path / "elsewhere")
    assert "is a link: give the folder itself" in refused(tmp_path / "in", tmp_path / "out", tmp_path / "store")


@pytest.mark.parametrize(("file", "words"), [("in", "is a file"), ("out", "is a file"), ("out/done", "is a file")])
def test_files_are_refused(tmp_path, file, words):
    """A file where a folder belongs is named and left as it is."""
    (tmp_path / file).parent.mkdir(exist_ok=True)
    (tmp_path / file).write_text("mine")
    assert words in refused(tmp_path / "in", tmp_path / "out", tmp_path / "store")
    assert (tmp_path / file).read_text() == "mine"


def test_a_folder_that_cannot_be_made_is_refused(tmp_path):
    """A way that leads through a file leads nowhere."""
    (tmp_path / "file").touch()
    assert "file" in refused(tmp_path / "file" / "in", tmp_path / "out", tmp_path / "store")


@pytest.mark.skipif(not Path("/dev/shm").is_dir(), reason="needs a second file system")  # noqa: S108
def test_different_file_systems_are_refused(tmp_path):
    """A file cannot be moved whole from one drive to another."""
    with tempfile.TemporaryDirectory(dir="/dev/shm") as other:
        if Path(other).stat().st_dev == tmp_path.stat().st_dev:
            pytest.skip("one file system")
        assert "different file systems" in refused(tmp_path / "in", Path(other) / "out", tmp_path / "store")


@_POSIX
def test_one_file_system_that_is_mounted_twice_is_refused(tmp_path, monkeypatch):
    """Where the system refuses to rename although the disk has one number, the trial finds out."""

    def rename(self: Path, target: Path) -> Path:
        raise OSError(18, "Invalid cross-device link", str(self), None, str(target))

    monkeypatch.setattr(Path, "rename", rename)
    assert "different file systems" in refused(tmp_path / "in", tmp_path / "out", tmp_path / "store")


@_POSIX
@pytest.mark.parametrize("closed", ["in", "out", "out/work", "out/done", "out/rejected"])
def test_a_folder_without_permission_is_refused_by_trying(closed):
    """What the service may not write is told at the start, not with the first submission."""
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        for folder in (".", "in", "out", "out/work", "out/done", "out/rejected"):
            (root / folder).mkdir(exist_ok=True)
            (root / folder).chmod(0o555 if folder == closed else 0o777)
        said = as_nobody(lambda: refused(root / "in", root / "out", root / "store"))
        (root / closed).chmod(0o777)
        assert "you have no permission" in said
        assert str(root / closed) in said
        assert as_nobody(lambda: refused(root / "in", root / "out", root / "store")) == ""


def test_r12_a_second_service_is_refused(tmp_path):
    """Neither INBOX nor OUT is shared, whatever the other folder is."""
    with Places.of(tmp_path / "in", tmp_path / "out", tmp_path / "store"):
        for inbox, out, held in (("in", "out", "OUT"), ("in", "out 2", "INBOX"), ("in 2", "out", "OUT")):
            said = refused(tmp_path / inbox, tmp_path / out, tmp_path / "store 2")
            assert said.startswith(f"another flexlash service works on {held}")
    assert refused(tmp_path / "in", tmp_path / "out", tmp_path / "store") == ""


_HOLD = """
import sys, time
from pathlib import Path
from flexlash.service.places import Places
places = Places.of(*map(Path, sys.argv[1:]))
print("held", flush=True)
time.sleep(60)
"""


@pytest.mark.slow
def test_r12_a_killed_service_leaves_no_lock(tmp_path):
    """After kill -9 the next start works, without a file that somebody has to remove."""
    folders = (tmp_path / "in", tmp_path / "out", tmp_path / "store")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    with subprocess.Popen(
        [sys.executable, "-c", _HOLD, *map(str, folders)], stdout=subprocess.PIPE, env=environment
    ) as other:
        assert other.stdout.readline().strip() == b"held"
        assert refused(*folders).startswith("another flexlash service works on OUT")
        other.send_signal(signal.SIGKILL if os.name != "nt" else signal.SIGTERM)
        other.wait()
    assert refused(*folders) == ""
