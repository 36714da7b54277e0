"""A Results row → how far a percentile is from its limit [arcmin], in words and as a number format, digits alike."""

from __future__ import annotations

import math
from typing import Any

from flexlash.report.layout.styles import decimals_of
from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.limit_verdict import VerdictBounds
from flexlash.schema.number_words import glance, rounded

__all__ = ["STORED", "deciding_percentile", "distance", "distance_format", "distance_words"]

_DIGITS = 2
"""Digits in which a distance is told, where the percentile's own digits leave fewer."""

_FINEST = 1e-6
"""Part of a percentile below which no distance from its limit is told."""

STORED = {"97.5 %": "p97_5", "99 %": "p99", "99.865 %": "p99_865"}
"""Percentiles of Results, by the share of units that are to be within the limit."""


def deciding_percentile(bounds: VerdictBounds) -> tuple[str, str]:
    """Return key and name of the percentile that decides the verdict, P99.865 where that of the target is not stored.

    >>> deciding_percentile(VerdictBounds()), deciding_percentile(VerdictBounds.of(99.9))
    (('p99_865', 'P99.865'), ('p99_865', 'P99.865'))
    >>> deciding_percentile(VerdictBounds.of(99))
    ('p99', 'P99')
    """
    key = STORED.get(bounds.target_words, "p99_865")
    return key, f"P{key[1:].replace('_', '.')}"


def distance(row: dict[str, Any], key: str) -> float:
    """Return how far a percentile of a Results row is over its limit [arcmin], negative when under."""
    return float(row[f"{key}_arcmin"] - row["backlash_limit_arcmin"])


def distance_words(row: dict[str, Any], key: str, angles: AngleUnit) -> str:
    """Return how far a percentile is from its limit, in words.

    >>> from flexlash.schema.angle_unit import ARC_MINUTES
    >>> distance_words({"p97_5_arcmin": 6.262, "p97_5_standard_error_arcmin": 1e-6, "backlash_limit_arcmin": 3.8},
    ...                "p97_5", ARC_MINUTES)
    '2.462′ over'
    """
    off = angles.of(distance(row, key))
    if off == 0:
        return "right at"
    least = _decade(_step(row, key, angles))
    words = rounded(abs(off), least)
    side = "over" if off > 0 else "under"
    return f"{words}{angles.sign} {side}" if float(words) else f"less than {rounded(least, least)}{angles.sign} {side}"


def distance_format(row: dict[str, Any], key: str, angles: AngleUnit) -> str:
    """Return the number format that shows a distance with its sign and in the digits of the words."""
    places = decimals_of(_step(row, key, angles), "plain")
    return f"+{places};-{places};{places}"


def _step(row: dict[str, Any], key: str, angles: AngleUnit) -> float:
    """Return the least difference told, in a unit: two digits or as fine as the percentile, no finer than is known."""
    value, off = angles.of(row[f"{key}_arcmin"]), angles.of(abs(distance(row, key)))
    fine = min(glance(value), _decade(off) * 10.0 ** (1 - _DIGITS) if off else math.inf)
    return float(max(angles.of(row[f"{key}_standard_error_arcmin"] or 0.0), fine, value * _FINEST))


def _decade(value: float) -> float:
    """Return the power of ten of a number's first digit."""
    return float(10.0 ** math.floor(math.log10(value)))
