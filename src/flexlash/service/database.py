"""The SQLite file of a store: opened or refused in a sentence, one transaction at a time, shared by all threads."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path

from flexlash.schema.findings import shown
from flexlash.service.store_place import StoreError

__all__ = ["SCHEMA_VERSION", "Database", "store_faults"]

SCHEMA_VERSION = 1
_APPLICATION = 0x464C5853
"""By this number in its head a SQLite file is known as a store of flexlash."""

_BUSY = 30
"""Seconds that a transaction waits for that of another process."""


@contextmanager
def store_faults(path: Path) -> Iterator[None]:
    """Turn what SQLite says of a file into the sentence of a StoreError."""
    try:
        yield
    except sqlite3.OperationalError as fault:
        raise StoreError(f"the store {shown(path, 4096)} could not be used: {_said(fault)}") from fault
    except sqlite3.DatabaseError as fault:
        raise StoreError(
            f"{shown(path, 4096)} is damaged or no store of flexlash ({_said(fault)}); "
            "put a backup in its place, or name another folder with --store"
        ) from fault


def _said(fault: sqlite3.Error) -> str:
    return shown(" ".join(str(fault).split()), 200)


class Database:
    """A connection that all threads share; other processes may have their own at the same time."""

    def __init__(self, path: Path, *, make: bool = False, only_read: bool = False) -> None:
        """Open a database, made where there is none if `make`; raise StoreError for one that cannot be used.

        `make` also looks for damage. With `only_read` nothing can be changed through it.
        """
        self._using = threading.RLock()
        with store_faults(path):
            # What is opened read-only would leave the files of its log behind.
            place = f"{path.absolute().as_uri()}?mode={'rwc' if make else 'rw'}"
            self._connection = sqlite3.connect(
                place, uri=True, timeout=_BUSY, isolation_level=None, check_same_thread=False
            )
            try:
                self._set_up(path, make=make)
                self._connection.execute(f"PRAGMA query_only = {int(only_read)}")
            except BaseException:
                self._connection.close()
                raise

    def _set_up(self, path: Path, *, make: bool) -> None:
        self._connection.row_factory = sqlite3.Row
        self._connection.execute("PRAGMA foreign_keys = ON")
        is_empty = not self.one("SELECT count(*) AS n FROM sqlite_master")["n"]
        if make and is_empty:
            self._connection.execute("PRAGMA journal_mode = WAL")
        self._connection.execute("PRAGMA synchronous = FULL")
        if make and is_empty:
            self._make()
        self._judge(path)
        if make and (said := self.one("PRAGMA quick_check(1)")[0]) != "ok":
            raise sqlite3.DatabaseError(said)

    def _make(self) -> None:
        with self.transaction():
            statements = files("flexlash.service").joinpath("schema.sql").read_text(encoding="utf-8").split(";\n")
            for statement in statements:
                self._connection.execute(statement)
            self._connection.execute(f"PRAGMA application_id = {_APPLICATION}")
            self._connection.execute(f"PRAGMA user_version = {SCHEMA_VERSION}")

    def _judge(self, path: Path) -> None:
        if self.one("PRAGMA application_id")[0] != _APPLICATION:
            raise sqlite3.DatabaseError("another program's database")
        if (version := self.one("PRAGMA user_version")[0]) != SCHEMA_VERSION:
            raise StoreError(
                f"the store {shown(path, 4096)} was written by another version of flexlash (form {version}; "
                f"this one has form {SCHEMA_VERSION}); use that version, or name another folder with --store"
            )

    def close(self) -> None:
        """Let go of it, once what another thread does with it has ended."""
        with self._using:
            self._connection.close()

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """Do all of a block or nothing; what was done is safe on the disk afterwards. Blocks within are part of it."""
        with self._using:
            if self._connection.in_transaction:
                yield
                return
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield
                self._connection.execute("COMMIT")
            except BaseException:
                # A full disk may have ended the transaction by itself.
                if self._connection.in_transaction:
                    self._connection.execute("ROLLBACK")
                raise

    def run(self, query: str, *values: object) -> int:
        """Carry out a statement within a transaction; return how many rows it changed."""
        with self._using:
            return self._connection.execute(query, values).rowcount

    def run_for(self, query: str, rows: Iterable[tuple[object, ...]]) -> None:
        """Carry out a statement once for each of several rows of values."""
        with self._using:
            self._connection.executemany(query, rows)

    def all(self, query: str, *values: object) -> list[sqlite3.Row]:
        """Return the rows that answer a question."""
        with self._using:
            return self._connection.execute(query, values).fetchall()

    def first(self, query: str, *values: object) -> sqlite3.Row | None:
        """Return the first of them, None where there is none."""
        rows = self.all(query, *values)
        return rows[0] if rows else None

    def one(self, query: str, *values: object) -> sqlite3.Row:
        """Return the first of them, of a question that always has an answer."""
        return self.all(query, *values)[0]

    def copy_to(self, path: Path) -> None:
        """Copy all that is committed into a new file, while others go on writing."""
        copy = sqlite3.connect(path, isolation_level=None)
        try:
            with self._using:
                self._connection.backup(copy)
            copy.execute("PRAGMA journal_mode = DELETE")
        finally:
            copy.close()
