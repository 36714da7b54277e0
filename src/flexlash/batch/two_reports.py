"""Two stored reports or submissions → what changed between them, in the words of `flexlash diff`, told by a worker."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from flexlash.batch.answer import Travelling
from flexlash.reading.read import Source
from flexlash.reading.reading_limits import ReadingLimits
from flexlash.reading.refusal import Refusal
from flexlash.schema.findings import finding

if TYPE_CHECKING:
    from flexlash.comparison.sides import Side

__all__ = ["ComparisonTask", "compare"]

_MOST_LINES = 500
"""Most lines that are told."""


@dataclass(frozen=True, kw_only=True)
class ComparisonTask(Travelling):
    """Two reports or submissions to compare, the older first, each under the name by which it is to be called."""

    old: Source
    new: Source
    limits: ReadingLimits = field(default_factory=ReadingLimits)


def compare(task: bytes) -> bytes:
    """Return what differs between two files, as JSON: the same bytes for the same task, and nothing is written.

    `lines` are sentences in order, those of a variant indented below its name, the most important last; `differs` says
    whether anything does. `counts` are those of `flexlash diff --json`, `results_compared` says whether both have
    results. A file that is neither report nor submission gives `refused`, with message and fix, which are its lines.
    """
    return json.dumps(_told(ComparisonTask.of(task)), ensure_ascii=False, separators=(",", ":")).encode()


def _told(task: ComparisonTask) -> dict[str, Any]:
    from flexlash.comparison.difference import difference
    from flexlash.comparison.difference_lines import difference_lines
    from flexlash.comparison.sides import side_of_source

    sides: list[Side] = []
    for source in (task.old, task.new):
        try:
            sides.append(side_of_source(source, task.limits))
        except Refusal as refusal:
            return _refused(source.name, refusal)
    old, new = sides
    found = difference(old, new)
    lines = list(difference_lines(found, all_by=""))
    if len(lines) > _MOST_LINES:
        lines = [*lines[: _MOST_LINES - 2], f"… and {len(lines) - _MOST_LINES + 1} more lines", lines[-1]]
    return {
        "refused": None,
        "differs": not found.is_none,
        "results_compared": found.has_results,
        "counts": found.counts,
        "lines": lines,
    }


def _refused(name: str, refusal: Refusal) -> dict[str, Any]:
    """Return why a file cannot be compared."""
    why = finding(refusal.code, **{"file": name, **refusal.facts})
    return {
        "refused": {"code": why.code, "message": why.message, "fix": why.fix},
        "differs": False,
        "results_compared": False,
        "counts": {},
        "lines": [why.message, why.fix],
    }
