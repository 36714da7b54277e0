"""What the Summary says of an outcome."""

from __future__ import annotations

from flexlash.analysis.outcome import Outcome
from flexlash.report.report_data import DRAWN, ROW, levers_of_variants, ranked
from flexlash.report.wording.sentences import sentences

__all__ = ["said_of"]


def said_of(outcome: Outcome) -> dict[str, str]:
    """Return the Summary's sentences by topic."""
    drawn = ranked(outcome)[ROW].head(DRAWN).to_list()
    return dict(sentences(outcome, levers_of_variants(outcome, drawn)))
