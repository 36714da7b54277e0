"""From bytes to findings: read, validate, set the limits, compute at the entered dimensions.

All of this is done in the limited process, since nothing of it is the program's own before it was judged. What follows
validation, `assessed`, grows with the number of sound rows alone and has no limits.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Mapping
from dataclasses import replace

from flexlash.analysis.assessment import assess
from flexlash.analysis.options import Options
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.results import results_frame
from flexlash.reading.products import require_submission
from flexlash.reading.raw import Submission
from flexlash.reading.read import ReadReport, Source, report_of, submission_of, table_of
from flexlash.reading.refusal import Refusal
from flexlash.schema.findings import Finding, finding
from flexlash.schema.variant import Settings
from flexlash.validation.validate import validate

__all__ = ["assessed", "examine", "in_order", "refused"]


def examine(given: Source | ReadReport, tables: Mapping[str, Source], options: Options) -> Outcome:
    """Return what a submission holds and what is wrong with it; nothing is computed yet.

    `tables` stand beside it, by the sheet that each replaces. Raises Refusal when the file is no readable submission.
    """
    start = time.process_time()
    submission = _submission(given, options)
    options = options.completed(submission.run_with)
    if isinstance(given, Source) and given.path:
        require_submission(submission, given.path, options.given, marked_copies=options.marked_copies)
    beside = {name: table_of(table, name, options.limits) for name, table in tables.items()}
    submission = replace(submission, sheets=submission.sheets | beside)
    validated = validate(submission, options.limits)
    overrides = {
        name: getattr(options, name) for name in ("seed", "method", "samples") if getattr(options, name) is not None
    }
    return Outcome(
        submission=submission,
        results=results_frame([]),
        findings=[],
        settings=replace(validated.settings, **overrides),
        options=options,
        validated=validated,
        processor_seconds=time.process_time() - start,
    )


def assessed(outcome: Outcome) -> Outcome:
    """Return an examined submission with nominal numbers and limits of its sound rows, and all its findings."""
    if outcome.validated is None:
        raise LookupError("a submission that was not validated")
    outcome.computed = assess(outcome.validated, outcome.settings)
    if outcome.options.strict and len(outcome.computed) < len(outcome.validated.submitted):
        outcome.computed = {}
    outcome.findings = in_order(outcome.validated.ledger.findings, outcome.submission)
    return outcome


def _submission(given: Source | ReadReport, options: Options) -> Submission:
    """Return the submission that a file is, or that a report carries."""
    if isinstance(given, ReadReport):
        return given.submission
    return report_of(given, options.limits).submission if options.from_report else submission_of(given, options.limits)


def refused(name: str, data: bytes, refusal: Refusal) -> Outcome:
    """Return the outcome of a file that is no readable submission, or that is skipped: one finding that says why."""
    digest = hashlib.sha256(data).hexdigest() if data else ""
    found = finding(refusal.code, **{"file": name, **refusal.facts})
    return Outcome(
        submission=Submission(name=name, sha256=digest, kind="refused"),
        results=results_frame([]),
        findings=[found],
        settings=Settings(),
        skipped=found.level == "info",
    )


def in_order(findings: list[Finding], submission: Submission) -> list[Finding]:
    """Return the findings in the order of the submission."""
    return sorted(findings, key=_place_order(submission))


def _place_order(submission: Submission) -> Callable[[Finding], tuple[int, int, int, str]]:
    """Return the sort key of findings: sheet, row, column, code."""
    sheets = {name: place for place, name in enumerate(submission.sheets)}

    def key(found: Finding) -> tuple[int, int, int, str]:
        row, column = found.address or (0, 0)
        return sheets.get(found.sheet, -1), row, column, found.code

    return key
