"""With which code a command ends, and the most severe of several."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum

__all__ = ["ExitCode", "most_severe"]


class ExitCode(IntEnum):
    """The code with which a command ends, or a submission of several."""

    FINE = 0
    INTERNAL = 1
    USAGE = 2
    SOME_ROWS = 3
    NOTHING = 4
    NO_FILE = 5
    OVER_LIMIT = 6
    INTERRUPTED = 130


_SEVERITY = (
    ExitCode.INTERNAL,
    ExitCode.USAGE,
    ExitCode.NO_FILE,
    ExitCode.NOTHING,
    ExitCode.SOME_ROWS,
    ExitCode.OVER_LIMIT,
    ExitCode.FINE,
)


def most_severe(codes: Iterable[ExitCode]) -> ExitCode:
    """Return the most severe code of several submissions; of none, that there was nothing to compute.

    >>> most_severe([ExitCode.FINE, ExitCode.OVER_LIMIT, ExitCode.SOME_ROWS]), most_severe([])
    (<ExitCode.SOME_ROWS: 3>, <ExitCode.NOTHING: 4>)
    """
    return min(codes, key=_SEVERITY.index, default=ExitCode.NOTHING)
