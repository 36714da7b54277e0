"""When a file that somebody puts into a folder is there whole: it has stayed as it is, and it ends as its kind does."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

from flexlash.reading.gate import PARQUET

__all__ = ["Identity", "Settling", "identity", "is_whole"]

Identity: TypeAlias = tuple[int, int, int, int]
"""Disk, number on it, size [bytes], time of the last change [ns]: what a file has as long as nobody touches it."""

_SETTLED, _UNCHANGED = 5.0, 60.0
"""Seconds for which a file stays as it is before it is taken: a whole one, and one that seems torn or is empty."""

_ZIP, _ZIP_END, _ZIP_64_PLACE = b"PK\x03\x04", b"PK\x05\x06", b"PK\x06\x07"
_ZIP_END_SIZE, _LONGEST_COMMENT = 22, 65_535
_ZIP_64_SIZE = 56 + 20
"""Bytes of the two records that stand before the end of a zip file with more than four gigabytes."""

_PARQUET_LEAST = 12
_UTF_16 = {b"\xff\xfe": (b"\n\x00", b"\r\x00"), b"\xfe\xff": (b"\x00\n", b"\x00\r")}
_BEGINNING = 512
_OPENED = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


def identity(status: os.stat_result) -> Identity:
    """Return what tells whether a file is still the same and as it was."""
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns


@dataclass(frozen=True, kw_only=True)
class _Seen:
    """A file as it was seen: since when the same [s], and whether it is whole, None where not yet known."""

    identity: Identity
    since: float
    whole: bool | None = None


class Settling:
    """The files of folders that are looked at again and again. Times are seconds of a clock that only goes forward."""

    def __init__(self) -> None:
        self._seen: dict[Path, _Seen] = {}

    def settled(self, path: Path, status: os.stat_result, now: float) -> Identity | None:
        """Return a file's identity once it may be taken, None before; `status` is what it is now, links not followed.

        Raises OSError where it cannot be read.
        """
        seen = self._seen.get(path)
        if seen is None or seen.identity != identity(status):
            seen = self._seen[path] = _Seen(identity=identity(status), since=now)
        # At the first look these are none: what is taken was seen twice.
        unchanged = now - seen.since
        if unchanged < _SETTLED:
            return None
        if seen.whole is None:
            seen = self._seen[path] = replace(seen, whole=is_whole(path))
        return seen.identity if seen.whole or unchanged >= _UNCHANGED else None

    def since(self, path: Path) -> float:
        """Return when a file that was looked at was first seen as it is."""
        return self._seen[path].since

    def keep(self, paths: Iterable[Path]) -> None:
        """Forget all files but these."""
        kept = set(paths)
        self._seen = {path: seen for path, seen in self._seen.items() if path in kept}


def is_whole(path: Path) -> bool:
    """Whether a file ends as its kind does: a zip file in its end record, Parquet in `PAR1`, a text in a line end.

    Of anything else, and of an empty file, that cannot be told. Raises OSError where it cannot be read.
    """
    handle = os.open(path, os.O_RDONLY | _OPENED)
    with os.fdopen(handle, "rb") as file:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            return False
        beginning, size = file.read(_BEGINNING), status.st_size
        file.seek(max(0, size - _LONGEST_COMMENT - _ZIP_END_SIZE - _ZIP_64_SIZE))
        end = file.read()
    if beginning.startswith(_ZIP):
        return _is_whole_zip(end, size)
    if beginning.startswith(PARQUET):
        return _is_whole_parquet(end, size)
    return _is_whole_text(beginning, end)


def _is_whole_zip(end: bytes, size: int) -> bool:
    """Whether the file ends in the end record of this very archive, not of one that is packed inside it."""
    at = end.rfind(_ZIP_END)
    while at >= 0:
        record = end[at : at + _ZIP_END_SIZE]
        if len(record) == _ZIP_END_SIZE and at + _ZIP_END_SIZE + int.from_bytes(record[20:22], "little") == len(end):
            directory = int.from_bytes(record[12:16], "little") + int.from_bytes(record[16:20], "little")
            # Of more than four gigabytes the record before it tells the place.
            is_long = end[at - 20 : at].startswith(_ZIP_64_PLACE)
            return is_long or directory == size - len(end) + at
        at = end.rfind(_ZIP_END, 0, at)
    return False


def _is_whole_parquet(end: bytes, size: int) -> bool:
    footer = int.from_bytes(end[-8:-4], "little")
    return end.endswith(PARQUET) and size >= _PARQUET_LEAST and 0 < footer <= size - _PARQUET_LEAST


def _is_whole_text(beginning: bytes, end: bytes) -> bool:
    """Whether a text ends in a line end; bytes that no text has, as where a copy is still to come, are none."""
    if line_ends := _UTF_16.get(beginning[:2]):
        return end.endswith(line_ends)
    return end.endswith((b"\n", b"\r")) and b"\x00" not in beginning + end
