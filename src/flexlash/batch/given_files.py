"""Files and folders of a command line → the submissions among them, in order; what is not one is told, not read."""

from __future__ import annotations

import contextlib
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from flexlash.reading.products import stamped_product
from flexlash.schema.findings import shown
from flexlash.schema.stamps import stamp_at

__all__ = ["Given", "GivenFiles", "given_files"]

_ENDINGS = frozenset({".xlsx", ".xlsm", ".csv", ".tsv", ".parquet"})
"""How a file in a folder must end to be looked at; what it is is judged by its content. Most texts are no tables."""

_UNFINISHED = frozenset({".tmp", ".part", ".crdownload", ".filepart"})
"""How files end that another program is still writing."""

_LOCK = "~$"
_SHOWN_ENDINGS = 5


@dataclass(frozen=True, kw_only=True)
class Given:
    """A file that was given, or met in a folder that was.

    `below` is the sub-folder of the given folder in which it lies. `skipped` is the code of the finding that says why
    it is none that is looked at, empty for a submission; `fault` says why a folder could not be looked into.
    """

    path: Path
    below: Path = Path()
    skipped: str = ""
    in_folder: bool = False
    fault: OSError | None = None


@dataclass(frozen=True, kw_only=True)
class GivenFiles:
    """What a command line gives: its files in order, sentences about what was left alone, the folders among it."""

    files: tuple[Given, ...]
    remarks: tuple[str, ...] = ()
    folders: tuple[Path, ...] = ()

    @property
    def submissions(self) -> tuple[Path, ...]:
        """The files that are looked at."""
        return tuple(given.path for given in self.files if not given.skipped and given.fault is None)

    @property
    def sub_folders(self) -> dict[Path, Path]:
        """In which sub-folder of its folder a submission lies, of those that do."""
        return {given.path: given.below for given in self.files if given.below != Path()}


def given_files(
    paths: Sequence[Path],
    *,
    recursive: bool = False,
    output: Path | None = None,
    beside: Iterable[Path] = (),
    marked_copies: bool = False,
) -> GivenFiles:
    """Return the files of a command line: as they are given, those of a folder by name, none of them twice.

    `recursive` also takes what lies below a folder; links are not followed and the folder `output` is not entered.
    Tables given `beside` are no submissions; `marked_copies` takes marked copies for submissions.
    """
    files: dict[str, Given] = {}
    folders, remarks = list[Path](), list[str]()
    tables = {_identity(path) for path in beside}
    for path in paths:
        # Not is_dir, which raises for a name that is too long.
        if not os.path.isdir(path):  # noqa: PTH112
            files.setdefault(_identity(path), Given(path=path))
            continue
        folders.append(path)
        met = _Met(path, output, recursive=recursive)
        for given in met.files():
            identity = _identity(given.path)
            if identity in tables:
                met.left["table(s) given by an option"] += 1
            elif identity not in files:
                files[identity] = _judged(given, marked_copies=marked_copies)
        remarks.extend(met.remarks())
    return GivenFiles(files=tuple(files.values()), remarks=tuple(remarks), folders=tuple(folders))


def _identity(path: Path) -> str:
    """Return what tells a file from every other: its whole path, links among its folders resolved."""
    return os.path.normcase(os.path.join(os.path.realpath(path.parent), path.name))  # noqa: PTH118


def _judged(given: Given, *, marked_copies: bool) -> Given:
    """Return a file met in a folder, skipped where it is a lock file or its stamp says that flexlash wrote it."""
    code = ""
    if given.fault is None:
        with contextlib.suppress(OSError):
            is_lock = given.path.name.startswith(_LOCK)
            code = "I525" if is_lock else stamped_product(stamp_at(given.path), marked_copies=marked_copies)
    return Given(path=given.path, below=given.below, skipped=code, in_folder=True, fault=given.fault)


class _Met:
    """What is met in a folder: the files to look at, and counts of what is left alone."""

    def __init__(self, folder: Path, output: Path | None, *, recursive: bool) -> None:
        self.folder = folder
        self.recursive = recursive
        self.output = None if output is None else os.path.realpath(output)
        self.left: Counter[str] = Counter()
        self.endings: Counter[str] = Counter()

    def files(self) -> Iterator[Given]:
        """Yield the files of the folder by name, those of a sub-folder in the place of its name."""
        ahead = [(self.folder, Path())]
        while ahead:
            path, below = ahead.pop()
            try:
                if path != self.folder and not path.is_dir():
                    yield Given(path=path, below=below)
                    continue
                with os.scandir(path) as entries:
                    taken = sorted((entry for entry in entries if self._is_taken(entry)), key=lambda entry: entry.name)
                inner = below / path.name if path != self.folder else below
                ahead.extend((path / entry.name, inner) for entry in reversed(taken))
            except OSError as fault:
                yield Given(path=path, below=below, fault=fault)

    def _is_taken(self, entry: os.DirEntry[str]) -> bool:
        """Whether a file is looked at, or a folder looked into; counts it where not."""
        ending = Path(entry.name).suffix.lower()
        if entry.is_symlink():
            self.left["link(s)"] += 1
        elif entry.is_dir(follow_symlinks=False):
            return self.recursive and not entry.name.startswith(".") and os.path.realpath(entry.path) != self.output
        elif entry.name.startswith("."):
            self.left["hidden file(s)"] += 1
        elif ending in _UNFINISHED:
            self.left["unfinished file(s)"] += 1
        elif ending not in _ENDINGS or not entry.is_file():
            self.endings[ending or "without an ending"] += 1
        else:
            return True
        return False

    def remarks(self) -> Iterator[str]:
        """Yield sentences about what was left alone."""
        if count := self.endings.total():
            endings = sorted(self.endings)
            named = [shown(ending) for ending in endings[:_SHOWN_ENDINGS]] + ["…"] * (len(endings) > _SHOWN_ENDINGS)
            self.left[f"file(s) of other kinds ({', '.join(named)})"] = count
        counts = [f"{n} {what.replace('(s)', 's' * (n > 1))}" for what, n in sorted(self.left.items())]
        if counts:
            yield f"{shown(self.folder, longest=4096)}: not read: {', '.join(counts)}."
