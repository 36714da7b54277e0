"""What is to be written → a file, whole or not at all, by way of a temporary file beside it; leftovers are removed.

While its writer lives, a temporary file is locked (`flock`); a later run removes those that nobody holds. Windows has
no such lock, but does not let go of a file that is open.
"""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import stat
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO, TypeAlias

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

__all__ = [
    "Filling",
    "held",
    "hold_folder",
    "put_new",
    "remove_leftovers",
    "replace",
    "sync_file",
    "sync_folder",
    "temporary",
]

Filling: TypeAlias = Callable[[BinaryIO], object]
"""Writes the content of a file, piece by piece, into an empty one that is open for writing and reading."""

_PREFIX, _SUFFIX = ".flexlash-", ".tmp"
_OPENED = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
_HOLDS_OPEN_FILES = os.name == "nt"
"""Whether this system refuses to move, replace or remove a file that a program holds open."""

_NO_LINKS = {errno.EPERM, errno.EACCES, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS, errno.EMLINK}
"""What a file system says that cannot give a file a second name."""

_NO_SYNC = {errno.EINVAL, errno.EACCES, errno.EPERM, errno.ENOTSUP, errno.EBADF}
"""What a system says that cannot synchronise this."""

_TRIES = 100


@contextlib.contextmanager
def temporary(folder: Path, fill: Filling) -> Iterator[Path]:
    """Yield a temporary file with this content, safe on the disk, to be given its path; what is left is removed."""
    path, handle = _created(folder)
    try:
        with os.fdopen(handle, "w+b", closefd=False) as file:
            fill(file)
            file.flush()
            os.fsync(handle)
        if _HOLDS_OPEN_FILES:
            os.close(handle)
        yield path
    finally:
        path.unlink(missing_ok=True)
        if not _HOLDS_OPEN_FILES:
            os.close(handle)


def _created(folder: Path) -> tuple[Path, int]:
    """Create a temporary file, with the permissions that any new file of the user has, and lock it."""
    for _ in range(_TRIES):
        path = folder / f"{_PREFIX}{secrets.token_hex(8)}{_SUFFIX}"
        handle = os.open(path, os.O_CREAT | os.O_EXCL | os.O_RDWR | _OPENED, 0o666)
        _lock(handle, wait=True)
        # Another run may have taken it for a leftover before it was locked.
        if _is_still(path, handle):
            return path, handle
        os.close(handle)
    raise FileNotFoundError(errno.ENOENT, "temporary files disappear from this folder", str(folder))


def _lock(handle: int, *, wait: bool) -> bool:
    """Lock a file; return whether it was locked. A file system without locks locks nothing."""
    if fcntl is None:
        return False
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:
        return False
    return True


def held(path: Path) -> int | None:
    """Return a file that is open, made where there is none, and locked until it is closed; None where another has it.

    Raises OSError when it can be neither made nor opened.
    """
    for _ in range(_TRIES):
        handle = os.open(path, os.O_CREAT | os.O_RDWR | _OPENED, 0o666)
        if _is_held_elsewhere(handle):
            os.close(handle)
            return None
        # The one that held it may have removed it before it was locked here.
        if _is_still(path, handle):
            return handle
        os.close(handle)
    return None


def hold_folder(folder: Path) -> int | None:
    """Return a folder that is open and locked until it is closed; None where another process has it.

    Not for Windows, which does not open folders. Raises OSError when it cannot be opened.
    """
    handle = os.open(folder, os.O_RDONLY | _OPENED)
    if _is_held_elsewhere(handle):
        os.close(handle)
        return None
    return handle


def _is_held_elsewhere(handle: int) -> bool:
    """Whether another process has the lock, which is taken otherwise. A file system without locks locks nothing."""
    if fcntl is not None:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        except OSError:
            pass
    return False


def _is_still(path: Path, handle: int) -> bool:
    """Whether a path leads to the file that is open."""
    with contextlib.suppress(FileNotFoundError):
        return os.path.samestat(path.lstat(), os.fstat(handle))
    return False


def remove_leftovers(folder: Path) -> None:
    """Remove the temporary files of a folder that no living run holds; what cannot be judged stays."""
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            if entry.name.startswith(_PREFIX) and entry.name.endswith(_SUFFIX):
                with contextlib.suppress(OSError):
                    _remove_unheld(Path(entry.path))


def _remove_unheld(path: Path) -> None:
    if not stat.S_ISREG(path.lstat().st_mode):
        return
    if _HOLDS_OPEN_FILES:
        path.unlink()
        return
    handle = os.open(path, os.O_RDWR | _OPENED)
    try:
        if _lock(handle, wait=False) and _is_still(path, handle):
            path.unlink()
    finally:
        os.close(handle)


def put_new(temporary_file: Path, path: Path) -> bool:
    """Give a temporary file a path that nothing has; return False, and do nothing, where something has it."""
    try:
        if _HOLDS_OPEN_FILES:
            temporary_file.rename(path)
        else:
            _link(temporary_file, path)
    except FileExistsError:
        return False
    sync_folder(path.parent)
    return True


def _link(temporary_file: Path, path: Path) -> None:
    """Give the file its name, which fails where the name is taken; the temporary name goes later."""
    try:
        path.hardlink_to(temporary_file)
    except OSError as fault:
        if fault.errno not in _NO_LINKS or isinstance(fault, FileExistsError):
            raise
        # An empty file holds the name until the whole one takes it.
        os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY | _OPENED, 0o666))
        try:
            temporary_file.replace(path)
        except OSError:
            path.unlink(missing_ok=True)
            raise


def replace(temporary_file: Path, path: Path, known: os.stat_result) -> bool:
    """Let a temporary file replace a known file; return False where another program has that in use."""
    now = path.lstat()
    if (now.st_ino, now.st_size, now.st_mtime_ns) != (known.st_ino, known.st_size, known.st_mtime_ns):
        return False
    try:
        temporary_file.replace(path)
    except PermissionError:
        if not _HOLDS_OPEN_FILES:
            raise
        return False
    sync_folder(path.parent)
    return True


def sync_file(path: Path) -> None:
    """Make the content of a file that another program wrote durable; raise OSError where it cannot be read."""
    handle = os.open(path, os.O_RDONLY | _OPENED)
    try:
        os.fsync(handle)
    except OSError as fault:
        # Some systems synchronise only what is open for writing.
        if fault.errno not in _NO_SYNC:
            raise
    finally:
        os.close(handle)


def sync_folder(folder: Path) -> None:
    """Make a new name durable where folders can be synchronised."""
    if _HOLDS_OPEN_FILES:
        return
    try:
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
    except OSError as fault:
        # Some network drives and folders without permission to list them cannot; the file has its name all the same.
        if fault.errno not in _NO_SYNC:
            raise
