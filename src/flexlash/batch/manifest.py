"""What a run has done in a folder of outputs, line by line, so that a later one goes on where it was stopped.

A submission is done where its content, the options and the version are those of the line and each file that was written
for it is there with the same digest. What was refused, failed or skipped has no line: it is looked at again.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from flexlash import __version__
from flexlash.analysis.options import TABLES, Options
from flexlash.analysis.outcome import Written
from flexlash.batch.answer import WorstVariant
from flexlash.batch.ended import Ended
from flexlash.outputs.lines_file import LinesFile
from flexlash.outputs.plan import Output
from flexlash.reading.read import Source
from flexlash.schema.exit_codes import ExitCode

__all__ = ["MANIFEST_NAME", "Manifest", "options_digest"]

MANIFEST_NAME = ".flexlash-manifest.jsonl"
_TITLE = json.dumps({"flexlash": "what was done here, by which --resume goes on"})
_OF_THE_PLACE = frozenset({"jobs", "progress", "given", "marked_copy", "from_report", *TABLES})
"""Options on which no output depends, or of which the digest of what they name counts."""

_KEYS = {
    "submission", "sha256", "options", "planned", "files", "copy", "remarks", "not_carried", "code", "ended",
}  # fmt: skip
"""What each line holds; any other line is none."""

_TOLD = ("told", "finding_lines", "words", "details", "by_rule")
_PIECE = 2**20


def options_digest(options: Options, tables: Mapping[str, Source], *, marked: bool) -> str:
    """Return the digest of all on which outputs depend beside the submission; `marked` says that copies are wanted."""
    chosen = {one.name: getattr(options, one.name) for one in fields(Options) if one.name not in _OF_THE_PLACE}
    beside = {name: (table.name, hashlib.sha256(table.data).hexdigest()) for name, table in tables.items()}
    facts = (__version__, sorted(chosen.items()), sorted(beside.items()), marked)
    return hashlib.sha256(repr(facts).encode()).hexdigest()


class Manifest:
    """The lines of a folder of outputs; `options` is the digest of the present ones."""

    def __init__(self, folder: Path, options: str, *, resume: bool) -> None:
        """Open the lines, or begin them anew unless `resume`; raise OSError where that cannot be."""
        self.fault: OSError | None = None
        self._folder = folder
        self._options = options
        self._file = LinesFile(folder / MANIFEST_NAME, _TITLE, anew=not resume)
        self._done: dict[tuple[str, str, str], dict[str, Any]] = {}
        for line in self._file.lines:
            with contextlib.suppress(ValueError):
                entry = json.loads(line)
                if isinstance(entry, dict) and entry.keys() == _KEYS:
                    self._done[entry["submission"], entry["sha256"], entry["options"]] = entry

    def close(self) -> None:
        """Let go of the file."""
        self._file.close()

    def done(self, path: Path, below: Path, sha256: str, *outputs: Output | None) -> Ended | None:
        """Return how a submission ended whose report and marked copy are to go there; None where that is not proven."""
        entry = self._done.get((_name(path, below), sha256, self._options))
        if entry is None or entry["planned"] != self._places(outputs):
            return None
        paths = [self._folder / name for name, _ in entry["files"]]
        if any(_digest(place) != digest for place, (_, digest) in zip(paths, entry["files"], strict=True)):
            return None
        ended = entry["ended"]
        return Ended(
            path=path,
            below=below,
            code=ExitCode(entry["code"]),
            told=ended["told"],
            finding_lines=tuple((level, text) for level, text in ended["finding_lines"]),
            words=ended["words"],
            details=tuple(ended["details"]),
            by_rule=ended["by_rule"],
            worst=tuple(WorstVariant(**one) for one in ended["worst"]),
            written=Written(
                paths=tuple(paths),
                remarks=tuple(entry["remarks"]),
                marked_copy=None if entry["copy"] is None else paths[entry["copy"]],
                not_carried=None if entry["not_carried"] is None else tuple(entry["not_carried"]),
            ),
            done_before=True,
        )

    def keep(self, ended: Ended, sha256: str, *outputs: Output | None) -> None:
        """Write down how a submission ended, unless it is to be looked at again; where that fails, `fault` says why.

        `outputs` are those that were planned for it.
        """
        again = ended.refused or ended.skipped or ended.code in {ExitCode.INTERNAL, ExitCode.NO_FILE}
        if again or self.fault is not None:
            return
        try:
            self._file.append(json.dumps(self._entry(ended, sha256, outputs)))
        except OSError as fault:
            self.fault = fault

    def _entry(self, ended: Ended, sha256: str, outputs: Sequence[Output | None]) -> dict[str, Any]:
        """Return a submission's line."""
        written = ended.written
        return {
            "submission": _name(ended.path, ended.below),
            "sha256": sha256,
            "options": self._options,
            "planned": self._places(outputs),
            "files": [(self._place(path), _digest(path)) for path in written.paths],
            "copy": None if written.marked_copy is None else written.paths.index(written.marked_copy),
            "remarks": written.remarks,
            "not_carried": written.not_carried,
            "code": ended.code,
            "ended": {name: getattr(ended, name) for name in _TOLD} | {"worst": [asdict(one) for one in ended.worst]},
        }

    def _places(self, outputs: Sequence[Output | None]) -> list[str | None]:
        return [None if output is None else self._place(output.path) for output in outputs]

    def _place(self, path: Path) -> str:
        """Return where a file lies: in the folder, or wherever samples and pictures were to go."""
        if path.is_relative_to(self._folder):
            return path.relative_to(self._folder).as_posix()
        return os.path.abspath(path)  # noqa: PTH100  # a link among its folders stays one


def _name(path: Path, below: Path) -> str:
    return (below / path.name).as_posix()


def _digest(path: Path) -> str:
    """Return a file's digest, an empty text where it cannot be read."""
    digest = hashlib.sha256()
    try:
        with path.open("rb") as file:
            while piece := file.read(_PIECE):
                digest.update(piece)
    except OSError:
        return ""
    return digest.hexdigest()
