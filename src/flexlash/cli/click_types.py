"""Arguments and options that several commands take, and the usage error for an output that cannot be meant."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from flexlash.schema.findings import shown

if TYPE_CHECKING:
    from flexlash.reading.reading_limits import ReadingLimits

__all__ = ["JSON", "LIMITS", "MARKED", "QUIET", "STRICT", "SUBMISSIONS", "planned", "table_option"]

Command = Callable[..., None]
Planned = TypeVar("Planned")


def planned(plan: Callable[..., Planned], *paths: Any, **options: bool) -> Planned:
    """Return where outputs go; raise a usage error for an output that cannot be meant."""
    try:
        return plan(*paths, **options)
    except ValueError as fault:
        raise click.UsageError(shown(fault, longest=400)) from fault


def _limits(context: click.Context, parameter: click.Parameter, given: tuple[str, ...]) -> ReadingLimits:
    """Return the limits of reading; raise a usage error for one that does not exist, with where it was set."""
    from click.core import ParameterSource

    from flexlash.reading.reading_limits import ReadingLimits

    pairs = {name.strip(): value.strip() for name, _, value in (text.partition("=") for text in given)}
    try:
        return ReadingLimits.of(pairs)
    except ValueError as fault:
        in_environment = context.get_parameter_source(parameter.name or "") is ParameterSource.ENVIRONMENT
        where = "The environment variable FLEXLASH_LIMIT" if in_environment else "--limit"
        raise click.UsageError(f"{where}: {fault}.") from fault


SUBMISSIONS = click.argument("submissions", nargs=-1, required=True, type=click.Path(path_type=Path, readable=False))
JSON = click.option("--json", "as_json", is_flag=True, help="Machine-readable outcome on stdout.")
LIMITS = click.option(
    "--limit", "limits", multiple=True, metavar="NAME=NUMBER", envvar="FLEXLASH_LIMIT", callback=_limits,
    help="Read more, or less, of a file than usual: cells=2000000. A refusal names the limit.",
)  # fmt: skip
MARKED = click.option(
    "--marked-copies", is_flag=True, help="Take marked copies (<name>-checked.xlsx) as submissions, too."
)
QUIET = click.option("--quiet", is_flag=True, help="Print nothing unless something failed.")
STRICT = click.option("--strict/--no-strict", default=None, help="Compute nothing when any row has an error.")


def table_option(name: str) -> Callable[[Command], Command]:
    """Return the option that names a table to use instead of the submission's."""
    return click.option(
        f"--{name}",
        type=click.Path(path_type=Path, readable=False),
        metavar="FILE.csv",
        help=f"The {name.capitalize()} table to use instead of the submission's.",
    )
