"""What a store holds → one object for `--json`, and the sentences that say the same."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from flexlash.schema.findings import shown

if TYPE_CHECKING:
    from flexlash.service.outbox import Outbox
    from flexlash.service.records import Delivery

__all__ = ["all_lines", "everything", "one", "one_lines"]

_MOST = 10
"""How many submissions of a state are told one by one."""

_MIB = 2**20


def everything(held: Outbox) -> dict[str, Any]:
    """Return what a store holds, in short."""
    return {
        "store": str(held.folder),
        "served": held.is_served(),
        "counts": dict(held.totals()),
        "waiting_bytes": held.waiting_bytes(),
        "kept_bytes": held.kept_bytes(),
        "warnings": list(held.warnings()),
        "working": [asdict(one) for one in held.history(state="working", most=_MOST)],
        "waiting": [asdict(one) for one in held.queue(_MOST)],
        "rejected": [asdict(one) for one in held.history(state="rejected", most=_MOST)],
        "done": [asdict(one) for one in held.history(state="done", most=_MOST)],
        "undelivered": [_delivery(held, one) for one in held.undelivered()],
    }


def one(held: Outbox, id_: str) -> dict[str, Any]:
    """Return all that is known of a submission; events as they happened."""
    found = held.submission(id_)
    if found is None:
        raise LookupError(f"the submission {id_} was forgotten meanwhile")
    return {
        "store": str(held.folder),
        "served": held.is_served(),
        **asdict(found),
        "position": held.position(found) if found.state == "waiting" else None,
        "files": [asdict(file) for file in held.files(id_).values()],
        "undelivered": [_delivery(held, each) for each in held.undelivered() if each.submission == id_],
        "events": [dict(event) for event in reversed(held.events(id_))],
    }


def all_lines(facts: Mapping[str, Any]) -> Iterator[str]:
    """Yield the sentences about a store."""
    counts, waiting = facts["counts"], facts["waiting_bytes"] / _MIB
    yield _place(facts)
    yield (
        f"{counts['working']} at work, {counts['waiting']} waiting ({waiting:.1f} MiB to be computed), "
        f"{counts['done']} done, {counts['rejected']} rejected; {facts['kept_bytes'] / _MIB:.1f} MiB kept."
    )
    for state in ("working", "waiting", "rejected", "done"):
        for found in facts[state]:
            yield f"{_state(found)}  {found['id']}"
        if (more := counts[state] - len(facts[state])) > 0:
            yield f"… and {more} more {state}."
    yield from _undelivered(facts)
    for warning in facts["warnings"]:
        yield f"Warning: {warning}."


def one_lines(facts: Mapping[str, Any]) -> Iterator[str]:
    """Yield the sentences about a submission."""
    sender = f" by {shown(facts['sender'])}" if facts["sender"] else ""
    yield _place(facts)
    yield f"{shown(facts['name'], 200)}, {facts['size']:,} bytes, handed in{sender} at {_time(facts['received_at'])}."
    yield _state(facts)
    if facts["position"]:
        yield f"{facts['position']} are ahead of it."
    if facts["same_as"]:
        yield f"It was answered with the result of {facts['same_as']}, which is the same submission."
    for file in facts["files"]:
        yield f"File: {file['role']}, {shown(file['name'], 200)}, {file['size']:,} bytes, sha256 {file['sha256']}"
    yield from _undelivered(facts)
    for event in facts["events"]:
        yield f"{_time(event['at'])} {event['kind']}{_why(event['text'])}"


def _place(facts: Mapping[str, Any]) -> str:
    return f"Store {shown(facts['store'], 4096)}: {'a' if facts['served'] else 'no'} server works on it."


def _state(facts: Mapping[str, Any]) -> str:
    """Return how far a submission is, by its name."""
    name, state = shown(facts["name"], 200), facts["state"]
    if state == "working":
        return f"At work: {name}, {facts['rows_done']:,} of {facts['rows']:,} rows, since {_time(facts['began_at'])}."
    if state == "waiting":
        again = f" until {_time(facts['not_before'])}" if facts["not_before"] > time.time() else ""
        return f"Waiting{again}: {name}{_why(facts['trouble'])}."
    words = facts["reason"] or facts["words"]
    return f"{'Done' if state == 'done' else 'Rejected'}: {name}{_why(words.removesuffix('.'))}."


def _undelivered(facts: Mapping[str, Any]) -> Iterator[str]:
    for each in facts["undelivered"]:
        tried = f"; tried {each['tries']} times, again at {_time(each['not_before'])}" if each["tries"] else ""
        yield f"Not delivered yet: {each['what']} of {shown(each['name'], 200)}{_why(each['trouble'])}{tried}."


def _delivery(held: Outbox, delivery: Delivery) -> dict[str, Any]:
    found = held.submission(delivery.submission)
    return {
        "submission": delivery.submission,
        "name": found.name if found else "",
        "what": delivery.file.role if delivery.file else delivery.kind,
        "target": delivery.target,
        "tries": delivery.tries,
        "trouble": delivery.trouble,
        "not_before": delivery.not_before,
    }


def _why(text: str) -> str:
    return f": {shown(text, 400)}" if text else ""


def _time(seconds: float) -> str:
    return time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(seconds))
