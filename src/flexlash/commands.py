"""What `run --from-report` and `diff` do, behind the command line."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from flexlash.comparison.difference import difference
from flexlash.comparison.difference_lines import comparison_line, difference_lines
from flexlash.comparison.sides import Side, side_of
from flexlash.findings import finding, shown
from flexlash.recreation import Recreation, recreate
from flexlash.submission.reading.limits import ReadingLimits
from flexlash.submission.reading.refusal import Refusal
from flexlash.terminal import NOTHING, one_submission, progress, tell, tell_refused, worst

__all__ = ["compare", "recreate_all"]


def recreate_all(
    reports: Sequence[Path], output: Path | None, *, as_json: bool, quiet: bool, **options: Any
) -> list[int]:
    """Write the submission and the report of each report anew and say whether they are the same; return exit codes."""
    codes: list[int] = []
    taken = {report.resolve() for report in reports}
    for report in reports:
        with one_submission(report, codes, as_json=as_json), progress(quiet=quiet or as_json) as advance:
            try:
                found = recreate(report, output, taken, progress=advance, **options)
            except ModuleNotFoundError as fault:
                raise click.UsageError(f"{fault} Without it: --no-elasticity.") from fault
            if not quiet or found.outcome.exit_code:
                _tell_recreation(found, report, as_json=as_json)
            codes.append(found.outcome.exit_code)
    return codes


def _tell_recreation(found: Recreation, report: Path, *, as_json: bool) -> None:
    """Print what came of a report, last whether its numbers are the same."""
    compared = {"numbers": found.numbers, "different": found.different}
    tell(found.outcome, report, as_json=as_json, ran=True, further={"compared": compared})
    if as_json or not found.numbers:
        return
    for remark in found.remarks:
        click.echo(f"  {shown(remark, longest=400)}", err=True)
    click.echo(comparison_line(found.different, found.numbers, shown(report.name)))


def compare(old: Path, new: Path, *, tolerance: float, every: bool, limits: ReadingLimits, as_json: bool) -> int:
    """Print what differs between two reports or submissions; return the exit code."""
    codes: list[int] = []
    before, after = (_side(path, limits, codes, as_json=as_json) for path in (old, new))
    if before is None or after is None:
        return worst(codes)
    found = difference(before, after, tolerance)
    if as_json:
        click.echo(json.dumps(found.as_dictionary(), ensure_ascii=False))
        return 0
    for line in difference_lines(found, every=every):
        click.echo(line)
    return 0


def _side(path: Path, limits: ReadingLimits, codes: list[int], *, as_json: bool) -> Side | None:
    """Return a file to compare; None, with its exit code, when it is none."""
    with one_submission(path, codes, as_json=as_json):
        try:
            return side_of(path, limits)
        except Refusal as refusal:
            facts: dict[str, Any] = {"file": path.name, **refusal.facts}
            found = finding(refusal.code, **facts)
            tell_refused(found, path.name)
            if as_json:
                click.echo(json.dumps({"submission": str(path), "error": found.message}, ensure_ascii=False))
            codes.append(NOTHING)
    return None
