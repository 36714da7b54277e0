"""`flexlash check`: what is wrong with submissions, marked or fixed on demand; nothing is sampled."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import click

from flexlash.analysis.options import TABLES, Options
from flexlash.batch.given_files import given_files
from flexlash.cli.batches import Planned, carried_out, to_be_told
from flexlash.cli.click_types import JSON, LIMITS, QUIET, RECURSIVE, SUBMISSIONS, VERBOSE, option, planned
from flexlash.outputs.naming import fixed_outputs, marked_outputs
from flexlash.outputs.plan import Plan

__all__ = ["check"]


@click.command()
@SUBMISSIONS
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="OUT",
    help="The fixed file, or the folder for marked and fixed files. Default: beside the submission.",
)  # fmt: skip
@click.option("--annotate", is_flag=True, help="Write <name>-checked.xlsx: your file with the cells to fix marked.")
@click.option("--apply-fixes", is_flag=True, help="Write a new file with the certain fixes applied.")
@option("strict")
@LIMITS
@option("marked_copies")
@RECURSIVE
@option("jobs", default=os.cpu_count() or 1, show_default="all cores")
@JSON
@QUIET
@VERBOSE
@option("tolerances")
@option("materials")
@option("measurements")
@option("correlations")
@option("other_sources")
def check(
    submissions: tuple[Path, ...],
    output: Path | None,
    *,
    annotate: bool,
    apply_fixes: bool,
    recursive: bool,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **options: Any,
) -> None:
    """Validate submissions and print what was found; nothing is sampled.

    Of a folder that is done with each workbook and table in it. Nothing is written without --annotate or --apply-fixes.
    """
    if output and not (annotate or apply_fixes):
        raise click.UsageError("-o needs --apply-fixes or --annotate; check alone writes nothing.")
    beside = [options[name] for name in TABLES if options[name]]
    given = given_files(
        submissions,
        recursive=recursive,
        output=output,
        beside=beside,
        marked_copies=options["marked_copies"],
    )
    # A marked copy alone is meant to be checked again; among others it is met on the way.
    options["marked_copies"] |= annotate and len(given.files) == 1
    paths, below = given.submissions, given.sub_folders
    plan = Plan(inputs=[*paths, *beside], submissions=paths, marked_copies=options["marked_copies"])
    fixed = planned(fixed_outputs, plan, paths, output, below=below) if apply_fixes else []
    copies = planned(marked_outputs, plan, paths, output, itself=not apply_fixes, below=below) if annotate else []
    outputs = Planned(files=dict(zip(paths, fixed, strict=False)), copies=dict(zip(paths, copies, strict=False)))
    told = to_be_told(given, recursive=recursive, as_json=as_json, quiet=quiet, verbose=verbose)
    chosen = Options.of("check()", options)
    sys.exit(carried_out("fix" if apply_fixes else "check", given, outputs, chosen, told))
