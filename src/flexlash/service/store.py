"""What was handed in and what became of it: one SQLite file and write-once blobs, served by one process at a time.

Every step is one transaction, safe on the disk when it returns: whenever the process ends, the store says what is to be
done again. Other processes may look at it and hand a submission back (`status`, `retry`).
"""

from __future__ import annotations

import json
import secrets
import sqlite3
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import fields, replace
from importlib.resources import files
from pathlib import Path
from typing import Any, Self

from filelock import FileLock, Timeout

from flexlash.service.blobs import Blobs
from flexlash.service.records import Delivery, Ending, HandedIn, StoredFile, StoredSubmission

__all__ = ["Store", "StoreInUseError"]

DATABASE = "flexlash.sqlite"
_SCHEMA_VERSION = 1
_BUSY = 30
"""Seconds that a transaction waits for that of another process."""

_DELIVERED = ("report", "results", "findings", "checked", "reasons")
"""Roles of files that are delivered to OUT, in this order."""

_COLUMNS = [one.name for one in fields(StoredSubmission)]


class StoreInUseError(OSError):
    """Another server works on this store."""


class Store:
    """Submissions, results, deliveries and events. All methods may be called by any thread."""

    def __init__(
        self, folder: Path, *, serving: bool, webhook: bool = False, clock: Callable[[], float] = time.time
    ) -> None:
        """Open a store, made where there is none; `serving` takes the lock that one server has.

        `webhook` says that each ending is also told to a webhook. Raises StoreInUseError, and OSError where it cannot
        be made or opened.
        """
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        self.folder = folder
        self._webhook = webhook
        self._clock = clock
        self._lock = FileLock(folder / "server.lock")
        if serving:
            try:
                self._lock.acquire(timeout=0)
            except Timeout:
                raise StoreInUseError(f"another flexlash serves the store {folder}") from None
        self.blobs = Blobs(folder / "blobs")
        self._using = threading.RLock()
        self._connection = sqlite3.connect(
            folder / DATABASE, timeout=_BUSY, isolation_level=None, check_same_thread=False
        )
        self._connection.row_factory = sqlite3.Row
        for pragma in ("journal_mode = WAL", "synchronous = FULL", "foreign_keys = ON"):
            self._connection.execute(f"PRAGMA {pragma}")
        self._make()
        self.name: str = self._one("SELECT value FROM meta WHERE key = 'name'")["value"]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the store."""
        self._connection.close()
        self._lock.release()

    # What is handed in

    def accept(self, handed: HandedIn, content: bytes | Path) -> StoredSubmission:
        """Keep a submission, given as bytes or as a file; with an ID that is there already return what is there.

        The same content, name and options as of a submission that has ended are answered with its result at once.
        Raises OSError where it cannot be kept, ChangedFileError where the file changed meanwhile.
        """
        with self.blobs.keeping():
            if known := self.submission(handed.id):
                return known
            sha256, size = self.blobs.put(content) if isinstance(content, bytes) else self.blobs.put_file(content)
            with self._transaction():
                self._connection.execute(
                    "INSERT INTO submission (id, name, sha256, size, options, door, sender, received_at, state)"
                    " VALUES (?, ?, ?, ?, ?, ?, ?, ?, 'waiting')",
                    (handed.id, handed.name, sha256, size, handed.options, handed.door, handed.sender, self._clock()),
                )
                self._event("received", handed.id, handed.name)
                self._answer_again(handed.id)
        return self._known(handed.id)

    def _answer_again(self, submission: str) -> None:
        """Give a new submission the result of an earlier one that is the same, if there is one."""
        earlier = self._first(
            "SELECT old.* FROM submission AS old JOIN submission AS new USING (sha256, name, options)"
            " WHERE new.id = ? AND old.id <> new.id AND old.state IN ('done', 'rejected') AND old.is_repeatable"
            " ORDER BY old.number DESC LIMIT 1",
            submission,
        )
        if earlier is None:
            return
        self._connection.execute(
            "UPDATE submission SET state = ?, exit_code = ?, words = ?, reason = ?, counts = ?, rows = ?,"
            " rows_done = ?, same_as = ?, ended_at = ? WHERE id = ?",
            (*(earlier[key] for key in ("state", "exit_code", "words", "reason", "counts", "rows", "rows_done")),
             earlier["same_as"] or earlier["id"], self._clock(), submission),
        )  # fmt: skip
        self._connection.execute(
            "INSERT INTO file SELECT ?, role, sha256, size, name FROM file WHERE submission = ?",
            (submission, earlier["id"]),
        )
        self._plan_deliveries(submission)
        self._event("answered again", submission, f"as {earlier['id']}")

    # The way of a submission

    def recover(self) -> Sequence[StoredSubmission]:
        """Put back what was at work when a server ended without handing it back; return it.

        It runs alone from now on. What ends the server three times while alone is for the caller to reject.
        """
        with self._transaction():
            working = self._all("SELECT * FROM submission WHERE state = 'working' ORDER BY number")
            self._connection.execute(
                "UPDATE submission SET state = 'waiting', server_ends = server_ends + alone, alone = 1"
                " WHERE state = 'working'"
            )
            for row in working:
                self._event("put back", row["id"], "the server had ended")
        return [self._known(row["id"]) for row in working]

    def take(self) -> StoredSubmission | None:
        """Return the oldest submission that may be begun, which is at work from now on; None where there is none."""
        with self._transaction():
            row = self._first(
                "SELECT id FROM submission WHERE state = 'waiting' AND not_before <= ?"
                " ORDER BY alone DESC, number LIMIT 1",
                self._clock(),
            )
            if row is None:
                return None
            self._connection.execute(
                "UPDATE submission SET state = 'working', began_at = ?, rows_done = 0, trouble = '' WHERE id = ?",
                (self._clock(), row["id"]),
            )
            self._event("begun", row["id"], "")
        return self._known(row["id"])

    def hand_back(self, submission: str, *, lost: int = 0, after: float = 0.0, trouble: str = "") -> None:
        """Put a submission at work back among those that wait.

        `lost` are workers that it has cost; `after` seconds it may be begun again, because of a `trouble` that is none
        of its own.
        """
        with self._transaction():
            self._connection.execute(
                "UPDATE submission SET state = 'waiting', tries = tries + ?, not_before = ?, trouble = ?"
                " WHERE id = ? AND state = 'working'",
                (lost, self._clock() + after if after else 0.0, trouble, submission),
            )
            self._event("handed back", submission, trouble)

    def note_rows(self, submission: str, done: int, rows: int) -> None:
        """Write down how many rows of a submission at work are done."""
        with self._transaction():
            self._connection.execute(
                "UPDATE submission SET rows_done = ?, rows = ? WHERE id = ? AND state = 'working'",
                (done, rows, submission),
            )

    def note_checked(self, submission: str, counts: Mapping[str, int], page: StoredFile) -> None:
        """Write down what checking a submission at work has found, which its page shows meanwhile."""
        with self._transaction():
            self._connection.execute(
                "UPDATE submission SET counts = ?, rows = ? WHERE id = ? AND state = 'working'",
                (json.dumps(dict(counts)), counts.get("rows", 0), submission),
            )
            self._put_file(submission, page)

    def end(self, submission: str, ending: Ending) -> bool:
        """Write down how a submission at work ended, with all that is to be delivered; return False where it was not.

        The bytes of its files are kept already, within `blobs.keeping()`.
        """
        with self._transaction():
            done = self._connection.execute(
                "UPDATE submission SET state = ?, exit_code = ?, words = ?, reason = ?, counts = ?, is_repeatable = ?,"
                " ended_at = ?, rows_done = rows, alone = 0, server_ends = 0 WHERE id = ? AND state = 'working'",
                (ending.state, ending.exit_code, ending.words, ending.reason, json.dumps(dict(ending.counts)),
                 ending.is_repeatable, self._clock(), submission),
            ).rowcount  # fmt: skip
            if not done:
                return False
            self._connection.execute("DELETE FROM file WHERE submission = ?", (submission,))
            for file in ending.files:
                self._put_file(submission, file)
            self._connection.executemany(
                "INSERT INTO rule VALUES (?, ?, ?, ?, ?, ?, ?)",
                [(submission, r.level, r.code, r.sheet, r.column, r.cells, r.first) for r in ending.rules],
            )
            self._plan_deliveries(submission)
            self._event(ending.state, submission, ending.reason or ending.words)
        return True

    def _plan_deliveries(self, submission: str) -> None:
        """Plan what is to leave the store of a submission that has ended."""
        door = self._one("SELECT door FROM submission WHERE id = ?", submission)["door"]
        roles = {row["role"] for row in self._all("SELECT role FROM file WHERE submission = ?", submission)}
        planned = []
        if door == "folder":
            planned = [("file", role) for role in _DELIVERED if role in roles] + [("original", "")]
        if self._webhook:
            planned.append(("message", ""))
        self._connection.executemany(
            "INSERT INTO delivery (submission, kind, role) VALUES (?, ?, ?)", [(submission, *one) for one in planned]
        )

    # What is to leave the store

    def deliveries(self) -> Sequence[Delivery]:
        """Return what is to leave the store now, in order; of each submission the next alone."""
        rows = self._all(
            "SELECT d.*, f.sha256, f.size, f.name FROM delivery AS d"
            " LEFT JOIN file AS f ON f.submission = d.submission AND f.role = d.role"
            " WHERE d.number IN (SELECT min(number) FROM delivery WHERE NOT is_done GROUP BY submission)"
            " AND d.not_before <= ? ORDER BY d.number",
            self._clock(),
        )
        return [_delivery(row) for row in rows]

    def choose_target(self, delivery: Delivery, target: str) -> Delivery:
        """Write down the name under which something leaves the store, before it does."""
        with self._transaction():
            self._connection.execute("UPDATE delivery SET target = ? WHERE number = ?", (target, delivery.number))
        return replace(delivery, target=target)

    def delivered(self, delivery: Delivery) -> None:
        """Write down that something has left the store."""
        with self._transaction():
            self._connection.execute("UPDATE delivery SET is_done = 1 WHERE number = ?", (delivery.number,))
            self._event("delivered", delivery.submission, delivery.target or delivery.kind)

    def postpone(self, delivery: Delivery, seconds: float) -> None:
        """Write down that something could not leave the store, and when it is tried again."""
        with self._transaction():
            self._connection.execute(
                "UPDATE delivery SET tries = tries + 1, not_before = ? WHERE number = ?",
                (self._clock() + seconds, delivery.number),
            )

    # What people ask

    def submission(self, id_: str) -> StoredSubmission | None:
        """Return a submission by its ID, None where there is none."""
        row = self._first("SELECT * FROM submission WHERE id = ?", id_)
        return None if row is None else _submission(row)

    def files(self, submission: str) -> Mapping[str, StoredFile]:
        """Return the files of a submission's result by what they are."""
        rows = self._all("SELECT role, sha256, size, name FROM file WHERE submission = ?", submission)
        return {row["role"]: StoredFile(**dict(row)) for row in rows}

    def position(self, submission: StoredSubmission) -> int:
        """Return how many submissions are to be begun before one that waits."""
        return int(
            self._one(
                "SELECT count(*) AS n FROM submission WHERE state = 'waiting' AND (number < ? OR alone > ?)",
                submission.number, submission.alone,
            )["n"]
        )  # fmt: skip

    def history(
        self, *, text: str = "", state: str = "", before: int | None = None, most: int = 50
    ) -> Sequence[StoredSubmission]:
        """Return submissions, the latest first, whose name or sender holds a text, of a state, before a number."""
        escaped = text.replace("\\", "\\\\").replace("%", "\\%").replace("_", "\\_")
        rows = self._all(
            "SELECT * FROM submission WHERE (name LIKE ?1 ESCAPE '\\' OR sender LIKE ?1 ESCAPE '\\')"
            " AND (?2 = '' OR state = ?2) AND (?3 IS NULL OR number < ?3) ORDER BY number DESC LIMIT ?4",
            f"%{escaped}%", state, before, most,
        )  # fmt: skip
        return [_submission(row) for row in rows]

    def previous(self, submission: StoredSubmission) -> StoredSubmission | None:
        """Return the last submission before this that has its name, other content, and a report."""
        row = self._first(
            "SELECT s.* FROM submission AS s JOIN file AS f ON f.submission = s.id AND f.role = 'report'"
            " WHERE s.name = ? AND s.number < ? AND s.sha256 <> ? ORDER BY s.number DESC LIMIT 1",
            submission.name, submission.number, submission.sha256,
        )  # fmt: skip
        return None if row is None else _submission(row)

    def totals(self) -> Mapping[str, int]:
        """Return how many submissions there are in each state."""
        rows = self._all("SELECT state, count(*) AS n FROM submission GROUP BY state")
        return dict.fromkeys(("waiting", "working", "done", "rejected"), 0) | {row["state"]: row["n"] for row in rows}

    def waiting_bytes(self) -> int:
        """Return the size of all that waits or is at work."""
        row = self._one("SELECT coalesce(sum(size), 0) AS n FROM submission WHERE state IN ('waiting', 'working')")
        return int(row["n"])

    def failing_most(self, most: int = 50) -> Sequence[Mapping[str, Any]]:
        """Return which rules in which columns are broken most: `level, code, sheet, column, cells, submissions`."""
        rows = self._all(
            'SELECT level, code, sheet, "column", sum(cells) AS cells, count(DISTINCT submission) AS submissions'
            " FROM rule WHERE level <> 'info' GROUP BY code, sheet, \"column\""
            " ORDER BY submissions DESC, cells DESC, code LIMIT ?",
            most,
        )
        return [dict(row) for row in rows]

    def events(self, submission: str = "", most: int = 100) -> Sequence[Mapping[str, Any]]:
        """Return the latest events, of one submission or of all: `number, at, kind, submission, text`."""
        rows = self._all(
            "SELECT * FROM event WHERE ?1 = '' OR submission = ?1 ORDER BY number DESC LIMIT ?2", submission, most
        )
        return [dict(row) for row in rows]

    def retry(self, id_: str) -> bool:
        """Have a submission that has ended computed anew; return False where there is no such one."""
        with self._transaction():
            done = self._connection.execute(
                "UPDATE submission SET state = 'waiting', tries = 0, alone = 0, server_ends = 0, not_before = 0,"
                " same_as = '', exit_code = NULL, words = '', reason = '', ended_at = NULL"
                " WHERE id = ? AND state IN ('done', 'rejected')",
                (id_,),
            ).rowcount
            if done:
                self._connection.execute("DELETE FROM rule WHERE submission = ?", (id_,))
                self._event("retried", id_, "")
        return bool(done)

    def forget(self, id_: str) -> bool:
        """Forget a submission that has ended and left; its bytes are swept later. Return False where it may not yet."""
        with self._transaction():
            done = self._connection.execute(
                "DELETE FROM submission WHERE id = ? AND state IN ('done', 'rejected') AND NOT EXISTS"
                " (SELECT 1 FROM delivery WHERE submission = id AND NOT is_done)",
                (id_,),
            ).rowcount
            if done:
                self._event("forgotten", id_, "")
        return bool(done)

    # Keeping house

    def sweep(self, older_than: float = 86_400.0) -> int:
        """Remove files that nothing names any more; return how many."""
        with self.blobs.keeping():
            rows = self._all("SELECT sha256 FROM submission UNION SELECT sha256 FROM file")
            return self.blobs.sweep({row["sha256"] for row in rows}, older_than)

    def _make(self) -> None:
        with self._transaction():
            if self._one("PRAGMA user_version")[0] == 0:
                for statement in (
                    files("flexlash.service").joinpath("schema.sql").read_text(encoding="utf-8").split(";\n")
                ):
                    self._connection.execute(statement)
                self._connection.execute("INSERT INTO meta VALUES ('name', ?)", (secrets.token_hex(8),))
                self._connection.execute(f"PRAGMA user_version = {_SCHEMA_VERSION}")

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        with self._using:
            if self._connection.in_transaction:
                yield
                return
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield
            except BaseException:
                self._connection.execute("ROLLBACK")
                raise
            self._connection.execute("COMMIT")

    def _put_file(self, submission: str, file: StoredFile) -> None:
        self._connection.execute(
            "INSERT OR REPLACE INTO file VALUES (?, ?, ?, ?, ?)",
            (submission, file.role, file.sha256, file.size, file.name),
        )

    def _event(self, kind: str, submission: str, text: str) -> None:
        self._connection.execute(
            "INSERT INTO event (at, kind, submission, text) VALUES (?, ?, ?, ?)",
            (self._clock(), kind, submission, text),
        )

    def _all(self, query: str, *values: object) -> list[sqlite3.Row]:
        with self._using:
            return self._connection.execute(query, values).fetchall()

    def _first(self, query: str, *values: object) -> sqlite3.Row | None:
        rows = self._all(query, *values)
        return rows[0] if rows else None

    def _one(self, query: str, *values: object) -> sqlite3.Row:
        return self._all(query, *values)[0]

    def _known(self, id_: str) -> StoredSubmission:
        return _submission(self._one("SELECT * FROM submission WHERE id = ?", id_))


def _submission(row: sqlite3.Row) -> StoredSubmission:
    known = {key: row[key] for key in _COLUMNS}
    return StoredSubmission(**known | {"alone": bool(row["alone"]), "counts": json.loads(row["counts"])})


def _delivery(row: sqlite3.Row) -> Delivery:
    file = None
    if row["kind"] == "file":
        file = StoredFile(role=row["role"], sha256=row["sha256"], size=row["size"], name=row["name"])
    return Delivery(
        number=row["number"], submission=row["submission"], kind=row["kind"], file=file, target=row["target"],
        tries=row["tries"], not_before=row["not_before"],
    )  # fmt: skip
