"""What takes long to compute is kept beside its output until that is whole, so that a later run need not do it again.

A working folder is hidden, belongs to one run at a time and holds parts, each written whole, and a manifest: a line for
what they are parts of, then one for every finished piece of work with the SHA-256 of its parts. A part counts only
while its bytes are those that the manifest names.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

from flexlash.outputs.writing import held, sync_folder, temporary
from flexlash.schema.unused_names import numbered_names

__all__ = ["WorkingFolder", "working_folder"]

_MANIFEST = "manifest.jsonl"
_PART = re.compile(r"[a-z0-9-]+\.part|\.flexlash-[0-9a-f]+\.tmp")
_MOST = 100
"""Folders of one name, numbered, beyond which none is tried."""

_LONGEST = 200
"""Bytes of an output's name that a folder's can have as a part: most systems allow 255 to both."""

_PIECE = 2**20

Parts = Mapping[str, Path]
"""Where the parts of a piece of work are, by what they are."""


class WorkingFolder:
    """A working folder that this run holds: `done` has the finished pieces of work by name, in the order of ending."""

    def __init__(self, folder: Path, manifest: int) -> None:
        self.folder = folder
        self._manifest = manifest
        self.done: dict[str, Sequence[Parts]] = {}

    def keep(self, name: str, pieces: Sequence[Mapping[str, bytes]]) -> Sequence[Parts]:
        """Keep the parts of a finished piece of work, safe on the disk, and return where they are.

        Raises OSError when they cannot be written.
        """
        kept: Sequence[Parts] = [
            {what: self.put(f"{name}-{number}-{what}.part", data) for what, data in piece.items()}
            for number, piece in enumerate(pieces)
        ]
        sync_folder(self.folder)
        sums = [{what: hashlib.sha256(data).hexdigest() for what, data in piece.items()} for piece in pieces]
        self._note({"done": name, "parts": sums})
        self.done[name] = kept
        return kept

    def put(self, name: str, data: bytes) -> Path:
        """Write a file into the folder, whole or not at all, without a line in the manifest."""
        path = self.folder / name
        with temporary(self.folder, lambda file: file.write(data)) as made:
            made.replace(path)
        return path

    def begin(self, what: Mapping[str, Any], *, resume: bool) -> None:
        """Take up what an earlier run has done of the same, if that is wanted; else remove it.

        Raises OSError when the folder cannot be written to.
        """
        if resume and self._taken_up(what):
            return
        self._empty()
        os.ftruncate(self._manifest, 0)
        os.lseek(self._manifest, 0, os.SEEK_SET)
        self._note(what)
        sync_folder(self.folder)
        sync_folder(self.folder.parent)

    def remove(self) -> None:
        """Remove the folder with what is ours in it."""
        with contextlib.suppress(OSError):
            self._empty()
            (self.folder / _MANIFEST).unlink()
            self.folder.rmdir()

    def _note(self, line: Mapping[str, Any]) -> None:
        text = json.dumps(line, sort_keys=True).encode() + b"\n"
        while text:
            text = text[os.write(self._manifest, text) :]
        os.fsync(self._manifest)

    def _taken_up(self, what: Mapping[str, Any]) -> bool:
        """Whether the manifest is one of this; then what it proves is done, and what a kill left half a line goes."""
        os.lseek(self._manifest, 0, os.SEEK_SET)
        with os.fdopen(self._manifest, "rb", closefd=False) as file:
            lines = file.read().splitlines(keepends=True)
        known = list(map(_line, lines))
        if not known or known[0] != json.loads(json.dumps(what)):
            return False
        whole = 1
        for line in known[1:]:
            if line is None:
                break
            whole += 1
            if (parts := self._proven(line)) is not None:
                self.done[line["done"]] = parts
        size = sum(map(len, lines[:whole]))
        os.ftruncate(self._manifest, size)
        os.lseek(self._manifest, size, os.SEEK_SET)
        return True

    def _proven(self, line: Mapping[str, Any]) -> Sequence[Parts] | None:
        """Return the parts that a line of the manifest names, None where one is not as it was written."""
        try:
            pieces: Sequence[Parts] = [
                {what: self.folder / f"{line['done']}-{number}-{what}.part" for what in piece}
                for number, piece in enumerate(line["parts"])
            ]
            sums = [known for piece in line["parts"] for known in piece.values()]
            paths = [path for piece in pieces for path in piece.values()]
            if all(_PART.fullmatch(path.name) and _sum(path) == known for path, known in zip(paths, sums, strict=True)):
                return pieces
        except (OSError, LookupError, TypeError, AttributeError):
            pass
        return None

    def _empty(self) -> None:
        self.done.clear()
        for path in self.folder.iterdir():
            if _PART.fullmatch(path.name):
                path.unlink()


@contextlib.contextmanager
def working_folder(output: Path, what: Mapping[str, Any], *, resume: bool) -> Iterator[WorkingFolder]:
    """Give the working folder of an output, which is removed when it is left without a fault.

    `what` says what is computed, in values that JSON has: with `resume` an earlier run's parts of the same are taken
    up. A folder that another run holds, or that is not ours, is left alone. Raises OSError when none can be made.
    """
    name = f".{_short(output.name)}.flexlash-parts"
    names = numbered_names(name, numbered=lambda number: f"{name}-{number}")
    for folder in (output.parent / one for one in islice(names, _MOST)):
        if _may_be_ours(folder, output) and (manifest := held(folder / _MANIFEST)) is not None:
            break
    else:
        raise FileExistsError(f"too many folders {name}")
    try:
        working = WorkingFolder(folder, manifest)
        working.begin(what, resume=resume)
        yield working
        working.remove()
    finally:
        os.close(manifest)
    if os.name == "nt":
        # There no file can be removed while it is open.
        working.remove()


def _short(name: str) -> str:
    """Return the name of an output, what stands for it where a longer one would be too long for a system."""
    data = os.fsencode(name)
    return name if len(data) <= _LONGEST else hashlib.sha256(data).hexdigest()


def _may_be_ours(folder: Path, output: Path) -> bool:
    """Whether a folder can be used, having been made if it was not there: it is empty or has a manifest."""
    try:
        folder.mkdir()
    except FileExistsError:
        pass
    except OSError as fault:
        # What cannot be written is the output, whose name the user knows.
        raise OSError(fault.errno, fault.strerror, os.fspath(output)) from fault
    else:
        return True
    return not folder.is_symlink() and folder.is_dir() and ((folder / _MANIFEST).exists() or not any(folder.iterdir()))


def _line(text: bytes) -> Any:
    """Return what a line of the manifest says, None where it is none or not whole."""
    if not text.endswith(b"\n"):
        return None
    with contextlib.suppress(ValueError):
        return json.loads(text)
    return None


def _sum(path: Path) -> str:
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while data := file.read(_PIECE):
            digest.update(data)
    return digest.hexdigest()
