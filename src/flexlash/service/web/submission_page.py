"""What the page of a submission shows: how far it is, what was found, what came of it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from markupsafe import Markup

from flexlash.report.page.shape import Card, PageFacts, Tile
from flexlash.report.pictures.chart import Spread, spread_chart
from flexlash.schema.angle_unit import angle_sign
from flexlash.schema.number_words import grouped
from flexlash.service.records import StoredFile, StoredSubmission
from flexlash.service.web.offers import Download, offered
from flexlash.service.web.words import DOORS, Moment, StateLine, counted, remaining, size_words, state_line

__all__ = [
    "CheckedView",
    "Progress",
    "SubmissionView",
    "checked_view",
    "submission_view",
]

_CARDS, _DRAWN = 6, 20
"""Cards that are open and variants that are drawn; the others wait behind a line."""

_SOON, _SELDOM = 15, 10
"""Seconds within which most submissions end, and between two looks at what takes long."""

Stage = Literal["waiting", "working", "done", "rejected"]


@dataclass(frozen=True, kw_only=True)
class Progress:
    """How far a submission is: rows done of how many (0 when not known yet), in words, and what waits behind it."""

    done: int
    rows: int
    title: str
    words: str
    checked: str
    next: str


@dataclass(frozen=True, kw_only=True)
class Event:
    """Something that happened to a submission, and when."""

    when: Moment
    words: str


@dataclass(frozen=True, kw_only=True)
class SubmissionView:
    """The page of a submission.

    `refresh` is in how many seconds it is asked for again, 0 once nothing changes any more. `first_cards` are open,
    `more_cards` behind a line; `findings_first` says that they come before what was computed.
    """

    id: str
    name: str
    stage: Stage
    state: StateLine
    received: Moment
    ended: Moment | None
    sender: str
    door: str
    sha256: str
    size: str
    refresh: int
    progress: Progress | None
    trouble: str
    undelivered: str
    reason: str
    is_repeated: bool
    repeated: Line | None
    previous: Line | None
    facts: PageFacts | None
    tiles: Sequence[Tile]
    verdict_tiles: Sequence[Tile]
    first_cards: Sequence[Card]
    more_cards: Sequence[Card]
    findings_first: bool
    charts: Sequence[Markup]
    drawn_more: int
    downloads: Sequence[Download]
    events: Sequence[Event]

    @property
    def title(self) -> str:
        """What the browser's tab says: how far it is, then whose page it is."""
        if self.stage == "working" and self.progress and self.progress.rows:
            return f"{100 * self.progress.done // self.progress.rows} % · {self.name}"
        return f"{self.name} · {self.state.words}"


@dataclass(frozen=True, kw_only=True)
class Line:
    """Another submission that a page leads to."""

    id: str
    name: str
    when: Moment


def submission_view(
    submission: StoredSubmission, now: float, *, facts: PageFacts | None = None,
    files: Mapping[str, StoredFile] | None = None, before: int = 0, waiting: int = 0,
    first: StoredSubmission | None = None, previous: StoredSubmission | None = None,
    events: Iterable[Mapping[str, Any]] = (), undelivered: str = "",
) -> SubmissionView:  # fmt: skip
    """Return the page of a submission.

    `before` are those that are begun before it while it waits, `waiting` those that wait in all; `first` is the one
    whose result it was answered with, `previous` the last one of its name that differs and has a report; `undelivered`
    says what keeps its files from the folder to which they belong.
    """
    cards = facts["cards"] if facts else []
    partly = bool(facts and facts["counts"].get("errors"))
    return SubmissionView(
        id=submission.id,
        name=submission.name,
        stage=submission.state,
        state=state_line(submission, now, before),
        received=Moment.of(submission.received_at, now),
        ended=None if submission.ended_at is None else Moment.of(submission.ended_at, now),
        sender=submission.sender,
        door=DOORS[submission.door],
        sha256=submission.sha256,
        size=size_words(submission.size),
        refresh=0 if submission.has_ended else _refresh(submission, now, reads=bool(cards)),
        progress=_progress(submission, now, waiting) if submission.state == "working" else None,
        trouble=_trouble(submission, now),
        undelivered=undelivered,
        reason=submission.reason,
        is_repeated=bool(submission.same_as),
        repeated=_line(first, now),
        previous=_line(previous, now),
        facts=facts,
        tiles=_tiles(facts, partly=partly),
        verdict_tiles=facts["verdict_tiles"][:-1] if facts else [],
        first_cards=cards[:_CARDS],
        more_cards=cards[_CARDS:],
        findings_first=partly,
        charts=_charts(facts),
        drawn_more=max(0, len(facts["chart"]["variants"]) - _DRAWN) if facts and facts["chart"] else 0,
        downloads=offered(submission, facts, files or {}, partly=partly),
        events=[Event(when=Moment.of(row["at"], now), words=_event(row)) for row in events],
    )


def _line(submission: StoredSubmission | None, now: float) -> Line | None:
    if submission is None:
        return None
    return Line(id=submission.id, name=submission.name, when=Moment.of(submission.received_at, now))


def _refresh(submission: StoredSubmission, now: float, *, reads: bool) -> int:
    """Return in how many seconds to look again: soon at what may end soon, seldom where findings are read meanwhile."""
    if submission.state == "waiting":
        return _SELDOM if submission.trouble else 1 if now - submission.received_at < _SOON else 3
    past = now - (submission.began_at or now)
    often = next((seconds for until, seconds in ((_SOON, 1), (60, 2), (600, 5)) if past < until), _SELDOM)
    return max(often, 5) if reads and past >= _SOON else often


def _progress(submission: StoredSubmission, now: float, waiting: int) -> Progress:
    """Return how far a submission at work is."""
    speed, left = remaining(submission, now)
    rows, counts = submission.rows, submission.counts
    words = [f"{grouped(submission.rows_done)} of {counted(rows, 'row')}"] if rows else []
    words += [f"{grouped(round(speed))} rows a second" if speed >= 1 else "", left]
    checked = ""
    if counts.get("rows"):
        wrong = counts["rows"] - counts.get("computed", 0)
        checked = f"{counted(counts.get('computed', 0), 'row')} ready"
        checked += f", {counted(wrong, 'row')} with errors" if wrong else ", none with errors"
    return Progress(
        done=submission.rows_done,
        rows=rows,
        title=_doing(submission),
        words=" · ".join(filter(None, words)),
        checked=checked,
        next=counted(waiting, "submission") if waiting else "",
    )


def _doing(submission: StoredSubmission) -> str:
    """Return what is done with a submission at work."""
    if not submission.rows:
        return "Reading and checking"
    return "Computing" if submission.rows_done < submission.rows else "Writing the report"


def _trouble(submission: StoredSubmission, now: float) -> str:
    """Return what keeps this machine from working on a submission, and when it is tried again."""
    if not submission.trouble or submission.state != "waiting":
        return ""
    again = submission.not_before - now
    when = "It will be tried again in a moment" if again < 1 else f"It is tried again in {round(again)} seconds"
    trouble = submission.trouble[:1].upper() + submission.trouble[1:].rstrip(".")
    return f"{trouble}. The fault is this machine's, not your file's. {when}; nothing is lost."


def _tiles(facts: PageFacts | None, *, partly: bool) -> Sequence[Tile]:
    """Return the figures at the top: those of the findings where there are errors, else those of the verdicts."""
    if facts is None or facts["refused"]:
        return []
    return facts["tiles"] if partly or not facts["verdict_tiles"] else facts["verdict_tiles"]


def _charts(facts: PageFacts | None) -> Sequence[Markup]:
    """Return the chart of all variants: the first of them, and the others, on the same scale."""
    chart = facts["chart"] if facts else None
    if chart is None or not chart["variants"]:
        return []
    spreads = [
        Spread(variant=one["variant"], low=one["low"], median=one["median"], high=one["high"], limit=one["limit"],
               verdict=one["verdict"])
        for one in chart["variants"]
    ]  # fmt: skip
    sign = angle_sign(chart["unit"])
    first, others = spreads[:_DRAWN], spreads[_DRAWN:]
    charts = [spread_chart("spread", first, sign, of=chart["of"], beside=others)]
    charts += [spread_chart("spread-others", others, sign, beside=first)] if others else []
    return [Markup(picture.inline()) for picture in charts]  # noqa: S704


_EVENTS = {
    "received": "handed in as",
    "begun": "computing began",
    "done": "computed",
    "put back": "put back in the queue",
    "handed back": "put back in the queue",
    "retried": "asked to be computed anew",
    "delivered": "put into the results folder",
}


def _event(row: Mapping[str, Any]) -> str:
    """Return an event in words."""
    if row["kind"] == "answered again":
        return "answered with the stored result of the same file"
    return ": ".join(filter(None, (_EVENTS.get(row["kind"], row["kind"]), row["text"])))


@dataclass(frozen=True, kw_only=True)
class CheckedView:
    """What was found in a file of which nothing is kept."""

    name: str
    facts: PageFacts
    tiles: Sequence[Tile]
    first_cards: Sequence[Card]
    more_cards: Sequence[Card]


def checked_view(name: str, facts: PageFacts) -> CheckedView:
    """Return the findings of a file that was checked only."""
    cards = facts["cards"]
    return CheckedView(
        name=name, facts=facts, tiles=_tiles(facts, partly=True), first_cards=cards[:_CARDS], more_cards=cards[_CARDS:]
    )
