"""The share over the limit → the verdict (green, amber, red), whether it is settled, how many variants have each."""

from __future__ import annotations

from collections import Counter
from typing import Any

from flexlash.analysis.outcome import Outcome
from flexlash.analysis.whole_batch import verdicts_of
from flexlash.schema.limit_verdict import BOUNDS as ALLOWED
from flexlash.schema.limit_verdict import Verdict, limit_verdict

__all__ = [
    "BOUNDS",
    "COLOURS",
    "LIGHTS",
    "NO_VERDICT",
    "RULES",
    "UNSETTLED",
    "firm",
    "light",
    "straddled",
    "verdict_counts",
]

NO_VERDICT = "–"
"""What stands in the place of a verdict where there is no limit."""

UNSETTLED = "?"
"""What follows a verdict that further points may change."""

RULES = {
    "red": "fewer than 97.5 % of units within the limit",
    "amber": "97.5 to 99.865 % of units within the limit",
    "green": "at least 99.865 % of units within the limit",
}
"""The rule of each verdict, in words."""

_FORMATS = {"red": "error", "amber": "warning", "green": "ok"}

COLOURS = {**_FORMATS, **{f"{verdict}{UNSETTLED}": look for verdict, look in _FORMATS.items()}, NO_VERDICT: "text"}
"""The cell format of each verdict, settled or not."""

LIGHTS: dict[Verdict | None, str] = {"meets": "green", "marginal": "amber", "fails": "red", None: NO_VERDICT}
"""The colour of each verdict."""

BOUNDS = {LIGHTS[verdict]: most for verdict, most in ALLOWED.items()}
"""Greatest share of units over the limit that each verdict allows; red allows any."""

_KEYS = tuple(f"probability_over_limit{end}" for end in ("", "_low", "_high"))


def light(row: dict[str, Any]) -> str:
    """Return a Results row's verdict: green, amber or red, with ? where it is not settled; a dash without a limit."""
    return _verdict(*(row[key] for key in _KEYS))


def firm(verdict: str) -> str:
    """Return a verdict without its ?."""
    return verdict.removesuffix(UNSETTLED)


def straddled(row: dict[str, Any]) -> list[float]:
    """Return the shares at which the verdict changes that the 95 % interval of a row's share has on both sides."""
    low, high = row["probability_over_limit_low"], row["probability_over_limit_high"]
    return [] if low is None or high is None else _straddled(low, high)


def verdict_counts(outcome: Outcome) -> Counter[str]:
    """Return how many computed variants of the whole submission have each verdict; those with ? are counted apart."""
    whole = outcome.whole
    every, doubtful = (whole.verdicts, whole.unsettled) if whole else verdicts_of(outcome.results)
    computed = whole.computed if whole else outcome.results["p97_5_arcmin"].count()
    counts = {NO_VERDICT: computed - sum(every.values())}
    for verdict, count in every.items():
        unsettled = doubtful.get(verdict, 0)
        counts |= {LIGHTS[verdict]: count - unsettled, f"{LIGHTS[verdict]}{UNSETTLED}": unsettled}
    return Counter({verdict: count for verdict, count in counts.items() if count})


def _verdict(share: float | None, low: float | None, high: float | None) -> str:
    verdict = LIGHTS[limit_verdict(share)]
    return f"{verdict}{UNSETTLED}" if low is not None and high is not None and _straddled(low, high) else verdict


def _straddled(low: float, high: float) -> list[float]:
    return [share for share in BOUNDS.values() if low <= share < high]
