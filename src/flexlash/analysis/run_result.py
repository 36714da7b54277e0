"""What the stages returned → the outcome: findings consolidated and Results built, both once and here alone."""

from __future__ import annotations

from dataclasses import replace
from itertools import chain

from flexlash.analysis.computed import Spread, Verified
from flexlash.analysis.examination import Examined
from flexlash.analysis.outcome import Outcome
from flexlash.analysis.results import empty_results, results_of
from flexlash.schema.result_columns import result_columns
from flexlash.validation.blocking_errors import stopped_by
from flexlash.validation.consolidation import consolidated, in_order

__all__ = ["outcome_of"]


def outcome_of(
    examined: Examined, spread: Spread | None = None, verified: Verified | None = None, *, with_results: bool = True
) -> Outcome:
    """Return the outcome of a submission after the stages that it went through; of a refused file, its one finding.

    Building Results takes most of the time; `with_results` says whether they are wanted.
    """
    submission, validated, nominal = examined.submission, examined.validated, examined.nominal
    if examined.refusal is not None or validated is None:
        why = () if examined.refusal is None else (examined.refusal,)
        skipped = any(found.level == "info" for found in why)
        return Outcome(submission=submission, results=empty_results(), findings=why, skipped=skipped)
    later = [stage.findings for stage in (spread, verified) if stage]
    findings = consolidated(validated, (*nominal.findings, *chain(*later)), nominal.blocked)
    computed = replace(
        nominal.computed,
        statistics=spread.statistics if spread else None,
        checks=verified.checks if verified else {},
    )
    columns = result_columns(cross_check=spread is not None and spread.cross_checked, elasticity=verified is not None)
    ordered, table = in_order(findings, submission.sheets), validated.table
    results = empty_results()
    if table and with_results:
        stops = stopped_by(table, nominal.blocked, findings) if len(computed) < table.frame.height else {}
        results = results_of(table, computed, ordered, stops, columns)
    return Outcome(
        submission=submission,
        results=results,
        findings=ordered,
        settings=examined.settings,
        options=examined.options,
        validated=validated,
        computed=computed,
        blocked=nominal.blocked,
        processor_seconds=examined.processor_seconds,
    )
