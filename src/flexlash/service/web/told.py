"""What the pages say, as JSON at the same addresses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flexlash.service.records import StoredFile, StoredSubmission
from flexlash.service.store import Store
from flexlash.service.web import views

__all__ = ["history_told", "submission_told"]

_SHOWN = (
    "id", "name", "sha256", "size", "door", "sender", "received_at", "state", "began_at", "ended_at", "rows_done",
    "rows", "exit_code", "words", "reason", "trouble", "same_as",
)  # fmt: skip


def _brief(one: StoredSubmission) -> dict[str, Any]:
    return {key: getattr(one, key) for key in _SHOWN} | {
        "counts": dict(one.counts),
        "href": f"/submissions/{one.id}",
    }


def submission_told(store: Store, one: StoredSubmission) -> dict[str, Any]:
    """Return a submission with its files and the facts of its page; times in seconds since 1970."""
    files = store.files(one.id)
    return _brief(one) | {
        "position": store.position(one) if one.state == "waiting" else None,
        "seconds_left": views.seconds_left(one),
        "files": [_file(one, file) for role, file in files.items() if role != "page"],
        "page": views.facts_of_page(store, files),
    }


def _file(one: StoredSubmission, file: StoredFile) -> dict[str, Any]:
    href = f"/submissions/{one.id}/files/{file.role}"
    return {"role": file.role, "name": file.name, "size": file.size, "sha256": file.sha256, "href": href}


def history_told(found: Sequence[StoredSubmission]) -> dict[str, Any]:
    """Return submissions, and where those before them are."""
    return {"submissions": [_brief(one) for one in found], "before": found[-1].number if found else None}
