"""The command line: the only place that prints and that knows exit codes."""

from __future__ import annotations

import json
import os
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from flexlash import __version__
from flexlash.findings import CATALOGUE, finding, shown
from flexlash.targets import beside, mended_targets, report_targets, template_target
from flexlash.terminal import (
    INTERNAL,
    INTERRUPTED,
    NO_FILE,
    NOTHING,
    named,
    one_submission,
    progress,
    tell,
    tell_refused,
    worst,
)

if TYPE_CHECKING:
    from flexlash.submission.mending.repair import Repair
    from flexlash.submission.reading.limits import ReadingLimits

__all__ = ["cli", "main"]

Command = Callable[..., None]
Planned = TypeVar("Planned")


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
      flexlash diff old.xlsx new.xlsx        what changed between two reports or submissions
    """  # noqa: D301


@cli.command()
@click.option(
    "-o", "--output", type=click.Path(dir_okay=False, path_type=Path), metavar="FILE.xlsx",
    help="Where to write it. Default: flexlash-template.xlsx; with --upgrade OLD-v2.xlsx beside OLD.",
)  # fmt: skip
@click.option("--example", is_flag=True, help="Fill it with the published B3-160 study.")
@click.option(
    "--upgrade", "old", type=click.Path(dir_okay=False, path_type=Path), metavar="OLD",
    help="Fill it with everything of an older template, or of a table (.csv, .parquet).",
)  # fmt: skip
@click.option("--force", is_flag=True, help="Replace an existing file.")
def template(output: Path | None, *, example: bool, old: Path | None, force: bool) -> None:
    """Write the Excel template that submissions are made from."""
    if example and old:
        raise click.UsageError("--example and --upgrade both fill the template; choose one.")
    target = _planned(template_target, output, old, force=force)
    from flexlash.report.output import write_bytes
    from flexlash.submission.templating.template import study, template_bytes

    if old:
        written = write_bytes(_upgraded(old), target)
    else:
        written = write_bytes(template_bytes(study() if example else None), target)
    click.echo(f"Template written: {named(written)}")
    follow = "Look it over, then: flexlash check" if old else "Fill it in, then: flexlash run"
    click.echo(f"{follow} {named(written)}", err=True)


def _upgraded(old: Path) -> bytes:
    """Return a new template filled with what an old file holds, and say what it could not hold."""
    from flexlash.submission.reading.refusal import Refusal
    from flexlash.submission.templating.upgrade import upgraded

    try:
        upgrade = upgraded(old)
    except Refusal as refusal:
        facts: dict[str, Any] = {"file": old.name, **refusal.facts}
        found = finding(refusal.code, **facts)
        tell_refused(found, old.name)
        sys.exit(NOTHING)
    made = f", made from template version {upgrade.version}" if upgrade.version else ""
    click.echo(f"{named(old)}{made}: {upgrade.rows} {'row' if upgrade.rows == 1 else 'rows'} of Variants carried over.")
    for remark in upgrade.remarks:
        click.echo(f"  {shown(remark, longest=400)}", err=True)
    return upgrade.data


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
    wanted = code.strip().upper()
    meant = [known for known in CATALOGUE if wanted in {known, known[1:]}]
    if len(meant) != 1:
        raise click.UsageError(f"{shown(code)} is not a finding's code. flexlash explain lists them all.")
    from flexlash.explanations import explanation_of

    for line in explanation_of(meant[0]).lines():
        click.echo(line)


def _limits(_: click.Context, __: click.Parameter, given: tuple[str, ...]) -> ReadingLimits:
    """Return the limits of reading; raise a usage error for one that does not exist."""
    from flexlash.submission.reading.limits import ReadingLimits

    pairs = {name.strip(): value.strip() for name, _, value in (text.partition("=") for text in given)}
    try:
        return ReadingLimits.of(pairs)
    except ValueError as fault:
        raise click.UsageError(f"--limit: {fault}.") from fault


_SUBMISSIONS = click.argument("submissions", nargs=-1, required=True, type=click.Path(path_type=Path, readable=False))
_JSON = click.option("--json", "as_json", is_flag=True, help="Machine-readable outcome on stdout.")
_LIMITS = click.option(
    "--limit", "limits", multiple=True, metavar="NAME=NUMBER", envvar="FLEXLASH_LIMIT", callback=_limits,
    help="Read more, or less, of a file than usual: cells=2000000. A refusal names the limit.",
)  # fmt: skip
_MARKED = click.option(
    "--marked-copies", is_flag=True, help="Take marked copies (<name>-checked.xlsx) as submissions, too."
)
_STRICT = click.option("--strict/--no-strict", default=None, help="Compute nothing when any row has an error.")


def _table_option(name: str) -> Callable[[Command], Command]:
    return click.option(
        f"--{name}",
        type=click.Path(path_type=Path, readable=False),
        metavar="FILE.csv",
        help=f"The {name.capitalize()} table to use instead of the submission's.",
    )


@cli.command()
@_SUBMISSIONS
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="OUT",
    help="The mended file, or the folder for marked and mended files. Default: beside the submission.",
)  # fmt: skip
@click.option("--annotate", is_flag=True, help="Write <name>-checked.xlsx: your file with the cells to mend marked.")
@click.option("--apply-fixes", is_flag=True, help="Write a new file in which the certain suggestions are applied.")
@_STRICT
@_LIMITS
@_MARKED
@_JSON
@_table_option("tolerances")
@_table_option("materials")
def check(
    submissions: tuple[Path, ...],
    output: Path | None,
    *,
    annotate: bool,
    apply_fixes: bool,
    as_json: bool,
    **options: Any,
) -> None:
    """Validate submissions and print what was found; nothing is sampled.

    Nothing is written without --annotate or --apply-fixes.
    """
    from flexlash.submission.reading.read import Reading

    if output and not (annotate or apply_fixes):
        raise click.UsageError("-o needs --apply-fixes or --annotate; check alone writes nothing.")
    targets = _planned(mended_targets, submissions, output)
    copies = beside(submissions, targets)
    if output in targets and not apply_fixes:
        copies = targets
        if output.suffix.lower() != ".xlsx":
            raise click.UsageError("A marked copy is a workbook: OUT must end in .xlsx or be a folder.")
    options["marked_copies"] |= annotate
    codes: list[int] = []
    for path, target, copy in zip(submissions, targets, copies, strict=True):
        with one_submission(path, codes, as_json=as_json):
            reading = Reading(path, options["limits"])
            # Loading the libraries takes as long as reading the file does: both at once.
            from flexlash.pipeline import check as check_one
            from flexlash.pipeline import mend

            repairs: list[Repair] | None = None
            if apply_fixes:
                outcome, repairs = mend(reading, target, marked_copy=copy if annotate else None, **options)
            else:
                outcome = check_one(reading, marked_copy=copy if annotate else None, **options)
            tell(outcome, outcome.outputs[0] if repairs else path, as_json=as_json, repairs=repairs)
            codes += [] if outcome.skipped else [outcome.exit_code]
    sys.exit(worst(codes))


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
@click.option(
    "--cross-check/--no-cross-check", default=None,
    help="Put plain Monte Carlo beside the spread and say whether they agree.",
)  # fmt: skip
@click.option("--elasticity/--no-elasticity", default=None, help="Check each variant by two-dimensional elasticity.")
@click.option(
    "--jobs", type=click.IntRange(1), default=os.cpu_count() or 1, show_default="all cores", help="Processes."
)
@_STRICT
@_LIMITS
@_JSON
@click.option(
    "--from-report", is_flag=True,
    help="The files are reports: write the submission that each carries and compute it anew, with its own options.",
)  # fmt: skip
@click.option("--quiet", is_flag=True, help="Print nothing unless something failed.")
@click.option(
    "--annotate/--no-annotate", default=True, show_default=True,
    help="Write <name>-checked.xlsx, your file with the cells to mend marked, when there are errors or warnings.",
)  # fmt: skip
@_MARKED
@_table_option("tolerances")
@_table_option("materials")
def run(
    submissions: tuple[Path, ...],
    output: Path | None,
    *,
    annotate: bool,
    from_report: bool,
    as_json: bool,
    quiet: bool,
    **options: Any,
) -> None:
    """Validate, compute the tolerance spread, write the report."""
    from flexlash.elasticity import MISSING, is_available
    from flexlash.submission.reading.read import Reading

    if options["elasticity"] and not is_available():
        raise click.UsageError(MISSING)
    targets = _planned(report_targets, submissions, output)
    if from_report:
        from flexlash.commands import recreate_all

        sys.exit(worst(recreate_all(submissions, output, as_json=as_json, quiet=quiet, **options)))
    codes: list[int] = []
    for path, target, copy in zip(submissions, targets, beside(submissions, targets), strict=True):
        with one_submission(path, codes, as_json=as_json), progress(quiet=quiet or as_json) as advance:
            reading = Reading(path, options["limits"])
            from flexlash.pipeline import run as run_one

            options["marked_copy"] = copy if annotate else None
            outcome = run_one(reading, target, progress=advance, **options)
            if not quiet or outcome.exit_code:
                tell(outcome, path, as_json=as_json, ran=True)
            codes += [] if outcome.skipped else [outcome.exit_code]
    sys.exit(worst(codes))


@cli.command()
@click.argument("old", metavar="A", type=click.Path(path_type=Path, readable=False))
@click.argument("new", metavar="B", type=click.Path(path_type=Path, readable=False))
@click.option(
    "--tolerance", type=click.FloatRange(0, 1), default=1e-12, show_default=True, metavar="RELATIVE",
    help="Numbers of Results that differ by no more than this part of themselves are equal.",
)  # fmt: skip
@click.option("--all", "every", is_flag=True, help="Tell every column of Results and every variant.")
@_LIMITS
@_JSON
def diff(old: Path, new: Path, *, tolerance: float, every: bool, limits: ReadingLimits, as_json: bool) -> None:
    """Say what differs between A and B, reports or submissions: inputs and, of two reports, results.

    The exit code is 0 whether or not they differ.
    """
    from flexlash.commands import compare

    sys.exit(compare(old, new, tolerance=tolerance, every=every, limits=limits, as_json=as_json))


def _planned(plan: Callable[..., Planned], *paths: Any, **options: bool) -> Planned:
    """Return where outputs go; raise a usage error for an output that cannot be meant."""
    try:
        return plan(*paths, **options)
    except ValueError as fault:
        raise click.UsageError(shown(fault, longest=400)) from fault


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
        place = f"{named(fault.filename)}: " if fault.filename else ""
        click.secho(f"{place}{fault.strerror or fault}", fg="red", err=True)
        sys.exit(NO_FILE)
    except Exception as fault:  # noqa: BLE001
        if os.environ.get("FLEXLASH_DEBUG") == "1":
            traceback.print_exc()
        click.secho(f"Internal error ({type(fault).__name__}). Set FLEXLASH_DEBUG=1 for details.", fg="red", err=True)
        sys.exit(INTERNAL)
