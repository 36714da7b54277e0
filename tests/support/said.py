"""What the Summary says of an outcome."""

from __future__ import annotations

from flexlash.analysis.outcome import Outcome
from flexlash.analysis.recommendations import recommendations_of
from flexlash.report.wording.sentences import sentences

__all__ = ["said_of"]


def said_of(outcome: Outcome) -> dict[str, str]:
    """Return the Summary's sentences by topic."""
    return dict(sentences(outcome, recommendations_of(outcome.computed, outcome.settings)))
