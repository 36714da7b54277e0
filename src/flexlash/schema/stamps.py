"""The stamp inside a file that flexlash writes: it says what the file is, and that nobody has changed it since.

A stamp is one line of plain letters, `flexlash stamp report 4f0c…`, whose last word is the SHA-256 of the whole file
with that word's digits as 0. It stands where other programs do not look, and are not in the way of:

- .xlsx, .xlsm: the comment at the end of the archive, which every program drops that saves the workbook;
- .parquet: the metadata of the footer, under the key `flexlash`;
- .json: the key `stamp`, the last of the file; .jsonl: the same key, of the last line;
- .svg: the element `metadata`; .png: behind the last chunk.

A .csv has no such place.
"""

from __future__ import annotations

import hashlib
import io
import os
import re
import stat
from pathlib import Path
from typing import BinaryIO

__all__ = ["has_stamp", "placeholder", "stamp", "stamp_at", "stamped"]

_DIGITS = 64
_STAMP = re.compile(rb"flexlash stamp (?P<role>[a-z]+(?: [0-9a-f]{64})?) (?P<sum>[0-9a-f]{64})")
_TAIL = 2**20
"""How near its end a file holds its stamp [bytes]; the footer of a table with many columns is long."""

_ARCHIVE = b"PK\x03\x04"
_FLAGS = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


def placeholder(role: str) -> str:
    """Return the stamp of a file that is still to be written; `stamped` puts the sum in."""
    return f"flexlash stamp {role} {'0' * _DIGITS}"


def stamped(data: bytes, role: str) -> bytes:
    """Return a file's bytes with its stamp, where they have room for one; the same bytes for the same bytes.

    `role` says what the file is: `report`, `results`, `levers`, `distribution`, `checked`, `recreated`, `summary`,
    `picture`, or `mended` and the SHA-256 of the submission that was fixed.
    """
    file = io.BytesIO(data)
    stamp(file, role)
    return file.getvalue()


def stamp(file: BinaryIO, role: str) -> None:
    """Put its stamp into a file that is open for reading and writing, as `stamped` puts it into bytes."""
    empty = placeholder(role).encode()
    size = file.seek(0, os.SEEK_END)
    start = file.seek(max(0, size - _TAIL))
    tail = file.read()
    if tail.endswith(b"\0\0") and _begins(file, _ARCHIVE):
        file.seek(size - 2)
        file.write(len(empty).to_bytes(2, "little") + empty)
        place = size
    elif (found := tail.rfind(empty)) >= 0:
        place = start + found
    else:
        return
    place += len(empty) - _DIGITS
    digits = _sum(file, place).encode()
    file.seek(place)
    file.write(digits)


def _begins(file: BinaryIO, start: bytes) -> bool:
    file.seek(0)
    return file.read(len(start)) == start


def _sum(file: BinaryIO, digits: int) -> str:
    """Return the SHA-256 of a file with 0 in place of the digits that stand at a place of it."""
    file.seek(0)
    digest = hashlib.sha256()
    left = digits
    while left > 0 and (piece := file.read(min(left, _TAIL))):
        digest.update(piece)
        left -= len(piece)
    file.seek(_DIGITS, os.SEEK_CUR)
    digest.update(b"0" * _DIGITS)
    while piece := file.read(_TAIL):
        digest.update(piece)
    return digest.hexdigest()


def has_stamp(data: bytes) -> bool:
    """Whether a file's bytes end with a stamp, whoever has changed them since."""
    return _STAMP.search(data[-_TAIL:]) is not None


def stamp_at(path: Path) -> str:
    """Return the role in the stamp of a file that nobody has changed since flexlash wrote it, else an empty text.

    What is no regular file, a link among it, has no stamp. Raises OSError when the file cannot be read.
    """
    handle = os.open(path, _FLAGS)
    with os.fdopen(handle, "rb") as file:
        return _stamp_of(file) if stat.S_ISREG(os.fstat(handle).st_mode) else ""


def _stamp_of(file: BinaryIO) -> str:
    size = file.seek(0, os.SEEK_END)
    start = file.seek(max(0, size - _TAIL))
    stamps = list(_STAMP.finditer(file.read()))
    if not stamps:
        return ""
    last = stamps[-1]
    return last["role"].decode() if _sum(file, start + last.start("sum")).encode() == last["sum"] else ""
