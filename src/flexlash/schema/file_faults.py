"""Why a file could not be opened or written, in words."""

from __future__ import annotations

import os
from pathlib import Path

from flexlash.schema.findings import readable, shown

__all__ = ["reason", "unusable"]


def reason(fault: OSError, path: Path | None = None) -> str:
    """Return why a file, or the path that the fault names, could not be opened or written."""
    place = fault.filename or path
    if isinstance(place, str | Path) and os.path.isdir(place):  # noqa: PTH112
        return "this is a folder; give the files in it"
    return readable(fault.strerror or fault)


def unusable(fault: OSError, path: Path) -> str:
    """Return the sentence that says of which file that is so, in place of `path` where the fault names another."""
    return f"{shown(fault.filename or path, 4096)} could not be opened or written: {reason(fault, path)}"
