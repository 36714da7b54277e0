"""Where files go: planned before anything is computed, numbered, stamped, written whole or not at all.

Nothing of the user's is overwritten. A file that has the name of an output is replaced only if flexlash wrote it and
nobody has changed it since, which its stamp says (`stamps.py`); whatever else has that name is left alone, never
followed, opened for writing or waited for, and the output gets ` (2)`. What a command is given to read is never an
output.
"""

from __future__ import annotations

import contextlib
import csv
import errno
import filecmp
import os
import stat
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain, islice
from pathlib import Path
from typing import BinaryIO

from flexlash.outputs.writing import Filling, put_new, remove_leftovers, replace, temporary
from flexlash.reading.products import is_replaced, results_header
from flexlash.schema.findings import shown
from flexlash.schema.stamps import stamp, stamp_at
from flexlash.schema.unused_names import numbered_names

__all__ = ["Output", "Plan", "WrittenFile"]

_KINDS = {stat.S_IFLNK: "it is a link", stat.S_IFDIR: "it is a folder", stat.S_IFIFO: "it is a pipe"}
_INPUT = "it is one of the files given to flexlash"
_COPIES = 9_999
"""Files of one name, numbered, beyond which none is written."""

_TRIES = 3
_LONGEST_HEADER = 2**16
"""How much of a table is read to see whether its header row is one of ours [bytes]."""

Identity = tuple[int, int] | str
"""What tells a file from every other: its number on its disk, or its whole path."""


@dataclass(frozen=True, kw_only=True)
class WrittenFile:
    """Where an output was written, and a sentence about what stood in its way and was left alone, if anything did."""

    path: Path
    remark: str = ""


@dataclass(kw_only=True)
class Plan:
    """The files that a command is given, `inputs`, and those that it will write; none replaces another.

    `submissions` are those of the inputs that are skipped where flexlash itself wrote them; a skipped file may be
    replaced by its successor.
    """

    inputs: Sequence[Path]
    submissions: Sequence[Path] = ()
    marked_copies: bool = False
    claimed: set[str] = field(default_factory=set)
    written: set[Identity] = field(default_factory=set)
    cleaned: set[Path] = field(default_factory=set)

    known: dict[Identity, set[Path]] = field(init=False)

    def __post_init__(self) -> None:
        self.known = _by_identity(self.inputs)

    def claim(self, wanted: Path, *, named: bool = False, forced: bool = False) -> Output:
        """Return where an output goes that should be called so; `named` says that the user has chosen this name.

        `forced` says that any file may be replaced there.
        A name that is taken gets a number. Raises ValueError where the user names one of the inputs, or a name twice.
        What keeps the output from being written at all is known to it, and raised when it is needed.
        """
        if named:
            self.refuse_input(wanted)
        if named and _full(wanted) in self.claimed:
            raise ValueError(f"{wanted} cannot hold two outputs; give each a name of its own.")
        try:
            self._prepare(wanted.parent)
            path = next(path for path in self.unclaimed(wanted) if not self.obstacle(path, named=named, forced=forced))
        except OSError as fault:
            return Output(plan=self, wanted=wanted, path=wanted, fault=_of_output(fault, wanted))
        self.claimed.add(_full(path))
        return Output(plan=self, wanted=wanted, path=path, named=named, forced=forced)

    def keep(self, paths: Iterable[Path]) -> None:
        """Let no output of this plan take the place of files that an earlier run wrote and that are to stay."""
        self.claimed.update(map(_full, paths))

    def refuse_input(self, wanted: Path) -> None:
        """Raise ValueError when a path that the user names leads to one of the inputs."""
        if not self.known.keys().isdisjoint(_identities(wanted)):
            raise ValueError(f"{wanted} is one of the files given to flexlash, which it never overwrites.")

    def _prepare(self, folder: Path) -> None:
        """Require a folder in which files can be made, and remove what killed runs left in it."""
        if folder not in self.cleaned:
            _require_folder(folder)
            remove_leftovers(folder)
            self.cleaned.add(folder)

    def unclaimed(self, wanted: Path) -> Iterator[Path]:
        """Yield the paths that no output of this plan has, numbered from the wanted one on.

        Raises FileExistsError after ten thousand.
        """
        stem, ending = wanted.stem, wanted.suffix
        names = numbered_names(wanted.name, numbered=lambda number: f"{stem} ({number}){ending}")
        paths = (wanted.with_name(name) for name in islice(names, _COPIES))
        yield from (path for path in paths if _full(path) not in self.claimed)
        raise FileExistsError(errno.EEXIST, "too many files of this name", str(wanted))

    def obstacle(self, path: Path, *, named: bool, forced: bool = False, file: Path | None = None) -> str:
        """Return why what has a path is left alone, an empty text where nothing has it or flexlash may replace it.

        `file` holds what is to be written there; without it, a table that may be the same is no obstacle yet.
        """
        if self._is_input(path):
            return _INPUT
        try:
            status = path.lstat()
        except FileNotFoundError:
            return ""
        if not stat.S_ISREG(status.st_mode):
            return _KINDS.get(stat.S_IFMT(status.st_mode), "it is a device")
        if (status.st_dev, status.st_ino) in self.written:
            return "it was written a moment ago"
        try:
            may_go = forced or _is_ours(path, file, named=named)
        except OSError:
            return "it cannot be read"
        return "" if may_go else "flexlash did not write it, or somebody has changed it"

    def _is_input(self, path: Path) -> bool:
        """Whether a path is that of an input, by whatever name, unless that is a file of ours that will be skipped."""
        inputs = {given for identity in _identities(path) for given in self.known.get(identity, ())}
        if not inputs:
            return False
        if not inputs <= {*self.submissions}:
            return True
        others = [given for given in self.submissions if given not in inputs]
        with contextlib.suppress(OSError):
            return not is_replaced(stamp_at(path), min(inputs), others, marked_copies=self.marked_copies)
        return True


@dataclass(frozen=True, kw_only=True)
class Output:
    """A planned output: the name that it should have, and the path that it gets."""

    plan: Plan
    wanted: Path
    path: Path
    named: bool = False
    forced: bool = False
    fault: OSError | None = None

    def __fspath__(self) -> str:
        """Return its place as a path, so that an output may be given where a path may."""
        return str(self.path)

    @property
    def ending(self) -> str:
        """How the output's name ends: `.xlsx`."""
        return self.wanted.suffix.lower()

    def require(self) -> None:
        """Raise OSError, with the output's name, where it is known already that it cannot be written."""
        if self.fault is not None:
            raise self.fault

    def write(self, content: bytes | Filling, role: str = "") -> WrittenFile:
        """Write the file and return where; with a role it is stamped, where its kind has room for that.

        What does not fit in memory is given as a function that writes it, and that may be called again.
        The plan is looked at again: what another program has put there meanwhile is left alone as well. Raises OSError,
        with the output's name, when the file cannot be written.
        """
        self.require()

        def fill(file: BinaryIO) -> None:
            if isinstance(content, bytes):
                file.write(content)
            else:
                content(file)
            if role:
                stamp(file, role)

        for tries_left in reversed(range(_TRIES)):
            try:
                return self._write(fill)
            except OSError as fault:
                # Where files cannot be locked, another run may have taken the temporary file for a leftover.
                if not (isinstance(fault, FileNotFoundError) and tries_left):
                    raise _of_output(fault, self.path) from fault
        raise AssertionError

    def _write(self, fill: Filling) -> WrittenFile:
        reason = self._known_obstacle()
        with temporary(self.path.parent, fill) as file:
            # The planned path first, then those that are free should something have come in its way.
            paths = chain([self.path], self.plan.unclaimed(self.wanted))
            while obstacle := self._put(file, path := next(paths)):
                reason = reason or obstacle
            status = path.stat()
        self.plan.written.add((status.st_dev, status.st_ino))
        return WrittenFile(path=path, remark=self._remark(reason, path))

    def _known_obstacle(self) -> str:
        """Return why the output does not get the name that it should have, where a file is the reason."""
        if self.path == self.wanted or _full(self.wanted) in self.plan.claimed:
            return ""
        return self.plan.obstacle(self.wanted, named=self.named)

    def _put(self, file: Path, path: Path) -> str:
        """Give a temporary file its path; return what is in the way, an empty text when it was put there."""
        if put_new(file, path):
            return ""
        before = path.lstat()
        named = self.named and path == self.wanted
        if obstacle := self.plan.obstacle(path, named=named, forced=self.forced, file=file):
            return obstacle
        return "" if replace(file, path, before) else "another program holds it open"

    def _remark(self, reason: str, path: Path) -> str:
        if not reason:
            return ""
        return f"{shown(self.wanted, 4096)} was left alone: {reason}. Written instead: {shown(path.name, 255)}"


def _full(path: Path) -> str:
    """Return the whole path of a file, links among its folders resolved, the file itself not if it is one."""
    return os.path.normcase(os.path.join(os.path.realpath(path.parent), path.name))  # noqa: PTH118


def _identities(path: Path) -> set[Identity]:
    """Return what tells a file from others, whatever it is called: its whole path and, where it exists, its number."""
    identities: set[Identity] = {_full(path), os.path.normcase(os.path.realpath(path))}
    with contextlib.suppress(OSError, ValueError):
        status = path.stat()
        identities |= {(status.st_dev, status.st_ino)} if status.st_ino else set()
    return identities


def _by_identity(paths: Iterable[Path]) -> dict[Identity, set[Path]]:
    known: dict[Identity, set[Path]] = {}
    for path in paths:
        for identity in _identities(path):
            known.setdefault(identity, set()).add(path)
    return known


def _require_folder(folder: Path) -> None:
    """Raise OSError where no file can be made in a folder."""
    where = shown(folder.absolute(), 4096)
    try:
        is_folder = stat.S_ISDIR(folder.stat().st_mode)
    except FileNotFoundError as fault:
        raise FileNotFoundError(errno.ENOENT, f"there is no folder {where}", str(folder)) from fault
    if not is_folder:
        raise NotADirectoryError(errno.ENOTDIR, f"{where} is not a folder", str(folder))
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, f"you have no permission to write in the folder {where}", str(folder))


_WORDS = {
    errno.ENAMETOOLONG: "its name is too long",
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "your share of the disk is full",
    errno.EFBIG: "the file becomes larger than this system allows",
}


def _of_output(fault: OSError, path: Path) -> OSError:
    """Return a fault under the name of the output, whatever file it happened to."""
    words = _WORDS.get(fault.errno or 0) or fault.strerror or str(fault)
    return OSError(fault.errno or errno.EIO, words, str(path))


def _is_ours(path: Path, file: Path | None, *, named: bool) -> bool:
    """Whether flexlash wrote a file and nobody has changed it; of a table, whether it is of our making or the same.

    Raises OSError when it cannot be read.
    """
    if path.suffix.lower() != ".csv":
        return bool(stamp_at(path))
    if file is None or filecmp.cmp(path, file, shallow=False):
        return True
    with path.open("rb") as table:
        return named and _has_our_header(table.read(_LONGEST_HEADER))


def _has_our_header(beginning: bytes) -> bool:
    """Whether a table begins with the header row of Results."""
    lines = beginning.decode("utf-8-sig", "replace").splitlines()
    with contextlib.suppress(csv.Error):
        return results_header(next(csv.reader(lines[:1]), ()))
    return False
