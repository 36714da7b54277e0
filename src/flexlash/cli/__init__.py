"""The command line: the group of commands, and how each of them ends. Commands alone print and know exit codes."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from flexlash import __version__
from flexlash.cli.check_command import check
from flexlash.cli.diff_command import diff
from flexlash.cli.distribution_command import distribution
from flexlash.cli.levers_command import levers
from flexlash.cli.program import command_given, keep_window_open
from flexlash.cli.reference_commands import explain, schema
from flexlash.cli.run_command import run
from flexlash.cli.serve_command import serve
from flexlash.cli.status_command import retry, status
from flexlash.cli.streams import lost_output, patient_streams
from flexlash.cli.sweep_command import sweep
from flexlash.cli.template_command import template
from flexlash.cli.terminal import colour, complain, internal_error, named
from flexlash.cli.watch_command import watch
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.file_faults import reason

__all__ = ["cli", "main"]


class _Commands(click.Group):
    """The commands by name; a file in the place of one is a slip that has its own answer."""

    def resolve_command(self, context: click.Context, given: list[str]) -> Any:
        """Return what click does; where there is no such command but a file, say how it is computed."""
        if given and given[0] not in self.commands and Path(given[0]).exists():
            quoted = f'"{given[0]}"' if " " in given[0] else given[0]
            raise click.UsageError(f"{named(given[0])} is a file, not a command. To compute it: flexlash run {quoted}")
        return super().resolve_command(context, given)


@click.group(
    cls=_Commands,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Exit codes of run and check: 0 every row fine, 3 some rows had errors, 4 nothing computable or no "
    "readable submission, 5 a file could not be opened or written, 6 a variant does not meet its limit (with "
    "--fail-over-limit), 2 usage, 1 internal error. Of several submissions the most severe: 1, 5, 4, 3, 6.",
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
      flexlash run folder -o reports         all submissions of a folder
      flexlash levers variants.xlsx          which single change meets the limit
      flexlash sweep study.xlsx --vary cylinder_length_mm=100:200:20
      flexlash distribution variants.xlsx -o units.parquet
      flexlash diff old.xlsx new.xlsx        what changed between two reports or submissions
      flexlash serve --open                  a page to hand templates in
    """  # noqa: D301


for _command in (template, check, run, levers, sweep, distribution, diff, serve, watch, schema, explain, status, retry):
    cli.add_command(_command)


def main() -> None:
    """Run the command line; never a traceback unless FLEXLASH_DEBUG=1."""
    cli.context_settings["color"] = colour()
    with patient_streams():
        code = _ended()
        if lost := lost_output():
            complain(f"Standard output could not be written: {reason(lost)}.")
            code = code or ExitCode.NO_FILE
        keep_window_open(failed=bool(code))
    sys.exit(code)


def _ended() -> int:
    """Run the command and return its exit code."""
    try:
        return int(cli.main(command_given(), standalone_mode=False) or ExitCode.FINE)
    except SystemExit as stop:
        return int(stop.code or ExitCode.FINE)
    except click.ClickException as fault:
        fault.show()
        return fault.exit_code
    except (click.Abort, KeyboardInterrupt):
        click.echo("Interrupted.", err=True)
        return ExitCode.INTERRUPTED
    except OSError as fault:
        complain(f"{f'{named(fault.filename)}: ' if fault.filename else ''}{reason(fault)}")
        return ExitCode.NO_FILE
    except Exception as fault:  # noqa: BLE001
        complain(internal_error(fault))
        return ExitCode.INTERNAL
