"""Lots and parts in words: how far either scatter, how many lots fail, and which units a share is a share of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flexlash.schema.angle_unit import AngleUnit
from flexlash.schema.findings import spelled_out
from flexlash.schema.number_words import (
    ALL_UNITS,
    INTERVAL,
    LEAST_SHARE,
    RARE_SHARE,
    glance,
    places,
    rounded,
    share_unit,
    share_words,
)

__all__ = [
    "is_settled",
    "lots_words",
    "of_all_units",
    "reach_words",
    "scatters_between_lots",
    "scatters_within_lots",
    "some_lots_fail",
]

_OF_LOTS = {" %": " % of lots", " ppm": " lots in a million", " ppb": " lots in a billion"}
"""Units in which a share of lots is told, for those of other shares."""

_UNKNOWN = 0.05
"""Standard error of a share of 0 or 1 from which it is not known whether all lots fail, which are alike, or none."""

_REACH_DIGITS = 2
"""Digits in which it is told how far parts or lots scatter."""


def scatters_between_lots(row: Mapping[str, Any]) -> bool:
    """Return whether lots differ, by a row of Results."""
    return bool(row.get("between_lots_sd_arcmin"))


def scatters_within_lots(row: Mapping[str, Any]) -> bool:
    """Return whether the parts of a lot differ, by a row of Results."""
    return bool(row.get("within_lot_sd_arcmin"))


def reach_words(sd: float, angles: AngleUnit) -> str:
    """Return within how much of their middle 95 % lie that scatter with an sd [arcmin], as of a normal.

    >>> from flexlash.schema.angle_unit import ARC_MINUTES
    >>> reach_words(0.0019357, ARC_MINUTES)
    '± 0.0038′'
    """
    return f"± {angles.spelled_out(INTERVAL * sd, _REACH_DIGITS)}"


def of_all_units(row: Mapping[str, Any]) -> str:
    """Return the share over the limit of a row of Results, without its interval, as one of all units.

    >>> of_all_units({"probability_over_limit": 5.062e-5, "probability_over_limit_low": 5.06e-5,
    ...               "probability_over_limit_high": 5.064e-5})
    '50.62 ppm of all units'
    """
    words = share_words(row).split(" (")[0]
    return f"{words} units" if words in ALL_UNITS else f"{words} of all units"


def lots_words(row: Mapping[str, Any], has: str = "", have: str = "") -> str:
    """Return how many lots fail by a row of Results, and a verb for one or for many; an empty text without a limit.

    >>> lots_words({"lots_failing": 1.1493e-4, "lots_failing_standard_error": 1.6e-7}, "has", "have")
    '115 lots in a million have'
    >>> lots_words({"lots_failing": 0.2576, "lots_failing_standard_error": 0.004})
    '25.8 % of lots'
    >>> lots_words({"lots_failing": 0.0, "lots_failing_standard_error": 0.0}, "fails", "fail")
    'no lot fails'
    """
    share, error = row.get("lots_failing"), row.get("lots_failing_standard_error") or 0.0
    if share is None:
        return ""
    if row.get("between_lots_sd_arcmin") == 0:
        return f"{'every lot' if share else 'no lot'} {has}".strip() if is_settled(row) else "not settled"
    for rare, one in ((share, "no lot"), (1 - share, "every lot")):
        if rare < LEAST_SHARE and error < LEAST_SHARE:
            # What is told as none of lots that differ is hardly ever so.
            return f"{'practically ' if scatters_between_lots(row) else ''}{one} {has}".strip()
    words = _nearly_every(share, error) if 1 - share < RARE_SHARE else _counted(share, error)
    return f"{words} {have}".strip()


def some_lots_fail(row: Mapping[str, Any]) -> bool:
    """Return whether some lots fail and others do not, by a row of Results."""
    share = row.get("lots_failing")
    return share is not None and scatters_between_lots(row) and LEAST_SHARE <= share <= 1 - LEAST_SHARE


def is_settled(row: Mapping[str, Any]) -> bool:
    """Return whether it is known of lots that are all alike whether they fail."""
    return (row.get("lots_failing_standard_error") or 0.0) < _UNKNOWN


def _counted(share: float, error: float) -> str:
    """Return how many lots a share is, in three digits, or fewer where its standard error is greater."""
    if share < 2 * error:
        factor, unit = _unit(share + INTERVAL * error)
        return f"at most {spelled_out((share + INTERVAL * error) * factor, _REACH_DIGITS)}{unit}"
    factor, unit = _unit(share)
    return f"{rounded(share * factor, max(error * factor, 10 * glance(share * factor)))}{unit}"


def _nearly_every(share: float, error: float) -> str:
    """Return a share of almost all lots in per cent, in as many decimals as its standard error leaves."""
    rest = 1 - share
    if rest < 2 * error:
        rest = rest + INTERVAL * error
        return f"at least {_per_cent_of_lots(rest, 10 * glance(rest))}"
    return _per_cent_of_lots(rest, max(error, 10 * glance(rest)))


def _per_cent_of_lots(rest: float, error: float) -> str:
    """Return all lots but a share of them in per cent, down to the first digit of its error."""
    return f"{100 - 100 * rest:.{max(0, places(100 * error))}f} % of lots"


def _unit(share: float) -> tuple[float, str]:
    """Return factor and name of the unit in which a share of lots is told."""
    factor, unit = share_unit(share)
    return factor, _OF_LOTS[unit]
