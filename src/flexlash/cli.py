"""The command line: the only place that prints and that knows exit codes."""

from __future__ import annotations

import json
import os
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexlash import __version__
from flexlash.findings import CATALOGUE, shown

if TYPE_CHECKING:
    from flexlash.outcome import Outcome
    from flexlash.pipeline import Progress
    from flexlash.submission.reading.limits import ReadingLimits

__all__ = ["cli", "main"]

INTERNAL, USAGE, SOME_ROWS, NOTHING, NO_FILE, INTERRUPTED = 1, 2, 3, 4, 5, 130

Command = Callable[..., None]

_SEVERITY = (INTERNAL, NO_FILE, NOTHING, SOME_ROWS, 0)


@click.group(
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Exit codes of run and check: 0 every row fine, 3 some rows had errors, 4 nothing computable or no "
    "readable submission, 5 a file could not be opened or written, 2 usage, 1 internal error.",
)
@click.version_option(__version__, prog_name="flexlash")
def cli() -> None:
    """Excel in, tolerance-spread report out: backlash of strain wave gear flexsplines.

    \b
    Examples:
      flexlash template                      write the empty template
      flexlash check variants.xlsx           say what is wrong with it
      flexlash run variants.xlsx             compute it, write variants-report.xlsx
      flexlash run variants.xlsx -o out.csv  the results table alone
    """  # noqa: D301


@cli.command()
@click.option(
    "-o", "--output", type=click.Path(dir_okay=False, path_type=Path), default="flexlash-template.xlsx",
    show_default=True, help="Where to write it.",
)  # fmt: skip
@click.option("--example", is_flag=True, help="Fill it with the published B3-160 study.")
@click.option("--force", is_flag=True, help="Replace an existing file.")
def template(output: Path, *, example: bool, force: bool) -> None:
    """Write the Excel template that submissions are made from."""
    if output.exists() and not force:
        raise click.UsageError(f"{_named(output)} exists and may be filled; choose another -o, or --force.")
    from flexlash.report.output import write_bytes
    from flexlash.submission.template import study, template_bytes

    written = write_bytes(template_bytes(study() if example else None), output)
    click.echo(f"Template written: {_named(written)}")
    click.echo(f"Fill it in, then: flexlash run {_named(written)}", err=True)


@cli.command()
@click.option("--json", "as_json", is_flag=True, help="As a JSON array, one object per column.")
def schema(*, as_json: bool) -> None:
    """Print the data dictionary: every column of every sheet."""
    from flexlash.columns import ENTRY_SHEETS
    from flexlash.result_columns import FINDINGS, RESULTS

    sheets = {**ENTRY_SHEETS, "Results": RESULTS, "Findings": FINDINGS}
    columns = [column for sheet in sheets.values() for column in sheet]
    if as_json:
        click.echo(json.dumps([column.as_dictionary() for column in columns], ensure_ascii=False, indent=1))
        return
    for sheet, entries in sheets.items():
        click.echo(f"\n{sheet}")
        for column in entries:
            click.echo(f"  {column.key:32} {column.label}{', required' if column.required else ''}")
            click.echo(f"  {'':32} {column.help}")


@cli.command()
@click.argument("code", required=False)
def explain(code: str | None) -> None:
    """Say what a finding means and how to mend it; without CODE, list all codes."""
    if code is None:
        for rule in CATALOGUE.values():
            click.echo(f"{rule.code}  {rule.level:8} {rule.title}")
        return
    found = CATALOGUE.get(code.strip().upper())
    if found is None:
        raise click.UsageError(f"{shown(code)} is not a finding's code. flexlash explain lists them all.")
    click.echo(f"{found.code} {found.level}: {found.title}\n\n{found.explanation}\n\nMend: {_generally(found.fix)}")


def _generally(fix: str) -> str:
    """Return a mend without a cell at hand."""
    return fix.format(label="the header of the template", unit="the template's unit", dimension="the dimension")


def _limits(_: click.Context, __: click.Parameter, given: tuple[str, ...]) -> ReadingLimits:
    """Return the limits of reading; raise a usage error for one that does not exist."""
    from flexlash.submission.reading.limits import ReadingLimits

    pairs = {name.strip(): value.strip() for name, _, value in (text.partition("=") for text in given)}
    try:
        return ReadingLimits.of(pairs)
    except ValueError as fault:
        raise click.UsageError(f"--limit: {fault}.") from fault


_SUBMISSIONS = click.argument("submissions", nargs=-1, required=True, type=click.Path(path_type=Path))
_JSON = click.option("--json", "as_json", is_flag=True, help="Machine-readable outcome on stdout.")
_LIMITS = click.option(
    "--limit", "limits", multiple=True, metavar="NAME=NUMBER", envvar="FLEXLASH_LIMIT", callback=_limits,
    help="Read more, or less, of a file than usual: cells=2000000. A refusal names the limit.",
)  # fmt: skip
_STRICT = click.option("--strict", is_flag=True, help="Compute nothing when any row has an error.")


def _table_option(name: str) -> Callable[[Command], Command]:
    return click.option(
        f"--{name}",
        type=click.Path(path_type=Path),
        metavar="FILE.csv",
        help=f"The {name.capitalize()} table to use instead of the submission's.",
    )


@cli.command()
@_SUBMISSIONS
@_STRICT
@_LIMITS
@_JSON
@_table_option("tolerances")
@_table_option("materials")
def check(submissions: tuple[Path, ...], *, as_json: bool, **options: Any) -> None:
    """Validate submissions and print what was found; nothing is sampled or written."""
    from flexlash.submission.read import Reading

    codes: list[int] = []
    for path in submissions:
        with _one_submission(path, codes, as_json=as_json):
            reading = Reading(path, options["limits"])
            # Loading the libraries takes as long as reading the file does: both at once.
            from flexlash.pipeline import check as check_one

            outcome = check_one(reading, **options)
            _tell(outcome, path, as_json=as_json)
            codes += [] if outcome.skipped else [outcome.exit_code]
    sys.exit(_worst(codes))


@cli.command()
@_SUBMISSIONS
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="OUT",
    help="Report (.xlsx), Results alone (.csv, .parquet, .json), or a folder. "
    "Default: <name>-report.xlsx beside the submission.",
)  # fmt: skip
@click.option("--seed", type=click.IntRange(0, 2**32 - 1), help="Start of the random numbers.")
@click.option("--method", type=click.Choice(["line", "sobol", "random"]), help="How the spread is sampled.")
@click.option("--samples", type=click.IntRange(1, 2**22), help="Lines or points per variant.")
@click.option("--cross-check", is_flag=True, help="Put plain Monte Carlo beside the spread and say whether they agree.")
@click.option("--elasticity", is_flag=True, help="Check each variant by two-dimensional elasticity.")
@click.option(
    "--jobs", type=click.IntRange(1), default=os.cpu_count() or 1, show_default="all cores", help="Processes."
)
@_STRICT
@_LIMITS
@_JSON
@click.option("--quiet", is_flag=True, help="Print nothing unless something failed.")
@_table_option("tolerances")
@_table_option("materials")
def run(submissions: tuple[Path, ...], output: Path | None, *, as_json: bool, quiet: bool, **options: Any) -> None:
    """Validate, compute the tolerance spread, write the report."""
    from flexlash.elasticity import MISSING, is_available
    from flexlash.submission.read import Reading

    if options["elasticity"] and not is_available():
        raise click.UsageError(MISSING)
    targets = _targets(submissions, output)
    codes: list[int] = []
    for path, target in zip(submissions, targets, strict=True):
        with _one_submission(path, codes, as_json=as_json), _progress(quiet=quiet or as_json) as progress:
            reading = Reading(path, options["limits"])
            from flexlash.pipeline import run as run_one

            outcome = run_one(reading, target, progress=progress, **options)
            if not quiet or outcome.exit_code:
                _tell(outcome, path, as_json=as_json, ran=True)
            codes += [] if outcome.skipped else [outcome.exit_code]
    sys.exit(_worst(codes))


def _named(path: object) -> str:
    """Return a path as it may be printed: whole, without control characters."""
    return shown(path, longest=4096)


def _worst(codes: list[int]) -> int:
    """Return the most severe exit code; without any submission there was nothing to compute."""
    return min(codes or [NOTHING], key=_SEVERITY.index)


@contextmanager
def _one_submission(path: Path, codes: list[int], *, as_json: bool) -> Iterator[None]:
    """Turn what stops one submission into its exit code, so that the others go on."""
    try:
        yield
    except OSError as fault:
        named = _named(fault.filename or path)
        why = fault.strerror or str(fault)
        click.secho(f"{named} could not be opened or written: {why}", fg="red", err=True)
        if as_json:
            click.echo(json.dumps({"submission": str(path), "error": f"{named}: {why}"}, ensure_ascii=False))
        codes.append(NO_FILE)


@contextmanager
def _progress(*, quiet: bool) -> Iterator[Progress | None]:
    """Yield a callback that draws a progress bar, or None off a terminal."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    with click.progressbar(length=1, label="Computing", file=sys.stderr, show_pos=True) as bar:

        def advance(done: int, total: int) -> None:
            bar.length = total
            bar.update(done - bar.pos)

        yield advance


def _targets(submissions: tuple[Path, ...], output: Path | None) -> list[Path]:
    """Return where each submission's output goes; refuse what would overwrite a submission."""
    from flexlash.report.output import ENDINGS

    if output is None:
        targets = [path.with_name(f"{path.stem}-report.xlsx") for path in submissions]
    elif output.is_dir() or not output.suffix or str(output).endswith(("/", "\\")):
        output.mkdir(parents=True, exist_ok=True)
        targets = [output / f"{path.stem}-report.xlsx" for path in submissions]
    elif len(submissions) > 1:
        raise click.UsageError("Several submissions need a folder as OUT.")
    elif output.suffix.lower() not in ENDINGS:
        raise click.UsageError(f"OUT must end in {', '.join(ENDINGS)} or be a folder, not {shown(output.suffix)}.")
    else:
        targets = [output]
    inputs = {path.resolve() for path in submissions}
    if any(target.resolve() in inputs for target in targets):
        raise click.UsageError("OUT is one of the submissions, which flexlash never overwrites.")
    return _distinct(targets)


def _distinct(targets: list[Path]) -> list[Path]:
    """Give equal names a number: ` (2)`, ` (3)`."""
    used: set[Path] = set()
    found = []
    for target in targets:
        distinct, copy = target, 1
        while distinct in used:
            copy += 1
            distinct = target.with_name(f"{target.stem} ({copy}){target.suffix}")
        used.add(distinct)
        found.append(distinct)
    return found


def _tell(outcome: Outcome, path: Path, *, as_json: bool, ran: bool = False) -> None:
    """Print an outcome: as one JSON object, or findings grouped by rule and then the summary."""
    if as_json:
        click.echo(json.dumps(outcome.as_dictionary(), ensure_ascii=False))
        return
    from flexlash.summary import finding_lines, summary_lines

    colours = {"error": "red", "warning": "yellow", "info": "cyan"}
    for level, line in finding_lines(outcome.findings):
        click.echo(click.style(line, fg=colours[level]) if level else line, err=ran)
    for line in summary_lines(outcome, _named(path), ran=ran):
        click.echo(line)


def main() -> None:
    """Run the command line; never a traceback unless FLEXLASH_DEBUG=1."""
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    if "NO_COLOR" in os.environ:
        cli.context_settings["color"] = False
    try:
        cli.main(standalone_mode=False)
    except click.ClickException as fault:
        fault.show()
        sys.exit(fault.exit_code)
    except (click.Abort, KeyboardInterrupt):
        click.echo("Interrupted.", err=True)
        sys.exit(INTERRUPTED)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        sys.exit(0)
    except OSError as fault:
        named = f"{_named(fault.filename)}: " if fault.filename else ""
        click.secho(f"{named}{fault.strerror or fault}", fg="red", err=True)
        sys.exit(NO_FILE)
    except Exception as fault:  # noqa: BLE001
        if os.environ.get("FLEXLASH_DEBUG") == "1":
            traceback.print_exc()
        click.secho(f"Internal error ({type(fault).__name__}). Set FLEXLASH_DEBUG=1 for details.", fg="red", err=True)
        sys.exit(INTERNAL)
