"""Moments, spans and sizes in words, and what a submission's state is in a sentence."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date, datetime, timedelta
from typing import Literal

from flexlash.schema.number_words import grouped
from flexlash.service.records import StoredSubmission

__all__ = ["DOORS", "Kind", "Moment", "StateLine", "counted", "remaining", "size_words", "span", "state_line"]

Kind = Literal["good", "bad", "warn", "plain"]

DOORS = {"page": "page", "folder": "drop folder"}
"""How a submission came, in words."""

_MINUTE, _HOUR, _DAY = 60.0, 3600.0, 86_400.0
_SETTLED = 2.0
_TOLD = 0.02
"""Seconds of computing, and part of the rows, before which no one can say how long the rest takes."""


@dataclass(frozen=True, kw_only=True)
class Moment:
    """A moment as people say it, exactly, and as machines read it; in the time of this server."""

    near: str
    day: str
    exact: str
    machine: str

    @classmethod
    def of(cls, then: float, now: float) -> Moment:
        """Return a moment, in seconds since 1970, as it is told now."""
        local = datetime.fromtimestamp(then).astimezone()
        return cls(
            near=_ago(then, now, local),
            day=_day(local, datetime.fromtimestamp(now).astimezone().date()),
            exact=f"{local:%Y-%m-%d %H:%M:%S}",
            machine=local.isoformat(timespec="seconds"),
        )


def _ago(then: float, now: float, local: datetime) -> str:
    """Return how long ago a moment is, or its day where that is long ago."""
    past = max(0.0, now - then)
    if past < _MINUTE:
        return "just now"
    if past < _HOUR:
        return f"{int(past / _MINUTE)} min ago"
    if past < _DAY:
        return f"{int(past / _HOUR)} h ago"
    return _day(local, datetime.fromtimestamp(now).astimezone().date())


def _day(local: datetime, today: date) -> str:
    if local.date() == today:
        return f"today {local:%H:%M}"
    if local.date() == today - timedelta(days=1):
        return f"yesterday {local:%H:%M}"
    return f"{local:%Y-%m-%d %H:%M}"


def counted(count: int, what: str) -> str:
    """Return a number with its noun.

    >>> counted(1, "row"), counted(12_000, "row")
    ('1 row', '12,000 rows')
    """
    return f"{grouped(count)} {what}{'' if count == 1 else 's'}"


def span(seconds: float) -> str:
    """Return how long something takes, as one says it.

    >>> [span(seconds) for seconds in (0.4, 42, 61, 250, 4000, 10_000, 200_000)]
    ['a second', '42 seconds', '1 minute', '4 minutes', '1 hour', '3 hours', '2 days']
    """
    if seconds < 1.5:  # noqa: PLR2004
        return "a second"
    for size, what in ((_DAY, "day"), (_HOUR, "hour"), (_MINUTE, "minute")):
        if seconds >= size:
            return counted(round(seconds / size), what)
    return counted(round(seconds), "second")


def remaining(submission: StoredSubmission, now: float) -> tuple[float, str]:
    """Return how many rows of a submission at work are computed in a second, and about how long the others take.

    0 and an empty text where that cannot be said yet.
    """
    past = now - (submission.began_at or now)
    if past < _SETTLED or not _TOLD * submission.rows <= submission.rows_done < submission.rows:
        return 0.0, ""
    speed = submission.rows_done / past
    return speed, f"about {span((submission.rows - submission.rows_done) / speed)} left"


def size_words(size: int) -> str:
    """Return a size in the unit that people use for it.

    >>> size_words(900), size_words(25_300), size_words(21_000_000)
    ('900 bytes', '25 kB', '21 MB')
    """
    for unit, name in ((1e6, "MB"), (1e3, "kB")):
        if size >= unit:
            return f"{size / unit:.2g} {name}" if size < 10 * unit else f"{size / unit:.0f} {name}"
    return f"{size} bytes"


@dataclass(frozen=True, kw_only=True)
class StateLine:
    """The state of a submission in a sentence, what colours it, and what the link to its page is called."""

    words: str
    kind: Kind
    link: str


def state_line(submission: StoredSubmission, now: float, before: int | None = None) -> StateLine:
    """Return what a list says of a submission; `before` are those that are begun before one that waits."""
    if submission.state == "rejected":
        return StateLine(words=submission.words or "rejected", kind="bad", link="reason")
    if submission.state == "done":
        return _done(submission)
    if submission.state == "working":
        if not submission.rows:
            return StateLine(words="being read and checked", kind="plain", link="watch")
        left = remaining(submission, now)[1]
        rows = f"{grouped(submission.rows_done)} of {counted(submission.rows, 'row')}"
        return StateLine(words=" · ".join(filter(None, (rows, left))), kind="plain", link="watch")
    if submission.trouble:
        return StateLine(words=f"waiting: {submission.trouble}", kind="warn", link="watch")
    place = (
        ""
        if before is None
        else "; next in the queue"
        if not before
        else f"; {counted(before, 'submission')} before it"
    )
    return StateLine(words=f"waiting{place}", kind="plain", link="watch")


def _done(submission: StoredSubmission) -> StateLine:
    """Return what a list says of a submission that was computed: how much of it, and how many variants fail."""
    counts = submission.counts
    failing, computed = counts.get("fails", 0), counts.get("computed", 0)
    told = f"{grouped(failing)} {'fails' if failing == 1 else 'fail'}" if failing else ""
    words = "; ".join(filter(None, (submission.words, told)))
    if counts.get("errors") or computed < counts.get("rows", 0):
        return StateLine(words=words, kind="warn" if computed else "bad", link="findings")
    return StateLine(words=words, kind="good", link="report")
