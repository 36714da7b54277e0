"""Submissions → how each ended, in order, whatever ends first: read here, computed by workers, written here.

Nothing that goes wrong with one stops the others. What waits for its turn is kept without its files.
"""

from __future__ import annotations

import hashlib
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from flexlash.analysis.examination import tables_beside
from flexlash.analysis.options import Options, Progress
from flexlash.analysis.outcome import Written
from flexlash.batch.answer import Answer, Command, Task
from flexlash.batch.ended import Ended, fault_of, fault_words
from flexlash.batch.executor import ClusterError, Executor, WorkerLostError
from flexlash.batch.given_files import Given
from flexlash.batch.manifest import Manifest
from flexlash.outputs.delivery import with_file
from flexlash.outputs.export_places import ExportPlaces
from flexlash.outputs.plan import Output
from flexlash.reading.gate import PARQUET, opened_file
from flexlash.reading.products import Companions, digests_of
from flexlash.reading.read import Source
from flexlash.reading.refusal import Refusal
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.file_faults import unusable
from flexlash.schema.findings import finding, readable, shown
from flexlash.schema.stamps import stamp_at

__all__ = ["Batch", "Wanted", "computed_apart", "large_tables", "side_by_side", "tables_or_why"]

_AHEAD = 2
"""Tasks for each worker that are handed over, so that none waits while answers are written."""

_LEAST_OF_LARGE = 40_000
"""Bytes below which no text has so many rows that it is computed in chunks."""

Advance = Callable[[Ended], None]
"""Called with each submission when it has ended, whichever is first."""


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """A submission and where its report, or the fixed one, its marked copy, and its samples and pictures go.

    None for what is not wanted.
    """

    given: Given
    file: Output | None = None
    copy: Output | None = None
    exports: ExportPlaces | None = None


@dataclass(frozen=True, kw_only=True)
class Batch:
    """What is to be done with submissions.

    `tables` are those beside each of them, by the sheet that each replaces, or why they cannot be used; `manifest` is
    where it is written down what is done, `resume` that an earlier run has left something. `several` says that a
    skipped one is no failure; `progress` is told of the rows of a large table.
    """

    command: Command
    options: Options
    wanted: Sequence[Wanted]
    tables: Mapping[str, Source] | OSError | Refusal = field(default_factory=dict)
    manifest: Manifest | None = None
    resume: bool = False
    several: bool = False
    progress: Progress | None = None


def side_by_side(batch: Batch, executor: Executor, advance: Advance) -> Iterator[Ended]:
    """Yield how each submission ended, in the order of the batch."""
    yield from _SideBySide(batch, executor, advance).ended()


def tables_or_why(options: Options) -> dict[str, Source] | OSError | Refusal:
    """Return the tables that stand beside each submission, or why they cannot be used."""
    try:
        return tables_beside(options)
    except (OSError, Refusal) as why:
        return why


def large_tables(options: Options, paths: Sequence[Path]) -> bool:
    """Return whether one of these files is a table that is computed in chunks."""
    found = False
    for path in paths:
        with suppress(OSError, Refusal):
            if path.stat().st_size >= _LEAST_OF_LARGE or _is_parquet(path):
                from flexlash.reading.survey import is_large

                found = found or is_large(path, options.limits)
    return found


def _is_parquet(path: Path) -> bool:
    """Whether a file is a Parquet file, which may hold many rows that are alike in few bytes."""
    with opened_file(path) as file:
        return file.read(len(PARQUET)) == PARQUET


def computed_apart(task: bytes) -> bytes:
    """Return the answer to a task; only where it is asked for are the libraries loaded."""
    from flexlash.batch.compute import compute

    return compute(task)


@dataclass(frozen=True, kw_only=True)
class _Begun:
    """A submission under way: its place, and when it was begun."""

    index: int
    start: float = field(default_factory=time.perf_counter)


@dataclass(frozen=True, kw_only=True)
class _HandedOver(_Begun):
    """A submission that a worker has, with its digest."""

    sha256: str
    future: Future[bytes]


class _SideBySide:
    """The submissions under way."""

    def __init__(self, batch: Batch, executor: Executor, advance: Advance) -> None:
        self._batch = batch
        self._executor = executor
        self._advance = advance
        self._given = [one.given.path for one in batch.wanted if not one.given.skipped]
        self._digests = digests_of(self._given) if len(self._given) > 1 else frozenset[str]()
        # What a worker is told: nothing of where files lie here; a single submission has all processes for its rows.
        jobs = 1 if len(self._given) > 1 else batch.options.jobs
        self._asked = batch.options.without_tables(jobs=jobs, given=(), marked_copy=None, progress=None)

    def ended(self) -> Iterator[Ended]:
        """Yield how each submission ended, in order."""
        ahead = deque(range(len(self._batch.wanted)))
        begun: dict[Future[bytes], _HandedOver] = {}
        finished: dict[int, Ended] = {}
        for turn in range(len(self._batch.wanted)):
            while turn not in finished:
                while ahead and turn not in finished and self._may_begin(ahead[0], len(begun)):
                    one = _Begun(index=ahead.popleft())
                    if handed_over := self._guarded(one, finished, partial(self._handed_over, one)):
                        begun[handed_over.future] = handed_over
                if turn not in finished:
                    for future in wait(begun, return_when=FIRST_COMPLETED).done:
                        waited = begun.pop(future)
                        self._guarded(waited, finished, partial(self._answered, waited))
            yield finished.pop(turn)

    def _may_begin(self, index: int, begun: int) -> bool:
        """Whether a submission is begun beside so many others; a large table waits until they are written and told."""
        if begun >= _AHEAD * self._executor.workers:
            return False
        return not (begun and self._is_large(index))

    def _is_large(self, index: int) -> bool:
        """Whether a submission is computed in chunks, for which this process is busy until it has ended."""
        batch, given = self._batch, self._batch.wanted[index].given
        computed = batch.command != "fix" and not given.skipped and given.fault is None
        return computed and large_tables(batch.options, [given.path])

    def _guarded(
        self, one: _Begun, finished: dict[int, Ended], step: Callable[[], Ended | _HandedOver]
    ) -> _HandedOver | None:
        """Take a step with a submission; return what it waits for, None when it has ended in whatever way."""
        wanted = self._batch.wanted[one.index]
        path = wanted.given.path
        try:
            ended = step()
        except ClusterError:
            # Nobody is there to compute the others either.
            raise
        except Refusal as refusal:
            found = finding(refusal.code, **{"file": readable(path.name), **refusal.facts})
            ended = Ended.failing(path, refusal.exit_code, found.message, found)
        except OSError as fault:
            ended = Ended.failing(path, ExitCode.NO_FILE, unusable(fault, path))
        except Exception as exception:  # noqa: BLE001
            internal = fault_of(exception)
            ended = replace(Ended.failing(path, ExitCode.INTERNAL, fault_words(internal.kind)), fault=internal)
        if isinstance(ended, _HandedOver):
            return ended
        given, seconds = wanted.given, time.perf_counter() - one.start
        finished[one.index] = replace(ended, below=given.below, in_folder=given.in_folder, seconds=seconds)
        self._advance(finished[one.index])
        return None

    def _handed_over(self, one: _Begun) -> Ended | _HandedOver:
        """Hand a submission over to a worker, or say how it ended before that."""
        batch, wanted = self._batch, self._batch.wanted[one.index]
        path = wanted.given.path
        if wanted.given.skipped:
            return Ended.refusing(path, Refusal(wanted.given.skipped), several=batch.several)
        if wanted.given.fault is not None:
            why = readable(wanted.given.fault.strerror or wanted.given.fault)
            return Ended.failing(path, ExitCode.NO_FILE, f"{shown(path, 4096)} could not be opened: {why}")
        if self._is_large(one.index):
            return self._large(wanted)
        try:
            source = Source.at(path, batch.options.limits)
        except Refusal as refusal:
            return Ended.refusing(path, refusal, several=batch.several)
        if wanted.file is not None:
            wanted.file.require()
        if isinstance(batch.tables, OSError | Refusal):
            raise batch.tables
        sha256 = hashlib.sha256(source.data).hexdigest()
        if ended := self._done(wanted, sha256):
            return ended
        task = Task(
            command=batch.command,
            source=replace(source, path=None, companions=self._companions(path)),
            options=self._asked,
            tables=batch.tables,
            report=wanted.file.ending if wanted.file else "",
            copy=wanted.copy.ending if wanted.copy else "",
            samples=wanted.exports is not None and wanted.exports.samples,
            pictures=wanted.exports is not None and wanted.exports.pictures,
        )
        future = self._executor.submit(computed_apart, task.as_bytes())
        return _HandedOver(index=one.index, start=one.start, sha256=sha256, future=future)

    def _answered(self, one: _HandedOver) -> Ended:
        """Return how a submission ended that was handed over, with its files written."""
        batch, wanted = self._batch, self._batch.wanted[one.index]
        path = wanted.given.path
        try:
            answer = Answer.of(one.future.result())
        except WorkerLostError as lost:
            refusal = batch.options.limits.exceeded(lost.setting) if lost.setting else Refusal("E118")
            return Ended.refusing(path, refusal, several=batch.several, sha256=one.sha256)
        return self._kept(wanted, answer, _written(wanted, answer), one.sha256)

    def _large(self, wanted: Wanted) -> Ended:
        """Compute a large table, whose chunks go through the workers beside the other submissions."""
        from flexlash.batch.large_tables import LargeTable, large_table

        batch, path = self._batch, wanted.given.path
        if isinstance(batch.tables, OSError | Refusal):
            raise batch.tables
        if batch.manifest:
            with path.open("rb") as file:
                sha256 = hashlib.file_digest(file, "sha256").hexdigest()
            if ended := self._done(wanted, sha256):
                return ended
        table = LargeTable(
            path=path,
            ran=batch.command == "run",
            options=batch.options,
            tables=batch.tables,
            companions=self._companions(path),
            report=wanted.file,
            copy=wanted.copy,
            exports=wanted.exports,
            resume=batch.resume,
        )
        answer, written = large_table(table, self._executor, self._batch.progress)
        return self._kept(wanted, answer, written, answer.told.get("sha256", ""))

    def _done(self, wanted: Wanted, sha256: str) -> Ended | None:
        """Return how a submission ended in an earlier run, where that is proven.

        A fixed one is looked at again when its original is given as well: it may have come later.
        """
        if self._batch.manifest is None:
            return None
        given = wanted.given
        ended = self._batch.manifest.done(given.path, given.below, sha256, wanted.file, wanted.copy)
        if ended is None or self._companions(given.path).hold_the_original(stamp_at(given.path)):
            return None
        if wanted.file is not None:
            wanted.file.plan.keep(ended.written.paths)
        return ended

    def _companions(self, path: Path) -> Companions:
        return Companions.of(path, self._given, self._digests)

    def _kept(self, wanted: Wanted, answer: Answer, written: Written, sha256: str) -> Ended:
        """Return how a submission ended, and write it down for a later run."""
        given, several = wanted.given, self._batch.several
        ended = replace(Ended.answered(given.path, answer, written, several=several), below=given.below)
        if self._batch.manifest is not None:
            self._batch.manifest.keep(ended, sha256, wanted.file, wanted.copy)
        return ended


def _written(wanted: Wanted, answer: Answer) -> Written:
    """Write the files of an answer; return where. A marked copy that cannot be written loses nothing else."""
    written = Written()
    if wanted.file is not None and answer.file is not None:
        written = with_file(written, wanted.file, answer.file.data, answer.file.role)
    if wanted.exports is not None:
        written = wanted.exports.written(written, answer.exports)
    if wanted.copy is None or answer.copy is None:
        return written
    try:
        with_copy = with_file(written, wanted.copy, answer.copy.data, answer.copy.role)
    except OSError as fault:
        return replace(written, fault=fault)
    return replace(with_copy, marked_copy=with_copy.paths[-1], not_carried=answer.copy.not_carried)
