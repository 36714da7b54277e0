"""What was handed in and what became of it: one SQLite file and write-once blobs, served by one process at a time.

Every step is one transaction, safe on the disk when it returns: whenever the process ends, the store says what is to be
done again. Other processes may look at it and have a submission computed anew (`status`, `retry`).
"""

from __future__ import annotations

import json
import secrets
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Self

from filelock import FileLock, Timeout

from flexlash.outputs.writing import Filling
from flexlash.schema.findings import shown
from flexlash.service.database import Database
from flexlash.service.outbox import Outbox
from flexlash.service.records import Ending, HandedIn, StoredFile, StoredSubmission
from flexlash.service.repeated import LONGEST_REST
from flexlash.service.store_place import DATABASE, KEEPING_LOCK, SERVER_LOCK, StoreError, prepared

__all__ = ["Store", "StoreInUseError"]

_PATIENCE = 1.0
"""Seconds in which a lock comes free that is merely being looked at."""


class StoreInUseError(StoreError):
    """Another server works on this store."""


class Store(Outbox):
    """Submissions, results, deliveries and events. All methods may be called by any thread."""

    def __init__(
        self, folder: Path, *, serving: bool, webhook: bool = False, clock: Callable[[], float] = time.time
    ) -> None:
        """Open a store; `serving` makes it where there is none and takes the lock that one server has.

        `webhook` says that each ending is also told to a webhook. Raises StoreInUseError, StoreError where it cannot be
        used, and OSError where it cannot be made.
        """
        folder = prepared(folder) if serving else folder.absolute()
        self._lock = FileLock(folder / SERVER_LOCK, thread_local=False)
        if serving:
            try:
                self._lock.acquire(timeout=_PATIENCE)
            except Timeout:
                raise StoreInUseError(
                    f"another flexlash serves the store {shown(folder, 4096)}; "
                    "use that one, end it, or name another folder with --store"
                ) from None
        try:
            database = Database(folder / DATABASE, make=serving)
            if serving:
                _named(database)
            super().__init__(folder, database, clock, webhook=webhook)
            if serving:
                self.blobs.prepare()
        except BaseException:
            self._lock.release()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the store."""
        self._database.close()
        self._lock.release()

    # What is handed in

    def accept(self, handed: HandedIn, content: bytes | Path | Filling) -> StoredSubmission:
        """Keep a submission, given as bytes, as a file or by what writes it; return what is there of a known ID.

        The same content, name and options as of a submission that has ended are answered with its result at once.
        Raises OSError where it cannot be kept, ChangedFileError where the file changed meanwhile.
        """
        with self.blobs.keeping():
            if known := self.submission(handed.id):
                return known
            sha256, size = self.blobs.put_file(content) if isinstance(content, Path) else self.blobs.put(content)
            with self._database.transaction():
                self._database.run(
                    "INSERT INTO submission (id, name, sha256, size, options, door, sender, received_at, state)"
                    " VALUES (?, ?, ?, ?, ?, ?, ?, ?, 'waiting')",
                    handed.id, handed.name, sha256, size, handed.options, handed.door, handed.sender, self._clock(),
                )  # fmt: skip
                self._database.run("DELETE FROM forgotten WHERE id = ?", handed.id)
                self._event("received", handed.id, handed.name)
                self._answer_again(handed.id)
        return self._known(handed.id)

    def _answer_again(self, submission: str) -> None:
        """Give a new submission the result of an earlier one that is the same, if there is one and it is whole."""
        earlier = self._database.first(
            "SELECT old.* FROM submission AS old JOIN submission AS new USING (sha256, name, options)"
            " WHERE new.id = ? AND old.id <> new.id AND old.state IN ('done', 'rejected') AND old.is_repeatable"
            " ORDER BY old.number DESC LIMIT 1",
            submission,
        )
        if earlier is None or not all(self.blobs.is_whole(one.sha256) for one in self.files(earlier["id"]).values()):
            return
        self._database.run(
            "UPDATE submission SET state = ?, exit_code = ?, words = ?, reason = ?, counts = ?, rows = ?,"
            " rows_done = ?, same_as = ?, ended_at = ? WHERE id = ?",
            *(earlier[key] for key in ("state", "exit_code", "words", "reason", "counts", "rows", "rows_done")),
            earlier["same_as"] or earlier["id"], self._clock(), submission,
        )  # fmt: skip
        for table, columns in (("file", "role, sha256, size, name"),
                               ("rule", 'level, code, sheet, "column", cells, first')):  # fmt: skip
            self._database.run(
                f"INSERT INTO {table} SELECT ?, {columns} FROM {table} WHERE submission = ?",  # noqa: S608
                submission, earlier["id"],
            )  # fmt: skip
        self._plan(submission)
        self._event("answered again", submission, f"as {earlier['id']}")

    # The way of a submission

    def recover(self) -> Sequence[StoredSubmission]:
        """Put back what was at work when a server ended without handing it back; return it.

        It runs alone from now on. What ends the server three times while alone is for the caller to reject.
        """
        with self._database.transaction():
            working = self._database.all("SELECT id FROM submission WHERE state = 'working' ORDER BY number")
            self._database.run(
                "UPDATE submission SET state = 'waiting', server_ends = server_ends + alone, alone = 1"
                " WHERE state = 'working'"
            )
            for row in working:
                self._event("put back", row["id"], "the server had ended")
        return [self._known(row["id"]) for row in working]

    def take(self, besides: Collection[str] = ()) -> StoredSubmission | None:
        """Return the oldest submission that may be begun, which is at work from now on; None where there is none.

        `besides` are the IDs of those that are passed over.
        """
        with self._database.transaction():
            row = self._database.first(
                "SELECT id FROM submission WHERE state = 'waiting' AND (not_before <= ?1 OR not_before > ?1 + ?2)"
                " AND id NOT IN (SELECT value FROM json_each(?3)) ORDER BY alone DESC, number LIMIT 1",
                self._clock(), LONGEST_REST, json.dumps(list(besides)),
            )  # fmt: skip
            if row is None:
                return None
            self._database.run(
                "UPDATE submission SET state = 'working', began_at = ?, rows_done = 0, trouble = '' WHERE id = ?",
                self._clock(), row["id"],
            )  # fmt: skip
            self._event("begun", row["id"], "")
        return self._known(row["id"])

    def hand_back(self, submission: str, *, lost: int = 0, after: float = 0.0, trouble: str = "") -> None:
        """Put a submission at work back among those that wait.

        `lost` are workers that it has cost; `after` seconds it may be begun again, because of a `trouble` that is none
        of its own.
        """
        with self._database.transaction():
            done = self._database.run(
                "UPDATE submission SET state = 'waiting', tries = tries + ?, not_before = ?, trouble = ?"
                " WHERE id = ? AND state = 'working'",
                lost, self._clock() + after if after else 0.0, trouble, submission,
            )  # fmt: skip
            if done:
                self._event("handed back", submission, trouble)

    def note_rows(self, submission: str, done: int, rows: int) -> None:
        """Write down how many rows of a submission at work are done."""
        with self._database.transaction():
            self._database.run(
                "UPDATE submission SET rows_done = ?, rows = ? WHERE id = ? AND state = 'working'",
                done, rows, submission,
            )  # fmt: skip

    def note_checked(self, submission: str, counts: Mapping[str, int], page: StoredFile) -> None:
        """Write down what checking a submission at work has found, which its page shows meanwhile."""
        with self._database.transaction():
            done = self._database.run(
                "UPDATE submission SET counts = ?, rows = ? WHERE id = ? AND state = 'working'",
                json.dumps(dict(counts)), counts.get("rows", 0), submission,
            )  # fmt: skip
            if done:
                self._put_file(submission, page)

    def end(self, submission: str, ending: Ending) -> bool:
        """Write down how a submission at work ended, with all that is to be delivered; return False where it was not.

        The bytes of its files are kept already, within `blobs.keeping()`.
        """
        with self._database.transaction():
            done = self._database.run(
                "UPDATE submission SET state = ?, exit_code = ?, words = ?, reason = ?, counts = ?, is_repeatable = ?,"
                " ended_at = ?, rows_done = ?, rows = ?, alone = 0, server_ends = 0 WHERE id = ? AND state = 'working'",
                ending.state, ending.exit_code, ending.words, ending.reason, json.dumps(dict(ending.counts)),
                ending.is_repeatable, self._clock(), *(ending.counts.get("rows", 0),) * 2, submission,
            )  # fmt: skip
            if not done:
                return False
            self._database.run("DELETE FROM file WHERE submission = ?", submission)
            self._database.run("DELETE FROM rule WHERE submission = ?", submission)
            for file in ending.files:
                self._put_file(submission, file)
            self._database.run_for(
                "INSERT INTO rule VALUES (?, ?, ?, ?, ?, ?, ?)",
                [(submission, r.level, r.code, r.sheet, r.column, r.cells, r.first) for r in ending.rules],
            )
            self._plan(submission)
            self._event(ending.state, submission, ending.reason or ending.words)
        return True

    def retry(self, id_: str) -> bool:
        """Have a submission that has ended computed anew; return False where there is no such one.

        Until it has ended again it keeps the files of its last result. An original that was moved stays where it is.
        """
        with self._database.transaction():
            done = self._database.run(
                "UPDATE submission SET state = 'waiting', tries = 0, alone = 0, server_ends = 0, not_before = 0,"
                " same_as = '', exit_code = NULL, words = '', reason = '', ended_at = NULL"
                " WHERE id = ? AND state IN ('done', 'rejected')",
                id_,
            )
            if done:
                self._event("retried", id_, "")
        return bool(done)

    def forget(self, id_: str) -> bool:
        """Forget a submission that has ended and left; its bytes are swept later. Return False where it may not yet."""
        with self._database.transaction():
            done = self._database.run(
                "DELETE FROM submission WHERE id = ? AND state IN ('done', 'rejected') AND NOT EXISTS"
                " (SELECT 1 FROM delivery WHERE submission = id AND kind <> 'message' AND NOT is_done)",
                id_,
            )
            if done:
                self._database.run("UPDATE submission SET same_as = '' WHERE same_as = ?", id_)
                self._database.run("DELETE FROM event WHERE submission = ?", id_)
                self._database.run("INSERT OR REPLACE INTO forgotten VALUES (?, ?)", id_, self._clock())
                self._event("forgotten", id_, "")
        return bool(done)

    # Keeping house

    def forget_ended(self, before: float, most: int = 100) -> int:
        """Forget submissions that ended before a time and have left the store; return how many, `most` at once."""
        rows = self._database.all(
            "SELECT id FROM submission WHERE ended_at < ? AND NOT EXISTS"
            " (SELECT 1 FROM delivery WHERE submission = id AND kind <> 'message' AND NOT is_done)"
            " ORDER BY ended_at LIMIT ?",
            before, most,
        )  # fmt: skip
        return sum(self.forget(row["id"]) for row in rows)

    def prune(self, events_before: float, forgotten_before: float) -> None:
        """Drop what happened before a time, and IDs that were forgotten before another; write the log into the file."""
        with self._database.transaction():
            self._database.run("DELETE FROM event WHERE at < ?", events_before)
            self._database.run("DELETE FROM forgotten WHERE at < ?", forgotten_before)
        self._database.all("PRAGMA wal_checkpoint(TRUNCATE)")

    def sweep(self, older_than: float = 86_400.0) -> int:
        """Remove files that nothing names any more; return how many. While a backup is made none are removed."""
        with suppress(Timeout), FileLock(self.folder / KEEPING_LOCK, timeout=0), self.blobs.keeping():
            return self.blobs.sweep({sha256 for sha256, _ in self.named()}, older_than)
        return 0

    def _put_file(self, submission: str, file: StoredFile) -> None:
        self._database.run(
            "INSERT OR REPLACE INTO file VALUES (?, ?, ?, ?, ?)",
            submission, file.role, file.sha256, file.size, file.name,
        )  # fmt: skip

    def _known(self, id_: str) -> StoredSubmission:
        found = self.submission(id_)
        if found is None:
            raise LookupError(f"the submission {id_} was forgotten meanwhile")
        return found


def _named(database: Database) -> None:
    """Give a new store a name of its own; one that was a backup is a store from now on, one of before 0.10 as well."""
    with database.transaction():
        database.run("INSERT OR IGNORE INTO meta VALUES ('name', ?)", secrets.token_hex(8))
        database.run("DELETE FROM meta WHERE key = 'backup'")
        database.run("UPDATE file SET role = ? WHERE role = ?", "fixed", "mended")
