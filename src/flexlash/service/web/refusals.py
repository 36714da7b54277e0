"""Why a request is refused: a status, and a sentence that says what to do."""

from __future__ import annotations

import errno
import sqlite3

from starlette.exceptions import HTTPException

__all__ = ["Refused", "full_or_busy"]

_WORDS = {
    400: ("This request cannot be read", "Go back and try again."),
    401: ("This page asks for its token", "Enter the token that the person who runs flexlash gave you."),
    403: ("This request is refused", "It did not come from a page of flexlash: open the page and try again there."),
    404: ("There is no such page", "Look at the address, or find the submission in the history."),
    405: ("This cannot be done at this address", "Go back to the page and use its buttons."),
    408: ("This took too long to arrive", "The connection paused for too long: try again."),
    409: ("Not now", "Wait until it has finished."),
    410: (
        "This submission is no longer kept",
        "It has been forgotten, or was kept as long as is set: hand it in again.",
    ),
    413: (
        "This file is too large",
        ("At most 20 MiB are accepted here: use flexlash run on the command line for larger tables."),
    ),
    415: ("This form cannot be read", "Send it as multipart/form-data, as the page does."),
    421: ("This address is not that of flexlash", "Use the address that flexlash printed when it was started."),
    422: ("This file cannot be read", "Hand in the template, filled in, or a table."),
    429: ("Too many wrong tokens", "Wait a minute and try again."),
    500: ("flexlash failed here", "This is a fault of flexlash, which has written it down. Nothing is lost."),
    503: ("flexlash is busy", "Try again in a minute; what has been handed in is kept."),
    507: (
        "The disk of flexlash is full",
        "Nothing was kept of this: tell the person who runs flexlash, and try later.",
    ),
}
_LATER = {429: "60", 503: "30", 507: "300"}


class Refused(HTTPException):
    """A refusal with its status, a title and a sentence of what to do, both in plain words."""

    def __init__(
        self,
        status: int,
        sentence: str = "",
        *,
        headers: dict[str, str] | None = None,
        asks_for_token: bool = False,
        retry_after: str = "",
    ) -> None:
        """Refuse by a status; `asks_for_token` shows the form for the token instead of the bare sentence."""
        title, usual = _WORDS.get(status, _WORDS[400 if status < 500 else 500])  # noqa: PLR2004
        later = retry_after or _LATER.get(status, "")
        super().__init__(status, title, {**(headers or {}), **({"Retry-After": later} if later else {})})
        self.title = title
        self.sentence = sentence or usual
        self.asks_for_token = asks_for_token

    @classmethod
    def of(cls, fault: HTTPException) -> Refused:
        """Return an exception of Starlette as a refusal in our own words."""
        if isinstance(fault, Refused):
            return fault
        return cls(fault.status_code, headers=dict(fault.headers or {}))


_FULL = {errno.ENOSPC, errno.EDQUOT}


def full_or_busy(fault: OSError | sqlite3.Error) -> Refused:
    """Return the refusal that a fault of this machine amounts to: its disk is full, or something else is wrong.

    >>> full_or_busy(sqlite3.OperationalError("database or disk is full")).status_code
    507
    """
    full = getattr(fault, "errno", None) in _FULL or "is full" in str(fault)
    return Refused(507) if full else Refused(503, "The store of flexlash cannot be used just now: try again later.")
