"""What goes back to the sender: the submission with its findings marked in it, or with the certain ones mended."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict

from flexlash.findings import Finding
from flexlash.outcome import Outcome
from flexlash.submission.mending.mended_table import mended_table
from flexlash.submission.mending.repair import Repair
from flexlash.submission.reading.isolated import ask
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.refusal import Refusal
from flexlash.submission.repairs import repair_of

__all__ = ["certain_repairs", "marked", "mended", "worth_marking"]


def worth_marking(outcome: Outcome) -> bool:
    """Whether there is an error or a warning to mark; what was merely repaired needs no copy."""
    return not outcome.skipped and any(found.level != "info" for found in outcome.findings)


def marked(outcome: Outcome, limits: ReadingLimits) -> tuple[bytes, tuple[str, ...] | None]:
    """Return a workbook that marks every finding in the submission, and what of the submission it could not take over.

    Where the submission cannot be marked, the workbook holds the findings alone and says why; then that is None.
    """
    from flexlash.submission.marking.marked_copy import findings_workbook, marked_table

    submission = outcome.submission
    why = f"flexlash could not read {submission.name}, so that nothing in it could be marked"
    if submission.kind in {"csv", "parquet"}:
        return marked_table(submission.sheets, outcome.findings, submission.name), ()
    if submission.kind == "workbook":
        try:
            findings = [asdict(found) for found in outcome.findings]
            head, data = ask("mark", submission.data, limits, findings=findings, name=submission.name)
        except Refusal:
            why = f"{submission.name} was read, but holds too much or too unusual things to be marked"
        else:
            return data, tuple(head["lost"])
    return findings_workbook(outcome.findings, submission.name, why), None


def certain_repairs(findings: Iterable[Finding]) -> list[Repair]:
    """Return what to write into which cell, for the findings that leave no doubt."""
    return [
        Repair(sheet=found.sheet, cell=found.cell, found=found.value, value=value, code=found.code)
        for found in findings
        if found.cell and (value := repair_of(found)) is not None
    ]


def mended(outcome: Outcome, repairs: list[Repair], limits: ReadingLimits) -> tuple[bytes, list[Repair]]:
    """Return the submission with these cells replaced, and the repairs that could be made.

    Raises Refusal when the submission cannot be written anew.
    """
    submission = outcome.submission
    if submission.kind == "csv":
        own = [repair for repair in repairs if repair.sheet in submission.sheets]
        (sheet,) = (sheet for sheet in submission.sheets.values() if sheet.manner == submission.manner)
        return mended_table(sheet, own), own
    if submission.kind != "workbook" or not repairs:
        return submission.data, []
    facts = [repair.as_dictionary() for repair in repairs]
    head, data = ask("mend", submission.data, limits, repairs=facts)
    return data, [Repair(**repair) for repair in head["made"]]
