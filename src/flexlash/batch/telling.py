"""What a worker tells of a task while it works on it: the findings as soon as they are known, then how many rows."""

from __future__ import annotations

import time
from collections.abc import Mapping

from flexlash.batch.answer import Stage, Told
from flexlash.workers import tell

__all__ = ["Telling"]

_APART = 0.25
"""Seconds between two messages about rows."""


class Telling:
    """Tells of one task: first what was found, then rows a few times a second and at the end, then that it writes."""

    def __init__(self) -> None:
        self._rows = 0
        self._last = -_APART
        tell(Told().as_bytes())

    def checked(self, page: bytes, counts: Mapping[str, int], rows: int) -> None:
        """Tell what was found, and how many rows are to be computed."""
        self._rows = rows
        stage: Stage = "computing" if rows else "writing"
        tell(Told(rows=rows, stage=stage, counts=dict(counts), page=page).as_bytes())

    def advance(self, done: int, steps: int) -> None:
        """Tell how many rows are done, where that is the end or none was told for a while.

        A row of several steps counts as so many parts of one.
        """
        now = time.monotonic()
        if done >= steps or now - self._last >= _APART:
            self._last = now
            tell(Told(rows_done=done * self._rows // steps, rows=self._rows, stage="computing").as_bytes())

    def writing(self) -> None:
        """Tell that what was found is being written down."""
        tell(Told(rows_done=self._rows, rows=self._rows, stage="writing").as_bytes())
