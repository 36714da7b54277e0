"""`flexlash distribution`: how the backlash of each variant is spread, as other programs take it over."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from flexlash.analysis.options import TABLES
from flexlash.cli.click_types import SUBMISSION, planned, spread_options
from flexlash.cli.submissions import Submissions
from flexlash.cli.terminal import progress
from flexlash.outputs.naming import table_output
from flexlash.outputs.plan import Plan

__all__ = ["distribution"]


@click.command()
@SUBMISSION
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="OUT", required=True,
    help="Random units as .parquet, percentiles as .csv, or metalogs as .json (SIPmath 3.0).",
)  # fmt: skip
@click.option("--units", type=click.IntRange(1, 1_000_000), default=10_000, show_default=True,
              help="Random units of each variant, in .parquet.")  # fmt: skip
@spread_options
def distribution(submission: Path, output: Path, *, units: int, as_json: bool, quiet: bool, **options: Any) -> None:
    """Write how the backlash of each variant is spread, for simulations and other programs.

    Exit codes are those of run.
    """
    from flexlash.pipeline import distribution as distribution_of

    told = Submissions(several=False, as_json=as_json, quiet=quiet, ran=True)
    beside = [options[name] for name in TABLES if options[name]]
    place = planned(table_output, Plan(inputs=[submission, *beside]), output)
    with told.one(submission) as attempt, progress(quiet=quiet or as_json) as advance:
        attempt.outcome = distribution_of(submission, place, units=units, progress=advance, **options)
    sys.exit(told.end())
