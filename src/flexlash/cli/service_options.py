"""What `serve` and `watch` share: their options, what is started with them, how each ends where it cannot start."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from flexlash.cli.status_command import STORE
from flexlash.cli.terminal import complain
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.findings import shown

if TYPE_CHECKING:
    from flexlash.service.running import Setup

__all__ = ["of_service", "setup_of", "started_or_why"]

Command = TypeVar("Command", bound=Callable[..., Any])


_UNITS = {"h": 3_600, "d": 86_400, "w": 7 * 86_400, "y": 365 * 86_400}
_DURATION = re.compile(r"([1-9]\d{0,4})([hdwy])")


class _Duration(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """A whole number with a unit, in seconds."""

    name = "TIME"

    def convert(self, value: Any, parameter: click.Parameter | None, context: click.Context | None) -> float:
        """Return seconds; raise a usage error for anything but a number and h, d, w or y."""
        if isinstance(value, float):
            return value
        if not (match := _DURATION.fullmatch(value)):
            self.fail(f"{shown(value)}: a whole number with h, d, w or y is required, such as 90d", parameter, context)
        return float(match[1]) * _UNITS[match[2]]


_PATH = click.Path(path_type=Path)

OUT = click.option("--out", type=_PATH, metavar="FOLDER", help="Where reports of the drop folder go.")
WORKERS = click.option(
    "--workers", type=click.IntRange(1, 512), default=os.cpu_count() or 1, show_default="all cores",
    help="Processes that compute.",
)  # fmt: skip
SCHEDULER = click.option(
    "--scheduler", metavar="ADDRESS", help="Compute on the workers of a Dask scheduler, such as tcp://10.0.0.1:8786."
)
KEEP = click.option(
    "--keep", "keep_seconds", type=_Duration(), default="90d", show_default=True,
    help="How long a submission is kept after it has finished: 12h, 90d, 26w, 2y.",
)  # fmt: skip
WEBHOOK = click.option(
    "--webhook", default="", metavar="URL", help=("Report the end of each submission to this address.")
)
WEBHOOK_KEY = click.option(
    "--webhook-key-file", type=_PATH, metavar="FILE",
    help="The key that signs these reports. Default: webhook.key in the store, made if absent.",
)  # fmt: skip
LOG_JSON = click.option("--json", "as_json", is_flag=True, help="Log lines as JSON.")


def of_service(command: Command) -> Command:
    """Give a command the options that both ways to run the service have."""
    for one in reversed((OUT, STORE, WORKERS, SCHEDULER, KEEP, WEBHOOK, WEBHOOK_KEY, LOG_JSON)):
        command = one(command)
    return command


@contextmanager
def started_or_why() -> Iterator[None]:
    """End the command with a sentence where the service cannot start, or can go on no longer."""
    from flexlash.service.places import PlacesError

    try:
        yield
    except PlacesError as fault:
        complain(str(fault))
        raise SystemExit(ExitCode.NO_FILE) from fault
    except ValueError as fault:
        raise click.UsageError(str(fault)) from fault


def setup_of(
    inbox: Path | None,
    *,
    out: Path | None,
    store: Path | None,
    workers: int,
    scheduler: str | None,
    keep_seconds: float,
    webhook: str,
    webhook_key_file: Path | None,
) -> Setup:
    """Return what the service is started with; raise a usage error for what does not go together."""
    if (inbox is None) != (out is None):
        raise click.UsageError("A drop folder needs both: INBOX and --out FOLDER.")
    if webhook_key_file is not None and not webhook:
        raise click.UsageError("--webhook-key-file is for --webhook URL, which is missing.")
    if scheduler is not None:
        from flexlash.batch.dask_executor import MissingDaskError, require_address

        try:
            require_address(scheduler)
        except (ValueError, MissingDaskError) as fault:
            raise click.UsageError(f"--scheduler: {fault}") from fault
    from flexlash.service.running import Setup
    from flexlash.service.store_place import default_store

    return Setup(
        store=default_store() if store is None else store,
        workers=workers,
        scheduler=scheduler,
        inbox=inbox,
        out=out,
        keep_seconds=keep_seconds,
        webhook=webhook,
        webhook_key_file=webhook_key_file,
    )
