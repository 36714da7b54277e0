"""Arguments and options that several commands take, and the usage error for an output that cannot be meant."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

import click

from flexlash.analysis.options import Options
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.schema import argument_checks
from flexlash.schema.findings import shown

__all__ = [
    "JSON",
    "LIMITS",
    "QUIET",
    "RECURSIVE",
    "SUBMISSION",
    "SUBMISSIONS",
    "VERBOSE",
    "option",
    "planned",
    "spread_options",
]

Command = Callable[..., None]
Planned = TypeVar("Planned")


def planned(plan: Callable[..., Planned], *paths: Any, **options: Any) -> Planned:
    """Return where outputs go; raise a usage error for an output that cannot be meant."""
    try:
        return plan(*paths, **options)
    except ValueError as fault:
        raise click.UsageError(shown(fault, longest=400)) from fault


def _limits(context: click.Context, parameter: click.Parameter, given: tuple[str, ...]) -> ReadingLimits:
    """Return the limits of reading; raise a usage error for one that does not exist, with where it was set."""
    from click.core import ParameterSource

    pairs = {name.strip(): value.strip() for name, _, value in (text.partition("=") for text in given)}
    try:
        return ReadingLimits.of(pairs)
    except ValueError as fault:
        in_environment = context.get_parameter_source(parameter.name or "") is ParameterSource.ENVIRONMENT
        where = "The environment variable FLEXLASH_LIMIT" if in_environment else "--limit"
        raise click.UsageError(f"{where}: {fault}.") from fault


class _Named(click.Path):
    """A path that is named: an empty text, as of a variable that is not set, would be the present folder."""

    def convert(self, value: Any, parameter: click.Parameter | None, context: click.Context | None) -> Any:
        """Return the path; raise a usage error for an empty text."""
        return super().convert(value, parameter, context) if value else self.fail("a name is empty", parameter, context)


SUBMISSION = click.argument("submission", type=_Named(path_type=Path, readable=False))
SUBMISSIONS = click.argument("submissions", nargs=-1, required=True, type=_Named(path_type=Path, readable=False))
JSON = click.option("--json", "as_json", is_flag=True, help="Machine-readable outcome on stdout.")
QUIET = click.option("--quiet", is_flag=True, help="Print nothing unless something fails.")
VERBOSE = click.option(
    "-v",
    "--verbose",
    is_flag=True,
    help=("With several submissions, print for each what is printed for one, not just a line."),
)
RECURSIVE = click.option("--recursive", is_flag=True, help="Also look in the folders below a folder.")

_DECLARED = {one.name: one for one in fields(Options)}


def option(name: str, **shown: Any) -> Callable[[Command], Command]:
    """Return the command line's form of a declared option; `shown` is what only the command line knows of it."""
    declared = _DECLARED[name]
    flag, check = f"--{name.replace('_', '-')}", declared.metadata["check"]
    how: dict[str, Any] = {"help": declared.metadata["help"]}
    if check is argument_checks.flag:
        if declared.default is None:
            flag, how["default"] = f"{flag}/--no-{flag[2:]}", None
        else:
            how["is_flag"] = True
    elif check is argument_checks.file_path:
        how |= {"type": click.Path(path_type=Path, readable=False), "metavar": "FILE.csv"}
    elif check.func is argument_checks.one_of:
        how["type"] = click.Choice(check.keywords["choices"])
    elif check.func is argument_checks.whole_number:
        how["type"] = click.IntRange(check.keywords["least"], check.keywords.get("most"))
    elif check.func is argument_checks.number_within:
        how["type"] = click.FloatRange(check.keywords["least"], check.keywords["most"])
    return click.option(flag, name, **how | shown)


LIMITS = click.option(
    "--limit", "limits", multiple=True, metavar="NAME=NUMBER", envvar="FLEXLASH_LIMIT", callback=_limits,
    help=_DECLARED["limits"].metadata["help"],
)  # fmt: skip


def spread_options(command: Command) -> Command:
    """Return a command of one submission with the options of its spread, its reading and its tables."""
    jobs = option("jobs", default=os.cpu_count() or 1, show_default="all cores")
    tables = map(option, ("tolerances", "materials", "measurements", "correlations", "other_sources"))
    every: list[Callable[[Command], Command]] = [
        *map(option, ("seed", "method", "samples", "target_percent")),
        jobs,
        LIMITS,
        JSON,
        QUIET,
        *tables,
    ]
    for one in reversed(every):
        command = one(command)
    return command
