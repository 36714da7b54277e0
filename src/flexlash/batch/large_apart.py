"""A large table computed by a process of its own, with borrowed workers: the one that asks stays as small as it is."""

from __future__ import annotations

import pickle
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path

from flexlash.analysis.options import Options
from flexlash.batch.answer import Answer, FileBytes, Told, Travelling
from flexlash.batch.lent_workers import borrowed_workers
from flexlash.outputs.plan import Plan
from flexlash.reading.products import CHECKED_NAME, REPORT_NAME, Companions
from flexlash.workers import tell

__all__ = ["LargeAnswer", "LargeTask", "compute_large"]

_CHUNK_ROWS = 1000
"""Rows of a chunk: what is small need not wait long until a worker is free."""

_STEM = 80
"""Characters of a submission's name in the names of files."""


@dataclass(frozen=True, kw_only=True)
class LargeTask(Travelling):
    """A large table at a path, the name it was handed in under, and the folder for its files and all that is underway.

    So many `workers` may be busy with it. What a task for the same folder has done before is taken up.
    """

    path: Path
    name: str
    folder: Path
    options: Options
    workers: int


@dataclass(frozen=True, kw_only=True)
class LargeAnswer(Answer):
    """What came of a large table, and its files in the folder, by what they are; `file` and `copy` hold no bytes."""

    files: Mapping[str, Path] = field(default_factory=dict)

    @classmethod
    def with_files(cls, answer: Answer, files: Mapping[str, Path]) -> LargeAnswer:
        """Return an answer whose files lie in a folder."""
        known = {one.name: getattr(answer, one.name) for one in fields(Answer)}
        if "report" in files:
            known["file"] = FileBytes(data=b"", role="report")
        if "checked" in files:
            known["copy"] = FileBytes(data=b"", role="checked", not_carried=None)
        return cls(**known, files=files)


def compute_large(task: bytes) -> bytes:
    """Return the answer to a `LargeTask` in a driver (`lent_workers.driven`), telling its rows meanwhile."""
    return _computed(LargeTask.of(task)).as_bytes()


def _computed(task: LargeTask) -> LargeAnswer:
    # Only in the driver: polars comes with it.
    from flexlash.batch.large_tables import LargeTable, large_table

    for path in task.folder.iterdir():
        if path.is_file():
            # Of a run that ended before its files were kept; a table would not be replaced, having no stamp.
            path.unlink()
    stem = _inert_stem(task.name)
    plan = Plan(inputs=[task.path])
    table = LargeTable(
        path=task.path,
        name=task.name,
        ran=True,
        options=task.options,
        companions=Companions(),
        report=plan.claim(task.folder / f"{stem}{REPORT_NAME}.xlsx"),
        copy=plan.claim(task.folder / f"{stem}{CHECKED_NAME}.xlsx"),
        resume=True,
        pages=True,
    )
    with borrowed_workers(task.workers) as executor:
        answer, written = large_table(table, executor, _tell_rows, chunk_rows=_CHUNK_ROWS)
    if written.fault is not None:
        raise written.fault
    return LargeAnswer.with_files(answer, {_role(path, stem): path for path in written.paths})


def _tell_rows(done: int, rows: int) -> None:
    tell(pickle.dumps(Told(rows_done=done, rows=rows, stage="computing"), protocol=5))


def _role(path: Path, stem: str) -> str:
    """Return what a file is, by the end of its name."""
    return path.stem.removeprefix(f"{stem}-")


def _inert_stem(name: str) -> str:
    """Return the stem of a stranger's name with nothing in it that has a meaning in a path.

    >>> _inert_stem("../a:b.csv"), _inert_stem("...")
    ('a_b', 'submission')
    """
    stem = "".join(letter if letter.isalnum() or letter in "-_ ." else "_" for letter in Path(name).stem)
    return stem.strip(". ")[:_STEM] or "submission"
