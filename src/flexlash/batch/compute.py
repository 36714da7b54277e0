"""The one function that a worker carries out: a submission's bytes and options → report, marked copy, outcome."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from flexlash.analysis.examination import examined
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_result import outcome_of
from flexlash.analysis.run_summary import detail_lines, finding_lines, state_words, worst_first
from flexlash.batch.answer import Answer, FileBytes, Task, WorstVariant
from flexlash.feedback.fixing.fix import Fix
from flexlash.feedback.returned_files import fixed, marked, worth_marking
from flexlash.pipeline import computed
from flexlash.reading.inside_limits import Fault
from flexlash.reading.libraries import ChangedLibrary
from flexlash.schema.exit_codes import ExitCode

if TYPE_CHECKING:
    from flexlash.report.report_data import ReportData

__all__ = ["answer_of", "compute", "copy_of", "data_of", "file_of", "report_of"]

_WORST = 3
"""Most variants that an answer names."""


def compute(task: bytes) -> bytes:
    """Return the answer to a task, both as bytes; the same bytes for the same bytes, whoever asks, and nothing written.

    A fault of the program is an answer as well.
    """
    try:
        return _answered(Task.of(task)).as_bytes()
    except ChangedLibrary as changed:
        fault = Fault(kind=str(changed), trace=Fault.of(changed).trace)
    except BaseException as failed:  # noqa: BLE001
        # A panic of polars is no Exception.
        fault = Fault.of(failed)
    return Answer(exit_code=ExitCode.INTERNAL, fault=fault).as_bytes()


def _answered(task: Task) -> Answer:
    if task.command == "fix":
        found = fixed(task.source, task.options, task.tables)
        file = FileBytes(data=found.data, role=found.role) if found.fixes else None
        return answer_of(found.outcome, ran=False, file=file, copy=copy_of(found.outcome, task), fixes=found.fixes)
    if task.pages:
        from flexlash.batch.page_answer import answer_with_page

        return answer_with_page(task)
    if task.command == "check":
        outcome = outcome_of(examined(task.source, task.options, task.tables))
        return answer_of(outcome, ran=False, copy=copy_of(outcome, task))
    outcome = computed(task.source, task.options, task.tables)
    data = data_of(outcome, task)
    answer = answer_of(outcome, ran=True, file=report_of(outcome, task, data), copy=copy_of(outcome, task), data=data)
    if not (task.samples or task.pictures):
        return answer
    from flexlash.report.exports import export_notes, exported_files

    files = exported_files(outcome, samples=task.samples, pictures=task.pictures, data=data)
    notes = export_notes(outcome, samples=task.samples, pictures=task.pictures)
    return replace(answer, details=(*answer.details, *notes), exports=files)


def answer_of(
    outcome: Outcome,
    *,
    ran: bool,
    file: FileBytes | None = None,
    copy: FileBytes | None = None,
    fixes: tuple[Fix, ...] | None = None,
    data: ReportData | None = None,
) -> Answer:
    """Return an outcome as an answer, with the files that are to be written; `ran` says that it was computed.

    `data` is what a report draws, where there is one: then its cheapest changes are told as well.
    """
    told = outcome.as_dictionary()
    del told["outputs"]
    return Answer(
        exit_code=outcome.exit_code,
        told=told,
        finding_lines=tuple(finding_lines(outcome.findings)),
        words=state_words(outcome, ran=ran),
        details=(*detail_lines(outcome, ran=ran), *_changes(outcome, data)),
        by_rule=Counter(found.code for found in outcome.findings),
        worst=tuple(map(WorstVariant.of, worst_first(outcome, _WORST))) if ran else (),
        file=file,
        copy=copy,
        fixes=fixes,
        refused=outcome.submission.kind == "refused",
        skipped=outcome.skipped,
    )


def _changes(outcome: Outcome, data: ReportData | None) -> Iterator[str]:
    """Yield the cheapest changes that a report tells."""
    if data is not None:
        from flexlash.report.wording.lever_sentences import cheapest_lines
        from flexlash.report.wording.lever_words import hats_of

        yield from cheapest_lines(data.levers, hats_of(outcome))


def data_of(outcome: Outcome, task: Task) -> ReportData | None:
    """Return what the report draws, if one is wanted."""
    if task.report != ".xlsx" or not outcome.computed:
        return None
    from flexlash.report.report_data import report_data

    return report_data(outcome)


def report_of(outcome: Outcome, task: Task, data: ReportData | None = None) -> FileBytes | None:
    """Return the report in the form that is wanted, if a row was computed."""
    return file_of(outcome, task.report, data) if task.report and outcome.computed else None


def file_of(outcome: Outcome, ending: str, data: ReportData | None = None) -> FileBytes:
    """Return an outcome in the form that an ending names; `data` is what a report draws."""
    from flexlash.report.output import outcome_bytes

    content, role = outcome_bytes(outcome, ending, data)
    return FileBytes(data=content, role=role)


def copy_of(outcome: Outcome, task: Task) -> FileBytes | None:
    """Return the marked copy, when there is something to mark."""
    if not task.copy or not worth_marking(outcome):
        return None
    data, not_carried = marked(outcome, task.options.limits, macros=task.copy == ".xlsm")
    return FileBytes(data=data, role="checked", not_carried=not_carried)
