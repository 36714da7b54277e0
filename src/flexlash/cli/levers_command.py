"""`flexlash levers`: which single change brings each variant within its limit, and what a sound one leaves open."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexlash.analysis.options import TABLES
from flexlash.cli.click_types import SUBMISSION, option, planned, spread_options
from flexlash.cli.submissions import Submissions
from flexlash.cli.terminal import progress
from flexlash.outputs.naming import table_output
from flexlash.outputs.plan import Plan

if TYPE_CHECKING:
    import polars as pl

    from flexlash.analysis.outcome import Outcome

__all__ = ["levers"]

_NARROWEST = 60


@click.command()
@SUBMISSION
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="OUT",
    help="The table as .csv, .parquet or .json. Without it the table is printed.",
)  # fmt: skip
@spread_options
@option("angle_unit")
def levers(submission: Path, output: Path | None, *, as_json: bool, quiet: bool, **options: Any) -> None:
    """Say which single change brings each variant within its backlash limit, and how far those of a sound one may go.

    Each change is computed anew as drawn, with what it does to mass, stiffness and stress. Exit codes are those of run.
    """
    from flexlash.pipeline import levers as levers_of

    told = Submissions(several=False, as_json=as_json, quiet=quiet, ran=True, tells_levers=True)
    beside = [options[name] for name in TABLES if options[name]]
    place = output and planned(table_output, Plan(inputs=[submission, *beside]), output)
    with told.one(submission) as attempt, progress(quiet=quiet or as_json) as advance:
        attempt.outcome, table = levers_of(submission, place, progress=advance, **options)
        if as_json:
            attempt.further = {"levers": table.to_dicts()}
        elif output is None:
            lines = list(_lines(attempt.outcome, table))
            attempt.closing = ["", *lines] if lines else []
    sys.exit(told.end())


def _lines(outcome: Outcome, table: pl.DataFrame) -> Iterator[str]:
    """Yield the table as the screen shows it."""
    from flexlash.cli.levers_lines import levers_lines
    from flexlash.report.wording.lever_words import hats_of

    width = max(shutil.get_terminal_size((100, 24)).columns, _NARROWEST)
    for text, look in levers_lines(outcome.results, table, width, outcome.settings.angles, hats_of(outcome)):
        style = {"bold": True} if look == "bold" else {"fg": look or None}
        yield click.style(text, **style) if look else text
