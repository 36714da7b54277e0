"""`flexlash run`: the tolerance spread of submissions, and the reports."""

from __future__ import annotations

import os
import sys
from itertools import zip_longest
from pathlib import Path
from typing import Any

import click

from flexlash.cli.click_types import JSON, LIMITS, QUIET, SUBMISSIONS, option, planned
from flexlash.cli.submissions import Submissions
from flexlash.cli.terminal import progress
from flexlash.outputs.naming import marked_outputs, report_outputs
from flexlash.outputs.plan import Plan

__all__ = ["run"]


@click.command()
@SUBMISSIONS
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="OUT",
    help="Report (.xlsx), Results alone (.csv, .parquet, .json), or a folder. "
    "Default: <name>-report.xlsx beside the submission.",
)  # fmt: skip
@option("seed")
@option("method")
@option("samples")
@option("cross_check")
@option("elasticity")
@option("jobs", default=os.cpu_count() or 1, show_default="all cores")
@option("strict")
@option("fail_over_limit")
@LIMITS
@JSON
@option("from_report")
@QUIET
@click.option(
    "--annotate/--no-annotate", default=True, show_default=True,
    help="Write <name>-checked.xlsx, your file with the cells to mend marked, when there are errors or warnings.",
)  # fmt: skip
@option("marked_copies")
@option("tolerances")
@option("materials")
def run(
    submissions: tuple[Path, ...],
    output: Path | None,
    *,
    annotate: bool,
    from_report: bool,
    as_json: bool,
    quiet: bool,
    **options: Any,
) -> None:
    """Validate, compute the tolerance spread, write the report."""
    from flexlash.mechanics.elasticity import MISSING, is_available
    from flexlash.reading.limited_process import begin

    if options["elasticity"] and not is_available():
        raise click.UsageError(MISSING)
    beside = [path for path in (options["tolerances"], options["materials"]) if path]
    plan = Plan(
        inputs=[*submissions, *beside],
        submissions=() if from_report else submissions,
        marked_copies=options["marked_copies"],
    )
    reports = planned(report_outputs, plan, submissions, output)
    if from_report:
        from flexlash.cli.recreate_command import recreate_all

        sys.exit(recreate_all(submissions, output, as_json=as_json, quiet=quiet, **options))
    copies = planned(marked_outputs, plan, submissions, output) if annotate else []
    options["given"] = submissions
    # The process that reads loads its libraries while this one loads its own.
    begin()
    all_of_them = Submissions(len(submissions), as_json=as_json, quiet=quiet, ran=True)
    for path, report, copy in zip_longest(submissions, reports, copies):
        with all_of_them.one(path) as ended, progress(quiet=quiet or as_json) as advance:
            from flexlash.pipeline import run as run_one

            ended.outcome = run_one(path, report, marked_copy=copy, progress=advance, **options)
    sys.exit(all_of_them.end())
