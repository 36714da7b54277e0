"""Raw cells → typed values, or the code that says why not."""

from __future__ import annotations

import datetime
import math
import re
import unicodedata
from dataclasses import dataclass

from flexlash.submission.read import ErrorCell, RawValue, Unstored

__all__ = ["Fault", "as_number", "as_text", "suggested_number"]

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?", re.ASCII)
_UNIT_AT_END = re.compile(r"[\s%°′″'\"a-zA-Zµμ·⋅*/²³]+$")
_DATES = (datetime.date, datetime.time, datetime.timedelta)
_LOOKALIKES = str.maketrans({"\u2212": "-", "\u2013": "-", "\u2012": "-", "\u066b": ".", "\u00a0": " "})


@dataclass(frozen=True, kw_only=True)
class Fault:
    """Why a cell is not usable: code, what to show of it, what was probably meant."""

    code: str
    value: object
    suggestion: str = ""


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


def as_number(value: RawValue, *, from_text: bool) -> float | Fault:
    """Return a cell as a finite number; texts count as numbers only in CSV files (`from_text`)."""
    if fault := _not_an_entry(value):
        return fault
    if isinstance(value, int | float):
        number = float(value)
        return number if math.isfinite(number) else Fault(code="E212", value=value)
    text = str(value).strip()
    if from_text and _NUMBER.fullmatch(text):
        number = float(text)
        return number if math.isfinite(number) else Fault(code="E212", value=text)
    return Fault(code="E202", value=value, suggestion=suggested_number(str(value)))


def as_text(value: RawValue, longest: int) -> str | Fault:
    """Return a cell as a text without outer spaces and invisible characters; whole numbers lose their point."""
    if fault := _not_an_entry(value):
        return fault
    if isinstance(value, int | float):
        if not math.isfinite(value):
            return Fault(code="E212", value=value)
        return str(int(value)) if value == int(value) else repr(value)
    spaced = " ".join(unicodedata.normalize("NFC", str(value)).split())
    text = "".join(character for character in spaced if unicodedata.category(character) not in {"Cc", "Cf", "Cs"})
    return text if len(text) <= longest else Fault(code="E212", value=text)


def suggested_number(text: str) -> str:
    """Return the number that a text probably means, or an empty text.

    >>> suggested_number("1,6 mm"), suggested_number("±0.02"), suggested_number("5%"), suggested_number("n/a")
    ('1.6', '0.02', '5', '')
    """
    bare = _UNIT_AT_END.sub("", text.translate(_LOOKALIKES).replace("±", "").strip())
    kept = unicodedata.normalize("NFKC", bare).replace("'", "").replace(" ", "")
    if kept.count(",") == 1 and "." not in kept:
        kept = kept.replace(",", ".")
    return kept if _NUMBER.fullmatch(kept) else ""
