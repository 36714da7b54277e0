"""`flexlash diff`: what changed between two reports or submissions."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexlash.commands.arguments import JSON, LIMITS
from flexlash.findings import finding
from flexlash.terminal import NOTHING, one_submission, tell_refused, worst

if TYPE_CHECKING:
    from flexlash.comparison.sides import Side
    from flexlash.submission.reading.limits import ReadingLimits

__all__ = ["diff"]


@click.command()
@click.argument("old", metavar="A", type=click.Path(path_type=Path, readable=False))
@click.argument("new", metavar="B", type=click.Path(path_type=Path, readable=False))
@click.option(
    "--tolerance", type=click.FloatRange(0, 1), default=1e-12, show_default=True, metavar="RELATIVE",
    help="Numbers of Results that differ by no more than this part of themselves are equal.",
)  # fmt: skip
@click.option("--all", "every", is_flag=True, help="Tell every column of Results and every variant.")
@LIMITS
@JSON
def diff(old: Path, new: Path, *, tolerance: float, every: bool, limits: ReadingLimits, as_json: bool) -> None:
    """Say what differs between A and B, reports or submissions: inputs and, of two reports, results.

    The exit code is 0 whether or not they differ.
    """
    from flexlash.comparison.difference import difference
    from flexlash.comparison.difference_lines import difference_lines

    codes: list[int] = []
    before, after = (_side(path, limits, codes, as_json=as_json) for path in (old, new))
    if before is None or after is None:
        sys.exit(worst(codes))
    found = difference(before, after, tolerance)
    if as_json:
        click.echo(json.dumps(found.as_dictionary(), ensure_ascii=False))
        return
    for line in difference_lines(found, every=every):
        click.echo(line)


def _side(path: Path, limits: ReadingLimits, codes: list[int], *, as_json: bool) -> Side | None:
    """Return a file to compare; None, with its exit code, when it is none."""
    from flexlash.comparison.sides import side_of
    from flexlash.submission.reading.refusal import Refusal

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
