"""Names of what is delivered: those of the submission, made harmless, short enough, and numbered together."""

from __future__ import annotations

import os
import re
from pathlib import Path, PurePath

__all__ = ["longest_name", "number_of", "numbered", "out_name"]

_NUMBERED = re.compile(r".* \((\d+)\)(\.[^.]*)?", re.DOTALL)
_ROOM = len(" (9999)")
_ENDING = len("-findings.parquet")
_LONGEST = 255
"""Bytes of a name on nearly every file system."""


def out_name(name: str, longest: int = _LONGEST) -> str:
    r"""Return the name in OUT of a file that people know as `<submission>-report.xlsx` or the like.

    What cannot be printed, or would lead into another folder, becomes `_`. A submission's name that leaves no room for
    `-report.xlsx` and a number is cut.

    >>> out_name("a\n/b-report.xlsx"), len(out_name("ä" * 127 + "-report.xlsx").encode())
    ('a__b-report.xlsx', 248)
    """
    safe = "".join(letter if letter.isprintable() and letter not in "/\\" else "_" for letter in name)
    stem, ending = safe[:-_ENDING], safe[-_ENDING:]
    room = longest - _ROOM - len(ending.encode())
    return f"{stem.encode()[:room].decode(errors='ignore')}{ending}"


def longest_name(folder: Path) -> int:
    """Return how many bytes a name may have in a folder."""
    try:
        return min(_LONGEST, os.pathconf(folder, "PC_NAME_MAX"))
    except (AttributeError, OSError, ValueError):
        return _LONGEST


def numbered(name: str, number: int) -> str:
    """Return a name with a number from 2 on.

    >>> numbered("a-report.xlsx", 1), numbered("a-report.xlsx", 2)
    ('a-report.xlsx', 'a-report (2).xlsx')
    """
    path = PurePath(name)
    return name if number == 1 else f"{path.stem} ({number}){path.suffix}"


def number_of(name: str) -> int:
    """Return the number in the name of a delivered file.

    >>> number_of("a-report (12).xlsx"), number_of("a (3)-report.xlsx")
    (12, 1)
    """
    match = _NUMBERED.fullmatch(name)
    return int(match[1]) if match else 1
