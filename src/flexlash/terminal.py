"""What reaches the screen, and with which exit code a command ends."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexlash.findings import shown

if TYPE_CHECKING:
    from flexlash.findings import Finding
    from flexlash.options import Progress
    from flexlash.outcome import Outcome
    from flexlash.submission.mending.repair import Repair

__all__ = [
    "INTERNAL",
    "INTERRUPTED",
    "NOTHING",
    "NO_FILE",
    "named",
    "one_submission",
    "progress",
    "reason",
    "tell",
    "tell_refused",
    "worst",
]

INTERNAL, _USAGE, SOME_ROWS, NOTHING, NO_FILE, INTERRUPTED = 1, 2, 3, 4, 5, 130

_SEVERITY = (INTERNAL, NO_FILE, NOTHING, SOME_ROWS, 0)


def named(path: object) -> str:
    """Return a path as it may be printed: whole, without control characters."""
    return shown(path, longest=4096)


def worst(codes: list[int]) -> int:
    """Return the most severe exit code; without any submission there was nothing to compute."""
    return min(codes or [NOTHING], key=_SEVERITY.index)


@contextmanager
def one_submission(path: Path, codes: list[int], *, as_json: bool) -> Iterator[None]:
    """Turn what stops one submission into its exit code, so that the others go on."""
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as fault:
        place = named(fault.filename or path)
        why = reason(fault, path)
        click.secho(f"{place} could not be opened or written: {why}", fg="red", err=True)
        if as_json:
            click.echo(json.dumps({"submission": str(path), "error": f"{place}: {why}"}, ensure_ascii=False))
        codes.append(NO_FILE)


def reason(fault: OSError, path: Path | None = None) -> str:
    """Return why a file, or the path that the fault names, could not be opened or written."""
    place = fault.filename or path
    if isinstance(place, str | Path) and Path(place).is_dir():
        return "this is a folder; give the files in it"
    return fault.strerror or str(fault)


def tell_refused(found: Finding, file: str) -> None:
    """Print why a file was refused, and the mend."""
    name = "" if file in found.message else f"{named(file)}: "
    click.secho(f"{name}{found.code} {found.message}", fg="red", err=True)
    click.echo(f"Mend: {found.fix}", err=True)


@contextmanager
def progress(*, quiet: bool) -> Iterator[Progress | None]:
    """Yield a callback that draws a progress bar, or None off a terminal."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    with click.progressbar(length=1, label="Computing", file=sys.stderr, show_pos=True) as bar:

        def advance(done: int, total: int) -> None:
            bar.length = total
            bar.update(done - bar.pos)

        yield advance


def tell(
    outcome: Outcome,
    path: Path,
    *,
    as_json: bool,
    ran: bool = False,
    repairs: list[Repair] | None = None,
    further: Mapping[str, Any] | None = None,
) -> None:
    """Print an outcome: as one JSON object, with `further` fields, or findings grouped by rule and then the summary."""
    if as_json:
        fixes = {} if repairs is None else {"fixes": [repair.as_dictionary() for repair in repairs]}
        click.echo(json.dumps({**outcome.as_dictionary(), **fixes, **(further or {})}, ensure_ascii=False))
        return
    from flexlash.summary import finding_lines, repair_lines, summary_lines

    for line in () if repairs is None else repair_lines(repairs):
        click.echo(line)

    colours = {"error": "red", "warning": "yellow", "info": "cyan"}
    for level, line in finding_lines(outcome.findings):
        click.echo(click.style(line, fg=colours[level]) if level else line, err=ran)
    for line in summary_lines(outcome, named(path), ran=ran):
        click.echo(line)
