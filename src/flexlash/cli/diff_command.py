"""`flexlash diff`: what changed between two reports or submissions."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from flexlash.cli.click_types import JSON, LIMITS
from flexlash.cli.submissions import Submissions
from flexlash.cli.terminal import print_json

if TYPE_CHECKING:
    from flexlash.comparison.sides import Side
    from flexlash.reading.reading_limits import ReadingLimits

__all__ = ["diff"]


@click.command()
@click.argument("old", metavar="A", type=click.Path(path_type=Path, readable=False))
@click.argument("new", metavar="B", type=click.Path(path_type=Path, readable=False))
@click.option(
    "--tolerance", type=click.FloatRange(0, 1), default=1e-12, show_default=True, metavar="RELATIVE",
    help="Numbers of Results whose relative difference is no greater than this count as equal.",
)  # fmt: skip
@click.option("--all", "every", is_flag=True, help="List every column of Results and every variant.")
@LIMITS
@JSON
def diff(old: Path, new: Path, *, tolerance: float, every: bool, limits: ReadingLimits, as_json: bool) -> None:
    """Say what differs between A and B, reports or submissions: inputs and, of two reports, results.

    The exit code is 0 whether or not they differ.
    """
    from flexlash.comparison.difference import difference
    from flexlash.comparison.difference_lines import difference_lines

    both = Submissions(several=True, as_json=as_json)
    before, after = (_side(path, limits, both) for path in (old, new))
    if before is None or after is None:
        sys.exit(both.code)
    found = difference(before, after, tolerance)
    if as_json:
        print_json(found.as_dictionary())
        return
    for line in difference_lines(found, every=every):
        click.echo(line)


def _side(path: Path, limits: ReadingLimits, both: Submissions) -> Side | None:
    """Return a file to compare; None, with its exit code, when it is none."""
    from flexlash.comparison.sides import side_of

    with both.one(path):
        return side_of(path, limits)
    return None
