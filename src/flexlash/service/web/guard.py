"""Before and after every request: who is let in, how long and large it may be, what each answer says to a browser."""

from __future__ import annotations

import asyncio
import sqlite3
from collections.abc import Mapping

from starlette.datastructures import MutableHeaders
from starlette.requests import ClientDisconnect, Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from flexlash.schema.findings import readable
from flexlash.service.web.answer_headers import HEADERS
from flexlash.service.web.refusals import Refused, full_or_busy
from flexlash.service.web.site import Site
from flexlash.service.web.visitors import OPENING, Visitors

__all__ = ["Guard"]

_UPLOADS = "/submissions"
_QUIET = 400
"""Answers from this status on are written into the log, as is whatever changes something."""


class Guard:
    """Stands around the whole application."""

    def __init__(self, app: ASGIApp, site: Site, visitors: Visitors) -> None:
        self._app = app
        self._site = site
        self._visitors = visitors
        self._running = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a request in, or answer why not; nothing but a request is known here."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
        elif scope["type"] == "http":
            self._running += 1
            try:
                await self._answered(scope, receive, send)
            finally:
                self._running -= 1
        else:
            await send({"type": "websocket.close", "code": 1000})

    async def _answered(self, scope: Scope, receive: Receive, send: Send) -> None:
        request, answer = Request(scope), _Answer(send, self._site.limits.idle_seconds)
        body = _Body(receive, self._site.limits.idle_seconds, self._site.limits.body_seconds)
        scope["state"] = {**scope.get("state", {}), "sender": "", "session": ""}
        try:
            scope["state"].update(self._let_in(request))
            await self._app(scope, body.receive, answer.send)
        except ClientDisconnect:
            pass
        except Exception as fault:
            refused = self._refusal(request, fault)
            if not answer.status:
                await self._site.refusal(request, refused)(scope, receive, answer.send)
            else:
                raise
        finally:
            self._note(request, answer.status)

    def _let_in(self, request: Request) -> Mapping[str, str]:
        """Return what is known of who asks; raise Refused where they are not let in."""
        known = self._visitors.let_in(request)
        if self._running > self._site.limits.requests:
            raise Refused(503)
        if "transfer-encoding" in request.headers and "content-length" in request.headers:
            # A proxy may see another end of such a request than we do, and take what follows for somebody else's.
            raise Refused(400, headers={"Connection": "close"})
        limits = self._site.limits
        length = request.headers.get("content-length", "0")
        if not length.isdecimal() or int(length[:20]) > (
            limits.body if request.scope["path"] == _UPLOADS else limits.form
        ):
            raise Refused(413)
        return known

    def _refusal(self, request: Request, fault: Exception) -> Refused:
        """Return a fault as a refusal; one of the program is written down."""
        if isinstance(fault, Refused):
            return fault
        if isinstance(fault, OSError | sqlite3.OperationalError):
            self._site.log.say("fault", what=_asked(request), why=readable(fault))
            return full_or_busy(fault)
        words = f"{type(fault).__name__}: {readable(fault)}"
        self._site.log.say("internal error", what=_asked(request), why=words)
        return Refused(500)

    def _note(self, request: Request, status: int) -> None:
        """Write down what changed something, or was refused."""
        if request.method in {"GET", "HEAD"} and status < _QUIET:
            return
        sender = request.scope["state"]["sender"]
        who = {"sender": sender} if sender else {}
        self._site.log.say("request", what=_asked(request), status=status or "left", **who)


def _asked(request: Request) -> str:
    """Return what a request asks, for the log; without the token of an address that works once."""
    path: str = request.scope["path"]
    return f"{request.method} {f'{OPENING}…' if path.startswith(OPENING) else path}"


class _Body:
    """The body of a request, which may neither pause for long nor take for ever."""

    def __init__(self, receive: Receive, idle: float, most: float) -> None:
        self._receive = receive
        self._idle = idle
        self._until = asyncio.get_running_loop().time() + most
        self._ended = False

    async def receive(self) -> Message:
        """Return the next piece; raise Refused where it does not come in time."""
        if self._ended:
            return await self._receive()
        rest = min(self._idle, self._until - asyncio.get_running_loop().time())
        try:
            message = await asyncio.wait_for(self._receive(), max(rest, 0.0))
        except TimeoutError:
            raise Refused(408, headers={"Connection": "close"}) from None
        self._ended = message["type"] != "http.request" or not message.get("more_body", False)
        return message


class _Answer:
    """The answer to a request, with the headers that every one has; who does not take it is left."""

    def __init__(self, send: Send, idle: float) -> None:
        self._send = send
        self._idle = idle
        self.status = 0

    async def send(self, message: Message) -> None:
        """Send a piece of the answer; raise ClientDisconnect where it is not taken in time."""
        if message["type"] == "http.response.start":
            self.status = message["status"]
            headers = MutableHeaders(scope=message)
            for name, value in HEADERS.items():
                headers[name] = value
            headers.add_vary_header("Accept")
        try:
            await asyncio.wait_for(self._send(message), self._idle)
        except TimeoutError:
            raise ClientDisconnect from None
