"""What reaches the screen: names as they may be printed, complaints in red, progress where it can be drawn."""

from __future__ import annotations

import json
import os
import shutil
import sys
import time
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from flexlash.batch.ended import fault_of, fault_words
from flexlash.schema.findings import shown

if TYPE_CHECKING:
    from flexlash.analysis.options import Progress
    from flexlash.batch.ended import Ended
    from flexlash.schema.findings import Finding

__all__ = ["Bar", "colour", "complain", "internal_error", "named", "print_json", "print_refusal", "progress"]

_BAR = 24
"""Characters of a bar."""

_ERASED = "\r\x1b[2K"
"""What takes the present line of a terminal away."""


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
    """Print why a file was refused, and the fix."""
    complain(f"{'' if file in found.message else f'{named(file)}: '}{found.code} {found.message}")
    click.echo(f"Fix: {found.fix}", err=True)


def internal_error(fault: BaseException) -> str:
    """Return the sentence about a fault of flexlash's own, of which FLEXLASH_DEBUG=1 shows everything."""
    if os.environ.get("FLEXLASH_DEBUG") == "1":
        traceback.print_exception(fault)
    return fault_words(fault_of(fault).kind)


def print_json(fields: Mapping[str, Any]) -> None:
    """Print an object on a line of its own, in plain letters where the screen's encoding is not that of JSON."""
    plain = (sys.stdout.encoding or "").lower().replace("-", "") != "utf8"
    click.echo(json.dumps(fields, ensure_ascii=plain))


class Bar:
    """How far many files are, drawn on standard error where that is a terminal that can draw, unless it is `quiet`."""

    def __init__(self, files: int, what: str = "Computing", *, quiet: bool) -> None:
        self._files = files
        self._what = what
        self._is_drawn = not quiet and sys.stderr.isatty() and _can_draw()
        self._done = self._rows = self._known = 0
        self._part = (0, 1)
        self._start = time.perf_counter()
        self.draw()

    def advance(self, ended: Ended) -> None:
        """Draw that a submission has ended; one skipped or done before tells nothing of how long the rest takes."""
        self._done += 1
        self._known += ended.done_before or ended.skipped
        self._rows += 0 if ended.done_before else ended.counts["rows"]
        self._part = (0, 1)
        self.draw()

    def advance_rows(self, done: int, rows: int) -> None:
        """Draw how many rows of a large table are done."""
        self._part = (done, max(rows, 1))
        self.draw()

    def draw(self) -> None:
        """Draw the bar anew: files, rows, rows a second, time left."""
        if not self._is_drawn:
            return
        seconds = time.perf_counter() - self._start
        rows, of_table = self._part
        ended = self._done + rows / of_table
        filled = round(_BAR * ended / self._files) if self._files else _BAR
        text = f"{self._what} [{'#' * filled}{'-' * (_BAR - filled)}] {self._done} of {self._files} files"
        if new := ended - self._known:
            left, rows = round(seconds / new * (self._files - ended)), rows + self._rows
            text += f", {rows:,} rows, {rows / seconds:,.0f} rows/s, {left // 60}:{left % 60:02} left"
        width = shutil.get_terminal_size().columns - 1
        # Without colour click would leave out what erases the line, and the bar would stay behind the next.
        click.echo(f"{_ERASED}{text[:width]}", nl=False, err=True, color=True)

    def clear(self) -> None:
        """Make room for lines that are printed."""
        if self._is_drawn:
            click.echo(_ERASED, nl=False, err=True, color=True)


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
