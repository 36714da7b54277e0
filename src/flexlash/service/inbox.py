"""INBOX → submissions in the store: looked through again and again, what has settled is claimed and accepted.

A claim is one rename into `work/STORE/ID/`, which only one service can win; the store is told afterwards. What lies
there without a row, since a service ended in between or the writer still wrote, is accepted later under the same ID.
"""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path

from flexlash.outputs.writing import sync_file, sync_folder
from flexlash.schema.findings import shown
from flexlash.service.blobs import ChangedFileError
from flexlash.service.log import Log
from flexlash.service.original import KeptPart
from flexlash.service.patience import Patience
from flexlash.service.places import Places
from flexlash.service.records import HandedIn, new_id
from flexlash.service.settling import Identity, Settling, identity
from flexlash.service.store import Store

__all__ = ["Inbox", "is_passed_over"]

_BEGINNINGS = (".", "~$")
_ENDINGS = (".tmp", ".part", ".crdownload", ".filepart")
_OF_THE_SYSTEM = {"thumbs.db", "desktop.ini"}
"""Files that Windows puts into folders by itself."""

_AT_ONCE = 50
"""Files claimed in one step, so that others of the service's work are not kept waiting and it ends soon when told."""

_GIVEN_UP = 60.0
"""Seconds after which a fault that stands no longer keeps the folder from being taken for idle."""


def is_passed_over(name: str) -> bool:
    """Whether a name is that of a file that is hidden, a lock, the system's, or still being copied by some program.

    >>> is_passed_over("~$a.xlsx"), is_passed_over("a.xlsx.PART"), is_passed_over("a.xlsx")
    (True, True, False)
    """
    lower = name.lower()
    return name.startswith(_BEGINNINGS) or lower.endswith(_ENDINGS) or lower in _OF_THE_SYSTEM


@dataclass(frozen=True, kw_only=True)
class _Ready:
    """A file of INBOX that has settled, and since when it is as it is."""

    path: Path
    identity: Identity
    since: float


class Inbox:
    """What people put into INBOX, on its way into the store."""

    def __init__(
        self, store: Store, places: Places, options: str, log: Log, *, kept: KeptPart, clock: Callable[[], float]
    ) -> None:
        """Use what `places` names; `options` is the digest of those with which all of it is computed."""
        self._store = store
        self._places = places
        self._options = options
        self._log = log
        self._kept = kept
        self._clock = clock
        self._own = places.work / store.name
        self._settling = Settling()
        self._patience = Patience(log, clock)
        self._passed_over: set[str] = set()
        self._unaccepted: set[Path] = set()
        self._waiting: frozenset[str] | None = None

    def begin(self) -> None:
        """Find again what was claimed before this service began; raise OSError where OUT cannot be read."""
        self._own.mkdir(exist_ok=True)
        for folder in sorted(self._places.work.iterdir()):
            if folder.is_dir() and folder != self._own:
                self._tell_of_other(folder)
        claimed = self._places.claimed(self._store.name)
        self._unaccepted |= {folder for folder in claimed if self._store.submission(folder.name) is None}

    def _tell_of_other(self, folder: Path) -> None:
        """Say that files of another store lie in OUT; they are its own, as long as anybody has it."""
        with contextlib.suppress(OSError):
            if not any(folder.iterdir()):
                return
        self._log.say(
            "left alone",
            folder=folder,
            why="these originals were claimed for another store; if that one is lost, move them back into INBOX",
        )

    def step(self) -> tuple[int, bool]:
        """Look through INBOX once; return how many submissions were accepted and whether more are ready."""
        try:
            self._places.require()
            ready = self._ready()
            self._patience.went_well("INBOX", self._places.inbox)
        except OSError as fault:
            self._waiting = None
            self._patience.failed("INBOX", fault, self._places.inbox)
            return self._accept_claimed(), False
        ready = [one for one in ready if self._patience.may_try(one.path)]
        accepted = self._accept_claimed()
        for one in ready[:_AT_ONCE]:
            accepted += self._take(one)
        return accepted, len(ready) > _AT_ONCE

    @property
    def is_hindered(self) -> bool:
        """Whether INBOX or OUT could not be used when it was last looked through."""
        return self._patience.stands_since("INBOX") is not None

    def expect(self, folder: Path) -> None:
        """Have what lies in a folder of this store's, named by its ID, accepted once it has settled."""
        self._unaccepted.add(folder)

    def is_idle(self) -> bool:
        """Whether INBOX was looked through and nothing waits in it, or on its way into the store.

        What cannot be taken for a minute, because this machine refuses it, is not waited for.
        """
        if self._waiting is None or self._unaccepted:
            return False
        return all(self._is_given_up(self._places.inbox / name) for name in self._waiting)

    def _is_given_up(self, path: Path) -> bool:
        since = self._patience.stands_since(path)
        return since is not None and self._clock() - since >= _GIVEN_UP

    def _ready(self) -> list[_Ready]:
        """Return the files of INBOX that have settled, those first that are there longest."""
        ready, waiting, passed_over = [], set(), set()
        now = self._clock()
        with os.scandir(self._places.inbox) as entries:
            names = [entry.name for entry in entries]
        for name in names:
            path = self._places.inbox / name
            try:
                status = path.lstat()
                if is_passed_over(name) or not stat.S_ISREG(status.st_mode):
                    passed_over.add(name)
                    continue
                waiting.add(name)
                if found := self._settling.settled(path, status, now):
                    ready.append(_Ready(path=path, identity=found, since=self._settling.since(path)))
            except FileNotFoundError:
                waiting.discard(name)
            except OSError as fault:
                self._patience.failed(path, fault, name)
        self._tell_passed_over(passed_over)
        self._waiting = frozenset(waiting)
        self._settling.keep([*(self._places.inbox / name for name in waiting), *self._claimed_files()])
        self._patience.keep(Path, {self._places.inbox / name for name in waiting} | self._unaccepted)
        return sorted(ready, key=attrgetter("since", "path"))

    def _tell_passed_over(self, names: set[str]) -> None:
        for name in sorted(names - self._passed_over):
            self._log.say("passed over", name=name, why="hidden, a lock, a copy under way, or no ordinary file")
        self._passed_over = names

    def _take(self, one: _Ready) -> int:
        """Claim a file and have it accepted; return 1 where it was, 0 where it is another's or must wait."""
        try:
            claimed = self._claimed(one)
        except OSError as fault:
            self._patience.failed(one.path, fault, one.path.name)
            return 0
        self._patience.went_well(one.path, one.path.name)
        if claimed is None:
            return 0
        status = claimed.lstat()
        if identity(status)[2:] != one.identity[2:] or not stat.S_ISREG(status.st_mode):
            # Another file came under this name, or its writer goes on: it has to settle first.
            return 0
        return self._accept(claimed)

    def _claimed(self, one: _Ready) -> Path | None:
        """Return where a file lies once it is ours, None where somebody else has taken it."""
        try:
            sync_file(one.path)
            if identity(one.path.lstat()) != one.identity:
                return None
        except FileNotFoundError:
            return None
        folder = self._own / new_id()
        # Whoever puts a lost OUT in its place again by hand makes no more than its `work`.
        self._own.mkdir(exist_ok=True)
        folder.mkdir()
        sync_folder(self._own)
        claimed = folder / one.path.name
        try:
            one.path.rename(claimed)
        except OSError as fault:
            # A network drive may say so of what it has done, when its answer was lost.
            if not os.path.lexists(claimed):
                folder.rmdir()
                if isinstance(fault, FileNotFoundError):
                    return None
                raise
        self._unaccepted.add(folder)
        sync_folder(folder)
        sync_folder(self._places.inbox)
        return claimed

    def _accept_claimed(self) -> int:
        """Accept what was claimed, but not accepted at once; return how many were."""
        accepted = 0
        for folder in sorted(self._unaccepted):
            if not self._patience.may_try(folder):
                continue
            try:
                files = sorted(folder.iterdir())
                if not files:
                    self._unaccepted.discard(folder)
                    folder.rmdir()
                    continue
                status = files[0].lstat()
                if stat.S_ISREG(status.st_mode) and self._settling.settled(files[0], status, self._clock()):
                    accepted += self._accept(files[0])
            except FileNotFoundError:
                self._unaccepted.discard(folder)
            except OSError as fault:
                self._patience.failed(folder, fault, self._name(folder), folder.name)
        return accepted

    def _claimed_files(self) -> list[Path]:
        found: list[Path] = []
        for folder in self._unaccepted:
            with contextlib.suppress(OSError):
                found += folder.iterdir()
        return found

    def _name(self, folder: Path) -> str:
        with contextlib.suppress(OSError):
            return next((path.name for path in folder.iterdir()), "")
        return ""

    def _accept(self, claimed: Path) -> int:
        """Have the store keep a claimed file; return 1 where it does, 0 where that must wait."""
        folder = claimed.parent
        handed = HandedIn(
            id=folder.name, name=shown(claimed.name, 255), options=self._options, door="folder", sender=_owner(claimed)
        )
        try:
            stored = self._store.accept(handed, self._kept.content(claimed))
        except ChangedFileError:
            return 0
        except OSError as fault:
            self._patience.failed(folder, fault, claimed.name, folder.name)
            return 0
        self._patience.went_well(folder, claimed.name)
        self._unaccepted.discard(folder)
        again = {"answered_as": stored.same_as} if stored.same_as else {}
        self._log.say("received", stored.id, name=stored.name, **again)
        return 1


def _owner(path: Path) -> str:
    """Return whose file it is, as far as this system tells."""
    with contextlib.suppress(OSError, KeyError, NotImplementedError):
        return shown(path.owner())
    return ""
