"""Inside a worker: the rows of a chunk → their part of Results and of the findings, and what is counted of them."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import polars as pl

from flexlash.analysis.computed import Nominal
from flexlash.analysis.drive_notes import DriveNotes
from flexlash.analysis.examination import Examined, examined
from flexlash.analysis.options import Options
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_result import outcome_of
from flexlash.analysis.run_summary import SpreadNotes, by_rule, to_fix
from flexlash.analysis.used_tolerances import used_tolerances
from flexlash.analysis.whole_batch import DRAWN, verdicts_of, worst_rows
from flexlash.batch.chunk import (
    FIRST_CELLS,
    FIRST_FINDINGS,
    ChunkAnswer,
    ChunkSummary,
    ChunkTask,
    ExportAnswer,
    ExportTask,
    FindingsTask,
    PageTask,
    ReportTask,
    WorstRow,
)
from flexlash.feedback.annotation.marked_copy import findings_workbook
from flexlash.pipeline import computed
from flexlash.report.exports import export_notes, exported_files
from flexlash.report.findings_table import findings_rows
from flexlash.report.page.grids import Sheets
from flexlash.report.page.page_facts import Found, page_bytes
from flexlash.report.report_data import report_data
from flexlash.report.results_pieces import piece
from flexlash.report.results_table import results_table
from flexlash.report.workbook import report_bytes
from flexlash.schema.findings import Finding, finding
from flexlash.schema.result_columns import result_columns
from flexlash.validation.blocking_errors import waiting_rows, without_waiting
from flexlash.validation.validated import Table

__all__ = ["answered", "exports_of_worst", "findings_listed", "page_made", "report_of_worst"]

_NAMED = 3
"""Worst variants that are told by name."""

_TOLD = (
    "variant", "backlash_arcmin", "p97_5_arcmin", "p97_5_standard_error_arcmin", "p99_865_arcmin",
    "backlash_limit_arcmin", "probability_over_limit", "probability_over_limit_low", "probability_over_limit_high",
    "between_lots_sd_arcmin", "lots_failing", "lots_failing_standard_error", "probability_over_limit_sample_low",
    "probability_over_limit_sample_high",
)  # fmt: skip
"""What is told of a variant that is among the worst."""


def answered(task: ChunkTask) -> ChunkAnswer:
    """Return what came of a chunk."""
    outcome = _outcome(task)
    validated = outcome.validated
    table = validated.table if validated else None
    if validated is None or outcome.submission.kind == "refused":
        refused = ChunkSummary(refusal=outcome.findings[0], skipped=outcome.skipped)
        return ChunkAnswer(summary=refused.as_bytes())
    before, own, after = _by_place(outcome, table)
    summary = ChunkSummary(
        rows=len(validated.submitted),
        computed=len(outcome.computed),
        seed=outcome.settings.seed,
        method=outcome.settings.method,
        target_percent=outcome.settings.target_percent,
        angle_unit=outcome.settings.angle_unit,
        rules=dict(Counter(found.code for found in own)),
        groups=tuple(replace(one, addresses=one.addresses[:FIRST_CELLS]) for one in by_rule(own)),
        before=before,
        own=own[:FIRST_FINDINGS],
        after=after,
        to_fix=to_fix(own)[0],
        sheet=table.sheet if table else "",
        waiting=tuple(waiting_rows(table, outcome.blocked)) if table else (),
        all_wait=table is not None and outcome.blocked.everything and table.has_entries,
    )
    results = tolerances = b""
    if task.spread:
        summary = _with_spread(summary, outcome, table)
    if task.ending and table:
        rows = _of_all_columns(results_table(outcome), task.options)
        results, summary = piece(rows, task.ending), replace(summary, columns=tuple(rows.columns))
        tolerances = piece(used_tolerances(outcome.computed.values()), ".json") if task.ending == ".json" else b""
    return ChunkAnswer(summary=summary.as_bytes(), results=results, tolerances=tolerances, findings=findings_rows(own))


def _outcome(task: ChunkTask) -> Outcome:
    """Return what came of the rows of a chunk."""
    if task.passed_over:
        return outcome_of(_passed_over(examined(task.source, task.options, task.tables, numbers=False)))
    if task.spread:
        return computed(task.source, task.options, task.tables)
    return outcome_of(examined(task.source, task.options, task.tables))


def _passed_over(found: Examined) -> Examined:
    """Return rows that were read, with the finding that says why nothing of them is computed."""
    table = found.validated.table if found.validated else None
    if table is None:
        return found
    findings = tuple(
        finding("E334", sheet=table.sheet, cell=table.address(row, "variant"), column="variant")
        for row in table.frame["row"]
    )
    return replace(found, nominal=Nominal(findings=findings))


def _by_place(outcome: Outcome, table: Table | None) -> tuple[tuple[Finding, ...], ...]:
    """Return the findings of the file that come before those at the rows of a chunk, these, and those that follow."""
    if table is None:
        return outcome.findings, (), ()
    sheets = [*outcome.submission.sheets]
    later = {*sheets[sheets.index(table.sheet) + 1 :]}
    places: dict[int, list[Finding]] = {-1: [], 0: [], 1: []}
    for found in without_waiting(outcome.findings, table.sheet, waiting_rows(table, outcome.blocked)):
        is_own = found.sheet == table.sheet and found.row > table.last_head_row
        places[0 if is_own else 1 if found.sheet in later else -1].append(found)
    return tuple(places[-1]), tuple(places[0]), tuple(places[1])


def _of_all_columns(rows: pl.DataFrame, options: Options) -> pl.DataFrame:
    """Return Results with all columns of the run, of which rows without a spread lack some."""
    columns = result_columns(cross_check=bool(options.cross_check), elasticity=bool(options.elasticity))
    types = {column.key: pl.Float64 if column.is_number else pl.String for column in columns}
    lacking = [pl.lit(None, dtype=kind).alias(key) for key, kind in types.items() if key not in rows.columns]
    own = [name for name in rows.columns if name not in types]
    return rows.with_columns(lacking).select(*types, *own)


def _with_spread(summary: ChunkSummary, outcome: Outcome, table: Table | None) -> ChunkSummary:
    """Return a summary with what the spread says."""
    verdicts, unsettled = verdicts_of(outcome.results, outcome.settings.verdict_bounds)
    return replace(
        summary,
        verdicts=verdicts,
        unsettled=unsettled,
        worst=_worst(outcome.results, table) if table else (),
        drives=DriveNotes.of(outcome.results, outcome.settings.target_percent),
        notes=SpreadNotes.of(outcome.results),
        cross_checked="cross_check" in outcome.results.columns,
    )


def _worst(results: pl.DataFrame, table: Table) -> tuple[WorstRow, ...]:
    """Return the worst rows of a chunk, worst first, the first few with what is told of them."""
    rows = worst_rows(results.with_columns(table.frame["row"].alias("row")), DRAWN)
    found = []
    for place, row in enumerate(rows.select("row", *_TOLD).iter_rows(named=True)):
        limit = row["backlash_limit_arcmin"]
        found.append(
            WorstRow(
                share=-1.0 if limit is None else row["probability_over_limit"],
                reach=row["p99_865_arcmin"] / (limit or 1.0),
                row=row["row"],
                told={key: row[key] for key in _TOLD} if place < _NAMED else None,
            )
        )
    return tuple(found)


def report_of_worst(task: ReportTask) -> bytes:
    """Return the report of the worst rows, which says that it stands for the whole table."""
    return report_bytes(replace(computed(task.source, task.options, task.tables), whole=task.whole))


def exports_of_worst(task: ExportTask) -> ExportAnswer:
    """Return samples and pictures of the worst rows, which say of how many they are."""
    outcome = replace(computed(task.source, task.options, task.tables), whole=task.whole)
    samples, pictures = task.samples, task.pictures
    return ExportAnswer(
        files=exported_files(outcome, samples=samples, pictures=pictures),
        notes=tuple(export_notes(outcome, samples=samples, pictures=pictures)),
    )


def page_made(task: PageTask) -> bytes:
    """Return what a page shows of a large table, of which the worst rows are computed once more."""
    cells = examined(task.cells, task.options, task.tables, numbers=False)
    headers = cells.validated.header_rows if cells.validated else {}
    told = Found(
        findings=task.findings,
        sheets=Sheets(submission=cells.submission, header_rows=headers),
        cells_to_fix=task.cells_to_fix,
        fixable=0,
        state=task.state,
        groups=task.groups,
    )
    outcome = outcome_of(cells) if task.worst is None else computed(task.worst, task.options, task.tables)
    data = report_data(outcome) if task.worst is not None else None
    return page_bytes(replace(outcome, whole=task.whole), told, ran=data is not None, data=data)


def findings_listed(task: FindingsTask) -> bytes:
    """Return the first findings as a workbook, which says how many there are and where the others are."""
    more = f"; all of them are in {task.findings_file}" if task.findings_file else ""
    why = f"The first {len(task.findings):,} findings of {task.name} are listed here{more}"
    return findings_workbook(task.findings, task.name, why, number=task.counted, macros=task.macros)
