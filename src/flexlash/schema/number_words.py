"""Numbers in words: shares with their interval, and no more digits than are known."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from flexlash.schema.findings import spelled_out

__all__ = [
    "ALL_UNITS",
    "INTERVAL",
    "LEAST_SHARE",
    "RARE_SHARE",
    "brief_share",
    "glance",
    "grouped",
    "places",
    "range_words",
    "rounded",
    "share_error",
    "share_unit",
    "share_words",
]

INTERVAL = 1.96
"""Standard errors to either side of a number that make its 95 % interval."""


_SHORT = 9999
"""Greatest number whose digits are not grouped."""


def grouped(count: int) -> str:
    """Return a whole number with its digits in groups of three, where it has five or more.

    >>> grouped(9999), grouped(10_000)
    ('9999', '10,000')
    """
    return f"{count:,}" if count > _SHORT else str(count)


def places(error: float) -> int:
    """Return to how many decimals a number is told: down to the first digit of its standard error.

    This is the one rule of digits, in sentences, number formats and formulas alike. The ends of an interval have the
    place of their number, from which they differ by 1.96 errors, so visibly. Negative: to tens, hundreds, ….

    >>> places(0.0021), places(0.3), places(1.0), places(40.0)
    (3, 1, 0, -1)
    """
    return -math.floor(math.log10(error))


def share_error(low: float, high: float) -> float:
    """Return the standard error of a share, from the ends of its 95 % interval."""
    return (high - low) / (2 * INTERVAL)


def share_words(row: Mapping[str, Any]) -> str:
    """Return the probability over limit of a Results row with its interval, never as a bare 0 or 100 %.

    >>> share_words({"probability_over_limit": 0.0, "probability_over_limit_low": 0.0,
    ...              "probability_over_limit_high": 1.1e-4})
    'at most 110 ppm'
    >>> share_words({"probability_over_limit": 0.412, "probability_over_limit_low": 0.407,
    ...              "probability_over_limit_high": 0.417})
    '41.2 % (40.7 to 41.7 %)'
    """
    value, low, high = (row[f"probability_over_limit{end}"] for end in ("", "_low", "_high"))
    if low == high and value in (0, 1):
        return "all" if value else "none"
    if 1 - value < RARE_SHARE:
        return _nearly_all(value, low, high)
    return _interval(value, low, high)


def brief_share(row: Mapping[str, Any]) -> str:
    """Return the probability over limit of a Results row in three digits at most, without its interval.

    >>> brief_share({"probability_over_limit": 5.29654e-6, "probability_over_limit_low": 5.29651e-6,
    ...              "probability_over_limit_high": 5.29657e-6})
    '5.3 ppm'
    """
    value, low, high = (row[f"probability_over_limit{end}"] for end in ("", "_low", "_high"))
    if not _BRIEF <= value <= 1 - RARE_SHARE or high - low > value * _ROUGH:
        return share_words(row).split(" (")[0]
    return _share(value, 3)


def range_words(low: float, high: float) -> str:
    """Return the interval of a share that is not known well, in two digits, or as many as keep its ends apart.

    An end that cannot be told is left out.

    >>> range_words(1.2e-5, 8.04e-4), range_words(0.0, 8.04e-4), range_words(0.4121, 0.99934)
    ('12 to 800 ppm', 'at most 800 ppm', '41 to 99.934 %')
    >>> range_words(0.001782, 0.001817)
    '0.178 to 0.182 %'
    """
    if high < LEAST_SHARE:
        return _NONE
    if low > 1 - LEAST_SHARE:
        return _ALL
    factor, unit = share_unit(high)
    is_open = high > 1 - LEAST_SHARE
    if low < LEAST_SHARE:
        return "0 to 100 %" if is_open else f"at most {_in_digits(high, factor)}{unit}"
    own, its = share_unit(low) if low < _FAR_APART * high else (factor, unit)
    if is_open:
        return f"at least {_in_digits(low, own)}{its}"
    pairs = ((_in_digits(low, own, digits), _in_digits(high, factor, digits)) for digits in range(2, _MOST_DIGITS))
    least, most = next((pair for pair in pairs if pair[0] != pair[1]), (_in_digits(low, own), _in_digits(high, factor)))
    return f"{least}{its if its != unit else ''} to {most}{unit}"


def _in_digits(share: float, factor: float, digits: int = 2) -> str:
    """Return a share times a factor in so many digits of it or of what it leaves to 1."""
    if share <= 1 / 2:
        return spelled_out(share * factor, digits)
    return rounded(share * factor, factor * 10.0 ** (math.floor(math.log10(1 - share)) + 1 - digits))


_UNITS = ((1.0, 100.0, " %"), (1e-3, 1e6, " ppm"), (1e-6, 1e9, " ppb"))
"""Shares below the first number are told in the unit, which is the factor times the share."""

RARE_SHARE = 1e-3
"""A share that leaves less than this to 1 is told by what it leaves."""

_FINEST = 1e-4
"""Part of a share that is not told in words, however well it is known."""

_BRIEF = 1e-6
"""Shares below it are told in two digits at most, without interval."""

LEAST_SHARE = 1e-9
"""Shares below it are told as none: tolerances do not bear more."""

_ROUGH = 0.01
"""Width of an interval over its share beyond which three digits are not known."""

_MOST_DECIMALS = 10
"""Decimals of a share in per cent, which leave two digits of the least rest that is told."""

_MOST_DIGITS = 7
"""Digits from on which the ends of an interval are told alike."""

_FAR_APART = 0.01
"""An end of an interval that is less than so much of the other is told in a unit of its own."""

_NONE, _ALL = "practically none", "practically all"

ALL_UNITS = frozenset({"all", _ALL})
"""What share_words says where no unit, or hardly one, is left out."""


def share_unit(share: float) -> tuple[float, str]:
    """Return factor and name of the unit in which a share is told.

    >>> share_unit(0.02), share_unit(1.2e-4), share_unit(3e-8)
    ((100.0, ' %'), (1000000.0, ' ppm'), (1000000000.0, ' ppb'))
    """
    return [(factor, name) for most, factor, name in _UNITS if share < most or most == 1][-1]


def _interval(value: float, low: float, high: float) -> str:
    """Return a share with its interval, in the unit of its upper end."""
    if high < LEAST_SHARE:
        return _NONE
    if value < LEAST_SHARE:
        return f"at most {_share(high, 3)}"
    if value < _BRIEF:
        return _share(value, 2 if high - low < value / 5 else 1)
    if low == high:
        return _share(value, 3)
    factor, unit = share_unit(high)
    finest, error = value * _FINEST, min(share_error(low, high), value, 1 - value)
    if places(error) > places(finest):
        return f"{rounded(value * factor, finest * factor)}{unit}"
    told, *ends = (rounded(end * factor, error * factor) for end in (value, low, high))
    if told in ends:  # an interval that reaches much further to one side
        told, *ends = (rounded(end * factor, error * factor / 10) for end in (value, low, high))
    return f"{told}{unit} ({ends[0]} to {ends[1]}{unit})"


def _nearly_all(value: float, low: float, high: float) -> str:
    """Return a share of almost all with its interval, in as many decimals of per cent as what is left has digits."""
    if 1 - low < LEAST_SHARE:
        return _ALL
    if 1 - value < LEAST_SHARE:
        told = _per_cent(low, _digit(1 - low, 3)).removesuffix(" %")
        return f"at least {told.rstrip('0').rstrip('.')} %"
    rest = 1 - value
    error = min(share_error(low, high), rest)
    finest = max(rest * _FINEST, _digit(rest, 2 if rest < _BRIEF else 3) if low == high or rest < _BRIEF else 0.0)
    if error < finest or rest < _BRIEF:
        return _per_cent(value, max(finest, _digit(error, 1) if error > 0 else 0.0))
    told, *ends = (_per_cent(end, error) for end in (value, low, high))
    if told in ends:  # an interval that reaches much further to one side
        told, *ends = (_per_cent(end, error / 10) for end in (value, low, high))
    return f"{told} ({ends[0].removesuffix(' %')} to {ends[1]})"


def _digit(value: float, digits: int) -> float:
    """Return the last of so many digits of a number above 0, as a power of ten."""
    return float(10.0 ** (math.floor(math.log10(value)) + 1 - digits))


def _per_cent(share: float, error: float) -> str:
    """Return a share in per cent down to the first digit of its error."""
    return f"{100 * share:.{max(0, min(_MOST_DECIMALS, places(100 * error)))}f} %"


def _share(share: float, digits: int) -> str:
    """Return one share in per cent, ppm or ppb."""
    factor, unit = share_unit(share)
    return f"{spelled_out(share * factor, digits)}{unit}"


def rounded(value: float, error: float) -> str:
    """Return a number down to the first digit of its standard error, in five digits where it has none.

    >>> rounded(3.684217, 0.0021), rounded(3.684217, 0.0), rounded(41.23, 0.3)
    ('3.684', '3.6842', '41.2')
    """
    if not error > 0:
        return f"{value:.5g}"
    return f"{value:.{max(0, min(8, places(error)))}f}"


def glance(value: float) -> float:
    """Return the last of the four digits in which a number is told at a glance.

    >>> glance(6.261963), glance(0.0)
    (0.001, 0.0)
    """
    return float(10.0 ** (math.floor(math.log10(value)) - 3)) if value > 0 else 0.0
