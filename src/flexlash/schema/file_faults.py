"""Why a file could not be opened or written, in words."""

from __future__ import annotations

import difflib
import errno
import os
from pathlib import Path

from flexlash.schema.findings import readable, shown

__all__ = ["reason", "unusable"]

_NO_FILE = "there is no such file"
_NO_PERMISSION = "you have no permission"
_OPEN_ELSEWHERE = "another program, such as Excel, has it open; close it there"

_WORDS = {errno.ENOENT: _NO_FILE, errno.EACCES: _NO_PERMISSION, errno.EPERM: _NO_PERMISSION}
_WINDOWS_WORDS = {
    2: _NO_FILE,
    3: "there is no such folder",
    5: _NO_PERMISSION,
    32: _OPEN_ELSEWHERE,
    33: _OPEN_ELSEWHERE,
}
"""Words for what a system says in its own, which on Windows may be in any language."""

_LIKE = 0.75
"""How like names are of which one was probably meant by the other."""


def reason(fault: OSError, path: Path | None = None) -> str:
    """Return why a file, or the path that the fault names, could not be opened or written."""
    place = fault.filename or path
    if isinstance(place, str | Path) and os.path.isdir(place):  # noqa: PTH112
        return "this is a folder; give the files in it"
    return _system_words(fault) or readable(fault.strerror or fault)


def _system_words(fault: OSError) -> str:
    """Return words for a fault as the system gives it, an empty text for one that has words of flexlash's own."""
    if number := getattr(fault, "winerror", None):
        return _WINDOWS_WORDS.get(number, "")
    number = fault.errno or 0
    return _WORDS.get(number, "") if number and fault.strerror == os.strerror(number) else ""


def unusable(fault: OSError, path: Path) -> str:
    """Return the sentence that says of which file that is so, in place of `path` where the fault names another."""
    words, file = reason(fault, path), fault.filename or path
    if words != _NO_FILE:
        return f"{shown(file, 4096)} could not be opened or written: {words}"
    near = _name_like(Path(os.fsdecode(file)))
    return f"{shown(file, 4096)} could not be opened: {words}{f'; did you mean {shown(near)}?' if near else ''}"


def _name_like(path: Path) -> str:
    """Return the name in a file's folder that is most like its own, an empty text where there is none."""
    try:
        names = sorted(os.listdir(path.parent))  # noqa: PTH208
    except OSError:
        return ""
    return next(iter(difflib.get_close_matches(path.name, names, 1, _LIKE)), "")
