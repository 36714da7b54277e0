"""The command line: the group of commands, and how each of them ends. Commands alone print and know exit codes."""

from __future__ import annotations

import os
import sys
import traceback

import click

from flexlash import __version__
from flexlash.commands.check import check
from flexlash.commands.diff import diff
from flexlash.commands.reference import explain, schema
from flexlash.commands.run import run
from flexlash.commands.template import template
from flexlash.terminal import INTERNAL, INTERRUPTED, NO_FILE, named, reason

__all__ = ["cli", "main"]


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


for _command in (template, check, run, diff, schema, explain):
    cli.add_command(_command)


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
        click.secho(f"{place}{reason(fault)}", fg="red", err=True)
        sys.exit(NO_FILE)
    except Exception as fault:  # noqa: BLE001
        if os.environ.get("FLEXLASH_DEBUG") == "1":
            traceback.print_exc()
        click.secho(f"Internal error ({type(fault).__name__}). Set FLEXLASH_DEBUG=1 for details.", fg="red", err=True)
        sys.exit(INTERNAL)
