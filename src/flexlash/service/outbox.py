"""What is to leave the store: planned with each ending, delivered once, tried again until it has left."""

from __future__ import annotations

import math
import sqlite3
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from flexlash.service.database import Database
from flexlash.service.records import Delivery, StoredFile
from flexlash.service.repeated import LONGEST_REST
from flexlash.service.store_questions import StoreQuestions

__all__ = ["Outbox"]

_DELIVERED = ("report", "results", "findings", "checked", "reasons")
"""Roles of files that are delivered to OUT, in this order; `_leaves` says of which form."""

_DUE = (
    "WITH turns AS (SELECT number, row_number() OVER (PARTITION BY submission"
    "  ORDER BY CASE kind WHEN 'file' THEN 0 WHEN 'original' THEN 1 ELSE 2 END, number) AS turn"
    "  FROM delivery WHERE NOT is_done)"
    " SELECT d.*, f.sha256, f.size, f.name FROM turns JOIN delivery AS d ON d.number = turns.number AND turns.turn = 1"
    " JOIN submission AS s ON s.id = d.submission"
    " LEFT JOIN file AS f ON f.submission = d.submission AND f.role = d.role"
    " WHERE s.state IN ('done', 'rejected') AND (d.not_before <= ?1 OR d.not_before > ?1 + ?2) ORDER BY d.number"
)
"""What is next to leave the store of each submission: its files, then the original, then the message.

Now is ?1. A time further ahead than any is ever set, ?2 seconds, stems from before the clock was set back.
"""


class Outbox(StoreQuestions):
    """A store with what is to leave it."""

    def __init__(
        self,
        folder: Path,
        database: Database,
        clock: Callable[[], float] = time.time,
        *,
        webhook: bool = False,
    ) -> None:
        super().__init__(folder, database, clock)
        self._webhook = webhook

    def deliveries(self) -> Sequence[Delivery]:
        """Return what is to leave the store now, of each submission that has ended the next alone, oldest first."""
        return [_delivery(row) for row in self._database.all(_DUE, self._clock(), LONGEST_REST)]

    def undelivered(self) -> Sequence[Delivery]:
        """Return what is to leave the store now or later, of each submission that has ended the next alone."""
        return [_delivery(row) for row in self._database.all(_DUE, math.inf, LONGEST_REST)]

    def _plan(self, submission: str) -> None:
        """Plan what is to leave the store of a submission that has ended.

        What an earlier result of it has begun to deliver goes on under the name that was chosen; the original moves
        once.
        """
        planned = self._database.all(
            "SELECT kind, role, is_done FROM delivery WHERE submission = ? AND (kind = 'original' OR NOT is_done)",
            submission,
        )
        known = {(row["kind"], row["role"]) for row in planned}
        door = self._database.one("SELECT door FROM submission WHERE id = ?", submission)["door"]
        roles = self.files(submission)
        leaves = [("file", role) for role in _DELIVERED if role in roles and _leaves(roles[role])]
        leaves.append(("original", ""))
        wanted = (leaves if door == "folder" else []) + ([("message", "")] if self._webhook else [])
        for kind, role in known - {*wanted}:
            self._database.run(
                "DELETE FROM delivery WHERE submission = ? AND kind = ? AND role = ? AND NOT is_done",
                submission, kind, role,
            )  # fmt: skip
        self._database.run_for(
            "INSERT INTO delivery (submission, kind, role) VALUES (?, ?, ?)",
            [(submission, *one) for one in wanted if one not in known],
        )

    def choose_target(self, delivery: Delivery, target: str) -> Delivery:
        """Write down the name under which something leaves the store, before it does."""
        with self._database.transaction():
            self._database.run("UPDATE delivery SET target = ? WHERE number = ?", target, delivery.number)
        return replace(delivery, target=target)

    def delivered(self, delivery: Delivery) -> None:
        """Write down that something has left the store."""
        with self._database.transaction():
            self._database.run("UPDATE delivery SET is_done = 1, trouble = '' WHERE number = ?", delivery.number)
            self._event("delivered", delivery.submission, delivery.target or delivery.kind)

    def give_up(self, delivery: Delivery, trouble: str) -> None:
        """Write down that something will not leave the store, and why."""
        with self._database.transaction():
            self._database.run(
                "UPDATE delivery SET is_done = 1, tries = tries + 1, trouble = ? WHERE number = ?",
                trouble, delivery.number,
            )  # fmt: skip
            self._event("given up", delivery.submission, f"{delivery.target or delivery.kind}: {trouble}")

    def postpone(self, delivery: Delivery, seconds: float, trouble: str = "") -> None:
        """Write down that something could not leave the store, why, and when it is tried again."""
        with self._database.transaction():
            self._database.run(
                "UPDATE delivery SET tries = tries + 1, not_before = ?, trouble = ? WHERE number = ?",
                self._clock() + seconds, trouble, delivery.number,
            )  # fmt: skip

    def targets(self, submission: str) -> Mapping[str, str]:
        """Return the names in OUT of a submission's files by what they are, empty where none is chosen yet."""
        rows = self._database.all(
            "SELECT role, target FROM delivery WHERE submission = ? AND kind = 'file' ORDER BY number", submission
        )
        return {row["role"]: row["target"] for row in rows}

    def drop_deliveries(self, submission: str, why: str) -> None:
        """Write down that nothing of a submission goes to OUT any more."""
        with self._database.transaction():
            self._database.run("UPDATE delivery SET is_done = 1 WHERE submission = ? AND kind <> 'message'", submission)
            self._event("not delivered", submission, why)

    def _event(self, kind: str, submission: str, text: str) -> None:
        self._database.run(
            "INSERT INTO event (at, kind, submission, text) VALUES (?, ?, ?, ?)", self._clock(), kind, submission, text
        )


def _leaves(file: StoredFile) -> bool:
    """Whether a file goes to OUT: Results do where the report holds the worst of them alone and names their file.

    Findings have a file of their own there alone.
    """
    return file.role != "results" or file.name.endswith(".parquet")


def _delivery(row: sqlite3.Row) -> Delivery:
    file = None
    if row["kind"] == "file":
        file = StoredFile(role=row["role"], sha256=row["sha256"], size=row["size"], name=row["name"])
    return Delivery(
        number=row["number"], submission=row["submission"], kind=row["kind"], file=file, target=row["target"],
        tries=row["tries"], not_before=row["not_before"], trouble=row["trouble"],
    )  # fmt: skip
