"""Path → bytes and what kind of submission they are, judged by content, never by the ending; or a refusal by name."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import Literal

from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.refusal import Refusal

__all__ = ["Kind", "Refusal", "kind_of", "read_bytes"]

Kind = Literal["workbook", "parquet", "csv"]

_MEBI = 2**20
_NEITHER = "the content is neither a workbook nor a table"
_ARCHIVE = b"PK\x03\x04"
_OLE2 = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_PARQUET = b"PAR1"
_OTHERS = {
    b"\x89PNG": "it is a picture",
    b"\xff\xd8\xff": "it is a picture",
    b"GIF8": "it is a picture",
    b"II*\0": "it is a picture",
    b"MM\0*": "it is a picture",
    b"%PDF": "it is a PDF document",
    b"{\\rtf": "it is a text document (RTF)",
    b"<": "it is a web page or XML text",
    b"PK": _NEITHER,
}
"""What files of other kinds begin with."""

_LOCK = "~$"
"""What the name of the file begins with by which Excel marks a workbook as open."""

_GREATEST_LOCK = 1024
_SIGNS = frozenset(b",;\t|")
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
_FLAGS = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


def read_bytes(path: Path, limits: ReadingLimits | None = None) -> bytes:
    """Return the bytes of a regular file of acceptable size; what is judged later is this copy.

    Raises OSError when it cannot be opened, is a link, a folder or a device, Refusal when it is empty or too large.
    """
    limits = limits or ReadingLimits()
    handle = _open(path)
    if not stat.S_ISREG(os.fstat(handle).st_mode):
        os.close(handle)
        raise FileNotFoundError(errno.ENOENT, "this is no file", str(path))
    with os.fdopen(handle, "rb") as file:
        data = file.read(limits.file_mebibytes * _MEBI + 1)
        if len(data) > limits.file_mebibytes * _MEBI:
            if not data.startswith(_PARQUET):
                raise limits.exceeded("file_mebibytes")
            data += file.read()
    if not data:
        raise Refusal("E101", found="the file is empty")
    if path.name.startswith(_LOCK) and len(data) <= _GREATEST_LOCK:
        raise Refusal("E101", found="it is Excel's lock file of a workbook that is open; submit the workbook itself")
    return data


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
    if data.startswith(_ARCHIVE):
        return "workbook"
    if data.startswith(_PARQUET):
        return "parquet"
    if data.startswith(_OLE2):
        locked = "EncryptedPackage".encode("utf-16-le") in data
        raise Refusal("E103") if locked else Refusal("E104", found="an old Excel file (.xls)")
    if data.startswith(_UTF_16):
        return "csv"
    for beginning, found in _OTHERS.items():
        if data.startswith(beginning):
            raise Refusal("E101", found=found)
    if b"\0" in data[:4096]:
        raise Refusal("E101", found=_NEITHER)
    if len(data.split()) and len(data.strip().splitlines()) == 1 and _SIGNS.isdisjoint(data):
        raise Refusal("E101", found="its text is a single line and no table")
    return "csv"
