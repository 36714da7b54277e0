"""A file of lines that grows while work is done: each line is safe on the disk before the next, or is none."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Sequence
from pathlib import Path

from flexlash.outputs.writing import held

__all__ = ["LinesFile"]


class LinesFile:
    """A file of ours that begins with a line which says so; one process at a time holds it."""

    def __init__(self, path: Path, title: str, *, anew: bool) -> None:
        """Open or create the file; `anew` forgets the lines that it holds.

        Raises OSError where it cannot be opened, holds something else, or another run holds it.
        """
        self._lines: list[str] = []
        self._size = 0
        if (handle := held(path)) is None:
            raise BlockingIOError(errno.EWOULDBLOCK, "another run is writing it", str(path))
        self._handle = handle
        if obstacle := self._obstacle(title):
            self.close()
            raise FileExistsError(errno.EEXIST, obstacle, str(path))
        if anew:
            self._lines, self._size = [], 0
        if not self._size:
            self.append(title)

    def _obstacle(self, title: str) -> str:
        """Return why the file is not used, having read the lines that are whole.

        What a killed run left of another line is overwritten by the next.
        """
        if not stat.S_ISREG(os.fstat(self._handle).st_mode):
            return "it is not a file"
        with os.fdopen(os.dup(self._handle), "rb") as file:
            *whole, rest = file.read().split(b"\n")
        if (whole[0] if whole else rest) != title.encode()[: None if whole else len(rest)]:
            return "flexlash did not write it"
        self._size = sum(len(line) + 1 for line in whole)
        self._lines = [line.decode("utf-8", "replace") for line in whole[1:]]
        return ""

    @property
    def lines(self) -> Sequence[str]:
        """The lines that were there when the file was opened."""
        return self._lines

    def append(self, line: str) -> None:
        """Write a line, safe on the disk; raise OSError where that fails, of which nothing then remains."""
        data = f"{line}\n".encode()
        os.ftruncate(self._handle, self._size)
        os.lseek(self._handle, self._size, os.SEEK_SET)
        written = 0
        while written < len(data):
            written += os.write(self._handle, data[written:])
        os.fsync(self._handle)
        self._size += len(data)

    def close(self) -> None:
        """Let go of the file."""
        os.close(self._handle)
