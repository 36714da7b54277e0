"""The files of a result as buttons: which there are, in the order in which they are wanted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath

from flexlash.report.page.shape import PageFacts
from flexlash.schema.number_words import grouped
from flexlash.service.records import StoredFile, StoredSubmission
from flexlash.service.web.words import counted, size_words

__all__ = ["Download", "offered"]


@dataclass(frozen=True, kw_only=True)
class Download:
    """A file to download: its address, what its button says, how large it is, whether it is what one wants first."""

    role: str
    words: str
    size: str
    is_first: bool


_SAID = {"report", "checked"}
"""Files beside which one with the reasons, which the page says, is of no use."""


def offered(
    submission: StoredSubmission, facts: PageFacts | None, files: Mapping[str, StoredFile], *, partly: bool
) -> Sequence[Download]:
    """Return the files to download, in the order in which they are wanted."""
    if not submission.has_ended:
        return []
    computed = facts["counts"].get("computed", 0) if facts else 0
    fixes = facts["fixable"] if facts else 0
    unread = submission.state == "rejected" and bool(facts and facts["refused"])
    words = {
        "checked": "Reasons" if unread else "Marked copy",
        "fixed": f"File with {grouped(fixes)} certain fix{'' if fixes == 1 else 'es'}",
        "report": f"Report of the {counted(computed, 'row')}" if partly and computed > 1 else "Report",
        "results": "Results",
        "findings": "All findings",
        "reasons": "Reasons",
    }
    order = (
        list(words)
        if partly or submission.state == "rejected"
        else ["report", "results", "findings", "checked", "fixed", "reasons"]
    )
    there = [role for role in order if role in files and (role != "reasons" or not _SAID & set(files))]
    return [
        Download(
            role=role,
            words=f"{words[role]} ({PurePosixPath(files[role].name).suffix or 'file'})",
            size=size_words(files[role].size),
            is_first=role == there[0],
        )
        for role in there
    ]
