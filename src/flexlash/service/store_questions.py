"""What people ask of a store: pages, terminal and drop folder read the same answers, and change nothing by it."""

from __future__ import annotations

import json
import shutil
import sqlite3
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path
from typing import Any, Self

from filelock import FileLock, Timeout

from flexlash.schema.findings import shown
from flexlash.service.blobs import Blobs
from flexlash.service.database import Database, store_faults
from flexlash.service.records import STATES, StoredFile, StoredSubmission
from flexlash.service.store_place import DATABASE, SERVER_LOCK, StoreError

__all__ = ["StoreQuestions"]

_COLUMNS = [one.name for one in fields(StoredSubmission)]

_LOW = 500 * 2**20
"""Free bytes of the disk below which the service warns."""

_SHORTEST_ID = 4

_NAMED = "SELECT sha256, size FROM submission UNION SELECT sha256, size FROM file"
"""Every file that is kept for something."""


class StoreQuestions:
    """A store as it is read. All methods may be called by any thread."""

    def __init__(self, folder: Path, database: Database, clock: Callable[[], float] = time.time) -> None:
        self.folder = folder
        self.blobs = Blobs(folder / "blobs")
        self._database = database
        self._clock = clock
        self.name: str = database.one("SELECT value FROM meta WHERE key = 'name'")["value"]

    @classmethod
    @contextmanager
    def opened(cls, folder: Path) -> Iterator[Self]:
        """Open a store that is there only to read it, whether or not a server works on it.

        Raises StoreError where there is none or it cannot be used, also while it is read.
        """
        folder = folder.absolute()
        if not (folder / DATABASE).is_file():
            raise StoreError(f"there is no store in {shown(folder, 4096)}; flexlash serve makes one there")
        with store_faults(folder / DATABASE):
            database = Database(folder / DATABASE, only_read=True)
            try:
                yield cls(folder, database)
            finally:
                database.close()

    def is_served(self) -> bool:
        """Return whether a server works on the store."""
        lock = FileLock(self.folder / SERVER_LOCK, thread_local=False)
        if not (self.folder / SERVER_LOCK).exists():
            return False
        try:
            with lock.acquire(timeout=0):
                return False
        except Timeout:
            return True

    def submission(self, id_: str) -> StoredSubmission | None:
        """Return a submission by its ID, None where there is none."""
        row = self._database.first("SELECT * FROM submission WHERE id = ?", id_)
        return None if row is None else _submission(row)

    def begun_with(self, start: str) -> Sequence[str]:
        """Return the IDs that begin with at least four letters."""
        if len(start) < _SHORTEST_ID:
            return []
        rows = self._database.all("SELECT id FROM submission WHERE substr(id, 1, ?) = ? LIMIT 2", len(start), start)
        return [row["id"] for row in rows]

    def queue(self, most: int = 50) -> Sequence[StoredSubmission]:
        """Return the submissions that wait, in the order in which they are to be begun."""
        rows = self._database.all(
            "SELECT * FROM submission WHERE state = 'waiting' ORDER BY alone DESC, number LIMIT ?", most
        )
        return [_submission(row) for row in rows]

    def was_forgotten(self, id_: str) -> bool:
        """Return whether there once was a submission of this ID that has been forgotten since."""
        return self._database.first("SELECT 1 FROM forgotten WHERE id = ?", id_) is not None

    def files(self, submission: str) -> Mapping[str, StoredFile]:
        """Return the files of a submission's result by what they are."""
        rows = self._database.all("SELECT role, sha256, size, name FROM file WHERE submission = ?", submission)
        return {row["role"]: StoredFile(**dict(row)) for row in rows}

    def position(self, submission: StoredSubmission) -> int:
        """Return how many submissions are to be begun before one that waits."""
        return int(
            self._database.one(
                "SELECT count(*) AS n FROM submission"
                " WHERE state = 'waiting' AND (alone > ?1 OR (alone = ?1 AND number < ?2))",
                submission.alone, submission.number,
            )["n"]
        )  # fmt: skip

    def history(
        self, *, text: str = "", state: str = "", before: int | None = None, most: int = 50
    ) -> Sequence[StoredSubmission]:
        """Return submissions, the latest first, whose name or sender holds a text, of a state, before a number."""
        escaped = text.replace("\\", "\\\\").replace("%", "\\%").replace("_", "\\_")
        rows = self._database.all(
            "SELECT * FROM submission WHERE (name LIKE ?1 ESCAPE '\\' OR sender LIKE ?1 ESCAPE '\\')"
            " AND (?2 = '' OR state = ?2) AND (?3 IS NULL OR number < ?3) ORDER BY number DESC LIMIT ?4",
            f"%{escaped}%", state, before, most,
        )  # fmt: skip
        return [_submission(row) for row in rows]

    def previous(self, submission: StoredSubmission) -> StoredSubmission | None:
        """Return the last submission before this that has its name, other content, and a report."""
        row = self._database.first(
            "SELECT s.* FROM submission AS s JOIN file AS f ON f.submission = s.id AND f.role = 'report'"
            " WHERE s.name = ? AND s.number < ? AND s.sha256 <> ? ORDER BY s.number DESC LIMIT 1",
            submission.name, submission.number, submission.sha256,
        )  # fmt: skip
        return None if row is None else _submission(row)

    def totals(self) -> Mapping[str, int]:
        """Return how many submissions there are in each state."""
        rows = self._database.all("SELECT state, count(*) AS n FROM submission GROUP BY state")
        return dict.fromkeys(STATES, 0) | {row["state"]: row["n"] for row in rows}

    def waiting_bytes(self) -> int:
        """Return the size of all that waits or is at work."""
        row = self._database.one(
            "SELECT coalesce(sum(size), 0) AS n FROM submission WHERE state IN ('waiting', 'working')"
        )
        return int(row["n"])

    def kept_bytes(self) -> int:
        """Return the size of all submissions and results, each content counted once."""
        return sum(size for _, size in self.named())

    def named(self) -> Sequence[tuple[str, int]]:
        """Return digest and size of every file that is kept for something."""
        return [(row["sha256"], row["size"]) for row in self._database.all(_NAMED)]

    def warnings(self) -> Sequence[str]:
        """Return what whoever looks after the service should fix, in sentences."""
        free = shutil.disk_usage(self.folder).free
        return [f"the disk of the store has only {free // 2**20} MiB left"] if free < _LOW else []

    def figures(self) -> Mapping[str, float]:
        """Return what whoever watches wants to know: deliveries outstanding, workers lost, rows done, seconds."""
        row = self._database.one(
            "SELECT (SELECT count(*) FROM delivery WHERE NOT is_done) AS deliveries_outstanding,"
            " coalesce(sum(tries), 0) AS workers_lost, coalesce(sum(rows_done), 0) AS rows_done,"
            " coalesce(? - min(CASE WHEN state = 'waiting' THEN received_at END), 0) AS oldest_waiting_seconds"
            " FROM submission",
            self._clock(),
        )
        return dict(row)

    def failing_most(self, most: int = 50) -> Sequence[Mapping[str, Any]]:
        """Return which rules in which columns are broken most: `level, code, sheet, column, cells, submissions`.

        The same submission handed in again or computed anew counts once.
        """
        rows = self._database.all(
            'SELECT level, code, sheet, "column", sum(cells) AS cells, count(DISTINCT submission) AS submissions'
            " FROM rule WHERE level <> 'info' AND submission IN (SELECT id FROM submission WHERE number IN"
            " (SELECT max(number) FROM submission WHERE state IN ('done', 'rejected')"
            "  GROUP BY sha256, name, options))"
            ' GROUP BY code, sheet, "column" ORDER BY submissions DESC, cells DESC, code LIMIT ?',
            most,
        )
        return [dict(row) for row in rows]

    def events(self, submission: str = "", most: int = 100) -> Sequence[Mapping[str, Any]]:
        """Return the latest events, of one submission or of all: `number, at, kind, submission, text`."""
        rows = self._database.all(
            "SELECT * FROM event WHERE ?1 = '' OR submission = ?1 ORDER BY number DESC LIMIT ?2", submission, most
        )
        return [dict(row) for row in rows]

    def copy_database(self, path: Path) -> Sequence[tuple[str, int]]:
        """Copy the database into a new file, marked as a backup; return digest and size of every file that it names."""
        self._database.copy_to(path)
        copy = Database(path)
        try:
            with copy.transaction():
                copy.run("INSERT OR REPLACE INTO meta VALUES ('backup', ?)", self.name)
            return [(row["sha256"], row["size"]) for row in copy.all(_NAMED)]
        finally:
            copy.close()


def _submission(row: sqlite3.Row) -> StoredSubmission:
    known = {key: row[key] for key in _COLUMNS}
    return StoredSubmission(**known | {"alone": bool(row["alone"]), "counts": json.loads(row["counts"])})
