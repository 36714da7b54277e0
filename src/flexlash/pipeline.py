"""The one natural way through: read → validate → limits → nominal → spread → results → report."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from flexlash.assessment import assess
from flexlash.elasticity import MISSING, is_available
from flexlash.findings import Finding, finding, readable
from flexlash.handback import certain_repairs, marked, mended, worth_marking
from flexlash.options import Options
from flexlash.outcome import DRAWN, PICTURED, Outcome
from flexlash.outputs.naming import MENDED, REPORTS, WORKBOOK, named_output
from flexlash.outputs.plan import Output, Plan
from flexlash.remedies import remedies_of
from flexlash.results import results_frame, results_of
from flexlash.scatter import drawn_curves, scattered
from flexlash.submission.mending.repair import Repair
from flexlash.submission.products import mended_role, require_submission
from flexlash.submission.reading.gate import kind_of, read_bytes
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.raw import column_number
from flexlash.submission.reading.read import RawSheet, Reading, ReportReading, Submission, read_table
from flexlash.submission.reading.refusal import Refusal
from flexlash.submission.validate import Validated, validate
from flexlash.summary import worst_first
from flexlash.variant import Settings

__all__ = ["Options", "Outcome", "check", "mend", "run"]

_PASSES = 3
"""Most times that a mended submission is looked at again, since one repair may uncover another fault."""


def check(submission: str | Path | Reading, **options: Any) -> Outcome:
    """Return the outcome of validation and nominal calculation alone; nothing is sampled.

    Nothing is written but the marked copy, when `marked_copy` says where. Raises OSError when a file cannot be opened,
    ValueError for an output that cannot be meant. A file that is no submission gives an outcome whose only finding says
    why; of a marked copy that cannot be written, the outcome's `fault` does.
    """
    chosen = Options(**options)
    plan = _plan(submission, chosen)
    copy = _copy(plan, chosen)
    outcome = _examine(_reading(submission, chosen), chosen)
    _mark(outcome, chosen, copy)
    return outcome


def mend(submission: str | Path | Reading, output: str | Path | Output, **options: Any) -> tuple[Outcome, list[Repair]]:
    """Write a submission with the certain repairs made; return the outcome of checking that, and the repairs.

    Nothing is written when there is no certain repair. Options and errors are those of `check`; OSError also says that
    the file cannot be written.
    """
    chosen = Options(**options)
    plan = _plan(submission, chosen)
    new, copy = named_output(plan, output, MENDED), _copy(plan, chosen)
    reading = _reading(submission, chosen)
    new.require()
    original = outcome = _examine(reading, chosen)
    repairs: dict[str, Repair] = {}
    for _ in range(_PASSES):
        wanted = {repair.place: repair for repair in certain_repairs(outcome.findings)}
        if not wanted.keys() - repairs.keys():
            break
        data, made = mended(original, [*(wanted | repairs).values()], chosen.limits)
        repairs |= {repair.place: repair for repair in made}
        if not made:
            break
        outcome = _examine(Reading(reading.path, chosen.limits, data), chosen)
    if repairs:
        _write(outcome, new, data, mended_role(original.submission.data))
    _mark(outcome, chosen, copy)
    return outcome, list(repairs.values())


def run(submission: str | Path | Reading, output: str | Path | Output | None = None, **options: Any) -> Outcome:
    """Return the outcome of a submission and write it to `output`, unless that is None.

    Options are those of the command line: seed, method, samples, cross_check, elasticity, strict, jobs,
    tolerances, materials, from_report. The output's ending decides its form: .xlsx, .csv, .parquet or .json.

    A file at the place of an output is replaced only if flexlash wrote it and nobody has changed it since; else the
    output gets ` (2)`, and the outcome's `remarks` say so.

    Raises OSError when a file cannot be opened or written, ValueError for an output that cannot be meant, such as the
    submission itself, ModuleNotFoundError for elasticity without its libraries. Of a marked copy that cannot be
    written, the outcome's `fault` says why.
    """
    chosen = Options(**options)
    plan = _plan(submission, chosen)
    report = None if output is None else named_output(plan, output, REPORTS)
    copy = _copy(plan, chosen)
    reading = _reading(submission, chosen)
    if report is not None:
        report.require()
    outcome = _examine(reading, chosen)
    chosen = chosen.completed(outcome.submission.run_with)
    if chosen.elasticity and not is_available():
        raise ModuleNotFoundError(MISSING)
    _spread(outcome, chosen)
    if chosen.elasticity:
        _verify(outcome, chosen)
    if report is not None and report.ending == ".xlsx":
        _draw(outcome, chosen)
        if chosen.elasticity:
            _picture(outcome)
    if report is not None and outcome.computed:
        from flexlash.report.output import outcome_bytes

        _write(outcome, report, *outcome_bytes(outcome, report.ending))
    _mark(outcome, chosen, copy)
    return outcome


def _plan(given: str | Path | Reading, options: Options) -> Plan:
    """Return the plan of one submission's outputs, none of which takes the place of what is read."""
    submission = given.path if isinstance(given, Reading) else given
    return Plan(inputs=[Path(path) for path in (submission, options.tolerances, options.materials) if path is not None])


def _copy(plan: Plan, options: Options) -> Output | None:
    """Return where the marked copy goes, when it is wanted."""
    return None if options.marked_copy is None else named_output(plan, options.marked_copy, WORKBOOK)


def _reading(given: str | Path | Reading, options: Options) -> Reading:
    """Return a submission being read."""
    if isinstance(given, Reading):
        return given
    return (ReportReading if options.from_report else Reading)(Path(given), options.limits)


def _examine(reading: Reading, options: Options) -> Outcome:
    """Read, validate and compute at the entered dimensions."""
    try:
        submission = reading.submission()
        options = options.completed(submission.run_with)
        require_submission(submission, reading.path, options.given, marked_copies=options.marked_copies)
        return _validated(_with_tables(submission, options), options)
    except Refusal as refusal:
        facts: dict[str, Any] = {"file": reading.name, **refusal.facts}
        digest = hashlib.sha256(reading.data).hexdigest() if reading.data else ""
        found = finding(refusal.code, **facts)
        refused = Submission(name=reading.name, sha256=digest, kind="refused")
        return Outcome(
            submission=refused,
            results=results_frame([]),
            findings=[found],
            settings=Settings(),
            skipped=found.level == "info",
        )


def _mark(outcome: Outcome, options: Options, copy: Output | None) -> None:
    """Write the marked copy, when it is wanted and there is something to mark; a failure loses nothing else."""
    if copy is None or not worth_marking(outcome):
        return
    try:
        copy.require()
        data, outcome.not_carried = marked(outcome, options.limits)
        outcome.marked_copy = _write(outcome, copy, data, "checked")
    except OSError as fault:
        outcome.fault = fault


def _write(outcome: Outcome, output: Output, data: bytes, role: str) -> Path:
    """Write an output and note it, and what was left alone in its place."""
    written = output.write(data, role)
    outcome.outputs.append(written.path)
    outcome.remarks += [written.remark] if written.remark else []
    return written.path


def _with_tables(submission: Submission, options: Options) -> Submission:
    """Put the tables given beside a submission in the place of its own."""
    given: dict[str, RawSheet] = {}
    for name, path in (("Tolerances", options.tolerances), ("Materials", options.materials)):
        if path is not None:
            given[name] = _table_beside(Path(path), name, options.limits)
    return replace(submission, sheets=submission.sheets | given)


def _table_beside(path: Path, name: str, limits: ReadingLimits) -> RawSheet:
    """Return a CSV table given beside a submission; raise Refusal, by its own name, when it is none."""
    try:
        data = read_bytes(path, limits)
        kind_of(data, only="csv")
        return read_table(data, name, readable(path.name), limits)
    except Refusal as refusal:
        if refusal.code.startswith("I"):
            raise Refusal("E101", file=readable(path.name), found="a csv file is required here") from refusal
        raise Refusal(refusal.code, **{"file": path.name, **refusal.facts}) from refusal


def _validated(submission: Submission, options: Options) -> Outcome:
    """Validate, set the limits and compute at the entered dimensions."""
    validated = validate(submission, options.limits)
    overrides = {
        name: getattr(options, name) for name in ("seed", "method", "samples") if getattr(options, name) is not None
    }
    settings = replace(validated.settings, **overrides)
    computed = assess(validated, settings)
    findings = _in_order(validated, submission)
    if options.strict and len(computed) < len(validated.submitted):
        computed = {}
    outcome = Outcome(
        submission=submission,
        results=results_frame([]),
        findings=findings,
        settings=settings,
        options=options,
        validated=validated,
        computed=computed,
    )
    outcome.results = results_of(outcome)
    return outcome


def _place_order(submission: Submission) -> Callable[[Finding], tuple[int, int, int, str]]:
    """Return the sort key of findings: sheet, row, column, code."""
    sheets = {name: place for place, name in enumerate(submission.sheets)}

    def key(found: Finding) -> tuple[int, int, int, str]:
        letters = found.cell.rstrip("0123456789")
        row = int(found.cell[len(letters) :] or 0)
        return sheets.get(found.sheet, -1), row, column_number(letters), found.code

    return key


def _spread(outcome: Outcome, options: Options) -> None:
    """Put the tolerance spread into every computed row, and what would help the worst beside them."""
    if not outcome.computed:
        return
    progress, steps = options.progress, 2 if options.elasticity else 1
    outcome.computed = scattered(
        outcome.computed,
        outcome.settings,
        options,
        (lambda done, rows: progress(done, rows * steps)) if progress else None,
    )
    outcome.results = results_of(outcome, cross_check=bool(options.cross_check))
    outcome.remedies = remedies_of(outcome.computed, outcome.settings)


def _draw(outcome: Outcome, options: Options) -> None:
    """Put the whole distribution beside the variants that the report draws, worst first."""
    by_name = {one.variant.name: one for one in outcome.computed.values()}
    drawn = [by_name[row["variant"]] for row in worst_first(outcome)[:DRAWN]]
    outcome.curves = drawn_curves(drawn, outcome.settings, options)


def _verify(outcome: Outcome, options: Options) -> None:
    """Put the elasticity check into every computed row."""
    if outcome.validated is None or not outcome.computed:
        return
    from flexlash.verification import verified

    rows = len(outcome.computed)
    progress = options.progress
    outcome.computed = verified(
        outcome.validated,
        outcome.computed,
        jobs=options.jobs,
        progress=(lambda done, total: progress(rows + done, rows + total)) if progress else None,
    )
    outcome.findings = _in_order(outcome.validated, outcome.submission)
    outcome.results = results_of(outcome, cross_check=bool(options.cross_check), elasticity=True)


def _picture(outcome: Outcome) -> None:
    """Solve the worst few of the checked variants once more, for their stress fields."""
    from flexlash.verification import pictured

    by_name = {one.variant.name: one for one in outcome.computed.values()}
    worst = [by_name[row["variant"]] for row in worst_first(outcome)]
    outcome.pictured = pictured([one for one in worst if "elasticity_windup" in one.nominal][:PICTURED])


def _in_order(validated: Validated, submission: Submission) -> list[Finding]:
    """Return the findings in the order of the submission."""
    return sorted(validated.ledger.findings, key=_place_order(submission))
