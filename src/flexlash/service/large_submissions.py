"""Large tables of the service: one at a time, by a driver of its own, beside everything else.

What is done of one is kept in a folder of the store until its result is: a server that ends loses a chunk or two.
"""

from __future__ import annotations

import shutil
import threading
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path

from flexlash.analysis.options import Options
from flexlash.batch.executor import Executor, Told, WorkerLostError
from flexlash.batch.large_apart import LargeAnswer, LargeTask, compute_large
from flexlash.batch.lent_workers import driven
from flexlash.service.blobs import Blobs
from flexlash.service.endings import named
from flexlash.service.records import FileRole, StoredFile, StoredSubmission
from flexlash.workers import StoppedError, Worker

__all__ = ["LargeSubmissions"]

_ROLES: tuple[FileRole, ...] = ("report", "results", "findings", "checked")


class LargeSubmissions:
    """What computes large tables, in a folder of the store."""

    def __init__(self, folder: Path, options: Options) -> None:
        self._folder = folder
        self._options = options
        self._driver: Worker | None = None
        self._future: Future[bytes] | None = None

    @property
    def is_busy(self) -> bool:
        """Whether a large table is being computed."""
        return self._future is not None and not self._future.done()

    def begin(self, submission: StoredSubmission, path: Path, executor: Executor, told: Told) -> Future[bytes]:
        """Return what will come of a large table, as `LargeAnswer`; `told` is called with its rows meanwhile.

        The future raises WorkerLostError when the driver is stopped, and what a piece of work raises. Raises OSError
        where no folder can be made.
        """
        folder = self._place(submission.id)
        folder.mkdir(parents=True, exist_ok=True)
        task = LargeTask(
            path=path, name=submission.name, folder=folder, options=self._options, workers=max(1, executor.workers // 2)
        )
        future = self._future = Future()
        threading.Thread(
            target=self._drive, args=(task, executor, told, future), name="flexlash large table", daemon=True
        ).start()
        return future

    def kept(self, submission: StoredSubmission, answer: LargeAnswer, blobs: Blobs) -> dict[str, StoredFile]:
        """Keep the files of a large table; return them by what they are. Raises OSError where that cannot be."""
        found: dict[str, StoredFile] = {}
        for role in _ROLES:
            if (path := answer.files.get(role)) is not None:
                sha256, size = blobs.put_file(path)
                name = named(submission, f"-{role}{path.suffix}")
                found[role] = StoredFile(role=role, sha256=sha256, size=size, name=name)
        return found

    def forget(self, submission: str) -> None:
        """Remove what was kept of a table whose result is in the store."""
        shutil.rmtree(self._place(submission), ignore_errors=True)

    def keep_only(self, is_open: Callable[[str], bool]) -> None:
        """Remove what was kept of all tables but those that are still to be computed."""
        for folder in self._folder.iterdir() if self._folder.is_dir() else ():
            if not is_open(folder.name):
                self.forget(folder.name)

    def stop(self) -> None:
        """Stop what is being computed; what it has done is taken up another time."""
        if driver := self._driver:
            driver.kill()

    def _place(self, submission: str) -> Path:
        return self._folder / submission

    def _drive(self, task: LargeTask, executor: Executor, told: Told, future: Future[bytes]) -> None:
        """Have a process compute a table, and tell who waits what came of it."""
        try:
            self._driver = driver = Worker()
            try:
                answer = driven(driver, compute_large, executor, told, task.as_bytes())
            except StoppedError as stopped:
                raise WorkerLostError(f"the process of a large table was stopped ({stopped})", losses=1) from None
            finally:
                self._driver = None
                driver.end()
        except BaseException as fault:  # noqa: BLE001
            future.set_exception(fault)
        else:
            future.set_result(answer)
