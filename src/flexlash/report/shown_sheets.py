"""Which sheets a reader sees; the others stay hidden, are not printed, and no link leads to them."""

from __future__ import annotations

from flexlash.analysis.outcome import Outcome
from flexlash.report.drive.drive_page import SHEET as DRIVE
from flexlash.report.failing.failing_places import FAILING, failing_variants
from flexlash.report.levers_sheet import LEVERS
from flexlash.report.report_data import ReportData
from flexlash.report.submission_sheets import SUBMISSION, titles_of
from flexlash.report.sweeps.sweep_sheet import SHEET as SWEEP

__all__ = ["ALWAYS", "MOST_SHOWN", "ROOM", "shown_sheets"]

ALWAYS = ("Summary", "Results", "Explorer", "Contributions", "Findings", "About")
"""Sheets that every reader sees."""

ROOM = 8
"""Most sheets of one printed page that are seen; beside them that with a page for each failing variant."""

MOST_SHOWN = ROOM + 1


def shown_sheets(outcome: Outcome, data: ReportData) -> frozenset[str]:
    """Return the sheets of a report that can be seen: those that every reader needs, then by rank.

    Drive and Sweep, which somebody asked for, come first; the cheapest changes of Levers are on Failing variants, too.
    """
    failing = failing_variants(data.drawn, outcome.settings.verdict_bounds)
    asked = [DRIVE] * _has_drive(outcome) + [SWEEP] * bool(data.studies)
    levers = [LEVERS] * bool(data.levers.height)
    ranked = [*ALWAYS, *asked, *levers, *_guilty(outcome, "error"), "Trace", *_guilty(outcome, "warning")]
    return frozenset([*ranked[:ROOM], *[FAILING] * bool(failing)])


def _has_drive(outcome: Outcome) -> bool:
    return outcome.validated is not None and bool(outcome.validated.other_sources)


def _guilty(outcome: Outcome, level: str) -> list[str]:
    """Return the sheets as read of which a cell has a finding of a level, which leads there."""
    titles = titles_of(outcome.submission)
    guilty = {
        titles[finding.sheet]
        for finding in outcome.findings
        if finding.level == level and finding.address is not None and finding.sheet in titles
    }
    return sorted(guilty, key=lambda title: (title != SUBMISSION, title))
