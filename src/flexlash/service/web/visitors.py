"""Whether a request is let in: its host, its proxy, where its form came from, its token."""

from __future__ import annotations

import hashlib
import hmac
import ipaddress
import re
import threading
from collections.abc import Mapping
from pathlib import Path

from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from flexlash.schema.findings import shown
from flexlash.service.running_page import takes_key
from flexlash.service.web.access import Access
from flexlash.service.web.attempts import Attempts
from flexlash.service.web.refusals import Refused
from flexlash.service.web.signing import DAY, Signer

__all__ = ["OPENING", "Visitors"]

OPENING = "/open/"
"""Where the token that works once stands in an address."""

_OPEN_TO_ALL = ("/health", "/metrics")
"""What names nobody, so that it may be watched without a token or a proxy."""

_ONE_BROWSER = (
    "flexlash was started for the browser that opened it. If that was yours and you have closed it, start flexlash once"
    " more, by a double click or with --open: the page opens again."
)
_SESSION = 30 * DAY
_HOST = re.compile(r"(?P<name>[a-z0-9.-]{1,255}|\[[0-9a-f:.]{2,45}\])(:[0-9]{1,5})?")
_WANTED = re.compile(r"/(?!/)[A-Za-z0-9/._-]{0,300}")
_SAFE_METHODS = {"GET", "HEAD"}


class Visitors:
    """Lets requests in, or says why not; knows again who has shown a token."""

    def __init__(self, access: Access, signer: Signer, folder: Path) -> None:
        self._access = access
        self._signer = signer
        self._folder = folder
        self._attempts = Attempts()
        self._once = access.once
        self._opening = threading.Lock()
        self._purpose = f"session {hashlib.sha256(access.token.encode()).hexdigest()}"

    def let_in(self, request: Request) -> Mapping[str, str]:
        """Return what is known of who asks: `sender`, `session`, `bearer`; raise Refused where they are not let in."""
        self._require_host(request)
        path = request.scope["path"]
        if path in _OPEN_TO_ALL:
            return {"sender": "", "session": ""}
        sender = self._sender(request)
        self._require_own_form(request)
        if not self._access.asks or path == "/login" or path.startswith(("/static/", OPENING)):
            # No browser says such a token of its own accord, nor has a foreign page it said: this is a program.
            return {"sender": sender, "session": "", "bearer": "yes" if _bearer(request) else ""}
        return {"sender": sender, **self._session(request)}

    def _require_host(self, request: Request) -> None:
        """Refuse a name that is not ours: it may lead here all the same, by whoever has set it up so."""
        host = _HOST.fullmatch(request.headers.get("host", "").lower())
        if host is None:
            raise Refused(421)
        name = host["name"].strip("[]")
        if name in self._access.host_names:
            return
        try:
            address = str(ipaddress.ip_address(name))
        except ValueError:
            raise Refused(421) from None
        # A name can be made to lead here, an address cannot: the one that was called, or loopback, is ours.
        if address not in {self._access.host, _plain((request.scope.get("server") or [""])[0])}:
            raise Refused(421)

    def _sender(self, request: Request) -> str:
        """Return who sends, as the proxy says it."""
        if not self._access.sender_header:
            return ""
        if client_address(request) not in self._access.proxy_addresses:
            raise Refused(403, "This page is reached through its proxy alone.")
        said = request.headers.getlist(self._access.sender_header)
        name = shown(_text(said[0]).strip(), 100) if len(said) == 1 else ""
        if not name:
            raise Refused(403, f"The proxy does not say who you are: it must set {self._access.sender_header} once.")
        return name

    def _require_own_form(self, request: Request) -> None:
        """Refuse what a page of somebody else has the browser send; where nothing tells, the form's token must."""
        if request.method in _SAFE_METHODS:
            return
        site, origin = request.headers.getlist("sec-fetch-site"), request.headers.getlist("origin")
        if site:
            own = site in (["same-origin"], ["none"])
        elif origin and origin != ["null"]:
            own = len(origin) == 1 and origin[0].lower().partition("://")[2] == request.headers["host"].lower()
        else:
            own = True
        if not own:
            raise Refused(403)

    def _session(self, request: Request) -> Mapping[str, str]:
        """Return the session of a cookie or of a token in a header."""
        if token := _bearer(request):
            self._require_right(request, token)
            return {"session": "", "bearer": "yes"}
        value = self._signer.value(self._purpose, request.cookies.get(self._cookie(request), ""), _SESSION)
        if value is None:
            sentence = "" if self._access.token else _ONE_BROWSER
            raise Refused(401, sentence, headers={"WWW-Authenticate": "Bearer"}, asks_for_token=True)
        return {"session": value}

    def _require_right(self, request: Request, token: str) -> None:
        """Refuse a wrong token, and any after too many wrong ones."""
        address = client_address(request)
        if self._attempts.are_too_many(address):
            raise Refused(429)
        if not _is_same(token, self._access.token):
            self._attempts.wrong(address)
            raise Refused(401, "That is not the token.", headers={"WWW-Authenticate": "Bearer"}, asks_for_token=True)

    def entered(self, request: Request, token: str, wanted: str) -> Response:
        """Return the way to the page that was wanted, with a cookie, for the right token."""
        self._require_right(request, token.strip())
        return self._welcomed(request, wanted if _WANTED.fullmatch(wanted) else "/")

    def opened(self, request: Request) -> Response:
        """Return the way in, with a cookie, for the token that works once, or a key that was left in the store."""
        if request.method != "GET":
            raise Refused(405, headers={"Allow": "GET"})
        token = request.path_params["token"]
        with self._opening:
            if self._access.once and takes_key(self._folder, token):
                return self._welcomed(request, "/")
            if self._access.once and not self._once:
                raise Refused(403, f"This address has been used once already, and works once alone. {_ONE_BROWSER}")
            # Nobody guesses 256 bits: counting wrong ones would only let another user of this machine keep its owner
            # out.
            if not _is_same(token, self._once):
                raise Refused(401, "That is not the address that flexlash printed.", asks_for_token=True)
            self._once = ""
        return self._welcomed(request, "/")

    def _welcomed(self, request: Request, to: str) -> Response:
        response = RedirectResponse(to, 303)
        response.set_cookie(
            self._cookie(request),
            self._signer.issue(self._purpose),
            max_age=int(_SESSION) if self._access.token else None,
            secure=self._is_secure(request),
            httponly=True,
            samesite="strict",
        )
        return response

    def _is_secure(self, request: Request) -> bool:
        """Whether the proxy, whose word alone counts, says that it was asked by https."""
        trusted = client_address(request) in self._access.proxy_addresses
        return trusted and request.headers.get("x-forwarded-proto", "").lower() == "https"

    def _cookie(self, request: Request) -> str:
        """Return the name of the cookie; browsers keep those of several ports of a host together."""
        port = (request.scope.get("server") or ["", 0])[1]
        return "__Host-flexlash" if self._is_secure(request) else f"flexlash-{port}"


def _bearer(request: Request) -> str:
    """Return the token that a program says in a header, empty where none is said."""
    kind, _, token = request.headers.get("authorization", "").partition(" ")
    return token.strip() if kind.lower() == "bearer" else ""


def _is_same(token: str, right: str) -> bool:
    """Whether a token is the right one, found out in a time that tells nothing; where there is none, none is right."""
    return bool(right) and hmac.compare_digest(token.encode(errors="replace"), right.encode())


def client_address(request: Request) -> str:
    """Return the address that a request comes from, as the connection has it."""
    return _plain(request.client.host) if request.client else ""


def _plain(address: str) -> str:
    """Return an address in its usual form, also one of version 4 within version 6."""
    try:
        number = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    return str(getattr(number, "ipv4_mapped", None) or number)


def _text(header: str) -> str:
    """Return a header's value as text: most proxies send UTF-8."""
    try:
        return header.encode("latin-1").decode()
    except UnicodeDecodeError:
        return header
