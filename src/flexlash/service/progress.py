"""How far a submission at work is, written down for its page: what checking it has found, then its rows."""

from __future__ import annotations

import time
from concurrent.futures import Future
from dataclasses import dataclass

from flexlash.batch.answer import Told
from flexlash.schema.findings import readable
from flexlash.service.endings import PAGE, KeptFile, kept
from flexlash.service.log import Log
from flexlash.service.records import StoredSubmission
from flexlash.service.repeated import ENVIRONMENT_FAULTS
from flexlash.service.store import Store

__all__ = ["Begun"]

_NOTED = 0.5
"""Seconds that pass before the rows of a submission are written down again."""


@dataclass(kw_only=True)
class Begun:
    """A submission at work, what will come of it, and whether it is computed in chunks."""

    submission: StoredSubmission
    future: Future[bytes] | None = None
    is_large: bool = False
    _noted: float = 0.0

    def note(self, message: bytes, store: Store, log: Log) -> None:
        """Write down what a worker tells of it; a fault here costs the news alone."""
        told, id_ = Told.of(message), self.submission.id
        try:
            if told.page:
                with store.blobs.keeping():
                    page = kept(store.blobs, self.submission, KeptFile(role="page", ending=PAGE, data=told.page))
                    store.note_checked(id_, told.counts, page)
            is_due = time.monotonic() - self._noted >= _NOTED
            if told.rows and (told.page or told.stage == "writing" or is_due):
                # The first rows are written down at once, however soon they follow what was found; so is the end.
                self._noted = 0.0 if told.page else time.monotonic()
                store.note_rows(id_, told.rows_done, told.rows)
        except ENVIRONMENT_FAULTS as fault:
            log.say("fault", id_, what="progress", why=readable(fault))
