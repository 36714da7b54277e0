"""Where the page of a service that runs is, told in its store, and keys by which its owner comes in once more.

Both are files of a folder that is closed to other users: who can write a key there owns the store already.
"""

from __future__ import annotations

import hmac
import secrets
import time
from contextlib import suppress
from pathlib import Path

from flexlash.outputs.writing import temporary

__all__ = ["announce_page", "forget_page", "new_key", "running_page", "takes_key"]

_PAGE, _KEY = ".page", ".page-key"
_LOOKING = 0.1
"""Seconds after which a page that is only starting is looked for again."""


def announce_page(folder: Path, address: str) -> None:
    """Tell in a store where its page is."""
    _write(folder / _PAGE, address)


def forget_page(folder: Path) -> None:
    """Remove what a page that runs no more has left in a store."""
    for name in (_PAGE, _KEY):
        with suppress(OSError):
            (folder / name).unlink()


def running_page(folder: Path, *, patience: float = 0.0) -> str:
    """Return where the page of a store is, an empty text where none is told within so many seconds."""
    end = time.monotonic() + patience
    while not (page := _read(folder / _PAGE)) and time.monotonic() < end:
        time.sleep(_LOOKING)
    return page


def new_key(folder: Path) -> str:
    """Leave a key in a store, which the page takes once, and return it."""
    key = secrets.token_urlsafe(32)
    _write(folder / _KEY, key)
    return key


def takes_key(folder: Path, key: str) -> bool:
    """Return whether a key is the one that was left in a store, which is gone then."""
    left = _read(folder / _KEY)
    if not left or not hmac.compare_digest(key.encode(errors="replace"), left.encode()):
        return False
    (folder / _KEY).unlink(missing_ok=True)
    return True


def _write(path: Path, text: str) -> None:
    with temporary(path.parent, lambda file: file.write(text.encode())) as made:
        made.chmod(0o600)
        made.replace(path)


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return ""
