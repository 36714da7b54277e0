"""A copy of a store, made while a server works on it: the database first, then every file that it names."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from filelock import FileLock, Timeout

from flexlash.outputs.writing import sync_folder, temporary
from flexlash.schema.findings import shown
from flexlash.service.blobs import Blobs
from flexlash.service.database import Database, store_faults
from flexlash.service.store_place import DATABASE, KEEPING_LOCK, WEBHOOK_KEY, StoreError, foreign
from flexlash.service.store_questions import StoreQuestions

__all__ = ["BackedUp", "back_up"]

_PATIENCE = 60.0
"""Seconds in which files that nothing names are removed meanwhile."""


@dataclass(frozen=True, kw_only=True)
class BackedUp:
    """What a backup has: files copied now and before, and digests of those that are damaged or gone in the store."""

    folder: Path
    copied: int
    copied_before: int
    damaged: Sequence[str]


def back_up(store: StoreQuestions, folder: Path) -> BackedUp:
    """Copy a store into a folder, made where there is none; what was copied into it before is not copied again.

    The folder then is a store itself. Until the last step it is the backup that it was. Raises StoreError for a folder
    that holds anything but a backup of this store, OSError where it cannot be written.
    """
    folder = folder.absolute()
    _admit(store, folder)
    new = folder / f"{DATABASE}.new"
    try:
        with FileLock(store.folder / KEEPING_LOCK, timeout=_PATIENCE), store_faults(new):
            new.unlink(missing_ok=True)
            named = store.copy_database(new)
            copy = Blobs(folder / "blobs")
            copy.prepare()
            done = _copied(store.blobs, copy, named, folder)
            _copy_key(store.folder, folder)
            _put_in_place(new, folder)
            copy.sweep({sha256 for sha256, _ in named}, 0.0)
    except Timeout:
        raise StoreError("another backup of the store is being made; wait until it has ended") from None
    return done


def _admit(store: StoreQuestions, folder: Path) -> None:
    """Make the folder, and refuse one that is no backup of this store."""
    here, there = store.folder.resolve(), folder.resolve()
    if here == there or here in there.parents or there in here.parents:
        raise StoreError(f"a backup cannot lie within its store or around it; name a folder beside {shown(here, 4096)}")
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    if other := foreign(folder):
        raise StoreError(f"{shown(folder, 4096)} holds other files ({shown(other)}); name an empty folder")
    if (folder / DATABASE).exists() and _backup_of(folder / DATABASE) != store.name:
        raise StoreError(f"{shown(folder, 4096)} holds a store that is no backup of this one; name an empty folder")


def _backup_of(path: Path) -> str:
    """Return the name of the store that a database is a backup of, an empty text where it is none."""
    database = Database(path, only_read=True)
    try:
        row = database.first("SELECT value FROM meta WHERE key = 'backup'")
        return row["value"] if row else ""
    finally:
        database.close()


def _copied(blobs: Blobs, copy: Blobs, named: Iterable[tuple[str, int]], folder: Path) -> BackedUp:
    copied, before, damaged = 0, 0, []
    for sha256, size in named:
        if copy.has(sha256, size):
            before += 1
        elif blobs.is_whole(sha256):
            copy.put_file(blobs.path(sha256))
            copied += 1
        else:
            damaged.append(sha256)
    return BackedUp(folder=folder, copied=copied, copied_before=before, damaged=damaged)


def _copy_key(store: Path, folder: Path) -> None:
    """Copy the key by which messages are signed: whoever hears them takes those of a restored store for the same."""
    with suppress(FileNotFoundError):
        key = (store / WEBHOOK_KEY).read_bytes()
        with temporary(folder, lambda file: file.write(key)) as made:
            made.chmod(0o600)
            made.replace(folder / WEBHOOK_KEY)


def _put_in_place(new: Path, folder: Path) -> None:
    """Let the copy of the database take its name; what SQLite left beside the last one would not fit it."""
    handle = os.open(new, os.O_RDWR)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
    for rest in ("-wal", "-shm"):
        (folder / f"{DATABASE}{rest}").unlink(missing_ok=True)
    new.replace(folder / DATABASE)
    sync_folder(folder)
