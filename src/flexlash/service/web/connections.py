"""Connections that are not left open: who says nothing, takes nothing or talks nonsense is cut off."""

from __future__ import annotations

import asyncio
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from flexlash.service.web.answer_headers import HEADERS

__all__ = ["MOST_CONNECTIONS", "SECONDS_BETWEEN_LOOKS", "Connection"]

MOST_CONNECTIONS = 256
SECONDS_BETWEEN_LOOKS = 10.0
"""What has neither begun a request nor taken the end of an answer from one look to the next is cut off."""

_AT_WORK = object()


class Connection(H11Protocol):
    """A connection of Uvicorn with an end to its patience."""

    _seen: object = _AT_WORK
    _next_look: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin, unless there are too many already."""
        super().connection_made(transport)
        if len(self.connections) > MOST_CONNECTIONS:
            transport.abort()
        self._next_look = self.loop.call_later(SECONDS_BETWEEN_LOOKS, self._look)

    def connection_lost(self, exc: Exception | None) -> None:
        """End."""
        if self._next_look:
            self._next_look.cancel()
        super().connection_lost(exc)

    def _look(self) -> None:
        """Cut the connection off where nothing has come of it since the last look."""
        answered = self.cycle is None or self.cycle.response_complete or self.transport.is_closing()
        if answered and self._seen is self.cycle:
            self.transport.abort()
            return
        self._seen = self.cycle if answered else _AT_WORK
        self._next_look = self.loop.call_later(SECONDS_BETWEEN_LOOKS, self._look)

    def send_400_response(self, msg: str) -> None:
        """Answer what is no HTTP, with the headers that every answer has."""
        told: list[Any] = [
            h11.Response(
                status_code=400,
                headers=[("content-type", "text/plain; charset=utf-8"), ("connection", "close"), *HEADERS.items()],
            ),
            h11.Data(data=msg.encode("ascii")),
            h11.EndOfMessage(),
        ]
        try:
            for event in told:
                self.transport.write(self.conn.send(event) or b"")
        except h11.LocalProtocolError:
            # An answer to what came before it is on its way: nothing can be said any more.
            self.transport.abort()
            return
        self.transport.close()
