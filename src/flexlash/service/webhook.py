"""Each ending is told to one address, once it has left by the drop folder: POST of the outcome's JSON, signed.

The body is the object that `--json` prints, with `id` and `state` of the submission; `X-Flexlash-Signature` is
`sha256=` and the HMAC-SHA256 of the body, in hexadecimal digits, under the key that both sides know. A message may come
twice: `X-Flexlash-Delivery` is then the same. Any status from 200 to 299 says that it has arrived.
"""

from __future__ import annotations

import hashlib
import hmac
import json
import secrets
from contextlib import closing
from http.client import HTTPConnection, HTTPException, HTTPSConnection
from pathlib import Path
from urllib.parse import SplitResult, urlsplit

from flexlash import __version__
from flexlash.outputs.writing import put_new, temporary
from flexlash.schema.findings import readable, shown
from flexlash.service.log import Log
from flexlash.service.records import Delivery
from flexlash.service.repeated import Repeated, back_off
from flexlash.service.store import Store
from flexlash.service.store_place import WEBHOOK_KEY

__all__ = ["Webhook", "webhook_address", "webhook_key"]

_SECONDS = 5.0
"""Seconds after which it is looked for messages again; one that failed ends a turn."""

_PATIENCE = 10.0
"""Seconds that the other side may take to connect, and to say each thing."""

_MOST_TRIES = 1_000
"""Tries after which a message is given up: three days of them."""

_SHORTEST_KEY = 16


def webhook_address(url: str) -> SplitResult:
    """Return the address of a webhook in its parts; raise ValueError, in a sentence, for what is none."""
    try:
        parts = urlsplit(url)
        is_one = parts.scheme in {"http", "https"} and bool(parts.hostname) and (parts.port or 1) > 0
    except ValueError:
        is_one = False
    if not is_one or not url.isascii() or not url.isprintable() or " " in url:
        raise ValueError(
            f"{shown(url, 200)} is not the address of a webhook: http://HOST/PATH or https://… is required"
        )
    if parts.username is not None or parts.fragment:
        raise ValueError("the address of a webhook holds neither a user nor a fragment: they would stand in every log")
    return parts


def webhook_key(store: Path, given: Path | None = None) -> bytes:
    """Return the key by which messages are signed: what stands in the file that is given, or one made once for a store.

    That lies in the store's folder as `webhook.key`. Raises OSError where a file cannot be read or made, ValueError,
    in a sentence, where the key is short enough to be guessed.
    """
    path = given or store / WEBHOOK_KEY
    if given is None and not path.exists():
        made_key = f"{secrets.token_urlsafe(32)}\n".encode()
        with temporary(store, lambda file: file.write(made_key)) as made:
            made.chmod(0o600)
            put_new(made, path)
    key = path.read_bytes().strip()
    if len(key) < _SHORTEST_KEY:
        raise ValueError(f"{path} holds a key of {len(key)} bytes; at least {_SHORTEST_KEY} are required")
    return key


class Webhook:
    """Tells an address of each ending, until it has heard it; no message holds another up for long."""

    def __init__(self, store: Store, url: str, key: bytes, log: Log) -> None:
        """Raise ValueError for what is no address."""
        self._store = store
        self._address = webhook_address(url)
        self._key = key
        self._log = log
        self._loop = Repeated("webhook", self.step, _SECONDS, log)

    def start(self) -> None:
        """Begin."""
        self._loop.start()

    def wake(self) -> None:
        """Say that a submission has ended."""
        self._loop.wake()

    def stop(self, seconds: float | None = _PATIENCE) -> None:
        """Send no further message, and wait so long for the present one; a later server sends what is left."""
        self._loop.stop(seconds)

    def step(self) -> None:
        """Send what is to be sent, until one message fails."""
        for delivery in self._store.deliveries():
            if delivery.kind == "message" and not self._sent(delivery):
                return

    def _sent(self, delivery: Delivery) -> bool:
        """Send a message and write down that it has arrived, or when it is tried again."""
        try:
            body = self._body(delivery)
            if body is not None:
                self._post(delivery, body)
        except (OSError, HTTPException) as fault:
            trouble = shown(readable(fault) or type(fault).__name__, 200)
            self._log.say("webhook failed", delivery.submission, why=trouble, tries=delivery.tries + 1)
            if delivery.tries + 1 >= _MOST_TRIES:
                self._store.give_up(delivery, trouble)
            else:
                self._store.postpone(delivery, back_off(delivery.tries + 1), trouble)
            return False
        self._store.delivered(delivery)
        return True

    def _body(self, delivery: Delivery) -> bytes | None:
        """Return what is told of a submission, None where there is nothing more to tell of it."""
        submission = self._store.submission(delivery.submission)
        outcome = self._store.files(delivery.submission).get("outcome")
        if submission is None or outcome is None:
            return None
        told = {"id": submission.id, "state": submission.state, **json.loads(self._store.blobs.read(outcome.sha256))}
        return json.dumps(told, ensure_ascii=False).encode()

    def _post(self, delivery: Delivery, body: bytes) -> None:
        """Send a message; raise OSError or HTTPException where it has not arrived."""
        address = self._address
        connect = HTTPSConnection if address.scheme == "https" else HTTPConnection
        with closing(connect(address.hostname or "", address.port, timeout=_PATIENCE)) as connection:
            connection.request(
                "POST",
                f"{address.path or '/'}{f'?{address.query}' if address.query else ''}",
                body,
                {
                    "Content-Type": "application/json",
                    "User-Agent": f"flexlash/{__version__}",
                    "X-Flexlash-Delivery": str(delivery.number),
                    "X-Flexlash-Signature": f"sha256={hmac.new(self._key, body, hashlib.sha256).hexdigest()}",
                },
            )
            status = connection.getresponse().status
        if status in range(300, 400):
            raise OSError(f"the webhook answered {status}; redirects are not followed")
        if status not in range(200, 300):
            raise OSError(f"the webhook answered {status}")
