"""Submissions in a store: handed in, ended without a worker, delivered to nobody."""

from __future__ import annotations

from flexlash.service.records import Ending, HandedIn, RuleCount, StoredFile

__all__ = ["computed", "handed", "left"]


def handed(name="a.csv", **how):
    """Return a submission as it comes in."""
    return HandedIn(**{"name": name, "options": "o", "door": "page"} | how)


def computed(store, *, report=b"report", state="done", repeatable=True, rules=("E201",)):
    """Have the next submission end with a report, or none; return it."""
    taken = store.take()
    with store.blobs.keeping():
        files = []
        if report:
            sha256, size = store.blobs.put(report)
            files = [StoredFile(role="report", sha256=sha256, size=size, name="a-report.xlsx")]
        ending = Ending(
            state=state, exit_code=0, words="2 of 2 rows", files=files, is_repeatable=repeatable,
            rules=[RuleCount(level="error", code=code, sheet="Variants", column="x", cells=3) for code in rules],
        )  # fmt: skip
        assert store.end(taken.id, ending)
    return store.submission(taken.id)


def left(store):
    """Have everything leave the store; return what did, in order."""
    kinds = []
    while due := store.deliveries():
        for one in due:
            kinds.append(one.file.role if one.file else one.kind)
            store.delivered(store.choose_target(one, f"target {one.number}"))
    return kinds
