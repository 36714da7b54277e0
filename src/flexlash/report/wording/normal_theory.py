"""A Results row → the share over the limit that a normal distribution of the same mean and sd would have."""

from __future__ import annotations

from collections.abc import Iterator

from scipy.special import ndtr

from flexlash.report.wording.summary_facts import Row, SummaryFacts
from flexlash.schema.number_words import brief_share

__all__ = ["NORMAL", "normal_share", "normal_theory", "normal_words"]

NORMAL = "Normal theory"
"""The topic of these sentences."""

_APART = 1.5
"""Times by which both shares differ from which on that is told."""

_ALL = 1 - 1e-15
"""Greatest share that is told: a normal distribution has no end."""

_LEAST = 1e-6
"""Share below which both are too rare to compare."""


def normal_share(row: Row) -> float | None:
    """Return the share over the limit by Z = (limit − mean)/sd alone; None without a limit or without scatter.

    >>> round(normal_share({"backlash_limit_arcmin": 4.0, "mean_arcmin": 3.4, "sd_arcmin": 0.2}), 8)
    0.0013499
    """
    limit, sd = row["backlash_limit_arcmin"], row["sd_arcmin"]
    if limit is None or not sd:
        return None
    return float(ndtr((row["mean_arcmin"] - limit) / sd))


def normal_words(row: Row) -> str:
    """Return that share as the computed one is told; a dash where there is none."""
    share = normal_share(row)
    if share is None:
        return "–"
    share = min(share, _ALL)
    return brief_share({f"probability_over_limit{end}": share for end in ("", "_low", "_high")})


def normal_theory(facts: SummaryFacts) -> Iterator[str]:
    """Yield of which variant Z tells a wrong share over the limit, by how much; nothing where it is near enough."""
    apart = [(ratio, row) for row in facts.judged.to_dicts() if (ratio := _times_apart(row)) > _APART]
    if not apart:
        return
    times, row = max(apart, key=lambda one: one[0])
    others = f", and by more than {_APART:g} times in {len(apart)} variants" if len(apart) > 1 else ""
    yield (
        f"Mean and standard deviation alone (Z, Cpk) would put {normal_words(row)} of {facts.named(row['variant'])} "
        f"over its limit, where {brief_share(row)} are: {times:.2g} times apart{others}. Do not judge by Z here."
    )


def _times_apart(row: Row) -> float:
    """Return how many times the greater share over the limit is the other one; 1 where both are too rare."""
    normal, real = normal_share(row), row["probability_over_limit"]
    if normal is None or max(normal, real) < _LEAST:
        return 1.0
    # A share is compared down to what can be told of it: nothing is infinitely many times as rare.
    small, great = sorted((max(normal, _LEAST), max(real, _LEAST)))
    return float(great / small)
