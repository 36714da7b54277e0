"""What reaches the screen: names as they may be printed, complaints in red, progress where it can be drawn."""

from __future__ import annotations

import json
import os
import sys
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexlash.reading.libraries import ChangedLibrary
from flexlash.schema.findings import readable, shown

if TYPE_CHECKING:
    from flexlash.analysis.options import Progress
    from flexlash.schema.findings import Finding

__all__ = ["colour", "complain", "internal_error", "named", "print_json", "print_refusal", "progress", "reason"]


def named(path: object) -> str:
    """Return a path as it may be printed: whole, without control characters."""
    return shown(path, longest=4096)


def colour() -> bool | None:
    """Return False where colours are not wanted or cannot be drawn, None to let the stream decide."""
    return False if os.environ.get("NO_COLOR") or not _can_draw() else None


def complain(text: str) -> None:
    """Print on standard error what went wrong."""
    click.secho(text, fg="red", err=True, color=colour())


def print_refusal(found: Finding, file: str) -> None:
    """Print why a file was refused, and the mend."""
    complain(f"{'' if file in found.message else f'{named(file)}: '}{found.code} {found.message}")
    click.echo(f"Mend: {found.fix}", err=True)


def internal_error(fault: BaseException) -> str:
    """Return the sentence about a fault of flexlash's own, of which FLEXLASH_DEBUG=1 shows everything."""
    if os.environ.get("FLEXLASH_DEBUG") == "1":
        traceback.print_exception(fault)
    if isinstance(fault, ChangedLibrary):
        return f"Internal error: {shown(fault, longest=400)}."
    from flexlash.reading.limited_process import ProcessFaultError

    lines = str(fault).splitlines()
    kind = lines[0] if isinstance(fault, ProcessFaultError) and lines else type(fault).__name__
    return (
        f"Internal error ({readable(kind)}): this is a fault of flexlash, not of your file. "
        "Set FLEXLASH_DEBUG=1 for details."
    )


def print_json(fields: Mapping[str, Any]) -> None:
    """Print an object on a line of its own, in plain letters where the screen's encoding is not that of JSON."""
    plain = (sys.stdout.encoding or "").lower().replace("-", "") != "utf8"
    click.echo(json.dumps(fields, ensure_ascii=plain))


def reason(fault: OSError, path: Path | None = None) -> str:
    """Return why a file, or the path that the fault names, could not be opened or written."""
    place = fault.filename or path
    if isinstance(place, str | Path) and os.path.isdir(place):  # noqa: PTH112
        return "this is a folder; give the files in it"
    return readable(fault.strerror or fault)


@contextmanager
def progress(*, quiet: bool) -> Iterator[Progress | None]:
    """Yield a callback that draws a progress bar, or None where none can be drawn or is wanted."""
    if quiet or not (sys.stderr.isatty() and _can_draw()):
        yield None
        return
    with click.progressbar(length=1, label="Computing", file=sys.stderr, show_pos=True) as bar:

        def advance(done: int, total: int) -> None:
            bar.length = total
            bar.update(done - bar.pos)

        yield advance


def _can_draw() -> bool:
    """Whether a terminal knows colours and lines that are drawn again; systems other than POSIX do not say."""
    return os.environ.get("TERM", "" if os.name == "posix" else "unknown") not in {"", "dumb"}
