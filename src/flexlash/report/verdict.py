"""The verdict on a variant, its rule, and how many variants have which."""

from __future__ import annotations

from collections import Counter
from typing import Any

from flexlash.outcome import Outcome

__all__ = ["COLOURS", "NO_VERDICT", "RULES", "light", "verdict_counts"]

NO_VERDICT = "–"
"""What stands in the place of a verdict where there is no limit."""

RULES = {
    "red": "fewer than 97.5 % of units within the limit",
    "amber": "97.5 to 99.865 % of units within the limit",
    "green": "at least 99.865 % of units within the limit",
}
"""The rule of each verdict, in words."""

COLOURS = {"red": "error", "amber": "warning", "green": "ok", NO_VERDICT: "text"}
"""The cell format of each verdict."""


def light(row: dict[str, Any]) -> str:
    """Return a Results row's verdict: green, amber, red, or a dash without a limit."""
    return _verdict(row["backlash_limit_arcmin"], row["p97_5_arcmin"], row["p99_865_arcmin"])


def verdict_counts(outcome: Outcome) -> Counter[str]:
    """Return how many computed variants have each verdict."""
    columns = (outcome.results[f"{key}_arcmin"].to_list() for key in ("backlash_limit", "p97_5", "p99_865"))
    return Counter(_verdict(*numbers) for numbers in zip(*columns, strict=True) if numbers[1] is not None)


def _verdict(limit: float | None, tail: float, far_tail: float) -> str:
    if limit is None:
        return NO_VERDICT
    if far_tail <= limit:
        return "green"
    return "amber" if tail <= limit else "red"
