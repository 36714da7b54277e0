"""What the templates show, from what the store has: one function a page, each returning the names its template uses."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from typing import Any, cast

from flexlash.report.page.shape import PageFacts
from flexlash.schema.columns import ENTRY_SHEETS
from flexlash.service.records import StoredFile, StoredSubmission
from flexlash.service.store import Store
from flexlash.service.web import lists, submission_page, variant_page
from flexlash.service.web.words import Moment, remaining

__all__ = [
    "checked",
    "difference",
    "explained",
    "facts_of_page",
    "hand_in",
    "history",
    "how_to_fill",
    "rules",
    "seconds_left",
    "submission",
    "variant",
]

_LATELY = 8


def hand_in(store: Store, *, fault: str = "") -> dict[str, Any]:
    """Return the form, what was handed in lately, and what is wrong with what was sent by the form."""
    waiting = store.totals()["waiting"]
    return {"view": lists.hand_in_view(store.history(most=_LATELY), time.time(), waiting=waiting), "fault": fault}


def submission(store: Store, one: StoredSubmission) -> dict[str, Any]:
    """Return how far a submission is, or what came of it."""
    files = store.files(one.id)
    view = submission_page.submission_view(
        one,
        time.time(),
        facts=facts_of_page(store, files),
        files=files,
        before=store.position(one) if one.state == "waiting" else 0,
        waiting=store.totals()["waiting"],
        first=store.submission(one.same_as) if one.same_as else None,
        previous=store.previous(one) if "report" in files else None,
        events=(events := store.events(one.id)),
        undelivered=_undelivered(store, one, events),
    )
    return {"view": view}


def variant(store: Store, one: StoredSubmission, number: int) -> dict[str, Any] | None:
    """Return the page of a variant, counted from 0 as drawn; None where there is none."""
    facts = facts_of_page(store, store.files(one.id))
    view = variant_page.variant_view(one, facts, number) if facts else None
    return {"view": view} if view else None


def checked(name: str, page: Mapping[str, Any]) -> dict[str, Any]:
    """Return what was found in a submission of which nothing is kept, from the facts of its page."""
    return {"view": submission_page.checked_view(name, cast("PageFacts", page))}


def difference(new: StoredSubmission, old: StoredSubmission | None, told: Mapping[str, Any] | None) -> dict[str, Any]:
    """Return what changed against the previous submission of the same name, None where there is none."""
    when = Moment.of(old.received_at, time.time()) if old else None
    return {"submission": new, "previous": old, "when": when, "told": told}


def history(store: Store, *, text: str, state: str, before: int | None) -> dict[str, Any]:
    """Return submissions, the latest first, by a text in name or sender, a state, before a number."""
    found = store.history(text=text, state=state, before=before, most=lists.PER_PAGE + 1)
    view = lists.history_view(found, time.time(), text=text, state=state, before=before, totals=store.totals())
    return {"view": view}


def rules(store: Store) -> dict[str, Any]:
    """Return which rules are broken most, over all submissions."""
    return {"view": lists.rules_view(store.failing_most())}


def explained(code: str) -> dict[str, Any] | None:
    """Return what a finding means, None where there is no such code."""
    found = lists.explained(code)
    return {"explanation": found} if found else None


def how_to_fill() -> dict[str, Any]:
    """Return how the template is filled in, and what every finding is called."""
    return {"sheets": ENTRY_SHEETS, "codes": lists.codes_by_level()}


def seconds_left(one: StoredSubmission) -> float | None:
    """Return the seconds until a submission at work will be done, None where that cannot be told."""
    speed = remaining(one, time.time())[0] if one.state == "working" else 0.0
    return (one.rows - one.rows_done) / speed if speed else None


def _undelivered(store: Store, one: StoredSubmission, events: Sequence[Mapping[str, Any]]) -> str:
    """Return what keeps a submission's files from the folder to which they belong, in a sentence."""
    if one.door != "folder":
        return ""
    dropped = [event["text"] for event in events if event["kind"] == "not delivered"]
    waiting = [each for each in store.undelivered() if each.submission == one.id and each.kind != "message"]
    troubles = dropped or [f"{each.trouble}; it is tried again" for each in waiting if each.trouble]
    return f"{troubles[0][:1].upper()}{troubles[0][1:].rstrip('.')}." if troubles else ""


def facts_of_page(store: Store, files: Mapping[str, StoredFile]) -> PageFacts | None:
    """Return the facts of a submission's page, None before there are any."""
    if "page" not in files:
        return None
    return cast("PageFacts", json.loads(store.blobs.read(files["page"].sha256)))
