"""Files kept by the digest of their bytes: written once, whole or not at all, never changed."""

from __future__ import annotations

import contextlib
import hashlib
import os
import threading
import time
from collections.abc import Iterator
from collections.abc import Set as AbstractSet
from pathlib import Path
from typing import BinaryIO

from flexlash.outputs.writing import Filling, put_new, remove_leftovers, sync_folder, temporary

__all__ = ["Blobs", "ChangedFileError", "DamagedFileError"]

_PIECE = 2**20


class ChangedFileError(OSError):
    """A file changed while it was copied."""


class DamagedFileError(OSError):
    """A kept file is gone or no longer has the bytes that it was kept with."""


class Blobs:
    """Write-once files in a folder of their own, two levels deep: `blobs/9c/9c1f…`."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._incoming = folder / "incoming"
        self._keeping = threading.RLock()

    def prepare(self) -> None:
        """Make the folders where there are none, and remove what interrupted runs left; raise OSError."""
        self._incoming.mkdir(parents=True, exist_ok=True)
        sync_folder(self._folder)
        sync_folder(self._folder.parent)
        remove_leftovers(self._incoming)

    @contextlib.contextmanager
    def keeping(self) -> Iterator[None]:
        """Keep what is put meanwhile from being swept, until it is named by a row; one thread at a time."""
        with self._keeping:
            yield

    def path(self, sha256: str) -> Path:
        """Return where the file of a digest lies, or would lie."""
        return self._folder / sha256[:2] / sha256

    def checked(self, sha256: str) -> Path:
        """Return where the file of a digest lies, once its bytes are found to be those of the digest.

        Raises DamagedFileError where they are not or there is none, OSError where it cannot be read.
        """
        try:
            with self.path(sha256).open("rb") as file:
                found = hashlib.file_digest(file, "sha256").hexdigest()
        except FileNotFoundError:
            raise DamagedFileError(f"the kept file {sha256} is gone") from None
        if found != sha256:
            raise DamagedFileError(f"the kept file {sha256} is damaged")
        return self.path(sha256)

    def has(self, sha256: str, size: int) -> bool:
        """Return whether there is a file of a digest with so many bytes, whatever they are."""
        with contextlib.suppress(OSError):
            return self.path(sha256).stat().st_size == size
        return False

    def is_whole(self, sha256: str) -> bool:
        """Return whether the file of a digest is there, can be read, and has the bytes of the digest."""
        try:
            self.checked(sha256)
        except OSError:
            return False
        return True

    def read(self, sha256: str) -> bytes:
        """Return the bytes of a digest; raise as `checked`."""
        return self.checked(sha256).read_bytes()

    def put(self, content: bytes | Filling) -> tuple[str, int]:
        """Keep bytes, or what a function writes, safe on the disk; return digest and size.

        A file that is there already stays, unless it is damaged.
        """
        digest, size = hashlib.sha256(), 0

        def fill(file: BinaryIO) -> None:
            nonlocal size
            if isinstance(content, bytes):
                file.write(content)
            else:
                content(file)
            file.seek(0)
            while piece := file.read(_PIECE):
                digest.update(piece)
                size += len(piece)

        with temporary(self._incoming, fill) as made:
            path = self.path(digest.hexdigest())
            path.parent.mkdir(exist_ok=True)
            if not put_new(made, path) and not self.is_whole(path.name):
                made.replace(path)
            # Whoever put it before may have been killed before its names were safe.
            sync_folder(path.parent)
            sync_folder(self._folder)
        return digest.hexdigest(), size

    def put_file(self, path: Path) -> tuple[str, int]:
        """Keep a copy of a file; return digest and size.

        Raises ChangedFileError where its size, time or number on the disk changed meanwhile.
        """
        with path.open("rb") as file:
            before = os.fstat(file.fileno())

            def fill(copy: BinaryIO) -> None:
                while piece := file.read(_PIECE):
                    copy.write(piece)

            found = self.put(fill)
        after = path.stat()
        if _identity(before) != _identity(after) or found[1] != after.st_size:
            raise ChangedFileError(f"{path.name} changed while it was copied")
        return found

    def sweep(self, named: AbstractSet[str], older_than: float) -> int:
        """Remove files that no row names and that are older than so many seconds; return how many."""
        removed, oldest = 0, time.time() - older_than
        with self._keeping:
            for folder in self._folder.iterdir():
                if folder == self._incoming or not folder.is_dir():
                    continue
                for path in folder.iterdir():
                    if path.name not in named and path.stat().st_mtime < oldest:
                        removed += _removed(path)
        return removed


def _identity(status: os.stat_result) -> tuple[int, int, int, int]:
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns


def _removed(path: Path) -> bool:
    """Remove a file; return whether that could be, since somebody may be reading it where that forbids it."""
    with contextlib.suppress(PermissionError, FileNotFoundError):
        path.unlink()
        return True
    return False
