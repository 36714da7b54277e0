"""A drop folder with a store, whose clock is moved by hand and whose submissions are answered by hand."""

from __future__ import annotations

import hashlib
import io
import os
import warnings
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Self

from flexlash.service.drop_folder import DropFolder
from flexlash.service.log import Log
from flexlash.service.places import Places
from flexlash.service.records import Ending, FileRole, StoredFile, StoredSubmission
from flexlash.service.store import Store

_ENDINGS = {"report": "-report.xlsx", "checked": "-checked.xlsx", "reasons": "-reasons.txt"}
_NOBODY = 65534


class Service:
    """A drop folder in `root`: INBOX `in`, OUT `out`, and a store of its own by `name`."""

    def __init__(
        self, root: Path, name: str = "store", out: str = "out", *, bypassing: bool = False, **given: int
    ) -> None:
        """Begin; `bypassing` takes INBOX and OUT although another service may hold them, `given` is for the folder."""
        self.now = 1_000.0
        self.inbox, self.out, self._open = root / "in", root / out, ExitStack()
        self.lines = io.StringIO()
        self.woken = 0
        if bypassing:
            for folder in ("work", "done", "rejected"):
                (self.out / folder).mkdir(parents=True, exist_ok=True)
            self.inbox.mkdir(exist_ok=True)
            self.places = Places(inbox=self.inbox, out=self.out)
        else:
            self.places = self._open.enter_context(Places.of(self.inbox, self.out, root / name))
        # The store looks at another clock: of seconds since 1970, which may be set back.
        self.store = self._open.enter_context(Store(root / name, serving=True, clock=lambda: self.now + 1e9))
        self.folder = DropFolder(
            self.store, self.places, "options", Log(stream=self.lines), self._wake, clock=lambda: self.now, **given
        )

    def _wake(self) -> None:
        self.woken += 1

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._open.close()

    def pass_time(self, seconds: float) -> None:
        """Let time go by, with a look every two seconds and one at the end."""
        end = self.now + seconds
        while self.now < end:
            self.step()
            self.now = min(end, self.now + 2.0)
        self.step()

    def step(self) -> None:
        """Look, and at once again as long as there is more to be done."""
        while self.folder.step():
            pass

    def put(self, name: str, data: bytes = b"a,b\n1,2\n") -> Path:
        """Put a file into INBOX."""
        path = self.inbox / name
        path.write_bytes(data)
        return path

    def answer(self, files: Mapping[FileRole, bytes] | None = None, *, state: str = "done") -> list[StoredSubmission]:
        """End all that waits with these files, or with a report that names its content; return it as it was taken."""
        ended = []
        while submission := self.store.take():
            given = {"report": f"report of {submission.sha256}".encode()} if files is None else files
            self.store.end(
                submission.id,
                Ending(
                    state=state,
                    exit_code=0 if state == "done" else 4,
                    words="answered",
                    files=[self._kept(submission, role, data) for role, data in given.items()],
                ),
            )
            ended.append(submission)
        return ended

    def _kept(self, submission: StoredSubmission, role: FileRole, data: bytes) -> StoredFile:
        sha256, size = self.store.blobs.put(data)
        return StoredFile(role=role, sha256=sha256, size=size, name=f"{Path(submission.name).stem}{_ENDINGS[role]}")

    def settle(self) -> None:
        """Let what lies in INBOX settle, be answered and delivered, where it is whole."""
        self.pass_time(8)
        self.answer()
        self.step()

    def submissions(self) -> list[StoredSubmission]:
        """Return all submissions of the store, the oldest first."""
        return list(reversed(self.store.history(most=10_000)))

    @property
    def delivered(self) -> dict[str, bytes]:
        """What lies in OUT itself, by name."""
        return {path.name: path.read_bytes() for path in self.out.iterdir() if path.is_file()}

    def originals(self, *states: str) -> Counter[tuple[str, bytes]]:
        """Return the names and bytes of all originals in these folders of OUT, in all three by default."""
        folders = states or ("work", "done", "rejected")
        found = [path for state in folders for path in (self.out / state).rglob("*") if path.is_file()]
        return Counter((path.name, path.read_bytes()) for path in found if path.name != "service.lock")

    @property
    def said(self) -> list[str]:
        """What was said in the log, line by line, without its time."""
        return [line.split(" ", 1)[1] for line in self.lines.getvalue().splitlines()]


def digest(data: bytes) -> str:
    """Return the SHA-256 of bytes."""
    return hashlib.sha256(data).hexdigest()


def as_nobody(function: Callable[[], object]) -> str:
    """Return what a function returns or raises, in words, as an ordinary user sees it.

    The superuser, who may do everything, becomes another in a copy of this process.
    """
    read, write = os.pipe()
    with warnings.catch_warnings():
        # A process with threads is copied: the copy needs none of them.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if not child:
        try:
            if os.geteuid() == 0:
                os.setgid(_NOBODY)
                os.setuid(_NOBODY)
            said = str(function())
        except Exception as fault:  # noqa: BLE001
            said = str(fault)
        os.write(write, said.encode())
        os._exit(0)
    os.close(write)
    os.waitpid(child, 0)
    with os.fdopen(read, "rb") as told:
        return told.read().decode()
