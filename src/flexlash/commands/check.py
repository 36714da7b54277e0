"""`flexlash check`: what is wrong with submissions, marked or mended on demand; nothing is sampled."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from flexlash.commands.arguments import JSON, LIMITS, MARKED, QUIET, STRICT, SUBMISSIONS, planned, table_option
from flexlash.commands.submissions import Submissions
from flexlash.targets import beside, mended_targets

__all__ = ["check"]


@click.command()
@SUBMISSIONS
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="OUT",
    help="The mended file, or the folder for marked and mended files. Default: beside the submission.",
)  # fmt: skip
@click.option("--annotate", is_flag=True, help="Write <name>-checked.xlsx: your file with the cells to mend marked.")
@click.option("--apply-fixes", is_flag=True, help="Write a new file in which the certain suggestions are applied.")
@STRICT
@LIMITS
@MARKED
@JSON
@QUIET
@table_option("tolerances")
@table_option("materials")
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
    from flexlash.submission.reading.read import Reading

    if output and not (annotate or apply_fixes):
        raise click.UsageError("-o needs --apply-fixes or --annotate; check alone writes nothing.")
    targets = planned(mended_targets, submissions, output)
    copies = beside(submissions, targets)
    if output in targets and not apply_fixes:
        copies = targets
        if output.suffix.lower() != ".xlsx":
            raise click.UsageError("A marked copy is a workbook: OUT must end in .xlsx or be a folder.")
    options["marked_copies"] |= annotate
    all_of_them = Submissions(len(submissions), as_json=as_json, quiet=quiet)
    for path, target, copy in zip(submissions, targets, copies, strict=True):
        with all_of_them.one(path) as ended:
            reading = Reading(path, options["limits"])
            # Loading the libraries takes as long as reading the file does: both at once.
            from flexlash.pipeline import check as check_one
            from flexlash.pipeline import mend

            if apply_fixes:
                ended.outcome, ended.repairs = mend(reading, target, marked_copy=copy if annotate else None, **options)
            else:
                ended.outcome = check_one(reading, marked_copy=copy if annotate else None, **options)
    sys.exit(all_of_them.end())
