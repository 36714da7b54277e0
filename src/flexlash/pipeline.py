"""The one natural way through: examine (read → validate → limits → nominal) → spread → results → report."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from flexlash.analysis.examination import assessed, examine, in_order, refused
from flexlash.analysis.options import Options
from flexlash.analysis.outcome import DRAWN, PICTURED, Outcome
from flexlash.analysis.recommendations import remedies_of
from flexlash.analysis.results import results_of
from flexlash.analysis.run_summary import worst_first
from flexlash.analysis.tolerance_spread import drawn_curves, scattered
from flexlash.feedback.fixing.fix import Repair
from flexlash.feedback.returned_files import certain_repairs, marked, mended, worth_marking
from flexlash.mechanics.elasticity import MISSING, is_available
from flexlash.outputs.naming import MENDED, REPORTS, WORKBOOK, named_output
from flexlash.outputs.plan import Output, Plan
from flexlash.reading.limited_process import ask
from flexlash.reading.products import mended_role
from flexlash.reading.read import ReadReport, Source, limits_of_reports, of_table
from flexlash.reading.refusal import Refusal
from flexlash.schema.argument_checks import file_path
from flexlash.schema.findings import readable

__all__ = ["Options", "Outcome", "check", "mend", "run"]

_PASSES = 3
"""Most times that a mended submission is looked at again, since one repair may uncover another fault."""


def check(submission: str | Path | Source | ReadReport, **options: Any) -> Outcome:
    """Return the outcome of validation and nominal calculation alone; nothing is sampled.

    Nothing is written but the marked copy, when `marked_copy` says where. Raises OSError when a file cannot be opened,
    ValueError for an output that cannot be meant. A file that is no submission gives an outcome whose only finding says
    why; of a marked copy that cannot be written, the outcome's `fault` does.
    """
    chosen = Options.of("check()", options)
    plan = _plan(submission, chosen)
    copy = _copy(plan, chosen)
    outcome = _examined(_source(submission, chosen), chosen)
    outcome.results = results_of(outcome)
    _mark(outcome, chosen, copy)
    return outcome


def mend(
    submission: str | Path | Source | ReadReport, output: str | Path | Output, **options: Any
) -> tuple[Outcome, list[Repair]]:
    """Write a submission with the certain repairs made; return the outcome of checking that, and the repairs.

    Nothing is written when there is no certain repair. Options and errors are those of `check`; OSError also says that
    the file cannot be written.
    """
    chosen = Options.of("mend()", options)
    plan = _plan(submission, chosen)
    new, copy = named_output(plan, output, MENDED), _copy(plan, chosen)
    source = _source(submission, chosen)
    new.require()
    original = outcome = _examined(source, chosen)
    repairs: dict[str, Repair] = {}
    for _ in range(_PASSES):
        wanted = {repair.place: repair for repair in certain_repairs(outcome.findings)}
        if not wanted.keys() - repairs.keys():
            break
        data, made = mended(original, [*(wanted | repairs).values()], chosen.limits)
        repairs |= {repair.place: repair for repair in made}
        if not made:
            break
        outcome = _examined(Source(name=original.submission.name, data=data), chosen)
    outcome.results = results_of(outcome)
    if repairs:
        _write(outcome, new, data, mended_role(original.submission.data))
    _mark(outcome, chosen, copy)
    return outcome, list(repairs.values())


def run(
    submission: str | Path | Source | ReadReport, output: str | Path | Output | None = None, **options: Any
) -> Outcome:
    """Return the outcome of a submission and write it to `output`, unless that is None.

    Options are those of the command line: seed, method, samples, cross_check, elasticity, strict, jobs,
    tolerances, materials, from_report. The output's ending decides its form: .xlsx, .csv, .parquet or .json.

    A file at the place of an output is replaced only if flexlash wrote it and nobody has changed it since; else the
    output gets ` (2)`, and the outcome's `remarks` say so.

    Raises OSError when a file cannot be opened or written, ValueError for an output that cannot be meant, such as the
    submission itself, ModuleNotFoundError for elasticity without its libraries. Of a marked copy that cannot be
    written, the outcome's `fault` says why.
    """
    chosen = Options.of("run()", options)
    plan = _plan(submission, chosen)
    report = None if output is None else named_output(plan, output, REPORTS)
    copy = _copy(plan, chosen)
    source = _source(submission, chosen)
    if report is not None:
        report.require()
    outcome = _examined(source, chosen)
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


def _plan(given: str | Path | Source | ReadReport, options: Options) -> Plan:
    """Return the plan of one submission's outputs, none of which takes the place of what is read."""
    submission = given.path if isinstance(given, Source | ReadReport) else file_path("submission", given)
    return Plan(inputs=[Path(path) for path in (submission, options.tolerances, options.materials) if path is not None])


def _copy(plan: Plan, options: Options) -> Output | None:
    """Return where the marked copy goes, when it is wanted."""
    return None if options.marked_copy is None else named_output(plan, options.marked_copy, WORKBOOK)


def _source(given: str | Path | Source | ReadReport, options: Options) -> Source | ReadReport | Refusal:
    """Return a submission's bytes, or why its name or size alone refuse it; raise OSError when it cannot be opened."""
    if isinstance(given, Source | ReadReport):
        return given
    try:
        return Source.at(Path(given), options.limits)
    except Refusal as refusal:
        return Refusal(refusal.code, **{"file": readable(Path(given).name), **refusal.facts})


def _examined(source: Source | ReadReport | Refusal, options: Options) -> Outcome:
    """Return what the limited process finds in a submission."""
    if isinstance(source, Refusal):
        return refused(str(source.facts["file"]), b"", source)
    limits = limits_of_reports(options.limits) if options.from_report else options.limits
    try:
        asked = replace(options, progress=None, marked_copy=None)
        outcome = ask(examine, limits, source, _tables(options), asked, then=assessed)
    except Refusal as refusal:
        return refused(source.name, source.data, refusal)
    outcome.submission = replace(outcome.submission, data=source.data)
    return outcome


def _tables(options: Options) -> dict[str, Source]:
    """Return the tables given beside a submission by the sheet that each replaces."""
    found = {}
    for name, path in (("Tolerances", options.tolerances), ("Materials", options.materials)):
        if path is not None:
            try:
                found[name] = Source.at(Path(path), options.limits)
            except Refusal as refusal:
                raise of_table(refusal, readable(Path(path).name)) from refusal
    return found


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


def _spread(outcome: Outcome, options: Options) -> None:
    """Put the tolerance spread into every computed row, and what would help the worst beside them."""
    if not outcome.computed:
        outcome.results = results_of(outcome)
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
    from flexlash.analysis.verification import verified

    rows = len(outcome.computed)
    progress = options.progress
    outcome.computed = verified(
        outcome.validated,
        outcome.computed,
        jobs=options.jobs,
        progress=(lambda done, total: progress(rows + done, rows + total)) if progress else None,
    )
    outcome.findings = in_order(outcome.validated.ledger.findings, outcome.submission)
    outcome.results = results_of(outcome, cross_check=bool(options.cross_check), elasticity=True)


def _picture(outcome: Outcome) -> None:
    """Solve the worst few of the checked variants once more, for their stress fields."""
    from flexlash.analysis.verification import pictured

    by_name = {one.variant.name: one for one in outcome.computed.values()}
    worst = [by_name[row["variant"]] for row in worst_first(outcome)]
    outcome.pictured = pictured([one for one in worst if "elasticity_windup" in one.nominal][:PICTURED])
