"""How submissions ended, on the screen or as JSON, each for itself and all of them together."""

from __future__ import annotations

import os
import time
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from flexlash.analysis.run_summary import closing_lines, counted, listed
from flexlash.analysis.written_files import file_words
from flexlash.batch.ended import Ended, how_many
from flexlash.cli.terminal import complain, internal_error, named, print_json
from flexlash.mechanics.elasticity import MissingLibrariesError
from flexlash.reading.refusal import Refusal
from flexlash.schema.exit_codes import ExitCode, most_severe
from flexlash.schema.file_faults import unusable
from flexlash.schema.findings import CATALOGUE, finding, shown

if TYPE_CHECKING:
    from flexlash.analysis.outcome import Outcome
    from flexlash.feedback.fixing.fix import Fix

__all__ = ["Attempt", "Submissions"]

_NOT_OURS = (click.ClickException, click.Abort, KeyboardInterrupt, SystemExit, GeneratorExit)
"""What ends the whole command, not one submission."""

_OPEN_IN_EXCEL = "~$"
"""What the file is called beside a workbook that Excel has open, before its name."""

_SHOWN_FIXES = 10
_SHOWN_SKIPPED = 3
_COLOURS = {"error": "red", "warning": "yellow", "info": "cyan"}


class _Line(NamedTuple):
    """A line for the screen: its text, its colour, whether it is a message rather than a result."""

    text: str
    colour: str | None = None
    is_message: bool = False


@dataclass(kw_only=True)
class Attempt:
    """What is done with one file in this process: the outcome it came to, and what more is to be told of it.

    `further` are more fields for `--json`; `remarks` and `closing` are lines that follow on standard error and standard
    output. `codes` are exit codes beside that of the outcome.
    """

    outcome: Outcome | None = None
    codes: Sequence[ExitCode] = ()
    further: Mapping[str, Any] = field(default_factory=dict)
    remarks: Sequence[str] = ()
    closing: Sequence[str] = ()


class Submissions:
    """The submissions of a command: each ends for itself, all of them with the most severe exit code.

    `ran` says that they are computed, not merely checked; then findings are messages, not what was asked for. Of
    several each has one line, unless `verbose`. `tells_levers` says that the changes of each are told.
    """

    def __init__(
        self,
        *,
        several: bool,
        as_json: bool,
        quiet: bool = False,
        ran: bool = False,
        verbose: bool = False,
        tells_levers: bool = False,
    ) -> None:
        self.several = several
        self.as_json = as_json
        self.quiet = quiet
        self.ran = ran
        self.tells_levers = tells_levers
        self.verbose = verbose or not several
        self.codes: list[ExitCode] = []
        self.further_codes: list[ExitCode] = []
        self.skipped = 0
        self.done_before = 0
        self._met: dict[str, list[str]] = defaultdict(list)

    @property
    def code(self) -> ExitCode:
        """The most severe exit code of the submissions that were not skipped, and of what is about all of them."""
        return most_severe([*self.codes, *self.further_codes])

    @contextmanager
    def one(self, path: Path) -> Iterator[Attempt]:
        """Yield a record to be filled with what is done with a file; whatever stops it, the others go on."""
        attempt = Attempt()
        start = time.perf_counter()
        ended = None
        try:
            yield attempt
            ended = self._ended(path, attempt.outcome)
        except _NOT_OURS:
            raise
        except Refusal as refusal:
            facts: dict[str, Any] = {"file": path.name, **refusal.facts}
            found = finding(refusal.code, **facts)
            ended = Ended.failing(path, refusal.exit_code, found.message, found)
        except OSError as fault:
            ended = Ended.failing(path, ExitCode.NO_FILE, unusable(fault, path))
        except MissingLibrariesError as missing:
            ended = Ended.failing(path, missing.exit_code, f"{missing} Without it: --no-elasticity.")
        except BaseException as fault:  # noqa: BLE001 - a panic of polars is no Exception
            ended = Ended.failing(path, ExitCode.INTERNAL, internal_error(fault))
        if ended is None:
            self.codes.append(ExitCode.FINE)
        else:
            code = most_severe([ended.code, *attempt.codes])
            self.tell(replace(ended, code=code, seconds=time.perf_counter() - start), attempt)

    def _ended(self, path: Path, outcome: Outcome | None) -> Ended | None:
        """Return how a file ended that came to an outcome."""
        if outcome is None:
            return None
        from flexlash.batch.compute import answer_of

        return Ended.answered(path, answer_of(outcome, ran=self.ran), outcome.written, several=self.several)

    def tell(self, ended: Ended, attempt: Attempt | None = None) -> None:
        """Print how a submission ended, and count it unless it was skipped."""
        attempt = attempt or Attempt()
        self.done_before += ended.done_before
        if ended.skipped:
            self.skipped += 1
        else:
            self.codes.append(ended.code)
        if self.as_json:
            print_json({**ended.as_dictionary(), **attempt.further})
        elif not (self.quiet and not ended.code):
            for line in self._lines(ended, attempt) if self.verbose else self._one_line(ended):
                click.echo(click.style(line.text, fg=line.colour) if line.colour else line.text, err=line.is_message)
        self._complain(ended)

    def _complain(self, ended: Ended) -> None:
        """Print what was left alone, and why nothing came of a submission or a file of it is missing."""
        name = f"{named(ended.path)}: "
        for remark in ended.written.remarks:
            click.echo(click.style(f"{name if self.several else ''}{remark}", fg="yellow"), err=True)
        lock = ended.path.parent / f"{_OPEN_IN_EXCEL}{ended.path.name}"
        if not (ended.skipped or self.quiet) and os.path.exists(lock):  # noqa: PTH110 - a name may be too long
            unsaved = "it seems to be open in Excel: what is not saved there was not read"
            click.echo(click.style(f"{name}{unsaved}", fg="yellow"), err=True)
        if ended.fault is not None and os.environ.get("FLEXLASH_DEBUG") == "1":
            click.echo(ended.fault.trace, err=True)
        if ended.error and not (ended.refused and (self.verbose or self.as_json)):
            code = f"{next(iter(ended.by_rule))} " if ended.refused else ""
            files = ", ".join(map(named, ended.written.paths)) if ended.refused else ""
            where = f" Written: {files}" if files else ""
            complain(f"{'' if named(ended.path) in ended.error and not code else name}{code}{ended.error}{where}")
        if ended.fix:
            click.echo(f"{name if self.several else ''}Fix: {ended.fix}", err=True)

    def _one_line(self, ended: Ended) -> Iterator[_Line]:
        """Yield what the screen shows of one submission among several: how much was computed, and what was written."""
        name = named(ended.path)
        if ended.skipped and ended.in_folder:
            self._met[next(iter(ended.by_rule))].append(name)
        elif ended.skipped:
            (found,) = ended.told["findings"]
            text = f"{name}: {found['level']} {found['code']} {found['message']}"
            yield _Line(text, _COLOURS["info"], is_message=self.ran)
        elif ended.words and not ended.refused:
            over = sum(ended.counts[verdict] for verdict in ("marginal", "fails"))
            judged = counted(over + ended.counts["meets"], "variant")
            limit = f" Limit not met by {over} of {judged}." if over else ""
            files = ", ".join(file_words(ended.written.paths))
            yield _Line(f"{ended.name}: {ended.words}.{limit}{f' Written: {files}' if files else ''}")

    def _lines(self, ended: Ended, attempt: Attempt) -> Iterator[_Line]:
        """Yield what the screen shows in full: findings grouped by rule, then the summary."""
        name = f"{named(ended.path)}: " if self.several else ""
        yield from (_Line(text) for text in _fix_lines(ended.fixes)) if ended.fixes is not None else ()
        for level, text in ended.finding_lines:
            yield _Line(f"{name}{text}", _COLOURS.get(level), self.ran)
        if ended.words and not ended.skipped:
            closing = closing_lines(
                ended.name,
                ended.words,
                ended.details,
                ended.counts,
                ended.written,
                ran=self.ran,
                tells_levers=self.tells_levers,
            )
            yield from (_Line(text) for text in closing)
        yield from (_Line(f"{name}{text}", None, is_message=True) for text in attempt.remarks)
        yield from (_Line(text) for text in attempt.closing)

    def end(self, written: Sequence[Path] = ()) -> ExitCode:
        """Say what came of all of them, where there are several; return the exit code of the command.

        `written` are files about all of them.
        """
        total = how_many(self.codes)
        if self.several and self.as_json:
            print_json({"total": {"submissions": len(self.codes), **total, "exit_code": self.code}})
        elif self.several and (self.code or not self.quiet):
            for code, names in self._met.items():
                text = f"{counted(len(names), 'file')}, {CATALOGUE[code].title}: {listed(names, _SHOWN_SKIPPED)}"
                click.echo(click.style(text, fg=_COLOURS["info"]), err=True)
            if self.done_before:
                click.echo(
                    f"{counted(self.done_before, 'submission')} done by an earlier run, not computed again.", err=True
                )
            done = "computed" if self.ran else "ready"
            skipped = f"; {self.skipped} skipped" if self.skipped else ""
            parts = f"{total['computed']} {done}, {total['partly']} {done} in part, {total['not']} not{skipped}"
            click.echo(f"Total of {counted(len(self.codes), 'submission')}: {parts}.")
            if written:
                click.echo(f"Written: {', '.join(map(named, written))}")
        return self.code


def _fix_lines(fixes: Sequence[Fix]) -> Iterator[str]:
    """Yield what was changed in a fixed submission, the first cells of it by name."""
    yield (f"{counted(len(fixes), 'cell')} fixed:" if fixes else "Nothing can be fixed with certainty.")
    for fix in fixes[:_SHOWN_FIXES]:
        yield f'    {shown(fix.place)}: "{shown(fix.found)}" → {shown(fix.written)} ({fix.code})'
    if len(fixes) > _SHOWN_FIXES:
        yield f"    … and {len(fixes) - _SHOWN_FIXES} more; a workbook lists them all on its sheet Fixes"
