"""Who may open the page, as it is settled at the start."""

from __future__ import annotations

import ipaddress
import os
import re
import secrets
import socket
import stat
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

__all__ = ["LOOPBACK", "Access", "AccessError"]

LOOPBACK = ("127.0.0.1", "::1")
_SHORTEST_TOKEN = 16
_HEADER = re.compile(r"[A-Za-z0-9-]{1,64}")
_NAME = re.compile(r"[a-z0-9]([a-z0-9.-]{0,252}[a-z0-9])?")
_OWN_HEADERS = {"host", "cookie", "origin", "authorization", "content-length", "content-type", "accept", "connection"}


class AccessError(Exception):
    """The page may not be opened like this; the message says why, and what would be right."""


@dataclass(frozen=True, kw_only=True)
class Access:
    """Who may open the page.

    `token` is asked of everybody, empty for nobody; `once` is a token that works a single time in an address, after
    which a cookie does. `sender_header` is the header by which the proxy, at `proxy_addresses` alone, says who sends.
    `host_names` are names by which the page may be called, beside the machine's own addresses.
    """

    host: str = "127.0.0.1"
    port: int = 8765
    token: str = ""
    once: str = ""
    sender_header: str = ""
    proxy_addresses: tuple[str, ...] = ()
    host_names: tuple[str, ...] = ("localhost",)

    @classmethod
    def of(
        cls,
        *,
        host: str = "127.0.0.1",
        port: int = 8765,
        token_file: Path | None = None,
        behind_proxy: str = "",
        proxy_addresses: Sequence[str] = LOOPBACK,
        host_names: Sequence[str] = (),
        opens: bool = False,
    ) -> Access:
        """Return who may open the page; `opens` says that it is opened here, by a token that works once.

        Raises AccessError where others than this machine could reach it and nothing says who they are.
        """
        local = _is_local(host)
        if not local and token_file is None and not behind_proxy:
            raise AccessError(
                f"--host {host} lets other machines open the page. It needs --token-file FILE, or --behind-proxy HEADER"
                " where a proxy says who they are; without either only 127.0.0.1 is possible."
            )
        if behind_proxy and (not _HEADER.fullmatch(behind_proxy) or behind_proxy.lower() in _OWN_HEADERS):
            raise AccessError(f"--behind-proxy {behind_proxy!r} is no header that a proxy could say the sender by.")
        names = [name.lower() for name in host_names]
        if wrong := [name for name in names if not _NAME.fullmatch(name)]:
            raise AccessError(f"--host-name {wrong[0]!r} is no name of a machine: give it without scheme and port.")
        if opens and behind_proxy:
            raise AccessError("--open is for the one who starts flexlash, --behind-proxy for others: give one of them.")
        own = [] if local else [socket.gethostname().lower(), host.lower()]
        return cls(
            host=host,
            port=port,
            token=_token(token_file) if token_file else "",
            once=secrets.token_urlsafe(32) if opens else "",
            sender_header=behind_proxy.lower(),
            proxy_addresses=tuple(_address(one) for one in proxy_addresses) if behind_proxy else (),
            host_names=("localhost", *own, *names),
        )

    @property
    def asks(self) -> bool:
        """Whether a cookie or a token is asked of everybody."""
        return bool(self.token or self.once)

    def address(self, port: int | None = None) -> str:
        """Return the address of the page, at the port that was taken where any would do."""
        host = {"0.0.0.0": LOOPBACK[0], "::": LOOPBACK[1]}.get(self.host, self.host)  # noqa: S104
        host = f"[{host}]" if ":" in host else host
        return f"http://{host}:{self.port if port is None else port}/"


def _is_local(host: str) -> bool:
    """Whether an address is reached from this machine alone."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _address(text: str) -> str:
    try:
        return str(ipaddress.ip_address(text))
    except ValueError:
        raise AccessError(f"{text!r} is not the address of a proxy: give its number, such as 10.0.0.7.") from None


def _token(path: Path) -> str:
    """Return the token of a file that its owner alone may read."""
    try:
        status, text = path.stat(), path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as fault:
        raise AccessError(f"--token-file {path} cannot be read: {fault}") from None
    if os.name == "posix" and stat.S_IMODE(status.st_mode) & 0o077:
        raise AccessError(f"--token-file {path} can be read by others: chmod 600 {path}")
    token = text.strip()
    if len(token) < _SHORTEST_TOKEN or not token.isascii() or not token.isprintable() or " " in token:
        raise AccessError(
            f"--token-file {path} must hold one token of at least {_SHORTEST_TOKEN} letters, digits and signs, such as"
            f" {secrets.token_urlsafe(24)}"
        )
    return token
