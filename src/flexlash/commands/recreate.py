"""`flexlash run --from-report`: the submission that a report carries, and the report made anew."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from flexlash.comparison.difference_lines import comparison_line
from flexlash.elasticity import MISSING
from flexlash.findings import shown
from flexlash.recreation import Recreation, recreate
from flexlash.terminal import one_submission, progress, tell

__all__ = ["recreate_all"]


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
                if str(fault) != MISSING:
                    raise
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
