"""Raw cells → typed values, or the code that says why not."""

from __future__ import annotations

import datetime
import math
import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from flexlash.reading.raw import CommaNumber, DoubtfulNumber, ErrorCell, Percentage, RawValue, Unstored
from flexlash.schema.columns import Column
from flexlash.validation.number_texts import Meant, Measure, meant_number

__all__ = ["Fault", "as_number", "as_text", "is_no_value", "no_value_facts", "plain_number"]

_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d{1,3})?", re.ASCII)
_TYPED_THIS_YEAR = 2020
"""Year from which on a date is taken for day and month; Excel adds the year in which they are typed."""

_DATES = (datetime.date, datetime.time, datetime.timedelta)


@dataclass(frozen=True, kw_only=True)
class Fault:
    """Why a cell is not usable: code, what to show of it, what was probably meant, what can only be meant.

    `facts` are what else its message names.
    """

    code: str
    value: object
    suggestion: str = ""
    certain_value: str | float | None = None
    facts: Mapping[str, object] = field(default_factory=dict)


_NO_VALUES = frozenset({
    "", "nan", "na", "n/a", "n.a", "#n/a", "tbd", "tbc", "tba", "null", "none", "nil", "?", "-", "/", "k.a",
    "not available", "not applicable",
})  # fmt: skip
"""Texts, in small letters and without repeated signs or last dots, by which people and programs say: no value."""


def is_no_value(text: str) -> bool:
    """Return whether a text says that there is no value, such as NaN, n/a, TBD, - or ??.

    >>> is_no_value("N/A"), is_no_value("--"), is_no_value("0")
    (True, True, False)
    """
    bare = unicodedata.normalize("NFKC", text).strip().casefold().rstrip(".… ")
    for dash in "\u2010\u2011\u2012\u2013\u2014\u2212":
        bare = bare.replace(dash, "-")
    return bool(text.strip()) and (bare in _NO_VALUES or bool(_ONE_SIGN.fullmatch(bare)))


_ONE_SIGN = re.compile(r"([?/-])\1*")


def no_value_facts(column: Column) -> dict[str, str]:
    """Return what a finding says to a text that stands for no value in a column."""
    return {"detail": f"{column.requirement} is required" if column.required else "leave the cell blank instead"}


def _not_an_entry(value: RawValue) -> Fault | None:
    """Return the fault of a cell that can be neither number nor text."""
    if isinstance(value, bool):
        return Fault(code="E204", value=value)
    if isinstance(value, ErrorCell):
        return Fault(code="E205", value=value.text)
    if isinstance(value, Unstored):
        return Fault(code="E206", value="")
    if isinstance(value, _DATES):
        midnight = isinstance(value, datetime.datetime) and value.time() == datetime.time()
        return Fault(code="E203", value=value.date() if midnight else value)  # type: ignore[union-attr]
    return None


def _typed_before(value: object) -> str:
    """Return the number that Excel probably made a date of: 1.6 the first of June, 12.80 December 1980."""
    if not isinstance(value, datetime.date) or isinstance(value, datetime.datetime):
        return ""
    if value.year >= _TYPED_THIS_YEAR:
        return f"{value.day}.{value.month}"
    return f"{value.month}.{value.year % 100:02d}" if value.day == 1 else ""


def plain_number(value: RawValue, *, from_text: bool) -> float | None:
    """Return a cell that is a finite number and nothing else; None for one that takes a closer look."""
    kind = type(value)
    if not (kind is float or kind is int or (from_text and kind is str and _NUMBER.fullmatch(str(value).strip()))):
        return None
    number = float(value)  # type: ignore[arg-type]
    return number if math.isfinite(number) else None


def as_number(
    value: RawValue, column: Column | None = None, *, from_text: bool, measure: Measure | None = None
) -> float | Fault:
    """Return a cell as a finite number; texts count as numbers only in CSV files (`from_text`).

    A column gives a text its suggestion; `measure` says what the column's numbers stand for where that is not its
    printed unit.
    """
    if fault := _not_an_entry(value):
        return replace(fault, suggestion=_typed_before(fault.value)) if column else fault
    if isinstance(value, Percentage):
        return _percentage(value, column, measure)
    if isinstance(value, int | float):
        number = float(value)
        return number if math.isfinite(number) else Fault(code="E212", value=value)
    return _from_text(value, column, measure, readable=from_text)


def _from_text(value: RawValue, column: Column | None, measure: Measure | None, *, readable: bool) -> float | Fault:
    """Return a text as a number where texts are `readable` as such; else what it says or probably means."""
    text = str(value).strip()
    number = text.replace(",", ".") if isinstance(value, CommaNumber) else text
    doubtful = isinstance(value, DoubtfulNumber)
    if readable and _NUMBER.fullmatch(number) and not doubtful:
        parsed = float(number)
        return parsed if math.isfinite(parsed) else Fault(code="E212", value=text)
    if column and is_no_value(text):
        return Fault(code="E221", value=value, facts=no_value_facts(column))
    meant = meant_number(str(value), column, measure) if column else Meant()
    if doubtful:
        words = f"{text.replace('.', ',')} with this table's decimal comma" if meant.words == text else meant.words
        return Fault(code="E202", value=value, suggestion=words)
    is_number = _NUMBER.fullmatch(text) and meant.certain_value is not None
    return Fault(
        code="E220" if is_number else "E202", value=value, suggestion=meant.words, certain_value=meant.certain_value
    )


def _percentage(value: Percentage, column: Column | None, measure: Measure | None) -> float | Fault:
    """Return the number that a cell shown as a percentage means: per cent where those are wanted, else the ratio."""
    if column is not None and column.unit == "%":
        return round(value * 100, 12)
    if measure is not None and measure.quantity == "ratio":
        return round(value / measure.si, 12)
    if column is not None and column.quantity == "ratio":
        return float(value)
    return Fault(code="E216", value=value.shown)


def as_text(value: RawValue, longest: int) -> str | Fault:
    """Return a cell as a text without outer spaces and invisible characters; whole numbers lose their point."""
    if fault := _not_an_entry(value):
        return fault
    if isinstance(value, Percentage):
        return value.shown
    if isinstance(value, int | float):
        if not math.isfinite(value):
            return Fault(code="E212", value=value)
        return str(int(value)) if value == int(value) else repr(value)
    text = str(value)
    if text.isascii() and text.isprintable():
        text = " ".join(text.split())
    else:
        spaced = " ".join(unicodedata.normalize("NFC", text).split())
        text = "".join(character for character in spaced if unicodedata.category(character) not in {"Cc", "Cf", "Cs"})
    if len(text) <= longest:
        return text
    return Fault(code="E222", value=text, facts={"found": f"{len(text):,}", "limit": f"{longest:,}"})
