"""Pages or JSON: which of the two a request would rather have."""

from __future__ import annotations

from starlette.requests import HTTPConnection

__all__ = ["wants_json"]


def wants_json(request: HTTPConnection) -> bool:
    """Whether a request asks for JSON more than for a page.

    >>> from starlette.requests import Request
    >>> def asks(accept): return Request({"type": "http", "headers": [(b"accept", accept)]})
    >>> wants_json(asks(b"application/json")), wants_json(asks(b"*/*")), wants_json(asks(b"text/html;q=0.4, */*;q=0.5"))
    (True, False, True)
    """
    accept = ",".join(request.headers.getlist("accept")) or "*/*"
    return _quality(accept, "application", "json") > _quality(accept, "text", "html")


def _quality(accept: str, kind: str, form: str) -> float:
    """Return how much a media type is wanted, from 0 to 1: what names it most closely counts."""
    best = (-1, 0.0)
    for entry in accept.split(",")[:50]:
        name, *parameters = (part.strip().lower() for part in entry.split(";"))
        closeness = {f"{kind}/{form}": 2, f"{kind}/*": 1, "*/*": 0}.get(name, -1)
        if closeness > best[0]:
            best = (closeness, _q(parameters))
    return best[1]


def _q(parameters: list[str]) -> float:
    for one in parameters:
        name, _, value = one.partition("=")
        if name.strip() == "q":
            try:
                return min(1.0, max(0.0, float(value)))
            except ValueError:
                return 0.0
    return 1.0
