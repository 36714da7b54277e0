"""The share over the limit → the verdict in a word, whether it is settled, how many variants have each."""

from __future__ import annotations

from collections import Counter
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.analysis.whole_batch import verdicts_of
from flexlash.schema.limit_verdict import Verdict, VerdictBounds

__all__ = [
    "COLOURS",
    "NO_VERDICT",
    "UNSETTLED",
    "firm",
    "straddled",
    "verdict_counts",
    "verdict_rules",
    "verdict_verb",
    "verdict_word",
]

NO_VERDICT = "–"
"""What stands in the place of a verdict where there is no limit."""

UNSETTLED = "?"
"""What follows a verdict that further points may change."""

_FORMATS = {"fails": "error", "marginal": "warning", "meets": "ok"}

COLOURS: dict[str, str] = {
    **_FORMATS,
    **{f"{verdict}{UNSETTLED}": look for verdict, look in _FORMATS.items()},
    NO_VERDICT: "text",
}
"""The cell format of each verdict, settled or not."""


def verdict_rules(bounds: VerdictBounds) -> dict[str, str]:
    """Return the rule of each verdict in words, the worst first.

    >>> verdict_rules(VerdictBounds())["marginal"]
    '97.5 to 99.865 % of units within the limit'
    """
    within, target = f"{100 - 100 * bounds.marginal:.10g}", bounds.target_words
    return {
        "fails": f"fewer than {within} % of units within the limit",
        "marginal": f"{within} to {target} of units within the limit"
        if bounds.any_marginal
        else f"none where the target is {target}",
        "meets": f"at least {target} of units within the limit",
    }


def verdict_word(row: dict[str, Any], bounds: VerdictBounds) -> str:
    """Return a Results row's verdict, with ? where it is not settled; a dash without a limit."""
    verdict = bounds.verdict(row["probability_over_limit"]) or NO_VERDICT
    return f"{verdict}{UNSETTLED}" if straddled(row, bounds) else verdict


def verdict_verb(verdict: Verdict, count: int) -> str:
    """Return a verdict as so many variants have it.

    >>> verdict_verb("fails", 3), verdict_verb("fails", 1), verdict_verb("marginal", 0), verdict_verb("meets", 8)
    ('fail', 'fails', 'marginal', 'meet')
    """
    return verdict if count == 1 or verdict == "marginal" else verdict.removesuffix("s")


def firm(verdict: str) -> str:
    """Return a verdict without its ?."""
    return verdict.removesuffix(UNSETTLED)


def straddled(row: dict[str, Any], bounds: VerdictBounds) -> list[float]:
    """Return the shares at which the verdict changes that the 95 % interval of a row's share has on both sides."""
    return bounds.straddled(row["probability_over_limit_low"], row["probability_over_limit_high"])


def verdict_counts(outcome: Outcome) -> Counter[str]:
    """Return how many computed variants of the whole submission have each verdict; those with ? are counted apart."""
    whole = outcome.whole
    bounds = outcome.settings.verdict_bounds
    every, doubtful = (whole.verdicts, whole.unsettled) if whole else verdicts_of(outcome.results, bounds)
    computed = whole.computed if whole else outcome.results["p97_5_arcmin"].count()
    counts = {NO_VERDICT: computed - sum(every.values())}
    for verdict, count in every.items():
        unsettled = doubtful.get(verdict, 0)
        counts |= {verdict: count - unsettled, f"{verdict}{UNSETTLED}": unsettled}
    return Counter({verdict: count for verdict, count in counts.items() if count})
