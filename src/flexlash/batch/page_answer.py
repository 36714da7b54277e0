"""Inside a worker: a submission → its answer with all that a page shows and offers, told of while it is made."""

from __future__ import annotations

from dataclasses import replace

from flexlash.analysis.examination import examined
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_result import outcome_of
from flexlash.batch.answer import Answer, FileBytes, RuleTotal, Task
from flexlash.batch.compute import answer_of, copy_of, file_of, report_of
from flexlash.batch.telling import Telling
from flexlash.feedback.returned_files import Fixed, certain_fixes, fixed_from
from flexlash.pipeline import spread_out
from flexlash.report.page.page_facts import Found, page_bytes
from flexlash.report.report_data import report_data

__all__ = ["answer_with_page"]


def answer_with_page(task: Task) -> Answer:
    """Return what came of a submission that is checked or computed; told are its findings at once, then its rows."""
    ran, telling = task.command == "run", Telling()
    found = examined(task.source, task.options, task.tables)
    computes = ran and bool(found.nominal.computed)
    checked = outcome_of(found, with_results=not computes)
    if found.refusal is None:
        rows = len(found.nominal.computed) if ran else 0
        telling.checked(page_bytes(checked, Found.of(checked, ran=False), ran=False), checked.counts, rows)
    outcome = checked
    if computes:
        outcome = spread_out(found, replace(task.options, progress=telling.advance))
    telling.writing()
    data = report_data(outcome) if ran and outcome.computed else None
    fixed = _fixed(checked, task)
    fixes = fixed.fixes if fixed else ()
    answer = answer_of(outcome, ran=ran, file=report_of(outcome, task, data), copy=copy_of(outcome, task), data=data)
    return replace(
        answer,
        results=file_of(outcome, ".csv") if data else None,
        fixed=FileBytes(data=fixed.data, role=fixed.role) if fixed else None,
        page=page_bytes(outcome, Found.of(outcome, ran=ran, fixes=fixes), ran=ran, data=data),
        rules=RuleTotal.all_of(outcome.findings),
    )


def _fixed(checked: Outcome, task: Task) -> Fixed | None:
    """Return the submission with the certain fixes, None where there are none."""
    if not certain_fixes(checked.findings):
        return None
    found = fixed_from(checked, task.options, task.tables, numbers=False)
    return found if found.fixes else None
