"""`flexlash watch`: the drop folder without the page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from flexlash.cli.service_options import of_service, setup_of, started_or_why
from flexlash.cli.status_command import require_extra

__all__ = ["watch"]

_LOOKING = 0.5
"""Seconds after which `--once` looks again whether all is done."""


@click.command()
@click.argument("inbox", type=click.Path(path_type=Path))
@of_service
@click.option("--once", is_flag=True, help="End when all that lies in INBOX is done.")
def watch(inbox: Path, *, once: bool, as_json: bool, **chosen: Any) -> None:
    """Compute what is saved into the folder INBOX, and put what became of it into OUT.

    What is not readable or has errors comes back with the reasons and its cells marked. Originals go to OUT/done or
    OUT/rejected; nothing is deleted. Ctrl-C ends it; what was at work is done after the next start.
    """
    require_extra()
    if chosen["out"] is None:
        raise click.UsageError("watch needs --out FOLDER, where reports go.")
    setup = setup_of(inbox, **chosen)
    from flexlash.service.log import Log
    from flexlash.service.running import running, stopped_by_signals

    with started_or_why(), stopped_by_signals() as stopped, running(setup, Log(as_json=as_json)) as service:
        while not stopped.wait(_LOOKING):
            if once and service.folder is not None and service.folder.is_idle:
                break
