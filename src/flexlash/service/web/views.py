"""What the templates show, from what the store has: one function a page, each returning the names its template uses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flexlash.service.records import StoredSubmission
from flexlash.service.store import Store

__all__ = [
    "checked",
    "difference",
    "explained",
    "hand_in",
    "history",
    "how_to_fill",
    "rules",
    "seconds_left",
    "submission",
    "variant",
]


def hand_in(store: Store, *, fault: str = "") -> dict[str, Any]:
    """Return the form, what was handed in lately, and what is wrong with what was sent by the form."""
    return {"latest": store.history(most=8), "fault": fault}


def submission(store: Store, one: StoredSubmission) -> dict[str, Any]:
    """Return how far a submission is, or what came of it."""
    return {"submission": one, "files": list(store.files(one.id).values())}


def variant(store: Store, one: StoredSubmission, number: int) -> dict[str, Any] | None:  # noqa: ARG001
    """Return the page of a variant, counted from 0 as drawn; None where there is none."""
    return None


def checked(name: str, page: Mapping[str, Any]) -> dict[str, Any]:
    """Return what was found in a submission of which nothing is kept, from the facts of its page."""
    return {"name": name, "page": page}


def difference(new: StoredSubmission, old: StoredSubmission | None, told: Mapping[str, Any] | None) -> dict[str, Any]:
    """Return what changed against the previous submission of the same name, None where there is none."""
    return {"submission": new, "previous": old, "told": told}


def history(store: Store, *, text: str, state: str, before: int | None) -> dict[str, Any]:
    """Return submissions, the latest first, by a text in name or sender, a state, before a number."""
    found = store.history(text=text, state=state, before=before)
    return {"submissions": found, "text": text, "state": state, "before": before}


def rules(store: Store) -> dict[str, Any]:
    """Return which rules are broken most, over all submissions."""
    return {"rules": store.failing_most()}


def explained(code: str) -> dict[str, Any] | None:  # noqa: ARG001
    """Return what a finding means, None where there is no such code."""
    return None


def how_to_fill() -> dict[str, Any]:
    """Return how the template is filled in."""
    return {}


def seconds_left(store: Store, one: StoredSubmission) -> float | None:  # noqa: ARG001
    """Return the seconds until a submission at work will be done, None where that cannot be told."""
    return None
