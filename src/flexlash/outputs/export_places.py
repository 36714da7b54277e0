"""Where samples and pictures of a submission go that are wanted beside its report."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from flexlash.analysis.outcome import Written
from flexlash.outputs.plan import Plan
from flexlash.report.exported_file import ExportedFile, ExportKind

__all__ = ["ExportPlaces", "export_folders", "export_places"]

_FORBIDDEN = re.compile(r'[<>:"/\\|?*\x00-\x1f\x7f]')

Folders = Mapping[ExportKind, Path]
"""The folders that are named, by what goes into them."""


@dataclass(frozen=True, kw_only=True)
class ExportPlaces:
    """The folders into which the samples and pictures of a submission go, and how their names begin."""

    plan: Plan
    folders: Folders
    stem: str

    @property
    def samples(self) -> bool:
        """Whether samples are wanted."""
        return "samples" in self.folders

    @property
    def pictures(self) -> bool:
        """Whether pictures are wanted."""
        return "pictures" in self.folders

    def written(self, written: Written, files: Iterable[ExportedFile]) -> Written:
        """Write the files; return what was written before and these. The first that cannot be written is the last."""
        for file in files:
            try:
                output = self.plan.claim(self.folders[file.kind] / f"{self.stem}{file.name}")
                done = output.write(file.data, file.role)
            except OSError as fault:
                return replace(written, fault=fault)
            remarks = (done.remark,) if done.remark else ()
            written = replace(written, paths=(*written.paths, done.path), remarks=(*written.remarks, *remarks))
        return written


def export_folders(samples: Path | None, pictures: Path | None) -> Folders:
    """Return the folders that are named, made where they are not there; raise ValueError for what can be none."""
    named: dict[ExportKind, Path | None] = {"samples": samples, "pictures": pictures}
    folders = {kind: folder for kind, folder in named.items() if folder is not None}
    for kind, folder in folders.items():
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as fault:
            raise ValueError(f"{folder} cannot be the folder of {kind}: {fault.strerror}.") from fault
    return folders


def export_places(
    plan: Plan, submissions: Sequence[Path], folders: Folders, below: Mapping[Path, Path] | None = None
) -> list[ExportPlaces]:
    """Return where samples and pictures of each submission go: into the named folders, under its own name.

    Submissions of one name are numbered in their order; `below` gives the sub-folder of those that lie in one.
    """
    found, often = [], Counter[tuple[Path, str]]()
    for path in submissions:
        inside = (below or {}).get(path, Path())
        stem = _FORBIDDEN.sub("_", path.stem) or "submission"
        often[inside, stem.casefold()] += 1
        number = often[inside, stem.casefold()]
        places: dict[ExportKind, Path] = {kind: folder / inside for kind, folder in folders.items()}
        for place in places.values():
            # What cannot be made is told when something is written there.
            with suppress(OSError):
                place.mkdir(parents=True, exist_ok=True)
        found.append(ExportPlaces(plan=plan, folders=places, stem=stem if number == 1 else f"{stem} ({number})"))
    return found
