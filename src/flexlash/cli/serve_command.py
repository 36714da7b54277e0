"""`flexlash serve`: the page, and the drop folder where one is given."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexlash.cli.program import keep_window_open
from flexlash.cli.service_options import of_service, setup_of, started_or_why
from flexlash.cli.status_command import require_extra
from flexlash.cli.terminal import named

if TYPE_CHECKING:
    from flexlash.service.running import Service
    from flexlash.service.web.serving import PageServer

__all__ = ["serve"]

_PAGE = ("starlette", "uvicorn", "jinja2", "python_multipart")
_STARTING = 10.0
"""Seconds that a page has to be there once its service has the store."""


@click.command()
@click.argument("inbox", type=click.Path(path_type=Path), required=False, metavar="[INBOX]")
@of_service
@click.option("--host", default="127.0.0.1", show_default=True, metavar="ADDRESS", help="Where the page is reached.")
@click.option(
    "--port", type=click.IntRange(0, 65535), default=8765, show_default=True, help=("Its port; 0: any free port.")
)
@click.option("--open", "opens", is_flag=True, help="Open the page in your browser, and for nobody else.")
@click.option(
    "--token-file", type=click.Path(path_type=Path), metavar="FILE",
    help="Only people who know the token in this file may open the page.",
)  # fmt: skip
@click.option(
    "--behind-proxy", default="", metavar="HEADER",
    help="A proxy on this machine authenticates people and names them in this header, such as X-Remote-User.",
)  # fmt: skip
@click.option(
    "--host-name", "host_names", multiple=True, metavar="NAME", help="A name by which browsers call the page."
)
def serve(inbox: Path | None, *, as_json: bool, **chosen: Any) -> None:
    """Serve the page on which templates are handed in; with INBOX and --out the drop folder as well.

    \b
    Examples:
      flexlash serve --open               the page, for you alone
      flexlash serve inbox --out reports  the page, and a folder to save into
    """  # noqa: D301
    require_extra(*_PAGE)
    who = {name: chosen.pop(name) for name in ("host", "port", "opens", "token_file", "behind_proxy", "host_names")}
    from flexlash.service.web.access import Access, AccessError

    try:
        access = Access.of(**who)
    except AccessError as fault:
        raise click.UsageError(str(fault)) from fault
    setup = setup_of(inbox, **chosen)
    from flexlash.service.log import Log
    from flexlash.service.running import running
    from flexlash.service.running_page import announce_page
    from flexlash.service.web.app import application
    from flexlash.service.web.serving import PageServer
    from flexlash.service.web.visitors import OPENING

    log = Log(as_json=as_json)
    opens_alone = access.once != "" and inbox is None
    with started_or_why(), _or_the_running_one(setup.store, opens=opens_alone), running(setup, log) as service:
        app = application(
            service.store, service.dispatcher, access, service.options_digest, service.started_at, log=log,
            troubles=service.folder.troubles if service.folder else tuple,
        )  # fmt: skip
        server = PageServer(app, access, log)
        announce_page(service.store.folder, f"{server.address.rstrip('/')}{OPENING}" if access.once else server.address)
        _say(server, service, opens=bool(access.once))
        server.run()


@contextmanager
def _or_the_running_one(store: Path, *, opens: bool) -> Iterator[None]:
    """Lead to the page that runs already, as after a second double click; else say where it is."""
    from flexlash.service.running_page import new_key, running_page
    from flexlash.service.store import StoreInUseError
    from flexlash.service.web.serving import open_browser
    from flexlash.service.web.visitors import OPENING

    try:
        yield
    except StoreInUseError as fault:
        folder = store.absolute()
        if not (page := running_page(folder, patience=_STARTING if opens else 0.0)):
            raise
        if not opens:
            raise StoreInUseError(f"{fault}. Its page: {page.removesuffix(OPENING.lstrip('/'))}") from None
        opening = f"{page}{new_key(folder)}" if page.endswith(OPENING) else page
        click.echo(f"flexlash runs already.\nPage:  {opening}")
        if not open_browser(opening, folder):
            keep_window_open(failed=True)


def _say(server: PageServer, service: Service, *, opens: bool) -> None:
    """Say where everything is, and open the page where that is wanted."""
    click.echo(f"Page:  {server.opening}")
    if service.places is not None:
        click.echo(f"INBOX: {named(service.places.inbox.absolute())}\nOUT:   {named(service.places.out.absolute())}")
    click.echo(f"Store: {named(service.store.folder)}\nCtrl-C ends the service.")
    if opens:
        from flexlash.service.web.serving import open_browser

        open_browser(server.opening, service.store.folder)
