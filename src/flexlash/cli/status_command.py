"""`flexlash status` and `flexlash retry`: what the service holds, whether or not a server works on it."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import click

from flexlash.cli.click_types import JSON
from flexlash.cli.terminal import complain, print_json
from flexlash.schema.exit_codes import ExitCode
from flexlash.schema.findings import shown

if TYPE_CHECKING:
    from flexlash.service.outbox import Outbox

__all__ = ["STORE", "require_extra", "retry", "status"]

_NEEDED = ("filelock", "platformdirs")

STORE = click.option(
    "--store", type=click.Path(path_type=Path), metavar="FOLDER",
    help="Where submissions and results are kept. Default: your data folder.",
)  # fmt: skip


def require_extra(*further: str) -> None:
    """Raise a usage error where a library of the service is missing, or one of these further ones."""
    if any(find_spec(name) is None for name in (*_NEEDED, *further)):
        raise click.UsageError("The service needs the extra of this name: pip install 'flexlash[service]'.")


@click.command()
@click.argument("id_", metavar="[ID]", required=False, default="")
@STORE
@click.option(
    "--backup", type=click.Path(path_type=Path, file_okay=False), metavar="FOLDER",
    help="First copy the store into FOLDER, even while a server is working on it. The copy is a store itself.",
)  # fmt: skip
@JSON
def status(id_: str, store: Path | None, *, backup: Path | None, as_json: bool) -> None:
    """Say what the service holds: all of it in short, or the submission ID with all that happened to it.

    The first letters of an ID are enough. The exit code is 2 for an ID that is not known, 5 where there is no store, it
    cannot be read, or files in it are found damaged while they are backed up.
    """
    with _opened(store) as held:
        damaged = backup is not None and not _backed_up(held, backup, as_json=as_json)
        from flexlash.cli.status_lines import all_lines, everything, one, one_lines

        if id_:
            facts, lines = one(held, _known(held, id_)), one_lines
        else:
            facts, lines = everything(held), all_lines
    if as_json:
        print_json(facts)
    else:
        for line in lines(facts):
            click.echo(line)
    if damaged:
        sys.exit(ExitCode.NO_FILE)


@click.command()
@click.argument("id_", metavar="ID")
@STORE
def retry(id_: str, store: Path | None) -> None:
    """Have the submission ID computed anew, by the server that works on the store or by the next.

    The first letters of an ID are enough. The exit code is 2 for an ID that is not known, 5 where there is no store or
    it cannot be written.
    """
    with _opened(store) as held:
        found = held.submission(_known(held, id_))
    if found is None or not found.has_ended:
        click.echo(f"{id_} has not finished yet; it will be computed in turn.")
        return
    from flexlash.service.database import store_faults
    from flexlash.service.store import Store

    with store_faults(held.folder), Store(held.folder, serving=False) as writable:
        writable.retry(found.id)
        served = writable.is_served()
    click.echo(f"{shown(found.name)} is computed anew{'' if served else ' as soon as flexlash serve or watch runs'}.")


@contextmanager
def _opened(folder: Path | None) -> Iterator[Outbox]:
    """Open a store to read it; raise a usage error where a library of the service is missing."""
    require_extra()
    from flexlash.service.outbox import Outbox
    from flexlash.service.store_place import default_store

    with Outbox.opened(folder or default_store()) as held:
        yield held


def _known(held: Outbox, start: str) -> str:
    """Return the ID that begins so; raise a usage error where there is none or there are several."""
    found = held.begun_with(start.lower())
    if len(found) == 1:
        return found[0]
    if found:
        raise click.UsageError(f"Several IDs begin with {shown(start)}; give more of it.")
    if held.was_forgotten(start):
        raise click.UsageError(f"The submission {shown(start)} was kept as long as set, and has been deleted.")
    raise click.UsageError(f"There is no submission {shown(start)}; flexlash status lists those that there are.")


def _backed_up(held: Outbox, folder: Path, *, as_json: bool) -> bool:
    """Copy the store, say so, and return whether all of it was whole."""
    from flexlash.service.backup import back_up

    done = back_up(held, folder)
    click.echo(
        f"{done.copied} files copied into {shown(done.folder, 4096)}, {done.copied_before} were there.", err=as_json
    )
    for sha256 in done.damaged:
        complain(f"The kept file {sha256} is damaged or gone and could not be copied: retry what it belongs to.")
    return not done.damaged
