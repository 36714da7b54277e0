"""The page on an address: Uvicorn, with an end to every connection, and signals left to whoever runs it."""

from __future__ import annotations

import contextlib
import errno
import logging
import os
import signal
import socket
import sys
import threading
import webbrowser
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

import uvicorn
from starlette.applications import Starlette

from flexlash.outputs.writing import temporary
from flexlash.service.log import Log
from flexlash.service.web.access import Access
from flexlash.service.web.connections import Connection
from flexlash.service.web.visitors import OPENING

__all__ = ["AddressError", "PageServer", "open_browser"]

_MOST_HEADER_BYTES = 32 * 1024
_KEEP_ALIVE, _GRACE = 5, 4
"""Seconds that an idle connection is kept, and that answers may take once the server ends."""

_SIGNALS = [one for one in (signal.SIGINT, signal.SIGTERM, getattr(signal, "SIGBREAK", None)) if one is not None]


class AddressError(OSError):
    """The address of the page cannot be had; the message says why."""


class PageServer(uvicorn.Server):
    """The page at its address, taken at once, answered from `run` on."""

    def __init__(self, app: Starlette, access: Access, log: Log) -> None:
        """Take the address; raise AddressError where it cannot be had."""
        self._socket = _bound(access)
        port = self._socket.getsockname()[1]
        self.address = access.address(port)
        self.opening = f"{self.address.rstrip('/')}{OPENING}{access.once}" if access.once else self.address
        _into(log)
        super().__init__(
            uvicorn.Config(
                app,
                http=Connection,
                ws="none",
                loop="asyncio",
                interface="asgi3",
                lifespan="off",
                log_config=None,
                access_log=False,
                proxy_headers=False,
                server_header=False,
                timeout_keep_alive=_KEEP_ALIVE,
                timeout_graceful_shutdown=_GRACE,
                h11_max_incomplete_event_size=_MOST_HEADER_BYTES,
            )
        )

    def run(self, sockets: list[socket.socket] | None = None) -> int | None:  # type: ignore[override]
        """Answer until `stop` or a signal, and return the signal; what is being answered gets four seconds more."""
        super().run([self._socket, *(sockets or [])])
        return self._captured_signals[0] if self._captured_signals else None

    def stop(self) -> None:
        """Answer nothing more; may be called by any thread."""
        self.should_exit = True

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """End by a signal in good order: Uvicorn would raise it once more, before anybody could tidy up."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        before = {one: signal.signal(one, self._signalled) for one in _SIGNALS}
        try:
            yield
        finally:
            for one, handler in before.items():
                signal.signal(one, handler)

    def _signalled(self, number: int, frame: FrameType | None) -> None:
        self.handle_exit(number, frame)


def _bound(access: Access) -> socket.socket:
    """Return a socket at the address, on which connections wait already."""
    place = f"{access.host} port {access.port}"
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            access.host, access.port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        bound = socket.socket(family, kind, protocol)
        try:
            if os.name == "posix":
                bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            elif exclusive := getattr(socket, "SO_EXCLUSIVEADDRUSE", None):
                bound.setsockopt(socket.SOL_SOCKET, exclusive, 1)
            bound.bind(address)
            bound.listen(128)
        except BaseException:
            bound.close()
            raise
    except OSError as fault:
        if fault.errno == errno.EADDRINUSE:
            raise AddressError(
                f"another program answers at {place}: stop it, or choose another with --port N"
            ) from None
        raise AddressError(f"the page cannot be had at {place}: {fault.strerror or fault}") from None
    return bound


class _Lines(logging.Handler):
    """Hands what libraries say over to the log of the service, without the trace of an exception."""

    def __init__(self, log: Log) -> None:
        super().__init__(logging.WARNING)
        self._log = log

    def emit(self, record: logging.LogRecord) -> None:
        self._log.say("server", what=record.getMessage())


def _into(log: Log) -> None:
    for name in ("uvicorn.error", "asyncio", "python_multipart"):
        logger = logging.getLogger(name)
        logger.handlers, logger.propagate = [_Lines(log)], False


def open_browser(address: str, folder: Path) -> bool:
    """Open an address in the user's browser; return whether one could be started.

    The address may hold a token, and every user of this machine can see the arguments of a program: so the browser is
    given a file, which its owner alone may read, that leads to the address.
    """
    page = f'<!doctype html><meta http-equiv="refresh" content="0;url={address}"><title>flexlash</title>'
    path = folder / ".open.html"
    with temporary(folder, lambda file: file.write(page.encode())) as made:
        made.chmod(0o600)
        made.replace(path)
    with _libraries_of_the_system():
        return webbrowser.open(path.absolute().as_uri())


@contextlib.contextmanager
def _libraries_of_the_system() -> Iterator[None]:
    """Have another program find the system's libraries, where the program without Python has put its own before them.

    What the variable held before is kept by PyInstaller under the second name.
    """
    own, before = (os.environ.get(name) for name in ("LD_LIBRARY_PATH", "LD_LIBRARY_PATH_ORIG"))
    if own is None or not getattr(sys, "frozen", False):
        yield
        return
    os.environ.pop("LD_LIBRARY_PATH")
    if before is not None:
        os.environ["LD_LIBRARY_PATH"] = before
    try:
        yield
    finally:
        os.environ["LD_LIBRARY_PATH"] = own
