"""Path → bytes and what kind of submission they are, judged by content, never by the ending; or a refusal by name."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Literal

from flexlash.reading.encodings import unmarked_utf_16
from flexlash.reading.other_kinds import NEITHER, other_kind
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.stamps import has_stamp

__all__ = ["EXCERPT", "PARQUET", "Kind", "Refusal", "kind_of", "opened_file", "read_bytes"]

Kind = Literal["workbook", "parquet", "csv"]

_MEBI = 2**20
_ARCHIVE = b"PK\x03\x04"
PARQUET = b"PAR1"
"""What a Parquet file begins with."""

EXCERPT = b"\0flexlash excerpt\n"
"""What the rows of a large table begin with on their way to a worker; no file is one."""

_LOCK = "~$"
"""What the name of the file begins with by which Excel marks a workbook as open."""

_GREATEST_LOCK = 1024
_SIGNS = (b",", b";", b"\t", b"|")
_UNICODE = (b"\xff\xfe", b"\xfe\xff", b"\0\0\xfe\xff")
_FLAGS = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


def read_bytes(path: Path, limits: ReadingLimits | None = None) -> bytes:
    """Return the bytes of a regular file of acceptable size; what is judged later is this copy.

    Raises OSError when it cannot be opened, is a link, a folder or a device, Refusal when it is empty,
    too large, or a lock file.
    """
    limits = limits or ReadingLimits()
    with opened_file(path) as file:
        beginning = file.read(len(PARQUET))
        setting = "parquet_mebibytes" if beginning == PARQUET else "file_mebibytes"
        most = getattr(limits, setting) * _MEBI
        # A sparse file costs neither time nor memory; one that grows meanwhile is refused by what was read.
        limits.require(setting, os.fstat(file.fileno()).st_size / _MEBI)
        data = beginning + file.read(most + 1 - len(beginning))
        if len(data) > most:
            raise limits.exceeded(setting)
    if not data:
        raise Refusal("E101", found="the file is empty")
    return data


@contextmanager
def opened_file(path: Path) -> Iterator[BinaryIO]:
    """Open a regular file to be read.

    Raises OSError when it cannot be opened, is a link, a folder or a device, Refusal when it is a lock file.
    """
    if _is_lock(path):
        raise Refusal("I525")
    handle = _open(path)
    if not stat.S_ISREG(os.fstat(handle).st_mode):
        os.close(handle)
        raise FileNotFoundError(errno.ENOENT, "this is not a file", str(path))
    with os.fdopen(handle, "rb") as file:
        yield file


def _is_lock(path: Path) -> bool:
    """Whether a file is one by which Excel marks a workbook as open, which nobody may read meanwhile."""
    if not path.name.startswith(_LOCK):
        return False
    status = path.lstat()
    return stat.S_ISREG(status.st_mode) and status.st_size <= _GREATEST_LOCK


def _open(path: Path) -> int:
    """Return a handle on a file that is no link; opening never waits."""
    try:
        return os.open(path, _FLAGS)
    except OSError as fault:
        if path.is_symlink() and fault.errno in {errno.ELOOP, errno.EMLINK}:
            raise OSError(fault.errno, "this is a link; give the file itself", str(path)) from fault
        raise


def kind_of(data: bytes, only: Kind | None = None) -> Kind:
    """Return what the content is, whatever its name says; raise Refusal for other formats, or for another kind."""
    kind = _kind(data)
    if only not in {None, kind}:
        raise Refusal("E101", found=f"a {only} file is required here")
    return kind


def _kind(data: bytes) -> Kind:
    if not data:
        raise Refusal("E101", found="the file is empty")
    if data.startswith(_ARCHIVE):
        return "workbook"
    if data.startswith(PARQUET):
        return "parquet"
    if data.startswith(b"{") and has_stamp(data):
        raise Refusal("I527")
    if refusal := other_kind(data):
        raise refusal
    if data.startswith(_UNICODE) or unmarked_utf_16(data):
        return "csv"
    if b"\0" in data[:4096]:
        raise Refusal("E101", found=NEITHER)
    text = data.strip()
    is_line = text and b"\n" not in text and b"\r" not in text
    if is_line and not any(sign in data for sign in _SIGNS):
        raise Refusal("E101", found="its text is a single line, not a table")
    return "csv"
