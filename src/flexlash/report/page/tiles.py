"""An outcome → its figures at a glance: of the findings, and of the limits."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from flexlash.analysis.outcome import Outcome
from flexlash.report.page.shape import Tile
from flexlash.report.wording.verdict import NO_VERDICT, UNSETTLED, verdict_counts, verdict_verb
from flexlash.schema.limit_verdict import VERDICTS, Verdict
from flexlash.schema.number_words import grouped

__all__ = ["finding_tiles", "verdict_tiles"]

_LOOKS: dict[Verdict, Literal["good", "bad", "warn"]] = {"fails": "bad", "marginal": "warn", "meets": "good"}


def finding_tiles(outcome: Outcome, *, ran: bool, to_fix: int, fixable: int) -> Iterator[Tile]:
    """Yield how many rows are ready, cells to fix, cells that are fixed without asking, warnings.

    Of a large table nothing is fixed.
    """
    counts = outcome.counts
    rows, computed, warnings = counts["rows"], counts["computed"], counts["warnings"]
    ready = f"{_noun(rows, 'row')} ready{', computed' if ran else ''}"
    yield Tile(number=f"{grouped(computed)} of {grouped(rows)}", words=ready, kind="good" if computed else "bad")
    yield Tile(number=grouped(to_fix), words=f"{_noun(to_fix, 'cell')} to fix", kind="bad" if to_fix else "plain")
    if outcome.whole is None:
        yield Tile(number=grouped(fixable), words="can be fixed for you", kind="plain")
    yield _warnings(warnings, "warn")


def verdict_tiles(outcome: Outcome) -> Iterator[Tile]:
    """Yield how many variants fail, are marginal, meet their limit or have none; nothing without one."""
    counts = verdict_counts(outcome)
    judged, without = counts.total() - counts[NO_VERDICT], counts[NO_VERDICT]
    for verdict in reversed(VERDICTS) if judged else ():
        doubtful = counts[f"{verdict}{UNSETTLED}"]
        count = counts[verdict] + doubtful
        target = f" {outcome.settings.verdict_bounds.target_words}" if verdict == "meets" else ""
        words = f"{verdict_verb(verdict, count)}{target}"
        doubt = f", {grouped(doubtful)} not settled" if doubtful else ""
        yield Tile(number=grouped(count), words=f"{words}{doubt}", kind=_LOOKS[verdict])
    if without:
        yield Tile(number=grouped(without), words="without a limit", kind="plain")
    if judged or without:
        yield _warnings(outcome.counts["warnings"], "plain")


def _warnings(count: int, kind: Literal["warn", "plain"]) -> Tile:
    return Tile(number=grouped(count), words=_noun(count, "warning"), kind=kind)


def _noun(count: int, noun: str) -> str:
    return noun if count == 1 else f"{noun}s"
