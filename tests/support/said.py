"""What the Summary says of an outcome."""

from __future__ import annotations

from flexlash.analysis.outcome import Outcome
from flexlash.report import report_data
from flexlash.report.wording.sentences import sentences

__all__ = ["said_of"]


def said_of(outcome: Outcome) -> dict[str, str]:
    """Return the Summary's sentences by topic."""
    drawn = report_data.ranked(outcome)[report_data.ROW].head(report_data.DRAWN).to_list()
    return dict(sentences(outcome, report_data.levers_of_variants(outcome, drawn)))
