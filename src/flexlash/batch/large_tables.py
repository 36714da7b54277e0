"""A table that is too large for one process: surveyed once, computed in chunks by the workers, joined at the end.

This process hands over bytes and writes files; it parses nothing of the table and holds none of its Results. What came
of each chunk is kept in a working folder beside the output, so that a run that was stopped can be resumed. The bytes
that come out are the same for any size of the chunks, any workers and any number of resumptions.
"""

from __future__ import annotations

import hashlib
import json
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple, TypeVar

from flexlash import __version__
from flexlash.analysis.options import Options, Progress
from flexlash.analysis.outcome import Written
from flexlash.batch.answer import Answer
from flexlash.batch.chunk import (
    ChunkAnswer,
    ChunkSummary,
    ChunkTask,
    blank_row,
    compute_chunk,
)
from flexlash.batch.chunk_totals import Totals
from flexlash.batch.executor import Executor, Work, WorkerLostError
from flexlash.batch.large_outputs import LargeOutputs
from flexlash.outputs.export_places import ExportPlaces
from flexlash.outputs.plan import Output
from flexlash.outputs.working_folder import Parts, WorkingFolder, working_folder
from flexlash.reading.excerpt import excerpt
from flexlash.reading.limited_process import ProcessFaultError, ask
from flexlash.reading.products import Companions
from flexlash.reading.read import Source
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.reading.survey import Survey, limits_of_survey, survey
from flexlash.schema.findings import finding, readable

__all__ = ["CHUNK_ROWS", "LargeTable", "large_table"]

_Result = TypeVar("_Result")

CHUNK_ROWS = 5000
"""Rows of a chunk: a worker needs about 220 MiB for them."""

_AHEAD = 2
"""Chunks for each worker that are handed over or finished and not yet taken, so that none waits for this process."""

_MOST_LOST = 20
"""Rows that stop their process beyond which it is not the rows' fault: every one costs nine processes."""

_LIMIT = "E110"
"""Code of a file that exceeds a limit: fewer rows may not."""


@dataclass(frozen=True, kw_only=True)
class LargeTable:
    """A large table and what is to be done with it.

    `ran` says that its spread is computed, not merely that it is checked. `tables` stand beside it, by the sheet that
    each replaces, `companions` are the files given with it. `report` is where its Results go, `copy` where its findings
    go as a workbook, `exports` where samples and pictures of its worst rows go, None for each that is not wanted. With
    `resume` what a stopped run has done is taken up. `name` is that of the table as it may be printed, where its path
    has another; with `pages` the answer has what a page shows.
    """

    path: Path
    name: str = ""
    ran: bool
    options: Options
    tables: Mapping[str, Source] = field(default_factory=dict)
    companions: Companions | None = None
    report: Output | None = None
    copy: Output | None = None
    exports: ExportPlaces | None = None
    resume: bool = False
    pages: bool = False

    @property
    def called(self) -> str:
        """The name by which the table is told of."""
        return self.name or readable(self.path.name)


def large_table(
    table: LargeTable,
    executor: Executor,
    progress: Progress | None = None,
    *,
    chunk_rows: int = CHUNK_ROWS,
    work: Work = compute_chunk,
) -> tuple[Answer, Written]:
    """Return what came of a large table, and what was written for it; `progress` is told of its rows.

    A report holds the worst rows and names the files beside it that hold all Results and all findings. `work` computes
    a chunk. A file that is no table, or that changes meanwhile, is answered as refused. Raises OSError when it cannot
    be opened or an output cannot be written, ProcessFaultError for a fault of the program. Of a marked copy that cannot
    be written the `fault` of what was written says why.
    """
    if table.report is not None:
        table.report.require()
    limits = table.options.limits
    try:
        within = limits_of_survey(limits, table.path.stat().st_size)
        found = _asked(table, survey, within, table.path, limits, table.called)
    except _RefusedError as refused:
        with table.path.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
        return _refused(table, digest, refused.chunk), Written()
    run = _Run(table, found, executor, progress=progress, chunk_rows=chunk_rows, work=work)
    return run.carried_out()


def _asked(table: LargeTable, task: Callable[..., _Result], limits: ReadingLimits, *arguments: object) -> _Result:
    """Return what the limited process says of a table; raise _RefusedError where it is refused."""
    try:
        return ask(task, limits, *arguments)
    except Refusal as refusal:
        found = finding(refusal.code, **{"file": table.called, **refusal.facts})
        raise _RefusedError(ChunkSummary(refusal=found, skipped=found.level == "info")) from refusal


def _refused(table: LargeTable, sha256: str, chunk: ChunkSummary) -> Answer:
    """Return what is said of a table that is no readable submission, or that flexlash itself wrote."""
    from flexlash.analysis.outcome import Outcome
    from flexlash.analysis.results import empty_results
    from flexlash.batch.compute import answer_of
    from flexlash.reading.raw import Submission

    submission = Submission(name=table.called, sha256=sha256, kind="refused")
    findings = () if chunk.refusal is None else (chunk.refusal,)
    outcome = Outcome(submission=submission, results=empty_results(), findings=findings, skipped=chunk.skipped)
    return answer_of(outcome, ran=table.ran)


class _Piece(NamedTuple):
    """What came of rows that were computed together: of a chunk, or of a part of one that was halved."""

    summary: ChunkSummary
    parts: Mapping[str, bytes]

    @classmethod
    def of(cls, data: bytes) -> _Piece:
        """Return what a worker says; raise _RefusedError where the rows are no readable submission."""
        answer = ChunkAnswer.of(data)
        summary = ChunkSummary.of(answer.summary)
        if summary.refusal is not None:
            raise _RefusedError(summary)
        parts = {what: getattr(answer, what) for what in ("summary", "results", "tolerances", "findings")}
        return cls(summary, {what: part for what, part in parts.items() if part})


class _RefusedError(Exception):
    """A chunk is no readable submission, so that the whole table is none."""

    def __init__(self, chunk: ChunkSummary) -> None:
        super().__init__()
        self.chunk = chunk


class _Run:
    """One large table on its way.

    `kept` is what came of its chunks in the last pass, in order, `lost` how many rows have stopped their process.
    """

    def __init__(
        self,
        table: LargeTable,
        found: Survey,
        executor: Executor,
        *,
        progress: Progress | None,
        chunk_rows: int,
        work: Work,
    ) -> None:
        self.table = table
        self.survey = found
        self.executor = executor
        self.progress = progress
        self.chunk_rows = chunk_rows
        self.work = work
        self.kept: list[Parts] = []
        self.lost = 0

    @cached_property
    def _options(self) -> Options:
        """What a worker is told of the options: nothing of this machine, and nothing that looks at all rows."""
        return self.table.options.without_tables(progress=None, marked_copy=None, given=(), jobs=1, strict=False)

    @cached_property
    def _limits(self) -> ReadingLimits:
        return limits_of_survey(self.table.options.limits, self.survey.size)

    @property
    def _ending(self) -> str:
        """How the file of all Results ends, an empty text where there is none."""
        report = self.table.report
        return "" if report is None or not self.table.ran else report.ending if report.ending != ".xlsx" else ".parquet"

    def carried_out(self) -> tuple[Answer, Written]:
        """Return what came of the table, and what was written for it."""
        copy = self.table.copy if self.table.copy is None or self.table.copy.fault is None else None
        with ExitStack() as stack:
            target = self.table.report or copy
            folder = None
            if target is not None:
                folder = stack.enter_context(working_folder(target.path, self._what(), resume=self.table.resume))
            try:
                totals = self._computed(folder)
                outputs = LargeOutputs(
                    name=self.survey.name, ran=self.table.ran, options=self._options, tables=self.table.tables,
                    report=self.table.report, copy=self.table.copy, exports=self.table.exports,
                    ending=self._ending, totals=totals,
                    parts=self.kept, folder=folder, source=self._source, executor=self.executor,
                )  # fmt: skip
                files = outputs.written()
                page = outputs.page(files) if self.table.pages else b""
            except _RefusedError as refused:
                return _refused(self.table, self.survey.sha256, refused.chunk), Written()
        answer = totals.answer(
            {"submission": self.survey.name, "sha256": self.survey.sha256, "version": __version__},
            ran=self.table.ran,
            fail_over_limit=self.table.options.fail_over_limit,
            findings_file=files.findings.path.name if files.findings else "",
        )
        return replace(answer, page=page, details=(*answer.details, *files.notes)), files.told()

    def _what(self) -> dict[str, object]:
        """Return what the parts in a working folder are parts of."""
        options = {key: value for key, value in vars(self._options).items() if key not in {"fail_over_limit", "limits"}}
        options |= {"limits": vars(self._options.limits), "strict": self.table.options.strict}
        sums = {name: hashlib.sha256(source.data).hexdigest() for name, source in self.table.tables.items()}
        return {
            "flexlash": __version__,
            "source": self.survey.sha256,
            "name": self.survey.name,
            "options": json.loads(json.dumps(options, default=str, sort_keys=True)),
            "tables": sums,
            "ran": self.table.ran,
            "results": self._ending,
            "rows": self.chunk_rows,
        }

    def _computed(self, folder: WorkingFolder | None) -> Totals:
        """Return what came of all rows; with `strict` they are checked first, and computed if none has an error."""
        ran, strict = self.table.ran, self.table.options.strict
        if strict or not ran:
            totals = self._pass(folder, "check-" if ran else "", spread=False)
            is_held_back = strict and totals.computed < totals.rows
            if is_held_back:
                totals.hold_back()
            if is_held_back or not ran:
                return totals
        return self._pass(folder, "", spread=True)

    def _pass(self, folder: WorkingFolder | None, prefix: str, *, spread: bool) -> Totals:
        """Return what came of all chunks, in order; their parts are kept."""
        totals, done = Totals(), folder.done if folder else {}
        self.kept.clear()
        waiting: deque[tuple[range, Future[bytes] | None]] = deque()
        chunks = self.survey.chunks(self.chunk_rows)
        try:
            while True:
                while len(waiting) < _AHEAD * self.executor.workers and (rows := next(chunks, None)) is not None:
                    known = _name(prefix, rows) in done
                    waiting.append((rows, None if known else self._submitted(rows, spread=spread)))
                if not waiting:
                    return totals
                rows, future = waiting.popleft()
                name = _name(prefix, rows)
                if future is not None:
                    pieces = list(self._pieces(rows, future, spread=spread))
                    summaries = [piece.summary for piece in pieces]
                    parts = folder.keep(name, [piece.parts for piece in pieces]) if folder else ()
                else:
                    parts = done[name]
                    summaries = [ChunkSummary.of(part["summary"].read_bytes()) for part in parts]
                self.kept += parts
                for summary in summaries:
                    totals.add(summary)
                if self.progress:
                    self.progress(min(totals.rows, self.survey.rows), self.survey.rows)
        finally:
            for _, future in waiting:
                if future is not None:
                    future.cancel()

    def _submitted(self, rows: Sequence[int], *, spread: bool, passed_over: bool = False) -> Future[bytes]:
        """Return what will come of some rows."""
        task = ChunkTask(
            source=self._source(rows),
            options=self._options,
            tables=self.table.tables,
            spread=spread and not passed_over,
            ending=self._ending if spread else "",
            passed_over=passed_over,
        )
        return self.executor.submit(self.work, task.as_bytes())

    def _source(self, rows: Sequence[int]) -> Source:
        data = _asked(self.table, excerpt, self._limits, self.table.path, self.survey, rows)
        return Source(name=self.survey.name, data=data, companions=self.table.companions)

    def _pieces(self, rows: range, future: Future[bytes], *, spread: bool) -> Iterator[_Piece]:
        """Yield what came of some rows; of their halves where together they stop their process or exceed a limit."""
        piece = None
        try:
            piece = _Piece.of(future.result())
        except WorkerLostError:
            if not rows:
                raise
            if len(rows) == 1:
                piece = self._passed_over(rows)
        except _RefusedError as refused:
            if len(rows) <= 1 or refused.chunk.refusal is None or refused.chunk.refusal.code != _LIMIT:
                raise
        if piece is not None:
            yield piece
            return
        middle = len(rows) // 2
        halves = [(half, self._submitted(half, spread=spread)) for half in (rows[:middle], rows[middle:])]
        for half, of_half in halves:
            yield from self._pieces(half, of_half, spread=spread)

    def _passed_over(self, rows: range) -> _Piece:
        """Return what is known of a row that stops its process, which may be no more than where it stands.

        Raises ProcessFaultError where that is so of many rows.
        """
        self.lost += 1
        if self.lost > _MOST_LOST:
            raise ProcessFaultError(f"more than {_MOST_LOST} rows stopped the process that computed them")
        try:
            return _Piece.of(self._submitted(rows, spread=self.table.ran, passed_over=True).result())
        except WorkerLostError:
            summary, place, findings = blank_row(rows[0])
            return _Piece(summary, {"summary": summary.as_bytes(), "blank": place, "findings": findings})


def _name(prefix: str, rows: range) -> str:
    """Return by which name what came of a chunk is kept."""
    return f"{prefix}{rows.start}-{rows.stop}"
