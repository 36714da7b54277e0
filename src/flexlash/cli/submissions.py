"""One submission after the other: how each ended, on the screen or as JSON, and all of them together."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from flexlash import __version__
from flexlash.cli.terminal import complain, internal_error, named, print_json, reason
from flexlash.mechanics.elasticity import MissingLibrariesError
from flexlash.reading.refusal import Refusal
from flexlash.schema.exit_codes import ExitCode, most_severe
from flexlash.schema.findings import Finding, finding, readable, shown
from flexlash.schema.variant import Settings

if TYPE_CHECKING:
    from flexlash.analysis.outcome import Outcome
    from flexlash.feedback.fixing.fix import Fix

__all__ = ["Ended", "Submissions"]

_FIELDS = (
    "submission", "path", "sha256", "version", "seed", "method", "seconds", "exit_code", "error", "counts", "findings",
    "outputs",
)  # fmt: skip
"""What `--json` says of a submission, whatever happened."""

_COUNTS = ("rows", "computed", "errors", "warnings", "meets", "marginal", "fails")
_NOT_OURS = (click.ClickException, click.Abort, KeyboardInterrupt, SystemExit, GeneratorExit)
"""What ends the whole command, not one submission."""

_KINDS = {ExitCode.FINE: "computed", ExitCode.OVER_LIMIT: "computed", ExitCode.SOME_ROWS: "partly"}
"""How much of a submission was computed, by its exit code; by any other, nothing."""

_SHOWN_FIXES = 10
_COLOURS = {"error": "red", "warning": "yellow", "info": "cyan"}


class _Line(NamedTuple):
    """A line for the screen: its text, its colour, whether it is a message rather than a result."""

    text: str
    colour: str | None = None
    is_message: bool = False


@dataclass(kw_only=True)
class Ended:
    """How a submission ended: its outcome, or why there is none.

    `error` is the sentence that says why nothing of it was computed, `refusal` the finding where it was no submission.
    `fixes` were made in it; `further` are more fields for `--json`; `remarks` and `closing` are lines that follow on
    standard error and standard output.
    """

    path: Path
    outcome: Outcome | None = None
    code: ExitCode = ExitCode.FINE
    error: str | None = None
    refusal: Finding | None = None
    seconds: float = 0.0
    fixes: list[Fix] | None = None
    further: Mapping[str, Any] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    closing: list[str] = field(default_factory=list)

    @property
    def name(self) -> str:
        """The file that the closing lines speak of: the mended one, where there is one."""
        return named(self.outcome.outputs[0] if self.fixes and self.outcome else self.path)

    def as_dictionary(self) -> dict[str, Any]:
        """Return the object that `--json` prints."""
        usual = Settings()
        known: dict[str, Any] = dict.fromkeys(_FIELDS)
        known |= {"submission": readable(self.path.name), "sha256": "", "version": __version__}
        known |= {"seed": usual.seed, "method": usual.method}
        known |= {"counts": dict.fromkeys(_COUNTS, 0), "findings": [], "outputs": []}
        if self.refusal:
            known["counts"]["errors"] = 1
            known["findings"] = [self.refusal.as_dictionary()]
        known |= self.outcome.as_dictionary() if self.outcome else {}
        known |= {"path": readable(self.path), "seconds": round(self.seconds, 3)}
        known |= {"exit_code": self.code, "error": self.error}
        fixes = {} if self.fixes is None else {"fixes": [fix.as_dictionary() for fix in self.fixes]}
        return {**known, **fixes, **self.further}


class Submissions:
    """The submissions of a command: each ends for itself, all of them with the most severe exit code.

    `ran` says that they are computed, not merely checked; then findings are messages, not what was asked for.
    """

    def __init__(self, count: int, *, as_json: bool, quiet: bool = False, ran: bool = False) -> None:
        self.several = count > 1
        self.as_json = as_json
        self.quiet = quiet
        self.ran = ran
        self.codes: list[ExitCode] = []
        self.skipped = 0

    @property
    def code(self) -> ExitCode:
        """The most severe exit code of those submissions that were not skipped."""
        return most_severe(self.codes)

    @contextmanager
    def one(self, path: Path) -> Iterator[Ended]:
        """Yield a record to be filled with a submission's outcome; whatever stops it, the others go on."""
        ended = Ended(path=path)
        lines: list[_Line] = []
        start = time.perf_counter()
        try:
            yield ended
            self._judge(ended)
            lines = list(self._lines(ended))
        except _NOT_OURS:
            raise
        except Refusal as refusal:
            facts: dict[str, Any] = {"file": path.name, **refusal.facts}
            ended.refusal = finding(refusal.code, **facts)
            self._fail(ended, refusal.exit_code, ended.refusal.message)
        except OSError as fault:
            place = named(fault.filename or path)
            self._fail(ended, ExitCode.NO_FILE, f"{place} could not be opened or written: {reason(fault, path)}")
        except BaseException as fault:  # noqa: BLE001 - a panic of polars is no Exception
            missing = isinstance(fault, MissingLibrariesError)
            code = MissingLibrariesError.exit_code if missing else ExitCode.INTERNAL
            self._fail(ended, code, f"{fault} Without it: --no-elasticity." if missing else internal_error(fault))
        ended.seconds = time.perf_counter() - start
        self._count(ended)
        self._print(ended, lines)

    def end(self) -> ExitCode:
        """Say what came of all of them, where there are several; return the exit code of the command."""
        from flexlash.analysis.run_summary import counted

        kinds = Counter(_KINDS.get(code, "not") for code in self.codes)
        total = {kind: kinds[kind] for kind in ("computed", "partly", "not")}
        if self.several and self.as_json:
            print_json({"total": {"submissions": len(self.codes), **total, "exit_code": self.code}})
        elif self.several and (self.code or not self.quiet):
            done = "computed" if self.ran else "ready"
            skipped = f"; {self.skipped} skipped" if self.skipped else ""
            parts = f"{total['computed']} {done}, {total['partly']} {done} in part, {total['not']} not{skipped}"
            click.echo(f"Total of {counted(len(self.codes), 'submission')}: {parts}.")
        return self.code

    def _judge(self, ended: Ended) -> None:
        """Set exit code and error of a submission that came to an outcome."""
        outcome = ended.outcome
        if outcome is None:
            return
        if outcome.skipped:
            ended.code = ExitCode.FINE if self.several else ExitCode.NOTHING
            return
        ended.code = outcome.exit_code
        if outcome.fault is not None:
            ended.error = f"{named(outcome.fault.filename)} could not be written: {reason(outcome.fault)}"
        elif outcome.submission.kind == "refused":
            ended.error = outcome.findings[0].message

    @staticmethod
    def _fail(ended: Ended, code: ExitCode, error: str) -> None:
        """Set exit code and error of a submission that came to no outcome."""
        ended.outcome, ended.code, ended.error = None, code, error

    def _count(self, ended: Ended) -> None:
        """Count a submission, unless it is none."""
        if ended.outcome is not None and ended.outcome.skipped:
            self.skipped += 1
        else:
            self.codes.append(ended.code)

    def _lines(self, ended: Ended) -> Iterator[_Line]:
        """Yield what the screen shows of an outcome: findings grouped by rule, then the summary."""
        outcome = ended.outcome
        if outcome is None or self.as_json or (self.quiet and not ended.code):
            return
        from flexlash.analysis.run_summary import finding_lines, summary_lines

        name = f"{named(ended.path)}: " if self.several else ""
        yield from (_Line(text) for text in _fix_lines(ended.fixes)) if ended.fixes is not None else ()
        for level, text in finding_lines(outcome.findings):
            yield _Line(f"{name}{text}", _COLOURS.get(level), self.ran)
        yield from (_Line(text) for text in summary_lines(outcome, ended.name, ran=self.ran))
        yield from (_Line(f"{name}{text}", None, True) for text in ended.remarks)
        yield from (_Line(text) for text in ended.closing)

    def _print(self, ended: Ended, lines: Iterable[_Line]) -> None:
        """Print how a submission ended."""
        if self.as_json and (ended.outcome or ended.error):
            print_json(ended.as_dictionary())
        for line in lines:
            click.echo(click.style(line.text, fg=line.colour) if line.colour else line.text, err=line.is_message)
        name = f"{named(ended.path)}: "
        for remark in ended.outcome.remarks if ended.outcome else ():
            click.echo(click.style(f"{name if self.several else ''}{remark}", fg="yellow"), err=True)
        if ended.error and (ended.outcome is None or ended.outcome.fault is not None):
            complain(ended.error if named(ended.path) in ended.error else f"{name}{ended.error}")
        if ended.refusal:
            click.echo(f"{name if self.several else ''}Mend: {ended.refusal.fix}", err=True)


def _fix_lines(fixes: Sequence[Fix]) -> Iterator[str]:
    """Yield what was changed in a mended submission, the first cells of it by name."""
    from flexlash.analysis.run_summary import counted

    yield (
        f"{counted(len(fixes), 'cell')} mended:" if fixes else "There is nothing that could be mended with certainty."
    )
    for fix in fixes[:_SHOWN_FIXES]:
        yield f'    {shown(fix.place)}: "{shown(fix.found)}" → {shown(fix.written)} ({fix.code})'
    if len(fixes) > _SHOWN_FIXES:
        yield f"    … and {len(fixes) - _SHOWN_FIXES} more; a workbook lists them all on its sheet Fixes"
