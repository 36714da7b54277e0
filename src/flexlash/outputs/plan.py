"""Where files go, once for all: planned before anything is computed, numbered, stamped, written whole or not at all.

Nothing of the user's is overwritten. A file at the place of an output is replaced only if flexlash wrote it and nobody
has changed it since, which its stamp says (`stamps.py`); whatever else stands there is left alone, never followed,
opened for writing or waited for, and the output gets ` (2)`. What a command is given to read is never an output.
"""

from __future__ import annotations

import contextlib
import csv
import errno
import os
import stat
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from flexlash.outputs.writing import put_new, remove_leftovers, replace, temporary
from flexlash.reading.products import is_replaced, results_header
from flexlash.schema.findings import shown
from flexlash.schema.stamps import stamp_at, stamped

__all__ = ["Output", "Plan", "Written"]

_KINDS = {stat.S_IFLNK: "it is a link", stat.S_IFDIR: "it is a folder", stat.S_IFIFO: "it is a pipe"}
_COPIES = 10_000
_TRIES = 3
_LONGEST_HEADER = 2**16
"""How much of a table is read to see whether its header row is one of ours [bytes]."""

Identity = tuple[int, int] | str
"""What tells a file from every other: its number on its disk, or its whole path."""


@dataclass(frozen=True, kw_only=True)
class Written:
    """Where an output was written, and a sentence about what stood in its way and was left alone, if anything did."""

    path: Path
    remark: str = ""


@dataclass(kw_only=True)
class Plan:
    """The files that a command is given, `inputs`, and those that it will write; none takes the place of another.

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
    skippable: dict[Identity, set[Path]] = field(init=False)

    def __post_init__(self) -> None:
        self.known = _by_identity(self.inputs)
        self.skippable = _by_identity(self.submissions)

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
            place = next(self._places(wanted, named=named, forced=forced))
        except OSError as fault:
            return Output(plan=self, wanted=wanted, path=wanted, fault=_of_output(fault, wanted))
        self.claimed.add(_full(place))
        return Output(plan=self, wanted=wanted, path=place, named=named, forced=forced)

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

    def _places(self, wanted: Path, *, named: bool, forced: bool) -> Iterator[Path]:
        """Yield the places, numbered from the wanted one on, at which an output of this name may stand."""
        for place in _numbered(wanted):
            if _full(place) in self.claimed or self.is_input(place):
                continue
            if not self.in_the_way(place, named=named, forced=forced):
                yield place

    def is_input(self, place: Path) -> bool:
        """Whether a place is that of an input, by whatever name, unless that is a file of ours that will be skipped."""
        mine = _identities(place)
        inputs, skippable = (_of(known, mine) for known in (self.known, self.skippable))
        if not inputs:
            return False
        if inputs - skippable:
            return True
        others = [path for path in self.submissions if path not in skippable]
        with contextlib.suppress(OSError):
            role = stamp_at(place)
            return not is_replaced(role, min(skippable), others, marked_copies=self.marked_copies)
        return True

    def in_the_way(self, place: Path, *, named: bool, forced: bool = False, data: bytes | None = None) -> str:
        """Return why what stands at a place is left alone, an empty text where nothing is or flexlash may replace it.

        `data` is what is to be written there; without it, a table that may be the same is no obstacle yet.
        """
        try:
            status = place.lstat()
        except FileNotFoundError:
            return ""
        if not stat.S_ISREG(status.st_mode):
            return _KINDS.get(stat.S_IFMT(status.st_mode), "it is a device")
        if (status.st_dev, status.st_ino) in self.written:
            return "it was written a moment ago"
        try:
            may_go = forced or _is_ours(place, data, named=named)
        except OSError:
            return "it cannot be read"
        return "" if may_go else "flexlash did not write it, or somebody has changed it"


@dataclass(frozen=True, kw_only=True)
class Output:
    """A planned output: the name that it should have, and the place that it gets."""

    plan: Plan
    wanted: Path
    path: Path
    named: bool = False
    forced: bool = False
    fault: OSError | None = None

    @property
    def ending(self) -> str:
        """How the output's name ends: `.xlsx`."""
        return self.wanted.suffix.lower()

    def require(self) -> None:
        """Raise OSError, with the output's name, where it is known already that it cannot be written."""
        if self.fault is not None:
            raise self.fault

    def write(self, data: bytes, role: str = "") -> Written:
        """Write the file and return where; with a role it is stamped, where its kind has room for that.

        The plan is looked at again: what another program has put there meanwhile is left alone as well. Raises OSError,
        with the output's name, when the file cannot be written.
        """
        self.require()
        data = stamped(data, role) if role else data
        for tries_left in reversed(range(_TRIES)):
            try:
                return self._write(data)
            except OSError as fault:
                # Where files cannot be locked, another run may have taken the temporary file for a leftover.
                if not (isinstance(fault, FileNotFoundError) and tries_left):
                    raise _of_output(fault, self.path) from fault
        raise AssertionError

    def _write(self, data: bytes) -> Written:
        why = self._obstacle()
        with temporary(self.path.parent, data) as file:
            for place in self._candidates():
                obstacle = self._put(file, place, data)
                if not obstacle:
                    status = place.stat()
                    self.plan.written.add((status.st_dev, status.st_ino))
                    return Written(path=place, remark=self._remark(why, place))
                why = why or obstacle
        raise FileExistsError(errno.EEXIST, "too many files of this name", str(self.wanted))

    def _obstacle(self) -> str:
        """Return why the output does not get the name that it should have, where a file is the reason."""
        if self.path == self.wanted or _full(self.wanted) in self.plan.claimed:
            return ""
        if self.plan.is_input(self.wanted):
            return "it is one of the files given to flexlash"
        return self.plan.in_the_way(self.wanted, named=self.named)

    def _candidates(self) -> Iterator[Path]:
        """Yield the planned place, then those that are free should something have come in its way."""
        yield self.path
        yield from (place for place in _numbered(self.wanted) if _full(place) not in self.plan.claimed)

    def _put(self, file: Path, place: Path, data: bytes) -> str:
        """Put the file in a place; return what is in the way, an empty text when it was put there."""
        if put_new(file, place):
            return ""
        before = place.lstat()
        if self.plan.is_input(place):
            return "it is one of the files given to flexlash"
        named = self.named and place == self.wanted
        if obstacle := self.plan.in_the_way(place, named=named, forced=self.forced, data=data):
            return obstacle
        return "" if replace(file, place, before) else "another program holds it open"

    def _remark(self, why: str, place: Path) -> str:
        if not why:
            return ""
        return f"{shown(self.wanted, 4096)} was left alone: {why}. Written instead: {shown(place.name, 255)}"


def _numbered(wanted: Path) -> Iterator[Path]:
    """Yield a path, then the same with ` (2)`, ` (3)` behind its name."""
    yield wanted
    yield from (wanted.with_name(f"{wanted.stem} ({copy}){wanted.suffix}") for copy in range(2, _COPIES))
    raise FileExistsError(errno.EEXIST, "too many files of this name", str(wanted))


def _full(path: Path) -> str:
    """Return the whole path of a place, links among its folders resolved, one at the place itself not."""
    return os.path.normcase(os.path.join(os.path.realpath(path.parent), path.name))  # noqa: PTH118


def _identities(path: Path) -> set[Identity]:
    """Return what tells a file from others, whatever it is called: its whole path and, where it exists, its number."""
    found: set[Identity] = {_full(path), os.path.normcase(os.path.realpath(path))}
    with contextlib.suppress(OSError, ValueError):
        status = path.stat()
        found |= {(status.st_dev, status.st_ino)} if status.st_ino else set()
    return found


def _by_identity(paths: Iterable[Path]) -> dict[Identity, set[Path]]:
    found: dict[Identity, set[Path]] = {}
    for path in paths:
        for identity in _identities(path):
            found.setdefault(identity, set()).add(path)
    return found


def _of(known: Mapping[Identity, set[Path]], mine: Iterable[Identity]) -> set[Path]:
    return {path for identity in mine for path in known.get(identity, ())}


def _require_folder(folder: Path) -> None:
    """Raise OSError where no file can be made in a folder."""
    where = shown(folder, 4096)
    try:
        is_folder = stat.S_ISDIR(folder.stat().st_mode)
    except FileNotFoundError as fault:
        raise FileNotFoundError(errno.ENOENT, f"there is no folder {where}", str(folder)) from fault
    if not is_folder:
        raise NotADirectoryError(errno.ENOTDIR, f"{where} is no folder", str(folder))
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, f"nothing may be written in the folder {where}", str(folder))


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


def _is_ours(place: Path, data: bytes | None, *, named: bool) -> bool:
    """Whether flexlash wrote a file and nobody has changed it; of a table, whether it is of our making or the same.

    Raises OSError when it cannot be read.
    """
    if place.suffix.lower() != ".csv":
        return bool(stamp_at(place))
    if data is None:
        return True
    with place.open("rb") as file:
        beginning = file.read(_LONGEST_HEADER)
        same = data is not None and place.lstat().st_size == len(data) and beginning + file.read() == data
    return same or (named and _has_our_header(beginning))


def _has_our_header(beginning: bytes) -> bool:
    """Whether a table begins with the header row of Results."""
    lines = beginning.decode("utf-8-sig", "replace").splitlines()
    with contextlib.suppress(csv.Error):
        return results_header(next(csv.reader(lines[:1]), ()))
    return False
