"""`flexlash check`: what is wrong with submissions, marked or mended on demand; nothing is sampled."""

from __future__ import annotations

import sys
from itertools import zip_longest
from pathlib import Path
from typing import Any

import click

from flexlash.cli.click_types import JSON, LIMITS, QUIET, SUBMISSIONS, option, planned
from flexlash.cli.submissions import Submissions
from flexlash.outputs.naming import fixed_outputs, marked_outputs
from flexlash.outputs.plan import Plan

__all__ = ["check"]


@click.command()
@SUBMISSIONS
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="OUT",
    help="The mended file, or the folder for marked and mended files. Default: beside the submission.",
)  # fmt: skip
@click.option("--annotate", is_flag=True, help="Write <name>-checked.xlsx: your file with the cells to mend marked.")
@click.option("--apply-fixes", is_flag=True, help="Write a new file in which the certain suggestions are applied.")
@option("strict")
@LIMITS
@option("marked_copies")
@JSON
@QUIET
@option("tolerances")
@option("materials")
def check(
    submissions: tuple[Path, ...],
    output: Path | None,
    *,
    annotate: bool,
    apply_fixes: bool,
    as_json: bool,
    quiet: bool,
    **options: Any,
) -> None:
    """Validate submissions and print what was found; nothing is sampled.

    Nothing is written without --annotate or --apply-fixes.
    """
    from flexlash.reading.limited_process import begin

    if output and not (annotate or apply_fixes):
        raise click.UsageError("-o needs --apply-fixes or --annotate; check alone writes nothing.")
    # A marked copy alone is meant to be checked again; among others it is met on the way.
    options["marked_copies"] |= annotate and len(submissions) == 1
    beside = [path for path in (options["tolerances"], options["materials"]) if path]
    plan = Plan(inputs=[*submissions, *beside], submissions=submissions, marked_copies=options["marked_copies"])
    fixed = planned(fixed_outputs, plan, submissions, output) if apply_fixes else []
    copies = planned(marked_outputs, plan, submissions, output, itself=not apply_fixes) if annotate else []
    options["given"] = submissions
    # The process that reads loads its libraries while this one loads its own.
    begin()
    all_of_them = Submissions(len(submissions), as_json=as_json, quiet=quiet)
    for path, target, copy in zip_longest(submissions, fixed, copies):
        with all_of_them.one(path) as ended:
            from flexlash.pipeline import check as check_one
            from flexlash.pipeline import mend

            if target:
                ended.outcome, ended.fixes = mend(path, target, marked_copy=copy, **options)
            else:
                ended.outcome = check_one(path, marked_copy=copy, **options)
    sys.exit(all_of_them.end())
