"""Tokens that we issued ourselves: a value, when it was issued, and the proof of both."""

from __future__ import annotations

import hashlib
import hmac
import os
import re
import secrets
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from flexlash.outputs.writing import put_new, temporary

__all__ = ["DAY", "Signer", "stored_key"]

DAY = 86_400.0
_KEY = ".web.key"
_KEY_BYTES = 32
_TOKEN = re.compile(r"([0-9a-f]{32})-([0-9]{1,12})-([0-9a-f]{64})")


class Signer:
    """Issues tokens and knows them again, under a key that nobody else has."""

    def __init__(self, key: bytes, clock: Callable[[], float] = time.time) -> None:
        self._key = key
        self._clock = clock

    def issue(self, purpose: str) -> str:
        """Return a new token for a purpose; 128 bits of it are random."""
        value, at = secrets.token_hex(16), int(self._clock())
        return f"{value}-{at}-{self._proof(purpose, value, at)}"

    def value(self, purpose: str, token: str, seconds: float = DAY) -> str | None:
        """Return the 32 hexadecimal digits of a token issued for this purpose that long ago at most, else None."""
        found = _TOKEN.fullmatch(token)
        if found is None:
            return None
        value, at, proof = found[1], int(found[2]), found[3]
        if not hmac.compare_digest(proof, self._proof(purpose, value, at)):
            return None
        return value if at <= self._clock() + 1 and self._clock() - at <= seconds else None

    def derived(self, *parts: str) -> str:
        """Return 32 hexadecimal digits that follow from these texts, and that nobody else can tell beforehand."""
        return hmac.new(self._key, "\0".join(("derived", *parts)).encode(), hashlib.sha256).hexdigest()[:32]

    def _proof(self, purpose: str, value: str, at: int) -> str:
        return hmac.new(self._key, f"{purpose}\0{value}\0{at}".encode(), hashlib.sha256).hexdigest()


def stored_key(folder: Path) -> bytes:
    """Return the key that lies in the store's folder, which only its owner may read; made where there is none.

    Raises OSError where it cannot be read or made.
    """
    path = folder / _KEY
    with suppress(FileNotFoundError):
        return _read(path)
    with temporary(folder, lambda file: file.write(secrets.token_bytes(_KEY_BYTES))) as made:
        made.chmod(0o600)
        put_new(made, path)
    return _read(path)


def _read(path: Path) -> bytes:
    key = path.read_bytes()
    if len(key) != _KEY_BYTES or (os.name == "posix" and path.stat().st_mode & 0o077):
        raise OSError(f"{path} is no key that its owner alone may read; remove it and a new one is made")
    return key
