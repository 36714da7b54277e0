"""What goes back to the sender: the submission with its findings marked in it, or with the certain ones fixed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial

from flexlash.analysis.examination import examined
from flexlash.analysis.options import Options
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.run_result import outcome_of
from flexlash.feedback.fixing.certain_fixes import certain_value_of
from flexlash.feedback.fixing.fix import Fix
from flexlash.feedback.fixing.fixed_table import fixed_table
from flexlash.feedback.fixing.fixed_workbook import fixed_workbook
from flexlash.reading.limited_process import ProcessFaultError, ask
from flexlash.reading.products import fixed_role
from flexlash.reading.raw import Submission
from flexlash.reading.read import ReadReport, Source
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.findings import Finding

__all__ = ["Fixed", "certain_fixes", "fixed", "fixed_from", "marked", "worth_marking"]

_PASSES = 3
"""Most times that a fixed submission is looked at again, since one fix may uncover another fault."""


@dataclass(frozen=True, kw_only=True)
class Fixed:
    """A submission with the certain fixes made, what came out of checking that, and the fixes.

    `role` is what a workbook says of itself: that it is fixed, and of which submission.
    """

    data: bytes
    role: str
    outcome: Outcome
    fixes: tuple[Fix, ...]


def fixed(source: Source | ReadReport | Refusal, options: Options, tables: Mapping[str, Source] | None = None) -> Fixed:
    """Return a submission with the certain fixes made, until there are no more of them; `tables` stand beside it."""
    return fixed_from(outcome_of(examined(source, options, tables)), options, tables)


def fixed_from(
    outcome: Outcome, options: Options, tables: Mapping[str, Source] | None = None, *, numbers: bool = True
) -> Fixed:
    """Return the same of a submission by what came of checking it.

    `numbers` says whether the outcome of the fixed one has nominal numbers and Results. Bytes and fixes do not depend
    on that: validation alone knows what is certain.
    """
    original = outcome.submission
    data, fixes = original.data, dict[str, Fix]()
    for _ in range(_PASSES):
        wanted = {fix.place: fix for fix in certain_fixes(outcome.findings)}
        if not wanted.keys() - fixes.keys():
            break
        data, made = _with_fixes(original, [*(wanted | fixes).values()], options.limits)
        fixes |= {fix.place: fix for fix in made}
        if not made:
            break
        found = examined(Source(name=original.name, data=data), options, tables, numbers=numbers)
        outcome = outcome_of(found, with_results=numbers)
    return Fixed(data=data, role=fixed_role(original.data), outcome=outcome, fixes=tuple(fixes.values()))


def worth_marking(outcome: Outcome) -> bool:
    """Whether there is an error or a warning to mark; what was merely repaired needs no copy."""
    return not outcome.skipped and any(found.level != "info" for found in outcome.findings)


def marked(outcome: Outcome, limits: ReadingLimits, *, macros: bool = False) -> tuple[bytes, tuple[str, ...] | None]:
    """Return a workbook that marks every finding in the submission, and what of the submission it could not take over.

    Where the submission cannot be marked, the workbook holds the findings alone and says why; then that is None.
    `macros` says that the copy is to be a file of the kind that may hold macros.
    """
    from flexlash.feedback.annotation.marked_copy import findings_workbook, marked_copy, marked_table

    submission, findings = outcome.submission, outcome.findings
    within = _rest(limits, outcome.processor_seconds)
    why = f"flexlash could not read {submission.name}, so that nothing in it could be marked"
    try:
        if submission.kind == "workbook":
            copy = ask(partial(marked_copy, macros=macros), within, submission.data, findings, submission.name, limits)
            return copy.data, copy.lost
        if submission.kind in {"csv", "parquet"}:
            return ask(partial(marked_table, macros=macros), within, submission.sheets, findings, submission.name), ()
    except (Refusal, ProcessFaultError):
        why = f"{submission.name} was read, but holds too much or too unusual things to be marked"
    return findings_workbook(findings, submission.name, why, macros=macros), None


def _rest(limits: ReadingLimits, used: float) -> ReadingLimits:
    """Return the limits of marking: what reading has left of its processor time, and a quarter of that time more."""
    seconds = limits.processor_seconds
    return replace(limits, processor_seconds=max(math.ceil(seconds / 5), math.floor(seconds * 5 / 4 - used)))


def certain_fixes(findings: Iterable[Finding]) -> list[Fix]:
    """Return what to write into which cell, for the findings that leave no doubt."""
    return [
        Fix(sheet=found.sheet, cell=found.cell, found=found.value, value=value, code=found.code)
        for found in findings
        if found.cell and (value := certain_value_of(found)) is not None
    ]


def _with_fixes(submission: Submission, fixes: list[Fix], limits: ReadingLimits) -> tuple[bytes, list[Fix]]:
    """Return the submission with these cells replaced, and the fixes that could be made.

    Raises Refusal when the submission cannot be written anew.
    """
    if not fixes or submission.kind not in {"csv", "workbook"}:
        return submission.data, []
    if submission.kind == "workbook":
        return ask(fixed_workbook, limits, submission.data, fixes, limits)
    own = [fix for fix in fixes if fix.sheet in submission.sheets]
    (sheet,) = (sheet for sheet in submission.sheets.values() if sheet.dialect == submission.dialect)
    return ask(fixed_table, limits, sheet, own), own
