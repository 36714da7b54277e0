"""INBOX and OUT: made where there are none, tried out before anything is taken, and held by one service at a time."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import stat
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO, Self

from filelock import BaseFileLock, FileLock, Timeout

from flexlash.outputs.writing import hold_folder, remove_leftovers, sync_folder, temporary
from flexlash.schema.file_faults import reason
from flexlash.schema.findings import shown

__all__ = ["Places", "PlacesError"]

_LOCK = "service.lock"
_LONGEST = 4096
_ID = re.compile(r"[0-9a-f]{32}")


class PlacesError(ValueError):
    """INBOX, OUT and the store cannot be used together; the sentence says why, and what would do."""


@dataclass(frozen=True, kw_only=True)
class Places:
    """The folders of a drop folder, held by this process until they are closed.

    `made` are those that were not there before.
    """

    inbox: Path
    out: Path
    made: Sequence[Path] = ()
    _held: contextlib.ExitStack = field(default_factory=contextlib.ExitStack, repr=False, compare=False)

    @classmethod
    def of(cls, inbox: Path, out: Path, store: Path) -> Self:
        """Return the places, made where they are absent, each tried out.

        INBOX is where people put files; OUT gets `work`, `done`, `rejected` and what is delivered; `store` is the
        folder of the store, which need not be there yet. Raises PlacesError, with a sentence, where they cannot be
        used or another service has one of them.
        """
        _require_apart(inbox, out, store)
        made = [*_made("INBOX", inbox), *_made("OUT", out)]
        for name in ("work", "done", "rejected"):
            _made(f"the folder {name} of OUT", out / name)
        # Again, since only what is there tells by which names it goes.
        _require_apart(inbox, out, store)
        places = cls(inbox=inbox, out=out, made=made)
        with contextlib.ExitStack() as held:
            held.enter_context(_holding("OUT", out, FileLock(out / "work" / _LOCK, thread_local=False)))
            held.enter_context(_holding_inbox(inbox))
            _try_out(places)
            places._held.push(held.pop_all())
        return places

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the folders."""
        self._held.close()

    @property
    def work(self) -> Path:
        """Where originals lie while they are worked on, by store and ID."""
        return self.out / "work"

    def claimed(self, store: str) -> list[Path]:
        """Return the folders of what a store has claimed, by ID; raise OSError where they cannot be listed."""
        return sorted(path for path in (self.work / store).iterdir() if _ID.fullmatch(path.name) and path.is_dir())

    def require(self) -> None:
        """Raise OSError where OUT is not there; in the empty folder that a lost drive leaves nothing is put."""
        if not self.work.is_dir():
            raise FileNotFoundError(errno.ENOENT, "OUT, or its folder work, is not there now", str(self.work))


def _made(what: str, folder: Path) -> list[Path]:
    """Make a folder where there is none; return it if it was made."""
    if _is_link(folder):
        raise PlacesError(f"{what}, {_told(folder)}, is a link: give the folder itself, so that nobody can turn it.")
    try:
        was_there = stat.S_ISDIR(folder.stat().st_mode)
        if not was_there:
            raise PlacesError(f"{what}, {_told(folder)}, is a file: give a folder.")
    except FileNotFoundError:
        was_there = False
    except OSError as fault:
        raise PlacesError(f"{what}, {_told(folder)}, cannot be used: {reason(fault)}.") from fault
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        why = f"{_told(folder)} cannot be made: {reason(fault)}"
        raise PlacesError(f"{what} is not there, and {why}.") from fault
    return [] if was_there else [folder]


def _is_link(folder: Path) -> bool:
    return folder.is_symlink() or bool(getattr(os.path, "isjunction", lambda _: False)(folder))


def _require_apart(inbox: Path, out: Path, store: Path) -> None:
    """Require that none of the folders is, or lies in, another."""
    named = {"INBOX": inbox, "OUT": out, "the store": store}
    for what, folder in named.items():
        for other, outer in named.items():
            if what == other or not _is_in(folder, outer):
                continue
            if _is_in(outer, folder):
                raise PlacesError(f"{what} and {other} are one folder, {_told(folder)}: give each a folder of its own.")
            raise PlacesError(
                f"{what}, {_told(folder)}, lies inside {other}, {_told(outer)}, where other files come and go: give"
                " folders that lie beside each other."
            )


def _is_in(folder: Path, outer: Path) -> bool:
    """Whether a folder is another or lies inside it, by whatever name."""
    real, real_outer = Path(os.path.realpath(folder)), Path(os.path.realpath(outer))
    if real_outer in {real, *real.parents}:
        return True
    for ancestor in (real, *real.parents):
        with contextlib.suppress(OSError):
            if ancestor.samefile(real_outer):
                return True
    return False


def _of_two_disks(inbox: Path, out: Path) -> PlacesError:
    return PlacesError(
        f"INBOX, {_told(inbox)}, and OUT, {_told(out)}, are on different file systems: a file can be moved whole only"
        " within one. Give both on the same drive."
    )


def _inside(out: Path) -> tuple[Path, ...]:
    """Return OUT and its folders, as an original goes through them."""
    return (out / "work", out / "done", out / "rejected", out)


@contextlib.contextmanager
def _holding(what: str, folder: Path, lock: BaseFileLock) -> Iterator[None]:
    """Hold a folder for this process by a lock that the system lets go of when the process ends, however it does."""
    try:
        lock.acquire(timeout=0)
    except Timeout:
        raise _in_use(what, folder) from None
    except (OSError, NotImplementedError) as fault:
        why = reason(fault) if isinstance(fault, OSError) else str(fault)
        raise PlacesError(f"{what}, {_told(folder)}, cannot be locked by {_told(lock.lock_file)}: {why}.") from fault
    try:
        yield
    finally:
        lock.release(force=True)


@contextlib.contextmanager
def _holding_inbox(inbox: Path) -> Iterator[None]:
    """Hold INBOX without putting a file where people put theirs.

    The folder itself is locked; Windows, which cannot do that, gets a file for it among the user's temporary ones.
    """
    if os.name == "nt":
        status = inbox.stat()
        path = Path(tempfile.gettempdir()) / f"flexlash-{status.st_dev:x}-{status.st_ino:x}.lock"
        with _holding("INBOX", inbox, FileLock(path, thread_local=False)):
            yield
        return
    try:
        handle = hold_folder(inbox)
    except OSError as fault:
        raise PlacesError(f"INBOX, {_told(inbox)}, cannot be opened: {reason(fault)}.") from fault
    if handle is None:
        raise _in_use("INBOX", inbox)
    try:
        yield
    finally:
        os.close(handle)


def _in_use(what: str, folder: Path) -> PlacesError:
    return PlacesError(
        f"another flexlash service works on {what}, {_told(folder)}: end that one, or give this one folders of its own."
    )


def _try_out(places: Places) -> None:
    """Move a probe the way an original goes, so that a folder without permission is told before anything is taken."""
    for folder in (places.inbox, *_inside(places.out)):
        remove_leftovers(folder)
    at = places.inbox
    doing = "made"
    try:
        with temporary(places.inbox, _probe) as made:
            doing = "moved"
            probe = made
            try:
                for folder in _inside(places.out):
                    at = folder
                    probe = probe.rename(folder / made.name)
                    sync_folder(folder)
                doing = "removed"
            finally:
                if probe != made:
                    probe.unlink()
    except OSError as fault:
        if fault.errno == errno.EXDEV:
            raise _of_two_disks(places.inbox, places.out) from fault
        where = f"{_told(places.inbox)} and {_told(at)}" if at != places.inbox else _told(at)
        raise PlacesError(
            f"files must come and go in {where}, but one for trial could not be {doing}: {reason(fault)}. Let the"
            " service's user write there."
        ) from fault


def _probe(file: BinaryIO) -> None:
    file.write(b"flexlash tries whether it may write here\n")


def _told(folder: object) -> str:
    return shown(folder, _LONGEST)
