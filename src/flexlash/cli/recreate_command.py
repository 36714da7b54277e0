"""`flexlash run --from-report`: the submission that a report carries, and the report made anew."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from flexlash.analysis.options import TABLES
from flexlash.analysis.outcome import Outcome
from flexlash.cli.recreation import recreate
from flexlash.cli.submissions import Submissions
from flexlash.cli.terminal import progress
from flexlash.comparison.difference_lines import comparison_line
from flexlash.outputs.plan import Plan
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.findings import shown

__all__ = ["recreate_all"]


def recreate_all(
    reports: Sequence[Path], output: Path | None, *, as_json: bool, quiet: bool, **options: Any
) -> ExitCode:
    """Write the submission and the report of each report anew and say whether they are the same; return the code."""
    all_of_them = Submissions(several=len(reports) > 1, as_json=as_json, quiet=quiet, ran=True, verbose=True)
    beside = [Path(options[name]) for name in TABLES if options.get(name)]
    plan = Plan(inputs=[*reports, *beside])
    for report in reports:
        with all_of_them.one(report) as attempt, progress(quiet=quiet or as_json) as advance:
            found = recreate(report, output, plan, progress=advance, **options)
            attempt.outcome = found.outcome
            attempt.further = {"compared": {"numbers": found.numbers, "different": found.different}}
            if found.numbers:
                attempt.remarks = [f"  {shown(remark, longest=400)}" for remark in found.remarks]
                attempt.closing = [
                    *_exported(found.outcome, options),
                    comparison_line(found.different, found.numbers, shown(report.name)),
                ]
    return all_of_them.end()


def _exported(outcome: Outcome, options: Mapping[str, Any]) -> Iterator[str]:
    """Yield what samples and pictures of an outcome hold, where they are wanted."""
    samples, pictures = bool(options.get("samples_out")), bool(options.get("pictures"))
    if samples or pictures:
        from flexlash.report.exports import export_notes

        yield from export_notes(outcome, samples=samples, pictures=pictures)
