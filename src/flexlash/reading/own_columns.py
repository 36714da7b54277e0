"""Columns that a submission has and flexlash does not use: what they hold, which the report keeps as it was."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

from flexlash.reading.raw import CommaNumber, DoubtfulNumber, RawValue
from flexlash.reading.whole_table import OwnKind

__all__ = ["is_number", "is_whole", "kind_of", "number_of"]

_NUMBER = re.compile(r"-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][+-]\d{1,3})?", re.ASCII)
"""A text of a CSV file that is a number and no part number such as 007 or 12E5."""

_MOST_DIGITS = 15
"""Digits of a number that every program keeps."""

_GREATEST = 2**63


def number_of(value: RawValue) -> float | int | None:
    """Return the number that a text of a CSV file is, None where it is none or would lose digits."""
    if not isinstance(value, str) or isinstance(value, DoubtfulNumber):
        return None
    text = value.strip()
    text = text.replace(",", ".") if isinstance(value, CommaNumber) else text
    digits = sum(character.isdigit() for character in text.lower().partition("e")[0])
    if not _NUMBER.fullmatch(text) or digits > _MOST_DIGITS:
        return None
    return int(text) if text.lstrip("-").isdigit() else float(text)


def kind_of(values: Iterable[RawValue | None]) -> OwnKind:
    """Return what the entries of a column are: whole numbers, numbers, or texts."""
    entries = [value for value in values if value is not None]
    if not entries or not all(map(is_number, entries)):
        return "text"
    return "whole" if all(map(is_whole, entries)) else "number"


def is_whole(value: RawValue) -> bool:
    """Whether a number is a whole one that a column of them can hold."""
    return isinstance(value, int) and abs(value) < _GREATEST


def is_number(value: RawValue) -> bool:
    """Whether an entry is a finite number."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
